//! The zero of an arm's force: taken while the arm stands still and unloaded, with its spread and its age.
//!
//! Baxter estimates the wrench from the springs in its joints, with an offset of several newtons that depends on posture,
//! tool and load. Nothing here decides *when* the arm is unloaded: the operator does, and this refuses what is not still.

use super::window::{SensingError, within};
use crate::geometry::{Finite, Vector};
use crate::time::Stamp;
use serde::{Deserialize, Serialize};
use std::collections::VecDeque;
use std::time::Duration;
use thiserror::Error;

/// How a zero is taken.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct BiasSettings {
    /// Samples of stillness that a zero is the mean of: half a second at 100 Hz.
    pub samples: usize,
    /// The largest standard deviation along an axis, in newtons, with which a zero is believed. Baxter's noise is
    /// thought to be 1 to 3 N; more means that somebody touches the arm.
    pub largest_spread_newtons: f64,
}

impl Default for BiasSettings {
    fn default() -> Self {
        Self { samples: 50, largest_spread_newtons: 3.0 }
    }
}

/// A zero.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Tare {
    /// When it was taken.
    pub stamp: Stamp,
    /// The force in newtons that counts as none.
    pub bias: Vector,
    /// Standard deviation along each axis, in newtons.
    pub spread: Vector,
}

/// Why a zero could not be taken.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
pub enum TareError {
    /// The arm has not been still for long enough.
    #[error("the arm has been still for {have} of {need} force samples: hold, wait a second, and tare again")]
    NotStill {
        /// Samples so far.
        have: usize,
        /// Samples needed.
        need: usize,
    },
    /// The force varies too much.
    #[error(
        "the force varies by {spread:.1} N while the arm stands still, more than {largest:.1} N: let go of it and tare again"
    )]
    Unsteady {
        /// The largest standard deviation along an axis, in newtons.
        spread: f64,
        /// The largest that is believed.
        largest: f64,
    },
}

/// Keeps the zero of one arm.
#[derive(Clone, Debug)]
pub struct BiasTracker {
    settings: BiasSettings,
    still: VecDeque<Vector>,
    tare: Option<Tare>,
}

impl BiasTracker {
    /// A tracker without a zero.
    ///
    /// # Errors
    /// Where a setting cannot be used.
    pub fn new(settings: BiasSettings) -> Result<Self, SensingError> {
        let BiasSettings { samples, largest_spread_newtons: spread } = settings;
        within("bias.samples", samples as f64, (10..=1000).contains(&samples), "from 10 to 1000")?;
        within("bias.largest_spread_newtons", spread, (0.1..=5.0).contains(&spread), "from 0.1 to 5 N")?;
        Ok(Self { settings, still: VecDeque::with_capacity(samples), tare: None })
    }

    /// Takes a force in newtons, and whether the arm stands still at that moment.
    pub fn observe(&mut self, force: Vector, still: bool) {
        if !still || !force.is_finite() {
            self.still.clear();
            return;
        }
        if self.still.len() == self.settings.samples {
            self.still.pop_front();
        }
        self.still.push_back(force);
    }

    /// Takes the mean of the last samples of stillness as zero.
    ///
    /// # Errors
    /// Where the arm was not still for long enough or its force was not steady; the zero before stays.
    pub fn tare(&mut self, now: Stamp) -> Result<Tare, TareError> {
        let (have, need) = (self.still.len(), self.settings.samples);
        if have < need {
            return Err(TareError::NotStill { have, need });
        }
        let bias = self.still.iter().sum::<Vector>() / have as f64;
        let variance =
            self.still.iter().map(|force| (force - bias).component_mul(&(force - bias))).sum::<Vector>() / have as f64;
        let spread = variance.map(f64::sqrt);
        let largest = self.settings.largest_spread_newtons;
        if spread.amax() > largest {
            return Err(TareError::Unsteady { spread: spread.amax(), largest });
        }
        let tare = Tare { stamp: now, bias, spread };
        self.tare = Some(tare);
        Ok(tare)
    }

    /// The zero in use; `None` where none was taken.
    #[must_use]
    pub const fn zero(&self) -> Option<&Tare> {
        self.tare.as_ref()
    }

    /// How old the zero is.
    #[must_use]
    pub fn age(&self, now: Stamp) -> Option<Duration> {
        self.tare.map(|tare| now.since(tare.stamp))
    }

    /// A force without its bias, in newtons; the force itself where no zero was taken.
    #[must_use]
    pub fn apply(&self, force: Vector) -> Vector {
        self.tare.map_or(force, |tare| force - tare.bias)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn still_for(samples: usize, force: impl Fn(usize) -> Vector) -> BiasTracker {
        let mut tracker = BiasTracker::new(BiasSettings::default()).unwrap();
        for index in 0..samples {
            tracker.observe(force(index), true);
        }
        tracker
    }

    #[test]
    fn s_19_a_zero_needs_half_a_second_of_stillness() {
        let mut tracker = still_for(49, |_| Vector::new(1.0, 2.0, 3.0));
        assert_eq!(tracker.tare(Stamp::ZERO), Err(TareError::NotStill { have: 49, need: 50 }));
        tracker.observe(Vector::new(1.0, 2.0, 3.0), true);
        let tare = tracker.tare(Stamp::ZERO).unwrap();
        assert!((tare.bias - Vector::new(1.0, 2.0, 3.0)).norm() < 1e-12);
        assert!(tracker.apply(Vector::new(1.0, 2.0, 8.0)).z - 5.0 < 1e-12);
    }

    #[test]
    fn motion_and_numbers_that_are_none_start_the_wait_anew() {
        let mut tracker = still_for(60, |_| Vector::zeros());
        tracker.observe(Vector::zeros(), false);
        assert!(matches!(tracker.tare(Stamp::ZERO), Err(TareError::NotStill { have: 0, .. })));
        let mut tracker = still_for(60, |_| Vector::zeros());
        tracker.observe(Vector::new(f64::NAN, 0.0, 0.0), true);
        assert!(matches!(tracker.tare(Stamp::ZERO), Err(TareError::NotStill { have: 0, .. })));
    }

    #[test]
    fn s_19_an_arm_that_is_touched_keeps_its_old_zero() {
        let mut tracker = still_for(50, |_| Vector::zeros());
        let first = tracker.tare(Stamp::ZERO).unwrap();
        for index in 0..50 {
            tracker.observe(Vector::new(if index % 2 == 0 { 8.0 } else { -8.0 }, 0.0, 0.0), true);
        }
        assert!(matches!(tracker.tare(Stamp::from_nanoseconds(9)), Err(TareError::Unsteady { .. })));
        assert_eq!(tracker.zero(), Some(&first));
    }

    #[test]
    fn the_age_of_a_zero_is_known_and_without_one_the_force_is_left_as_it_is() {
        let mut tracker = still_for(50, |_| Vector::x());
        assert_eq!(tracker.age(Stamp::ZERO), None);
        assert_eq!(tracker.apply(Vector::y()), Vector::y());
        tracker.tare(Stamp::ZERO).unwrap();
        assert_eq!(tracker.age(Stamp::from_nanoseconds(7)), Some(Duration::from_nanos(7)));
    }

    #[test]
    fn settings_out_of_range_are_refused_by_name() {
        let error = BiasTracker::new(BiasSettings { samples: 3, ..BiasSettings::default() }).unwrap_err();
        assert_eq!(error.key, "bias.samples");
        let settings = BiasSettings { largest_spread_newtons: f64::NAN, ..BiasSettings::default() };
        assert_eq!(BiasTracker::new(settings).unwrap_err().key, "bias.largest_spread_newtons");
    }

    proptest! {
        #[test]
        fn a_constant_force_is_taken_away_whole(x in -9.0..9.0_f64, y in -9.0..9.0_f64, z in -9.0..9.0_f64) {
            let mut tracker = still_for(50, |_| Vector::new(x, y, z));
            tracker.tare(Stamp::ZERO).unwrap();
            prop_assert!(tracker.apply(Vector::new(x, y, z)).norm() < 1e-9);
        }
    }
}
