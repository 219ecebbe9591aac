use super::*;
use crate::geometry::{Point, Vector};
use crate::kinematics::{
    MotionLimits, RobotModel, Scene, Target, dressing_orientation, plan_pair, plan_postures, start_postures,
};
use proptest::prelude::*;
use std::sync::LazyLock;

static MODEL: LazyLock<RobotModel> = LazyLock::new(|| RobotModel::baxter().unwrap());
/// Both grippers in front of the robot, 0.4 m apart.
static START: LazyLock<PerSide<JointVector>> = LazyLock::new(|| {
    let place = PerSide { left: Point::new(0.65, 0.2, 0.05), right: Point::new(0.65, -0.2, 0.05) };
    let orientations = PerSide { left: dressing_orientation(), right: dressing_orientation() };
    start_postures(&MODEL, &Scene::default(), &[place], &orientations, &MotionLimits::default()).unwrap()
});
/// A motion of 0.3 m with both grippers.
static MOTION: LazyLock<PairMotion> = LazyLock::new(|| both_by(Vector::new(0.1, 0.0, -0.3)));

fn start() -> PerSide<JointVector> {
    *START
}

fn both_by(step: Vector) -> PairMotion {
    let start = start();
    let targets = PerSide::from_fn(|side| {
        let tip = Point::from(MODEL.arm(side).forward(start.get(side)).translation.vector);
        Some(Target::position(tip + step))
    });
    plan_pair(&MODEL, &Scene::default(), &start, &targets, &MotionLimits::default()).unwrap()
}

/// The largest change of a joint position from sample to sample at 100 Hz, against speed times 10 ms.
fn largest_step_share(motion: &PairMotion) -> f64 {
    let limits = MotionLimits::default();
    let samples = u32::try_from(motion.duration().as_millis() / 10).unwrap() + 2;
    let at = |index: u32| motion.sample(Duration::from_millis(10) * index);
    let mut worst: f64 = 0.0;
    for index in 1..=samples {
        let (before, after) = (at(index - 1), at(index));
        for side in Side::BOTH {
            let step = (after.get(side).joints - before.get(side).joints).abs();
            worst = worst.max(step.component_div(&(limits.joint_speed * 0.01)).max());
        }
    }
    worst
}

#[test]
fn no_joint_moves_further_in_a_tick_than_its_speed_allows() {
    let share = largest_step_share(&MOTION);
    assert!(share <= 1.0 && share > 0.05, "{share}");
}

#[test]
fn the_grippers_stay_on_their_straight_lines() {
    let duration = MOTION.duration();
    for side in Side::BOTH {
        let at = |share: f64| MOTION.sample(duration.mul_f64(share)).get(side).pose;
        let (from, to) = (at(0.0), at(1.0));
        for index in 0..=1000 {
            let pose = at(f64::from(index) / 1000.0);
            let (start, end) = (Point::from(from.translation.vector), Point::from(to.translation.vector));
            let here = Point::from(pose.translation.vector);
            let off = (here - crate::geometry::closest_on_segment(&here, &start, &end)).norm();
            assert!(off < 1e-5, "{off}");
            assert!(pose.rotation.angle_to(&from.rotation) < 1e-5);
        }
    }
}

#[test]
fn both_arms_are_in_step() {
    let duration = MOTION.duration();
    for index in 0..=20 {
        let share = f64::from(index) / 20.0;
        let here = MOTION.sample(duration.mul_f64(share));
        let (start, end) = (MOTION.sample(Duration::ZERO), MOTION.sample(duration));
        let progress = |side: Side| {
            let tip = |setpoints: &PerSide<Setpoint>| setpoints.get(side).pose.translation.vector;
            (tip(&here) - tip(&start)).norm() / (tip(&end) - tip(&start)).norm()
        };
        assert!((progress(Side::Left) - progress(Side::Right)).abs() < 1e-4);
        assert!((progress(Side::Left) - MOTION.progress(duration.mul_f64(share))).abs() < 1e-4);
    }
}

#[test]
fn the_grippers_keep_speed_and_acceleration() {
    let limits = MotionLimits::default();
    let step = Duration::from_millis(10);
    let mut before: Option<(Vector, Vector)> = None;
    for index in 0..(MOTION.duration().as_millis() / 10) {
        let here = MOTION.sample(step * u32::try_from(index).unwrap()).right.pose.translation.vector;
        if let Some((position, velocity)) = before {
            let speed = (here - position) / 0.01;
            assert!(speed.norm() <= limits.speed * 1.001);
            if velocity.norm() > 0.0 {
                assert!((speed - velocity).norm() / 0.01 <= limits.acceleration * 1.05 + 1e-3);
            }
            before = Some((here, speed));
        } else {
            before = Some((here, Vector::zeros()));
        }
    }
}

#[test]
fn velocity_and_acceleration_are_the_derivatives_of_the_joints() {
    let step = Duration::from_micros(500);
    for index in 1..40 {
        let time = MOTION.duration().mul_f64(f64::from(index) / 40.0);
        let (before, here, after) =
            (MOTION.sample(time.checked_sub(step).unwrap()), MOTION.sample(time), MOTION.sample(time + step));
        for side in Side::BOTH {
            let velocity = (after.get(side).joints - before.get(side).joints) / (2.0 * step.as_secs_f64());
            assert!((velocity - here.get(side).velocity).amax() < 1e-4);
            let acceleration = (after.get(side).velocity - before.get(side).velocity) / (2.0 * step.as_secs_f64());
            assert!((acceleration - here.get(side).acceleration).amax() < 2e-2);
        }
    }
}

#[test]
fn before_the_start_and_after_the_end_the_arms_rest() {
    let end = MOTION.sample(MOTION.duration() + Duration::from_mins(1));
    for side in Side::BOTH {
        assert!(MOTION.sample(Duration::ZERO).get(side).velocity.amax() < 1e-9);
        assert!(end.get(side).velocity.amax() < 1e-6);
        assert!((end.get(side).joints - MOTION.sample(MOTION.duration()).get(side).joints).amax() < 1e-9);
    }
}

#[test]
fn an_arm_without_a_target_rests() {
    let start = start();
    let target = MODEL.arm(Side::Right).forward(&start.right).translation.vector + Vector::new(0.0, -0.1, 0.0);
    let targets = PerSide { left: None, right: Some(Target::position(Point::from(target))) };
    let motion = plan_pair(&MODEL, &Scene::default(), &start, &targets, &MotionLimits::default()).unwrap();
    assert!(motion.rests(Side::Left) && !motion.rests(Side::Right));
    for index in 0..50 {
        let here = motion.sample(Duration::from_millis(100 * index));
        assert_eq!(here.left.joints, start.left);
        assert_eq!(here.left.velocity, JointVector::zeros());
    }
}

#[test]
fn a_short_move_takes_the_minimum_duration() {
    let motion = both_by(Vector::new(0.01, 0.0, 0.0));
    assert!((motion.duration().as_secs_f64() - 3.0).abs() < 1e-6);
    let long = both_by(Vector::new(0.05, 0.0, -0.4));
    assert!(long.duration().as_secs_f64() > 4.0);
}

#[test]
fn a_posture_move_ends_at_the_posture() {
    let target = start().right + JointVector::from([-0.2, 0.1, 0.1, -0.1, -0.3, 0.1, 0.4]);
    let targets = PerSide { left: None, right: Some(target) };
    let motion = plan_postures(&MODEL, &Scene::default(), &start(), &targets, &MotionLimits::default()).unwrap();
    assert!((motion.sample(motion.duration()).right.joints - target).amax() < 1e-7);
    assert!(largest_step_share(&motion) <= 1.0);
}

#[test]
fn s_39_a_fast_joint_is_brought_to_rest_within_what_a_hold_may_take() {
    // A way without bends: all of a joint's acceleration is there for braking, from the highest speed of a wrist.
    let mut target = start().right;
    target[6] -= 2.5_f64.copysign(target[6]);
    let targets = PerSide { left: None, right: Some(target) };
    // The gripper's own turning speed does not bind.
    let limits = MotionLimits { turning_speed: 3.0, ..MotionLimits::default() };
    let motion = plan_postures(&MODEL, &Scene::default(), &start(), &targets, &limits).unwrap();
    for tenths in 1..10 {
        let halted = motion.halt(motion.duration().mul_f64(0.1 * f64::from(tenths)));
        assert!(halted.duration() <= Duration::from_millis(750), "{:?} at {tenths} tenths", halted.duration());
        assert!(largest_step_share(&halted) <= 1.0);
    }
}

#[test]
fn a_halt_ends_before_the_end_of_the_path_and_a_second_halt_is_no_worse() {
    let halted = MOTION.halt(MOTION.duration().mul_f64(0.4));
    let again = halted.halt(Duration::from_millis(50));
    assert!(halted.duration() < Duration::from_secs(1));
    assert!(again.duration() <= halted.duration());
    let end = again.sample(again.duration());
    assert!(end.left.velocity.amax() < 1e-6 && end.right.velocity.amax() < 1e-6);
}

proptest! {
    #[test]
    fn a_halt_starts_where_the_motion_is_and_keeps_the_limits(share in 0.0..1.0_f64) {
        let elapsed = MOTION.duration().mul_f64(share);
        let halted = MOTION.halt(elapsed);
        let (was, is) = (MOTION.sample(elapsed), halted.sample(Duration::ZERO));
        for side in Side::BOTH {
            prop_assert!((was.get(side).joints - is.get(side).joints).amax() < 1e-9);
            prop_assert!((was.get(side).velocity - is.get(side).velocity).amax() < 1e-9);
        }
        let end = halted.sample(halted.duration());
        let travelled = (end.right.pose.translation.vector - is.right.pose.translation.vector).norm();
        prop_assert!(travelled < 0.03, "{travelled} m to come to rest");
        prop_assert!(end.right.velocity.amax() < 1e-6);
        prop_assert!(largest_step_share(&halted) <= 1.0);
    }
}
