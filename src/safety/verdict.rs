//! How strict a judgement is, and why.

use serde::{Deserialize, Serialize};

/// What a judgement asks of the robot, the mildest first: of several the strictest counts.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Reaction {
    /// Nothing to say.
    #[default]
    Clear,
    /// The operator is told.
    Advise,
    /// The arms slow down.
    Slow,
    /// The arms come to a halt, enabled, until the operator says how it goes on.
    Hold,
    /// The emergency stop by software, latched.
    Stop,
}

impl Reaction {
    /// The reaction in one word.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Clear => "clear",
            Self::Advise => "advise",
            Self::Slow => "slow",
            Self::Hold => "hold",
            Self::Stop => "stop",
        }
    }
}

impl std::fmt::Display for Reaction {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        formatter.pad(self.name())
    }
}

/// A judgement with its cause.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Verdict {
    /// What it asks for.
    pub reaction: Reaction,
    /// What brought it about, in words with numbers; empty where all is clear.
    pub cause: String,
    /// Newtons that remain until the next stricter tier; `None` where force has no part in it.
    pub margin_newtons: Option<f64>,
}

impl Verdict {
    /// All is clear.
    #[must_use]
    pub fn clear() -> Self {
        Self::default()
    }

    /// A judgement with its cause.
    #[must_use]
    pub fn new(reaction: Reaction, cause: impl Into<String>) -> Self {
        Self { reaction, cause: cause.into(), margin_newtons: None }
    }

    /// The same with the newtons that remain until the next stricter tier.
    #[must_use]
    pub fn with_margin(mut self, newtons: Option<f64>) -> Self {
        self.margin_newtons = newtons;
        self
    }

    /// The stricter of two; of two equally strict ones the first, so that the cause that was found first stays on the
    /// screen. The smaller margin is kept.
    ///
    /// ```
    /// use valet::safety::{Reaction, Verdict};
    ///
    /// let slow = Verdict::new(Reaction::Slow, "force 12.3 N");
    /// let hold = Verdict::new(Reaction::Hold, "the joints are 120 ms old");
    /// assert_eq!(slow.clone().stricter(hold.clone()), hold);
    /// assert_eq!(hold.clone().stricter(slow), hold);
    /// ```
    #[must_use]
    pub fn stricter(self, other: Self) -> Self {
        let margin_newtons = match (self.margin_newtons, other.margin_newtons) {
            (Some(mine), Some(theirs)) => Some(mine.min(theirs)),
            (mine, theirs) => mine.or(theirs),
        };
        let strictest = if other.reaction > self.reaction { other } else { self };
        Self { margin_newtons, ..strictest }
    }

    /// The strictest of many; clear where there are none.
    #[must_use]
    pub fn strictest(verdicts: impl IntoIterator<Item = Self>) -> Self {
        verdicts.into_iter().fold(Self::clear(), Self::stricter)
    }

    /// Whether motion may go on, slowed or not.
    #[must_use]
    pub fn allows_motion(&self) -> bool {
        self.reaction < Reaction::Hold
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const ALL: [Reaction; 5] = [Reaction::Clear, Reaction::Advise, Reaction::Slow, Reaction::Hold, Reaction::Stop];

    fn any_verdict() -> impl Strategy<Value = Verdict> {
        (0_usize..5, "[a-z]{0,4}", proptest::option::of(-5.0..30.0_f64))
            .prop_map(|(index, cause, margin)| Verdict::new(ALL[index], cause).with_margin(margin))
    }

    #[test]
    fn reactions_are_ordered_from_mild_to_strict() {
        assert!(ALL.windows(2).all(|pair| pair[0] < pair[1]));
    }

    #[test]
    fn only_hold_and_stop_forbid_motion() {
        assert_eq!(ALL.map(|reaction| Verdict::new(reaction, "").allows_motion()), [true, true, true, false, false]);
    }

    proptest! {
        #[test]
        fn the_strictest_wins_in_whatever_order(verdicts in proptest::collection::vec(any_verdict(), 0..8)) {
            let forwards = Verdict::strictest(verdicts.clone());
            let backwards = Verdict::strictest(verdicts.iter().rev().cloned());
            prop_assert_eq!(forwards.reaction, backwards.reaction);
            prop_assert_eq!(forwards.margin_newtons, backwards.margin_newtons);
            prop_assert_eq!(forwards.reaction, verdicts.iter().map(|verdict| verdict.reaction).max().unwrap_or_default());
        }

        #[test]
        fn grouping_does_not_matter(a in any_verdict(), b in any_verdict(), c in any_verdict()) {
            let left = a.clone().stricter(b.clone()).stricter(c.clone());
            let right = a.stricter(b.stricter(c));
            prop_assert_eq!(left, right);
        }

        #[test]
        fn a_clear_verdict_takes_nothing_away(verdict in any_verdict()) {
            prop_assert_eq!(Verdict::clear().stricter(verdict.clone()).reaction, verdict.reaction);
            prop_assert_eq!(verdict.clone().stricter(Verdict::clear()), verdict);
        }
    }
}
