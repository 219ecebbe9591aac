//! Records a trial beside the robot: a bounded queue that never blocks, a thread that writes, and what it has to say.

use super::entry::Header;
use super::error::JournalError;
use super::writer::JournalWriter;
use crate::config::RecordingSettings;
use crate::supervisor::{Effect, Input};
use crate::time::Stamp;
use crossbeam_channel::{Receiver, RecvTimeoutError, Sender, bounded};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

/// How the recorder does.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct RecorderStatus {
    /// The journal's file.
    pub path: PathBuf,
    /// False while the operator has switched it off.
    pub on: bool,
    /// Bytes in the file.
    pub bytes: u64,
    /// Steps that were lost because the queue was full.
    pub lost: u64,
    /// Bytes free on the disk; `None` where the system does not say.
    pub free_bytes: Option<u64>,
    /// Why it does not write any more; `None` while it does.
    pub failed: Option<String>,
}

/// What the recorder has to say by itself.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum RecorderNotice {
    /// It does not write any more.
    Failed {
        /// Why, and what to do.
        reason: String,
    },
    /// Its queue was full.
    Overflowed {
        /// Steps that were lost since the last notice.
        lost: u64,
    },
}

/// Where the recorder's notices go. Called from its own thread; must not block.
pub type Told = Box<dyn Fn(RecorderNotice) + Send>;

#[expect(clippy::large_enum_variant, reason = "nearly all items are steps")]
enum Item {
    Step { now: Stamp, input: Input, effects: Vec<Effect>, lost_before: u64 },
    Depth { stamp: Stamp, width: u32, height: u32, millimetres: Arc<[u16]> },
}

/// The longest time that something recorded waits in memory: with what a disk and a busy machine take, a second is not exceeded.
const FLUSH_EVERY: Duration = Duration::from_millis(800);

/// A recording that is under way. Dropping it ends the journal in order.
#[derive(Debug)]
pub struct Recorder {
    queue: Option<Sender<Item>>,
    thread: Option<JoinHandle<()>>,
    on: AtomicBool,
    lost: Arc<AtomicU64>,
    left_out: AtomicU64,
    status: Arc<Mutex<RecorderStatus>>,
}

impl Recorder {
    /// Begins a journal in a folder and the thread that writes it. `told` hears when the queue overflows and when it
    /// cannot write any more.
    ///
    /// # Errors
    /// [`JournalError`] where the file or the thread cannot be made.
    pub fn start(
        folder: &Path,
        header: &Header,
        settings: &RecordingSettings,
        told: Told,
    ) -> Result<Self, JournalError> {
        let writer = JournalWriter::create(folder, header)?;
        let path = writer.path().to_path_buf();
        let status = Arc::new(Mutex::new(RecorderStatus { path: path.clone(), ..RecorderStatus::default() }));
        let (queue, items) = bounded(settings.queue.max(1));
        let least_free = settings.least_free_megabytes << 20;
        let lost = Arc::new(AtomicU64::new(0));
        let writing = Writing { status: Arc::clone(&status), least_free, lost: Arc::clone(&lost), told };
        // A disk that is full already is told now, not after the first step.
        writing.look_at_the_disk(&writer)?;
        let thread = std::thread::Builder::new()
            .name("recorder".into())
            .spawn(move || writing.run(writer, &items))
            .map_err(|source| JournalError::file(&path, source))?;
        Ok(Self {
            queue: Some(queue),
            thread: Some(thread),
            on: AtomicBool::new(true),
            lost,
            left_out: AtomicU64::new(0),
            status,
        })
    }

    /// Records one step. Never blocks: where the queue is full the step is lost, counted, and the next one that fits tells
    /// of it.
    pub fn offer(&self, now: Stamp, input: &Input, effects: &[Effect]) {
        if !self.on.load(Ordering::Relaxed) {
            self.left_out.fetch_add(1, Ordering::Relaxed);
            return;
        }
        let lost_before = self.left_out.swap(0, Ordering::Relaxed);
        let item = Item::Step { now, input: input.clone(), effects: effects.to_vec(), lost_before };
        if !self.send(item) {
            self.lost.fetch_add(1, Ordering::Relaxed);
            self.left_out.fetch_add(lost_before + 1, Ordering::Relaxed);
        }
    }

    /// Switches recording off, and on again in the same journal: the steps between are missing, and the journal says so.
    pub fn set_on(&self, on: bool) {
        self.on.store(on, Ordering::Relaxed);
    }

    /// Records a depth image in millimetres, row by row. Never blocks: an image that does not fit is left out.
    pub fn offer_depth(&self, stamp: Stamp, width: u32, height: u32, millimetres: &Arc<[u16]>) {
        // An image is left out before it could push a step out of the queue.
        let half_empty = self.on.load(Ordering::Relaxed)
            && self.queue.as_ref().is_some_and(|queue| queue.len() * 2 <= queue.capacity().unwrap_or(0));
        if half_empty {
            self.send(Item::Depth { stamp, width, height, millimetres: Arc::clone(millimetres) });
        }
    }

    fn send(&self, item: Item) -> bool {
        self.queue.as_ref().is_some_and(|queue| queue.try_send(item).is_ok())
    }

    /// How the recorder does now.
    #[must_use]
    pub fn status(&self) -> RecorderStatus {
        let mut status = self.status.lock().unwrap_or_else(PoisonError::into_inner).clone();
        status.lost = self.lost.load(Ordering::Relaxed);
        status.on = self.on.load(Ordering::Relaxed) && status.failed.is_none();
        status
    }

    /// Ends the journal in order and returns its last status. Waits for the disk.
    #[must_use]
    pub fn finish(mut self) -> RecorderStatus {
        self.end();
        self.status()
    }

    fn end(&mut self) {
        self.queue = None;
        if let Some(thread) = self.thread.take() {
            // A thread that died has said why in the status, or could not.
            let _ = thread.join();
        }
    }
}

impl Drop for Recorder {
    fn drop(&mut self) {
        self.end();
    }
}

/// The writing thread's side.
struct Writing {
    status: Arc<Mutex<RecorderStatus>>,
    least_free: u64,
    lost: Arc<AtomicU64>,
    told: Told,
}

impl Writing {
    fn run(&self, mut writer: JournalWriter, items: &Receiver<Item>) {
        let ended = self.write(&mut writer, items).and_then(|()| writer.finish().map(drop));
        if let Err(error) = ended {
            let reason = error.to_string();
            self.note(|status| status.failed = Some(reason.clone()));
            (self.told)(RecorderNotice::Failed { reason });
        }
    }

    fn write(&self, writer: &mut JournalWriter, items: &Receiver<Item>) -> Result<(), JournalError> {
        let mut flushed = Instant::now();
        let mut known_lost = 0;
        loop {
            let matters = match items.recv_timeout(FLUSH_EVERY.saturating_sub(flushed.elapsed())) {
                Ok(Item::Step { now, input, effects, lost_before }) => {
                    writer.step(now, &input, &effects, lost_before)?;
                    let lost = self.lost.load(Ordering::Relaxed);
                    if lost > known_lost {
                        (self.told)(RecorderNotice::Overflowed { lost: lost - known_lost });
                        known_lost = lost;
                    }
                    effects.iter().any(matters)
                }
                Ok(Item::Depth { stamp, width, height, millimetres }) => {
                    writer.depth(stamp, width, height, &millimetres)?;
                    false
                }
                Err(RecvTimeoutError::Timeout) => false,
                Err(RecvTimeoutError::Disconnected) => return Ok(()),
            };
            if matters || flushed.elapsed() >= FLUSH_EVERY {
                writer.save()?;
                flushed = Instant::now();
                self.look_at_the_disk(writer)?;
            }
        }
    }

    fn look_at_the_disk(&self, writer: &JournalWriter) -> Result<(), JournalError> {
        let bytes = std::fs::metadata(writer.path()).map_or(0, |metadata| metadata.len());
        let free = free_bytes(writer.path());
        self.note(|status| {
            status.bytes = bytes;
            status.free_bytes = free;
        });
        match free.filter(|free| *free < self.least_free) {
            None => Ok(()),
            Some(free) => {
                let reason =
                    format!("only {} MB are free on the disk: make room and start recording again", free >> 20);
                Err(JournalError::container(writer.path(), reason))
            }
        }
    }

    fn note(&self, change: impl FnOnce(&mut RecorderStatus)) {
        change(&mut self.status.lock().unwrap_or_else(PoisonError::into_inner));
    }
}

/// Whether a decision is worth a flush at once: what explains a stop must be on the disk when the machine goes down next.
const fn matters(effect: &Effect) -> bool {
    matches!(effect, Effect::Stopped { .. } | Effect::Switch(_) | Effect::Iteration { .. } | Effect::TrialEnded { .. })
}

fn free_bytes(path: &Path) -> Option<u64> {
    let disk = rustix::fs::statvfs(path).ok()?;
    Some(disk.f_bavail.saturating_mul(disk.f_frsize))
}
