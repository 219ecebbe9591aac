//! Reads a journal on a thread of its own, ahead of whoever runs it through the core: unpacking and deciding take about the
//! same time. Shows the same steps in the same order as [`read`].

use super::entry::{Header, Step};
use super::error::JournalError;
use super::file::JournalFile;
use super::{Reading, read};
use crossbeam_channel::{Sender, bounded};
use std::thread;

/// Steps that are handed over at once: about a second of a trial.
const BATCH: usize = 512;
/// Batches that may wait: the reader runs ahead no further, however long the journal is.
const WAITING: usize = 8;

/// What the reader hands over.
enum Piece {
    Header(Box<Header>),
    Steps(Vec<Step>),
}

/// Steps on their way.
struct Reader {
    pieces: Sender<Piece>,
    has_begun: bool,
    batch: Vec<Step>,
}

impl Reader {
    fn take(&mut self, header: &Header, step: Step) {
        if !self.has_begun {
            self.has_begun = true;
            self.hand_over(Piece::Header(Box::new(header.clone())));
        }
        self.batch.push(step);
        if self.batch.len() >= BATCH {
            self.flush();
        }
    }

    fn flush(&mut self) {
        let steps = std::mem::replace(&mut self.batch, Vec::with_capacity(BATCH));
        self.hand_over(Piece::Steps(steps));
    }

    fn hand_over(&self, piece: Piece) {
        // Where nobody takes it any more, whoever ran the journal has panicked.
        let _ = self.pieces.send(piece);
    }
}

/// Reads a journal and shows each step to `visit`, in order.
///
/// # Errors
/// As [`read`].
pub(super) fn read_ahead(journal: &JournalFile, mut visit: impl FnMut(&Header, Step)) -> Result<Reading, JournalError> {
    let (pieces, waiting) = bounded(WAITING);
    thread::scope(|scope| {
        let reader = scope.spawn(move || {
            let mut reader = Reader { pieces, has_begun: false, batch: Vec::with_capacity(BATCH) };
            let reading = read(journal, |header, step| reader.take(header, step));
            reader.flush();
            reading
        });
        let mut header = Box::default();
        for piece in waiting {
            match piece {
                Piece::Header(known) => header = known,
                Piece::Steps(steps) => steps.into_iter().for_each(|step| visit(&header, step)),
            }
        }
        reader.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic))
    })
}
