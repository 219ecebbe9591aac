//! Whether a stream of messages still lives: age, rate, gaps, jitter, and how far its own stamps lie behind.
//!
//! The rate falls when messages stop, because it is taken from the present moment and not from the last message. A backlog
//! that arrives in a burst after a broken connection is not fresh although it has just arrived: its stamps lag.

use crate::time::Stamp;
use serde::{Deserialize, Serialize};
use std::collections::VecDeque;
use std::time::Duration;

/// Arrivals that are remembered: more than a second of the fastest stream.
const REMEMBERED: usize = 256;
/// The span over which rate, gap and jitter are taken.
const SPAN: Duration = Duration::from_secs(1);
/// Stamps that are this much further ahead than any before jumped, in seconds: no way through a network gains so much.
const JUMP_SECONDS: f64 = 0.5;
/// Stamps that stay ahead for so long come from a clock that was set; a shorter jump must not make all later stamps look old.
const SET_AFTER: Duration = Duration::from_secs(5);

/// What is expected of a stream.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct FreshnessSettings {
    /// Least messages a second.
    pub least_hertz: f64,
    /// Most messages a second.
    pub most_hertz: f64,
    /// A value older than this does not hold any more.
    pub deadline: Duration,
}

impl FreshnessSettings {
    /// What is expected of a stream of `least` to `most` messages a second that is worth nothing after `deadline`.
    #[must_use]
    pub const fn new(least_hertz: f64, most_hertz: f64, deadline: Duration) -> Self {
        Self { least_hertz, most_hertz, deadline }
    }
}

/// The life of one stream.
///
/// ```
/// use std::time::Duration;
/// use valet::sensing::{Freshness, FreshnessSettings};
/// use valet::time::Stamp;
///
/// let mut force = Freshness::new(FreshnessSettings::new(80.0, 120.0, Duration::from_millis(60)));
/// for index in 0..100_u64 {
///     let arrival = Stamp::from_nanoseconds(index * 10_000_000);
///     force.observe(arrival, Some(arrival));
/// }
/// assert!(force.is_fresh(Stamp::from_nanoseconds(1_040_000_000)));
/// assert!(!force.is_fresh(Stamp::from_nanoseconds(1_060_000_000)));
/// ```
#[derive(Clone, Debug)]
pub struct Freshness {
    settings: FreshnessSettings,
    arrivals: VecDeque<Stamp>,
    lag: Option<f64>,
    least_lag: Option<f64>,
    ahead_since: Option<Stamp>,
    reordered: u64,
    newest_header: Option<Stamp>,
}

impl Freshness {
    /// A stream of which nothing has come in.
    #[must_use]
    pub fn new(settings: FreshnessSettings) -> Self {
        let arrivals = VecDeque::with_capacity(REMEMBERED);
        Self { settings, arrivals, lag: None, least_lag: None, ahead_since: None, reordered: 0, newest_header: None }
    }

    /// What is expected of it.
    #[must_use]
    pub const fn settings(&self) -> &FreshnessSettings {
        &self.settings
    }

    /// A message arrived; `header` is its own stamp where it has one.
    pub fn observe(&mut self, arrival: Stamp, header: Option<Stamp>) {
        self.forget_what_lies_ahead(arrival);
        if self.arrivals.len() == REMEMBERED {
            self.arrivals.pop_front();
        }
        self.arrivals.push_back(arrival);
        let Some(header) = header else { return };
        if self.newest_header.is_some_and(|newest| header < newest) {
            self.reordered += 1;
        }
        self.newest_header = self.newest_header.max(Some(header));
        let lag = arrival.seconds() - header.seconds();
        self.lag = Some(lag);
        self.take_lag(arrival, lag);
    }

    /// Forgets arrivals that lie ahead of the present moment: the clock went back, and what was measured with the old one means
    /// nothing, not even when the clock comes to those moments again.
    pub fn forget_what_lies_ahead(&mut self, now: Stamp) {
        if self.arrivals.back().is_some_and(|last| *last > now) {
            self.arrivals.clear();
            self.least_lag = None;
        }
    }

    fn take_lag(&mut self, arrival: Stamp, lag: f64) {
        let is_ahead = self.least_lag.is_some_and(|least| least - lag > JUMP_SECONDS);
        let since = *self.ahead_since.get_or_insert(arrival);
        let is_set = arrival.checked_since(since).is_none_or(|span| span > SET_AFTER);
        if is_ahead && !is_set {
            return;
        }
        self.ahead_since = None;
        self.least_lag = Some(self.least_lag.map_or(lag, |least| least.min(lag)));
    }

    /// True while the stamps are further ahead than they can be: their clock jumped, or they are wrong.
    #[must_use]
    pub const fn is_ahead(&self) -> bool {
        self.ahead_since.is_some()
    }

    /// When the newest message arrived.
    #[must_use]
    pub fn last(&self) -> Option<Stamp> {
        self.arrivals.back().copied()
    }

    /// Time since the newest message arrived; `None` where none did, or where the clock went back before it.
    #[must_use]
    pub fn age(&self, now: Stamp) -> Option<Duration> {
        now.checked_since(self.last()?)
    }

    /// How much longer the newest message was under way than the quickest one, in seconds. The two computers' clocks may
    /// differ by any constant.
    #[must_use]
    pub fn delay(&self) -> f64 {
        self.lag.zip(self.least_lag).map_or(0.0, |(lag, least)| (lag - least).max(0.0))
    }

    /// Whether the newest value still holds: its age and the delay of its way together are less than the deadline, and its
    /// stamp has not jumped ahead.
    #[must_use]
    pub fn is_fresh(&self, now: Stamp) -> bool {
        let age = self.age(now);
        !self.is_ahead()
            && age.is_some_and(|age| age.as_secs_f64() + self.delay() <= self.settings.deadline.as_secs_f64())
    }

    fn recent(&self, now: Stamp) -> impl Iterator<Item = Stamp> + '_ {
        self.arrivals.iter().copied().filter(move |arrival| now.checked_since(*arrival).is_some_and(|age| age <= SPAN))
    }

    /// Messages a second over the last second: falls to 0 within a second when they stop.
    #[must_use]
    pub fn rate(&self, now: Stamp) -> f64 {
        let Some(first) = self.recent(now).next() else { return 0.0 };
        let intervals = self.recent(now).count().saturating_sub(1);
        let span = now.since(first).as_secs_f64();
        if span > 0.0 { intervals as f64 / span } else { 0.0 }
    }

    /// Whether the rate is what is expected.
    #[must_use]
    pub fn rate_is_expected(&self, now: Stamp) -> bool {
        (self.settings.least_hertz..=self.settings.most_hertz).contains(&self.rate(now))
    }

    fn gaps(&self, now: Stamp) -> impl Iterator<Item = f64> + '_ {
        self.recent(now).zip(self.recent(now).skip(1)).map(|(early, late)| late.since(early).as_secs_f64())
    }

    /// The longest time without a message over the last second, the present one included, in seconds.
    #[must_use]
    pub fn gap(&self, now: Stamp) -> f64 {
        let open = self.age(now).map_or(0.0, |age| age.as_secs_f64());
        self.gaps(now).fold(open, f64::max)
    }

    /// The standard deviation of the gaps over the last second, in seconds.
    #[must_use]
    pub fn jitter(&self, now: Stamp) -> f64 {
        let (count, sum, squares) = self
            .gaps(now)
            .fold((0.0, 0.0, 0.0), |(count, sum, squares), gap| (count + 1.0, sum + gap, squares + gap * gap));
        if count < 2.0 {
            return 0.0;
        }
        (squares / count - (sum / count) * (sum / count)).max(0.0).sqrt()
    }

    /// How far the newest message's own stamp lies behind its arrival, in seconds; negative where it lies ahead.
    #[must_use]
    pub const fn stamp_lag(&self) -> Option<f64> {
        self.lag
    }

    /// Messages whose stamp was older than one seen before.
    #[must_use]
    pub const fn reordered(&self) -> u64 {
        self.reordered
    }

    /// Forgets the quickest way seen, as after a clock was set: an act of the operator.
    pub const fn rebase(&mut self) {
        self.least_lag = self.lag;
    }
}

#[cfg(test)]
mod tests;
