//! Speeds of the motion rooms that a tick depends on: `cargo bench --bench kinematics`.
#![allow(missing_docs, reason = "criterion's macros make public items without documentation")]
#![allow(clippy::unwrap_used, reason = "a bench that cannot be set up has nothing to measure")]

use criterion::{Criterion, criterion_group, criterion_main};
use std::hint::black_box;
use valet::body::{PerSide, Side};
use valet::geometry::Point;
use valet::kinematics::{
    JointVector, MotionLimits, PairMotion, RobotModel, Scene, Target, dressing_orientation, plan_pair, start_postures,
};

struct Setup {
    model: RobotModel,
    start: PerSide<JointVector>,
    targets: PerSide<Option<Target>>,
    motion: PairMotion,
}

/// Both grippers 0.4 m apart in front of the robot, and a move of 0.3 m.
fn setup() -> Setup {
    let model = RobotModel::baxter().unwrap();
    let place = PerSide { left: Point::new(0.60, 0.2, 0.15), right: Point::new(0.60, -0.2, 0.15) };
    let end = PerSide { left: Point::new(0.70, 0.2, -0.13), right: Point::new(0.70, -0.2, -0.13) };
    let orientations = PerSide { left: dressing_orientation(), right: dressing_orientation() };
    let limits = MotionLimits::default();
    let start = start_postures(&model, &Scene::default(), &[place, end], &orientations, &limits).unwrap();
    let targets = end.map(|_, point| Some(Target::position(*point)));
    let motion = plan_pair(&model, &Scene::default(), &start, &targets, &limits).unwrap();
    Setup { model, start, targets, motion }
}

fn kinematics(criterion: &mut Criterion) {
    let Setup { model, start, targets, motion } = setup();
    let (scene, limits) = (Scene::default(), MotionLimits::default());
    let arm = model.arm(Side::Right);
    let middle = motion.duration() / 2;
    let pose = motion.sample(middle).right.pose;
    criterion.bench_function("forward", |bencher| bencher.iter(|| arm.forward(black_box(&start.right))));
    criterion.bench_function("inverse, seed mid-range", |bencher| {
        let seed = arm.limits().middle();
        bencher.iter(|| arm.inverse(black_box(&pose), &seed));
    });
    criterion.bench_function("both arms against everything", |bencher| {
        bencher.iter(|| model.tightest(black_box(&start), &scene));
    });
    criterion.bench_function("plan a move of 0.3 m", |bencher| {
        bencher.iter(|| plan_pair(&model, &scene, black_box(&start), &targets, &limits));
    });
    criterion.bench_function("sample both arms", |bencher| bencher.iter(|| motion.sample(black_box(middle))));
    criterion.bench_function("halt", |bencher| bencher.iter(|| motion.halt(black_box(middle))));
}

criterion_group!(benches, kinematics);
criterion_main!(benches);
