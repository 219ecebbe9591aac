//! `valet console --watch`: another node's trial on this screen, with the stop and nothing else.

use super::console::conclude;
use super::exit::Failure;
use super::sim::ros_failure;
use crate::command::Command;
use crate::console::ConsoleOptions;
use crate::engine::stop::{StopLatch, StopThread};
use crate::ros::{Node, WatchLink, leave};
use crate::snapshot::{Level, LogLine, Snapshot, StopView, Watermark};
use crate::time::Stamp;
use std::sync::Arc;
use std::time::{Duration, SystemTime, UNIX_EPOCH};

/// A node that has been silent for longer tells nothing of a stop any more: the robot itself is asked.
const SILENCE: Duration = Duration::from_secs(1);

pub(super) fn run(watched: &str, options: &ConsoleOptions) -> Result<(), Failure> {
    let name = format!("valet_watch_{}", std::process::id());
    let node = Node::start(&name).map_err(ros_failure)?;
    let link = Arc::new(WatchLink::connect(watched).map_err(ros_failure)?);
    let stop = StopThread::start(link.stopper()).map_err(Failure::fault)?;
    let latch = stop.latch();
    let mut watcher = Watcher::new(watched, Arc::clone(&link), latch.clone());
    let handle: Arc<dyn crate::console::StopHandle> = Arc::new(move || latch.stop());
    // The stop has gone to the latch already; nothing else can be asked from here.
    let deaf = |_: Command| Ok(());
    let reason = crate::console::run(move || watcher.look(), deaf, &handle, None, options);
    drop(stop);
    leave((link, node));
    conclude(reason.map_err(Failure::configuration), None)
}

/// Turns what the watched node shows into what this screen shows.
struct Watcher {
    watched: String,
    link: Arc<WatchLink>,
    latch: StopLatch,
    last: Option<Snapshot>,
    own: OwnStop,
    told_of_waiting: bool,
}

/// A stop that was asked for here.
#[derive(Clone, Debug, Default, PartialEq)]
struct OwnStop {
    view: StopView,
    /// True once the watched node has latched it too.
    taken_over: bool,
}

/// What is known of the stop at one look.
struct StopFacts {
    now: Stamp,
    latched_here: bool,
    /// What the node says; `None` where it is silent.
    node_latched: Option<bool>,
    robot_stopped: bool,
}

impl OwnStop {
    /// Follows the stop from the key to the node and back; true where the latch here is to be cleared, because the stop was
    /// reset at the node.
    fn follow(&mut self, facts: &StopFacts) -> bool {
        if !facts.latched_here {
            *self = Self::default();
            return false;
        }
        if !self.view.latched {
            let cause = "a console that watches".to_owned();
            let at = Some(facts.now);
            self.view = StopView { latched: true, requested_at: at, sent_at: at, cause, ..StopView::default() };
        }
        if facts.robot_stopped && self.view.confirmed_at.is_none() {
            self.view.confirmed_at = Some(facts.now);
        }
        let was_taken_over = self.taken_over;
        self.taken_over |= facts.node_latched == Some(true);
        was_taken_over && facts.node_latched == Some(false)
    }
}

impl Watcher {
    fn new(watched: &str, link: Arc<WatchLink>, latch: StopLatch) -> Self {
        let (watched, own) = (watched.to_owned(), OwnStop::default());
        Self { watched, link, latch, last: None, own, told_of_waiting: false }
    }

    /// What there is to show now; nothing where the node has said nothing new and no stop is under way here.
    fn look(&mut self) -> Option<Snapshot> {
        let fresh = self.link.newest();
        let silent = self.link.silence().is_none_or(|silence| silence > SILENCE);
        let facts = self.stop_facts(fresh.as_ref(), silent);
        if self.own.follow(&facts) {
            self.latch.clear();
            self.own = OwnStop::default();
        }
        if self.own.view.confirmed_at.is_some() {
            self.latch.confirm();
        }
        if let Some(fresh) = fresh {
            self.last = Some(fresh);
        } else if !self.own.view.latched {
            return self.waiting();
        }
        let mut shown = self.last.clone().unwrap_or_default();
        shown.watermark = Watermark::Watch;
        if silent && self.own.view.latched {
            // The node's word is old: what the robot itself says is all there is.
            shown.now = facts.now;
            shown.robot.state = self.link.robot();
            shown.robot.deadline_seconds = SILENCE.as_secs_f64();
        }
        if self.own.view.latched && (silent || !shown.stop.latched) {
            shown.stop = self.own.view.clone();
        }
        Some(shown)
    }

    fn stop_facts(&self, fresh: Option<&Snapshot>, silent: bool) -> StopFacts {
        let newest = fresh.or(self.last.as_ref());
        let node_latched = newest.filter(|_| !silent).map(|snapshot| snapshot.stop.latched);
        // The node's clock, as long as it speaks: moments of two computers are not compared.
        let own_clock = Stamp::ZERO + SystemTime::now().duration_since(UNIX_EPOCH).unwrap_or_default();
        let now = newest.filter(|_| !silent).map_or(own_clock, |snapshot| snapshot.now);
        let heard = |stamp: Stamp| own_clock.since(stamp) <= SILENCE;
        let robot_stopped = self.link.robot().is_some_and(|robot| robot.stopped && heard(robot.stamp));
        StopFacts { now, latched_here: self.latch.is_stopped(), node_latched, robot_stopped }
    }

    /// What is shown until the node is heard for the first time, once.
    fn waiting(&mut self) -> Option<Snapshot> {
        if self.last.is_some() || (self.told_of_waiting && self.link.unreadable() == 0) {
            return None;
        }
        self.told_of_waiting = true;
        let text = if self.link.unreadable() > 0 {
            format!("{} is a valet of another version: its snapshots cannot be read; the stop works", self.watched)
        } else {
            format!("waiting for {}: is `valet console` running on this master? The stop works already", self.watched)
        };
        let mut empty = Snapshot { watermark: Watermark::Watch, ..Snapshot::default() };
        empty.trial.waiting_for.clone_from(&text);
        empty.log.push(LogLine { id: 0, stamp: Stamp::ZERO, level: Level::Warning, source: "watch".into(), text });
        Some(empty)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn facts(seconds: u64, node_latched: Option<bool>, robot_stopped: bool) -> StopFacts {
        let now = Stamp::from_nanoseconds(seconds * 1_000_000_000);
        StopFacts { now, latched_here: true, node_latched, robot_stopped }
    }

    #[test]
    fn a_stop_asked_for_here_is_shown_until_the_node_has_reset_it() {
        let mut own = OwnStop::default();
        assert!(!own.follow(&facts(1, Some(false), false)), "the node has not heard of it yet");
        assert!(own.view.latched && own.view.confirmed_at.is_none());
        assert!(!own.follow(&facts(2, Some(true), true)));
        assert_eq!(own.view.confirmed_at, Some(Stamp::from_nanoseconds(2_000_000_000)));
        assert!(!own.follow(&facts(3, None, true)), "a silent node has reset nothing");
        assert!(own.follow(&facts(4, Some(false), false)), "reset at the node");
    }

    #[test]
    fn without_a_node_the_robot_alone_confirms() {
        let mut own = OwnStop::default();
        assert!(!own.follow(&facts(1, None, false)));
        assert!(own.view.latched && own.view.confirmed_at.is_none());
        assert!(!own.follow(&facts(2, None, true)));
        assert!(own.view.confirmed_at.is_some() && !own.taken_over);
    }

    #[test]
    fn without_a_stop_here_nothing_is_shown_of_one() {
        let mut own = OwnStop::default();
        let idle = StopFacts { latched_here: false, ..facts(1, Some(true), true) };
        assert!(!own.follow(&idle));
        assert_eq!(own, OwnStop::default());
    }
}
