//! How a subscribed topic does: shared between its callback, the watch and whoever shows it.
//!
//! Judges nothing: the core's watchdogs decide what a silence means. This is for the check-list, for diagnostics, and for
//! the watch, which subscribes anew where a live publisher has gone silent.

use super::definitions::Definition;
use crate::sensing::{Freshness, FreshnessSettings};
use crate::time::Stamp;
use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, SystemTime, UNIX_EPOCH};

/// The time of day, as the engine and message headers count it.
#[must_use]
pub fn now() -> Stamp {
    Stamp::ZERO + SystemTime::now().duration_since(UNIX_EPOCH).unwrap_or_default()
}

/// What a topic's messages did lately.
#[derive(Clone, Debug, PartialEq)]
pub struct TopicReport {
    /// The topic, as the master knows it.
    pub topic: String,
    /// Its type.
    pub kind: String,
    /// When the newest message arrived; `None` where none did.
    pub newest: Option<Stamp>,
    /// Seconds since then.
    pub age_seconds: Option<f64>,
    /// Messages a second now.
    pub hertz: f64,
    /// Least and most messages a second that are expected.
    pub expected_hertz: (f64, f64),
    /// The longest time without a message lately, in seconds.
    pub gap_seconds: f64,
    /// Standard deviation of the times between messages, in seconds.
    pub jitter_seconds: f64,
    /// How far the newest message's own stamp lies behind its arrival, in seconds; `None` where it has none.
    pub stamp_lag_seconds: Option<f64>,
    /// Messages that could not be used.
    pub unusable: u64,
    /// Nodes that publish it, as the master knows them.
    pub publishers: Vec<String>,
    /// Those of them whose messages cannot be read, and what they publish: type and digest.
    pub wrong: Vec<(String, String)>,
    /// True where a trial cannot go on without it.
    pub required: bool,
}

impl TopicReport {
    /// True where messages come as they should.
    #[must_use]
    pub fn is_good(&self) -> bool {
        let (least, most) = self.expected_hertz;
        self.age_seconds.is_some_and(|age| age < 0.5) && (least..=most).contains(&self.hertz)
    }
}

#[derive(Debug)]
struct State {
    freshness: Freshness,
    unusable: u64,
    publishers: Vec<String>,
    /// What publishers with another definition publish, by their names.
    wrong: BTreeMap<String, String>,
}

/// One topic's monitor. Cheap to clone.
#[derive(Clone, Debug)]
pub(super) struct Monitor {
    /// As it was asked for.
    pub(super) topic: String,
    /// As the master knows it, after remappings.
    pub(super) resolved: String,
    /// The definitions that are read here.
    pub(super) definitions: Vec<Definition>,
    required: bool,
    expected_hertz: (f64, f64),
    /// Its publisher says once what holds for good.
    said_once: bool,
    state: Arc<Mutex<State>>,
}

impl Monitor {
    pub(super) fn new(topic: &str, definition: Definition, expected_hertz: (f64, f64), required: bool) -> Self {
        let (least, most) = expected_hertz;
        let settings = FreshnessSettings::new(least, most, Duration::from_millis(500));
        let state =
            State { freshness: Freshness::new(settings), unusable: 0, publishers: Vec::new(), wrong: BTreeMap::new() };
        let (topic, resolved) = (topic.to_owned(), topic.to_owned());
        Self {
            topic,
            resolved,
            definitions: vec![definition],
            required,
            expected_hertz,
            said_once: false,
            state: Arc::new(Mutex::new(state)),
        }
    }

    /// The same under the name that the master knows.
    pub(super) fn resolved_as(self, resolved: String) -> Self {
        Self { resolved, ..self }
    }

    /// The same where messages of one type are read by several definitions.
    pub(super) fn reading(self, digests: Vec<String>) -> Self {
        let kind = self.kind();
        let definition = |digest| Definition { kind: kind.clone(), digest };
        let definitions = digests.into_iter().map(definition).collect();
        Self { definitions, ..self }
    }

    /// The same where the publisher says once what holds for good.
    pub(super) fn said_once(self) -> Self {
        Self { said_once: true, ..self }
    }

    fn kind(&self) -> String {
        self.definitions.first().map(|definition| definition.kind.clone()).unwrap_or_default()
    }

    fn with<T>(&self, act: impl FnOnce(&mut State) -> T) -> T {
        act(&mut self.state.lock().unwrap_or_else(PoisonError::into_inner))
    }

    /// A message arrived, with a stamp of its own or none.
    pub(super) fn observe(&self, arrival: Stamp, own: Option<Stamp>) {
        self.with(|state| state.freshness.observe(arrival, own));
    }

    /// A message could not be used.
    pub(super) fn unusable(&self) {
        self.with(|state| state.unusable += 1);
    }

    pub(super) fn set_publishers(&self, publishers: Vec<String>) {
        self.with(|state| {
            state.wrong.retain(|node, _| publishers.contains(node));
            state.publishers = publishers;
        });
    }

    /// What a publisher publishes by a definition that is not read here; `None` where it is.
    pub(super) fn set_wrong(&self, node: &str, found: Option<String>) {
        self.with(|state| match found {
            Some(found) => drop(state.wrong.insert(node.to_owned(), found)),
            None => drop(state.wrong.remove(node)),
        });
    }

    /// True where somebody publishes and nothing has come for `span`; of what is said once, where nothing ever came.
    pub(super) fn is_silent(&self, now: Stamp, span: Duration) -> bool {
        let is_late = |state: &State| state.freshness.age(now).is_none_or(|age| age > span && !self.said_once);
        self.with(|state| !state.publishers.is_empty() && is_late(state))
    }

    pub(super) fn report(&self, now: Stamp) -> TopicReport {
        self.with(|state| TopicReport {
            topic: self.resolved.clone(),
            kind: self.kind(),
            newest: state.freshness.last(),
            age_seconds: state.freshness.age(now).map(|age| age.as_secs_f64()),
            hertz: state.freshness.rate(now),
            expected_hertz: self.expected_hertz,
            gap_seconds: state.freshness.gap(now),
            jitter_seconds: state.freshness.jitter(now),
            stamp_lag_seconds: state.freshness.stamp_lag(),
            unusable: state.unusable,
            publishers: state.publishers.clone(),
            wrong: state.wrong.iter().map(|(node, found)| (node.clone(), found.clone())).collect(),
            required: self.required,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn definition() -> Definition {
        Definition { kind: "type".into(), digest: "digest".into() }
    }

    #[test]
    fn silence_counts_only_where_somebody_publishes() {
        let monitor = Monitor::new("/robot/state", definition(), (80.0, 120.0), true);
        let at = |milliseconds: u64| Stamp::from_nanoseconds(milliseconds * 1_000_000);
        assert!(!monitor.is_silent(at(5_000), Duration::from_secs(2)));
        monitor.set_publishers(vec!["/robot".into()]);
        assert!(monitor.is_silent(at(5_000), Duration::from_secs(2)), "published and never heard");
        monitor.observe(at(5_000), None);
        assert!(!monitor.is_silent(at(6_000), Duration::from_secs(2)));
        assert!(monitor.is_silent(at(7_001), Duration::from_secs(2)));
    }

    #[test]
    fn what_is_said_once_is_silent_only_as_long_as_it_was_not_heard() {
        let monitor = Monitor::new("/tf_static", definition(), (0.0, f64::INFINITY), false).said_once();
        let at = |milliseconds: u64| Stamp::from_nanoseconds(milliseconds * 1_000_000);
        monitor.set_publishers(vec!["/robot".into()]);
        assert!(monitor.is_silent(at(5_000), Duration::from_secs(2)));
        monitor.observe(at(5_000), None);
        assert!(!monitor.is_silent(at(3_600_000), Duration::from_secs(2)));
    }

    #[test]
    fn a_report_tells_age_and_rate() {
        let monitor = Monitor::new("/robot/state", definition(), (80.0, 120.0), true);
        (0..100_u64).for_each(|index| {
            let arrival = Stamp::from_nanoseconds(index * 10_000_000 + 2_000_000);
            monitor.observe(arrival, Some(Stamp::from_nanoseconds(index * 10_000_000)));
        });
        monitor.unusable();
        let report = monitor.report(Stamp::from_nanoseconds(1_000_000_000));
        assert!((report.hertz - 100.0).abs() < 2.0 && report.is_good(), "{report:?}");
        assert_eq!((report.age_seconds, report.unusable), (Some(0.008), 1));
        assert!((report.stamp_lag_seconds.unwrap() - 0.002).abs() < 1e-9);
        assert!(!monitor.report(Stamp::from_nanoseconds(3_000_000_000)).is_good());
    }

    #[test]
    fn a_publisher_with_another_definition_is_reported_as_long_as_it_is_there() {
        let monitor = Monitor::new("/robot/state", definition(), (80.0, 120.0), true);
        monitor.set_publishers(vec!["/old_robot".into()]);
        monitor.set_wrong("/old_robot", Some("other (md5 1)".into()));
        assert_eq!(monitor.report(now()).wrong, [("/old_robot".to_owned(), "other (md5 1)".to_owned())]);
        monitor.set_publishers(vec!["/robot".into()]);
        assert!(monitor.report(now()).wrong.is_empty());
    }
}
