//! The seeded generator behind every draw of the learning rooms, so that a seed repeats a result on any machine.
//!
//! `SplitMix64` (Steele, Lea and Flood, 2014): tiny, fast, and the same in every language. Never used for secrets.

use crate::geometry::Vector;
use std::f64::consts::TAU;

/// A `SplitMix64` generator.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SplitMix64 {
    state: u64,
}

impl SplitMix64 {
    /// A generator from its seed.
    #[must_use]
    pub const fn new(seed: u64) -> Self {
        Self { state: seed }
    }

    /// The next 64 bits.
    pub const fn next_u64(&mut self) -> u64 {
        self.state = self.state.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut mixed = self.state;
        mixed = (mixed ^ (mixed >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        mixed ^ (mixed >> 31)
    }

    /// A uniform number in [0, 1), of 53 bits.
    pub fn uniform(&mut self) -> f64 {
        (self.next_u64() >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// A uniform number in [`low`, `high`).
    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.uniform()
    }

    /// A whole number in [0, `count`); 0 where `count` is 0.
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "the product lies in [0, count)")]
    pub fn below(&mut self, count: usize) -> usize {
        ((self.uniform() * count as f64) as usize).min(count.saturating_sub(1))
    }

    /// A standard normal number (Box and Muller; two uniform numbers a draw).
    pub fn normal(&mut self) -> f64 {
        let radius = (-2.0 * (1.0 - self.uniform()).ln()).sqrt();
        radius * (TAU * self.uniform()).cos()
    }

    /// A point of the disc of `radius` in the plane z = 0, uniform by area.
    pub fn in_disc(&mut self, radius: f64) -> Vector {
        let distance = radius * self.uniform().sqrt();
        let (sine, cosine) = (TAU * self.uniform()).sin_cos();
        Vector::new(distance * cosine, distance * sine, 0.0)
    }

    /// A point of the ball of `radius`, uniform by volume.
    pub fn in_ball(&mut self, radius: f64) -> Vector {
        let distance = radius * self.uniform().cbrt();
        let height = 2.0 * self.uniform() - 1.0;
        let (sine, cosine) = (TAU * self.uniform()).sin_cos();
        let around = (1.0 - height * height).max(0.0).sqrt();
        Vector::new(around * cosine, around * sine, height) * distance
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn draws_are_those_of_the_published_generator() {
        let file: serde_json::Value =
            serde_json::from_str(include_str!("../../tests/vectors/algorithms/prng.json")).unwrap();
        let mut random = SplitMix64::new(42);
        for word in file["seed42_u64"].as_array().unwrap() {
            assert_eq!(random.next_u64().to_string(), word.as_str().unwrap());
        }
        let mut random = SplitMix64::new(42);
        for number in file["seed42_uniform"].as_array().unwrap() {
            assert!((random.uniform() - number.as_f64().unwrap()).abs() < 1e-12);
        }
        let mut random = SplitMix64::new(42);
        for number in file["seed42_normal"].as_array().unwrap() {
            assert!((random.normal() - number.as_f64().unwrap()).abs() < 1e-12);
        }
    }

    #[test]
    fn balls_and_discs_are_those_of_the_published_generator() {
        let file: serde_json::Value =
            serde_json::from_str(include_str!("../../tests/vectors/algorithms/prng.json")).unwrap();
        let lists = file["seed7_ball2_r0.5_x3_then_ball3_r0.5_x3"].as_array().unwrap();
        let mut random = SplitMix64::new(7);
        for (list, planar) in lists.iter().zip([true, false]) {
            for expected in list.as_array().unwrap() {
                let drawn = if planar { random.in_disc(0.5) } else { random.in_ball(0.5) };
                for (axis, value) in expected.as_array().unwrap().iter().enumerate() {
                    assert!((drawn[axis] - value.as_f64().unwrap()).abs() < 1e-12);
                }
            }
        }
    }

    #[test]
    fn whole_numbers_stay_below_their_count() {
        let mut random = SplitMix64::new(3);
        assert!((0..1000).all(|_| random.below(7) < 7));
        assert_eq!(random.below(0), 0);
    }
}
