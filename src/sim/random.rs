//! Seeded randomness of the simulator: one generator for each sense, so that switching one off leaves the others as they were.

use crate::geometry::Vector;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

/// What a stream of random numbers is for; each purpose has a stream of its own under one seed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Purpose {
    LeftWrench = 1,
    RightWrench = 2,
    LeftArm = 3,
    RightArm = 4,
    Camera = 5,
    Faults = 6,
    Body = 7,
}

/// A seeded source of normal and uniform numbers.
#[derive(Clone, Debug)]
pub(super) struct Random {
    generator: ChaCha8Rng,
    spare: Option<f64>,
}

impl Random {
    pub(super) fn new(seed: u64, purpose: Purpose) -> Self {
        let mut generator = ChaCha8Rng::seed_from_u64(seed);
        generator.set_stream(purpose as u64);
        Self { generator, spare: None }
    }

    /// A number from 0 to 1.
    pub(super) fn uniform(&mut self) -> f64 {
        self.generator.random()
    }

    /// A number from `low` to `high`.
    pub(super) fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.uniform()
    }

    /// A standard normal number (polar method of Marsaglia).
    pub(super) fn normal(&mut self) -> f64 {
        if let Some(spare) = self.spare.take() {
            return spare;
        }
        loop {
            let (x, y) = (self.between(-1.0, 1.0), self.between(-1.0, 1.0));
            let square = x * x + y * y;
            if square > 0.0 && square < 1.0 {
                let factor = (-2.0 * square.ln() / square).sqrt();
                self.spare = Some(y * factor);
                return x * factor;
            }
        }
    }

    /// Three independent normal numbers with the given standard deviation.
    pub(super) fn normal_vector(&mut self, deviation: f64) -> Vector {
        Vector::new(self.normal(), self.normal(), self.normal()) * deviation
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn normal_numbers_have_mean_zero_and_deviation_one() {
        let mut random = Random::new(7, Purpose::Camera);
        let numbers: Vec<f64> = (0..20_000).map(|_| random.normal()).collect();
        let mean = numbers.iter().sum::<f64>() / 20_000.0;
        let variance = numbers.iter().map(|number| (number - mean).powi(2)).sum::<f64>() / 20_000.0;
        assert!(mean.abs() < 0.03, "{mean}");
        assert!((variance - 1.0).abs() < 0.05, "{variance}");
    }

    #[test]
    fn purposes_under_one_seed_differ_and_the_same_purpose_repeats() {
        let draw = |purpose| Random::new(3, purpose).uniform();
        assert_ne!(draw(Purpose::LeftWrench).to_bits(), draw(Purpose::RightWrench).to_bits());
        assert_eq!(draw(Purpose::Body).to_bits(), draw(Purpose::Body).to_bits());
    }
}
