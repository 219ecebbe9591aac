//! Checks a whole path of both arms against the rules that hold between the arms and their surroundings.

use super::JointVector;
use super::limits::MotionLimits;
use super::model::RobotModel;
use super::refusal::MotionRefusal;
use super::scene::Scene;
use crate::body::PerSide;

/// Numerical slack in metres for "no deeper than at the start".
const SLACK: f64 = 1e-4;

/// Checks each knot of both arms. An arm with fewer knots stays at its last one.
pub(super) fn check_path(
    model: &RobotModel,
    scene: &Scene,
    knots: &PerSide<Vec<JointVector>>,
    limits: &MotionLimits,
) -> Result<(), MotionRefusal> {
    let at = |index: usize| {
        PerSide::from_fn(|side| {
            let way = knots.get(side);
            way.get(index).or(way.last()).copied().unwrap_or_else(JointVector::zeros)
        })
    };
    let rules = Rules::new(model, scene, limits, &at(0));
    (0..knots.left.len().max(knots.right.len()))
        .try_for_each(|index| rules.check(&at(index), rules.least_room).map(|_| ()))
}

/// Checks one configuration, with no allowance for where it came from, and returns the metres that are left beyond those to keep,
/// or `most` (not negative) if there are more.
pub(super) fn room_at(
    model: &RobotModel,
    scene: &Scene,
    joints: &PerSide<JointVector>,
    limits: &MotionLimits,
    most: f64,
) -> Result<f64, MotionRefusal> {
    let grippers = (limits.minimum_gripper_distance, limits.maximum_gripper_distance);
    Rules { model, scene, grippers, allowed: grippers, least_room: 0.0 }.check(joints, most)
}

/// The rules between the arms and their surroundings, with the state at the start of a motion.
struct Rules<'a> {
    model: &'a RobotModel,
    scene: &'a Scene,
    grippers: (f64, f64),
    allowed: (f64, f64),
    least_room: f64,
}

impl<'a> Rules<'a> {
    fn new(model: &'a RobotModel, scene: &'a Scene, limits: &MotionLimits, start: &PerSide<JointVector>) -> Self {
        let grippers = (limits.minimum_gripper_distance, limits.maximum_gripper_distance);
        let placed = model.placed(start);
        let distance = placed.gripper_distance();
        // Where a rule is already broken, the motion may lead out of it but no deeper.
        let allowed = (grippers.0.min(distance) - SLACK, grippers.1.max(distance) + SLACK);
        let least_room = placed.tightest(0.0, scene).room - SLACK;
        Self { model, scene, grippers, allowed, least_room }
    }

    /// The metres that are left, or `most` if there are more.
    fn check(&self, joints: &PerSide<JointVector>, most: f64) -> Result<f64, MotionRefusal> {
        let placed = self.model.placed(joints);
        let distance = placed.gripper_distance();
        if !(self.allowed.0..=self.allowed.1).contains(&distance) {
            return Err(MotionRefusal::GripperDistance { distance, range: self.grippers });
        }
        let tightest = placed.tightest(most, self.scene);
        if tightest.room < self.least_room {
            return Err(placed.describe(&tightest, self.scene).into());
        }
        Ok(tightest.room)
    }
}
