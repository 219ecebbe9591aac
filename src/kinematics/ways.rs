//! Motions along ways that another planner has found: the same limits, checks and timing as for a plan of our own.
//!
//! Nothing is taken on trust: a way that does not begin where the arm is, leaves its line, jumps, ends elsewhere or comes too
//! close to anything is refused.

use super::JointVector;
use super::limits::MotionLimits;
use super::line::shares;
use super::line::{JUMP, Line};
use super::model::{ArmModel, RobotModel};
use super::motion::PairMotion;
use super::path::JointPath;
use super::plan::{Target, checked_start, extent_of, finish, lines_of, spans_of};
use super::refusal::MotionRefusal;
use super::scene::Scene;
use crate::body::{PerSide, Side};

/// Joint positions (radians) one after the other along each arm's line, evenly spaced; `None` for an arm that stays.
pub type Ways = PerSide<Option<Vec<JointVector>>>;

/// How far a way may begin from where the arm is, radians: the control error of the robot (0.5°) and a little more.
const START: f64 = 0.01;
/// How far a gripper may leave its line on another planner's way, in metres and radians. Between points 5 mm apart, as they are
/// asked for, joints that turn evenly leave a line by less than a tenth of this.
const DEVIATION: f64 = 2e-3;

/// A motion of both arms in step along ways that another planner has found for straight lines to the targets.
///
/// # Errors
/// [`MotionRefusal::Planner`] where a way is not what was asked for, else as [`super::plan_pair`].
pub fn plan_through(
    model: &RobotModel,
    scene: &Scene,
    start: &PerSide<JointVector>,
    targets: &PerSide<Option<Target>>,
    ways: &Ways,
    limits: &MotionLimits,
) -> Result<PairMotion, MotionRefusal> {
    let start = checked_start(model, start)?;
    let lines = lines_of(model, &start, targets, limits)?;
    let spans = spans_of(&lines);
    let knots = |side: Side| match (lines.get(side), ways.get(side)) {
        (None, _) => Ok(vec![*start.get(side)]),
        (Some(_), None) => Err(refused(side, "has no way")),
        (Some(line), Some(way)) => resampled(model.arm(side), line, start.get(side), way, spans),
    };
    let knots = PerSide { left: knots(Side::Left)?, right: knots(Side::Right)? };
    finish(model, scene, knots, extent_of(&lines), limits)
}

/// A way with knots as many as both arms' lines need, after it was checked against its line.
fn resampled(
    arm: &ArmModel,
    line: &Line,
    start: &JointVector,
    way: &[JointVector],
    spans: f64,
) -> Result<Vec<JointVector>, MotionRefusal> {
    let side = arm.side();
    let (Some(first), Some(last)) = (way.first(), way.last()) else { return Err(refused(side, "has an empty way")) };
    if way.iter().any(|joints| joints.iter().any(|value| !value.is_finite())) {
        return Err(refused(side, "has a way with numbers that are not finite"));
    }
    if (first - start).amax() > START {
        return Err(refused(side, "has a way that begins elsewhere than the arm is"));
    }
    if way.iter().zip(way.iter().skip(1)).any(|(one, next)| (next - one).amax() > JUMP) {
        return Err(refused(side, "has a way that jumps to another posture"));
    }
    let end = line.deviation(&arm.forward(last), Some(1.0));
    if end > DEVIATION {
        return Err(refused(side, &format!("has a way that ends {end:.4} m or rad from its target")));
    }
    // The way begins exactly where the arm is.
    let mut way = way.to_vec();
    if let Some(first) = way.first_mut() {
        *first = *start;
    }
    let path = JointPath::through(way).ok_or_else(|| refused(side, "has an empty way"))?;
    let knots: Vec<_> = shares(spans).map(|share| path.at(share).joints).collect();
    match knots.iter().map(|joints| line.deviation(&arm.forward(joints), None)).fold(0.0, f64::max) {
        far if far > DEVIATION => Err(refused(side, &format!("has a way that leaves its line by {far:.4} m or rad"))),
        _ => Ok(knots),
    }
}

fn refused(side: Side, what: &str) -> MotionRefusal {
    MotionRefusal::Planner { reason: format!("the {side} arm {what}") }
}

#[cfg(test)]
mod tests;
