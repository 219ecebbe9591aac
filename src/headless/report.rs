//! What a run without a screen prints: one full sentence per change for people (and screen readers), one JSON object a
//! line for programs.

use crate::snapshot::Outcome;
use crate::supervisor::Effect;
use serde_json::{Value, json};

/// What is told of an effect.
#[derive(Clone, Debug, PartialEq)]
pub struct Report {
    /// For people.
    pub sentence: String,
    /// For programs; `None` where only people are told.
    pub event: Option<Value>,
}

/// How a trial ended, for the exit code and the closing line.
#[derive(Clone, Debug, PartialEq)]
pub struct TrialResult {
    /// How.
    pub outcome: Outcome,
    /// Why, in words.
    pub reason: String,
}

impl Report {
    /// What is to be told of an effect; `None` for those that are too many to tell.
    #[must_use]
    pub fn of(effect: &Effect) -> Option<Self> {
        match effect {
            Effect::Log { level, text } => Some(Self { sentence: format!("{}: {text}", level.name()), event: None }),
            Effect::Receipt(receipt) => Some(Self { sentence: format!("command: {receipt}"), event: None }),
            Effect::Iteration { side, strategy, summary, duration_seconds } => Some(Self {
                sentence: format!(
                    "iteration {} on the {side} arm ({strategy}): energy {:.2} N, {} resistances, {} way-points, {duration_seconds:.1} s",
                    summary.iteration,
                    summary.energy,
                    summary.contacts,
                    summary.path.len(),
                ),
                event: Some(json!({
                    "event": "iteration",
                    "arm": side.name(),
                    "iteration": summary.iteration,
                    "energy_newtons": summary.energy,
                    "resistances": summary.contacts,
                    "waypoints": summary.path.len(),
                    "duration_seconds": duration_seconds,
                })),
            }),
            _ => None,
        }
    }
}

impl TrialResult {
    /// The result that an effect brings, where it ends the trial or stops the robot.
    #[must_use]
    pub fn of(effect: &Effect) -> Option<Self> {
        match effect {
            Effect::TrialEnded { outcome, reason } => Some(Self { outcome: *outcome, reason: reason.clone() }),
            Effect::Stopped { outcome, cause } => Some(Self { outcome: *outcome, reason: cause.clone() }),
            _ => None,
        }
    }

    /// The closing event of a trial.
    #[must_use]
    pub fn event(&self, strategy: &str, seed: u64, duration_seconds: f64) -> Value {
        json!({
            "event": "trial",
            "outcome": self.outcome,
            "strategy": strategy,
            "seed": seed,
            "duration_seconds": duration_seconds,
            "reason": self.reason,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::body::Side;
    use crate::snapshot::Level;

    #[test]
    fn setpoints_are_not_told() {
        assert_eq!(Report::of(&Effect::Release { side: Side::Left }), None);
    }

    #[test]
    fn a_log_line_says_its_level_as_a_word() {
        let report = Report::of(&Effect::Log { level: Level::Warning, text: "hold: the operator".into() }).unwrap();
        assert_eq!(report.sentence, "warning: hold: the operator");
        assert_eq!(report.event, None);
    }

    #[test]
    fn the_closing_event_names_outcome_strategy_and_seed() {
        let effect = Effect::TrialEnded { outcome: Outcome::Completed, reason: "both arms are dressed".into() };
        let event = TrialResult::of(&effect).unwrap().event("force", 7, 61.5);
        assert_eq!(event["event"], "trial");
        assert_eq!(event["outcome"], "completed");
        assert_eq!(event["strategy"], "force");
        assert_eq!(event["seed"], 7);
    }
}
