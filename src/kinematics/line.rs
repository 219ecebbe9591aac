//! Straight lines of a gripper, followed by the joints from a posture on.
//!
//! An arm has one joint more than a pose needs. What is left over draws the joints towards the middle of their ranges, so that
//! going to and fro does not wind the arm up against its limits. Knows no time and no second arm.

use super::JointVector;
use super::chain::Frame;
use super::inverse::{TOLERANCE, twist_between};
use super::model::ArmModel;
use super::path::JointPath;
use super::refusal::MotionRefusal;
use crate::geometry::{Point, Pose};
use nalgebra::{Isometry3, Translation3, UnitQuaternion};

/// Distance of two knots of a path in metres: halfway between, the spline is within a few micrometres of the line.
const KNOT_SPACING: f64 = 0.002;
/// Distance of two knots in radians for turns, and for joint moves.
pub(super) const KNOT_ANGLE: f64 = 0.02;
/// Most knots of a path: 3 m at the spacing above, more than an arm can reach.
pub(super) const MOST_KNOTS: f64 = 1500.0;
/// A joint that moves further than this (radians) from knot to knot, at the spacing above, jumps to another posture.
pub(super) const JUMP: f64 = 0.1;
/// How far the left-over freedom goes towards the middle of the joint ranges on [`KNOT_SPACING`], as a share.
const CENTRING: f64 = 0.004;
/// How far the spline may leave the line halfway between knots, in metres and radians: half of what is promised of a line.
const DEVIATION: f64 = 5e-6;
/// How often the knots of a line are doubled before it is taken as it is. Where a joint meets the end of its range the way has a
/// corner, which a spline cuts by less the nearer its knots are.
pub(super) const DOUBLINGS: i32 = 4;

/// A straight line of the tip with an even turn.
#[derive(Clone, Copy, Debug)]
pub(super) struct Line {
    from: Pose,
    to: Pose,
    pub(super) length: f64,
    pub(super) angle: f64,
}

impl Line {
    pub(super) fn new(from: Pose, to: Pose) -> Self {
        let length = (to.translation.vector - from.translation.vector).norm();
        Self { from, to, length, angle: from.rotation.angle_to(&to.rotation) }
    }

    /// How many spans between knots the line needs.
    pub(super) fn spans(&self) -> f64 {
        (self.length / KNOT_SPACING).max(self.angle / KNOT_ANGLE).ceil().clamp(2.0, MOST_KNOTS)
    }

    /// True where start and end are the same within twice what inverse kinematics promises: then the arm rests.
    pub(super) fn is_still(&self) -> bool {
        self.length < 2.0 * TOLERANCE && self.angle < 2.0 * TOLERANCE
    }

    /// The first share (0 to 1) of the line.
    pub(super) fn until(&self, share: f64) -> Self {
        Self::new(self.from, self.at(share))
    }

    /// The line from its end to its start.
    pub(super) fn reversed(&self) -> Self {
        Self { from: self.to, to: self.from, ..*self }
    }

    /// How far a pose is from the line, or from the place at one share of it: the larger of metres and radians.
    pub(super) fn deviation(&self, pose: &Pose, share: Option<f64>) -> f64 {
        let along = self.to.translation.vector - self.from.translation.vector;
        let from_start = pose.translation.vector - self.from.translation.vector;
        let nearest = if self.length > TOLERANCE { from_start.dot(&along) / along.norm_squared() } else { 0.5 };
        let there = self.at(share.unwrap_or(nearest).clamp(0.0, 1.0));
        let place = (pose.translation.vector - there.translation.vector).norm();
        // A turn on the spot has no nearest share: its ends bound it.
        let turn =
            if self.length > TOLERANCE || share.is_some() { pose.rotation.angle_to(&there.rotation) } else { 0.0 };
        place.max(turn)
    }

    pub(super) fn at(&self, share: f64) -> Pose {
        let position = self.from.translation.vector.lerp(&self.to.translation.vector, share);
        let turn = self.from.rotation.rotation_to(&self.to.rotation).scaled_axis() * share;
        Isometry3::from_parts(Translation3::from(position), UnitQuaternion::from_scaled_axis(turn) * self.from.rotation)
    }
}

/// The shares 0 to 1 of a path in so many spans.
#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a whole number from 1 to 3000")]
pub(super) fn shares(spans: f64) -> impl Iterator<Item = f64> {
    (0..=spans as usize).map(move |index| index as f64 / spans)
}

impl ArmModel {
    /// The joint positions at evenly spaced knots of a line, from a posture that is at the line's start.
    pub(super) fn follow_line(
        &self,
        line: &Line,
        start: &JointVector,
        spans: f64,
    ) -> Result<Vec<JointVector>, MotionRefusal> {
        let mut knots: Vec<JointVector> = Vec::new();
        let coarseness = line.spans() / spans;
        let (centring, jump) = (CENTRING * coarseness, JUMP * coarseness.max(1.0));
        for share in shares(spans) {
            let guess = match knots.as_slice() {
                [] => *start,
                [only] => self.onward(only, only, centring),
                [.., before, last] => self.onward(before, last, centring),
            };
            let refused = || self.not_tracked(line, share, 1.0 / spans, start);
            let next = self.follow(&line.at(share), &guess).ok_or_else(refused)?;
            if knots.last().is_some_and(|last| (next - last).amax() > jump) {
                return Err(refused());
            }
            knots.push(next);
        }
        Ok(knots)
    }

    /// True where the tip keeps to the line halfway between the knots of a path along it.
    pub(super) fn keeps_to(&self, line: &Line, path: &JointPath) -> bool {
        let spans = path.knots().len().saturating_sub(1);
        (0..spans).all(|index| {
            let share = (index as f64 + 0.5) / spans as f64;
            let tip = self.chain.frames(&path.at(share).joints).tip;
            twist_between(&tip, &Frame::from_pose(&line.at(share))).amax() <= DEVIATION
        })
    }

    /// The next knot if the joints go on as before, kept inside the limits. Only what moves the tip goes on: the left-over freedom
    /// creeps towards the middle of the ranges. Left to its swing it would go to and fro, and bend the way more than the line does.
    fn onward(&self, before: &JointVector, last: &JointVector, centring: f64) -> JointVector {
        let limits = self.limits();
        let step = last - before;
        let wanted = (limits.middle() - last) * centring - step;
        let next = last + step + self.free_motion(last, &wanted);
        next.zip_zip_map(&limits.lower, &limits.upper, f64::clamp)
    }

    /// Says whether the pose is out of reach at all, or only from this posture.
    fn not_tracked(&self, line: &Line, share: f64, step: f64, start: &JointVector) -> MotionRefusal {
        let pose = line.at(share);
        if let Err(error) = self.inverse(&pose, start) {
            return MotionRefusal::unreachable(self, &pose, &error);
        }
        let share = (share - step).max(0.0);
        let place = Point::from(line.at(share).translation.vector);
        MotionRefusal::NotTracked { side: self.side(), place, share }
    }
}
