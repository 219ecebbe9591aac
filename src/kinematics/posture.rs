//! Postures from which the dressing is done: the grippers' fixed orientation, where the gripper that waits is, and start postures
//! from which the arms can go the whole way.

mod search;

use super::JointVector;
use super::limits::MotionLimits;
use super::model::RobotModel;
use super::refusal::MotionRefusal;
use super::scene::Scene;
use crate::body::{PerSide, Side};
use crate::geometry::Point;
use nalgebra::{UnitQuaternion, Vector3};
use search::{Start, roomiest_start};

/// How far the grippers point below the horizontal: of the lines in front of the robot that are possible at all, the largest
/// share is so at 30° (99 %; 95 % at 0°, 91 % at 60°, 58 % at 90°).
const PITCH: f64 = std::f64::consts::FRAC_PI_6;
/// How far both grippers may be turned inwards, about the vertical, in degrees: a wrist that comes from further out passes the
/// person's trunk with more room, as long as the arm still reaches and the grippers stay apart. What leaves the most room depends
/// on the person, so each is tried.
const INWARD_TURNS: [f64; 3] = [5.0, 10.0, 15.0];
/// From a person's shoulder to where the other gripper waits behind it, in `base`, metres: behind and below, because the robot's
/// forearms (radius 0.06 m) lie behind their grippers and have to pass each other when the leading gripper is at the shoulder.
const WAITING_OFFSET: Vector3<f64> = Vector3::new(-0.20, 0.0, -0.28);
/// The grippers' orientation in `base` while a person is dressed: they point forward (x) and 30° down, and their own x axis
/// (the camera's side of the hand) points down. Of four quarter turns about the gripper's own axis this one leaves the most room to
/// the joint limits on dressing paths.
#[must_use]
pub fn dressing_orientation() -> UnitQuaternion<f64> {
    UnitQuaternion::from_axis_angle(&Vector3::y_axis(), std::f64::consts::FRAC_PI_2 + PITCH)
}

/// [`dressing_orientation`] for both grippers, each turned inwards about the vertical by so many radians.
fn turned_inwards(angle: f64) -> PerSide<UnitQuaternion<f64>> {
    let turn = PerSide { left: -angle, right: angle };
    turn.map(|_, angle| UnitQuaternion::from_axis_angle(&Vector3::z_axis(), *angle) * dressing_orientation())
}

/// Where the gripper that does not lead waits, for a person's shoulder in `base`, metres.
#[must_use]
pub fn waiting_place(shoulder: &Point) -> Point {
    shoulder + WAITING_OFFSET
}

/// A part of the arms' way with what they keep clear of on it.
#[derive(Clone, Copy, Debug)]
pub struct Leg<'a> {
    /// What surrounds the arms on this part of the way.
    pub scene: &'a Scene,
    /// Where the grippers go in turn (`base`, metres), from where the part before has left them.
    pub stages: &'a [PerSide<Point>],
}

/// Start postures (radians) of both arms from which they can go through all stages: straight lines in step from one pair of
/// points (`base`, metres) to the next, each gripper at one orientation. A gripper whose point stays the same rests.
///
/// # Errors
/// See [`start_postures_for`].
pub fn start_postures(
    model: &RobotModel,
    scene: &Scene,
    stages: &[PerSide<Point>],
    orientations: &PerSide<UnitQuaternion<f64>>,
    limits: &MotionLimits,
) -> Result<PerSide<JointVector>, MotionRefusal> {
    start_postures_for(model, &[Leg { scene, stages }], orientations, limits)
}

/// [`start_postures`] for a way whose surroundings change: the arm of the person that is dressed next is no obstacle any more.
///
/// Each arm's candidates are followed through all legs and ranked by the room they leave to the joint limits and to the joint
/// speeds; of the best pairs that keep clear of everything and keep the grippers' distance throughout, the one is taken that leaves
/// the most room of either kind.
///
/// # Errors
/// A [`MotionRefusal`]: of a candidate's way where no posture of an arm can follow it, or of the best pair where none is clear.
pub fn start_postures_for(
    model: &RobotModel,
    legs: &[Leg],
    orientations: &PerSide<UnitQuaternion<f64>>,
    limits: &MotionLimits,
) -> Result<PerSide<JointVector>, MotionRefusal> {
    found(roomiest_start(model, legs, orientations, limits, f64::NEG_INFINITY))
}

/// The joints of a start; a search that had nothing to beat and found nothing had no places to go to.
fn found(start: Result<Option<Start>, MotionRefusal>) -> Result<PerSide<JointVector>, MotionRefusal> {
    start?.map(|start| start.joints).ok_or(MotionRefusal::NotFinite { side: Side::Left })
}

/// [`start_postures_for`] with the grippers in the orientation for dressing, turned inwards as far as leaves the most room.
///
/// # Errors
/// As [`start_postures_for`], with the grippers not turned.
pub fn dressing_postures(
    model: &RobotModel,
    legs: &[Leg],
    limits: &MotionLimits,
) -> Result<PerSide<JointVector>, MotionRefusal> {
    let start =
        |degrees: f64, to_beat| roomiest_start(model, legs, &turned_inwards(degrees.to_radians()), limits, to_beat);
    let straight = start(0.0, f64::NEG_INFINITY);
    let mut best = straight.as_ref().ok().copied().flatten();
    for degrees in INWARD_TURNS {
        let to_beat = best.map_or(f64::NEG_INFINITY, |best| best.room);
        best = start(degrees, to_beat).ok().flatten().or(best);
    }
    found(if best.is_some() { Ok(best) } else { straight })
}

#[cfg(test)]
mod tests;
