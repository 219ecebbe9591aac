//! The stick between two neighbouring joints (thesis section 5.1.2) and what it says about where a way-point can be.
//!
//! A stick has the length of the limb. Its ends are joints, and each joint has a mixture of where it can be.

use super::mixture::Mixture;
use crate::geometry::{Point, Vector};
use std::f64::consts::TAU;

/// Two points closer than this have no direction.
const NO_DIRECTION: f64 = 1e-9;

/// The other end of a stick of `length` that starts at `end` and passes through `middle` (equation 5.1); `None` where
/// the two coincide and the direction is unknown.
#[must_use]
pub fn other_end(end: &Point, middle: &Point, length: f64) -> Option<Point> {
    let along = middle - end;
    let distance = along.norm();
    (distance >= NO_DIRECTION).then(|| end + along * (length / distance))
}

/// One limb: its length and where its two ends can be.
#[derive(Clone, Copy, Debug)]
pub struct Limb<'a> {
    /// The mixture of the end that the garment passes first.
    pub start: &'a Mixture,
    /// The mixture of the end that it passes last.
    pub end: &'a Mixture,
    /// The distance between the two joints in metres.
    pub length: f64,
}

/// Whether a problem lives in the plane z = 0 (the thesis' synthetic data) or in space (the robot).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Space {
    /// The plane z = 0.
    Planar,
    /// Space.
    #[default]
    Spatial,
}

impl Space {
    /// The squared Mahalanobis radius that holds 95 % of a Gaussian.
    #[must_use]
    pub const fn region_95(self) -> f64 {
        match self {
            Self::Planar => super::mixture::REGION_95_PLANAR,
            Self::Spatial => super::mixture::REGION_95_SPATIAL,
        }
    }
}

/// How well some stick through a point fits the movement space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reachability {
    /// The best joint log density of both ends, less that of the two modes: 0 is best.
    pub score: f64,
    /// Whether some stick has both ends inside a 95 % region.
    pub inside: bool,
}

/// Orientations tried in the plane, and places along the stick.
const ORIENTATIONS: u32 = 48;
const PLACES: u32 = 17;
/// Orientations tried in space: about 15 degrees apart, as in the plane 7.5 degrees.
const SPATIAL_ORIENTATIONS: u32 = 200;

/// Fits sticks through points: the directions to try and the height of the modes, worked out once.
#[derive(Clone, Debug)]
pub struct StickFit {
    space: Space,
    directions: Vec<Vector>,
}

impl StickFit {
    /// A fit in the plane or in space.
    #[must_use]
    pub fn new(space: Space) -> Self {
        let directions = match space {
            Space::Planar => (0..ORIENTATIONS).map(planar_direction).collect(),
            Space::Spatial => (0..SPATIAL_ORIENTATIONS).map(spatial_direction).collect(),
        };
        Self { space, directions }
    }

    /// The best of all sticks through `point`. `best_possible` is the sum of the log densities at the two modes.
    #[must_use]
    pub fn reachability(&self, point: &Point, limb: &Limb<'_>, best_possible: f64) -> Reachability {
        let region = self.space.region_95();
        let mut result = Reachability { score: f64::NEG_INFINITY, inside: false };
        for direction in &self.directions {
            for place in 0..PLACES {
                let share = f64::from(place) / f64::from(PLACES - 1);
                let start = point - direction * (limb.length * share);
                let end = start + direction * limb.length;
                let score = limb.start.log_density(&start) + limb.end.log_density(&end);
                result.score = result.score.max(score - best_possible);
                result.inside = result.inside
                    || (limb.start.contains(&start.coords, region) && limb.end.contains(&end.coords, region));
            }
        }
        result
    }
}

fn planar_direction(index: u32) -> Vector {
    let (sine, cosine) = (TAU * f64::from(index) / f64::from(ORIENTATIONS)).sin_cos();
    Vector::new(cosine, sine, 0.0)
}

/// A point of the Fibonacci sphere: nearly equal spacing for any count.
fn spatial_direction(index: u32) -> Vector {
    let golden = TAU * (1.0 - 1.0 / 1.618_033_988_749_895);
    let height = 1.0 - (2.0 * f64::from(index) + 1.0) / f64::from(SPATIAL_ORIENTATIONS);
    let around = (1.0 - height * height).sqrt();
    let (sine, cosine) = (golden * f64::from(index)).sin_cos();
    Vector::new(around * cosine, around * sine, height)
}
