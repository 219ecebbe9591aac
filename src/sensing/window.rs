//! The resistance window of the thesis (section 4.4.2): the change of force over the last N samples.
//!
//! A sum of N consecutive differences is the newest force minus the force N samples ago, so the window needs N + 1
//! samples and sees only what builds within N samples: at 15 samples and 100 Hz a ramp below 33.3 N/s never passes 5 N.
//! The force guard of the safety room exists because of that.
//!
//! The window is *broken* by a missing, late, reordered or non-finite sample: it starts anew. It is never shortened, for a
//! window that spans less or more time than it says compares with the wrong threshold.

use crate::geometry::{Finite, Vector};
use crate::time::Stamp;
use serde::{Deserialize, Serialize};
use std::collections::VecDeque;
use std::fmt;
use thiserror::Error;

/// Which statistic is compared with the threshold.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum WindowForm {
    /// The change of the magnitude (thesis section 4.4.2). Blind to a sideways force on a preload.
    Magnitude,
    /// The largest change along one axis (thesis section 4.2).
    Axis,
    /// The magnitude of the change as a vector: independent of axes and of preload.
    #[default]
    Vector,
}

/// How the window is laid out.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct WindowSettings {
    /// Differences in a full window; the thesis' N = 15 (section 4.4.2).
    pub length: usize,
    /// Samples per second that are expected; the wrench comes at 100 Hz (thesis section 4.4.2).
    pub rate_hertz: f64,
    /// A statistic beyond this is resistance, in newtons: 5 N (thesis section 4.4.2).
    pub threshold_newtons: f64,
    /// Which statistic is compared.
    pub form: WindowForm,
    /// How far the time between two samples may be off the expected period, as a share of that period.
    pub late_tolerance: f64,
}

impl Default for WindowSettings {
    fn default() -> Self {
        Self { length: 15, rate_hertz: 100.0, threshold_newtons: 5.0, form: WindowForm::Vector, late_tolerance: 0.5 }
    }
}

/// A setting of the sensing room that cannot be used.
#[derive(Clone, Debug, PartialEq, Error)]
#[error("{key} is {value}: it must be {range}")]
pub struct SensingError {
    /// The setting's key.
    pub key: &'static str,
    /// What was given.
    pub value: f64,
    /// What is allowed, in words.
    pub range: &'static str,
}

/// Refuses a number outside a range; the error names the key.
pub(super) fn within(key: &'static str, value: f64, allowed: bool, range: &'static str) -> Result<(), SensingError> {
    if value.is_finite() && allowed { Ok(()) } else { Err(SensingError { key, value, range }) }
}

impl WindowSettings {
    /// Checks the settings.
    ///
    /// # Errors
    /// Where a number is not finite or outside its range.
    pub fn validate(&self) -> Result<(), SensingError> {
        let Self { length, rate_hertz, threshold_newtons, late_tolerance, .. } = *self;
        within("length", length as f64, (1..=1000).contains(&length), "from 1 to 1000 differences")?;
        within("rate_hertz", rate_hertz, (1.0..=1000.0).contains(&rate_hertz), "from 1 to 1000 Hz")?;
        // Above 15 N the force guard holds before the window could speak.
        within("threshold_newtons", threshold_newtons, (0.5..=15.0).contains(&threshold_newtons), "from 0.5 to 15 N")?;
        within("late_tolerance", late_tolerance, (0.05..=0.95).contains(&late_tolerance), "from 0.05 to 0.95 periods")
    }
}

/// Why a window had to start anew.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum BreakCause {
    /// The time since the sample before is not the expected period; it is given in seconds.
    Gap {
        /// Seconds between the two samples' stamps.
        seconds: f64,
    },
    /// The sample is not later than the one before.
    Reordered,
    /// The sample holds a number that is not finite.
    NotFinite,
    /// The window was emptied on purpose, as at the start of a motion.
    Reset,
}

/// The cause in the operator's words.
impl fmt::Display for BreakCause {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Gap { seconds } => write!(formatter, "{:.0} ms between two force samples", seconds * 1000.0),
            Self::Reordered => formatter.write_str("a force sample older than the one before"),
            Self::NotFinite => formatter.write_str("a force that is not a finite number"),
            Self::Reset => formatter.write_str("emptied with the motion"),
        }
    }
}

/// What a full window reads.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WindowReading {
    /// Stamp of the newest sample.
    pub stamp: Stamp,
    /// Change of force along each axis over the window, in newtons.
    pub axes: Vector,
    /// The statistic of the chosen form in newtons; signed for [`WindowForm::Magnitude`].
    pub combined: f64,
}

/// A resistance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Detection {
    /// Stamp of the sample that showed it.
    pub stamp: Stamp,
    /// Change of force over the window along each axis, in newtons, in the axes of the force that was pushed.
    pub resistance: Vector,
    /// The compared statistic, in newtons, always positive: what the energy of an iteration sums.
    pub magnitude: f64,
}

/// The window of one arm.
///
/// ```
/// use valet::geometry::Vector;
/// use valet::sensing::{ForceWindow, WindowSettings};
/// use valet::time::Stamp;
///
/// let mut window = ForceWindow::new(WindowSettings::default())?;
/// for index in 0..16_u64 {
///     let pull = if index < 10 { 0.0 } else { 6.0 };
///     window.push(Stamp::from_nanoseconds(index * 10_000_000), Vector::new(pull, 0.0, 0.0));
/// }
/// assert_eq!(window.detect().map(|found| found.magnitude), Some(6.0));
/// # Ok::<(), valet::sensing::SensingError>(())
/// ```
#[derive(Clone, Debug)]
pub struct ForceWindow {
    settings: WindowSettings,
    samples: VecDeque<(Stamp, Vector)>,
    reading: Option<WindowReading>,
    last_break: Option<BreakCause>,
}

impl ForceWindow {
    /// An empty window.
    ///
    /// # Errors
    /// Where a setting cannot be used.
    pub fn new(settings: WindowSettings) -> Result<Self, SensingError> {
        settings.validate()?;
        let samples = VecDeque::with_capacity(settings.length + 1);
        Ok(Self { settings, samples, reading: None, last_break: None })
    }

    /// The settings it was made with.
    #[must_use]
    pub const fn settings(&self) -> &WindowSettings {
        &self.settings
    }

    /// Takes a sample with its header stamp and its force in newtons; `None` while the window fills.
    ///
    /// A sample that repeats the stamp and the force of the one before is the same message twice and changes nothing.
    pub fn push(&mut self, stamp: Stamp, force: Vector) -> Option<WindowReading> {
        if self.samples.back() == Some(&(stamp, force)) {
            return self.reading;
        }
        if let Some(cause) = self.break_cause(stamp, force) {
            self.empty(cause);
        }
        if !force.is_finite() {
            return None;
        }
        if self.samples.len() > self.settings.length {
            self.samples.pop_front();
        }
        self.samples.push_back((stamp, force));
        self.reading = self.read();
        self.reading
    }

    fn break_cause(&self, stamp: Stamp, force: Vector) -> Option<BreakCause> {
        if !force.is_finite() {
            return Some(BreakCause::NotFinite);
        }
        let (last, _) = *self.samples.back()?;
        let Some(span) = stamp.checked_since(last).filter(|span| !span.is_zero()) else {
            return Some(BreakCause::Reordered);
        };
        let seconds = span.as_secs_f64();
        let off = (seconds * self.settings.rate_hertz - 1.0).abs();
        (off > self.settings.late_tolerance).then_some(BreakCause::Gap { seconds })
    }

    fn read(&self) -> Option<WindowReading> {
        if self.samples.len() <= self.settings.length {
            return None;
        }
        let (_, oldest) = *self.samples.front()?;
        let (stamp, newest) = *self.samples.back()?;
        let axes = newest - oldest;
        let combined = match self.settings.form {
            WindowForm::Magnitude => newest.norm() - oldest.norm(),
            WindowForm::Axis => axes.amax(),
            WindowForm::Vector => axes.norm(),
        };
        Some(WindowReading { stamp, axes, combined })
    }

    fn empty(&mut self, cause: BreakCause) {
        self.samples.clear();
        self.reading = None;
        self.last_break = Some(cause);
    }

    /// Empties the window on purpose, as when the arm's own motion changes.
    pub fn reset(&mut self) {
        self.empty(BreakCause::Reset);
    }

    /// The newest reading of a full window.
    #[must_use]
    pub const fn reading(&self) -> Option<WindowReading> {
        self.reading
    }

    /// Differences in the window now: a full one has as many as its length.
    #[must_use]
    pub fn filled(&self) -> usize {
        self.samples.len().saturating_sub(1)
    }

    /// Why it was emptied last.
    #[must_use]
    pub const fn last_break(&self) -> Option<BreakCause> {
        self.last_break
    }

    /// The resistance that the newest reading shows: its statistic is strictly beyond the threshold.
    #[must_use]
    pub fn detect(&self) -> Option<Detection> {
        let WindowReading { stamp, axes, combined } = self.reading?;
        let magnitude = combined.abs();
        (magnitude > self.settings.threshold_newtons).then_some(Detection { stamp, resistance: axes, magnitude })
    }
}

#[cfg(test)]
mod tests;
