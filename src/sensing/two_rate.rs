//! A detector of slow resistance: the difference of a fast and a slow running mean of the force, as a vector.
//!
//! The thesis' window cannot see what builds over more than 150 ms; this can. While it reports contact its slow mean is
//! frozen, so that a steady pull stays visible, but only for a bounded time: a lasting change of bias would otherwise be
//! taken for contact for ever.

use super::window::{SensingError, within};
use crate::geometry::{Finite, Vector};
use serde::{Deserialize, Serialize};

/// How the two means are laid out.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct TwoRateSettings {
    /// Time constant of the fast mean in seconds.
    pub fast_seconds: f64,
    /// Time constant of the slow mean in seconds.
    pub slow_seconds: f64,
    /// A difference strictly beyond this begins a contact, in newtons.
    pub threshold_newtons: f64,
    /// A difference below this share of the threshold ends it.
    pub release_share: f64,
    /// The longest time for which the slow mean is frozen in contact, in seconds; 0 never freezes it.
    pub freeze_seconds: f64,
}

/// 0.06 s and 1.5 s with 2.5 N, found as fast as any other detector at equal false alarms (own comparison,
/// `valet reproduce detectors`).
impl Default for TwoRateSettings {
    fn default() -> Self {
        Self { fast_seconds: 0.06, slow_seconds: 1.5, threshold_newtons: 2.5, release_share: 0.6, freeze_seconds: 3.0 }
    }
}

impl TwoRateSettings {
    /// Checks the settings.
    ///
    /// # Errors
    /// Where a number is not finite or outside its range.
    pub fn validate(&self) -> Result<(), SensingError> {
        let Self { fast_seconds, slow_seconds, threshold_newtons, release_share, freeze_seconds } = *self;
        within("fast_seconds", fast_seconds, (0.01..=1.0).contains(&fast_seconds), "from 0.01 to 1 s")?;
        within(
            "slow_seconds",
            slow_seconds,
            slow_seconds > fast_seconds && slow_seconds <= 30.0,
            "above fast_seconds, up to 30 s",
        )?;
        within("threshold_newtons", threshold_newtons, (0.5..=15.0).contains(&threshold_newtons), "from 0.5 to 15 N")?;
        within("release_share", release_share, (0.1..=1.0).contains(&release_share), "from 0.1 to 1")?;
        within("freeze_seconds", freeze_seconds, (0.0..=10.0).contains(&freeze_seconds), "from 0 to 10 s")
    }
}

/// What the filter reads.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct TwoRateReading {
    /// The fast mean less the slow one, in newtons.
    pub change: Vector,
    /// Whether it reports contact.
    pub contact: bool,
}

/// The filter of one arm.
#[derive(Clone, Debug)]
pub struct TwoRate {
    settings: TwoRateSettings,
    means: Option<(Vector, Vector)>,
    reading: TwoRateReading,
    frozen_seconds: f64,
}

impl TwoRate {
    /// A filter that has seen nothing.
    ///
    /// # Errors
    /// Where a setting cannot be used.
    pub fn new(settings: TwoRateSettings) -> Result<Self, SensingError> {
        settings.validate()?;
        Ok(Self { settings, means: None, reading: TwoRateReading::default(), frozen_seconds: 0.0 })
    }

    /// Takes a force in newtons, `seconds` after the one before. A force or a span that is not finite empties the filter.
    pub fn push(&mut self, force: Vector, seconds: f64) -> TwoRateReading {
        self.push_with_threshold(force, seconds, self.settings.threshold_newtons)
    }

    /// As [`Self::push`], with a threshold of the moment in newtons, as while the arm's own acceleration blurs the force.
    pub fn push_with_threshold(&mut self, force: Vector, seconds: f64, threshold: f64) -> TwoRateReading {
        if !force.is_finite() || !(0.0..1.0).contains(&seconds) {
            self.reset();
            return self.reading;
        }
        let (mut fast, mut slow) = self.means.unwrap_or((force, force));
        fast += (force - fast) * share(seconds, self.settings.fast_seconds);
        if !self.is_frozen(seconds) {
            slow += (force - slow) * share(seconds, self.settings.slow_seconds);
        }
        self.means = Some((fast, slow));
        let change = fast - slow;
        let begins = change.norm() > threshold;
        let goes_on = self.reading.contact && change.norm() > threshold * self.settings.release_share;
        self.reading = TwoRateReading { change, contact: begins || goes_on };
        self.reading
    }

    fn is_frozen(&mut self, seconds: f64) -> bool {
        if !self.reading.contact {
            self.frozen_seconds = 0.0;
            return false;
        }
        self.frozen_seconds += seconds;
        self.frozen_seconds <= self.settings.freeze_seconds
    }

    /// The newest reading.
    #[must_use]
    pub const fn reading(&self) -> TwoRateReading {
        self.reading
    }

    /// Forgets everything: the next force is its own mean.
    pub fn reset(&mut self) {
        self.means = None;
        self.reading = TwoRateReading::default();
        self.frozen_seconds = 0.0;
    }
}

/// The share of the way that a first-order mean goes in a step.
fn share(seconds: f64, constant: f64) -> f64 {
    1.0 - (-seconds / constant).exp()
}

#[cfg(test)]
mod tests;
