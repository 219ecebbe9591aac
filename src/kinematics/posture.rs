//! Postures from which the dressing is done: the grippers' fixed orientation, and start postures found by looking ahead.
//!
//! A posture that reaches the first point of a way need not be able to follow it: a first solution fails on one way in six.
//! So several are tried, and the whole way is followed from each before one is chosen.

use super::JointVector;
use super::inverse::TOLERANCE;
use super::limits::MotionLimits;
use super::model::{ArmModel, RobotModel};
use super::plan::{Target, plan_pair};
use super::refusal::MotionRefusal;
use super::scene::Scene;
use crate::body::{PerSide, Side};
use crate::geometry::{Point, Pose};
use nalgebra::{Isometry3, Translation3, UnitQuaternion};

/// How far the grippers point below the horizontal: of the lines in front of the robot that are possible at all, the largest
/// share is so at 30° (99 %; 95 % at 0°, 91 % at 60°, 58 % at 90°).
const PITCH: f64 = std::f64::consts::FRAC_PI_6;

/// The grippers' orientation in `base` while a person is dressed: they point forward (x) and 30° down, and their own x axis
/// (the camera's side of the hand) points up.
#[must_use]
pub fn dressing_orientation() -> UnitQuaternion<f64> {
    UnitQuaternion::from_axis_angle(&nalgebra::Vector3::y_axis(), std::f64::consts::FRAC_PI_2 + PITCH)
        * UnitQuaternion::from_axis_angle(&nalgebra::Vector3::z_axis(), std::f64::consts::PI)
}
