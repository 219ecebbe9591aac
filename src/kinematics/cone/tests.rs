use super::*;
use crate::body::Side;
use crate::geometry::Pose;
use crate::kinematics::{InverseError, JointVector, RobotModel};
use nalgebra::{Translation3, UnitQuaternion};
use proptest::prelude::*;
use std::sync::LazyLock;

static MODEL: LazyLock<RobotModel> = LazyLock::new(|| RobotModel::baxter().unwrap());

/// The angles between two orientations as a tolerance has them: between the axes, and about the axis.
fn angles_between(from: &Frame, to: &Frame) -> OrientationTolerance {
    let (tilt, turn) = tilt_and_turn(from, to);
    OrientationTolerance { cone: tilt.norm(), turn: turn.abs() }
}

fn frame(turn: UnitQuaternion<f64>) -> Frame {
    Frame::from_pose(&Pose::from_parts(Translation3::identity(), turn))
}

/// A place that the right arm reaches only where its gripper may be tilted: the arm is nearly straight there.
fn far() -> Pose {
    let turn = UnitQuaternion::from_axis_angle(&Vector3::y_axis(), std::f64::consts::PI);
    Pose::from_parts(Translation3::new(1.02, -0.45, 0.25), turn)
}

#[test]
fn a_place_out_of_reach_with_one_orientation_is_reached_with_a_cone() {
    let arm = MODEL.arm(Side::Right);
    let seed = arm.limits().middle();
    assert!(matches!(arm.inverse(&far(), &seed), Err(InverseError::NotReached { .. })));
    let tolerance = OrientationTolerance { cone: 1.2, turn: 0.5 };
    let joints = arm.inverse_within(&far(), &tolerance, &seed).unwrap();
    let reached = arm.chain.frames(&joints).tip;
    let angles = angles_between(&reached, &Frame::from_pose(&far()));
    assert!((reached.translation - far().translation.vector).norm() < 1e-5);
    assert!(angles.cone <= 1.2 + 1e-5 && angles.turn <= 0.5 + 1e-5, "{angles:?}");
    assert!(arm.limits().breach(&joints, 0.0).is_none());
}

#[test]
fn a_tolerance_that_is_no_angle_is_refused() {
    let arm = MODEL.arm(Side::Left);
    for cone in [f64::NAN, -0.1, 4.0] {
        let tolerance = OrientationTolerance { cone, turn: 0.0 };
        let answer = arm.inverse_within(&arm.forward(&arm.limits().middle()), &tolerance, &arm.limits().middle());
        assert_eq!(answer, Err(InverseError::NotFinite), "{cone}");
    }
}

#[test]
fn opposite_axes_are_half_a_turn_apart() {
    let from = frame(UnitQuaternion::identity());
    let to = frame(UnitQuaternion::from_axis_angle(&Vector3::x_axis(), std::f64::consts::PI));
    assert!((angles_between(&from, &to).cone - std::f64::consts::PI).abs() < 1e-9);
}

proptest! {
    #[test]
    fn tilt_and_turn_make_up_the_rotation(
        from in proptest::array::uniform3(-2.0..2.0_f64),
        to in proptest::array::uniform3(-2.0..2.0_f64),
    ) {
        let (from, to) = (frame(UnitQuaternion::from_scaled_axis(from.into())), frame(UnitQuaternion::from_scaled_axis(to.into())));
        let (tilt, turn) = tilt_and_turn(&from, &to);
        let axis: Vector3<f64> = to.rotation.column(2).into();
        let rebuilt = nalgebra::Rotation3::new(axis * turn).matrix() * nalgebra::Rotation3::new(tilt).matrix() * from.rotation;
        prop_assert!((rebuilt - to.rotation).amax() < 1e-6, "{rebuilt}");
    }

    #[test]
    fn what_is_found_lies_inside_the_tolerance_and_the_limits(
        share in proptest::array::uniform7(0.05..0.95_f64), cone in 0.0..0.8_f64, turn in 0.0..0.8_f64,
    ) {
        let arm = MODEL.arm(Side::Right);
        let limits = arm.limits();
        let target = arm.forward(&(limits.lower + JointVector::from(share).component_mul(&(limits.upper - limits.lower))));
        let joints = arm.inverse_within(&target, &OrientationTolerance { cone, turn }, &limits.middle());
        let joints = joints.map_err(|error| TestCaseError::fail(error.to_string()))?;
        let reached = arm.chain.frames(&joints).tip;
        let angles = angles_between(&reached, &Frame::from_pose(&target));
        prop_assert!((reached.translation - target.translation.vector).norm() < 1e-5);
        prop_assert!(angles.cone <= cone + 1e-5 && angles.turn <= turn + 1e-5, "{angles:?}");
        prop_assert!(limits.breach(&joints, 0.0).is_none());
    }
}
