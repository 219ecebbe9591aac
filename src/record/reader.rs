//! Reads a journal step by step, damaged ones included: what is intact is read, what is not is named with its offset.

use super::channels::{EFFECT, INPUT};
use super::chunk;
use super::entry::{Header, OwnedEffectEntry, OwnedInputEntry, Step};
use super::error::{JournalError, Problem};
use super::file::{Contents, JournalFile};
use super::foreign_bag;
use super::writer::{FORMAT, METADATA};
use mcap::records::{Metadata, Record};
use std::collections::HashMap;
use std::fs::File;
use std::io::{BufReader, Cursor, Read};
use std::path::Path;

/// What was read of a journal.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Reading {
    /// What the trial was run with.
    pub header: Header,
    /// How many steps were read.
    pub steps: u64,
    /// Steps that the recorder had to leave out because its queue was full.
    pub lost: u64,
    /// What could not be read.
    pub problems: Vec<Problem>,
    /// True where the journal was ended in order; false after a crash.
    pub finished: bool,
    /// Where the chunk begins that was being written when the recorder was killed, in bytes: up to a second is lost there.
    pub open_chunk: Option<u64>,
}

/// The first and last bytes of every MCAP file.
const MAGIC: &[u8] = b"\x89MCAP0\r\n";
/// Opcode and length before each record.
const RECORD_HEAD: usize = 9;
/// The longest record before the first chunk, in bytes: a profile with its movement space is far below it.
const LONGEST_HEADER: u64 = 64 << 20;
/// The opcode of a chunk.
const CHUNK: u8 = 0x06;

/// Reads a journal and shows each step to `visit`, in order.
///
/// # Errors
/// [`JournalError`] where nothing can be read: no file, no journal of valet, or a later format. Damage inside is no error:
/// it is listed in [`Reading::problems`].
pub fn read(journal: impl Into<JournalFile>, mut visit: impl FnMut(&Header, Step)) -> Result<Reading, JournalError> {
    let journal = journal.into();
    let path = journal.path();
    let Contents { bytes, damage } = journal.contents()?;
    if !bytes.starts_with(MAGIC) {
        return Err(match damage {
            Some(reason) => JournalError::foreign(path, format!("it is cut or damaged at its beginning: {reason}")),
            None => JournalError::foreign(path, kind_of(&bytes)),
        });
    }
    let mut scan = Scan::default();
    let mut offset = MAGIC.len();
    while let Some(record) = record_at(&bytes, offset) {
        match record {
            Ok((opcode, body)) => {
                let end = offset + RECORD_HEAD + body.len();
                if opcode == CHUNK {
                    scan.chunk(bytes.get(offset..end).unwrap_or_default(), offset as u64, &mut visit);
                } else {
                    scan.record(path, opcode, body, offset as u64)?;
                }
                offset = end;
            }
            Err(_) if is_open_chunk(&bytes, offset) => {
                scan.reading.open_chunk = Some(offset as u64);
                break;
            }
            Err(what) => {
                let next = next_chunk(&bytes, offset + 1);
                let rest = next.map_or("nothing after it can be read", |_| "reading goes on at the next intact chunk");
                scan.problem(offset as u64, format!("{what}; {rest}"));
                let Some(next) = next else { break };
                offset = next;
            }
        }
        if scan.reading.finished {
            break;
        }
    }
    if let Some(reason) = damage {
        scan.problem(bytes.len() as u64, format!("the encrypted file is cut or damaged after this: {reason}"));
    }
    scan.finish(path, &mut visit)
}

/// Reads a journal's header alone, however long the journal is.
///
/// # Errors
/// [`JournalError`] where it is no journal of valet, or has a later format.
pub fn read_header(journal: impl Into<JournalFile>) -> Result<Header, JournalError> {
    let journal = journal.into();
    let path = journal.path();
    if journal.is_closed()? {
        return header_in(path, Cursor::new(journal.contents()?.bytes));
    }
    let file = File::open(path).map_err(|source| JournalError::file(path, source))?;
    header_in(path, BufReader::new(file))
}

fn header_in(path: &Path, mut file: impl Read) -> Result<Header, JournalError> {
    let failed = |source| JournalError::file(path, source);
    let mut begin = [0; MAGIC.len()];
    let whole = file.read_exact(&mut begin);
    if whole.is_err() || begin != *MAGIC {
        return Err(JournalError::foreign(path, kind_of(&begin)));
    }
    let mut head = [0; RECORD_HEAD];
    while file.read_exact(&mut head).is_ok() {
        let [opcode, length @ ..] = head;
        let length = u64::from_le_bytes(length);
        if opcode == CHUNK || length > LONGEST_HEADER {
            break;
        }
        let mut body = Vec::new();
        file.by_ref().take(length).read_to_end(&mut body).map_err(failed)?;
        if let Ok(Record::Metadata(metadata)) = mcap::read::parse_record(opcode, &body)
            && metadata.name == METADATA
        {
            return header_of(path, &metadata);
        }
    }
    Err(JournalError::foreign(path, "it is an MCAP file without valet's header"))
}

/// The record at an offset: its opcode and body. `None` at the end of the file, an error where there is none.
fn record_at(bytes: &[u8], offset: usize) -> Option<Result<(u8, &[u8]), String>> {
    let rest = bytes.get(offset..).filter(|rest| !rest.is_empty())?;
    let (Some(opcode), Some(length)) = (rest.first(), rest.get(1..RECORD_HEAD)) else {
        return Some(Err(format!("the file ends within a record's head ({} bytes are left)", rest.len())));
    };
    let length = length.try_into().map_or(u64::MAX, u64::from_le_bytes);
    let end = usize::try_from(length).ok().and_then(|length| length.checked_add(RECORD_HEAD));
    match end.and_then(|end| rest.get(RECORD_HEAD..end)) {
        Some(_) if !(0x01..=0x0f).contains(opcode) && *opcode < 0x80 => {
            Some(Err(format!("there is no record of kind {opcode:#04x}: the file is damaged here")))
        }
        Some(body) => Some(Ok((*opcode, body))),
        None => Some(Err(format!(
            "a record of {length} bytes is cut off: {} bytes are left",
            rest.len().saturating_sub(RECORD_HEAD)
        ))),
    }
}

/// True where a chunk begins whose length was never filled in: its writer was killed before the chunk was ended.
fn is_open_chunk(bytes: &[u8], offset: usize) -> bool {
    let length = bytes.get(offset + 1..offset + RECORD_HEAD);
    bytes.get(offset) == Some(&CHUNK) && length.is_some_and(|length| length.iter().all(|byte| *byte == 0xff))
}

/// The offset of the next intact chunk from `start` on.
fn next_chunk(bytes: &[u8], start: usize) -> Option<usize> {
    (start..bytes.len()).find(|offset| {
        bytes.get(*offset) == Some(&CHUNK) && matches!(record_at(bytes, *offset), Some(Ok((_, body))) if is_chunk(body))
    })
}

fn is_chunk(body: &[u8]) -> bool {
    match mcap::read::parse_record(CHUNK, body) {
        Ok(Record::Chunk { header, data }) => {
            header.compression == "lz4" && header.compressed_size == data.len() as u64
        }
        _ => false,
    }
}

/// What a file is that is no MCAP file, in words.
fn kind_of(bytes: &[u8]) -> String {
    if bytes.starts_with(b"#ROSBAG V") {
        foreign_bag::describe(bytes)
    } else if bytes.is_empty() {
        "it is empty".into()
    } else {
        "it is no MCAP file".into()
    }
}

/// The state of a reading.
#[derive(Default)]
struct Scan {
    reading: Reading,
    has_header: bool,
    topics: HashMap<u16, Topic>,
    pending: Option<Step>,
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum Topic {
    Input,
    Effect,
    Beside,
}

impl Scan {
    fn problem(&mut self, offset: u64, what: impl Into<String>) {
        self.reading.problems.push(Problem { offset, what: what.into() });
    }

    fn record(&mut self, path: &Path, opcode: u8, body: &[u8], offset: u64) -> Result<(), JournalError> {
        let record = match mcap::read::parse_record(opcode, body) {
            Ok(record) => record,
            Err(error) => {
                self.problem(offset, format!("a record cannot be read: {error}"));
                return Ok(());
            }
        };
        match record {
            Record::Metadata(metadata) if metadata.name == METADATA && !self.has_header => {
                self.reading.header = header_of(path, &metadata)?;
                self.has_header = true;
            }
            Record::DataEnd(_) => self.reading.finished = true,
            _ => {}
        }
        Ok(())
    }

    fn chunk(&mut self, chunk: &[u8], offset: u64, visit: &mut impl FnMut(&Header, Step)) {
        let read = chunk::records_of(chunk, |record| match record {
            Record::Channel(channel) => {
                let topic = match channel.topic.as_str() {
                    INPUT => Topic::Input,
                    EFFECT => Topic::Effect,
                    _ => Topic::Beside,
                };
                self.topics.insert(channel.id, topic);
            }
            Record::Message { header, data } => {
                let topic = self.topics.get(&header.channel_id).copied().unwrap_or(Topic::Beside);
                self.message(topic, &data, offset, visit);
            }
            _ => {}
        });
        if let Err(error) = read {
            self.problem(offset, format!("a chunk is damaged and left out: {error}"));
        }
    }

    fn message(&mut self, topic: Topic, data: &[u8], offset: u64, visit: &mut impl FnMut(&Header, Step)) {
        match topic {
            Topic::Beside => {}
            Topic::Input => match ciborium::from_reader::<OwnedInputEntry, _>(data) {
                Ok(entry) => {
                    self.deliver(visit);
                    let OwnedInputEntry { number, now, lost_before, input } = entry;
                    self.pending = Some(Step { number, now, input, effects: Vec::new(), lost_before });
                }
                Err(error) => self.problem(offset, format!("an input in this chunk cannot be read: {error}")),
            },
            Topic::Effect => match ciborium::from_reader::<OwnedEffectEntry, _>(data) {
                Ok(entry) => {
                    if let Some(step) = self.pending.as_mut().filter(|step| step.number == entry.number) {
                        step.effects = entry.effects;
                    } else {
                        self.problem(offset, format!("the input of step {} is missing", entry.number));
                    }
                }
                Err(error) => self.problem(offset, format!("a decision in this chunk cannot be read: {error}")),
            },
        }
    }

    fn deliver(&mut self, visit: &mut impl FnMut(&Header, Step)) {
        if let Some(step) = self.pending.take() {
            self.reading.steps += 1;
            self.reading.lost += step.lost_before;
            visit(&self.reading.header, step);
        }
    }

    fn finish(mut self, path: &Path, visit: &mut impl FnMut(&Header, Step)) -> Result<Reading, JournalError> {
        if !self.has_header {
            return Err(JournalError::foreign(path, "it is an MCAP file without valet's header"));
        }
        self.deliver(visit);
        Ok(self.reading)
    }
}

fn header_of(path: &Path, metadata: &Metadata) -> Result<Header, JournalError> {
    let text = |key: &str| metadata.metadata.get(key).cloned().unwrap_or_default();
    let format: u32 =
        text("format").parse().map_err(|_| JournalError::foreign(path, "its header does not say its format"))?;
    if format > FORMAT {
        return Err(JournalError::Future { path: path.to_path_buf(), found: format, known: FORMAT });
    }
    let seed = text("seed").parse().map_err(|_| JournalError::foreign(path, "its header does not say its seed"))?;
    Ok(Header {
        software: text("software"),
        seed,
        profile: text("profile"),
        profile_hash: text("profile_hash"),
        profile_text: text("profile_text"),
        garment: text("garment"),
        recipe: text("recipe"),
        watermark: text("watermark"),
        began_nanoseconds: text("began_nanoseconds").parse().unwrap_or_default(),
    })
}
