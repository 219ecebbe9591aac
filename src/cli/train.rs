//! `valet train`: trains a forest on a folder of labelled images, on one simulated person, or on many (`--generic`).
//!
//! The file is written whole or not at all. Everything random comes from the seed: the same arguments make the same bytes
//! on any number of cores.

mod folder;
mod progress;

use super::exit::Failure;
use super::output::Output;
use crate::config::write_whole;
use crate::sim::camera::dataset::{Frame, Labelled, training_set};
use crate::sim::camera::{Motion, Subject};
use crate::vision::part::CLASSES;
use crate::vision::probe::ProbeImage;
use crate::vision::training::{Settings, TrainingSet, train};
use crate::vision::{Forest, Intrinsics, View};
use progress::Bar;
use rayon::prelude::*;
use serde::Serialize;
use std::path::PathBuf;

/// Frames in which a simulated person goes through a movement once: 3 s at 30 Hz.
const FRAMES_A_CYCLE: f64 = 90.0;
/// Images in a hundred that are kept from training to judge the forest by.
const KEPT_PERCENT: usize = 5;
/// Images of each person of a generic forest.
const IMAGES_A_PERSON: u64 = 2;
/// A generic forest's smallest node that is split: smaller ones tell about single people.
const GENERIC_SMALLEST: usize = 20;
/// Where trees would be counted, this one stands for the people that are kept from training.
const KEPT_PEOPLE: u64 = 1000;
/// Trees of a generic forest; a person's own forest has one, as in the thesis.
const GENERIC_TREES: u64 = 3;

/// Trains a forest that finds body parts in depth images.
#[derive(Clone, Debug, clap::Args)]
pub(super) struct Arguments {
    /// The file that the forest is written to.
    #[arg(long, value_name = "FILE")]
    out: PathBuf,
    /// Folder with own images: NAME.png (16-bit, millimetres), NAME.json (`fx`, `fy`, `cx`, `cy`, `neck_m`) and truth/NAME.png
    /// (8-bit labels); empty/NAME.png and truth/joints.jsonl are used where they are there. Without it people are simulated.
    #[arg(long, value_name = "DIR", conflicts_with = "generic")]
    from: Option<PathBuf>,
    /// Train on many simulated people instead of one, for people whom nobody has trained for.
    #[arg(long)]
    generic: bool,
    /// Images; of a folder, at most so many.
    #[arg(long, default_value_t = 3000, value_parser = clap::value_parser!(u64).range(1..=1_000_000))]
    images: u64,
    /// Trees; without it 1, and 3 for a generic forest.
    #[arg(long, value_parser = clap::value_parser!(u64).range(1..=16))]
    trees: Option<u64>,
    /// Deepest level of a leaf.
    #[arg(long, default_value_t = Settings::default().depth)]
    depth: usize,
    /// Pixels of each part of an image.
    #[arg(long, default_value_t = 63, value_parser = clap::value_parser!(u16).range(1..=10_000))]
    pixels: u16,
    /// Features that a node tries.
    #[arg(long, default_value_t = Settings::default().features)]
    features: usize,
    /// Thresholds for each feature.
    #[arg(long, default_value_t = Settings::default().thresholds)]
    thresholds: usize,
    /// Share of a node's features that look at the way and the place from the neck; 0 is the thesis' equation 3.1 alone.
    #[arg(long, default_value_t = 0.5)]
    neck_share: f64,
    /// Seed of everything random, the simulated people too.
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Print one JSON object a tree, and one at the end, on stdout.
    #[arg(long)]
    json: bool,
}

#[derive(Serialize)]
struct Report<'a> {
    event: &'static str,
    file: String,
    description: &'a str,
    images: u64,
    kept_images: usize,
    trees: usize,
    nodes: usize,
    bytes: usize,
    pixel_accuracy_on_kept_images: Option<f64>,
}

/// An image that is kept from training: its foreground pixels with a label.
struct Kept {
    image: ProbeImage,
    pixels: Vec<(f32, f32, f32, u8)>,
    focal: f64,
}

/// What is trained on, for each tree, and judged by.
struct Material {
    focal: f64,
    description: String,
    kept: Vec<Kept>,
    own: Option<TrainingSet>,
}

/// Trains, judges and writes a forest.
///
/// # Errors
/// Where images or settings cannot be used, or the file cannot be written.
pub(super) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let trees = arguments.trees.unwrap_or(if arguments.generic { GENERIC_TREES } else { 1 });
    settings(arguments, 0).check().map_err(Failure::configuration)?;
    let mut output = Output::new(arguments.json);
    let material = gather(arguments)?;
    let mut forest = Forest::new(material.focal, material.description.clone(), Vec::new());
    for number in 0..trees {
        let generic;
        let set = if let Some(set) = &material.own {
            set
        } else {
            generic = generic_set(arguments, number, material.focal);
            &generic
        };
        let bar = Bar::of_tree(number, trees);
        let tree =
            train(set, &settings(arguments, number), &|share| bar.reach(share)).map_err(Failure::configuration)?;
        forest.push(tree);
        let accuracy = accuracy(&forest, &material.kept);
        bar.finish(accuracy);
        let so_far =
            accuracy.map_or_else(String::new, |share| format!(", {:.1} % of pixels right so far", share * 100.0));
        output.line(format!("Tree {} of {trees}{so_far}", number + 1))?;
    }
    finish(arguments, &forest, &material, &mut output)
}

fn finish(arguments: &Arguments, forest: &Forest, material: &Material, output: &mut Output) -> Result<(), Failure> {
    let bytes = forest.to_bytes().map_err(Failure::fault)?;
    write_whole(&arguments.out, &bytes).map_err(Failure::configuration)?;
    let images = material.own.as_ref().map_or(arguments.images, |set| set.image_count() as u64);
    output.event(&Report {
        event: "trained",
        file: arguments.out.display().to_string(),
        description: &forest.description,
        images,
        kept_images: material.kept.len(),
        trees: forest.trees().len(),
        nodes: forest.trees().iter().map(crate::vision::tree::Tree::node_count).sum(),
        bytes: bytes.len(),
        pixel_accuracy_on_kept_images: accuracy(forest, &material.kept),
    })?;
    output.line(format!("Written: {} ({} bytes)", arguments.out.display(), bytes.len()))
}

/// A tree's settings: each tree draws other candidates.
fn settings(arguments: &Arguments, tree: u64) -> Settings {
    Settings {
        features: arguments.features,
        thresholds: arguments.thresholds,
        depth: arguments.depth,
        smallest: if arguments.generic { GENERIC_SMALLEST } else { Settings::default().smallest },
        neck_share: arguments.neck_share,
        seed: arguments.seed.wrapping_add(tree.wrapping_mul(0x9E37_79B9)),
        ..Settings::default()
    }
}

fn gather(arguments: &Arguments) -> Result<Material, Failure> {
    if let Some(path) = &arguments.from {
        return folder::read(path, arguments);
    }
    let focal = Intrinsics::default().fx;
    let kept_count = (arguments.images * KEPT_PERCENT as u64).div_ceil(100).min(100);
    let bar = Bar::of_images("images to judge by", kept_count);
    let render = |number: u64| {
        let image = simulated(arguments, number);
        bar.step();
        Kept::of(&image)
    };
    let kept = (0..kept_count).into_par_iter().filter_map(|number| render(arguments.images + number)).collect();
    let kind = if arguments.generic { "simulated people" } else { "a simulated person" };
    let description = format!("{} images of {kind}, seed {}", arguments.images, arguments.seed);
    let own = (!arguments.generic).then(|| personal_set(arguments, focal));
    Ok(Material { focal, description, kept, own })
}

/// A simulated image; numbers from `--images` on are for judging and show other people, or the same person later.
fn simulated(arguments: &Arguments, number: u64) -> Labelled {
    if arguments.generic {
        return Frame { person: people_from(arguments, KEPT_PEOPLE) + number, number }.render();
    }
    let subject = Subject::sampled(arguments.seed);
    let motion = match arguments.seed % 4 {
        0 => Motion::Sideways,
        1 => Motion::Forward,
        2 => Motion::Upward,
        _ => Motion::Circle,
    };
    let sampled = subject.in_motion(motion, number as f64 / FRAMES_A_CYCLE);
    Labelled::render(sampled, number.is_multiple_of(2), arguments.seed ^ (number << 20))
}

/// The first of the simulated people of a tree: no two seeds or trees share one.
const fn people_from(arguments: &Arguments, tree: u64) -> u64 {
    1 + (arguments.seed % 256) * (1 << 30) + tree * (1 << 20)
}

fn generic_set(arguments: &Arguments, tree: u64, focal: f64) -> TrainingSet {
    let first = people_from(arguments, tree);
    let frames: Vec<Frame> = Frame::list(arguments.images, IMAGES_A_PERSON, first).collect();
    let bar = Bar::of_images("simulated images", arguments.images);
    training_set(&frames, focal, usize::from(arguments.pixels), &|| bar.step())
}

fn personal_set(arguments: &Arguments, focal: f64) -> TrainingSet {
    let bar = Bar::of_images("simulated images", arguments.images);
    let piece = |number: u64| {
        let mut piece = TrainingSet::new(focal, usize::from(arguments.pixels));
        // A frame in which nobody is seen teaches nothing.
        let _ = simulated(arguments, number).add_to(&mut piece, number);
        bar.step();
        piece
    };
    let pieces: Vec<TrainingSet> = (0..arguments.images).into_par_iter().map(piece).collect();
    let mut set = TrainingSet::new(focal, usize::from(arguments.pixels));
    pieces.into_iter().for_each(|piece| set.append(piece));
    set
}

impl Kept {
    fn of(image: &Labelled) -> Option<Self> {
        Self::from_parts(&image.view(), &image.rendering.depth, &image.rendering.labels)
    }

    fn from_parts(view: &View<'_>, depth: &crate::vision::DepthImage, labels: &[u8]) -> Option<Self> {
        let (mut image, mut found) = (ProbeImage::default(), Vec::new());
        view.extract(depth, &mut image, &mut found).ok()?;
        let width = image.width();
        let labelled = |pixel: &crate::vision::foreground::Pixel| {
            let label = *labels.get(usize::from(pixel.row) * width + usize::from(pixel.column))?;
            let place = (f32::from(pixel.column), f32::from(pixel.row), f32::from(pixel.depth.max(1)));
            (usize::from(label) < CLASSES).then_some((place.0, place.1, place.2, label))
        };
        let pixels = found.iter().filter_map(labelled).collect();
        Some(Self { image, pixels, focal: view.camera.fx })
    }
}

/// Share of the kept images' foreground pixels that get their label.
fn accuracy(forest: &Forest, kept: &[Kept]) -> Option<f64> {
    let count = |kept: &Kept| {
        #[expect(clippy::cast_possible_truncation, reason = "a ratio near one")]
        let ratio = (kept.focal / forest.focal) as f32;
        let right = kept.pixels.iter().filter(|(column, row, depth, label)| {
            let leaf =
                |tree: &crate::vision::tree::Tree| tree.leaf(&kept.image, (*column, *row), 1000.0 / depth * ratio);
            forest.class(forest.trees().iter().map(leaf)) == *label
        });
        (right.count(), kept.pixels.len())
    };
    let (right, all) = kept.par_iter().map(count).reduce(|| (0, 0), |sum, more| (sum.0 + more.0, sum.1 + more.1));
    (all > 0).then(|| right as f64 / all as f64)
}

#[cfg(test)]
mod tests;
