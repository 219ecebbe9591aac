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
#[error("{}{}", sentence(.what, *.value, *.range), what_would_do(self))]
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

impl LimitBreach {
    /// The allowed value that is nearest to the one that breaks the limit; `None` where there is nothing near it: the value is no
    /// number, or the limit is not one of places and speeds.
    #[must_use]
    pub fn nearest(&self) -> Option<f64> {
        let is_of_motion = !matches!(self.what, Limit::Following { .. } | Limit::Freshness { .. } | Limit::StopLatch);
        // A range that a NaN has come into has no end to go to.
        (is_of_motion && !self.value.is_nan()).then(|| self.value.max(self.range.0).min(self.range.1))
    }
}

fn what_would_do(breach: &LimitBreach) -> String {
    match (breach.nearest(), &breach.what) {
        // The least distance that is kept is told already.
        (Some(nearest), Limit::Clearance { .. }) => format!(": {:.4} m further off would do", nearest - breach.value),
        (Some(nearest), _) => format!("; {nearest:.4} would do"),
        (None, Limit::Following { .. } | Limit::Freshness { .. } | Limit::StopLatch) => String::new(),
        (None, _) => "; it is not a number, so nothing near it would do: plan the move again".into(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_refusal_says_what_value_and_range() {
        let breach =
            LimitBreach { what: Limit::JointPosition { joint: "left_e1".into() }, value: 2.7, range: (-0.05, 2.618) };
        assert_eq!(
            breach.to_string(),
            "left_e1 was to go to 2.7000 rad; allowed are -0.0500 to 2.6180; 2.6180 would do"
        );
        let stale = LimitBreach { what: Limit::Freshness { side: Side::Right }, value: 0.3, range: (0.0, 0.1) };
        assert!(stale.to_string().contains("right arm's joint positions are 0.300 s old"));
    }
    #[test]
    fn a_refusal_names_the_nearest_value_that_would_do() {
        let range = (0.1, 0.9);
        for (value, nearest) in [(0.04, 0.1), (0.95, 0.9), (f64::INFINITY, 0.9)] {
            let breach = LimitBreach { what: Limit::GripperDistance, value, range };
            assert_eq!(breach.nearest(), Some(nearest));
            assert!(breach.to_string().ends_with(&format!("; {nearest:.4} would do")), "{breach}");
        }
        let workspace = LimitBreach { what: Limit::Workspace { side: Side::Left, axis: 'z' }, value: 1.8, range };
        assert!(workspace.to_string().ends_with("; 0.9000 would do"), "{workspace}");
        let what = Limit::Clearance { first: "the left hand".into(), second: "the person's head".into() };
        let close = LimitBreach { what, value: 0.004, range: (0.01, f64::INFINITY) };
        assert!(close.to_string().contains("at least 0.0100 m is kept: 0.0060 m further off would do"), "{close}");
    }

    #[test]
    fn where_nothing_near_would_do_none_is_named() {
        let missing =
            LimitBreach { what: Limit::JointPosition { joint: "left_w0".into() }, value: f64::NAN, range: (-3.0, 3.0) };
        assert_eq!(missing.nearest(), None);
        assert!(missing.to_string().ends_with("nothing near it would do: plan the move again"), "{missing}");
        let latch = LimitBreach { what: Limit::StopLatch, value: 1.0, range: (0.0, 0.0) };
        assert_eq!(latch.to_string(), "the stop latch is set; reset, enable and start again");
    }
}
