//! How long images take, on one core: `cargo bench --bench vision`.
//!
//! - `leaves of 31,000 pixels, one tree`: a frame's foreground through a depth-20 tree of the forest that valet brings along,
//!   with vector instructions where the machine has them, and without;
//! - `frame to joints`: a whole 640 x 480 image with the forest that valet brings along, three trees, nothing but this on the core;
//! - `training kernel`: one tree of depth 1 on 20 images, which is one pass of 500 features x 10 thresholds over their samples;
//! - `rendered image`: 640 x 480 with labels, without and with the sensor's noise.
#![allow(missing_docs, reason = "criterion's macros make public items without documentation")]
#![allow(clippy::unwrap_used, reason = "a bench that cannot be set up has nothing to measure")]

use criterion::{Criterion, criterion_group, criterion_main};
use std::hint::black_box;
use valet::sim::camera::dataset::{Frame, Labelled, training_set};
use valet::sim::camera::{IMAGE_SIZE, SensorNoise};
use valet::vision::foreground::Pixel;
use valet::vision::probe::ProbeImage;
use valet::vision::training::{Settings, train};
use valet::vision::{PoseFinder, generic, walk};

/// Foreground pixels of a frame.
const PIXELS: usize = 31_000;
/// Somebody whom the forest has not seen.
const STRANGER: u64 = 700_000_000;

fn foreground(image: &Labelled) -> (ProbeImage, Vec<Pixel>) {
    let (mut probe, mut pixels) = (ProbeImage::default(), Vec::new());
    image.view().extract(&image.rendering.depth, &mut probe, &mut pixels).unwrap();
    (probe, pixels)
}

fn classification(criterion: &mut Criterion) {
    let (image, pixels) = foreground(&Frame { person: STRANGER, number: 0 }.render());
    let pixels: Vec<Pixel> = pixels.iter().cycle().take(PIXELS).copied().collect();
    let forest = generic::forest().unwrap();
    let tree = forest.trees().first().unwrap();
    let mut found = Vec::with_capacity(PIXELS);
    let mut group = criterion.benchmark_group("leaves of 31,000 pixels, one tree");
    group.bench_function("vector instructions", |bencher| {
        bencher.iter(|| walk::leaves(tree, black_box(&image), &pixels, 1.0, &mut found));
    });
    group.bench_function("plain", |bencher| {
        bencher.iter(|| {
            found.clear();
            walk::plain_leaves(tree, black_box(&image), &pixels, 1.0, &mut found);
        });
    });
}

fn frame_to_joints(criterion: &mut Criterion) {
    let image = Frame { person: STRANGER, number: 0 }.render();
    let mut finder = PoseFinder::new(generic::forest().unwrap());
    criterion.bench_function("frame to joints, three trees", |bencher| {
        bencher.iter(|| finder.find(black_box(&image.rendering.depth), &image.view()).unwrap());
    });
}

fn training(criterion: &mut Criterion) {
    let frames: Vec<Frame> = Frame::list(20, 1, STRANGER).collect();
    let set = training_set(&frames, 545.0, 63, &|| ());
    let settings = Settings { depth: 1, ..Settings::default() };
    let one_thread = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
    criterion.bench_function("training kernel, 20 images x 500 features", |bencher| {
        one_thread.install(|| bencher.iter(|| train(black_box(&set), &settings, &|_| ()).unwrap()));
    });
}

fn rendering(criterion: &mut Criterion) {
    let image = Frame { person: STRANGER, number: 0 }.render();
    let (scene, camera) = (&image.sampled.scene, &image.sampled.camera);
    let mut group = criterion.benchmark_group("rendered image, 640 x 480 with labels");
    for (name, noise) in [("without noise", None), ("with noise", Some(SensorNoise::default()))] {
        group.bench_function(name, |bencher| {
            bencher.iter(|| black_box(scene).render(camera, IMAGE_SIZE, noise.as_ref(), 1));
        });
    }
}

criterion_group!(benches, classification, frame_to_joints, training, rendering);
criterion_main!(benches);
