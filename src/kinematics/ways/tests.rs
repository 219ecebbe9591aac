use super::*;
use crate::geometry::Point;
use crate::kinematics::{dressing_orientation, plan_pair, start_postures};
use std::time::Duration;

struct Asked {
    model: RobotModel,
    limits: MotionLimits,
    start: PerSide<JointVector>,
    targets: PerSide<Option<Target>>,
    ways: Ways,
}

/// Both grippers 0.2 m down, and the ways that our own planner would take, in 40 steps.
fn asked() -> Asked {
    let model = RobotModel::baxter().unwrap();
    let limits = MotionLimits::default();
    let place = |z: f64| PerSide { left: Point::new(0.65, 0.2, z), right: Point::new(0.65, -0.2, z) };
    let orientations = PerSide { left: dressing_orientation(), right: dressing_orientation() };
    let stages = [place(0.1), place(-0.1)];
    let start = start_postures(&model, &Scene::default(), &stages, &orientations, &limits).unwrap();
    let targets = place(-0.1).map(|_, point| Some(Target::position(*point)));
    let own = plan_pair(&model, &Scene::default(), &start, &targets, &limits).unwrap();
    let ways = PerSide::from_fn(|side| {
        let path = &own.arms.get(side).path;
        Some((0..=40).map(|index| path.at(f64::from(index) / 40.0).joints).collect())
    });
    Asked { model, limits, start, targets, ways }
}

fn plan(asked: &Asked) -> Result<PairMotion, MotionRefusal> {
    plan_through(&asked.model, &Scene::default(), &asked.start, &asked.targets, &asked.ways, &asked.limits)
}

fn words(asked: &Asked) -> String {
    plan(asked).unwrap_err().to_string()
}

#[test]
fn a_way_of_another_planner_is_driven_in_step_to_its_target() {
    let asked = asked();
    let motion = plan(&asked).unwrap();
    let end = motion.sample(motion.duration());
    for (side, setpoint) in end.iter() {
        let target = asked.targets.get(side).unwrap().position;
        assert!((setpoint.pose.translation.vector - target.coords).norm() < 1e-4, "{side}");
        assert!(setpoint.velocity.norm() < 1e-9);
    }
    assert!((motion.sample(Duration::ZERO).left.joints - asked.start.left).amax() < 1e-9);
}

#[test]
fn a_way_that_is_missing_empty_or_no_number_is_refused() {
    let mut asked = asked();
    asked.ways.left = None;
    assert!(words(&asked).contains("left arm has no way"));
    asked.ways.left = Some(Vec::new());
    assert!(words(&asked).contains("empty way"));
    asked.ways.left = Some(vec![asked.start.left, JointVector::repeat(f64::NAN)]);
    assert!(words(&asked).contains("not finite"));
}

#[test]
fn a_way_that_begins_or_ends_elsewhere_is_refused() {
    let mut asked = asked();
    let whole = asked.ways.right.clone().unwrap();
    asked.ways.right = Some(whole[3..].to_vec());
    assert!(words(&asked).contains("begins elsewhere"), "{}", words(&asked));
    asked.ways.right = Some(whole[..30].to_vec());
    assert!(words(&asked).contains("ends 0.0"), "{}", words(&asked));
}

#[test]
fn a_way_that_jumps_or_leaves_its_line_is_refused() {
    let mut asked = asked();
    let whole = asked.ways.right.clone().unwrap();
    let mut jumping = whole.clone();
    jumping[20][6] += 0.5;
    asked.ways.right = Some(jumping);
    assert!(words(&asked).contains("jumps"));
    let mut bent = whole;
    for (index, joints) in bent.iter_mut().enumerate() {
        joints[1] += 0.02 * (std::f64::consts::PI * index as f64 / 40.0).sin();
    }
    asked.ways.right = Some(bent);
    assert!(words(&asked).contains("leaves its line by 0.0"), "{}", words(&asked));
}

#[test]
fn a_way_into_the_person_is_refused_as_any_other_plan() {
    use crate::kinematics::{BodyPart, Capsule};
    let asked = asked();
    let shape = Capsule::sphere(Point::new(0.65, -0.2, -0.1), 0.1);
    let scene = Scene { person: vec![BodyPart { name: "the person's knee".into(), shape }], ..Scene::default() };
    let refusal = plan_through(&asked.model, &scene, &asked.start, &asked.targets, &asked.ways, &asked.limits);
    assert!(refusal.unwrap_err().to_string().contains("knee"));
}
