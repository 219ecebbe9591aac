//! Limits of joints and of motion, with the source of each default.
//!
//! A limit is never applied by cutting a value in silence: planners refuse, and the guards in `robot` refuse again.

use super::JointVector;
use crate::geometry::Point;
use serde::{Deserialize, Serialize};
use std::time::Duration;

/// How far outside its range a commanded joint position may be, in radians: where a joint runs along its limit, the spline
/// through the planned positions swings a little beyond. Less than three of the encoder's steps (2π / 16384), and a ninth
/// of the 0.5° to which the robot itself controls a joint.
pub const JOINT_TOLERANCE: f64 = 1e-3;

/// Position and speed limits of one arm's joints, as its description gives them.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct JointLimits {
    /// Lower ends in radians.
    pub lower: JointVector,
    /// Upper ends in radians.
    pub upper: JointVector,
    /// Speeds in radians per second that the description allows. Motion uses the lower [`MotionLimits::joint_speed`].
    pub speed: JointVector,
}

impl JointLimits {
    /// The middle of each joint's range in radians.
    #[must_use]
    pub fn middle(&self) -> JointVector {
        (self.lower + self.upper) * 0.5
    }

    /// The first joint (index in s0, s1, e0, e1, w0, w1, w2) that is outside its range by more than `tolerance` radians,
    /// or not a number, and its value.
    #[must_use]
    pub fn breach(&self, joints: &JointVector, tolerance: f64) -> Option<(usize, f64)> {
        let ranges = self.lower.iter().zip(self.upper.iter());
        joints.iter().zip(ranges).enumerate().find_map(|(index, (value, (lower, upper)))| {
            let inside = (lower - tolerance..=upper + tolerance).contains(value);
            (!inside).then_some((index, *value))
        })
    }

    /// The joint's range in radians; empty for an index beyond 6.
    #[must_use]
    pub fn range(&self, index: usize) -> (f64, f64) {
        let end = |vector: &JointVector| vector.get(index).copied().unwrap_or(f64::NAN);
        (end(&self.lower), end(&self.upper))
    }

    /// Distance of the closest joint to an end of its range, as a share of half that range: 1 in the middle, 0 at an end.
    #[must_use]
    pub fn margin(&self, joints: &JointVector) -> f64 {
        let half = (self.upper - self.lower) * 0.5;
        let offset = (joints - self.middle()).abs();
        1.0 - offset.component_div(&half).max()
    }
}

/// A box in `base`, corners in metres.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Workspace {
    /// The corner with the smallest coordinates.
    pub lower: Point,
    /// The corner with the largest coordinates.
    pub upper: Point,
}

impl Workspace {
    /// The first axis (0 x, 1 y, 2 z) on which a point lies outside, or is not a number.
    #[must_use]
    pub fn breach(&self, point: &Point) -> Option<usize> {
        let ranges = self.lower.iter().zip(self.upper.iter());
        point.iter().zip(ranges).position(|(value, (lower, upper))| !(lower..=upper).contains(&value))
    }
}

/// How the arms may move.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct MotionLimits {
    /// Highest speed of a gripper in metres per second.
    pub speed: f64,
    /// Highest turning speed of a gripper in radians per second.
    pub turning_speed: f64,
    /// Highest acceleration of a gripper along its line in metres per second squared.
    pub acceleration: f64,
    /// Highest jerk of a gripper along its line in metres per second cubed.
    pub jerk: f64,
    /// Highest joint speeds in radians per second, order s0, s1, e0, e1, w0, w1, w2.
    pub joint_speed: JointVector,
    /// Highest joint accelerations in radians per second squared.
    pub joint_acceleration: JointVector,
    /// Smallest distance between the grippers' tips in metres.
    pub minimum_gripper_distance: f64,
    /// Largest distance between the grippers' tips in metres: the garment's back panel hangs between them.
    pub maximum_gripper_distance: f64,
    /// Least time for a move: shorter ones are slowed down to it.
    pub minimum_duration: Duration,
    /// Where a gripper's tip may be.
    pub workspace: Workspace,
}

impl Default for MotionLimits {
    /// Speed and time are the thesis' (3 s between goals, section 3.5; 0.10 m/s over 0.30 m), joint limits those of the
    /// public MoveIt configuration for Baxter (`baxter_moveit_config`, `joint_limits.yaml`: 0.75 rad/s shoulder to elbow,
    /// 1.0 rad/s wrist, 2.0 rad/s²), turning speed that of published hand-over work with a Baxter
    /// (`human_robot_collaboration`: 0.5 rad/s). Acceleration and jerk bring a gripper from 0.10 m/s to rest in 0.17 s
    /// within 9 mm: the way that a sleeve is pulled on after its catch was found. Gripper distances keep the tool bodies apart and the garment slack: a wide
    /// sleeveless jacket has 0.45 m of back and twice 0.23 m of armhole depth from one gripper to the other.
    fn default() -> Self {
        Self {
            speed: 0.10,
            turning_speed: 0.5,
            acceleration: 1.5,
            jerk: 15.0,
            joint_speed: JointVector::from_column_slice(&[0.75, 0.75, 0.75, 0.75, 1.0, 1.0, 1.0]),
            joint_acceleration: JointVector::repeat(2.0),
            minimum_gripper_distance: 0.10,
            maximum_gripper_distance: 0.90,
            minimum_duration: Duration::from_secs(3),
            workspace: Workspace { lower: Point::new(0.25, -1.0, -0.55), upper: Point::new(1.15, 1.0, 0.75) },
        }
    }
}

#[cfg(test)]
mod tests;
