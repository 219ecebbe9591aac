use super::*;
use crate::body::Side;
use crate::kinematics::RobotModel;
use proptest::prelude::*;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use std::sync::LazyLock;

static MODEL: LazyLock<RobotModel> = LazyLock::new(|| RobotModel::baxter().unwrap());

fn random_joints(arm: &ArmModel, random: &mut ChaCha8Rng) -> JointVector {
    let limits = arm.limits();
    JointVector::from_fn(|index, _| random.random_range(limits.lower[index]..limits.upper[index]))
}

fn reached(arm: &ArmModel, joints: &JointVector, target: &Pose) -> bool {
    let error = twist_between(&arm.chain.frames(joints).tip, &Frame::from_pose(target));
    error.amax() <= 1e-5 && arm.limits().breach(joints, 0.0).is_none()
}

#[test]
fn every_one_of_a_thousand_reachable_poses_is_solved_inside_the_limits() {
    for side in Side::BOTH {
        let arm = MODEL.arm(side);
        let mut random = ChaCha8Rng::seed_from_u64(7);
        let seed = arm.limits().middle();
        for index in 0..1000 {
            let target = arm.forward(&random_joints(arm, &mut random));
            let joints = arm.inverse(&target, &seed).unwrap_or_else(|error| panic!("{side} {index}: {error}"));
            assert!(reached(arm, &joints, &target), "{side} {index}");
        }
    }
}

#[test]
fn a_warm_seed_keeps_the_posture() {
    let arm = MODEL.arm(Side::Right);
    let mut random = ChaCha8Rng::seed_from_u64(3);
    for _ in 0..200 {
        let seed = random_joints(arm, &mut random) * 0.8;
        let target = Pose::translation(0.001, -0.001, 0.001) * arm.forward(&seed);
        if let Ok(joints) = arm.inverse(&target, &seed) {
            assert!(reached(arm, &joints, &target));
        }
    }
    let seed = JointVector::from_column_slice(&[0.1, -0.6, 1.1, 1.3, -0.8, 1.2, 0.4]);
    let target = Pose::translation(0.002, 0.0, 0.0) * arm.forward(&seed);
    let joints = arm.inverse(&target, &seed).unwrap();
    assert!((joints - seed).amax() < 0.03);
}

#[test]
fn a_pose_out_of_reach_is_refused_with_the_nearest_one() {
    let arm = MODEL.arm(Side::Left);
    let target = Pose::translation(3.0, 0.3, 0.4);
    match arm.inverse(&target, &arm.limits().middle()) {
        Err(InverseError::NotReached { position_error, nearest, .. }) => {
            let tip = arm.forward(&nearest).translation.vector;
            assert!(arm.limits().breach(&nearest, 0.0).is_none());
            assert!((1.5..3.0).contains(&position_error), "{position_error}");
            assert!(tip.x > 0.5, "the arm reaches towards the target: {tip:?}");
        }
        other => panic!("{other:?}"),
    }
}

#[test]
fn numbers_that_are_not_finite_are_refused() {
    let arm = MODEL.arm(Side::Left);
    let middle = arm.limits().middle();
    let mut target = arm.forward(&middle);
    let mut seed = middle;
    seed[3] = f64::NAN;
    assert_eq!(arm.inverse(&target, &seed), Err(InverseError::NotFinite));
    target.translation.vector.y = f64::INFINITY;
    assert_eq!(arm.inverse(&target, &middle), Err(InverseError::NotFinite));
}

#[test]
fn the_same_question_has_the_same_answer() {
    let arm = MODEL.arm(Side::Right);
    let other = RobotModel::baxter().unwrap();
    let mut random = ChaCha8Rng::seed_from_u64(11);
    for _ in 0..50 {
        let target = arm.forward(&random_joints(arm, &mut random));
        let seed = arm.limits().middle();
        assert_eq!(arm.inverse(&target, &seed), other.arm(Side::Right).inverse(&target, &seed));
    }
}

proptest! {
    #[test]
    fn the_rotation_vector_undoes_the_exponential(x in -1.0..1.0_f64, y in -1.0..1.0_f64, z in -1.0..1.0_f64, angle in 0.0..3.1_f64) {
        prop_assume!(x * x + y * y + z * z > 1e-4);
        let vector = Vector3::new(x, y, z).normalize() * angle;
        let rotation = *UnitQuaternion::from_scaled_axis(vector).to_rotation_matrix().matrix();
        prop_assert!((rotation_vector(&rotation) - vector).norm() < 1e-7);
    }

    #[test]
    fn a_projected_step_never_leaves_the_joint_limits(shares in proptest::array::uniform7(0.0..1.0_f64), error in proptest::array::uniform6(-2.0..2.0_f64)) {
        let arm = MODEL.arm(Side::Left);
        let limits = arm.limits();
        let joints = limits.lower + JointVector::from(shares).component_mul(&(limits.upper - limits.lower));
        let jacobian = arm.chain.frames(&joints).jacobian();
        let next = projected_step(limits, &jacobian, &joints, Vector6::from(error), 1e-3);
        prop_assert!(limits.breach(&next, 0.0).is_none());
    }
}
