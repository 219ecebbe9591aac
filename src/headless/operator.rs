//! The operator of a run without a screen: resets, enables, starts, and gives each go-ahead, one act at a time.
//!
//! It asks for nothing that an operator could not ask for, and waits for the answer to each act before the next one.

use crate::assembly::RobotState;
use crate::command::{Command, CommandReceipt};
use crate::snapshot::{RunKeyView, Snapshot, TrialPhase};
use crate::time::Stamp;
use std::time::Duration;

/// Time between two acts: what a person needs to read what has changed.
const PAUSE: Duration = Duration::from_millis(500);

/// After so many refusals to start, one each half second, waiting longer will not help.
const MOST_REFUSALS: u32 = 40;

/// A script in place of a person.
#[derive(Clone, Debug)]
pub struct ScriptedOperator {
    last_act: Option<Stamp>,
    continues_left: u32,
    started: bool,
    refusals: u32,
    gave_up: Option<String>,
}

impl ScriptedOperator {
    /// An operator that goes on after at most `continues` holds, and then gives the trial up.
    #[must_use]
    pub const fn new(continues: u32) -> Self {
        Self { last_act: None, continues_left: continues, started: false, refusals: 0, gave_up: None }
    }

    /// What the operator does on seeing this, if anything. Where hold to run is chosen, the key is held whenever nothing else
    /// is done.
    pub fn act(&mut self, seen: &Snapshot) -> Option<Command> {
        let has_paused = self.last_act.is_none_or(|last| seen.now.since(last) >= PAUSE);
        let command = if has_paused { self.choose(seen) } else { None };
        if command.is_some() {
            self.last_act = Some(seen.now);
        }
        command.or_else(|| holds_key(seen).then_some(Command::Run))
    }

    /// Why the trial could not be started, once there is no point in asking again.
    #[must_use]
    pub fn gave_up(&self) -> Option<&str> {
        self.gave_up.as_deref()
    }

    fn choose(&mut self, seen: &Snapshot) -> Option<Command> {
        if seen.stop.latched {
            // Whoever stopped had a reason: a script does not go on after a stop.
            return None;
        }
        match seen.trial.phase {
            TrialPhase::Idle => self.prepare(seen),
            TrialPhase::Waiting => Some(Command::GoAhead),
            TrialPhase::Holding if seen.trial.run_key == RunKeyView::Awaited => None,
            TrialPhase::Holding => Some(self.after_hold()),
            _ => None,
        }
    }

    fn prepare(&mut self, seen: &Snapshot) -> Option<Command> {
        let robot: &RobotState = seen.robot.fresh(seen.now)?;
        if robot.stopped || robot.error {
            return Some(Command::Reset);
        }
        if !robot.enabled {
            return Some(Command::Enable);
        }
        let answer = seen.newest_receipt().filter(|receipt| receipt.command == Command::Start);
        if self.started && answer.is_some_and(CommandReceipt::is_accepted) {
            return None;
        }
        if let Some(reason) = answer.and_then(CommandReceipt::refusal) {
            self.refusals += 1;
            if self.refusals >= MOST_REFUSALS {
                self.gave_up = Some(format!("the trial cannot start: {reason}"));
                return None;
            }
        }
        seen.body.pose?;
        self.started = true;
        Some(Command::Start)
    }

    const fn after_hold(&mut self) -> Command {
        if self.continues_left == 0 {
            return Command::Abort;
        }
        self.continues_left -= 1;
        Command::Continue
    }
}

fn holds_key(seen: &Snapshot) -> bool {
    match seen.trial.run_key {
        RunKeyView::NotNeeded => false,
        RunKeyView::Needed => seen.trial.phase.moves(),
        RunKeyView::Awaited => !seen.stop.latched,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::body::BodyPose;
    use crate::command::Origin;
    use crate::snapshot::{ReceiptLine, RobotView};

    fn at(milliseconds: u64, phase: TrialPhase, enabled: bool) -> Snapshot {
        let now = Stamp::from_nanoseconds(milliseconds * 1_000_000);
        let mut seen = Snapshot { now, ..Snapshot::default() };
        seen.trial.phase = phase;
        seen.robot = RobotView {
            state: Some(RobotState { stamp: now, enabled, ..RobotState::default() }),
            deadline_seconds: 0.1,
        };
        seen.body.pose = Some(BodyPose::default());
        seen
    }

    #[test]
    fn enable_and_start_are_two_acts_with_a_pause_between() {
        let mut operator = ScriptedOperator::new(0);
        assert_eq!(operator.act(&at(1000, TrialPhase::Idle, false)), Some(Command::Enable));
        assert_eq!(operator.act(&at(1010, TrialPhase::Idle, true)), None);
        assert_eq!(operator.act(&at(1600, TrialPhase::Idle, true)), Some(Command::Start));
    }

    #[test]
    fn without_a_fresh_robot_nothing_is_asked() {
        let mut seen = at(1000, TrialPhase::Idle, true);
        seen.now = Stamp::from_nanoseconds(2_000_000_000);
        assert_eq!(ScriptedOperator::new(0).act(&seen), None);
    }

    #[test]
    fn holds_are_continued_a_limited_number_of_times() {
        let mut operator = ScriptedOperator::new(1);
        assert_eq!(operator.act(&at(1000, TrialPhase::Holding, true)), Some(Command::Continue));
        assert_eq!(operator.act(&at(2000, TrialPhase::Holding, true)), Some(Command::Abort));
    }

    #[test]
    fn the_key_of_hold_to_run_is_held_whenever_nothing_else_is_done_and_not_after_a_stop() {
        let mut operator = ScriptedOperator::new(0);
        let mut seen = at(1000, TrialPhase::Waiting, true);
        seen.trial.run_key = RunKeyView::Needed;
        assert_eq!(operator.act(&seen), Some(Command::GoAhead));
        assert_eq!(operator.act(&seen), None, "while it waits there is nothing to hold the key for");
        seen.trial.phase = TrialPhase::Dressing;
        assert_eq!(operator.act(&seen), Some(Command::Run));
        (seen.trial.phase, seen.trial.run_key) = (TrialPhase::Holding, RunKeyView::Awaited);
        seen.now = Stamp::from_nanoseconds(9_000_000_000);
        assert_eq!(operator.act(&seen), Some(Command::Run), "and no hold is counted");
        (seen.trial.phase, seen.stop.latched) = (TrialPhase::Stopped, true);
        assert_eq!(operator.act(&seen), None);
    }

    #[test]
    fn a_script_does_not_go_on_after_a_stop() {
        let mut seen = at(1000, TrialPhase::Stopped, false);
        seen.stop.latched = true;
        assert_eq!(ScriptedOperator::new(9).act(&seen), None);
    }

    #[test]
    fn waiting_is_answered_with_a_go_ahead() {
        assert_eq!(ScriptedOperator::new(0).act(&at(1000, TrialPhase::Waiting, true)), Some(Command::GoAhead));
    }

    #[test]
    fn a_start_that_is_refused_again_and_again_is_given_up_with_the_reason() {
        let mut operator = ScriptedOperator::new(0);
        for ask in 0..100_u64 {
            let mut seen = at(1000 + ask * 1000, TrialPhase::Idle, true);
            let receipt = CommandReceipt::refused(Command::Start, "no movement space");
            seen.receipts.push(ReceiptLine { stamp: seen.now, origin: Origin::Headless, receipt });
            let act = operator.act(&seen);
            assert_eq!(act.is_none(), operator.gave_up().is_some());
        }
        assert!(operator.gave_up().is_some_and(|reason| reason.contains("no movement space")));
    }
}
