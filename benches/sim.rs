//! How many times faster than real time the simulated people are: `cargo bench --bench sim`.
//!
//! Each figure is one pass of a garment along an arm (3 s a limb and more at 0.1 m/s), stepped beat by beat on one core; a
//! criterion time of t for a pass of s seconds is a real-time factor of s / t; beside it the factor by processor time is printed.
#![allow(missing_docs, reason = "criterion's macros make public items without documentation")]
#![allow(clippy::unwrap_used, reason = "a bench that cannot be set up has nothing to measure")]
#![allow(clippy::print_stdout, reason = "criterion has no column for a factor of real time")]

use criterion::{Criterion, criterion_group, criterion_main};
use std::hint::black_box;
use valet::body::Side;
use valet::geometry::{Point, Vector};
use valet::sim::WorldSetup;
use valet::sim::rig::{BEAT_SECONDS, Rig};
use valet::sim::world::Backend;
use valet::time::Stamp;

/// The gripper's speed in metres per second (thesis section 3.5).
const SPEED: f64 = 0.1;

fn setup(backend: Backend) -> WorldSetup {
    WorldSetup { backend, ..WorldSetup::default() }
}

/// The gripper's places beat by beat, from the hand over the elbow to the shoulder.
fn places(rig: &Rig) -> Vec<Point> {
    let [hand, elbow, shoulder] = rig.dressed();
    let mut places = vec![hand];
    for (from, to) in [(hand, elbow), (elbow, shoulder)] {
        let way: Vector = to - from;
        let mut done = 0.0;
        while done < way.norm() {
            done = (done + SPEED * BEAT_SECONDS).min(way.norm());
            places.push(from + way.normalize() * done);
        }
    }
    places
}

/// One pass; returns its virtual time in seconds.
fn pass(backend: Backend) -> f64 {
    let mut rig = Rig::new(&setup(backend), Side::Right).unwrap();
    let places = places(&rig);
    for place in &places {
        black_box(rig.place(*place));
    }
    places.len() as f64 * BEAT_SECONDS
}

/// Prints the real-time factor of some passes at a stretch, by processor time: what other programs do meanwhile counts little.
fn factor(name: &str, backend: Backend, passes: u32) {
    let began = processor_seconds();
    let seconds: f64 = (0..passes).map(|_| pass(backend)).sum();
    println!("{name}: {:.0} times real time on one core", seconds / (processor_seconds() - began));
}

fn processor_seconds() -> f64 {
    let spent = rustix::time::clock_gettime(rustix::time::ClockId::ThreadCPUTime);
    spent.tv_sec as f64 + spent.tv_nsec as f64 * 1e-9
}

fn sim(criterion: &mut Criterion) {
    factor("reduced garment", Backend::Reduced, 200);
    factor("garment of cloth, 5 ms steps", Backend::Cloth, 4);
    criterion.bench_function("a pass, reduced garment", |bencher| bencher.iter(|| pass(Backend::Reduced)));
    let mut slow = criterion.benchmark_group("cloth");
    slow.sample_size(10);
    slow.bench_function("a pass, garment of cloth", |bencher| bencher.iter(|| pass(Backend::Cloth)));
    slow.finish();
    criterion.bench_function("a second of the whole world, reduced garment", |bencher| {
        let mut world = valet::sim::World::new(&setup(Backend::Reduced)).unwrap();
        let mut beats = 0_u64;
        bencher.iter(|| {
            beats += 100;
            black_box(world.step(Stamp::from_nanoseconds(beats * 10_000_000)))
        });
    });
}

criterion_group!(benches, sim);
criterion_main!(benches);
