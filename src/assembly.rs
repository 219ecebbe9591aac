//! The robot's own switch: what Baxter says of its state, and what may be asked of it.
//!
//! Plain words for `/robot/state` and the three `/robot/set_super_*` topics. Nothing here decides.

use crate::time::Stamp;
use serde::{Deserialize, Serialize};

/// The red button, as `/robot/state` reports it (`estop_button`).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum RedButton {
    /// Not pressed (0).
    #[default]
    Unpressed,
    /// Pressed, or its cable is loose (1).
    Pressed,
    /// Not known, as after a stop by software (2), or a number that no release defines.
    Unknown,
    /// Released, while the latch is still set (3).
    Released,
}

impl RedButton {
    /// From the number on the wire.
    #[must_use]
    pub const fn from_wire(number: u8) -> Self {
        match number {
            0 => Self::Unpressed,
            1 => Self::Pressed,
            3 => Self::Released,
            _ => Self::Unknown,
        }
    }

    /// The number on the wire.
    #[must_use]
    pub const fn to_wire(self) -> u8 {
        match self {
            Self::Unpressed => 0,
            Self::Pressed => 1,
            Self::Unknown => 2,
            Self::Released => 3,
        }
    }
}

/// What stopped the robot, as `/robot/state` reports it (`estop_source`).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum StopSource {
    /// Nothing (0).
    #[default]
    None,
    /// The red button (1).
    User,
    /// Not known, as after a stop by software (2), or a number that no release defines.
    Unknown,
    /// A joint's fault (3).
    Fault,
    /// The motor controller lost its computer (4).
    Brain,
}

impl StopSource {
    /// From the number on the wire.
    #[must_use]
    pub const fn from_wire(number: u8) -> Self {
        match number {
            0 => Self::None,
            1 => Self::User,
            3 => Self::Fault,
            4 => Self::Brain,
            _ => Self::Unknown,
        }
    }

    /// The number on the wire.
    #[must_use]
    pub const fn to_wire(self) -> u8 {
        match self {
            Self::None => 0,
            Self::User => 1,
            Self::Unknown => 2,
            Self::Fault => 3,
            Self::Brain => 4,
        }
    }
}

/// The robot's state, as `/robot/state` reports it (`baxter_core_msgs/AssemblyState`).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct RobotState {
    /// When the message arrived: the message itself carries no stamp.
    pub stamp: Stamp,
    /// Enabled and homed; `None` from releases before 1.2.0, which do not say.
    pub ready: Option<bool>,
    /// Motors on.
    pub enabled: bool,
    /// Stopped and latched.
    pub stopped: bool,
    /// A fault that the robot reports.
    pub error: bool,
    /// The red button.
    pub button: RedButton,
    /// What stopped it.
    pub source: StopSource,
}

/// What may be asked of the robot's switch.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum SwitchRequest {
    /// The software stop (`/robot/set_super_stop`): motors off, latched.
    Stop,
    /// Clears the latch and leaves the robot disabled (`/robot/set_super_reset`).
    Reset,
    /// Motors on (`/robot/set_super_enable` true).
    Enable,
    /// Motors off (`/robot/set_super_enable` false).
    Disable,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn wire_numbers_return_to_themselves_and_unknown_ones_are_unknown() {
        for number in 0..4 {
            assert_eq!(RedButton::from_wire(number).to_wire(), number);
        }
        for number in 0..5 {
            assert_eq!(StopSource::from_wire(number).to_wire(), number);
        }
        assert_eq!(RedButton::from_wire(77), RedButton::Unknown);
        assert_eq!(StopSource::from_wire(77), StopSource::Unknown);
    }
}
