//! What a supervisor is set up with: the settings of every room it owns, and the person.

use super::WarmStart;
use crate::kinematics::{BodyBuild, MotionLimits};
use crate::modelling::MovementSpace;
use crate::safety::{GuardSettings, WatchSettings};
use crate::sensing::{WindowSettings, WrenchConversion};
use crate::sequencing::TrialSettings;
use crate::snapshot::Watermark;
use crate::strategy::{StrategyKind, StrategySettings};
use serde::{Deserialize, Serialize};
use std::time::Duration;
use thiserror::Error;

/// The settings of the rooms that the supervisor owns.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct SupervisorSettings {
    /// The strategy that a trial begins with.
    pub strategy: StrategyKind,
    /// The strategies' own settings.
    pub strategies: StrategySettings,
    /// How a trial runs.
    pub trial: TrialSettings,
    /// How the arms may move.
    pub motion: MotionLimits,
    /// Who plans straight lines.
    pub planner: PlannerKind,
    /// The detector's window.
    pub window: WindowSettings,
    /// Axes and sign of the robot's wrench.
    pub wrench: WrenchConversion,
    /// Force protection that does not depend on the strategy.
    pub guard: GuardSettings,
    /// Limits of the watchdogs.
    pub watch: WatchSettings,
    /// How long after a motion has begun resistance is not listened to, in seconds: the arm's own acceleration is in the
    /// signal then (ours; a move reaches its speed within this time).
    pub settling_seconds: f64,
    /// Whether an arm begins with the path that an earlier trial of this person learned with the same strategy.
    pub warm_start: bool,
}

impl Default for SupervisorSettings {
    fn default() -> Self {
        Self {
            strategy: StrategyKind::Force,
            strategies: StrategySettings::default(),
            trial: TrialSettings::default(),
            motion: MotionLimits::default(),
            planner: PlannerKind::default(),
            window: WindowSettings::default(),
            wrench: WrenchConversion::default(),
            guard: GuardSettings::default(),
            watch: WatchSettings::default(),
            settling_seconds: 0.3,
            warm_start: false,
        }
    }
}

/// Who plans the straight lines of a trial. Whoever plans, valet checks, times and streams.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum PlannerKind {
    /// valet itself.
    #[default]
    BuiltIn,
    /// MoveIt's `move_group` on the same graph.
    #[serde(rename = "moveit")]
    MoveIt,
}

impl PlannerKind {
    /// All of them, with the names that settings and arguments use.
    pub const ALL: [(&'static str, Self); 2] = [("built_in", Self::BuiltIn), ("moveit", Self::MoveIt)];
}

/// How long a planner outside this process may take before the trial is held: two arms, each a look-up, a greeting and an answer.
const OUTSIDE_PLANNER: Duration = Duration::from_secs(6);

impl SupervisorSettings {
    /// The limits of the watchdogs for the planner that is chosen.
    pub(super) fn watch_settings(&self) -> WatchSettings {
        match self.planner {
            PlannerKind::BuiltIn => self.watch,
            PlannerKind::MoveIt => WatchSettings { planner: self.watch.planner.max(OUTSIDE_PLANNER), ..self.watch },
        }
    }
}

/// A setting that is not usable.
#[derive(Clone, Debug, PartialEq, Error)]
#[error("{key}: {reason}")]
pub struct SettingsError {
    /// The setting's key.
    pub key: String,
    /// Why it is not usable, with the value and the range.
    pub reason: String,
}

/// Everything that a supervisor starts with.
#[derive(Clone, Debug, Default)]
pub struct Setup {
    /// Settings.
    pub settings: SupervisorSettings,
    /// The person's movement space, where the profile has one.
    pub space: Option<MovementSpace>,
    /// Paths that earlier trials of this person have learned, the newest last.
    pub warm_start: Vec<WarmStart>,
    /// How thick the person is.
    pub build: BodyBuild,
    /// Seed of everything random.
    pub seed: u64,
    /// What kind of run this is.
    pub watermark: Watermark,
    /// The profile's name.
    pub profile: String,
    /// The profile's hash, shortened.
    pub profile_hash: String,
    /// The garment's name.
    pub garment: String,
}

impl Setup {
    /// Checks every setting.
    ///
    /// # Errors
    /// The first setting that is not usable, by key.
    pub fn validate(&self) -> Result<(), SettingsError> {
        let settings = &self.settings;
        let named = |key: &str, reason: String| SettingsError { key: key.to_owned(), reason };
        settings.window.validate().map_err(|error| named("window", error.to_string()))?;
        settings.strategies.validate().map_err(|error| named("strategies", error.to_string()))?;
        settings.guard.validate().map_err(|error| named("guard", error.to_string()))?;
        let trial = &settings.trial;
        let range = |key: &str, value: f64, low: f64, high: f64| {
            let inside = (low..=high).contains(&value);
            if inside { Ok(()) } else { Err(named(key, format!("{value} is outside {low} to {high}"))) }
        };
        range("trial.garment_reach_metres", trial.garment_reach_metres, 0.2, 1.0)?;
        range("trial.goal_interval_seconds", trial.goal_interval_seconds, 0.0, 60.0)?;
        range("settling_seconds", settings.settling_seconds, 0.0, 2.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_defaults_are_usable() {
        assert_eq!(Setup::default().validate(), Ok(()));
    }

    #[test]
    fn a_setting_out_of_range_is_named_with_its_value() {
        let mut setup = Setup::default();
        setup.settings.trial.garment_reach_metres = f64::NAN;
        let error = setup.validate().unwrap_err();
        assert_eq!(error.key, "trial.garment_reach_metres");
        assert!(error.to_string().contains("NaN"), "{error}");
    }

    #[test]
    fn settings_survive_the_way_through_a_file() {
        let settings = SupervisorSettings::default();
        let text = toml::to_string(&settings).unwrap();
        assert_eq!(toml::from_str::<SupervisorSettings>(&text).unwrap(), settings);
    }
}
