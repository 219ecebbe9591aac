//! The record of a tortured trial: written as a session writes it, cut off as a crash does, read and replayed.
//!
//! Only some trials are recorded: each costs a file in the system's folder for temporary files, which is removed at once.

use super::invariant::Invariant;
use crate::record::{Header, JournalWriter, Replay, read};
use crate::supervisor::{Effect, Input, Setup};
use crate::time::Stamp;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use std::fs::{self, File};
use std::path::PathBuf;
use std::time::Duration;

/// Of so many trials one is recorded.
const RECORDED_EVERY: u64 = 50;
/// As often as the recorder of a session flushes.
const FLUSH: Duration = Duration::from_secs(1);
const CRASH_STREAM: u64 = 104;

/// A record under way.
#[derive(Debug)]
pub(super) struct Record {
    folder: PathBuf,
    writer: JournalWriter,
    flushed: Option<Stamp>,
    /// Steps and bytes at the last flush.
    safe: (u64, u64),
    steps: u64,
    random: ChaCha8Rng,
}

impl Record {
    /// A record where the seed's trial is one that is recorded.
    pub(super) fn begin(seed: u64, setup: &Setup) -> Result<Option<Self>, String> {
        if !seed.is_multiple_of(RECORDED_EVERY) {
            return Ok(None);
        }
        let folder = std::env::temp_dir().join(format!("valet-torture-{}-{seed}", std::process::id()));
        let header = Header::of(setup, "", 0)?;
        let writer = JournalWriter::create(&folder, &header).map_err(|error| error.to_string())?;
        let mut random = ChaCha8Rng::seed_from_u64(seed);
        random.set_stream(CRASH_STREAM);
        Ok(Some(Self { folder, writer, flushed: None, safe: (0, 0), steps: 0, random }))
    }

    pub(super) fn step(&mut self, now: Stamp, input: &Input, effects: &[Effect]) -> Result<(), String> {
        self.writer.step(now, input, effects, 0).map_err(|error| error.to_string())?;
        self.steps += 1;
        let due = self.flushed.is_none_or(|flushed| now.distance(flushed) >= FLUSH);
        if due {
            self.writer.flush().map_err(|error| error.to_string())?;
            self.flushed = Some(now);
            self.safe = (self.steps, length(self.writer.path())?);
        }
        Ok(())
    }

    /// Cuts the file anywhere after the last flush, as a crash may, and reads and replays what is left.
    pub(super) fn crash(mut self) -> Result<(), (Invariant, String)> {
        let folder = self.folder.clone();
        let judged = self.judge();
        // What cannot be removed is the system's to clean up.
        let _ = fs::remove_dir_all(folder);
        judged
    }

    fn judge(&mut self) -> Result<(), (Invariant, String)> {
        let lost = |reason: String| (Invariant::RecordSurvives, reason);
        let (steps, bytes) = self.safe;
        let path = self.writer.path().to_owned();
        let whole = length(&path).map_err(lost)?;
        let cut = self.random.random_range(bytes..=whole.max(bytes));
        File::options()
            .write(true)
            .open(&path)
            .and_then(|file| file.set_len(cut))
            .map_err(|error| lost(error.to_string()))?;
        let (mut replay, mut read_steps, mut differs) = (None, 0, None);
        read(&path, |header, step| {
            let replay = replay.get_or_insert_with(|| Replay::new(header, Ok));
            if step.number == read_steps {
                read_steps += 1;
            }
            if let Ok(replay) = replay {
                differs = differs.take().or(replay.step(&step).1);
            }
        })
        .map_err(|error| lost(error.to_string()))?;
        if read_steps < steps {
            return Err(lost(format!("{read_steps} of {steps} flushed steps can be read after a cut at byte {cut}")));
        }
        match (replay, differs) {
            (_, Some(difference)) => Err((Invariant::ReplayRepeats, format!("{difference:?}"))),
            (Some(Err(reason)), _) => Err((Invariant::ReplayRepeats, reason)),
            _ => Ok(()),
        }
    }
}

fn length(path: &std::path::Path) -> Result<u64, String> {
    fs::metadata(path).map(|metadata| metadata.len()).map_err(|error| error.to_string())
}
