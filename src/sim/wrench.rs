//! The wrench as Baxter gives it: an estimate from joint torques, not a sensor at the wrist.
//!
//! Takes the true force on a gripper and returns what `/robot/limb/{s}/endpoint_state` would say: the opposite sign in
//! axes parallel to `base`, late, noisy, with a bias that changes with the pose, a share of the arm's own acceleration,
//! and in steps of a quantum. No figure for Baxter's noise was ever published; the defaults are assumptions that lie
//! between the thresholds that people needed on real robots, and are to be replaced by a recording.

use super::random::Random;
use crate::geometry::{Point, Vector, Wrench};
use serde::{Deserialize, Serialize};
use std::collections::VecDeque;

/// Samples between a force and its report at the most (0.2 s at 100 Hz).
const MAXIMUM_DELAY_SAMPLES: usize = 20;

/// How the wrench estimate errs.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct WrenchErrors {
    /// Standard deviation of the white noise on each axis in newtons.
    pub noise_newtons: f64,
    /// Amplitude of the bias that changes with the pose, in newtons.
    pub bias_newtons: f64,
    /// How far the gripper travels for one period of that bias, in metres.
    pub bias_period_metres: f64,
    /// Random walk of the bias in newtons per square root of a second.
    pub drift_newtons: f64,
    /// Samples of 10 ms between a force and its report.
    pub delay_samples: usize,
    /// Steps of the estimate in newtons; 0 for none.
    pub quantum_newtons: f64,
    /// The part of the moved mass that the gravity model misses, in kilograms: its acceleration shows as force.
    pub unmodelled_mass_kilograms: f64,
}

impl Default for WrenchErrors {
    fn default() -> Self {
        Self {
            noise_newtons: 0.25,
            bias_newtons: 2.0,
            bias_period_metres: 1.5,
            drift_newtons: 0.05,
            delay_samples: 3,
            quantum_newtons: 0.01,
            unmodelled_mass_kilograms: 0.4,
        }
    }
}

impl WrenchErrors {
    /// A perfect sense: what is felt is reported at once.
    pub const NONE: Self = Self {
        noise_newtons: 0.0,
        bias_newtons: 0.0,
        bias_period_metres: 1.0,
        drift_newtons: 0.0,
        delay_samples: 0,
        quantum_newtons: 0.0,
        unmodelled_mass_kilograms: 0.0,
    };
}

/// The wrench estimate of one arm.
#[derive(Clone, Debug)]
pub(super) struct WrenchSense {
    errors: WrenchErrors,
    random: Random,
    phases: Vector,
    drift: Vector,
    late: VecDeque<Vector>,
}

impl WrenchSense {
    pub(super) fn new(errors: WrenchErrors, mut random: Random) -> Self {
        let turn = std::f64::consts::TAU;
        let phases = Vector::new(random.between(0.0, turn), random.between(0.0, turn), random.between(0.0, turn));
        Self {
            errors,
            random,
            phases,
            drift: Vector::zeros(),
            late: VecDeque::with_capacity(MAXIMUM_DELAY_SAMPLES + 1),
        }
    }

    /// What the robot reports 10 ms after the last call, for the force that acts on the gripper (newtons, `base` axes).
    pub(super) fn report(&mut self, force: &Vector, tip: &Point, acceleration: &Vector, seconds: f64) -> Wrench {
        if self.errors.drift_newtons > 0.0 {
            self.drift += self.random.normal_vector(self.errors.drift_newtons * seconds.sqrt());
        }
        let felt = force - acceleration * self.errors.unmodelled_mass_kilograms + self.bias(tip) + self.drift;
        self.late.push_back(felt);
        let delay = self.errors.delay_samples.min(MAXIMUM_DELAY_SAMPLES);
        while self.late.len() > delay + 1 {
            self.late.pop_front();
        }
        let old = self.late.front().copied().unwrap_or(felt);
        let noisy = old + self.random.normal_vector(self.errors.noise_newtons);
        // The robot reports the force that it applies to the world, not the one that it feels.
        Wrench { force: -self.in_steps(noisy), torque: Vector::zeros() }
    }

    /// The error of the gravity and spring model at a place: smooth, so that it changes slowly as the arm moves.
    fn bias(&self, tip: &Point) -> Vector {
        let wave = std::f64::consts::TAU / self.errors.bias_period_metres;
        let path = Vector::new(tip.x + 0.5 * tip.y, tip.y + 0.5 * tip.z, tip.z + 0.5 * tip.x) * wave + self.phases;
        path.map(f64::sin) * self.errors.bias_newtons
    }

    fn in_steps(&self, force: Vector) -> Vector {
        let quantum = self.errors.quantum_newtons;
        if quantum > 0.0 { force.map(|value| (value / quantum).round() * quantum) } else { force }
    }
}

#[cfg(test)]
mod tests {
    use super::super::random::Purpose;
    use super::*;

    fn sense(errors: WrenchErrors) -> WrenchSense {
        WrenchSense::new(errors, Random::new(1, Purpose::LeftWrench))
    }

    #[test]
    fn the_sign_is_the_robots_and_nothing_else_changes_without_errors() {
        let force = Vector::new(1.0, -2.0, 3.0);
        let report = sense(WrenchErrors::NONE).report(&force, &Point::origin(), &Vector::zeros(), 0.01);
        assert_eq!(report.force, -force);
    }

    #[test]
    fn a_step_of_force_comes_after_the_delay_and_not_before() {
        let mut sense = sense(WrenchErrors { delay_samples: 3, ..WrenchErrors::NONE });
        let quiet = Vector::zeros();
        for _ in 0..5 {
            sense.report(&quiet, &Point::origin(), &quiet, 0.01);
        }
        let reports: Vec<f64> =
            (0..4).map(|_| sense.report(&Vector::new(8.0, 0.0, 0.0), &Point::origin(), &quiet, 0.01).force.x).collect();
        assert_eq!(reports, [0.0, 0.0, 0.0, -8.0]);
    }

    #[test]
    fn the_bias_changes_with_the_pose_and_stays_within_its_amplitude() {
        let mut sense = sense(WrenchErrors { bias_newtons: 2.0, bias_period_metres: 1.0, ..WrenchErrors::NONE });
        let at = |sense: &mut WrenchSense, x| {
            sense.report(&Vector::zeros(), &Point::new(x, 0.0, 0.0), &Vector::zeros(), 0.01).force
        };
        let (here, there) = (at(&mut sense, 0.0), at(&mut sense, 0.4));
        assert!((here - there).norm() > 0.5);
        assert!(here.amax() <= 2.0 && there.amax() <= 2.0);
    }

    #[test]
    fn reports_are_multiples_of_the_quantum() {
        let mut sense = sense(WrenchErrors { quantum_newtons: 0.5, ..WrenchErrors::default() });
        for _ in 0..50 {
            let force = sense.report(&Vector::new(3.3, 0.1, -7.7), &Point::origin(), &Vector::zeros(), 0.01).force;
            for value in force.iter() {
                assert!(((value / 0.5).round() * 0.5 - value).abs() < 1e-12);
            }
        }
    }

    #[test]
    fn the_arms_own_acceleration_shows_as_force() {
        let mut sense = sense(WrenchErrors { unmodelled_mass_kilograms: 0.5, ..WrenchErrors::NONE });
        let report = sense.report(&Vector::zeros(), &Point::origin(), &Vector::new(2.0, 0.0, 0.0), 0.01);
        assert!((report.force.x - 1.0).abs() < 1e-12);
    }
}
