//! Plays a recorded trial: a position in it that goes on, pauses, steps and seeks, and the core as it was there.
//!
//! Has no clock: whoever shows it says how much time has passed and how much work may be done at once.

use super::entry::{Header, Step};
use super::error::JournalError;
use super::file::JournalFile;
use super::replay::{Difference, Replay};
use super::{Reading, read};
use crate::snapshot::{Level, LogLine, RecorderView, ReplayView, Snapshot};
use crate::supervisor::{Effect, Setup};
use crate::time::Stamp;
use std::path::{Path, PathBuf};
use std::time::Duration;

/// How a setup is changed before it is replayed (`--what-if`).
pub type Change = Box<dyn Fn(Setup) -> Result<Setup, String>>;

/// The slowest and the fastest pace.
const SPEEDS: (f64, f64) = (1.0 / 16.0, 64.0);
/// Differences that are shown in the log; the rest is counted.
const DIFFERENCES_SHOWN: usize = 100;
/// Numbers of log lines that tell of differences begin here: far above those of any trial.
const FIRST_NUMBER: u64 = 1 << 40;

/// A recorded trial that is being played.
pub struct Player {
    path: PathBuf,
    reading: Reading,
    steps: Vec<Step>,
    change: Change,
    replay: Replay,
    next: usize,
    /// Where the play stands, in time since the first step.
    position: Duration,
    speed: f64,
    paused: bool,
    differences: Vec<LogLine>,
    differing: u64,
}

impl std::fmt::Debug for Player {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let mut shown = formatter.debug_struct("Player");
        shown
            .field("path", &self.path)
            .field("next", &self.next)
            .field("position", &self.position)
            .finish_non_exhaustive()
    }
}

impl Player {
    /// Reads a journal whole and stands at its beginning, playing at the trial's own pace.
    ///
    /// # Errors
    /// [`JournalError`] where the journal cannot be read, holds no step, or its settings are not usable.
    pub fn open(journal: impl Into<JournalFile>, change: Change) -> Result<Self, JournalError> {
        let journal = journal.into();
        let path = journal.path();
        let mut steps = Vec::new();
        let reading = read(&journal, |_, step| steps.push(step))?;
        if steps.is_empty() {
            return Err(JournalError::foreign(path, "it holds no step that can be read"));
        }
        let replay = begin(path, &reading.header, &change)?;
        Ok(Self {
            path: path.to_path_buf(),
            reading,
            steps,
            change,
            replay,
            next: 0,
            position: Duration::ZERO,
            speed: 1.0,
            paused: false,
            differences: Vec::new(),
            differing: 0,
        })
    }

    /// How the journal was read.
    #[must_use]
    pub const fn reading(&self) -> &Reading {
        &self.reading
    }

    /// Steps so far that are decided otherwise than they were recorded.
    #[must_use]
    pub const fn differing(&self) -> u64 {
        self.differing
    }

    /// How long the trial is.
    #[must_use]
    pub fn length(&self) -> Duration {
        self.steps.last().map_or(Duration::ZERO, |last| last.now.since(self.began()))
    }

    fn began(&self) -> Stamp {
        self.steps.first().map_or(Stamp::ZERO, |first| first.now)
    }

    /// Lets time pass; nothing where it is paused. Stands still at the end.
    pub fn pass(&mut self, elapsed: Duration) {
        if self.paused {
            return;
        }
        self.position = (self.position + elapsed.mul_f64(self.speed)).min(self.length());
        self.paused = self.position == self.length();
    }

    /// Pauses, or goes on; at the end it begins anew.
    ///
    /// # Errors
    /// As [`Player::seek`].
    pub fn pause_or_go_on(&mut self) -> Result<(), JournalError> {
        self.paused = !self.paused;
        if !self.paused && self.position == self.length() {
            self.position = Duration::ZERO;
            self.rewind()?;
        }
        Ok(())
    }

    /// Multiplies the pace, within limits.
    pub fn change_speed(&mut self, factor: f64) {
        let (slowest, fastest) = SPEEDS;
        let speed = self.speed * factor;
        if speed.is_finite() {
            self.speed = speed.clamp(slowest, fastest);
        }
    }

    /// Goes to the next decision that is more than a position of the arms, and pauses there.
    pub fn step(&mut self) {
        self.paused = true;
        let rest = self.steps.get(self.next..).unwrap_or_default();
        let found = rest.iter().find(|step| step.effects.iter().any(is_told));
        let began = self.began();
        self.position = found.map_or_else(|| self.length(), |step| step.now.since(began));
    }

    /// Moves by so many seconds, back or on, within the trial.
    ///
    /// # Errors
    /// [`JournalError`] where the core cannot be begun anew.
    pub fn seek(&mut self, seconds: f64) -> Result<(), JournalError> {
        let target = (self.position.as_secs_f64() + seconds).clamp(0.0, self.length().as_secs_f64());
        self.position = Duration::try_from_secs_f64(target).unwrap_or_default();
        // The core only goes forwards: what lies behind is reached from the beginning.
        if seconds < 0.0 { self.rewind() } else { Ok(()) }
    }

    fn rewind(&mut self) -> Result<(), JournalError> {
        self.replay = begin(&self.path, &self.reading.header, &self.change)?;
        self.next = 0;
        self.differences.clear();
        self.differing = 0;
        Ok(())
    }

    /// Feeds the core up to the position, at most `most` steps at once. True where it has arrived there.
    pub fn catch_up(&mut self, most: usize) -> bool {
        let until = self.began() + self.position;
        for _ in 0..most {
            let Some(step) = self.steps.get(self.next).filter(|step| step.now <= until) else { return true };
            let (_, difference) = self.replay.step(step);
            self.next += 1;
            if let Some(difference) = difference {
                self.note(&difference);
            }
        }
        false
    }

    fn note(&mut self, difference: &Difference) {
        self.differing += 1;
        if self.differences.len() < DIFFERENCES_SHOWN {
            let Difference { step, recorded, decided, .. } = difference;
            self.differences.push(LogLine {
                id: FIRST_NUMBER + self.differing,
                stamp: Stamp::from_nanoseconds(difference.nanoseconds),
                level: Level::Warning,
                source: "replay".into(),
                text: format!("step {step}: recorded {recorded}; now {decided}"),
            });
        }
    }

    /// What was to be seen at the position, with where the replay stands and every difference so far in the log.
    #[must_use]
    pub fn snapshot(&self) -> Snapshot {
        let mut snapshot = self.replay.supervisor().snapshot(self.began() + self.position);
        self.differences.iter().for_each(|line| snapshot.log.push(line.clone()));
        snapshot.recorder = RecorderView { file: self.path.display().to_string(), ..RecorderView::default() };
        snapshot.replay = Some(ReplayView {
            position: self.position.as_secs_f64(),
            length: self.length().as_secs_f64(),
            speed: self.speed,
            paused: self.paused,
        });
        snapshot
    }
}

fn begin(path: &Path, header: &Header, change: &Change) -> Result<Replay, JournalError> {
    let unusable = |reason| JournalError::foreign(path, format!("its settings are not usable: {reason}"));
    Replay::new(header, change).map_err(unusable)
}

/// Whether a decision is one that people are told of.
const fn is_told(effect: &Effect) -> bool {
    !matches!(effect, Effect::Setpoint { .. } | Effect::Release { .. })
}

#[cfg(test)]
mod tests;
