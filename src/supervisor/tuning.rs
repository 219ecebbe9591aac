//! Settings that the operator may change while a trial runs: within limits, with the old value and an undo.

use super::Supervisor;
use crate::snapshot::{Level, SettingView, Shared};
use crate::time::Stamp;

/// A setting that can be changed live.
struct Tunable {
    key: &'static str,
    name: &'static str,
    limits: (f64, f64),
    step: f64,
    unit: &'static str,
}

/// The detector's threshold, the optimiser's step and the speed: what the thesis itself tuned. The upper limits keep the
/// threshold below the force guard's pause, and a step below what is safe next to a person (0.05 m).
const TUNABLES: [Tunable; 4] = [
    Tunable { key: "window.threshold_newtons", name: "force threshold", limits: (2.0, 12.0), step: 0.5, unit: "N" },
    Tunable {
        key: "strategies.learning.optimiser.learning_rate",
        name: "step size",
        limits: (0.005, 0.05),
        step: 0.005,
        unit: "m",
    },
    Tunable { key: "motion.speed", name: "speed", limits: (0.02, 0.10), step: 0.01, unit: "m/s" },
    Tunable { key: WARM_START, name: "begin with the learned path", limits: (0.0, 1.0), step: 1.0, unit: "(1: yes)" },
];

/// Offered only where an earlier trial has learned something.
const WARM_START: &str = "warm_start";

impl Supervisor {
    fn tunable_value(&self, key: &str) -> f64 {
        let settings = &self.setup.settings;
        match key {
            "window.threshold_newtons" => settings.window.threshold_newtons,
            "strategies.learning.optimiser.learning_rate" => settings.strategies.learning.optimiser.learning_rate,
            WARM_START => f64::from(u8::from(settings.warm_start)),
            _ => settings.motion.speed,
        }
    }

    /// What can be changed for this person.
    fn tunables(&self) -> impl Iterator<Item = &'static Tunable> + use<> {
        let is_offered = !self.setup.warm_start.is_empty();
        TUNABLES.iter().filter(move |tunable| tunable.key != WARM_START || is_offered)
    }

    pub(super) fn show_settings(&mut self) {
        let previous: Vec<_> =
            self.view.settings.iter().map(|setting| (setting.key.clone(), setting.previous)).collect();
        let rows = self.tunables().map(|tunable| SettingView {
            key: tunable.key.into(),
            name: tunable.name.into(),
            value: self.tunable_value(tunable.key),
            previous: previous.iter().find(|(key, _)| key == tunable.key).and_then(|(_, value)| *value),
            limits: tunable.limits,
            step: tunable.step,
            unit: tunable.unit.into(),
        });
        self.view.settings = Shared::new(rows.collect());
    }

    pub(super) fn obey_setting(&mut self, now: Stamp, key: &str, value: f64) -> Result<String, String> {
        let tunable = self.tunables().find(|tunable| tunable.key == key);
        let Some(tunable) = tunable else {
            let known: Vec<_> = self.tunables().map(|tunable| tunable.key).collect();
            return Err(format!("{key} cannot be changed while valet runs; these can: {}", known.join(", ")));
        };
        let (low, high) = tunable.limits;
        if !(low..=high).contains(&value) {
            return Err(format!("{value} {} is outside {low} to {high} {}", tunable.unit, tunable.unit));
        }
        let before = self.tunable_value(key);
        if before.to_bits() == value.to_bits() {
            // The old value stays the one that an undo brings back.
            return Ok("it has that value already".into());
        }
        self.apply_setting(key, value)?;
        self.show_settings();
        self.remember_previous(key, before);
        self.log(
            now,
            Level::Information,
            "settings",
            format!("{}: {before} -> {value} {}", tunable.name, tunable.unit),
        );
        let laid_out = key.starts_with("strategies") || key == WARM_START;
        Ok(if laid_out { "with the next strategy that is laid out" } else { "now" }.into())
    }

    pub(super) fn obey_undo(&mut self, now: Stamp, key: &str) -> Result<String, String> {
        let previous =
            self.view.settings.iter().find(|setting| setting.key == key).and_then(|setting| setting.previous);
        let previous = previous.ok_or_else(|| format!("{key} was not changed"))?;
        self.obey_setting(now, key, previous)
    }

    fn apply_setting(&mut self, key: &str, value: f64) -> Result<(), String> {
        match key {
            "window.threshold_newtons" => {
                self.protection.set_threshold(value)?;
                self.setup.settings.window.threshold_newtons = value;
            }
            "strategies.learning.optimiser.learning_rate" => {
                self.setup.settings.strategies.learning.optimiser.learning_rate = value;
            }
            WARM_START => self.setup.settings.warm_start = value >= 0.5,
            _ => self.setup.settings.motion.speed = value,
        }
        Ok(())
    }

    fn remember_previous(&mut self, key: &str, before: f64) {
        let mut rows = self.view.settings.to_vec();
        for row in rows.iter_mut().filter(|row| row.key == key) {
            row.previous = Some(before);
        }
        self.view.settings = Shared::new(rows);
    }
}
