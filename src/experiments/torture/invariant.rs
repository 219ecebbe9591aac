//! What may never be broken, whatever goes wrong, by name.

use serde::Serialize;

/// What may never be broken.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Invariant {
    /// The trial of a seed can begin.
    TrialCanBegin,
    /// Nothing panics.
    NoPanic,
    /// After a stop no setpoint until Reset, Enable and Start were accepted, in this order.
    StopIsLatched,
    /// A stop that is asked for reaches the robot's switch in the same step.
    StopIsAtOnce,
    /// No setpoint while the robot is disabled, stopped, or its state not known.
    RobotIsEnabled,
    /// No motion on stale, missing or non-finite input, beyond braking.
    InputsAreFresh,
    /// Every setpoint is finite and inside the joints' ranges.
    JointRange,
    /// No joint and no gripper is faster than its limit.
    Speed,
    /// No joint is sped up or braked more than its limit.
    Acceleration,
    /// No gripper leaves the workspace, or goes further out of it.
    Workspace,
    /// The first setpoint of a motion is where the arm is.
    FirstStep,
    /// The grippers keep their distance.
    GripperDistance,
    /// An unbearable force stops the robot.
    ForceStops,
    /// In a hold nothing moves, beyond braking, until the operator acts.
    HoldHolds,
    /// Another node may stop and hold, nothing else.
    ServiceMayOnlyStop,
    /// Once a trial has ended or a motion was dropped, nothing moves until the next Start.
    EndedIsStill,
    /// A force or a robot's state that is no longer fresh is not on the screen.
    StaleDisappears,
    /// A recorded trial replays to the same decisions, byte for byte.
    ReplayRepeats,
    /// What was flushed before a crash can be read after it.
    RecordSurvives,
    /// Figures of an iteration are finite and not negative.
    FiguresAreFinite,
}

/// A broken invariant.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Violation {
    /// Which one.
    pub invariant: Invariant,
    /// When, in seconds of the trial's clock.
    pub at_seconds: f64,
    /// What was seen, in words with numbers.
    pub text: String,
}
