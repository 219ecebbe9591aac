use super::*;
use crate::body::Side;
use crate::kinematics::RobotModel;
use nalgebra::Vector6;
use serde::Deserialize;
use std::collections::BTreeMap;

#[derive(Deserialize)]
struct Vectors {
    arms: BTreeMap<String, Vec<Case>>,
}

#[derive(Deserialize)]
struct Case {
    joints: [f64; JOINTS],
    position: [f64; 3],
    orientation: [f64; 4],
    jacobian: Option<[[f64; JOINTS]; 6]>,
}

fn vectors() -> Vectors {
    serde_json::from_str(include_str!("../../../tests/vectors/kinematics/forward.json")).unwrap()
}

fn cases(side: Side) -> Vec<Case> {
    vectors().arms.remove(side.name()).unwrap()
}

#[test]
fn forward_kinematics_agree_with_another_library_to_a_nanometre() {
    let model = RobotModel::baxter().unwrap();
    for side in Side::BOTH {
        let cases = cases(side);
        assert_eq!(cases.len(), 100);
        for case in cases {
            let pose = model.arm(side).forward(&JointVector::from(case.joints));
            assert!((pose.translation.vector - Vector3::from(case.position)).norm() < 1e-9);
            let [x, y, z, w] = case.orientation;
            let orientation = UnitQuaternion::from_quaternion(nalgebra::Quaternion::new(w, x, y, z));
            assert!(pose.rotation.angle_to(&orientation) < 1e-9);
        }
    }
}

#[test]
fn the_jacobian_agrees_with_another_library() {
    let model = RobotModel::baxter().unwrap();
    let mut compared = 0;
    for side in Side::BOTH {
        for case in cases(side) {
            let Some(rows) = case.jacobian else { continue };
            let frames = model.arm(side).chain.frames(&JointVector::from(case.joints));
            let expected = Jacobian::from_fn(|row, column| rows[row][column]);
            assert!((frames.jacobian() - expected).amax() < 1e-9);
            compared += 1;
        }
    }
    assert_eq!(compared, 4);
}

#[test]
fn the_jacobian_is_the_derivative_of_the_tip() {
    let model = RobotModel::baxter().unwrap();
    let joints = JointVector::from_column_slice(&[0.2, -0.6, 0.9, 1.1, -0.4, 0.8, 1.5]);
    let chain = &model.arm(Side::Left).chain;
    let frames = chain.frames(&joints);
    let step = 1e-6;
    for index in 0..JOINTS {
        let mut moved = joints;
        moved[index] += step;
        let twist: Vector6<f64> = super::super::inverse::twist_between(&frames.tip, &chain.frames(&moved).tip) / step;
        assert!((twist - frames.jacobian().column(index)).amax() < 1e-5);
    }
}

#[test]
fn an_axis_that_is_not_z_is_folded_into_the_chain() {
    let origins = |axis: Vector3<f64>| [(Pose::translation(0.1, 0.02, 0.3), axis); JOINTS];
    let tip = Pose::translation(0.0, 0.0, 0.2);
    let joints = JointVector::from_column_slice(&[0.3, -0.2, 0.5, 0.1, -0.7, 0.4, 0.9]);
    for axis in [Vector3::x(), -Vector3::y(), -Vector3::z(), Vector3::new(0.6, 0.0, 0.8)] {
        let expected = joints.iter().fold(Pose::identity(), |pose, angle| {
            pose * Pose::translation(0.1, 0.02, 0.3) * UnitQuaternion::from_scaled_axis(axis * *angle)
        }) * tip;
        let found = Chain::new(&origins(axis), &tip).tip_pose(&joints);
        assert!((found.translation.vector - expected.translation.vector).norm() < 1e-12);
        assert!(found.rotation.angle_to(&expected.rotation) < 1e-7);
    }
}
