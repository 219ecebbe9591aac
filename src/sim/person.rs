//! The simulated person: a body of published sizes, arms held in a posture, a preferred dressing movement that the node
//! never sees, and how the person reacts to a garment that pulls.
//!
//! [`SimulatedPerson`] is the `[simulated]` section of a profile; [`SimulatedPerson::check`] refuses a person that cannot be.

mod arm;
mod body;
mod exercise;
mod impairment;
mod movement;
mod reaction;

#[cfg(test)]
pub(super) use arm::point_along;
pub use arm::{ArmAngles, ArmSizes, SimulatedArm};
pub use body::{BodySizes, Sex};
pub(super) use exercise::Exercise;
pub use exercise::Seen;
pub use impairment::Impairment;
pub use movement::{Movement, MovementKind};
pub use reaction::Response;
pub(super) use reaction::{Pull, Reaction};

use crate::body::{PerSide, Side};
use crate::geometry::Point;
use serde::{Deserialize, Serialize};
use thiserror::Error;

/// A person for the simulator, as the `[simulated]` section of a profile gives it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct SimulatedPerson {
    /// Sizes of the body.
    pub body: BodySizes,
    /// Middle between the shoulders in metres in `base`; the person looks along +x, away from the robot behind.
    pub chest_metres: [f64; 3],
    /// The right arm.
    pub right: SimulatedArm,
    /// The left arm; the mirror image of the right one where it is not given.
    pub left: Option<SimulatedArm>,
}

impl Default for SimulatedPerson {
    fn default() -> Self {
        Self {
            body: BodySizes::default(),
            // Shoulders 1.12 m above the floor of the stock pedestal (base is 0.92 m above it): an adult on a chair.
            chest_metres: [0.84, 0.0, 0.20],
            right: SimulatedArm::default(),
            left: None,
        }
    }
}

/// Why a simulated person cannot be.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum PersonError {
    /// A number is outside what people have.
    #[error("simulated.{key} is {value}, but people have {lowest} to {highest}: correct the profile")]
    OutOfRange {
        /// The key in the profile.
        key: String,
        /// Its value.
        value: f64,
        /// The lowest that is allowed.
        lowest: f64,
        /// The highest that is allowed.
        highest: f64,
    },
    /// Two entries contradict each other.
    #[error("simulated.{key} contradicts itself: {reason}; correct the profile")]
    Contradiction {
        /// The key in the profile.
        key: String,
        /// Why.
        reason: String,
    },
}

impl PersonError {
    fn range(key: impl Into<String>, value: f64, (lowest, highest): (f64, f64)) -> Result<(), Self> {
        if (lowest..=highest).contains(&value) {
            return Ok(());
        }
        Err(Self::OutOfRange { key: key.into(), value, lowest, highest })
    }
}

/// Where an arm's joints are, in metres in `base`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ArmPoints {
    /// The middle finger's knuckle.
    pub hand: Point,
    /// The wrist.
    pub wrist: Point,
    /// The elbow.
    pub elbow: Point,
    /// The centre of the shoulder joint.
    pub shoulder: Point,
}

impl ArmPoints {
    /// Hand, elbow and shoulder: the path along which a sleeve goes on.
    #[must_use]
    pub const fn dressed(&self) -> [Point; 3] {
        [self.hand, self.elbow, self.shoulder]
    }
}

impl SimulatedPerson {
    /// An arm; the left one is the mirror image of the right one where the profile does not give it.
    #[must_use]
    pub fn arm(&self, side: Side) -> SimulatedArm {
        match (side, &self.left) {
            (Side::Left, Some(left)) => left.clone(),
            _ => self.right.clone(),
        }
    }

    /// Where a shoulder's centre is at rest, in metres in `base`.
    #[must_use]
    pub fn shoulder(&self, side: Side) -> Point {
        let half = self.body.shoulder_breadth_metres() / 2.0;
        let [x, y, z] = self.chest_metres;
        Point::new(x, y + if side == Side::Left { half } else { -half }, z)
    }

    /// Where both arms' joints are in the posture of the profile.
    #[must_use]
    pub fn posture(&self) -> PerSide<ArmPoints> {
        let sizes = self.body.arm_sizes();
        PerSide::from_fn(|side| self.arm(side).posture.points(side, &self.shoulder(side), &sizes))
    }

    /// The gripper's path that the person likes best, from hand to shoulder in metres in `base`: hidden from the node.
    #[must_use]
    pub fn preferred_path(&self, side: Side) -> Vec<Point> {
        let points = self.posture();
        self.arm(side).preferred_path(side, &points.get(side).dressed())
    }

    /// Checks every number.
    ///
    /// # Errors
    /// The first entry that no person has, with the range that people have.
    pub fn check(&self) -> Result<(), PersonError> {
        self.body.check()?;
        let [x, y, z] = self.chest_metres;
        PersonError::range("chest_metres, x", x, (0.4, 1.4))?;
        PersonError::range("chest_metres, y", y, (-0.5, 0.5))?;
        PersonError::range("chest_metres, z", z, (-0.3, 0.6))?;
        self.right.check("right")?;
        self.left.as_ref().map_or(Ok(()), |left| left.check("left"))
    }
}

#[cfg(test)]
mod tests;
