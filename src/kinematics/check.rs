//! Checks a whole path of both arms against the rules that hold between the arms and their surroundings.

use super::JointVector;
use super::limits::MotionLimits;
use super::model::RobotModel;
use super::refusal::MotionRefusal;
use super::scene::Scene;
use crate::body::{PerSide, Side};
use crate::geometry::Point;

/// Numerical slack in metres for "no deeper than at the start".
const SLACK: f64 = 1e-4;

/// Checks each knot of both arms. An arm with a single knot stays.
pub(super) fn check_path(
    model: &RobotModel,
    _scene: &Scene,
    knots: &PerSide<Vec<JointVector>>,
    limits: &MotionLimits,
) -> Result<(), MotionRefusal> {
    let count = knots.left.len().max(knots.right.len());
    let mut at_start = None;
    for index in 0..count {
        let tips = PerSide::from_fn(|side: Side| {
            let way = knots.get(side);
            let joints = way.get(index).or(way.last()).copied().unwrap_or_else(JointVector::zeros);
            Point::from(model.arm(side).forward(&joints).translation.vector)
        });
        let distance = (tips.left - tips.right).norm();
        let first = *at_start.get_or_insert(distance);
        let range = (limits.minimum_gripper_distance, limits.maximum_gripper_distance);
        let allowed = (range.0.min(first) - SLACK, range.1.max(first) + SLACK);
        if !(allowed.0..=allowed.1).contains(&distance) {
            return Err(MotionRefusal::GripperDistance { distance, range });
        }
    }
    Ok(())
}
