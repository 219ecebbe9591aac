use super::*;
use crate::geometry::Vector;
use crate::kinematics::{BodyPart, Capsule, dressing_orientation, start_postures};
use proptest::prelude::*;
use std::sync::LazyLock;

static MODEL: LazyLock<RobotModel> = LazyLock::new(|| RobotModel::baxter().unwrap());
/// Both grippers in front of the robot, 0.4 m apart.
static START: LazyLock<PerSide<JointVector>> = LazyLock::new(|| {
    let place = PerSide { left: Point::new(0.65, 0.2, 0.05), right: Point::new(0.65, -0.2, 0.05) };
    let orientations = PerSide { left: dressing_orientation(), right: dressing_orientation() };
    start_postures(&MODEL, &Scene::default(), &[place], &orientations, &MotionLimits::default()).unwrap()
});

fn start() -> PerSide<JointVector> {
    *START
}

fn tip(side: Side) -> Point {
    Point::from(MODEL.arm(side).forward(start().get(side)).translation.vector)
}

/// Plans a step of the right gripper from where it is.
fn step_right(step: Vector, limits: &MotionLimits) -> Result<PairMotion, MotionRefusal> {
    plan_right_to(tip(Side::Right) + step, &Scene::default(), limits)
}

fn plan_right_to(position: Point, scene: &Scene, limits: &MotionLimits) -> Result<PairMotion, MotionRefusal> {
    let targets = PerSide { left: None, right: Some(Target::position(position)) };
    plan_pair(&MODEL, scene, &start(), &targets, limits)
}

#[test]
fn a_target_that_is_no_number_is_refused() {
    let refusal = step_right(Vector::new(0.0, f64::NAN, 0.0), &MotionLimits::default()).unwrap_err();
    assert_eq!(refusal, MotionRefusal::NotFinite { side: Side::Right });
}

#[test]
fn a_start_that_is_no_number_or_outside_the_limits_is_refused_by_name() {
    for value in [f64::NAN, 4.0] {
        let mut start = start();
        start.left[2] = value;
        let refusal =
            plan_pair(&MODEL, &Scene::default(), &start, &PerSide::default(), &MotionLimits::default()).unwrap_err();
        assert!(matches!(&refusal, MotionRefusal::Joint { joint, .. } if joint == "left_e0"), "{refusal}");
        let words = refusal.to_string();
        let what_would_do = if value.is_nan() { "check /robot/joint_states" } else { "3.0542 rad would do" };
        assert!(words.contains("-3.0542 to 3.0542") && words.contains(what_would_do), "{words}");
    }
}

#[test]
fn a_measured_start_a_little_outside_its_range_is_brought_inside() {
    let mut start = start();
    start.right[3] = 2.618 + 0.004;
    let motion = plan_pair(&MODEL, &Scene::default(), &start, &PerSide::default(), &MotionLimits::default()).unwrap();
    assert!((motion.sample(std::time::Duration::ZERO).right.joints[3] - 2.618).abs() < 1e-12);
}

#[test]
fn a_target_outside_the_workspace_is_refused_with_axis_value_and_range() {
    match plan_right_to(Point::new(0.6, -0.3, 0.9), &Scene::default(), &MotionLimits::default()) {
        Err(refusal @ MotionRefusal::Workspace { side: Side::Right, axis: 'z', value, range }) => {
            assert!(refusal.to_string().ends_with("0.750 m would do"), "{refusal}");
            assert!((value - 0.9).abs() < 1e-12 && (range.1 - 0.75).abs() < 1e-12);
        }
        other => panic!("{other:?}"),
    }
}

#[test]
fn a_target_out_of_reach_is_refused_with_the_nearest_place() {
    match plan_right_to(Point::new(1.14, 0.9, -0.5), &Scene::default(), &MotionLimits::default()) {
        Err(MotionRefusal::OutOfReach { side: Side::Right, nearest, .. }) => {
            assert!(nearest.coords.iter().all(|value| value.is_finite()));
        }
        other => panic!("{other:?}"),
    }
}

#[test]
fn grippers_that_would_come_too_close_or_too_far_apart_are_refused() {
    let limits = MotionLimits { minimum_gripper_distance: 0.37, ..MotionLimits::default() };
    match step_right(Vector::y() * 0.05, &limits) {
        Err(refusal @ MotionRefusal::GripperDistance { distance, range }) => {
            assert!(refusal.to_string().ends_with("0.370 m would do"), "{refusal}");
            assert!(distance < range.0 && (range.0 - 0.37).abs() < 1e-12);
        }
        other => panic!("{other:?}"),
    }
    let limits = MotionLimits { maximum_gripper_distance: 0.5, ..MotionLimits::default() };
    match step_right(Vector::new(0.1, -0.35, 0.0), &limits) {
        Err(refusal @ MotionRefusal::GripperDistance { distance, .. }) => {
            assert!(distance > 0.5 && refusal.to_string().ends_with("0.500 m would do"), "{refusal}");
        }
        other => panic!("{other:?}"),
    }
}

#[test]
fn grippers_that_are_too_far_apart_may_come_closer_but_not_go_further() {
    let limits = MotionLimits { maximum_gripper_distance: 0.3, ..MotionLimits::default() };
    assert!((tip(Side::Left) - tip(Side::Right)).norm() > 0.3);
    assert!(step_right(Vector::new(0.0, 0.1, 0.0), &limits).is_ok());
    assert!(matches!(step_right(Vector::new(0.0, -0.1, 0.0), &limits), Err(MotionRefusal::GripperDistance { .. })));
}

#[test]
fn a_person_in_the_way_is_refused_by_name_with_the_distance() {
    let mut scene = Scene::default();
    let ahead = tip(Side::Right) + Vector::new(0.05, -0.15, 0.0);
    scene.person.push(BodyPart { name: "the person's head".into(), shape: Capsule::sphere(ahead, 0.05) });
    let refusal =
        plan_right_to(tip(Side::Right) + Vector::new(0.0, -0.15, 0.0), &scene, &MotionLimits::default()).unwrap_err();
    let MotionRefusal::Collision(found) = &refusal else { panic!("{refusal:?}") };
    assert_eq!(found.second, "the person's head");
    assert!(found.distance < found.least);
    let words = refusal.to_string();
    let further = format!("{:.3} m further off would do", found.least - found.distance);
    assert!(words.contains("the person's head") && words.contains(&further), "{words}");
}

#[test]
fn an_arm_that_is_too_close_already_may_leave_but_not_come_closer() {
    let tip = tip(Side::Right);
    let mut scene = Scene::default();
    let beside = tip - Vector::new(0.0, 0.07, 0.03);
    scene.person.push(BodyPart { name: "an elbow".into(), shape: Capsule::sphere(beside, 0.04) });
    let go = |step: Vector| plan_right_to(tip + step, &scene, &MotionLimits::default());
    assert!(go(Vector::new(0.0, 0.03, 0.05)).is_ok());
    assert!(matches!(go(Vector::new(0.0, -0.03, 0.0)), Err(MotionRefusal::Collision(_))));
}

#[test]
fn a_posture_outside_the_limits_is_refused_by_name() {
    let mut target = start().right;
    target[6] = 3.2;
    let targets = PerSide { left: None, right: Some(target) };
    let refusal = plan_postures(&MODEL, &Scene::default(), &start(), &targets, &MotionLimits::default()).unwrap_err();
    assert!(matches!(refusal, MotionRefusal::Joint { joint, .. } if joint == "right_w2"));
}

#[test]
fn a_turn_keeps_the_turning_speed() {
    let arm = MODEL.arm(Side::Right);
    let here = arm.forward(&start().right);
    let turned = UnitQuaternion::from_scaled_axis(Vector::z() * 0.8) * here.rotation;
    let target = Target { position: Point::from(here.translation.vector), orientation: Some(turned) };
    let targets = PerSide { left: None, right: Some(target) };
    let limits = MotionLimits { minimum_duration: std::time::Duration::ZERO, ..MotionLimits::default() };
    let motion = plan_pair(&MODEL, &Scene::default(), &start(), &targets, &limits).unwrap();
    assert!(motion.duration().as_secs_f64() > 0.8 / limits.turning_speed);
    let end = motion.sample(motion.duration()).right.pose;
    assert!(end.rotation.angle_to(&turned) < 1e-6);
    assert!((end.translation.vector - here.translation.vector).norm() < 1e-6);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]
    #[test]
    fn whatever_is_planned_keeps_every_limit(x in -0.2..0.2_f64, y in -0.2..0.2_f64, z in -0.3..0.1_f64) {
        let limits = MotionLimits::default();
        let Ok(motion) = step_right(Vector::new(x, y, z), &limits) else { return Ok(()) };
        prop_assert!(motion.duration() + std::time::Duration::from_micros(1) >= limits.minimum_duration);
        for index in 0..=200_u32 {
            let setpoints = motion.sample(motion.duration() * index / 200);
            for (side, setpoint) in setpoints.iter() {
                prop_assert!(MODEL.arm(side).limits().breach(&setpoint.joints, JOINT_TOLERANCE).is_none());
                prop_assert!(setpoint.velocity.abs().component_div(&limits.joint_speed).max() <= 1.0 + 1e-6);
                prop_assert!(setpoint.acceleration.abs().component_div(&limits.joint_acceleration).max() <= 1.0 + 1e-6);
            }
            let joints = setpoints.map(|_, setpoint| setpoint.joints);
            let found = MODEL.tightest(&joints, &Scene::default());
            prop_assert!(found.distance >= found.least - 2e-4, "{found:?}");
        }
    }
}
