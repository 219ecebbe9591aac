//! Words for the person and the robot: sides, joints, arms, and a person's pose with how well each joint is known.
//!
//! `Side` is always a body's own left and right. In dressing, the robot stands behind the person and both look the same
//! way, so the robot's right gripper dresses the person's right arm.

use crate::geometry::Point;
use crate::time::Stamp;
use nalgebra::Matrix3;
use serde::{Deserialize, Serialize};
use std::fmt;

/// A body's own left or right.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Side {
    /// The body's own left.
    Left,
    /// The body's own right.
    Right,
}

impl Side {
    /// Both sides, left first.
    pub const BOTH: [Self; 2] = [Self::Left, Self::Right];

    /// The opposite side.
    #[must_use]
    pub const fn other(self) -> Self {
        match self {
            Self::Left => Self::Right,
            Self::Right => Self::Left,
        }
    }

    /// The word that Baxter's topics and joints use.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Left => "left",
            Self::Right => "right",
        }
    }
}

impl fmt::Display for Side {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.pad(self.name())
    }
}

/// One value for each side.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PerSide<T> {
    /// The left one.
    pub left: T,
    /// The right one.
    pub right: T,
}

impl<T> PerSide<T> {
    /// Makes both values from their side.
    pub fn from_fn(mut make: impl FnMut(Side) -> T) -> Self {
        Self { left: make(Side::Left), right: make(Side::Right) }
    }

    /// The value of a side.
    #[must_use]
    pub const fn get(&self, side: Side) -> &T {
        match side {
            Side::Left => &self.left,
            Side::Right => &self.right,
        }
    }

    /// The value of a side, to change it.
    #[must_use]
    pub const fn get_mut(&mut self, side: Side) -> &mut T {
        match side {
            Side::Left => &mut self.left,
            Side::Right => &mut self.right,
        }
    }

    /// Both values with their sides, left first.
    pub fn iter(&self) -> impl Iterator<Item = (Side, &T)> {
        Side::BOTH.into_iter().map(|side| (side, self.get(side)))
    }

    /// The same for each side, from its value.
    pub fn map<U>(&self, mut make: impl FnMut(Side, &T) -> U) -> PerSide<U> {
        PerSide::from_fn(|side| make(side, self.get(side)))
    }
}

/// A named place on a person's arm, from the hand inwards.
///
/// Hand, forearm, upper arm and shoulder are the thesis' four (section 3.2.1); elbow and wrist are what chapters 4 and 5
/// need besides. Hand is the middle finger's knuckle, forearm and upper arm the middle of the part, shoulder the centre
/// of the glenohumeral joint.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Joint {
    /// The middle finger's knuckle.
    Hand,
    /// The wrist.
    Wrist,
    /// The middle of the forearm.
    Forearm,
    /// The elbow.
    Elbow,
    /// The middle of the upper arm.
    UpperArm,
    /// The centre of the shoulder joint.
    Shoulder,
}

impl Joint {
    /// All joints of an arm, from the hand inwards.
    pub const ALL: [Self; 6] = [Self::Hand, Self::Wrist, Self::Forearm, Self::Elbow, Self::UpperArm, Self::Shoulder];
    /// The joints that a dressing path passes (thesis section 4.4.3), in order.
    pub const DRESSED: [Self; 3] = [Self::Hand, Self::Elbow, Self::Shoulder];

    /// The position of this joint in [`Joint::ALL`].
    #[must_use]
    pub const fn index(self) -> usize {
        self as usize
    }

    /// The joint's name in words that files and screens share.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Hand => "hand",
            Self::Wrist => "wrist",
            Self::Forearm => "forearm",
            Self::Elbow => "elbow",
            Self::UpperArm => "upper_arm",
            Self::Shoulder => "shoulder",
        }
    }
}

impl fmt::Display for Joint {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.pad(self.name())
    }
}

/// A part of an arm that the garment passes in one go.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Segment {
    /// From the hand to the elbow.
    HandToElbow,
    /// From the elbow to the shoulder.
    ElbowToShoulder,
}

/// How a joint's position came to be known.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Evidence {
    /// Measured in the newest image or skeleton.
    Seen,
    /// Concluded from other joints, the arm's lengths or the last measurement.
    Inferred,
}

/// Where a joint is and how well that is known.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct JointEstimate {
    /// Position in metres.
    pub position: Point,
    /// Covariance of the position in square metres.
    pub covariance: Matrix3<f64>,
    /// From 0 (a guess) to 1 (certain).
    pub confidence: f64,
    /// Whether it was seen or inferred.
    pub evidence: Evidence,
}

/// What is known of one arm. A joint that is not known is `None`, never an old or invented place.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct ArmPose {
    joints: [Option<JointEstimate>; 6],
}

impl ArmPose {
    /// What is known of a joint.
    #[must_use]
    pub fn joint(&self, joint: Joint) -> Option<&JointEstimate> {
        self.joints.get(joint.index()).and_then(Option::as_ref)
    }

    /// Sets or clears what is known of a joint.
    pub fn set(&mut self, joint: Joint, estimate: Option<JointEstimate>) {
        if let Some(slot) = self.joints.get_mut(joint.index()) {
            *slot = estimate;
        }
    }

    /// A joint's position in metres, where it is known.
    #[must_use]
    pub fn position(&self, joint: Joint) -> Option<Point> {
        self.joint(joint).map(|estimate| estimate.position)
    }
}

/// A person's pose in the robot's `base` frame at one moment.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct BodyPose {
    /// When the image or skeleton was taken.
    pub stamp: Stamp,
    /// Both arms.
    pub arms: PerSide<ArmPose>,
    /// The neck, which the keep-out zone of head and face is built round.
    pub neck: Option<JointEstimate>,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn indices_follow_the_order_of_the_list() {
        for (index, joint) in Joint::ALL.into_iter().enumerate() {
            assert_eq!(joint.index(), index);
        }
    }

    #[test]
    fn the_other_side_of_the_other_side_is_the_side_itself() {
        for side in Side::BOTH {
            assert_ne!(side.other(), side);
            assert_eq!(side.other().other(), side);
        }
    }

    #[test]
    fn a_joint_that_was_not_set_is_not_known() {
        let mut arm = ArmPose::default();
        let estimate = JointEstimate {
            position: Point::new(0.1, 0.2, 0.3),
            covariance: Matrix3::identity() * 1e-4,
            confidence: 0.9,
            evidence: Evidence::Seen,
        };
        arm.set(Joint::Elbow, Some(estimate));
        assert_eq!(arm.position(Joint::Elbow), Some(estimate.position));
        assert_eq!(arm.position(Joint::Hand), None);
        arm.set(Joint::Elbow, None);
        assert_eq!(arm.joint(Joint::Elbow), None);
    }

    #[test]
    fn per_side_values_keep_their_sides() {
        let names = PerSide::from_fn(Side::name);
        assert_eq!(
            names.iter().map(|(side, name)| (side, *name)).collect::<Vec<_>>(),
            [(Side::Left, "left"), (Side::Right, "right")]
        );
    }
}
