//! The stick between two neighbouring joints (thesis section 5.1.2) and what it says about where a way-point can be.
//!
//! A stick has the length of the limb. Its ends are joints, and each joint has a mixture of where it can be.

use super::mixture::Mixture;
use crate::geometry::{Point, Vector};
use nalgebra::SVector;
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
    /// Both ends in one mixture, where they were modelled together: it knows which start goes with which end. Where there
    /// is none, the ends are independent, as in the thesis.
    pub together: Option<&'a Mixture<6>>,
    /// The distance between the two joints in metres.
    pub length: f64,
}

impl Limb<'_> {
    /// The logarithm of the joint density of the limb's two ends.
    #[must_use]
    pub fn log_density(&self, start: &Point, end: &Point) -> f64 {
        match self.together {
            Some(together) => together.log_density_at(&both_ends(start, end)),
            None => self.start.log_density(start) + self.end.log_density(end),
        }
    }
}

/// The coordinates of both ends, one after the other.
fn both_ends(start: &Point, end: &Point) -> SVector<f64, 6> {
    SVector::from_iterator(start.iter().chain(end.iter()).copied())
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
/// Orientations tried in space: about 15 degrees apart.
const SPATIAL_ORIENTATIONS: u32 = 200;
/// The same for a judgement that is wanted at once: half as fine.
const COARSE: (u32, u32, u32) = (24, 50, 7);

/// Fits sticks through points by trying orientations and places.
#[derive(Clone, Debug)]
pub struct StickFit {
    space: Space,
    directions: Vec<Vector>,
    places: u32,
}

impl StickFit {
    /// A fit in the plane or in space.
    #[must_use]
    pub fn new(space: Space) -> Self {
        Self::with(space, ORIENTATIONS, SPATIAL_ORIENTATIONS, PLACES)
    }

    /// A quicker fit with half the resolution.
    #[must_use]
    pub fn coarse(space: Space) -> Self {
        let (planar, spatial, places) = COARSE;
        Self::with(space, planar, spatial, places)
    }

    fn with(space: Space, planar: u32, spatial: u32, places: u32) -> Self {
        let directions = match space {
            Space::Planar => (0..planar).map(|index| planar_direction(index, planar)).collect(),
            Space::Spatial => (0..spatial).map(|index| spatial_direction(index, spatial)).collect(),
        };
        Self { space, directions, places }
    }

    /// The best of all sticks through `point`. `best_possible` is the sum of the log densities at the two modes.
    #[must_use]
    pub fn reachability(&self, point: &Point, limb: &Limb<'_>, best_possible: f64) -> Reachability {
        let region = self.space.region_95();
        let mut result = Reachability { score: f64::NEG_INFINITY, inside: false };
        for direction in &self.directions {
            for place in 0..self.places {
                let share = f64::from(place) / f64::from(self.places - 1);
                let start = point - direction * (limb.length * share);
                let end = start + direction * limb.length;
                let score = limb.log_density(&start, &end);
                result.score = result.score.max(score - best_possible);
                result.inside = result.inside
                    || (limb.start.contains(&start.coords, region) && limb.end.contains(&end.coords, region));
            }
        }
        result
    }
}

fn planar_direction(index: u32, count: u32) -> Vector {
    let (sine, cosine) = (TAU * f64::from(index) / f64::from(count)).sin_cos();
    Vector::new(cosine, sine, 0.0)
}

/// A point of the Fibonacci sphere: nearly equal spacing for any count.
fn spatial_direction(index: u32, count: u32) -> Vector {
    let golden = TAU * (1.0 - 1.0 / 1.618_033_988_749_895);
    let height = 1.0 - (2.0 * f64::from(index) + 1.0) / f64::from(count);
    let around = (1.0 - height * height).sqrt();
    let (sine, cosine) = (golden * f64::from(index)).sin_cos();
    Vector::new(around * cosine, around * sine, height)
}
