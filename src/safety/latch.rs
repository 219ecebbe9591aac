//! The latch of the stop: after a stop nothing moves until Reset, then Enable, then Start, each an act of the operator.
//!
//! Follows the robot's own switch (`/robot/state`): Reset clears the robot's latch and leaves it disabled, Enable switches
//! its motors on, Start lets valet command it. A stop counts as confirmed only when the robot says that it is stopped.

use crate::assembly::{RedButton, RobotState};
use crate::time::Stamp;
use serde::{Deserialize, Serialize};
use std::time::Duration;
use thiserror::Error;

/// The robot confirms a stop within this span, or something is wrong (the maker's own tool waits as long).
const CONFIRM_WITHIN: Duration = Duration::from_secs(3);

/// Where the way back from a stop is.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum StopPhase {
    /// No stop is in force: commands may be sent.
    #[default]
    Released,
    /// A stop was asked for; the robot has not said yet that it is stopped.
    Requested,
    /// The robot says that it is stopped.
    Confirmed,
    /// Reset was asked for; the robot is stopped still.
    Resetting,
    /// The robot's latch is clear; its motors are off.
    Disabled,
    /// Enable was asked for; the motors are off still.
    Enabling,
    /// Motors are on; nothing moves until Start.
    Enabled,
}

/// Why an act on the way back was refused.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum StopRefusal {
    /// The robot's state is not known.
    #[error("the robot's state is not known: check that the robot is on and its network reachable")]
    StateUnknown,
    /// No stop is in force.
    #[error("no stop is in force")]
    NotStopped,
    /// The robot has not confirmed the stop.
    #[error("the robot has not confirmed the stop yet: press the red button if it moves")]
    NotConfirmed,
    /// The red button is down.
    #[error("the red button is down or its cable is loose: release it, then reset")]
    ButtonDown,
    /// The robot is stopped still.
    #[error("the robot is stopped: reset first; enabling does not reset")]
    ResetFirst,
    /// The robot reports a fault.
    #[error("the robot reports a fault: see its diagnostics, then reset")]
    RobotFault,
    /// The motors are off.
    #[error("the robot is disabled: enable it first")]
    EnableFirst,
    /// The robot homes its joints after enabling.
    #[error("the robot is enabled but not ready yet: wait until it has homed its joints")]
    NotReady,
}

impl From<StopRefusal> for String {
    fn from(refusal: StopRefusal) -> Self {
        refusal.to_string()
    }
}

/// The latch.
///
/// ```
/// use valet::assembly::RobotState;
/// use valet::safety::{StopPhase, StopState};
/// use valet::time::Stamp;
///
/// let at = Stamp::from_nanoseconds;
/// let mut latch = StopState::default();
/// assert!(latch.request(at(1), "the operator"));
/// latch.observe(at(2), &RobotState { stopped: true, ..RobotState::default() });
/// assert_eq!(latch.phase(), StopPhase::Confirmed);
/// latch.reset(at(3), Some(&RobotState { stopped: true, ..RobotState::default() }))?;
/// latch.observe(at(4), &RobotState::default());
/// latch.enable(Some(&RobotState::default()))?;
/// let enabled = RobotState { enabled: true, ready: Some(true), ..RobotState::default() };
/// latch.observe(at(6), &enabled);
/// assert!(latch.is_latched());
/// latch.start(Some(&enabled))?;
/// assert!(!latch.is_latched());
/// # Ok::<(), valet::safety::StopRefusal>(())
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct StopState {
    phase: StopPhase,
    cause: String,
    requested_at: Option<Stamp>,
    confirmed_at: Option<Stamp>,
    told_overdue: bool,
}

impl StopState {
    /// Latches a stop with its cause; the cause names who or what. True where none was in force: the first cause stays,
    /// later ones do not overwrite it. A stop on the way back begins the way anew.
    pub fn request(&mut self, now: Stamp, cause: &str) -> bool {
        let first =
            matches!(self.phase, StopPhase::Released | StopPhase::Disabled | StopPhase::Enabling | StopPhase::Enabled);
        if first || self.phase == StopPhase::Resetting {
            self.phase = StopPhase::Requested;
            cause.clone_into(&mut self.cause);
            self.requested_at = Some(now);
            self.confirmed_at = None;
            self.told_overdue = false;
            return true;
        }
        first
    }

    /// Takes what the robot says of itself. A robot that stopped by itself, as at its red button, latches too.
    /// Returns the cause where this began a stop that valet had not asked for.
    pub fn observe(&mut self, now: Stamp, robot: &RobotState) -> Option<String> {
        if robot.stopped {
            return self.observe_stopped(now, robot);
        }
        // A confirmed stop stays where it is although somebody else may have reset the robot: that is no act of the operator.
        match self.phase {
            StopPhase::Resetting if !robot.error => self.phase = StopPhase::Disabled,
            StopPhase::Enabling if robot.enabled => self.phase = StopPhase::Enabled,
            StopPhase::Enabled if !robot.enabled => self.phase = StopPhase::Disabled,
            _ => {}
        }
        None
    }

    fn observe_stopped(&mut self, now: Stamp, robot: &RobotState) -> Option<String> {
        match self.phase {
            StopPhase::Requested => {
                self.phase = StopPhase::Confirmed;
                self.confirmed_at = Some(now);
                None
            }
            StopPhase::Confirmed | StopPhase::Resetting => None,
            StopPhase::Released | StopPhase::Disabled | StopPhase::Enabling | StopPhase::Enabled => {
                let cause = stopped_by(robot);
                self.request(now, &cause);
                self.phase = StopPhase::Confirmed;
                self.confirmed_at = Some(now);
                Some(cause)
            }
        }
    }

    /// Where the way back is.
    #[must_use]
    pub const fn phase(&self) -> StopPhase {
        self.phase
    }

    /// True from the request of a stop until Start: no motion meanwhile.
    #[must_use]
    pub const fn is_latched(&self) -> bool {
        !matches!(self.phase, StopPhase::Released)
    }

    /// True where the robot has said that it is stopped.
    #[must_use]
    pub const fn is_confirmed(&self) -> bool {
        self.confirmed_at.is_some()
    }

    /// What caused the stop in force, or the last one.
    #[must_use]
    pub fn cause(&self) -> &str {
        &self.cause
    }

    /// When the stop was asked for.
    #[must_use]
    pub const fn requested_at(&self) -> Option<Stamp> {
        self.requested_at
    }

    /// When the robot said that it is stopped.
    #[must_use]
    pub const fn confirmed_at(&self) -> Option<Stamp> {
        self.confirmed_at
    }

    /// True where the stop must be asked for again: the robot has not confirmed it.
    #[must_use]
    pub const fn needs_repeat(&self) -> bool {
        matches!(self.phase, StopPhase::Requested)
    }

    /// True once, where the robot owes its confirmation of a stop for too long: the operator has to be told.
    #[must_use]
    pub fn becomes_overdue(&mut self, now: Stamp) -> bool {
        let is_late = self.needs_repeat() && self.requested_at.is_some_and(|at| now.since(at) > CONFIRM_WITHIN);
        is_late && !std::mem::replace(&mut self.told_overdue, is_late)
    }

    /// The operator's Reset: clears the robot's latch, never this one, and moves nothing.
    ///
    /// # Errors
    /// Where the robot's state is not known, the stop is not confirmed, or the red button is down.
    pub fn reset(&mut self, now: Stamp, robot: Option<&RobotState>) -> Result<(), StopRefusal> {
        let robot = robot.ok_or(StopRefusal::StateUnknown)?;
        if !robot.stopped && !robot.error && !self.is_latched() {
            return Err(StopRefusal::NotStopped);
        }
        if robot.button == RedButton::Pressed {
            return Err(StopRefusal::ButtonDown);
        }
        if self.phase == StopPhase::Requested && !robot.stopped {
            return Err(StopRefusal::NotConfirmed);
        }
        if self.phase == StopPhase::Released {
            // A robot that reports a fault without having stopped: it, too, comes back by Reset, Enable and Start.
            self.request(now, "the robot reports a fault");
        }
        self.phase = StopPhase::Resetting;
        Ok(())
    }

    /// The robot's state, where neither it nor the latch says that it is stopped or in fault.
    fn robot_without_stop<'a>(&self, robot: Option<&'a RobotState>) -> Result<&'a RobotState, StopRefusal> {
        let robot = robot.ok_or(StopRefusal::StateUnknown)?;
        if robot.button == RedButton::Pressed {
            return Err(StopRefusal::ButtonDown);
        }
        if robot.stopped || matches!(self.phase, StopPhase::Requested | StopPhase::Confirmed | StopPhase::Resetting) {
            return Err(StopRefusal::ResetFirst);
        }
        if robot.error {
            return Err(StopRefusal::RobotFault);
        }
        Ok(robot)
    }

    /// The operator's Enable: switches the motors on. It never resets first.
    ///
    /// # Errors
    /// Where the robot's state is not known, it is stopped, its red button is down, or it reports a fault.
    pub fn enable(&mut self, robot: Option<&RobotState>) -> Result<(), StopRefusal> {
        let robot = self.robot_without_stop(robot)?;
        if self.phase != StopPhase::Released {
            self.phase = if robot.enabled { StopPhase::Enabled } else { StopPhase::Enabling };
        }
        Ok(())
    }

    /// The operator's Start: commands may be sent again.
    ///
    /// # Errors
    /// Where the robot's state is not known, it is stopped, in fault, disabled or not ready.
    pub fn start(&mut self, robot: Option<&RobotState>) -> Result<(), StopRefusal> {
        let robot = self.robot_without_stop(robot)?;
        if !robot.enabled || self.phase == StopPhase::Disabled {
            return Err(StopRefusal::EnableFirst);
        }
        if robot.ready == Some(false) {
            return Err(StopRefusal::NotReady);
        }
        self.phase = StopPhase::Released;
        Ok(())
    }
}

/// What stopped a robot that valet had not asked to stop.
fn stopped_by(robot: &RobotState) -> String {
    use crate::assembly::StopSource;
    match (robot.button, robot.source) {
        (RedButton::Pressed, _) => "the red button is down, or its cable is loose",
        (RedButton::Released, _) | (_, StopSource::User) => "the red button was pressed",
        (_, StopSource::Fault) => "the robot reports a fault of a joint",
        (_, StopSource::Brain) => "the robot's motor controller lost its computer",
        _ => "the robot was stopped by other software",
    }
    .to_owned()
}

#[cfg(test)]
mod tests;
