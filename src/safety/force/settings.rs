//! The force guard's settings and the caps that no setting raises.

use crate::geometry::Point;
use crate::safety::Reaction;
use crate::sensing::{BiasSettings, InertiaCompensation, SensingError, TwoRateSettings};
use serde::{Deserialize, Serialize};
use thiserror::Error;

/// The force beyond which the robot stops whatever is set: published trials of dressing by hand call more than 35 N a
/// hazard (Rafiq 2025).
pub const HARD_CAP_NEWTONS: f64 = 35.0;

/// How near to shoulder and neck the halved tiers hold, in metres: half the breadth of the shoulder's top (our choice).
const SHOULDER_RADIUS_METRES: f64 = 0.12;

/// Where the gripper is at the person.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Zone {
    /// Along the arm, or away from the person.
    #[default]
    Arm,
    /// Near a shoulder or the neck: every tier is halved.
    ShoulderOrNeck,
}

impl Zone {
    /// The zone of a place, given the shoulders and the neck as far as they are known, all in `base`.
    #[must_use]
    pub fn of(place: &Point, shoulders_and_neck: impl IntoIterator<Item = Point>) -> Self {
        let near = shoulders_and_neck.into_iter().any(|joint| (joint - place).norm() < SHOULDER_RADIUS_METRES);
        if near { Self::ShoulderOrNeck } else { Self::Arm }
    }
}

/// Where the tiers of the absolute force begin, in newtons.
///
/// The defaults are ours and no standard: a normal pull along the forearm is up to 10 N (Kapusta), human-human dressing
/// trials call 15 to 35 N suspect (Rafiq 2025).
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Tiers {
    /// The operator is told.
    pub advise: f64,
    /// The arm slows down.
    pub slow: f64,
    /// The arm holds.
    pub pause: f64,
    /// Emergency stop, latched.
    pub stop: f64,
}

impl Default for Tiers {
    fn default() -> Self {
        Self { advise: 8.0, slow: 12.0, pause: 15.0, stop: 25.0 }
    }
}

impl Tiers {
    /// The most that each tier can be set to, in newtons; the stop itself cannot be set beyond the hard cap.
    pub const MOST: Self = Self { advise: 15.0, slow: 20.0, pause: 25.0, stop: HARD_CAP_NEWTONS };

    /// The tiers in a zone.
    #[must_use]
    pub fn at(&self, zone: Zone) -> Self {
        let share = match zone {
            Zone::Arm => 1.0,
            Zone::ShoulderOrNeck => 0.5,
        };
        Self {
            advise: self.advise * share,
            slow: self.slow * share,
            pause: self.pause * share,
            stop: self.stop * share,
        }
    }

    const fn rising(&self) -> [(Reaction, f64); 4] {
        [
            (Reaction::Advise, self.advise),
            (Reaction::Slow, self.slow),
            (Reaction::Hold, self.pause),
            (Reaction::Stop, self.stop),
        ]
    }

    /// The tier that a force reaches, and where that tier begins.
    #[must_use]
    pub fn reached(&self, newtons: f64) -> (Reaction, f64) {
        self.rising().into_iter().rev().find(|(_, limit)| newtons >= *limit).unwrap_or((Reaction::Clear, 0.0))
    }

    /// Where a tier begins; 0 where nothing is to be said.
    #[must_use]
    pub fn limit(&self, tier: Reaction) -> f64 {
        self.rising().into_iter().find(|(reaction, _)| *reaction == tier).map_or(0.0, |(_, limit)| limit)
    }

    /// Where the tier above begins; `None` above the stop.
    #[must_use]
    pub fn above(&self, tier: Reaction) -> Option<f64> {
        self.rising().into_iter().find(|(reaction, _)| *reaction > tier).map(|(_, limit)| limit)
    }

    fn validate(&self) -> Result<(), GuardError> {
        let most = Self::MOST.rising();
        let mut below = 0.0;
        for ((tier, limit), (_, cap)) in self.rising().into_iter().zip(most) {
            if !limit.is_finite() || limit <= below || limit > cap {
                return Err(GuardError::Tier { tier, value: limit, below, cap });
            }
            below = limit;
        }
        Ok(())
    }
}

/// When a force that grows along the way is a catch.
///
/// A gown caught on a fist measures 60 N/m, a good pull up to 34 N/m at its end and less than 20 N/m where a sleeve catches
/// (Kapusta); between them the limits were chosen by pulls as `valet reproduce detectors` makes them.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CatchLimits {
    /// Growth beyond this is a catch, in N/m, where dressing itself is expected to pull evenly.
    pub newtons_per_metre: f64,
    /// The share of the growth that dressing itself is expected to have, by which the limit rises. Less than 1: what is
    /// expected is another person's arm, and known to some centimetres only.
    #[serde(default)]
    pub expected_share: f64,
    /// It must have grown by at least this over the window, in newtons.
    pub least_newtons: f64,
    /// The way over which the growth is taken, in metres.
    pub window_metres: f64,
}

/// How much dressing itself pulls, by the way along the arm: points of metres from the hand and newtons, the way rising.
/// Between them it is a straight line, before the first it is the first, after the last it is the last.
///
/// The default is a gown that slides well along the forearm (Kapusta, horizontal pull; 0 is where it meets the hand).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(transparent)]
pub struct ExpectedPull(Vec<[f64; 2]>);

impl Default for ExpectedPull {
    fn default() -> Self {
        Self(vec![
            [0.0, 0.25],
            [0.05, 0.3],
            [0.10, 0.4],
            [0.15, 1.1],
            [0.20, 2.1],
            [0.30, 4.5],
            [0.40, 7.3],
            [0.47, 9.7],
        ])
    }
}

impl ExpectedPull {
    /// The most that a profile may expect anywhere, in newtons: a normal pull along the forearm (Kapusta). What is expected
    /// is taken off the work and raises the limit of growth; it is never taken off the tiers.
    pub const MOST_NEWTONS: f64 = 12.0;

    /// Nothing is expected anywhere.
    #[must_use]
    pub const fn none() -> Self {
        Self(Vec::new())
    }

    /// The pull in newtons that dressing needs so many metres from the hand.
    #[must_use]
    pub fn at(&self, metres: f64) -> f64 {
        let mut before: Option<[f64; 2]> = None;
        for &[place, newtons] in &self.0 {
            if metres <= place {
                return before
                    .map_or(newtons, |[start, least]| least + (newtons - least) * (metres - start) / (place - start));
            }
            before = Some([place, newtons]);
        }
        before.map_or(0.0, |[_, newtons]| newtons)
    }

    fn validate(&self) -> Result<(), GuardError> {
        let mut last = f64::NEG_INFINITY;
        for &[place, newtons] in &self.0 {
            if !place.is_finite() || place <= last {
                let range = "a way in metres that rises from point to point";
                return Err(GuardError::Range { key: "expected", value: place, range });
            }
            if !(0.0..=Self::MOST_NEWTONS).contains(&newtons) {
                return Err(GuardError::Range {
                    key: "expected",
                    value: newtons,
                    range: "from 0 to 12 N at every point",
                });
            }
            last = place;
        }
        Ok(())
    }
}

/// How the force of an arm is guarded.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct GuardSettings {
    /// Tiers of the absolute force.
    pub tiers: Tiers,
    /// How a zero is taken.
    pub bias: BiasSettings,
    /// The mass that the gripper holds.
    pub inertia: InertiaCompensation,
    /// Mass that may be there besides, in kilograms: thresholds of change rise by it times the acceleration.
    pub unknown_mass_kilograms: f64,
    /// The detector of a fast change.
    pub fast_change: TwoRateSettings,
    /// When growth along the way is a catch: over a long window, which finds a soft one in spite of noise.
    pub catch: CatchLimits,
    /// The same over a short window, which finds a hard one in time.
    pub hard_catch: CatchLimits,
    /// What a catch asks for: `slow` leaves it to the strategy to give way, `hold` to the operator.
    pub catch_reaction: Reaction,
    /// What dressing itself pulls, by the way along the arm.
    pub expected: ExpectedPull,
    /// Force beyond what is expected that does no work worth counting, in newtons: bias that drifts.
    pub work_free_newtons: f64,
    /// Work beyond what dressing needs, in joules, from which the arm slows down. A 60 N/m catch pulled to 10 N is 0.8 J.
    pub work_joules: f64,
}

impl Default for GuardSettings {
    fn default() -> Self {
        Self {
            tiers: Tiers::default(),
            bias: BiasSettings::default(),
            inertia: InertiaCompensation::default(),
            unknown_mass_kilograms: 0.3,
            fast_change: TwoRateSettings { threshold_newtons: 5.0, ..TwoRateSettings::default() },
            catch: CatchLimits {
                newtons_per_metre: 36.0,
                expected_share: 0.5,
                least_newtons: 4.0,
                window_metres: 0.14,
            },
            hard_catch: CatchLimits {
                newtons_per_metre: 240.0,
                expected_share: 0.0,
                least_newtons: 4.0,
                window_metres: 0.033,
            },
            catch_reaction: Reaction::Slow,
            expected: ExpectedPull::default(),
            work_free_newtons: 6.0,
            work_joules: 0.8,
        }
    }
}

/// A setting of the force guard that cannot be used.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum GuardError {
    /// A tier that is out of order or beyond its cap.
    #[error("the {tier} tier is {value} N: it must be above {below} N and at most {cap} N")]
    Tier {
        /// Which one.
        tier: Reaction,
        /// What was given.
        value: f64,
        /// The tier below.
        below: f64,
        /// The most that can be set.
        cap: f64,
    },
    /// A number that is out of its range.
    #[error("{key} is {value}: it must be {range}")]
    Range {
        /// The setting's key.
        key: &'static str,
        /// What was given.
        value: f64,
        /// What is allowed, in words.
        range: &'static str,
    },
    /// A catch must at least slow the arm down.
    #[error("catch_reaction is {0}: it must be slow, hold or stop")]
    CatchReaction(Reaction),
    /// A setting of one of its detectors.
    #[error(transparent)]
    Sensing(#[from] SensingError),
}

impl GuardSettings {
    /// Checks the settings.
    ///
    /// # Errors
    /// Where a number is not finite, out of its range, or beyond a cap.
    pub fn validate(&self) -> Result<(), GuardError> {
        self.tiers.validate()?;
        self.inertia.validate()?;
        self.fast_change.validate()?;
        self.expected.validate()?;
        if self.catch_reaction < Reaction::Slow {
            return Err(GuardError::CatchReaction(self.catch_reaction));
        }
        let within = |key, value: f64, least: f64, most: f64, range| {
            if (least..=most).contains(&value) { Ok(()) } else { Err(GuardError::Range { key, value, range }) }
        };
        within("unknown_mass_kilograms", self.unknown_mass_kilograms, 0.0, 1.0, "from 0 to 1 kg")?;
        for (catch, most) in [(&self.catch, 100.0), (&self.hard_catch, 400.0)] {
            within(
                "catch.newtons_per_metre",
                catch.newtons_per_metre,
                10.0,
                most,
                "from 10 to 100 N/m, hard to 400 N/m",
            )?;
            within("catch.expected_share", catch.expected_share, 0.0, 1.0, "from 0 to 1")?;
            within("catch.least_newtons", catch.least_newtons, 1.0, 8.0, "from 1 to 8 N")?;
            within("catch.window_metres", catch.window_metres, 0.02, 0.15, "from 0.02 to 0.15 m")?;
        }
        within("work_free_newtons", self.work_free_newtons, 0.0, 8.0, "from 0 to 8 N")?;
        within("work_joules", self.work_joules, 0.1, 5.0, "from 0.1 to 5 J")
    }
}

#[cfg(test)]
mod tests;
