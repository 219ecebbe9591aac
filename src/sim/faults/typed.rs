//! Faults as they are typed: `KIND[=VALUE]@SECONDS[+SECONDS][:SIDE]`, as in `biased_force=5,0,0@20+3:right`.

use super::{Fault, FaultKind};
use crate::body::Side;
use std::fmt;
use std::str::FromStr;
use thiserror::Error;

/// A number with its sense and what people or robots have of it at the most.
type Limit = (&'static str, f64, f64);

/// The kinds that take a value, with what it may be: newtons, seconds, a share, metres.
const FORCE: Limit = ("newtons along x, y, z, as in biased_force=5,0,0", -60.0, 60.0);
const DELAY: Limit = ("seconds, as in late_commands=0.2", 0.0, 5.0);
const SHARE: Limit = ("a share, as in dropped_commands=0.5", 0.0, 1.0);
const AWAY: Limit = ("metres, as in pull_away=0.1", 0.0, 0.5);

/// A fault that was typed and cannot be.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum TypedFaultError {
    /// No such kind.
    #[error("there is no fault {typed}: take one of {}", FaultKind::NAMES.join(", "))]
    Unknown {
        /// What was typed.
        typed: String,
    },
    /// No moment was given, or one that is no number.
    #[error("{typed} does not say when: add @SECONDS, as in stale_force@20+3:right")]
    When {
        /// What was typed.
        typed: String,
    },
    /// A side that nobody has.
    #[error("{typed} is no side: take left or right, or leave it out for both")]
    Side {
        /// What was typed.
        typed: String,
    },
    /// A value that is missing, not wanted, or out of its range.
    #[error("{kind} {wanted}")]
    Value {
        /// The kind.
        kind: &'static str,
        /// What it takes, in words.
        wanted: String,
    },
}

impl FromStr for Fault {
    type Err = TypedFaultError;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        let when = || TypedFaultError::When { typed: text.to_owned() };
        let (what, rest) = text.split_once('@').ok_or_else(when)?;
        let (span, side) = rest.split_once(':').map_or((rest, None), |(span, side)| (span, Some(side)));
        let (from, lasts) = span.split_once('+').map_or((span, None), |(from, lasts)| (from, Some(lasts)));
        let seconds = |text: &str| number(text).filter(|value| *value >= 0.0).ok_or_else(when);
        let side = side.map(|side| match side {
            "left" => Ok(Side::Left),
            "right" => Ok(Side::Right),
            _ => Err(TypedFaultError::Side { typed: side.to_owned() }),
        });
        Ok(Self {
            kind: kind(what)?,
            side: side.transpose()?,
            from_seconds: seconds(from)?,
            duration_seconds: lasts.map(seconds).transpose()?,
        })
    }
}

impl fmt::Display for Fault {
    /// As it can be typed again.
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(self.kind.name())?;
        match self.kind {
            FaultKind::BiasedForce { newtons: [x, y, z] } => write!(formatter, "={x},{y},{z}")?,
            FaultKind::LateCommands { seconds: value }
            | FaultKind::DroppedCommands { share: value }
            | FaultKind::PullAway { metres: value } => write!(formatter, "={value}")?,
            _ => {}
        }
        write!(formatter, "@{}", self.from_seconds)?;
        if let Some(seconds) = self.duration_seconds {
            write!(formatter, "+{seconds}")?;
        }
        self.side.map_or(Ok(()), |side| write!(formatter, ":{}", side.name()))
    }
}

fn number(text: &str) -> Option<f64> {
    text.trim().parse().ok().filter(|value: &f64| value.is_finite())
}

fn kind(typed: &str) -> Result<FaultKind, TypedFaultError> {
    let (name, value) = typed.split_once('=').map_or((typed, None), |(name, value)| (name, Some(value)));
    let one = |kind: &'static str, limit: Limit| values::<1>(kind, value, limit).map(|[value]| value);
    let kind = match name {
        "stale_force" => FaultKind::StaleForce,
        "frozen_force" => FaultKind::FrozenForce,
        "biased_force" => return Ok(FaultKind::BiasedForce { newtons: values("biased_force", value, FORCE)? }),
        "not_a_number_force" => FaultKind::NotANumberForce,
        "lost_camera" => FaultKind::LostCamera,
        "lost_pose" => FaultKind::LostPose,
        "late_commands" => return Ok(FaultKind::LateCommands { seconds: one("late_commands", DELAY)? }),
        "dropped_commands" => return Ok(FaultKind::DroppedCommands { share: one("dropped_commands", SHARE)? }),
        "stale_joints" => FaultKind::StaleJoints,
        "joint_fault" => FaultKind::JointFault,
        "red_button" => FaultKind::RedButton,
        "snag" => FaultKind::Snag,
        "garment_slip" => FaultKind::GarmentSlip,
        "pull_away" => return Ok(FaultKind::PullAway { metres: one("pull_away", AWAY)? }),
        _ => return Err(TypedFaultError::Unknown { typed: name.to_owned() }),
    };
    match value {
        None => Ok(kind),
        Some(_) => Err(TypedFaultError::Value { kind: kind.name(), wanted: "takes no value".into() }),
    }
}

/// As many numbers as a kind takes, each within its limits.
fn values<const COUNT: usize>(
    kind: &'static str,
    typed: Option<&str>,
    (words, lowest, highest): Limit,
) -> Result<[f64; COUNT], TypedFaultError> {
    let numbers: Option<Vec<f64>> = typed.map(|text| text.split(',').map(number).collect()).unwrap_or_default();
    let within = numbers.filter(|numbers| numbers.iter().all(|value| (lowest..=highest).contains(value)));
    within.and_then(|numbers| numbers.try_into().ok()).ok_or_else(|| TypedFaultError::Value {
        kind,
        wanted: format!("takes {words}, each from {lowest} to {highest}"),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_kind_can_be_typed_by_its_name() {
        for name in FaultKind::NAMES {
            let value = match name {
                "biased_force" => "=5,0,-1",
                "late_commands" | "dropped_commands" | "pull_away" => "=0.2",
                _ => "",
            };
            let fault: Fault = format!("{name}{value}@20+3:right").parse().unwrap();
            assert_eq!((fault.kind.name(), fault.side), (name, Some(Side::Right)));
            assert!(fault.is_active(22.9, Side::Right) && !fault.is_active(23.0, Side::Right));
            assert!(!fault.is_active(21.0, Side::Left));
            assert_eq!(fault.to_string().parse(), Ok(fault));
        }
    }

    #[test]
    fn what_is_left_out_means_both_sides_and_for_ever() {
        let fault: Fault = "biased_force=5,0,-1@1.5".parse().unwrap();
        assert_eq!(fault.kind, FaultKind::BiasedForce { newtons: [5.0, 0.0, -1.0] });
        assert!(
            fault.is_active(1e6, Side::Left) && fault.is_active(1e6, Side::Right) && !fault.is_active(1.4, Side::Left)
        );
    }

    #[test]
    fn what_cannot_be_is_refused_with_what_can() {
        for (typed, word) in [
            ("stale_force", "@SECONDS"),
            ("stale_force@soon", "@SECONDS"),
            ("stale_force@-1", "@SECONDS"),
            ("stale_force@1:front", "left or right"),
            ("earthquake@1", "garment_slip"),
            ("snag=3@1", "no value"),
            ("pull_away@1", "metres"),
            ("pull_away=9@1", "0.5"),
            ("biased_force=1,2@1", "x, y, z"),
            ("dropped_commands=nan@1", "share"),
        ] {
            let refused = typed.parse::<Fault>().unwrap_err().to_string();
            assert!(refused.contains(word), "{typed}: {refused}");
        }
    }
}
