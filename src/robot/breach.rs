//! Which limit a command would break, by which value.

use crate::body::Side;
use thiserror::Error;

/// A limit that guards keep.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Limit {
    /// A joint's position in radians.
    JointPosition {
        /// Its name on the wire.
        joint: String,
    },
    /// A joint's speed in radians per second.
    JointSpeed {
        /// Its name on the wire.
        joint: String,
    },
    /// A joint's acceleration in radians per second squared.
    JointAcceleration {
        /// Its name on the wire.
        joint: String,
    },
    /// How far a joint lags behind its command, in radians.
    Following {
        /// Its name on the wire.
        joint: String,
    },
    /// A gripper's coordinate in `base`, metres.
    Workspace {
        /// Which gripper.
        side: Side,
        /// x, y or z.
        axis: char,
    },
    /// The distance between the grippers in metres.
    GripperDistance,
    /// The distance between two things that must not touch, in metres.
    Clearance {
        /// One of them.
        first: String,
        /// The other.
        second: String,
    },
    /// The age of an arm's measured joint positions in seconds.
    Freshness {
        /// Which arm.
        side: Side,
    },
    /// The stop latch: 1 where it is set.
    StopLatch,
}

/// A command that was refused: it would have broken a limit. Nothing was sent.
#[derive(Clone, Debug, PartialEq, Error)]
#[error("{}", sentence(.what, *.value, *.range))]
pub struct LimitBreach {
    /// Which limit.
    pub what: Limit,
    /// The value that breaks it, in the limit's unit; NaN where a number is missing.
    pub value: f64,
    /// What is allowed, in the limit's unit.
    pub range: (f64, f64),
}

fn sentence(what: &Limit, value: f64, (lower, upper): (f64, f64)) -> String {
    let range = format!("allowed are {lower:.4} to {upper:.4}");
    match what {
        Limit::JointPosition { joint } => format!("{joint} was to go to {value:.4} rad; {range}"),
        Limit::JointSpeed { joint } => format!("{joint} was to move at {value:.4} rad/s; {range}"),
        Limit::JointAcceleration { joint } => format!("{joint} was to accelerate at {value:.4} rad/s²; {range}"),
        Limit::Following { joint } => {
            format!("{joint} is {value:.4} rad away from its command; {range}: look for what holds the arm")
        }
        Limit::Workspace { side, axis } => format!("the {side} gripper was to go to {axis} = {value:.4} m; {range}"),
        Limit::GripperDistance => format!("the grippers were to be {value:.4} m apart; {range}"),
        Limit::Clearance { first, second } => {
            format!("{first} was to come within {value:.4} m of {second}; at least {lower:.4} m is kept")
        }
        Limit::Freshness { side } => {
            format!(
                "the {side} arm's joint positions are {value:.3} s old; at most {upper:.3} s is allowed: check /robot/joint_states"
            )
        }
        Limit::StopLatch => "the stop latch is set; reset, enable and start again".into(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_refusal_says_what_value_and_range() {
        let breach =
            LimitBreach { what: Limit::JointPosition { joint: "left_e1".into() }, value: 2.7, range: (-0.05, 2.618) };
        assert_eq!(breach.to_string(), "left_e1 was to go to 2.7000 rad; allowed are -0.0500 to 2.6180");
        let stale = LimitBreach { what: Limit::Freshness { side: Side::Right }, value: 0.3, range: (0.0, 0.1) };
        assert!(stale.to_string().contains("right arm's joint positions are 0.300 s old"));
    }
}
