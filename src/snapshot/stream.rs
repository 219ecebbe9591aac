//! A snapshot on its way to another node: shortened where it leaves, put together again where it arrives.
//!
//! Series of force are sent as their newest part only, so that ten snapshots a second stay small; a watcher carries on
//! what it has had before. Lists that an operator reads (log, answers, marks) are sent whole as far as a screen shows them:
//! a watcher that comes late has them at once.

use super::{Detection, ForceSample, History, LogLine, ReceiptLine, Snapshot, TimelineEvent};
use crate::body::Side;
use crate::time::Stamp;

/// Samples of force that are sent: half a second of each arm at 100 Hz, five times what comes between two snapshots.
const FORCE_SAMPLES: usize = 50;
/// Lines, answers and marks that are sent: more than a screen shows.
const LINES: usize = 100;

/// What stands in a series at a moment of its own.
trait Dated {
    /// The moment, and a number that tells two values of one moment apart.
    fn order(&self) -> (Stamp, u64);
}

impl Dated for ForceSample {
    fn order(&self) -> (Stamp, u64) {
        (self.stamp, 0)
    }
}

impl Dated for Detection {
    fn order(&self) -> (Stamp, u64) {
        (self.stamp, 0)
    }
}

impl Dated for LogLine {
    fn order(&self) -> (Stamp, u64) {
        (self.stamp, self.id)
    }
}

impl Dated for ReceiptLine {
    fn order(&self) -> (Stamp, u64) {
        (self.stamp, 0)
    }
}

impl Dated for TimelineEvent {
    fn order(&self) -> (Stamp, u64) {
        (self.stamp, 0)
    }
}

fn carried_on<T: Dated + Clone>(earlier: &History<T>, newest: &History<T>) -> History<T> {
    let Some(last) = earlier.last().map(Dated::order) else { return newest.clone() };
    let mut whole = earlier.clone();
    whole.extend(newest.iter().filter(|value| value.order() > last).cloned());
    whole
}

impl Snapshot {
    /// The snapshot with its series cut to what is new and what a screen shows.
    #[must_use]
    pub fn shortened(&self) -> Self {
        let mut short = self.clone();
        for side in Side::BOTH {
            let force = &mut short.sides.get_mut(side).force;
            force.samples = force.samples.newest(FORCE_SAMPLES);
            force.detections = force.detections.newest(LINES);
        }
        short.log = short.log.newest(LINES);
        short.receipts = short.receipts.newest(LINES);
        short.timeline = short.timeline.newest(LINES);
        short
    }

    /// A shortened snapshot with the series of the one before it in front of its own.
    #[must_use]
    pub fn carrying_on(mut self, earlier: &Self) -> Self {
        for side in Side::BOTH {
            let before = &earlier.sides.get(side).force;
            let force = &mut self.sides.get_mut(side).force;
            force.samples = carried_on(&before.samples, &force.samples);
            force.detections = carried_on(&before.detections, &force.detections);
        }
        self.log = carried_on(&earlier.log, &self.log);
        self.receipts = carried_on(&earlier.receipts, &self.receipts);
        self.timeline = carried_on(&earlier.timeline, &self.timeline);
        self
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(milliseconds: u64) -> Stamp {
        Stamp::from_nanoseconds(milliseconds * 1_000_000)
    }

    fn grow(snapshot: &mut Snapshot, from: u64, to: u64) {
        snapshot.now = at(to);
        for moment in (from..to).step_by(10) {
            let sample = ForceSample { stamp: at(moment), ..ForceSample::default() };
            snapshot.sides.right.force.samples.push(sample);
        }
        let (id, stamp) = (from, at(from));
        let text = String::from("a line");
        snapshot.log.push(LogLine { id, stamp, level: super::super::Level::Information, source: text.clone(), text });
    }

    #[test]
    fn a_watcher_that_misses_some_parts_has_the_whole_series_all_the_same() {
        let mut node = Snapshot::default();
        let mut watcher: Option<Snapshot> = None;
        for part in 0..40_u64 {
            grow(&mut node, part * 100, (part + 1) * 100);
            // Two of three parts are lost on the way.
            if part % 3 == 0 || part == 39 {
                let part = node.shortened();
                watcher = Some(match &watcher {
                    Some(earlier) => part.carrying_on(earlier),
                    None => part,
                });
            }
        }
        let seen = watcher.unwrap();
        assert!(seen.sides.right.force.samples.iter().eq(node.sides.right.force.samples.iter()));
        assert!(seen.log.iter().eq(node.log.iter()));
        assert_eq!(seen.now, node.now);
    }

    #[test]
    fn a_part_is_small_however_long_the_trial_is() {
        let mut node = Snapshot::default();
        (0..600).for_each(|part| grow(&mut node, part * 100, (part + 1) * 100));
        let part = node.shortened();
        assert_eq!(part.sides.right.force.samples.len(), FORCE_SAMPLES);
        assert_eq!((part.log.len(), part.log.last()), (LINES, node.log.last()));
    }

    #[test]
    fn a_node_that_begins_anew_counts_its_lines_anew() {
        let mut before = Snapshot::default();
        grow(&mut before, 5_000, 5_100);
        let mut anew = Snapshot::default();
        grow(&mut anew, 6_000, 6_100);
        let line = LogLine { id: 0, ..anew.log.last().unwrap().clone() };
        anew.log = History::default();
        anew.log.push(line.clone());
        assert_eq!(anew.carrying_on(&before).log.last(), Some(&line));
    }
}
