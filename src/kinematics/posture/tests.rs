use super::search::{Course, confirm};
use super::*;
use crate::kinematics::{BodyPart, Capsule, PairMotion, Target, plan_pair};
use serde::Deserialize;

#[derive(Deserialize)]
struct Vectors {
    paths: Vec<Path>,
}

#[derive(Deserialize)]
struct Path {
    hand: [f64; 3],
    elbow: [f64; 3],
    shoulder: [f64; 3],
}

/// The right arms of twelve virtual participants: hand, elbow, shoulder in `base`.
fn paths() -> Vec<[Point; 3]> {
    let vectors: Vectors =
        serde_json::from_str(include_str!("../../../tests/vectors/kinematics/dressing_paths.json")).unwrap();
    vectors.paths.iter().map(|path| [path.hand, path.elbow, path.shoulder].map(Point::from)).collect()
}

#[test]
fn the_grippers_point_forward_and_thirty_degrees_down() {
    let approach = dressing_orientation() * Vector3::z();
    assert!((approach - Vector3::new(0.75_f64.sqrt(), 0.0, -0.5)).norm() < 1e-12);
}

fn mirrored(point: &Point) -> Point {
    Point::new(point.x, -point.y, point.z)
}

/// Hand, elbow and shoulder of one side with the other gripper waiting behind that shoulder.
fn stages(side: Side, [hand, elbow, shoulder]: [Point; 3]) -> Vec<PerSide<Point>> {
    let place = |point: Point| if side == Side::Right { point } else { mirrored(&point) };
    let wait = waiting_place(&place(shoulder));
    [hand, elbow, shoulder]
        .map(|point| PerSide::from_fn(|each| if each == side { place(point) } else { wait }))
        .to_vec()
}

fn orientations() -> PerSide<UnitQuaternion<f64>> {
    PerSide { left: dressing_orientation(), right: dressing_orientation() }
}

/// Plans all stages one after the other and returns the motions.
fn plan_all(model: &RobotModel, stages: &[PerSide<Point>], limits: &MotionLimits) -> Vec<PairMotion> {
    let scene = Scene::default();
    let mut here = start_postures(model, &scene, stages, &orientations(), limits).unwrap();
    let plan = |stage: &PerSide<Point>| {
        let targets = stage.map(|_, point| Some(Target::position(*point)));
        let motion = plan_pair(model, &scene, &here, &targets, limits).unwrap();
        here = motion.sample(motion.duration()).map(|_, setpoint| setpoint.joints);
        motion
    };
    stages.iter().skip(1).map(plan).collect()
}

#[test]
fn every_dressing_path_is_tracked_with_the_other_gripper_behind_the_shoulder() {
    let model = RobotModel::baxter().unwrap();
    let limits = MotionLimits::default();
    for path in paths() {
        for side in Side::BOTH {
            let stages = stages(side, path);
            let motions = plan_all(&model, &stages, &limits);
            assert_eq!(motions.len(), 2);
            for (motion, stage) in motions.iter().zip(stages.iter().skip(1)) {
                let end = motion.sample(motion.duration());
                for (side, setpoint) in end.iter() {
                    assert!((setpoint.pose.translation.vector - stage.get(side).coords).norm() < 1e-5);
                    assert!(setpoint.pose.rotation.angle_to(&dressing_orientation()) < 1e-5);
                    assert!(model.arm(side).limits().breach(&setpoint.joints, 0.0).is_none());
                }
                let distance = (end.left.pose.translation.vector - end.right.pose.translation.vector).norm();
                assert!((limits.minimum_gripper_distance..=limits.maximum_gripper_distance).contains(&distance));
            }
        }
    }
}

#[test]
fn a_way_that_no_posture_can_follow_is_refused_with_the_place() {
    let model = RobotModel::baxter().unwrap();
    let mut stages = stages(Side::Right, paths()[0]);
    stages.push(PerSide { left: stages[2].left, right: Point::new(0.8, -2.5, 0.0) });
    match start_postures(&model, &Scene::default(), &stages, &orientations(), &MotionLimits::default()) {
        Err(MotionRefusal::OutOfReach { side: Side::Right, place, .. }) => assert!(place.y < -0.8),
        other => panic!("{other:?}"),
    }
}

#[test]
fn no_stages_or_stages_that_are_no_numbers_are_refused() {
    let model = RobotModel::baxter().unwrap();
    let ask = |stages: &[PerSide<Point>]| {
        start_postures(&model, &Scene::default(), stages, &orientations(), &MotionLimits::default())
    };
    assert!(matches!(ask(&[]), Err(MotionRefusal::NotFinite { .. })));
    let mut stages = stages(Side::Right, paths()[0]);
    stages[1].right.z = f64::NAN;
    assert!(matches!(ask(&stages), Err(MotionRefusal::NotFinite { side: Side::Right })));
}

/// A person whose shoulder is where the way ends: the trunk hangs below it, towards the middle.
fn seated_beside(path: [Point; 3]) -> Scene {
    let top = path[2] + Vector3::new(0.0, 0.17, -0.12);
    let shape = Capsule { start: top, end: top - Vector3::z() * 0.55, radius: 0.11 };
    Scene { person: vec![BodyPart { name: "the person's trunk".into(), shape }], ..Scene::default() }
}

#[test]
fn grippers_are_turned_inwards_where_that_leaves_more_room_beside_the_trunk() {
    let model = RobotModel::baxter().unwrap();
    let limits = MotionLimits::default();
    let scene = seated_beside(paths()[0]);
    let stages = stages(Side::Right, paths()[0]);
    let legs = [Leg { scene: &scene, stages: &stages }];
    let straight = roomiest_start(&model, &legs, &orientations(), &limits, f64::NEG_INFINITY).unwrap().unwrap();
    let joints = dressing_postures(&model, &legs, &limits).unwrap();
    let turned = PerSide::from_fn(|side| model.arm(side).forward(joints.get(side)).rotation);
    let angle = turned.map(|_, rotation| rotation.angle_to(&dressing_orientation()).to_degrees());
    assert!((angle.left - angle.right).abs() < 1e-3, "both are turned alike: {angle:?}");
    assert!(angle.right > 4.0, "{angle:?}");
    let points = turned.map(|_, rotation| rotation * Vector3::z());
    assert!(points.left.y < 0.0 && points.right.y > 0.0, "towards the middle: {points:?}");
    let chosen = roomiest_start(&model, &legs, &turned, &limits, f64::NEG_INFINITY).unwrap().unwrap();
    assert!(chosen.room > straight.room, "{} against {}", chosen.room, straight.room);
}

#[test]
fn a_search_with_something_to_beat_finds_the_same_start_or_none() {
    let model = RobotModel::baxter().unwrap();
    let limits = MotionLimits::default();
    let scene = seated_beside(paths()[0]);
    let stages = stages(Side::Right, paths()[0]);
    let legs = [Leg { scene: &scene, stages: &stages }];
    let search = |to_beat| roomiest_start(&model, &legs, &orientations(), &limits, to_beat).unwrap();
    let all = search(f64::NEG_INFINITY).unwrap();
    let with_less_to_beat = search(all.room - 1e-6).unwrap();
    assert_eq!((with_less_to_beat.joints, with_less_to_beat.room.to_bits()), (all.joints, all.room.to_bits()));
    assert!(search(all.room).is_none(), "nothing has more room than the roomiest");
}

#[test]
fn what_was_chosen_at_knots_far_apart_keeps_its_room_at_those_of_a_plan() {
    let model = RobotModel::baxter().unwrap();
    let limits = MotionLimits::default();
    for path in paths() {
        let scene = seated_beside(path);
        let stages = stages(Side::Right, path);
        let legs = [Leg { scene: &scene, stages: &stages }];
        let chosen = roomiest_start(&model, &legs, &orientations(), &limits, f64::NEG_INFINITY).unwrap().unwrap();
        let room = confirm(&model, &Course::new(&legs, &orientations(), 1.0), &chosen.joints, &limits).unwrap();
        assert!((room - chosen.room).abs() < 1e-3, "{room} is not {}", chosen.room);
    }
}

#[test]
fn a_way_that_no_turn_makes_possible_is_refused_as_without_a_turn() {
    let model = RobotModel::baxter().unwrap();
    let limits = MotionLimits::default();
    let mut stages = stages(Side::Right, paths()[0]);
    stages.push(PerSide { left: stages[2].left, right: Point::new(0.8, -2.5, 0.0) });
    let scene = Scene::default();
    let legs = [Leg { scene: &scene, stages: &stages }];
    let refusal = dressing_postures(&model, &legs, &limits).unwrap_err();
    assert_eq!(refusal, start_postures_for(&model, &legs, &orientations(), &limits).unwrap_err());
}
