//! A console to practise at: a made-up trial that answers every key and is connected to nothing.

use super::fixture::{Moment, fixture_at};
use super::{CommandSink, Situation, SnapshotSource, StopHandle};
use crate::command::{Command, CommandReceipt, Origin};
use crate::snapshot::{History, ReceiptLine, Snapshot, StopView, TrialPhase, Watermark};
use crate::time::Stamp;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant, SystemTime, UNIX_EPOCH};

/// How long the made-up robot takes to confirm a stop: about what a real one takes.
const CONFIRMATION: Duration = Duration::from_millis(12);

/// What has been practised so far.
#[derive(Debug)]
struct State {
    phase: TrialPhase,
    enabled: bool,
    stopped_at: Option<Stamp>,
    is_reset: bool,
    receipts: History<ReceiptLine>,
}

/// The made-up trial. Its clones are the three wires of a console: snapshots, commands and the stop.
#[derive(Clone, Debug)]
pub struct Practice {
    started: Instant,
    epoch: Stamp,
    latch: Arc<AtomicBool>,
    state: Arc<Mutex<State>>,
}

impl Default for Practice {
    fn default() -> Self {
        Self::new()
    }
}

impl Practice {
    /// A trial under way.
    #[must_use]
    pub fn new() -> Self {
        let epoch = SystemTime::now().duration_since(UNIX_EPOCH).unwrap_or_default();
        let receipts = History::new(100);
        let state = State { phase: TrialPhase::Dressing, enabled: true, stopped_at: None, is_reset: false, receipts };
        Self {
            started: Instant::now(),
            epoch: Stamp::ZERO + epoch,
            latch: Arc::new(AtomicBool::new(false)),
            state: Arc::new(Mutex::new(state)),
        }
    }

    fn now(&self) -> Stamp {
        self.epoch + self.started.elapsed()
    }

    fn snapshot(&self) -> Snapshot {
        let now = self.now();
        let mut state = self.state.lock().unwrap_or_else(PoisonError::into_inner);
        if self.latch.load(Ordering::SeqCst) && (state.stopped_at.is_none() || state.is_reset) {
            state.is_reset = false;
            (state.stopped_at, state.enabled, state.phase) = (Some(now), false, TrialPhase::Stopped);
        }
        let mut snapshot = fixture_at(Situation::Live, Moment(now));
        snapshot.watermark = Watermark::DryRun;
        snapshot.trial.phase = state.phase;
        snapshot.receipts = state.receipts.clone();
        if let Some(robot) = &mut snapshot.robot.state {
            (robot.enabled, robot.stopped) = (state.enabled, state.stopped_at.is_some() && !state.is_reset);
        }
        if let Some(at) = state.stopped_at {
            let confirmed = at + CONFIRMATION;
            snapshot.stop = StopView {
                latched: true,
                requested_at: Some(at),
                sent_at: Some(at),
                confirmed_at: (now >= confirmed).then_some(confirmed),
                is_reset: state.is_reset,
                cause: "practice".into(),
            };
        }
        snapshot
    }

    fn carry_out(&self, command: &Command) {
        let stamp = self.now();
        let mut state = self.state.lock().unwrap_or_else(PoisonError::into_inner);
        let next = match command {
            Command::Hold => Some(TrialPhase::Holding),
            // After a stop the trial holds first, as with a robot.
            Command::Start if state.stopped_at.is_some() => Some(TrialPhase::Holding),
            Command::Continue | Command::Start | Command::GoAhead => Some(TrialPhase::Dressing),
            Command::Withdraw => Some(TrialPhase::Withdrawing),
            Command::Abort => Some(TrialPhase::Ended),
            _ => None,
        };
        state.phase = next.unwrap_or(state.phase);
        match command {
            Command::Reset => {
                self.latch.store(false, Ordering::SeqCst);
                state.is_reset = true;
            }
            Command::Start => (state.stopped_at, state.is_reset) = (None, false),
            Command::Enable => state.enabled = true,
            Command::Disable => state.enabled = false,
            _ => {}
        }
        let receipt = CommandReceipt::accepted(command.clone(), "practice: nothing is connected");
        state.receipts.push(ReceiptLine { stamp, origin: Origin::OperatorKey, receipt });
    }
}

impl SnapshotSource for Practice {
    fn newest(&mut self) -> Option<Snapshot> {
        Some(self.snapshot())
    }
}

impl CommandSink for Practice {
    fn send(&mut self, command: Command) -> Result<(), String> {
        self.carry_out(&command);
        Ok(())
    }
}

impl StopHandle for Practice {
    fn stop(&self) {
        self.latch.store(true, Ordering::SeqCst);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::snapshot::StopPhase;

    #[test]
    fn a_stop_is_left_by_reset_enable_and_start_alone() {
        let mut practice = Practice::new();
        practice.stop();
        let stopped = practice.newest().unwrap();
        assert_ne!(stopped.stop.phase(stopped.now), StopPhase::Clear);
        practice.send(Command::Reset).unwrap();
        let reset = practice.newest().unwrap();
        assert_eq!(reset.stop.phase(reset.now), StopPhase::Reset);
        assert!(!reset.robot.state.unwrap().enabled && !reset.trial.phase.moves());
        practice.send(Command::Enable).unwrap();
        assert!(!practice.newest().unwrap().trial.phase.moves());
        practice.send(Command::Start).unwrap();
        let started = practice.newest().unwrap();
        assert!(started.stop.phase(started.now) == StopPhase::Clear && !started.trial.phase.moves());
        practice.send(Command::Continue).unwrap();
        assert!(practice.newest().unwrap().trial.phase.moves());
    }
}
