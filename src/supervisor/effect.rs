//! Everything the supervisor may answer: the only door out of the core.
//!
//! The engine carries effects out through guarded ports and hands them to the recorder. An effect is a decision, not a
//! deed: whether a setpoint really left the node is told back as an input.

use super::{MovementOrder, StartOrder, WarmStart};
use crate::assembly::SwitchRequest;
use crate::body::{PerSide, Side};
use crate::command::CommandReceipt;
use crate::kinematics::{JointVector, Target};
use crate::modelling::ArmSpace;
pub use crate::snapshot::{Level, Outcome};
use crate::strategy::{IterationSummary, StrategyKind, WaypointChange};
use serde::{Deserialize, Serialize};

/// The answers to one input, in the order in which they are to be carried out.
pub type Effects = Vec<Effect>;

/// What a planner outside is asked: ways along straight lines.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct PlanOrder {
    /// Which question this is: the answer names it.
    pub number: u64,
    /// Where the arms are, radians.
    pub start: PerSide<JointVector>,
    /// Where the grippers are to go; an arm without a target stays.
    pub targets: PerSide<Option<Target>>,
}

/// One decision.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Effect {
    /// Send these joint positions to an arm (position mode).
    Setpoint {
        /// Which arm.
        side: Side,
        /// Radians in the order s0, s1, e0, e1, w0, w1, w2.
        joints: JointVector,
    },
    /// Send nothing more to this arm: it holds where it is once the robot's command time-out has passed.
    Release {
        /// Which arm.
        side: Side,
    },
    /// Ask the planner outside for ways; it answers with [`super::Input::Planned`].
    Plan(PlanOrder),
    /// Find a posture to begin from where nobody waits for it; the answer comes as [`super::Input::StartFound`].
    FindStart(Box<StartOrder>),
    /// Fit a movement space where nobody waits for it; the answer comes as [`super::Input::Fitted`].
    Fit(MovementOrder),
    /// Ask something of the robot's switch.
    Switch(SwitchRequest),
    /// A stop was latched.
    Stopped {
        /// Whether the operator, a safety verdict or a fault stopped.
        outcome: Outcome,
        /// Who or what, in words.
        cause: String,
    },
    /// Answer to a command.
    Receipt(CommandReceipt),
    /// A line for the log.
    Log {
        /// How grave.
        level: Level,
        /// What happened, in words.
        text: String,
    },
    /// A way-point moved.
    Waypoint {
        /// Whose arm (the robot's gripper and the person's arm are on the same side).
        side: Side,
        /// What moved and why.
        change: WaypointChange,
    },
    /// An iteration ended.
    Iteration {
        /// Whose arm.
        side: Side,
        /// Which strategy ran it.
        strategy: StrategyKind,
        /// What came of it.
        summary: IterationSummary,
        /// Seconds from the first motion of the pass to its end.
        duration_seconds: f64,
    },
    /// An arm is dressed: what was learned for it.
    Learned(WarmStart),
    /// A person's movement was recorded: the movement space that it came to.
    Recorded {
        /// Whose arm.
        side: Side,
        /// Where its joints can be.
        space: Box<ArmSpace>,
    },
    /// The trial ended.
    TrialEnded {
        /// How.
        outcome: Outcome,
        /// Why, in words.
        reason: String,
    },
}
