//! Plans motions of both arms in step: straight lines of the grippers, or from posture to posture.
//!
//! A plan is checked from its start to its end before it is handed out: reach, joint limits, workspace, the distance between
//! the grippers, and everything that must not touch. What cannot be done is refused with what and why.

use super::JointVector;
use super::inverse::InverseError;
use super::limits::MotionLimits;
use super::model::{ArmModel, RobotModel};
use super::motion::{ArmMotion, PairMotion};
use super::path::JointPath;
use super::refusal::MotionRefusal;
use super::scene::Scene;
use super::timing::{PathLimits, PathTiming};
use crate::body::{PerSide, Side};
use crate::geometry::{Finite, Point, Pose};
use nalgebra::{Isometry3, Translation3, UnitQuaternion};

/// Distance of two knots of a path in metres: halfway between, the spline is within a few micrometres of the line.
const KNOT_SPACING: f64 = 0.002;
/// Distance of two knots in radians for turns, and for joint moves.
const KNOT_ANGLE: f64 = 0.02;
/// Most knots of a path: 3 m at the spacing above, more than an arm can reach.
const MOST_KNOTS: f64 = 1500.0;
/// A joint that moves further than this (radians) from knot to knot jumps to another posture.
const JUMP: f64 = 0.1;
/// How far outside its range (radians) a measured joint may be: encoder steps and the robot's own control error (0.5°).
const START_TOLERANCE: f64 = 0.009;

/// Where a gripper is to go.
#[derive(Clone, Copy, Debug, PartialEq)]
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
    let lines = PerSide {
        left: line(model.arm(Side::Left), &start.left, targets.left, limits)?,
        right: line(model.arm(Side::Right), &start.right, targets.right, limits)?,
    };
    let knots = Side::BOTH.into_iter().filter_map(|side| lines.get(side).as_ref().map(Line::knots)).fold(1.0, f64::max);
    let track = |side: Side| match lines.get(side) {
        None => Ok(vec![*start.get(side)]),
        Some(line) => follow_line(model.arm(side), line, start.get(side), knots),
    };
    let paths = PerSide { left: track(Side::Left)?, right: track(Side::Right)? };
    let extent = PerSide::from_fn(|side| {
        lines.get(side).as_ref().map_or(Extent::default(), |line| Extent { metres: line.length, radians: line.angle })
    });
    finish(model, scene, paths, extent, limits)
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

/// A straight line of the tip with an even turn.
struct Line {
    from: Pose,
    to: Pose,
    length: f64,
    angle: f64,
}

impl Line {
    fn knots(&self) -> f64 {
        (self.length / KNOT_SPACING).max(self.angle / KNOT_ANGLE).ceil().clamp(2.0, MOST_KNOTS)
    }

    fn at(&self, share: f64) -> Pose {
        let position = self.from.translation.vector.lerp(&self.to.translation.vector, share);
        let turn = self.from.rotation.rotation_to(&self.to.rotation).scaled_axis() * share;
        Isometry3::from_parts(Translation3::from(position), UnitQuaternion::from_scaled_axis(turn) * self.from.rotation)
    }
}

/// The fastest that a gripper moves per unit of the path's parameter.
#[derive(Clone, Copy, Debug, Default)]
struct Extent {
    metres: f64,
    radians: f64,
}

fn checked_start(model: &RobotModel, start: &PerSide<JointVector>) -> Result<PerSide<JointVector>, MotionRefusal> {
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
    let length = (to.translation.vector - from.translation.vector).norm();
    Ok(Some(Line { from, to, length, angle: from.rotation.angle_to(&to.rotation) }))
}

/// The shares 0 to 1 of a path in so many spans.
#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a whole number from 1 to 1500")]
fn shares(spans: f64) -> impl Iterator<Item = f64> {
    (0..=spans as usize).map(move |index| index as f64 / spans)
}

fn follow_line(
    arm: &ArmModel,
    line: &Line,
    start: &JointVector,
    spans: f64,
) -> Result<Vec<JointVector>, MotionRefusal> {
    let mut knots: Vec<JointVector> = Vec::new();
    for share in shares(spans) {
        let guess = match knots.as_slice() {
            [] => *start,
            [only] => *only,
            [.., before, last] => extrapolate(arm, before, last),
        };
        let pose = line.at(share);
        let next = arm.follow(&pose, &guess).ok_or_else(|| not_tracked(arm, line, share, start))?;
        if knots.last().is_some_and(|last| (next - last).amax() > JUMP) {
            return Err(not_tracked(arm, line, share, start));
        }
        knots.push(next);
    }
    Ok(knots)
}

/// The next knot if the joints go on as before, kept inside the limits: a better seed than the last knot.
fn extrapolate(arm: &ArmModel, before: &JointVector, last: &JointVector) -> JointVector {
    (last * 2.0 - before).zip_zip_map(&arm.limits().lower, &arm.limits().upper, f64::clamp)
}

/// Says whether the pose is out of reach at all, or only from this posture.
fn not_tracked(arm: &ArmModel, line: &Line, share: f64, start: &JointVector) -> MotionRefusal {
    let place = Point::from(line.at(share).translation.vector);
    match arm.inverse(&line.at(share), start) {
        Err(InverseError::NotReached { nearest, .. }) => MotionRefusal::OutOfReach {
            side: arm.side(),
            place,
            nearest: Point::from(arm.forward(&nearest).translation.vector),
        },
        _ => MotionRefusal::NotTracked { side: arm.side(), place, share },
    }
}

fn swept(arm: &ArmModel, knots: &[JointVector]) -> Extent {
    let spans = knots.len().saturating_sub(1) as f64;
    let poses: Vec<Pose> = knots.iter().map(|joints| arm.forward(joints)).collect();
    poses.iter().zip(poses.iter().skip(1)).fold(Extent::default(), |extent, (from, to)| Extent {
        metres: extent.metres.max((to.translation.vector - from.translation.vector).norm() * spans),
        radians: extent.radians.max(from.rotation.angle_to(&to.rotation) * spans),
    })
}

fn finish(
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
    let bounds = path_limits(&paths, &extent, limits);
    let timing = PathTiming::rest_to_rest(&bounds, limits.minimum_duration.as_secs_f64())?;
    let arms = PerSide {
        left: ArmMotion { chain: model.arm(Side::Left).chain.clone(), path: paths.left },
        right: ArmMotion { chain: model.arm(Side::Right).chain.clone(), path: paths.right },
    };
    Ok(PairMotion { arms, timing, limits: bounds })
}

/// The highest speed, acceleration and jerk of the shared parameter with which no gripper and no joint breaks a limit.
///
/// Joint acceleration is slope · s̈ + curvature · ṡ²: each of the two gets half of what is allowed.
fn path_limits(paths: &PerSide<JointPath>, extent: &PerSide<Extent>, limits: &MotionLimits) -> PathLimits {
    // A path of no extent takes the minimum duration whatever its limits are; they must only be finite.
    const MOST: f64 = 1e3;
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
    bounds
}
