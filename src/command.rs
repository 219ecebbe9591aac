//! What may be asked of valet, by whom, and how it answers.
//!
//! Plain data. Whether a command is carried out is decided by the supervisor alone; nothing here moves or stops anything.

use crate::body::Side;
use crate::strategy::StrategyKind;
use serde::{Deserialize, Serialize};
use std::fmt;

/// Something that may be asked.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Command {
    /// Emergency stop by software. The stop keys do not wait for this: they go straight to the stop latch.
    Stop,
    /// Keep the robot enabled where it is.
    Hold,
    /// Go on after a hold.
    Continue,
    /// The run key is held down: where hold to run is chosen, the arms move as long as this comes at least every 0.3 s.
    Run,
    /// Give the trial up; the arms hold where they are.
    Abort,
    /// Withdraw the garment along the travelled path, slowly.
    Withdraw,
    /// The operator's answer to what the trial waits for.
    GoAhead,
    /// End the arm after the iteration that is under way.
    FinishAfterThis,
    /// Run one more iteration on the arm.
    NextIteration,
    /// Go to the next step of table 3.1.
    NextStep,
    /// Go back to the previous step of table 3.1.
    PreviousStep,
    /// Clear the robot's stop latch. Moves nothing and leaves the robot disabled.
    Reset,
    /// Switch the robot's motors on.
    Enable,
    /// Switch the robot's motors off. The arms may sink.
    Disable,
    /// Begin a trial, or take it up again after a stop.
    Start,
    /// Change the strategy at the next safe point.
    SelectStrategy(StrategyKind),
    /// Change a setting within its limits.
    SetSetting {
        /// The setting's key, as in the configuration.
        key: String,
        /// The new value in the setting's own unit.
        value: f64,
    },
    /// Give a setting back the value that it had before its last change.
    UndoSetting {
        /// The setting's key.
        key: String,
    },
    /// Take the present reading of an arm's force as its zero. Only while the arm stands still.
    Tare(Side),
    /// Watch an arm's force while the operator pushes the gripper along an axis, and tell the sign that comes in.
    SignCheck(Side),
    /// Use another person's profile. Only before a trial.
    SelectProfile(String),
    /// Use another garment of the profile. Only before a trial.
    SelectGarment(String),
    /// Which arm is dressed first. Only before a trial.
    SelectFirstArm(Side),
    /// Record the person's movement to model the movement space.
    RecordMovement {
        /// Which of the person's arms.
        side: Side,
        /// For how long, in seconds.
        seconds: f64,
    },
    /// Switch the recording of the trial on or off.
    SetRecording(bool),
    /// Write a note of the operator into the record.
    Note(String),
}

impl Command {
    /// True where carrying the command out can set the robot in motion, at once or as soon as something else is done.
    /// Such a command is asked for again before it is sent.
    #[must_use]
    pub const fn may_move(&self) -> bool {
        match self {
            Self::Continue
            | Self::Withdraw
            | Self::GoAhead
            | Self::NextIteration
            | Self::NextStep
            | Self::PreviousStep
            | Self::Enable
            | Self::Disable
            | Self::Start
            | Self::SelectStrategy(_) => true,
            // A key that is held needs no question: what it lets go on was asked for and confirmed.
            Self::Run
            | Self::Stop
            | Self::Hold
            | Self::Abort
            | Self::FinishAfterThis
            | Self::Reset
            | Self::SetSetting { .. }
            | Self::UndoSetting { .. }
            | Self::Tare(_)
            | Self::SignCheck(_)
            | Self::SelectProfile(_)
            | Self::SelectGarment(_)
            | Self::SelectFirstArm(_)
            | Self::RecordMovement { .. }
            | Self::SetRecording(_)
            | Self::Note(_) => false,
        }
    }
}

/// The command in the operator's words.
impl fmt::Display for Command {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Stop => formatter.write_str("emergency stop (software)"),
            Self::Hold => formatter.write_str("hold"),
            Self::Continue => formatter.write_str("continue"),
            Self::Run => formatter.write_str("run while the key is held"),
            Self::Abort => formatter.write_str("abort the trial"),
            Self::Withdraw => formatter.write_str("withdraw the garment"),
            Self::GoAhead => formatter.write_str("go ahead"),
            Self::FinishAfterThis => formatter.write_str("finish after this iteration"),
            Self::NextIteration => formatter.write_str("next iteration"),
            Self::NextStep => formatter.write_str("next step"),
            Self::PreviousStep => formatter.write_str("previous step"),
            Self::Reset => formatter.write_str("reset the stop"),
            Self::Enable => formatter.write_str("enable the robot"),
            Self::Disable => formatter.write_str("disable the robot"),
            Self::Start => formatter.write_str("start the trial"),
            Self::SelectStrategy(strategy) => write!(formatter, "strategy {strategy}"),
            Self::SetSetting { key, value } => write!(formatter, "set {key} to {value}"),
            Self::UndoSetting { key } => write!(formatter, "undo the change of {key}"),
            Self::Tare(side) => write!(formatter, "tare the {side} force"),
            Self::SignCheck(side) => write!(formatter, "sign check of the {side} force"),
            Self::SelectProfile(name) => write!(formatter, "profile {name}"),
            Self::SelectGarment(name) => write!(formatter, "garment {name}"),
            Self::SelectFirstArm(side) => write!(formatter, "{side} arm first"),
            Self::RecordMovement { side, seconds } => {
                write!(formatter, "record the movement of the {side} arm for {seconds:.0} s")
            }
            Self::SetRecording(true) => formatter.write_str("record the trial"),
            Self::SetRecording(false) => formatter.write_str("stop recording the trial"),
            Self::Note(text) => write!(formatter, "note: {text}"),
        }
    }
}

/// Who asks.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Origin {
    /// The operator, at a key of the console.
    #[default]
    OperatorKey,
    /// Another node, by a service call. It may stop and hold, nothing else.
    RosService,
    /// A run without a screen, which acts in the operator's place by a fixed script.
    Headless,
}

/// How a command was answered.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum CommandOutcome {
    /// It is, or will be, carried out.
    Accepted {
        /// From when on, in words, as in "now" or "at the next way-point".
        effective: String,
    },
    /// It is not carried out.
    Refused {
        /// Why, and what would help, in words.
        reason: String,
    },
}

/// The answer to one command.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct CommandReceipt {
    /// What was asked.
    pub command: Command,
    /// How it was answered.
    pub outcome: CommandOutcome,
}

impl CommandReceipt {
    /// The answer that a command is carried out from the moment that `effective` names.
    #[must_use]
    pub fn accepted(command: Command, effective: impl Into<String>) -> Self {
        Self { command, outcome: CommandOutcome::Accepted { effective: effective.into() } }
    }

    /// The answer that a command is not carried out.
    #[must_use]
    pub fn refused(command: Command, reason: impl Into<String>) -> Self {
        Self { command, outcome: CommandOutcome::Refused { reason: reason.into() } }
    }

    /// True where the command is carried out.
    #[must_use]
    pub const fn is_accepted(&self) -> bool {
        matches!(self.outcome, CommandOutcome::Accepted { .. })
    }

    /// Why the command is not carried out; `None` where it is.
    #[must_use]
    pub fn refusal(&self) -> Option<&str> {
        match &self.outcome {
            CommandOutcome::Accepted { .. } => None,
            CommandOutcome::Refused { reason } => Some(reason),
        }
    }
}

/// The receipt in one line for a screen or a log.
impl fmt::Display for CommandReceipt {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match &self.outcome {
            CommandOutcome::Accepted { effective } => write!(formatter, "{}: {effective}", self.command),
            CommandOutcome::Refused { reason } => write!(formatter, "{}: refused: {reason}", self.command),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn neither_reset_nor_hold_nor_stop_can_move_the_robot() {
        for command in [Command::Reset, Command::Hold, Command::Stop, Command::Abort] {
            assert!(!command.may_move(), "{command}");
        }
        for command in [Command::Enable, Command::Start, Command::Continue, Command::Withdraw] {
            assert!(command.may_move(), "{command}");
        }
    }

    #[test]
    fn commands_survive_the_way_through_a_file() {
        let commands = [
            Command::SelectStrategy(StrategyKind::Force),
            Command::SetSetting { key: "force.threshold_newtons".into(), value: 5.0 },
            Command::RecordMovement { side: Side::Left, seconds: 30.0 },
            Command::Note("sleeve caught".into()),
        ];
        for command in commands {
            let receipt = CommandReceipt::accepted(command, "now");
            let text = serde_json::to_string(&receipt).unwrap();
            assert_eq!(serde_json::from_str::<CommandReceipt>(&text).unwrap(), receipt);
        }
    }

    #[test]
    fn a_refusal_names_command_and_reason() {
        let receipt = CommandReceipt::refused(Command::Tare(Side::Right), "the arm moves");
        assert_eq!(receipt.to_string(), "tare the right force: refused: the arm moves");
        assert!(!receipt.is_accepted());
    }
}
