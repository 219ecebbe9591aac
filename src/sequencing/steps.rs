//! The steps of table 3.1: to which place each gripper goes.
//!
//! The thesis dresses the right arm first. Where a person needs the left arm first, the table is mirrored: *leading* is
//! the gripper on the side of the first arm, *trailing* the other.

use crate::body::Side;
use serde::{Deserialize, Serialize};
use std::fmt;

/// A row of table 3.1.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Step {
    /// Row 1: each gripper goes behind its own shoulder.
    BehindShoulders,
    /// Row 2: the trailing gripper goes behind the first arm's shoulder, the leading one to the hand.
    Hand,
    /// Row 3: the leading gripper passes the forearm.
    Forearm,
    /// Row 4: the leading gripper passes the upper arm.
    UpperArm,
    /// Row 5: the leading gripper reaches the shoulder.
    Shoulder,
    /// Row 6: the trailing gripper dresses the second arm, the leading one stays.
    SecondArm,
}

/// Where a step sends a gripper.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Place {
    /// Behind the person's shoulder of the given side.
    BehindShoulder(Side),
    /// Towards the person's shoulder of the given side.
    TowardsShoulder(Side),
    /// To the hand of the given side.
    Hand(Side),
    /// Along the forearm of the given side.
    Forearm(Side),
    /// Along the upper arm of the given side.
    UpperArm(Side),
    /// To the shoulder of the given side.
    Shoulder(Side),
    /// Nowhere: it holds its place.
    NoMovement,
}

impl Step {
    /// All steps in order.
    pub const ALL: [Self; 6] =
        [Self::BehindShoulders, Self::Hand, Self::Forearm, Self::UpperArm, Self::Shoulder, Self::SecondArm];

    /// The row of table 3.1, from 1.
    #[must_use]
    pub const fn number(self) -> u8 {
        self as u8 + 1
    }

    /// Where this step sends a gripper, when the person's `first` arm is dressed first.
    #[must_use]
    pub fn place(self, first: Side, gripper: Side) -> Place {
        let leading = gripper == first;
        match self {
            Self::BehindShoulders => Place::BehindShoulder(gripper),
            Self::Hand if leading => Place::Hand(first),
            Self::Hand => Place::BehindShoulder(first),
            Self::SecondArm if leading => Place::NoMovement,
            Self::SecondArm => Place::Shoulder(first.other()),
            _ if !leading => Place::TowardsShoulder(first.other()),
            Self::Forearm => Place::Forearm(first),
            Self::UpperArm => Place::UpperArm(first),
            Self::Shoulder => Place::Shoulder(first),
        }
    }
}

impl fmt::Display for Place {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::BehindShoulder(side) => write!(formatter, "behind {side} shoulder"),
            Self::TowardsShoulder(side) => write!(formatter, "towards {side} shoulder"),
            Self::Hand(side) => write!(formatter, "{side} hand"),
            Self::Forearm(side) => write!(formatter, "{side} forearm"),
            Self::UpperArm(side) => write!(formatter, "{side} upper arm"),
            Self::Shoulder(side) => write!(formatter, "{side} shoulder"),
            Self::NoMovement => formatter.write_str("no movement"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Table 3.1 as the thesis prints it: left gripper, right gripper.
    const TABLE_3_1: [(&str, &str); 6] = [
        ("behind left shoulder", "behind right shoulder"),
        ("behind right shoulder", "right hand"),
        ("towards left shoulder", "right forearm"),
        ("towards left shoulder", "right upper arm"),
        ("towards left shoulder", "right shoulder"),
        ("left shoulder", "no movement"),
    ];

    #[test]
    fn the_steps_are_those_of_table_3_1() {
        for (step, (left, right)) in Step::ALL.into_iter().zip(TABLE_3_1) {
            assert_eq!(step.place(Side::Right, Side::Left).to_string(), left, "{step:?}");
            assert_eq!(step.place(Side::Right, Side::Right).to_string(), right, "{step:?}");
        }
    }

    #[test]
    fn with_the_left_arm_first_the_table_is_mirrored() {
        let mirrored = |text: &str| match text {
            text if text.contains("left") => text.replace("left", "right"),
            text => text.replace("right", "left"),
        };
        for (step, (left, right)) in Step::ALL.into_iter().zip(TABLE_3_1) {
            assert_eq!(step.place(Side::Left, Side::Right).to_string(), mirrored(left));
            assert_eq!(step.place(Side::Left, Side::Left).to_string(), mirrored(right));
        }
    }

    #[test]
    fn rows_are_counted_from_one() {
        assert_eq!(Step::ALL.map(Step::number), [1, 2, 3, 4, 5, 6]);
    }
}
