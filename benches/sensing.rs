//! How long the force path takes: a sample through the window and through the guard, and one step of the supervisor.
//!
//! Run with `cargo bench --bench sensing`. A beat lasts 10 ms and brings two forces, joints, a state and the beat itself.
#![allow(clippy::expect_used, reason = "a bench that cannot be set up has nothing to measure")]

use criterion::{Criterion, criterion_group, criterion_main};
use std::hint::black_box;
use std::time::Duration;
use valet::body::Side;
use valet::command::{Command, Origin};
use valet::geometry::{Pose, Vector, Wrench};
use valet::kinematics::RobotModel;
use valet::safety::{ForceGuard, GuardSample, GuardSettings, Zone};
use valet::sensing::{ForceWindow, WindowSettings};
use valet::sim::{World, WorldSetup};
use valet::supervisor::{EndpointSample, Input, Setup, Supervisor};
use valet::time::Stamp;

const BEAT: Duration = Duration::from_millis(10);
const START: Stamp = Stamp::from_nanoseconds(1_000_000_000);

fn force_at(beat: u32) -> Vector {
    let phase = f64::from(beat) * 0.07;
    Vector::new(phase.sin(), phase.cos(), 0.3 * (3.0 * phase).sin())
}

fn window(criterion: &mut Criterion) {
    let mut window = ForceWindow::new(WindowSettings::default()).expect("the defaults can be used");
    let (mut now, mut beat) = (START, 0);
    criterion.bench_function("force window, one sample", |bencher| {
        bencher.iter(|| {
            (now, beat) = (now + BEAT, beat + 1);
            window.push(black_box(now), black_box(force_at(beat)));
            window.detect()
        });
    });
}

fn guard(criterion: &mut Criterion) {
    let mut guard = ForceGuard::new(GuardSettings::default()).expect("the defaults can be used");
    let (mut now, mut beat) = (START, 0);
    criterion.bench_function("force guard, one sample", |bencher| {
        bencher.iter(|| {
            (now, beat) = (now + BEAT, beat + 1);
            guard.observe(&GuardSample {
                stamp: black_box(now),
                force: black_box(force_at(beat)),
                velocity: Vector::new(0.1, 0.0, 0.0),
                acceleration: Vector::zeros(),
                zone: Zone::Arm,
                expected_newtons: guard.expected(0.2),
            })
        });
    });
}

/// A supervisor in the middle of a trial, with both arms under way.
fn dressing() -> (Supervisor, World, Stamp) {
    let model = RobotModel::baxter().expect("the shipped description can be used");
    let mut supervisor = Supervisor::new(Setup::default(), model).expect("the defaults can be used");
    let mut world = World::new(&WorldSetup::default()).expect("the defaults can be used");
    let mut now = START;
    for beat in 0..900 {
        now = now + BEAT;
        let mut inputs: Vec<Input> = world.step(now).into_inputs().collect();
        let asked = match beat {
            100 => Some(Command::Enable),
            200 => Some(Command::Start),
            _ => None,
        };
        inputs.extend(asked.map(|command| Input::Operator { command, origin: Origin::OperatorKey }));
        inputs.push(Input::Tick);
        for input in inputs {
            for effect in supervisor.step(now, &input) {
                match effect {
                    valet::supervisor::Effect::Setpoint { side, joints } => world.command_joints(side, &joints, now),
                    valet::supervisor::Effect::Switch(request) => world.switch(request, now),
                    _ => {}
                }
            }
        }
    }
    (supervisor, world, now)
}

fn supervisor(criterion: &mut Criterion) {
    let (mut supervisor, _, now) = dressing();
    let sample = |stamp| EndpointSample {
        side: Side::Left,
        stamp,
        pose: Pose::identity(),
        wrench: Wrench { force: Vector::new(1.0, 0.0, 0.0), torque: Vector::zeros() },
    };
    criterion.bench_function("Supervisor::step, one force sample", |bencher| {
        let mut stamp = now;
        bencher.iter(|| {
            stamp = stamp + Duration::from_nanos(10);
            supervisor.step(now, black_box(&Input::Endpoint(sample(stamp))))
        });
    });
    let (mut supervisor, _, now) = dressing();
    criterion.bench_function("Supervisor::step, one beat", |bencher| {
        bencher.iter(|| supervisor.step(now, black_box(&Input::Tick)));
    });
    criterion.bench_function("Supervisor::snapshot", |bencher| {
        bencher.iter(|| supervisor.snapshot(black_box(now)));
    });
}

criterion_group!(benches, window, guard, supervisor);
criterion_main!(benches);
