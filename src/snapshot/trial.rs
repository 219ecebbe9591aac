//! The trial as the screen sees it: phase, steps, iterations, and the strategies side by side.

use super::history::Shared;
use crate::body::{PerSide, Side};
use crate::strategy::StrategyKind;
use crate::time::Stamp;
use serde::{Deserialize, Serialize};

/// How a trial ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Outcome {
    /// Both arms are dressed.
    Completed,
    /// The operator gave it up.
    Aborted,
    /// The operator stopped it.
    OperatorStop,
    /// A safety verdict stopped it.
    SafetyStop,
    /// Something broke.
    Fault,
}

impl Outcome {
    /// The outcome in words.
    #[must_use]
    pub const fn words(self) -> &'static str {
        match self {
            Self::Completed => "completed",
            Self::Aborted => "aborted by the operator",
            Self::OperatorStop => "stopped by the operator",
            Self::SafetyStop => "stopped for safety",
            Self::Fault => "ended by a fault",
        }
    }
}

/// Where a trial stands.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum TrialPhase {
    /// No trial yet: choices can be made.
    #[default]
    Idle,
    /// Waits for the operator's go-ahead; [`TrialView::waiting_for`] says for what.
    Waiting,
    /// The grippers move between steps of the table, free of the person.
    Positioning,
    /// The garment passes along an arm.
    Dressing,
    /// The garment is withdrawn along the travelled path.
    Withdrawing,
    /// Enabled and still; [`TrialView::hold_cause`] says why.
    Holding,
    /// After an emergency stop.
    Stopped,
    /// The trial is over.
    Ended,
}

impl TrialPhase {
    /// The phase in words.
    #[must_use]
    pub const fn words(self) -> &'static str {
        match self {
            Self::Idle => "no trial",
            Self::Waiting => "waiting",
            Self::Positioning => "positioning",
            Self::Dressing => "dressing",
            Self::Withdrawing => "withdrawing",
            Self::Holding => "holding",
            Self::Stopped => "stopped",
            Self::Ended => "ended",
        }
    }

    /// True where a gripper may be moving.
    #[must_use]
    pub const fn moves(self) -> bool {
        matches!(self, Self::Positioning | Self::Dressing | Self::Withdrawing)
    }

    /// True from the start of a trial to its end: leaving the console then asks first.
    #[must_use]
    pub const fn is_running(self) -> bool {
        !matches!(self, Self::Idle | Self::Ended)
    }
}

/// Hold to run: whether the arms move only as long as the operator holds a key down.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum RunKeyView {
    /// Not chosen.
    #[default]
    NotNeeded,
    /// Chosen.
    Needed,
    /// The trial holds for this key, and for nothing else.
    Awaited,
}

/// One step of the thesis' table 3.1.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct StepRow {
    /// From 1 to 6.
    pub number: u32,
    /// Where each gripper goes, in the table's words.
    pub goals: PerSide<String>,
}

/// What will move next.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct MotionNotice {
    /// Which arms.
    pub arms: Vec<Side>,
    /// What they will do, in words.
    pub what: String,
    /// Why, in words.
    pub why: String,
}

/// A recording of the person's movement that is under way.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct RecordingMovement {
    /// Which of the person's arms.
    pub side: Side,
    /// Poses so far.
    pub poses: u32,
    /// Seconds that remain.
    pub seconds_left: f64,
}

/// The trial.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct TrialView {
    /// Where it stands.
    pub phase: TrialPhase,
    /// How it ended, once it has.
    pub outcome: Option<Outcome>,
    /// Since when the phase lasts.
    pub since: Option<Stamp>,
    /// The steps of the table.
    pub steps: Shared<Vec<StepRow>>,
    /// The step that each gripper is at, from 1; `None` before the first.
    pub step: PerSide<Option<u32>>,
    /// The arm that is dressed first.
    #[serde(default)]
    pub first_arm: Option<Side>,
    /// The arm that is being dressed.
    pub arm: Option<Side>,
    /// The strategy at work.
    pub strategy: Option<StrategyKind>,
    /// A strategy that was chosen and takes effect at the next safe point, which the text names.
    pub strategy_pending: Option<(StrategyKind, String)>,
    /// What will move next and why; `None` where nothing will without the operator.
    pub next: Option<MotionNotice>,
    /// What the trial waits for, in words; empty where it does not wait.
    pub waiting_for: String,
    /// Why it holds, in words; empty where it does not hold.
    pub hold_cause: String,
    /// Whether the arms need a key that is held down.
    #[serde(default)]
    pub run_key: RunKeyView,
    /// The person's profile: name and hash.
    pub profile: String,
    /// The profile's hash, shortened.
    pub profile_hash: String,
    /// The garment.
    pub garment: String,
    /// The seed of everything random.
    pub seed: u64,
    /// The speed as a share of the full speed, from 0 to 1.
    pub speed_share: Option<f64>,
    /// A recording of movement under way.
    pub movement: Option<RecordingMovement>,
}

/// One iteration of an arm.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct IterationView {
    /// From 1.
    pub number: u32,
    /// Which strategy ran it.
    pub strategy: StrategyKind,
    /// The sum of detected resistance in newtons: the thesis' energy.
    pub energy: f64,
    /// How many resistances were found.
    pub resistances: u32,
    /// Way-points at its end.
    pub waypoints: u32,
    /// Its duration in seconds.
    pub duration: f64,
    /// True once it is over; the figures of a running one still change.
    pub finished: bool,
}

/// One row of the comparison of strategies.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct StrategyRow {
    /// For which arm.
    pub side: Side,
    /// Energy by iteration in newtons.
    pub energies: Vec<f64>,
    /// Reachability by iteration, beside the energies; `None` where there is no movement space.
    #[serde(default)]
    pub reaches: Vec<Option<f64>>,
    /// Mean log density of the path in the movement space, 0 being the best; `None` where it was not run or has no model.
    pub reachability: Option<f64>,
    /// Share of way-points inside the 95 % region, from 0 to 1.
    pub inside: Option<f64>,
    /// Residual resistance in newtons: the comfort criterion.
    pub comfort: Option<f64>,
}

/// One strategy for this person.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct StrategyView {
    /// Which one.
    pub kind: StrategyKind,
    /// What came of it, or is expected of it, for each arm.
    pub rows: Vec<StrategyRow>,
    /// True where the figures were measured in this trial, false where they come from an earlier one or a forecast.
    pub measured: bool,
    /// What a switch to it would do now, in words.
    pub switch: String,
    /// Why a switch is not possible now, in words; `None` where it is.
    pub refusal: Option<String>,
}

/// What can be chosen.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Choices {
    /// Profiles by name.
    pub profiles: Vec<String>,
    /// Garments by name.
    pub garments: Vec<String>,
    /// Strategies that this build offers.
    pub strategies: Vec<StrategyKind>,
}

/// A mark on the time axis of the trial.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct TimelineEvent {
    /// When.
    pub stamp: Stamp,
    /// On which side; `None` for both.
    pub side: Option<Side>,
    /// What.
    pub kind: TimelineKind,
}

/// What is marked on the time axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum TimelineKind {
    /// A step of the table began.
    Step(u32),
    /// An iteration began.
    Iteration(u32),
    /// Resistance was found.
    Resistance,
    /// A hold began.
    Hold,
    /// The trial went on.
    Continue,
    /// An emergency stop.
    Stop,
    /// Data went stale.
    Stale,
}
