//! What may be seen: one plain, cheap copy of everything that the screen, the headless mode and watchers show.
//!
//! The supervisor and the engine fill it; the console draws it. Nothing here decides, and nothing here reads a clock:
//! whether a value is still fresh follows from [`Snapshot::now`] and the value's own stamp.

mod checklist;
mod force;
mod health;
mod history;
mod path;
mod stream;
mod trial;

pub use force::{Detection, ForceSample, ForceTier, ForceView, TierMargin, WindowView};
pub use health::{
    CheckLine, DiagnosisView, Freshness, LogLine, MasterView, ReceiptLine, RecorderView, SettingView, TopicHealth,
    Verdict,
};
pub use history::{History, Shared};
pub use path::{BodyView, EllipseView, PathView, PoseQuality, WaypointRow};
pub use trial::{
    Choices, IterationView, MotionNotice, Outcome, RecordingMovement, RunKeyView, StepRow, StrategyRow, StrategyView,
    TimelineEvent, TimelineKind, TrialPhase, TrialView,
};

use crate::assembly::RobotState;
use crate::body::{PerSide, Side};
use crate::command::CommandReceipt;
use crate::time::Stamp;
use serde::{Deserialize, Serialize};
use std::fmt;
use std::time::Duration;

/// How grave a line of the log is.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Level {
    /// For whoever looks for a cause.
    Debug,
    /// What happens in a trial that goes well.
    #[default]
    Information,
    /// Look at this.
    Warning,
    /// This does not work.
    Error,
}

impl Level {
    /// All levels, the least grave first.
    pub const ALL: [Self; 4] = [Self::Debug, Self::Information, Self::Warning, Self::Error];

    /// The level as a word.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Debug => "debug",
            Self::Information => "information",
            Self::Warning => "warning",
            Self::Error => "error",
        }
    }
}

impl fmt::Display for Level {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.pad(self.name())
    }
}

/// What kind of run this is: said on every screen where it is not a trial on a robot.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Watermark {
    /// A trial on a robot.
    #[default]
    Live,
    /// Simulated robot and person.
    Demo,
    /// A recorded trial.
    Replay,
    /// Everything is decided, nothing is sent.
    DryRun,
    /// Another node's trial: this screen may stop it and do nothing else.
    Watch,
}

impl Watermark {
    /// The word that is shown; nothing for a trial on a robot.
    #[must_use]
    pub const fn word(self) -> Option<&'static str> {
        match self {
            Self::Live => None,
            Self::Demo => Some("DEMO"),
            Self::Replay => Some("REPLAY"),
            Self::DryRun => Some("DRY RUN"),
            Self::Watch => Some("WATCH"),
        }
    }
}

/// The emergency stop by software, from the key to the robot's own word.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct StopView {
    /// True from the request until Start: nothing moves meanwhile.
    pub latched: bool,
    /// When the operator, a node or a verdict asked for it.
    pub requested_at: Option<Stamp>,
    /// When the first message with the request left this node.
    pub sent_at: Option<Stamp>,
    /// When the robot first said that it is stopped.
    pub confirmed_at: Option<Stamp>,
    /// True from the robot's answer to Reset until Start: the way back has begun, and Enable and Start are left.
    #[serde(default)]
    pub is_reset: bool,
    /// Who or what asked, in words.
    pub cause: String,
}

/// How far a stop has come.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StopPhase {
    /// Nothing is stopped.
    Clear,
    /// Reset: the robot is no longer stopped, and nothing moves before Enable and Start.
    Reset,
    /// Asked for, and still within the time in which the robot should have answered.
    Requested,
    /// The robot says that it is stopped.
    Confirmed,
    /// The robot has not said so in time: the red button is what is left.
    NotConfirmed,
}

impl StopView {
    /// Nanoseconds within which the robot should confirm: `/robot/state` comes at 100 Hz on a healthy robot, and a
    /// quarter of a second is the time in which an operator decides for the red button.
    const CONFIRMATION: Duration = Duration::from_millis(250);

    /// How far the stop has come at the moment `now`.
    #[must_use]
    pub fn phase(&self, now: Stamp) -> StopPhase {
        if !self.latched {
            return StopPhase::Clear;
        }
        if self.is_reset {
            return StopPhase::Reset;
        }
        if self.confirmed_at.is_some() {
            return StopPhase::Confirmed;
        }
        // Where the clock went back, nobody knows how long it was: that is no reason to wait longer.
        let waited = self.requested_at.map_or(Duration::ZERO, |requested| now.distance(requested));
        if waited <= Self::CONFIRMATION { StopPhase::Requested } else { StopPhase::NotConfirmed }
    }

    /// Seconds from the request to the robot's confirmation.
    #[must_use]
    pub fn confirmation_seconds(&self) -> Option<f64> {
        Some(self.confirmed_at?.since(self.requested_at?).as_secs_f64())
    }
}

/// The robot's own switch as it last said, with how long that holds.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct RobotView {
    /// What it last said; `None` where nothing was heard yet.
    pub state: Option<RobotState>,
    /// How long that holds, in seconds, before it is stale.
    pub deadline_seconds: f64,
}

impl RobotView {
    /// What the robot said, as long as that still holds.
    #[must_use]
    pub fn fresh(&self, now: Stamp) -> Option<&RobotState> {
        self.state.as_ref().filter(|state| now.distance(state.stamp).as_secs_f64() <= self.deadline_seconds)
    }
}

/// What is known of one side: the robot's gripper and the person's arm there.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct SideView {
    /// Force as it comes in and as the detector sees it.
    pub force: ForceView,
    /// Way-points and paths.
    pub path: PathView,
    /// The iterations so far, oldest first.
    pub iterations: Shared<Vec<IterationView>>,
    /// The most iterations that an arm gets (the thesis' `t_max`).
    pub iterations_maximum: u32,
    /// Where along the arm the gripper is: 0 at the hand, 1 at the shoulder; `None` where no iteration runs.
    pub progress: Option<f64>,
}

/// Where a replay stands.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct ReplayView {
    /// Seconds from the beginning of the recorded trial to the moment that is shown.
    pub position: f64,
    /// Seconds from its beginning to its end.
    pub length: f64,
    /// How much faster than the trial it runs; 1 is the trial's own pace.
    pub speed: f64,
    /// True while it stands still.
    pub paused: bool,
}

/// Everything that may be seen at one moment. Cloning it copies a few kilobytes and shares the rest.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Snapshot {
    /// The moment that it shows.
    pub now: Stamp,
    /// What kind of run it is.
    pub watermark: Watermark,
    /// The stop.
    pub stop: StopView,
    /// The robot's switch.
    pub robot: RobotView,
    /// The ROS master.
    pub master: MasterView,
    /// The trial.
    pub trial: TrialView,
    /// Both sides.
    pub sides: PerSide<SideView>,
    /// The person's pose.
    pub body: BodyView,
    /// The strategies, side by side.
    pub strategies: Shared<Vec<StrategyView>>,
    /// What can be chosen before and during a trial.
    pub choices: Shared<Choices>,
    /// One row a topic.
    pub topics: Shared<Vec<TopicHealth>>,
    /// What other nodes say of themselves on `/diagnostics`.
    #[serde(default)]
    pub diagnoses: Shared<Vec<DiagnosisView>>,
    /// The check-list before the first trial.
    pub checks: Shared<Vec<CheckLine>>,
    /// The recorder.
    pub recorder: RecorderView,
    /// Settings that can be changed while a trial runs.
    pub settings: Shared<Vec<SettingView>>,
    /// The log, oldest line first.
    pub log: History<LogLine>,
    /// Answers to commands, oldest first.
    pub receipts: History<ReceiptLine>,
    /// Steps, resistance, holds and stops on one time axis.
    pub timeline: History<TimelineEvent>,
    /// Where the replay stands; `None` where no recorded trial is shown.
    #[serde(default)]
    pub replay: Option<ReplayView>,
    /// Samples thrown away because a queue was full, since the start.
    pub dropped_samples: u64,
}

impl Snapshot {
    /// The answer to the newest command.
    #[must_use]
    pub fn newest_receipt(&self) -> Option<&CommandReceipt> {
        self.receipts.last().map(|line| &line.receipt)
    }

    /// The clock went back: what came in after the present moment is stale, also when the clock comes to those moments again.
    pub fn forget_what_lies_ahead(&mut self, now: Stamp) {
        let passed = |last: &Stamp| *last <= now;
        for side in Side::BOTH {
            let freshness = &mut self.sides.get_mut(side).force.freshness;
            freshness.last = freshness.last.filter(passed);
        }
        self.body.freshness.last = self.body.freshness.last.filter(passed);
        self.robot.state = self.robot.state.filter(|state| passed(&state.stamp));
    }
}

#[cfg(test)]
mod tests;
