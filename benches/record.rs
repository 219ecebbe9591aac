//! What recording costs: one second of a trial at full rate (both wrenches, joints and state at 100 Hz, beats, poses) written
//! as a journal, without images and with 30 compressed depth images of 640 by 480; and a recorded trial replayed.
//!
//! The time that a benchmark takes for one second of a trial is the share of a core that recording takes: 50 ms are 5 %.
//! Run with `cargo bench --bench record`.

#![expect(clippy::expect_used, reason = "a benchmark without a disk or a simulator should not run")]

use criterion::{Criterion, criterion_group, criterion_main};
use std::hint::black_box;
use std::path::Path;
use std::time::Duration;
use valet::body::PerSide;
use valet::config::{LoadedProfile, Places, Settings};
use valet::geometry::Point;
use valet::headless::{ScriptedOperator, VirtualTrial};
use valet::record::{Header, JournalWriter, Replay, Step, read};
use valet::sim::camera::{IMAGE_SIZE, robot_mount, view};
use valet::sim::person::ArmPoints;
use valet::sim::world::WorldSetup;
use valet::snapshot::Watermark;
use valet::supervisor::Setup;
use valet::vision::Intrinsics;

/// A setup as `valet demo` makes it in the folder of this package, and its simulated world.
fn demo() -> (Setup, WorldSetup) {
    let places = Places::of_this_machine();
    let person = LoadedProfile::find("participant-01", &places).expect("the package has profiles");
    let setup = Settings::default().setup_for(&person, 3, Watermark::Demo).expect("a built-in profile is usable");
    let simulated = person.profile.simulated.clone().unwrap_or_default();
    (setup, WorldSetup { seed: 3, person: simulated, ..WorldSetup::default() })
}

/// The journal of a simulated trial and the seconds that it covers.
fn journal(folder: &Path) -> (std::path::PathBuf, Header, f64) {
    let (setup, world) = demo();
    let header = Header::of(&setup, "", 0).expect("a setup can be written");
    let mut writer = JournalWriter::create(folder, &header).expect("a temporary folder can be written to");
    let mut trial = VirtualTrial::new(setup, &world).expect("a built-in profile is usable");
    trial.run(&mut ScriptedOperator::new(10), Duration::from_mins(2), |now, input, effects| {
        writer.step(now, input, effects, 0).expect("the disk has room");
    });
    let seconds = trial.trial_seconds();
    (writer.finish().expect("the disk has room"), header, seconds)
}

/// Depth as a robot's camera sees a person: a picture in millimetres, row by row.
fn picture(seed: u64) -> Vec<u16> {
    let (_, world) = demo();
    let arm = |y: f64| ArmPoints {
        hand: Point::new(0.56, y, 0.1),
        wrist: Point::new(0.62, y, 0.1),
        elbow: Point::new(0.75, y * 1.3, 0.12),
        shoulder: Point::new(0.8, y * 0.7, 0.35),
    };
    let arms = PerSide { left: arm(0.3), right: arm(-0.3) };
    let intrinsics = Intrinsics { fx: 570.3, fy: 570.3, cx: 319.5, cy: 239.5 };
    view(&world.person, &arms, &intrinsics, &robot_mount(), seed).depth.millimetres().to_vec()
}

fn write_second(folder: &Path, header: &Header, steps: &[Step], pictures: &[Vec<u16>]) {
    let mut writer = JournalWriter::create(folder, header).expect("a temporary folder can be written to");
    let (width, height) = IMAGE_SIZE;
    let [width, height] = [width, height].map(|pixels| u32::try_from(pixels).unwrap_or(u32::MAX));
    for step in steps {
        writer.step(step.now, &step.input, &step.effects, 0).expect("the disk has room");
    }
    let stamp = steps.first().map(|step| step.now).unwrap_or_default();
    for picture in pictures {
        writer.depth(stamp, width, height, picture).expect("the disk has room");
    }
    let path = writer.finish().expect("the disk has room");
    std::fs::remove_file(path).expect("what was written can be removed");
}

fn recording(criterion: &mut Criterion) {
    let folder = tempfile::tempdir().expect("there is a folder for temporary files");
    let (path, header, seconds) = journal(folder.path());
    let mut steps = Vec::new();
    read(&path, |_, step| steps.push(step)).expect("what was written can be read");
    let middle = steps.get(steps.len() / 2).map(|step| step.now).expect("a trial has steps");
    let second: Vec<Step> = steps
        .into_iter()
        .filter(|step| step.now >= middle && step.now.since(middle) < Duration::from_secs(1))
        .collect();
    let pictures: Vec<_> = (0..30).map(picture).collect();
    let scratch = folder.path().join("scratch");
    let mut group = criterion.benchmark_group("record");
    group.sample_size(20);
    group.bench_function(format!("one second of a trial ({} steps), no images", second.len()), |bencher| {
        bencher.iter(|| write_second(&scratch, &header, black_box(&second), &[]));
    });
    group.bench_function("one second of a trial, 30 compressed depth images", |bencher| {
        bencher.iter(|| write_second(&scratch, &header, black_box(&second), &pictures));
    });
    group.sample_size(10);
    group.bench_function(format!("replay of a trial of {seconds:.0} s"), |bencher| {
        bencher.iter(|| Replay::run(black_box(&path), Ok, |_, _, _, _, _| ()));
    });
    group.finish();
}

criterion_group!(benches, recording);
criterion_main!(benches);
