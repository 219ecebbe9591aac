//! What is a reason to draw: news, and things that go stale or turn out not to be confirmed. Time that passes is none; the
//! clock has its own.

use crate::snapshot::{CheckLine, Shared, Snapshot, StopPhase, TopicHealth, Verdict};

/// What can change on the screen though no message came.
#[derive(Debug, PartialEq)]
pub(super) struct Vitals {
    stop: StopPhase,
    fresh: [bool; 4],
    topics: Vec<Verdict>,
}

impl Vitals {
    pub(super) fn of(snapshot: &Snapshot) -> Self {
        let now = snapshot.now;
        let force = |side| snapshot.sides.get(side).force.freshness.is_fresh(now);
        let body = snapshot.body.freshness.is_fresh(now);
        let fresh = [
            snapshot.robot.fresh(now).is_some(),
            force(crate::body::Side::Left),
            force(crate::body::Side::Right),
            body,
        ];
        let topics = snapshot.topics.iter().map(|topic| topic.verdict(now)).collect();
        Self { stop: snapshot.stop.phase(now), fresh, topics }
    }
}

/// True where a snapshot says more than that time has passed since the one before.
pub(super) fn is_news(mut known: Snapshot, newer: &mut Snapshot) -> bool {
    known.now = newer.now;
    // What grows with time alone is compared apart, and is put back.
    let checks = (std::mem::take(&mut known.checks), std::mem::take(&mut newer.checks));
    let topics = (std::mem::take(&mut known.topics), std::mem::take(&mut newer.topics));
    let news = known != *newer || !are_the_same_checks(&checks) || !are_the_same_topics(&topics);
    (newer.checks, newer.topics) = (checks.1, topics.1);
    news
}

fn are_the_same_checks((known, newer): &(Shared<Vec<CheckLine>>, Shared<Vec<CheckLine>>)) -> bool {
    let said = |check: &CheckLine| (check.name.clone(), check.verdict, check.value.clone(), check.hint.clone());
    known.len() == newer.len() && known.iter().zip(newer.iter()).all(|(known, newer)| said(known) == said(newer))
}

/// Rate, gap and jitter change with every beat; without a message they say only that time has passed, and a verdict that
/// changes with them is among the vitals.
fn are_the_same_topics((known, newer): &(Shared<Vec<TopicHealth>>, Shared<Vec<TopicHealth>>)) -> bool {
    let same = |known: &TopicHealth, newer: &TopicHealth| {
        let (rate, gap, jitter) = (newer.rate, newer.gap, newer.jitter);
        *newer == TopicHealth { rate, gap, jitter, ..known.clone() }
    };
    known.len() == newer.len() && known.iter().zip(newer.iter()).all(|(known, newer)| same(known, newer))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::console::{Situation, fixture};
    use std::time::Duration;

    fn later(snapshot: &Snapshot) -> Snapshot {
        let mut later = Snapshot { now: snapshot.now + Duration::from_millis(33), ..snapshot.clone() };
        for check in later.checks.make_mut() {
            check.age = check.age.map(|age| age + 0.033);
        }
        for topic in later.topics.make_mut() {
            topic.rate *= 0.9;
        }
        later
    }

    #[test]
    fn time_that_passes_over_silent_topics_is_no_news() {
        let stale = fixture(Situation::Stale);
        assert!(stale.topics.iter().all(|topic| topic.verdict(stale.now) >= Verdict::Stale));
        let mut later = later(&stale);
        let untouched = later.clone();
        assert!(!is_news(stale, &mut later));
        assert_eq!(later, untouched);
    }

    #[test]
    fn a_message_a_check_and_a_line_of_the_log_are_news() {
        let live = fixture(Situation::Live);
        assert!(!is_news(live.clone(), &mut later(&live)), "rates without a message");
        let mut heard = later(&live);
        heard.topics.make_mut()[0].freshness.last = Some(heard.now);
        assert!(is_news(live, &mut heard));
        let stale = fixture(Situation::Stale);
        let changes: [fn(&mut Snapshot); 4] = [
            |snapshot| snapshot.topics.make_mut()[0].freshness.last = Some(snapshot.now),
            |snapshot| snapshot.topics.make_mut()[0].publishers.push("/other".into()),
            |snapshot| snapshot.topics.make_mut().clear(),
            |snapshot| snapshot.dropped_samples += 1,
        ];
        for change in changes {
            let mut newer = later(&stale);
            change(&mut newer);
            assert!(is_news(stale.clone(), &mut newer));
        }
        let mut checked = later(&stale);
        let line = |verdict| CheckLine {
            name: "master".into(),
            verdict,
            value: String::new(),
            hint: String::new(),
            age: None,
        };
        checked.checks.make_mut().push(line(Verdict::Good));
        let mut failed = checked.clone();
        failed.checks.make_mut().pop();
        failed.checks.make_mut().push(line(Verdict::Fault));
        assert!(is_news(checked, &mut failed));
    }
}
