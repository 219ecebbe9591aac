use super::*;
use crate::geometry::{Point, Vector};
use crate::kinematics::{BodyPart, Capsule, dressing_orientation, start_postures};
use crate::robot::GuardSettings;
use crate::robot::dummy::{DummyLimb, Told};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, LazyLock};

static MODEL: LazyLock<RobotModel> = LazyLock::new(|| RobotModel::baxter().unwrap());
static HOME: LazyLock<PerSide<JointVector>> = LazyLock::new(|| {
    let place = PerSide { left: Point::new(0.65, 0.2, 0.05), right: Point::new(0.65, -0.2, 0.05) };
    let orientations = PerSide { left: dressing_orientation(), right: dressing_orientation() };
    start_postures(&MODEL, &Scene::default(), &[place], &orientations, &MotionLimits::default()).unwrap()
});

fn at(milliseconds: u64) -> Stamp {
    Stamp::from_nanoseconds(milliseconds * 1_000_000)
}

fn pair(limits: &MotionLimits) -> (GuardedPair<DummyLimb>, Arc<AtomicBool>) {
    let latch = Arc::new(AtomicBool::new(false));
    let limb = |side: Side| {
        let arm = MODEL.arm(side).clone();
        GuardedLimb::new(DummyLimb::default(), arm, limits.clone(), GuardSettings::default(), Arc::clone(&latch))
    };
    let limbs = PerSide { left: limb(Side::Left), right: limb(Side::Right) };
    let mut pair = GuardedPair::new(limbs, MODEL.clone(), limits.clone());
    observe(&mut pair, at(1000), &HOME);
    (pair, latch)
}

fn observe(pair: &mut GuardedPair<DummyLimb>, now: Stamp, joints: &PerSide<JointVector>) {
    for (side, joints) in joints.iter() {
        pair.observe(now, side, &std::array::from_fn(|index| Some(joints[index])));
    }
}

/// Joints with the right gripper moved by a small step.
fn right_moved(step: Vector) -> JointVector {
    let arm = MODEL.arm(Side::Right);
    let mut pose = arm.forward(&HOME.right);
    pose.translation.vector += step;
    arm.inverse(&pose, &HOME.right).unwrap()
}

fn breach(result: Result<(), CommandError>) -> LimitBreach {
    match result {
        Err(CommandError::Refused(breach)) => breach,
        other => panic!("{other:?}"),
    }
}

#[test]
fn commands_inside_all_limits_reach_both_arms() {
    let (mut pair, _) = pair(&MotionLimits::default());
    pair.command_both(at(1010), &HOME).unwrap();
    for side in Side::BOTH {
        assert_eq!(pair.limb(side).inner().told, [(at(1010), Told::Command(*HOME.get(side)))]);
    }
}

#[test]
fn grippers_too_far_apart_or_too_close_are_refused() {
    let apart = MotionLimits { maximum_gripper_distance: 0.4005, ..MotionLimits::default() };
    let (mut pair_, _) = pair(&apart);
    let found = breach(pair_.command(at(1010), Side::Right, &right_moved(Vector::new(0.0, -0.004, 0.0))));
    assert_eq!(found.what, Limit::GripperDistance);
    assert!((found.value - 0.404).abs() < 1e-4);
    let close = MotionLimits { minimum_gripper_distance: 0.3995, ..MotionLimits::default() };
    let (mut pair_, _) = pair(&close);
    let found = breach(pair_.command(at(1010), Side::Right, &right_moved(Vector::new(0.0, 0.004, 0.0))));
    assert_eq!(found.what, Limit::GripperDistance);
    assert!(pair_.limb(Side::Right).inner().told.is_empty());
}

#[test]
fn grippers_that_are_too_far_apart_may_come_closer() {
    let limits = MotionLimits { maximum_gripper_distance: 0.3, ..MotionLimits::default() };
    let (mut pair, _) = pair(&limits);
    pair.command(at(1010), Side::Right, &right_moved(Vector::new(0.0, 0.004, 0.0))).unwrap();
}

#[test]
fn a_person_who_comes_close_stops_the_commands() {
    let (mut pair, _) = pair(&MotionLimits::default());
    let tip = Point::from(MODEL.arm(Side::Right).forward(&HOME.right).translation.vector);
    let approach = dressing_orientation() * Vector::z();
    // The hand's shape ends 0.015 m beyond the tip.
    let ahead = tip + approach * 0.036;
    let person = vec![BodyPart { name: "a hand".into(), shape: Capsule::sphere(ahead, 0.0) }];
    // What a plan keeps from the person is twice what commands keep.
    pair.surround(Scene { person, margin: 0.02 / STREAMED_SHARE });
    let found = breach(pair.command(at(1010), Side::Right, &right_moved(approach * 0.004)));
    assert!(matches!(&found.what, Limit::Clearance { second, .. } if second == "a hand"), "{found}");
    // Away from the hand is allowed.
    pair.command(at(1010), Side::Right, &right_moved(approach * -0.004)).unwrap();
}

#[test]
fn of_two_commands_neither_is_sent_where_one_is_refused() {
    let (mut pair, _) = pair(&MotionLimits::default());
    let mut joints = *HOME;
    joints.right[3] = f64::NAN;
    assert!(matches!(breach(pair.command_both(at(1010), &joints)).what, Limit::JointPosition { .. }));
    assert!(pair.limb(Side::Left).inner().told.is_empty());
}

#[test]
fn what_was_sent_before_the_clock_went_back_never_counts_again() {
    let (mut pair, _) = pair(&MotionLimits::default());
    pair.command_both(at(1010), &HOME).unwrap();
    let mut far = *HOME;
    far.right[2] += 0.06;
    for now in (510..1200).step_by(10) {
        observe(&mut pair, at(now), &HOME);
        let one = breach(pair.command(at(now), Side::Right, &far.right)).what;
        let both = breach(pair.command_both(at(now), &far)).what;
        assert!(
            matches!((&one, &both), (Limit::Following { .. }, Limit::Following { .. })),
            "{now} ms: {one:?} {both:?}"
        );
    }
}

#[test]
fn the_stop_latch_closes_both_arms() {
    let (mut pair, latch) = pair(&MotionLimits::default());
    latch.store(true, Ordering::SeqCst);
    assert_eq!(breach(pair.command_both(at(1010), &HOME)).what, Limit::StopLatch);
}
