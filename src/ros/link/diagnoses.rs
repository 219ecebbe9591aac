//! What other nodes say of themselves on `/diagnostics`: the robot's own, its drivers', the camera's. Shown, never judged: no
//! decision rests on it.

use crate::ros::message::diagnostic_msgs::{DiagnosticArray, DiagnosticStatus};
use crate::snapshot::{DiagnosisView, Verdict};
use crate::time::Stamp;
use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

/// The topic.
pub(super) const TOPIC: &str = "/diagnostics";
/// Components that are kept: a Baxter with its drivers names some forty.
const MOST: usize = 200;
/// The longest name and text that are kept, in characters.
const LONGEST: usize = 200;
/// What was silent for so long is forgotten: its node has gone.
const FORGOTTEN: Duration = Duration::from_secs(60);

/// The newest word of each component. Cheap to clone.
#[derive(Clone, Debug, Default)]
pub(super) struct Diagnoses(Arc<Mutex<BTreeMap<String, DiagnosisView>>>);

impl Diagnoses {
    /// Takes a message in. What the node `own` says itself is left out: the topics' rows tell it already.
    pub(super) fn take(&self, arrival: Stamp, own: &str, message: DiagnosticArray) {
        let own = format!("{}: ", own.trim_start_matches('/'));
        let mut known = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        known.retain(|_, diagnosis| arrival.distance(diagnosis.heard) < FORGOTTEN);
        for status in message.status.into_iter().filter(|status| !status.name.starts_with(&own)) {
            let name: String = status.name.chars().take(LONGEST).collect();
            if known.len() < MOST || known.contains_key(&name) {
                let text = status.message.chars().take(LONGEST).collect();
                let verdict = verdict(status.level);
                known.insert(name.clone(), DiagnosisView { name, verdict, text, heard: arrival });
            }
        }
    }

    /// All of them, by name.
    pub(super) fn all(&self) -> Vec<DiagnosisView> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).values().cloned().collect()
    }
}

/// A level that the definition does not know is as grave as its gravest.
const fn verdict(level: i8) -> Verdict {
    match level {
        DiagnosticStatus::OK => Verdict::Good,
        DiagnosticStatus::WARN => Verdict::Late,
        DiagnosticStatus::STALE => Verdict::Stale,
        _ => Verdict::Fault,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn said(name: &str, level: i8, message: &str) -> DiagnosticStatus {
        DiagnosticStatus { level, name: name.into(), message: message.into(), ..DiagnosticStatus::default() }
    }

    fn heard(known: &Diagnoses, seconds: u64, status: Vec<DiagnosticStatus>) {
        let arrival = Stamp::from_nanoseconds(seconds * 1_000_000_000);
        known.take(arrival, "/valet", DiagnosticArray { status, ..DiagnosticArray::default() });
    }

    #[test]
    fn the_newest_word_of_each_component_is_kept_and_our_own_is_not() {
        let known = Diagnoses::default();
        heard(&known, 1, vec![said("left arm", DiagnosticStatus::OK, "fine"), said("valet: /tf", 2, "late")]);
        heard(&known, 2, vec![said("left arm", DiagnosticStatus::ERROR, "hot"), said("camera", 77, "?")]);
        let all: Vec<_> = known.all().into_iter().map(|known| (known.name, known.verdict, known.text)).collect();
        let expected = [("camera", Verdict::Fault, "?"), ("left arm", Verdict::Fault, "hot")];
        assert_eq!(all, expected.map(|(name, verdict, text)| (name.to_owned(), verdict, text.to_owned())));
    }

    #[test]
    fn what_is_silent_is_forgotten_and_a_flood_of_names_is_not_kept() {
        let known = Diagnoses::default();
        heard(&known, 1, vec![said("gone", 0, "")]);
        let flood = (0..1000).map(|number| said(&format!("{number} {}", "x".repeat(1000)), 0, &"y".repeat(1000)));
        heard(&known, 62, flood.collect());
        let all = known.all();
        assert!(!all.iter().any(|diagnosis| diagnosis.name == "gone"));
        assert_eq!((all.len(), all[0].name.len(), all[0].text.len()), (MOST, LONGEST, LONGEST));
    }
}
