//! Synthetic problems: pairs of an initial and an optimal path (thesis section 4.5.1), scenes of three joints
//! (section 5.2.1), and the ways in which a sensor errs.
//!
//! Lengths have no unit there; the thesis' thresholds and steps are used as they are. All in the plane z = 0.

use crate::geometry::{Curve, Point, Vector};
use crate::modelling::{ArmSpace, Mixture, MixtureError, SplitMix64};
use nalgebra::{Matrix2, Vector2};
use serde::Serialize;
use std::f64::consts::PI;

/// Points of an optimal path.
const RESOLUTION: u32 = 100;

/// A family of pairs.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub enum PairSet {
    /// One half sine of chord 2 and height 0.6 to 1.4: closest to the thesis' table.
    A,
    /// Three harmonics, chord 4, height 0.6 to 1.4.
    B,
    /// Two harmonics, chord 3, height 0.3 to 0.7: every place has one closest point on the path.
    C,
}

impl PairSet {
    /// All sets.
    pub const ALL: [Self; 3] = [Self::A, Self::B, Self::C];

    const fn shape(self) -> (f64, u32, [f64; 2]) {
        match self {
            Self::A => (2.0, 1, [0.6, 1.4]),
            Self::B => (4.0, 3, [0.6, 1.4]),
            Self::C => (3.0, 2, [0.3, 0.7]),
        }
    }
}

/// An initial path and the optimal one that is to be found.
#[derive(Clone, Debug, PartialEq)]
pub struct Pair {
    /// A straight line.
    pub initial: Vec<Point>,
    /// A curve with the same ends.
    pub optimal: Curve,
}

impl Pair {
    /// A random pair of a set. Seeds of experiments are a thousand pairs apart: see [`seed_of`].
    #[must_use]
    pub fn random(set: PairSet, seed: u64) -> Self {
        let mut random = SplitMix64::new(seed);
        let (chord, harmonics, [low, high]) = set.shape();
        let height = random.between(low, high) * if random.uniform() < 0.5 { -1.0 } else { 1.0 };
        let weights: Vec<f64> = (0..harmonics).map(|index| random.normal() / f64::from(index + 1)).collect();
        let wave = |share: f64| -> f64 {
            let terms = weights.iter().enumerate();
            terms.map(|(index, weight)| weight * (PI * (index as f64 + 1.0) * share).sin()).sum()
        };
        let shares = || (0..=RESOLUTION).map(|index| f64::from(index) / f64::from(RESOLUTION));
        let peak = shares().map(|share| wave(share).abs()).fold(f64::MIN_POSITIVE, f64::max);
        let (start, end) = (Point::origin(), Point::new(chord, 0.0, 0.0));
        let mut optimal: Vec<Point> =
            shares().map(|share| Point::new(chord * share, height * wave(share) / peak, 0.0)).collect();
        if let Some(last) = optimal.last_mut() {
            *last = end;
        }
        Self { initial: vec![start, end], optimal: Curve::new(optimal) }
    }

    /// The sum over all way-points of the distance to the optimal path: the thesis' error.
    #[must_use]
    pub fn error(&self, path: &[Point]) -> f64 {
        path.iter().map(|point| self.optimal.displacement(point).norm()).sum()
    }
}

/// The seed of problem `index` (below 1,000) of the experiment with seed `seed`: no two experiments share a problem.
#[must_use]
pub const fn seed_of(seed: u64, index: u64) -> u64 {
    seed.wrapping_sub(1).wrapping_mul(1_000).wrapping_add(1).wrapping_add(index)
}

/// How a sensor errs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SensorError {
    /// Not at all.
    None,
    /// By a share of the reading, normally distributed.
    Multiplicative(f64),
    /// By a normally distributed vector of this deviation an axis.
    Additive(f64),
    /// By a constant along x and y of this length.
    Bias(f64),
    /// By a random turn of this deviation in degrees.
    Direction(f64),
    /// By a constant turn in degrees.
    Rotation(f64),
    /// By a constant factor: a garment softer or stiffer than expected.
    Stiffness(f64),
}

impl SensorError {
    /// The columns of the robustness table.
    pub const ALL: [Self; 12] = [
        Self::None,
        Self::Multiplicative(0.1),
        Self::Multiplicative(0.3),
        Self::Additive(0.01),
        Self::Additive(0.03),
        Self::Bias(0.05),
        Self::Direction(20.0),
        Self::Direction(45.0),
        Self::Rotation(30.0),
        Self::Rotation(60.0),
        Self::Stiffness(0.3),
        Self::Stiffness(3.0),
    ];

    /// The error in words.
    #[must_use]
    pub fn name(self) -> String {
        match self {
            Self::None => "none".into(),
            Self::Multiplicative(share) => format!("multiplicative {:.0} %", share * 100.0),
            Self::Additive(deviation) => format!("additive {deviation}"),
            Self::Bias(length) => format!("bias {length}"),
            Self::Direction(degrees) => format!("direction {degrees} deg"),
            Self::Rotation(degrees) => format!("rotation {degrees} deg"),
            Self::Stiffness(factor) => format!("stiffness {factor}"),
        }
    }

    /// What the sensor says where `exact` is true.
    pub fn reading(self, exact: Vector, random: &mut SplitMix64) -> Vector {
        match self {
            Self::None => exact,
            Self::Multiplicative(share) => exact * (1.0 + share * random.normal()),
            Self::Additive(deviation) => exact + Vector::new(random.normal(), random.normal(), 0.0) * deviation,
            Self::Bias(length) => exact + Vector::new(1.0, 1.0, 0.0).normalize() * length,
            Self::Direction(degrees) => turned(&exact, degrees * random.normal()),
            Self::Rotation(degrees) => turned(&exact, degrees),
            Self::Stiffness(factor) => exact * factor,
        }
    }
}

fn turned(vector: &Vector, degrees: f64) -> Vector {
    let (sine, cosine) = degrees.to_radians().sin_cos();
    Vector::new(cosine * vector.x - sine * vector.y, sine * vector.x + cosine * vector.y, vector.z)
}

/// A scene of section 5.2.1: where three joints can be, the initial path through them, and a reference force path.
#[derive(Clone, Debug)]
pub struct Scene {
    /// The mixtures of the joints.
    pub space: ArmSpace,
    /// The modes of the first and the last joint, and a draw of the middle one.
    pub initial: [Point; 3],
    /// Where no force would be felt.
    pub reference: Curve,
}

impl Scene {
    /// A random scene. `components` are the numbers of Gaussians of the joints; `deviation` is how far the reference
    /// force path strays from the initial path at most.
    ///
    /// # Errors
    /// [`MixtureError`] where a random covariance is not positive definite, which its making excludes.
    pub fn random(components: [usize; 3], deviation: f64, seed: u64) -> Result<Self, MixtureError> {
        let mut random = SplitMix64::new(seed);
        let mut joint = |x: f64, count: usize| mixture(x, count, &mut random);
        let space = ArmSpace {
            hand: joint(0.0, components[0])?,
            elbow: joint(2.7, components[1])?,
            shoulder: joint(5.2, components[2])?,
            whole: None,
        };
        let middle = Point::from(space.elbow.sample(&mut random));
        let initial = [space.hand.mode(), Point::new(middle.x, middle.y, 0.0), space.shoulder.mode()];
        let reference = Curve::new(stray(&initial, deviation, &mut random));
        Ok(Self { space, initial, reference })
    }

    /// A random scene with one to four Gaussians a joint.
    ///
    /// # Errors
    /// As [`Scene::random`].
    pub fn any(deviation: f64, seed: u64) -> Result<Self, MixtureError> {
        let mut random = SplitMix64::new(seed ^ 0x5CE7E);
        let components = [0; 3].map(|_: usize| 1 + random.below(4));
        Self::random(components, deviation, seed)
    }
}

fn mixture(x: f64, count: usize, random: &mut SplitMix64) -> Result<Mixture, MixtureError> {
    let centre = Vector2::new(x + 0.4 * random.normal(), 0.4 * random.normal());
    let weights: Vec<f64> = (0..count).map(|_| random.between(0.3, 1.0)).collect();
    let sum: f64 = weights.iter().sum();
    Mixture::planar(weights.into_iter().map(|weight| {
        let mean = centre + Vector2::new(random.normal(), random.normal()) * 0.3;
        let (wide, narrow) = (random.between(0.35, 0.6), random.between(0.25, 0.45));
        let (sine, cosine) = random.between(0.0, PI).sin_cos();
        let turn = Matrix2::new(cosine, -sine, sine, cosine);
        let covariance = turn * Matrix2::new(wide * wide, 0.0, 0.0, narrow * narrow) * turn.transpose();
        (weight / sum, mean, (covariance + covariance.transpose()) * 0.5)
    }))
}

/// A smooth curve with the ends of `initial` that strays from it by `deviation` at most.
fn stray(initial: &[Point; 3], deviation: f64, random: &mut SplitMix64) -> Vec<Point> {
    let weights = [1.0, 0.6, 0.3].map(|scale: f64| scale * random.normal());
    let wave = |share: f64| -> f64 {
        weights.iter().zip([1.0, 2.0, 3.0]).map(|(weight, order)| weight * (PI * order * share).sin()).sum()
    };
    let line =
        crate::planning::line::resample(initial, crate::geometry::polyline_length(initial) / f64::from(RESOLUTION));
    let [start, _, end] = initial;
    let normal = Vector::new(start.y - end.y, end.x - start.x, 0.0).normalize();
    let count = (line.len().max(2) - 1) as f64;
    let share = |index: usize| index as f64 / count;
    let peak = (0..line.len()).map(|index| wave(share(index)).abs()).fold(f64::MIN_POSITIVE, f64::max);
    let last = line.len().saturating_sub(1);
    line.iter()
        .enumerate()
        .map(|(index, point)| {
            if index == 0 || index == last { *point } else { point + normal * (deviation * wave(share(index)) / peak) }
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pairs_repeat_with_their_seed_and_have_the_promised_height() {
        for set in PairSet::ALL {
            let (_, _, [low, high]) = set.shape();
            for seed in 0..20 {
                let pair = Pair::random(set, seed);
                assert_eq!(pair, Pair::random(set, seed));
                let height = pair.optimal.points().iter().map(|point| point.y.abs()).fold(0.0, f64::max);
                assert!((low - 1e-9..=high + 1e-9).contains(&height));
                assert_eq!(pair.initial.last(), pair.optimal.points().last());
                assert!(pair.error(pair.optimal.points()) < 1e-9);
            }
        }
    }

    #[test]
    fn scenes_have_the_components_asked_for_and_a_reference_with_the_same_ends() {
        let scene = Scene::random([3, 2, 1], 0.9, 4).unwrap();
        assert_eq!(scene.space.dressed().map(|joint| joint.components().len()), [3, 2, 1]);
        assert_eq!(scene.reference.points().first(), Some(&scene.initial[0]));
        assert_eq!(scene.reference.points().last(), Some(&scene.initial[2]));
        let initial = Curve::new(scene.initial.to_vec());
        let strays = scene.reference.points().iter().map(|point| initial.displacement(point).norm());
        assert!(strays.fold(0.0, f64::max) <= 0.9 + 1e-9);
        for seed in 0..50 {
            assert!(Scene::any(0.9, seed).is_ok());
        }
    }

    #[test]
    fn errors_of_a_sensor_do_what_they_say() {
        let exact = Vector::new(0.3, 0.4, 0.0);
        let mut random = SplitMix64::new(1);
        assert_eq!(SensorError::None.reading(exact, &mut random), exact);
        assert!((SensorError::Rotation(90.0).reading(exact, &mut random) - Vector::new(-0.4, 0.3, 0.0)).norm() < 1e-12);
        assert!((SensorError::Direction(20.0).reading(exact, &mut random).norm() - 0.5).abs() < 1e-12);
        assert!(((SensorError::Bias(0.05).reading(exact, &mut random) - exact).norm() - 0.05).abs() < 1e-12);
    }
}
