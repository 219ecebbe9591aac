//! Whether everything still lives: freshness, topics, master, recorder, settings and the log.

use super::Level;
use crate::command::{CommandReceipt, Origin};
use crate::time::Stamp;
use serde::{Deserialize, Serialize};

/// When a value came in last and how long it holds.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Freshness {
    /// When it came in last; `None` where it never did.
    pub last: Option<Stamp>,
    /// How long it holds, in seconds.
    pub deadline: f64,
}

impl Freshness {
    /// The value's age in seconds; `None` where none ever came in.
    #[must_use]
    pub fn age(&self, now: Stamp) -> Option<f64> {
        self.last.map(|last| now.since(last).as_secs_f64())
    }

    /// True as long as the value holds. One that lies further ahead than it may lie behind does not: the clock went back.
    #[must_use]
    pub fn is_fresh(&self, now: Stamp) -> bool {
        self.last.is_some_and(|last| now.distance(last).as_secs_f64() <= self.deadline)
    }
}

/// How a thing does, the best first: of several, the worst counts.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Verdict {
    /// As it should be.
    #[default]
    Good,
    /// Works, but not as it should.
    Late,
    /// Nothing comes any more.
    Stale,
    /// Broken, or never there.
    Fault,
}

/// One topic.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct TopicHealth {
    /// The topic's resolved name.
    pub name: String,
    /// The message type.
    pub kind: String,
    /// Whether the newest message still holds.
    pub freshness: Freshness,
    /// Messages a second now: falls when messages stop.
    pub rate: f64,
    /// The rate that is expected, in messages a second: least and most.
    pub expected: (f64, f64),
    /// Longest gap lately, in seconds.
    pub gap: f64,
    /// Deviation of the gaps, in seconds.
    pub jitter: f64,
    /// How far the messages' own stamps lie behind their arrival, in seconds; `None` where they have none.
    pub stamp_lag: Option<f64>,
    /// Messages thrown away since the start.
    pub drops: u64,
    /// The nodes that publish it.
    pub publishers: Vec<String>,
    /// True where the trial cannot go on without it.
    pub required: bool,
}

impl TopicHealth {
    /// True where nobody publishes it and the trial does without it, as with a camera that is not there.
    #[must_use]
    pub fn is_absent(&self) -> bool {
        !self.required && self.freshness.last.is_none()
    }

    /// How the topic does at the moment `now`.
    #[must_use]
    pub fn verdict(&self, now: Stamp) -> Verdict {
        if self.freshness.last.is_none() {
            return Verdict::Fault;
        }
        if !self.freshness.is_fresh(now) {
            return Verdict::Stale;
        }
        let (least, most) = self.expected;
        if self.rate < least || self.rate > most { Verdict::Late } else { Verdict::Good }
    }
}

/// What another node says of one of its components on `/diagnostics`.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct DiagnosisView {
    /// The component's name.
    pub name: String,
    /// The level that was told: `Late` is the definition's WARN.
    pub verdict: Verdict,
    /// What was told, in words.
    pub text: String,
    /// When it came in.
    pub heard: Stamp,
}

impl DiagnosisView {
    /// Seconds after which a word is stale: the usual time-out of ROS's own `diagnostic_aggregator`.
    const HOLDS_SECONDS: f64 = 5.0;

    /// How the component does at the moment `now`.
    #[must_use]
    pub fn verdict(&self, now: Stamp) -> Verdict {
        let is_old = now.distance(self.heard).as_secs_f64() > Self::HOLDS_SECONDS;
        if is_old { self.verdict.max(Verdict::Stale) } else { self.verdict }
    }
}

/// The ROS master.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct MasterView {
    /// Where it is; empty where none is used, as in a run in virtual time.
    pub uri: String,
    /// True while it answers.
    pub connected: bool,
    /// What happened to it last, in words.
    pub text: String,
}

/// The recorder of the trial.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct RecorderView {
    /// True while it writes.
    pub on: bool,
    /// The file.
    pub file: String,
    /// Bytes written.
    pub bytes: u64,
    /// Events that it could not keep.
    pub drops: u64,
    /// Bytes that are free on the disk; `None` where that is not known.
    pub disk_free: Option<u64>,
    /// Why it cannot write, in words; empty where it can.
    pub fault: String,
}

/// One line of the check-list before the first trial.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct CheckLine {
    /// What is checked.
    pub name: String,
    /// How it does.
    pub verdict: Verdict,
    /// The value found.
    pub value: String,
    /// What to do where it is not good.
    pub hint: String,
    /// The age of the value in seconds.
    pub age: Option<f64>,
}

/// A setting that can be changed while a trial runs.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SettingView {
    /// Its key, as in the configuration.
    pub key: String,
    /// Its name for the operator.
    pub name: String,
    /// Its value.
    pub value: f64,
    /// The value before its last change.
    pub previous: Option<f64>,
    /// Its limits, both allowed.
    pub limits: (f64, f64),
    /// How far one key press changes it.
    pub step: f64,
    /// Its unit.
    pub unit: String,
}

/// One line of the log.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct LogLine {
    /// Its number, rising by one.
    pub id: u64,
    /// When.
    pub stamp: Stamp,
    /// How grave.
    pub level: Level,
    /// Which part of valet says so, as in "safety" or "ros".
    pub source: String,
    /// What happened.
    pub text: String,
}

/// An answer to a command, with its moment.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ReceiptLine {
    /// When it was answered.
    pub stamp: Stamp,
    /// Who had asked.
    pub origin: Origin,
    /// The answer.
    pub receipt: CommandReceipt,
}
