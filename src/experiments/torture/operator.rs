//! An operator who mostly does what is sensible, takes time to do it, and now and then does anything at all.

use super::origin;
use crate::body::Side;
use crate::command::{Command, Origin};
use crate::snapshot::{Snapshot, TrialPhase};
use crate::strategy::StrategyKind;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

const OPERATOR_STREAM: u64 = 103;

/// The operator of one trial.
#[derive(Debug)]
pub(super) struct ErringOperator {
    random: ChaCha8Rng,
    errs: f64,
    looks_to_wait: u32,
}

impl ErringOperator {
    pub(super) fn new(seed: u64, errs: f64) -> Self {
        let mut random = ChaCha8Rng::seed_from_u64(seed);
        random.set_stream(OPERATOR_STREAM);
        Self { random, errs, looks_to_wait: 2 }
    }

    /// What is asked on seeing this, if anything, and by whom.
    pub(super) fn act(&mut self, seen: &Snapshot) -> Option<(Command, Origin)> {
        if self.errs > 0.0 && self.random.random_bool(self.errs) {
            let from_service = self.random.random_bool(0.2);
            return Some((self.anything(), origin(from_service)));
        }
        self.looks_to_wait = self.looks_to_wait.saturating_sub(1);
        if self.looks_to_wait > 0 {
            return None;
        }
        let command = self.sensible(seen)?;
        self.looks_to_wait = self.random.random_range(1..8);
        Some((command, origin(false)))
    }

    /// The next sensible thing: out of a stop by reset, enable, start; out of a hold by one of three ways.
    fn sensible(&mut self, seen: &Snapshot) -> Option<Command> {
        let robot = seen.robot.state?;
        if robot.stopped || robot.error || (seen.stop.latched && !robot.enabled && self.random.random_bool(0.5)) {
            return Some(Command::Reset);
        }
        if !robot.enabled {
            return Some(Command::Enable);
        }
        if seen.stop.latched {
            let acts = [Command::Reset, Command::Enable, Command::Start];
            return acts.get(self.random.random_range(0..acts.len())).cloned();
        }
        match seen.trial.phase {
            TrialPhase::Idle | TrialPhase::Stopped => Some(Command::Start),
            TrialPhase::Waiting => Some(Command::GoAhead),
            TrialPhase::Holding => Some(match self.random.random_range(0..10) {
                0..=6 => Command::Continue,
                7..=8 => Command::Withdraw,
                _ => Command::Abort,
            }),
            _ => None,
        }
    }

    fn anything(&mut self) -> Command {
        let side = if self.random.random_bool(0.5) { Side::Left } else { Side::Right };
        let value = [f64::NAN, -1.0, 0.0, 5.0, 12.0, 1e9].get(self.random.random_range(0..6)).copied().unwrap_or(5.0);
        let key = ["window.threshold_newtons", "motion.speed", "no.such.setting", ""];
        let key = key.get(self.random.random_range(0..4)).copied().unwrap_or_default().to_owned();
        match self.random.random_range(0..20) {
            0 => Command::Stop,
            1 => Command::Hold,
            2 => Command::Continue,
            3 => Command::Abort,
            4 => Command::Withdraw,
            5 => Command::GoAhead,
            6 => Command::FinishAfterThis,
            7 => Command::NextIteration,
            8 => Command::NextStep,
            9 => Command::PreviousStep,
            10 => Command::Reset,
            11 => Command::Enable,
            12 => Command::Disable,
            13 => Command::Start,
            14 => Command::SelectStrategy(if side == Side::Left { StrategyKind::Gmm } else { StrategyKind::Force }),
            15 => Command::SetSetting { key, value },
            16 => Command::UndoSetting { key },
            17 => Command::Tare(side),
            18 => Command::SelectFirstArm(side),
            _ => Command::Note("\u{1b}[2J\0".into()),
        }
    }
}
