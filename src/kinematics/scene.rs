//! What surrounds the robot: the person's body as capsules, and how far the arms keep away from it.

use crate::geometry::Point;
use serde::{Deserialize, Serialize};

/// All points within `radius` of the segment from `start` to `end`; a sphere where both are the same. Metres.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Capsule {
    /// One end of the axis.
    pub start: Point,
    /// The other end of the axis.
    pub end: Point,
    /// Radius in metres.
    pub radius: f64,
}

/// A part of the person's body that the arms keep away from.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct BodyPart {
    /// What it is, in the operator's words.
    pub name: String,
    /// Its shape in `base`, uncertainty included.
    pub shape: Capsule,
}

/// What surrounds the robot.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Scene {
    /// The person; empty where nobody is there.
    pub person: Vec<BodyPart>,
    /// Least distance between an arm and the person in metres.
    pub margin: f64,
}

impl Default for Scene {
    fn default() -> Self {
        Self { person: Vec::new(), margin: 0.02 }
    }
}
