//! Moments and spans of time, as the core knows them.
//!
//! A [`Stamp`] is a plain number that comes in from outside: from a message header, from the engine's clock or from
//! virtual time. Nothing here reads a clock, and nothing in the core may.

use serde::{Deserialize, Serialize};
use std::fmt;
use std::ops::Add;
use std::time::Duration;

/// A moment: nanoseconds since the Unix epoch (robot and real time) or since the start of a run (virtual time).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(transparent)]
pub struct Stamp(u64);

const NANOSECONDS_PER_SECOND: u64 = 1_000_000_000;

impl Stamp {
    /// The start of the epoch, or of a virtual run.
    pub const ZERO: Self = Self(0);

    /// A moment from its count of nanoseconds.
    #[must_use]
    pub const fn from_nanoseconds(nanoseconds: u64) -> Self {
        Self(nanoseconds)
    }

    /// A moment from seconds; `None` where the number is negative, not finite or beyond the range.
    #[must_use]
    pub fn from_seconds(seconds: f64) -> Option<Self> {
        Duration::try_from_secs_f64(seconds).ok().and_then(|span| Self::ZERO.checked_add(span))
    }

    /// A moment from the two words of a ROS header stamp.
    #[must_use]
    pub const fn from_ros(seconds: u32, nanoseconds: u32) -> Self {
        Self(seconds as u64 * NANOSECONDS_PER_SECOND + nanoseconds as u64)
    }

    /// The two words of a ROS header stamp: seconds (wrapping after the year 2106, as ROS 1 does) and nanoseconds.
    #[must_use]
    #[expect(clippy::cast_possible_truncation, reason = "ROS 1 counts seconds in 32 bits")]
    pub const fn to_ros(self) -> (u32, u32) {
        ((self.0 / NANOSECONDS_PER_SECOND) as u32, (self.0 % NANOSECONDS_PER_SECOND) as u32)
    }

    /// Nanoseconds since the epoch.
    #[must_use]
    pub const fn nanoseconds(self) -> u64 {
        self.0
    }

    /// Seconds since the epoch, to the precision of an `f64`.
    #[must_use]
    pub fn seconds(self) -> f64 {
        Duration::from_nanos(self.0).as_secs_f64()
    }

    /// The time that has passed since `earlier`, or `None` where `earlier` lies in the future: a clock has jumped.
    #[must_use]
    pub fn checked_since(self, earlier: Self) -> Option<Duration> {
        self.0.checked_sub(earlier.0).map(Duration::from_nanos)
    }

    /// The time that has passed since `earlier`; zero where `earlier` lies in the future.
    #[must_use]
    pub fn since(self, earlier: Self) -> Duration {
        self.checked_since(earlier).unwrap_or_default()
    }

    /// The time between two moments, whichever is the earlier.
    #[must_use]
    pub fn distance(self, other: Self) -> Duration {
        Duration::from_nanos(self.0.abs_diff(other.0))
    }

    /// The moment a span later, or `None` where it is beyond the range.
    #[must_use]
    pub fn checked_add(self, span: Duration) -> Option<Self> {
        u64::try_from(span.as_nanos()).ok().and_then(|nanoseconds| self.0.checked_add(nanoseconds)).map(Self)
    }
}

/// Adds a span; stops at the end of the range.
impl Add<Duration> for Stamp {
    type Output = Self;

    fn add(self, span: Duration) -> Self {
        self.checked_add(span).unwrap_or(Self(u64::MAX))
    }
}

impl fmt::Display for Stamp {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(formatter, "{}.{:09} s", self.0 / NANOSECONDS_PER_SECOND, self.0 % NANOSECONDS_PER_SECOND)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn a_clock_that_jumps_back_is_told_apart_from_no_time_passed() {
        let early = Stamp::from_nanoseconds(5);
        let late = Stamp::from_nanoseconds(9);
        assert_eq!(late.checked_since(early), Some(Duration::from_nanos(4)));
        assert_eq!(early.checked_since(late), None);
        assert_eq!(early.since(late), Duration::ZERO);
        assert_eq!((early.distance(late), late.distance(early)), (Duration::from_nanos(4), Duration::from_nanos(4)));
    }

    #[test]
    fn seconds_that_are_no_moment_are_refused() {
        assert_eq!(Stamp::from_seconds(-1.0), None);
        assert_eq!(Stamp::from_seconds(f64::NAN), None);
        assert_eq!(Stamp::from_seconds(f64::INFINITY), None);
        assert_eq!(Stamp::from_seconds(1.5), Some(Stamp::from_nanoseconds(1_500_000_000)));
    }

    proptest! {
        #[test]
        fn ros_words_return_the_same_moment(seconds: u32, nanoseconds in 0_u32..1_000_000_000) {
            prop_assert_eq!(Stamp::from_ros(seconds, nanoseconds).to_ros(), (seconds, nanoseconds));
        }

        #[test]
        fn adding_and_taking_away_agree(start in 0_u64..u64::MAX / 2, span in 0_u64..u64::MAX / 2) {
            let start = Stamp::from_nanoseconds(start);
            let span = Duration::from_nanos(span);
            prop_assert_eq!((start + span).checked_since(start), Some(span));
        }
    }
}
