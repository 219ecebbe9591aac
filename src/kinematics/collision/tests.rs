use crate::body::{PerSide, Side};
use crate::geometry::{Point, Vector};
use crate::kinematics::{BAXTER_URDF, BodyPart, Capsule, JointVector, RobotModel, Scene, Tool};

/// The posture to which the SDK's `move_to_neutral` brings both arms.
const NEUTRAL: [f64; 7] = [0.0, -0.55, 0.0, 0.75, 0.0, 1.26, 0.0];
/// The postures of the SDK's `tuck_arms`, right arm: left has s0, e0, w0 and w2 mirrored.
const UNTUCKED: [f64; 7] = [0.08, -1.0, 1.19, 1.94, -0.67, 1.03, 0.50];

/// The first posture of the SDK's `joint_trajectory_client`, right arm.
const TRAJECTORY_DEMO: [f64; 7] = [0.11, -0.62, 1.15, 1.32, -0.80, 1.27, -2.39];

fn mirrored(right: [f64; 7]) -> PerSide<JointVector> {
    let signs = JointVector::from([-1.0, 1.0, -1.0, 1.0, -1.0, 1.0, -1.0]);
    let right = JointVector::from(right);
    PerSide { left: right.component_mul(&signs), right }
}

#[test]
fn the_postures_of_the_sdk_are_free_of_contact() {
    for posture in [NEUTRAL, UNTUCKED, TRAJECTORY_DEMO] {
        let found = RobotModel::baxter().unwrap().tightest(&mirrored(posture), &Scene::default());
        assert!(found.distance >= found.least, "{found:?}");
    }
}

#[test]
fn arms_that_cross_are_seen() {
    let mut joints = mirrored(NEUTRAL);
    joints.left[0] = -1.2;
    joints.right[0] = 1.2;
    let found = RobotModel::baxter().unwrap().tightest(&joints, &Scene::default());
    assert!(found.distance < 0.0, "{found:?}");
    assert!(found.first.starts_with("the robot's left") && found.second.starts_with("the robot's right"), "{found:?}");
}

#[test]
fn an_arm_folded_into_the_head_is_seen() {
    let model = RobotModel::baxter().unwrap();
    let mut joints = mirrored(UNTUCKED);
    // The elbow up and bent, the forearm across the head.
    joints.right = JointVector::from([1.0, -1.6, 0.0, 2.3, 0.0, 0.0, 0.0]);
    let found = model.tightest(&joints, &Scene::default());
    assert!(found.distance < found.least, "{found:?}");
    assert_eq!(found.second, "the robot's head");
}

#[test]
fn a_person_closer_than_the_margin_is_seen() {
    let model = RobotModel::baxter().unwrap();
    let joints = mirrored(UNTUCKED);
    let tip = Point::from(model.arm(Side::Right).forward(&joints.right).translation.vector);
    let mut scene = Scene::default();
    let far = model.tightest(&joints, &scene);
    scene.person.push(BodyPart { name: "a hand".into(), shape: Capsule::sphere(tip - Vector::z() * 0.05, 0.03) });
    let close = model.tightest(&joints, &scene);
    assert!(close.distance < scene.margin && close.distance < far.distance);
    assert_eq!(close.second, "a hand");
}

#[test]
fn a_longer_tool_is_longer_in_the_check() {
    let tools = PerSide { left: Tool::ElectricExtended, right: Tool::ElectricExtended };
    let model = RobotModel::from_urdf(BAXTER_URDF, tools).unwrap();
    let joints = mirrored(UNTUCKED);
    let tip = Point::from(model.arm(Side::Right).forward(&joints.right).translation.vector);
    let mut scene = Scene::default();
    scene.person.push(BodyPart { name: "a finger".into(), shape: Capsule::sphere(tip, 0.01) });
    let found = model.tightest(&joints, &scene);
    assert_eq!(found.first, "the robot's right tool");
    assert!((found.distance + 0.01).abs() < 1e-9, "{found:?}");
}

#[test]
fn a_joint_that_is_not_a_number_counts_as_contact() {
    let mut joints = mirrored(NEUTRAL);
    joints.left[2] = f64::NAN;
    assert!(RobotModel::baxter().unwrap().tightest(&joints, &Scene::default()).distance < 0.0);
}
