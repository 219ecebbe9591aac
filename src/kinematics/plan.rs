//! Plans motions of both arms in step: straight lines of the grippers, or from posture to posture.
//!
//! A plan is checked from its start to its end before it is handed out: reach, joint limits, workspace, the distance between
//! the grippers, and everything that must not touch. What cannot be done is refused with what and why.

use super::JointVector;
use super::limits::{JOINT_TOLERANCE, MotionLimits};
use super::line::{DOUBLINGS, KNOT_ANGLE, Line, MOST_KNOTS, shares};
use super::model::{ArmModel, RobotModel};
use super::motion::{ArmMotion, Braking, PairMotion};
use super::path::JointPath;
use super::refusal::MotionRefusal;
use super::scene::Scene;
use super::timing::{PathLimits, PathTiming};
use crate::body::{PerSide, Side};
use crate::geometry::{Finite, Point, Pose};
use nalgebra::{Isometry3, Translation3, UnitQuaternion};
use serde::{Deserialize, Serialize};

/// Share of the limits that a plan uses: between the places where a path's slope is looked at it may be a little steeper.
const HEADROOM: f64 = 0.95;
/// A path of no extent takes the minimum duration whatever its limits are; they must only be finite.
const MOST: f64 = 1e3;
/// How far outside its range (radians) a measured joint may be: encoder steps and the robot's own control error (0.5°).
const START_TOLERANCE: f64 = 0.009;

/// Where a gripper is to go.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Target {
    /// Position of the tip in `base`, metres.
    pub position: Point,
    /// Orientation of the tip in `base`; `None` keeps the present one.
    pub orientation: Option<UnitQuaternion<f64>>,
}

impl Target {
    /// A position at the present orientation.
    #[must_use]
    pub const fn position(position: Point) -> Self {
        Self { position, orientation: None }
    }
}

/// A motion of both arms in step from `start` (joint positions in radians) along straight lines to the targets. An arm without
/// a target stays where it is. The motion starts and ends at rest.
///
/// Where an arm is already outside a distance rule (grippers, person), the motion may lead out of it but no deeper.
///
/// # Errors
/// A [`MotionRefusal`] that says what is in the way, with the values, before anything moves.
pub fn plan_pair(
    model: &RobotModel,
    scene: &Scene,
    start: &PerSide<JointVector>,
    targets: &PerSide<Option<Target>>,
    limits: &MotionLimits,
) -> Result<PairMotion, MotionRefusal> {
    let start = checked_start(model, start)?;
    let lines = lines_of(model, &start, targets, limits)?;
    let paths = follow_lines(model, &lines, &start, spans_of(&lines))?;
    finish(model, scene, paths, extent_of(&lines), limits)
}

/// The lines from where the grippers are to their targets; `None` for an arm that stays.
pub(super) fn lines_of(
    model: &RobotModel,
    start: &PerSide<JointVector>,
    targets: &PerSide<Option<Target>>,
    limits: &MotionLimits,
) -> Result<PerSide<Option<Line>>, MotionRefusal> {
    Ok(PerSide {
        left: line(model.arm(Side::Left), &start.left, targets.left, limits)?,
        right: line(model.arm(Side::Right), &start.right, targets.right, limits)?,
    })
}

/// As many spans as the line that needs more.
pub(super) fn spans_of(lines: &PerSide<Option<Line>>) -> f64 {
    Side::BOTH.into_iter().filter_map(|side| lines.get(side).as_ref().map(Line::spans)).fold(1.0, f64::max)
}

pub(super) fn extent_of(lines: &PerSide<Option<Line>>) -> PerSide<Extent> {
    PerSide::from_fn(|side| {
        lines.get(side).as_ref().map_or(Extent::default(), |line| Extent { metres: line.length, radians: line.angle })
    })
}

/// The knots of both arms along their lines, as many as the lines need to be kept.
fn follow_lines(
    model: &RobotModel,
    lines: &PerSide<Option<Line>>,
    start: &PerSide<JointVector>,
    spans: f64,
) -> Result<PerSide<Vec<JointVector>>, MotionRefusal> {
    let mut doublings = 0;
    loop {
        let spans = spans * f64::from(1 << doublings);
        let track = |side: Side| match lines.get(side) {
            None => Ok(vec![*start.get(side)]),
            Some(line) => model.arm(side).follow_line(line, start.get(side), spans),
        };
        let paths = PerSide { left: track(Side::Left)?, right: track(Side::Right)? };
        let keeps = |side: Side| match (lines.get(side), JointPath::through(paths.get(side).clone())) {
            (Some(line), Some(path)) => model.arm(side).keeps_to(line, &path),
            _ => true,
        };
        if doublings == DOUBLINGS || Side::BOTH.into_iter().all(keeps) {
            return Ok(paths);
        }
        doublings += 1;
    }
}

/// A motion of both arms in step from posture to posture, each joint on its own straight way. An arm without a target stays.
///
/// For moves between trials, when no garment hangs between the grippers: the grippers do not follow straight lines. Limits and
/// checks are those of [`plan_pair`].
///
/// # Errors
/// A [`MotionRefusal`] as from [`plan_pair`].
pub fn plan_postures(
    model: &RobotModel,
    scene: &Scene,
    start: &PerSide<JointVector>,
    targets: &PerSide<Option<JointVector>>,
    limits: &MotionLimits,
) -> Result<PairMotion, MotionRefusal> {
    let start = checked_start(model, start)?;
    for (side, target) in targets.iter() {
        if let Some(target) = target {
            check_posture(model.arm(side), target, 0.0)?;
        }
    }
    let turn = |side: Side| targets.get(side).map_or(0.0, |target| (target - start.get(side)).amax());
    let spans = (turn(Side::Left).max(turn(Side::Right)) / KNOT_ANGLE).ceil().clamp(1.0, MOST_KNOTS);
    let paths = PerSide::from_fn(|side| match targets.get(side) {
        None => vec![*start.get(side)],
        Some(target) => shares(spans).map(|share| start.get(side).lerp(target, share)).collect(),
    });
    let extent = PerSide::from_fn(|side| swept(model.arm(side), paths.get(side)));
    finish(model, scene, paths, extent, limits)
}

/// The fastest that a gripper moves per unit of the path's parameter.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Extent {
    metres: f64,
    radians: f64,
}

pub(super) fn checked_start(
    model: &RobotModel,
    start: &PerSide<JointVector>,
) -> Result<PerSide<JointVector>, MotionRefusal> {
    for (side, joints) in start.iter() {
        check_posture(model.arm(side), joints, START_TOLERANCE)?;
    }
    // What is inside the tolerance is measurement error: the motion itself starts inside the range.
    Ok(start.map(|side, joints| {
        let limits = model.arm(side).limits();
        joints.zip_zip_map(&limits.lower, &limits.upper, f64::clamp)
    }))
}

fn check_posture(arm: &ArmModel, joints: &JointVector, tolerance: f64) -> Result<(), MotionRefusal> {
    match arm.limits().breach(joints, tolerance) {
        None => Ok(()),
        Some((index, value)) => Err(MotionRefusal::Joint {
            joint: arm.joint_names().get(index).cloned().unwrap_or_default(),
            value,
            range: arm.limits().range(index),
        }),
    }
}

fn line(
    arm: &ArmModel,
    start: &JointVector,
    target: Option<Target>,
    limits: &MotionLimits,
) -> Result<Option<Line>, MotionRefusal> {
    let Some(target) = target else { return Ok(None) };
    let from = arm.forward(start);
    let orientation = target.orientation.unwrap_or(from.rotation);
    let to = Isometry3::from_parts(Translation3::from(target.position.coords), orientation);
    if !to.is_finite() {
        return Err(MotionRefusal::NotFinite { side: arm.side() });
    }
    if let Some(axis) = limits.workspace.breach(&target.position) {
        return Err(MotionRefusal::workspace(arm.side(), axis, &target.position, &limits.workspace));
    }
    Ok(Some(Line::new(from, to)).filter(|line| !line.is_still()))
}

fn swept(arm: &ArmModel, knots: &[JointVector]) -> Extent {
    let spans = knots.len().saturating_sub(1) as f64;
    let poses: Vec<Pose> = knots.iter().map(|joints| arm.forward(joints)).collect();
    poses.iter().zip(poses.iter().skip(1)).fold(Extent::default(), |extent, (from, to)| Extent {
        metres: extent.metres.max((to.translation.vector - from.translation.vector).norm() * spans),
        radians: extent.radians.max(from.rotation.angle_to(&to.rotation) * spans),
    })
}

pub(super) fn finish(
    model: &RobotModel,
    scene: &Scene,
    knots: PerSide<Vec<JointVector>>,
    extent: PerSide<Extent>,
    limits: &MotionLimits,
) -> Result<PairMotion, MotionRefusal> {
    super::check::check_path(model, scene, &knots, limits)?;
    let path = |side: Side, knots: Vec<JointVector>| JointPath::through(knots).ok_or(MotionRefusal::NotFinite { side });
    let PerSide { left, right } = knots;
    let paths = PerSide { left: path(Side::Left, left)?, right: path(Side::Right, right)? };
    for (side, path) in paths.iter() {
        check_between_knots(model.arm(side), path)?;
    }
    let bounds = path_limits(&paths, &extent, limits);
    let timing = PathTiming::rest_to_rest(&bounds, limits.minimum_duration.as_secs_f64())?;
    let arms = PerSide {
        left: ArmMotion { chain: model.arm(Side::Left).chain.clone(), path: paths.left },
        right: ArmMotion { chain: model.arm(Side::Right).chain.clone(), path: paths.right },
    };
    let grippers = extent.iter().map(|(_, extent)| limits.acceleration / extent.metres).fold(MOST, f64::min) * HEADROOM;
    let braking = Braking { grippers, joints: limits.joint_acceleration * HEADROOM };
    Ok(PairMotion { arms, timing, limits: bounds, braking })
}

/// Where a joint runs against its limit the way bends there, and its spline may swing beyond: such a way is refused.
fn check_between_knots(arm: &ArmModel, path: &JointPath) -> Result<(), MotionRefusal> {
    let spans = path.knots().len().saturating_sub(1) as f64;
    shares(4.0 * spans).try_for_each(|share| check_posture(arm, &path.at(share).joints, JOINT_TOLERANCE))
}

/// The highest speed, acceleration and jerk of the shared parameter with which no gripper and no joint breaks a limit.
///
/// Joint acceleration is slope · s̈ + curvature · ṡ²: each of the two gets half of what is allowed.
fn path_limits(paths: &PerSide<JointPath>, extent: &PerSide<Extent>, limits: &MotionLimits) -> PathLimits {
    let mut bounds = PathLimits { speed: MOST, acceleration: MOST, jerk: MOST };
    for (side, path) in paths.iter() {
        let extent = extent.get(side);
        bounds.speed = bounds.speed.min(limits.speed / extent.metres).min(limits.turning_speed / extent.radians);
        bounds.acceleration = bounds.acceleration.min(limits.acceleration / extent.metres);
        bounds.jerk = bounds.jerk.min(limits.jerk / extent.metres);
        let spans = path.knots().len().saturating_sub(1).max(1) as f64;
        // Halfway points too: between its knots a cubic may be steeper than at them.
        for share in shares(2.0 * spans) {
            let point = path.at(share);
            let rates = point.slope.iter().zip(point.curvature.iter());
            let allowed = limits.joint_speed.iter().zip(limits.joint_acceleration.iter());
            for ((slope, curvature), (speed, acceleration)) in rates.zip(allowed) {
                bounds.speed = bounds.speed.min(speed / slope.abs());
                bounds.speed = bounds.speed.min((0.5 * acceleration / curvature.abs()).sqrt());
                bounds.acceleration = bounds.acceleration.min(0.5 * acceleration / slope.abs());
            }
        }
    }
    bounds.speed *= HEADROOM;
    bounds.acceleration *= HEADROOM;
    bounds
}

#[cfg(test)]
mod tests;
