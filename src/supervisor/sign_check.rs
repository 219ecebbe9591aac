//! The sign check of a wrench: the operator pushes a gripper by hand, and valet says along which axis and with which sign the
//! force came in. Watches and tells; moves nothing and changes no setting.

use super::Supervisor;
use crate::body::Side;
use crate::geometry::Vector;
use crate::snapshot::Level;
use crate::time::Stamp;
use std::time::Duration;

/// How long the push is waited for.
const PATIENCE: Duration = Duration::from_secs(15);
/// A push in newtons that nobody makes by accident, well below what pauses a trial.
const PUSH_NEWTONS: f64 = 4.0;
/// The largest part must be so many times the next: a push between two axes tells no sign.
const CLEARLY: f64 = 2.0;

/// A check under way.
#[derive(Clone, Copy, Debug)]
pub(super) struct SignCheck {
    side: Side,
    began: Stamp,
    /// The force before the push; taken with the first sample.
    rest: Option<Vector>,
}

/// Along which axis a push came in.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Push {
    axis: usize,
    newtons: f64,
}

impl Push {
    /// The push in a change of force, where it is one and along one axis.
    fn of(change: &Vector) -> Option<Self> {
        let (axis, newtons) =
            change.iter().copied().enumerate().max_by(|one, two| one.1.abs().total_cmp(&two.1.abs()))?;
        let others = change.iter().enumerate().filter(|(other, _)| *other != axis);
        let next = others.map(|(_, value)| value.abs()).fold(0.0, f64::max);
        let is_clear = newtons.abs() >= PUSH_NEWTONS && newtons.abs() >= CLEARLY * next;
        is_clear.then_some(Self { axis, newtons })
    }

    /// What came in, and what the operator is to compare it with.
    fn words(self, side: Side) -> String {
        let axis = ["x", "y", "z"].get(self.axis).copied().unwrap_or("?");
        let sign = if self.newtons < 0.0 { '-' } else { '+' };
        let (away, back) =
            [("away from the robot", "towards the robot"), ("to the robot's left", "to its right"), ("up", "down")]
                .get(self.axis)
                .copied()
                .unwrap_or_default();
        let meant = if self.newtons < 0.0 { back } else { away };
        format!(
            "the {side} gripper felt {sign}{:.1} N along {axis}: right where you pushed it {meant}; if you pushed the other \
             way, turn the sign in [wrench] of the settings",
            self.newtons.abs()
        )
    }
}

impl Supervisor {
    pub(super) fn begin_sign_check(&mut self, now: Stamp, side: Side) -> Result<String, String> {
        if self.trial.is_some() {
            return Err("only before a trial: nobody pushes a gripper while the garment is on it".into());
        }
        self.sign_check = Some(SignCheck { side, began: now, rest: None });
        Ok(format!("push the {side} gripper along one axis with about 8 N within {} s", PATIENCE.as_secs()))
    }

    /// Looks at the newest force of an arm, after it has been read.
    pub(super) fn follow_sign_check(&mut self, now: Stamp, side: Side) {
        let Some(check) = self.sign_check.filter(|check| check.side == side) else { return };
        if now.since(check.began) > PATIENCE {
            self.sign_check = None;
            let text = format!("no push along one axis of the {side} gripper was felt: check again");
            return self.log(now, Level::Warning, "sign check", text);
        }
        let Some(force) = self.protection.reading(side).map(|reading| reading.force) else { return };
        let Some(rest) = check.rest else {
            self.sign_check = Some(SignCheck { rest: Some(force), ..check });
            return;
        };
        if let Some(push) = Push::of(&(force - rest)) {
            self.sign_check = None;
            self.log(now, Level::Information, "sign check", push.words(side));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_push_along_one_axis_is_told_with_its_sign_and_anything_else_is_not() {
        let push = Push::of(&Vector::new(0.5, -7.0, 1.0)).unwrap();
        assert_eq!((push.axis, push.newtons), (1, -7.0));
        let words = push.words(Side::Left);
        assert!(words.contains("-7.0 N along y") && words.contains("to its right"), "{words}");
        assert_eq!(Push::of(&Vector::new(3.0, 0.0, 0.0)), None, "too weak");
        assert_eq!(Push::of(&Vector::new(6.0, 5.0, 0.0)), None, "between two axes");
        assert_eq!(Push::of(&Vector::new(f64::NAN, f64::NAN, f64::NAN)), None);
    }
}
