//! The parts that a pixel can belong to, and their numbers in label images, trees and files.
//!
//! Numbers 0 to 7 are the thesis' eight parts (section 3.2), the subject's own left first. Lap, chair and what else is
//! near a person form a ninth class, `other`, which only trees know: a label image shows it as no part.

use crate::body::{Joint, Side};

/// Label of a pixel that belongs to no part.
pub const NONE: u8 = 255;
/// Label of lap, chair and remains of the head, inside trees and training images only.
pub const OTHER: u8 = 8;
/// Number of body parts.
pub const PARTS: usize = 8;
/// Number of classes that a tree tells apart: the parts and `other`.
pub const CLASSES: usize = 9;
/// Where shoulder ends and upper arm begins, as a share of the way from the shoulder's centre to the elbow.
pub const SHOULDER_SHARE: f64 = 0.24;

/// A body part as the thesis labels it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Part {
    /// Shoulder, with the torso's half on that side.
    Shoulder,
    /// Upper arm without the shoulder.
    UpperArm,
    /// Forearm, from elbow to wrist.
    Forearm,
    /// Hand, from the wrist on.
    Hand,
}

impl Part {
    /// All parts of an arm, from the shoulder outwards.
    pub const ALL: [Self; 4] = [Self::Shoulder, Self::UpperArm, Self::Forearm, Self::Hand];

    /// The part's number in label images on a side.
    #[must_use]
    pub const fn label(self, side: Side) -> u8 {
        let first = match side {
            Side::Left => 0,
            Side::Right => 4,
        };
        first + self as u8
    }

    /// Side and part of a label; `None` for no part.
    #[must_use]
    pub fn from_label(label: u8) -> Option<(Side, Self)> {
        let side = if label < 4 { Side::Left } else { Side::Right };
        let part = *Self::ALL.get(usize::from(label % 4))?;
        (usize::from(label) < PARTS).then_some((side, part))
    }
}

/// The parts whose pixels tell about a joint: its own, or those that meet in it.
#[must_use]
pub const fn parts_of(joint: Joint) -> &'static [Part] {
    match joint {
        Joint::Hand => &[Part::Hand],
        Joint::Wrist => &[Part::Forearm, Part::Hand],
        Joint::Forearm => &[Part::Forearm],
        Joint::Elbow => &[Part::UpperArm, Part::Forearm],
        Joint::UpperArm => &[Part::UpperArm],
        Joint::Shoulder => &[Part::Shoulder],
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn labels_are_those_of_the_convention_and_come_back() {
        assert_eq!(Part::Shoulder.label(Side::Left), 0);
        assert_eq!(Part::Hand.label(Side::Left), 3);
        assert_eq!(Part::Shoulder.label(Side::Right), 4);
        assert_eq!(Part::Hand.label(Side::Right), 7);
        for side in Side::BOTH {
            for part in Part::ALL {
                assert_eq!(Part::from_label(part.label(side)), Some((side, part)));
            }
        }
        assert_eq!(Part::from_label(OTHER), None);
        assert_eq!(Part::from_label(NONE), None);
    }
}
