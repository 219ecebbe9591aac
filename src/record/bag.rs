//! Writes rosbag's format 2.0 (wiki.ros.org/Bags/Format/2.0): uncompressed chunks with their index.

use super::channels::CHANNELS;
use super::error::JournalError;
use super::file::JournalFile;
use super::ros_message::{self, RosMessage};
use super::{Reading, Step, read};
use crate::supervisor::{Effect, Input};
use crate::time::Stamp;
use std::collections::BTreeMap;
use std::fs::File;
use std::io::{self, BufWriter, Seek, SeekFrom, Write};
use std::path::Path;
use std::time::Duration;

/// Bytes of messages in a chunk before the next one begins; rosbag's own default.
const CHUNK_BYTES: usize = 768 * 1024;
/// The first record, with its padding, takes this many bytes.
const HEADER_BYTES: usize = 4096;
/// An export without absolute time begins here: rosbag refuses a time of zero.
const FIRST_MOMENT: Stamp = Stamp::from_nanoseconds(1_000_000_000);

/// Writes a journal's ROS 1 messages as a bag. With `anonymous`, time begins at one second and the log is left out.
///
/// # Errors
/// [`JournalError`] where the journal cannot be read or the bag cannot be written.
pub fn write_bag(journal: impl Into<JournalFile>, bag: &Path, anonymous: bool) -> Result<Reading, JournalError> {
    let failed = |source| JournalError::file(bag, source);
    let mut writer = Bag::create(bag).map_err(failed)?;
    let mut first = None;
    let mut outcome = Ok(());
    let reading = read(journal, |_, step| {
        let began = *first.get_or_insert(step.now);
        if outcome.is_ok() {
            outcome = write_step(&mut writer, step, anonymous.then_some(began));
        }
    })?;
    outcome.and_then(|()| writer.finish()).map_err(failed)?;
    Ok(reading)
}

fn write_step(writer: &mut Bag, mut step: Step, began: Option<Stamp>) -> io::Result<()> {
    if let Some(began) = began {
        let shift = |stamp: &mut Stamp| *stamp = FIRST_MOMENT + stamp.since(began);
        shift(&mut step.now);
        match &mut step.input {
            Input::Endpoint(sample) => shift(&mut sample.stamp),
            Input::Joints(sample) => shift(&mut sample.stamp),
            Input::Robot(state) => shift(&mut state.stamp),
            Input::Body(pose) => shift(&mut pose.stamp),
            _ => {}
        }
        step.effects.retain(|effect| !matches!(effect, Effect::Log { .. }));
    }
    let beside = ros_message::of_input(&step.input).into_iter();
    for message in beside.chain(step.effects.iter().filter_map(|effect| ros_message::of_effect(step.now, effect))) {
        writer.message(step.now.max(Stamp::ZERO + Duration::from_nanos(1)), &message)?;
    }
    Ok(())
}

/// Fields of a record's header.
#[derive(Default)]
struct Fields(Vec<u8>);

impl Fields {
    fn with(mut self, name: &str, value: &[u8]) -> Self {
        self.0.extend(length(name.len() + 1 + value.len()));
        self.0.extend(name.as_bytes());
        self.0.push(b'=');
        self.0.extend(value);
        self
    }

    fn operation(operation: u8) -> Self {
        Self::default().with("op", &[operation])
    }

    fn record(&self, data: &[u8]) -> Vec<u8> {
        let mut record = length(self.0.len()).to_vec();
        record.extend(&self.0);
        record.extend(length(data.len()));
        record.extend(data);
        record
    }
}

fn length(length: usize) -> [u8; 4] {
    u32::try_from(length).unwrap_or(u32::MAX).to_le_bytes()
}

fn time(stamp: Stamp) -> [u8; 8] {
    let (seconds, nanoseconds) = stamp.to_ros();
    (u64::from(nanoseconds) << 32 | u64::from(seconds)).to_le_bytes()
}

fn connection(index: usize) -> Vec<u8> {
    let Some(channel) = CHANNELS.get(index) else { return Vec::new() };
    let topic = channel.topic.as_bytes();
    let details = Fields::default()
        .with("topic", topic)
        .with("type", channel.kind.name.as_bytes())
        .with("md5sum", channel.kind.md5.as_bytes())
        .with("message_definition", channel.kind.definition.as_bytes())
        .with("callerid", b"/valet");
    Fields::operation(0x07).with("conn", &length(index)).with("topic", topic).record(&details.0)
}

/// What the index says of a chunk.
struct ChunkInfo {
    position: u64,
    first: Stamp,
    last: Stamp,
    counts: BTreeMap<usize, usize>,
}

struct Bag {
    file: BufWriter<File>,
    position: u64,
    chunk: Vec<u8>,
    entries: BTreeMap<usize, Vec<(Stamp, usize)>>,
    chunks: Vec<ChunkInfo>,
    known: Vec<usize>,
}

impl Bag {
    fn create(path: &Path) -> io::Result<Self> {
        let mut file = BufWriter::new(File::create(path)?);
        let magic = b"#ROSBAG V2.0\n";
        file.write_all(magic)?;
        file.write_all(&header_record(0, 0, 0))?;
        Ok(Self {
            file,
            position: (magic.len() + HEADER_BYTES) as u64,
            chunk: Vec::new(),
            entries: BTreeMap::new(),
            chunks: Vec::new(),
            known: Vec::new(),
        })
    }

    fn message(&mut self, stamp: Stamp, message: &RosMessage) -> io::Result<()> {
        if !self.known.contains(&message.channel) {
            self.known.push(message.channel);
            self.chunk.extend(connection(message.channel));
        }
        let offset = self.chunk.len();
        let fields = Fields::operation(0x02).with("conn", &length(message.channel)).with("time", &time(stamp));
        self.chunk.extend(fields.record(&message.bytes));
        self.entries.entry(message.channel).or_default().push((stamp, offset));
        if self.chunk.len() >= CHUNK_BYTES { self.end_chunk() } else { Ok(()) }
    }

    fn write(&mut self, bytes: &[u8]) -> io::Result<()> {
        self.position += bytes.len() as u64;
        self.file.write_all(bytes)
    }

    fn end_chunk(&mut self) -> io::Result<()> {
        let entries = std::mem::take(&mut self.entries);
        let stamps = || entries.values().flatten().map(|(stamp, _)| *stamp);
        let (Some(first), Some(last)) = (stamps().min(), stamps().max()) else { return Ok(()) };
        let counts = entries.iter().map(|(channel, list)| (*channel, list.len())).collect();
        self.chunks.push(ChunkInfo { position: self.position, first, last, counts });
        let chunk = std::mem::take(&mut self.chunk);
        let fields = Fields::operation(0x05).with("compression", b"none").with("size", &length(chunk.len()));
        self.write(&fields.record(&chunk))?;
        for (channel, list) in &entries {
            let fields = Fields::operation(0x04)
                .with("ver", &1_u32.to_le_bytes())
                .with("conn", &length(*channel))
                .with("count", &length(list.len()));
            let data: Vec<u8> =
                list.iter().flat_map(|(stamp, offset)| time(*stamp).into_iter().chain(length(*offset))).collect();
            self.write(&fields.record(&data))?;
        }
        Ok(())
    }

    fn finish(mut self) -> io::Result<()> {
        self.end_chunk()?;
        let index = self.position;
        for channel in self.known.clone() {
            self.write(&connection(channel))?;
        }
        for info in std::mem::take(&mut self.chunks) {
            self.write(&info.record())?;
            self.chunks.push(info);
        }
        let header = header_record(index, self.known.len(), self.chunks.len());
        self.file.seek(SeekFrom::Start(13))?;
        self.file.write_all(&header)?;
        self.file.flush()
    }
}

impl ChunkInfo {
    fn record(&self) -> Vec<u8> {
        let fields = Fields::operation(0x06)
            .with("ver", &1_u32.to_le_bytes())
            .with("chunk_pos", &self.position.to_le_bytes())
            .with("start_time", &time(self.first))
            .with("end_time", &time(self.last))
            .with("count", &length(self.counts.len()));
        let data: Vec<u8> = self
            .counts
            .iter()
            .flat_map(|(channel, count)| length(*channel).into_iter().chain(length(*count)))
            .collect();
        fields.record(&data)
    }
}

fn header_record(index: u64, connections: usize, chunks: usize) -> Vec<u8> {
    let fields = Fields::operation(0x03)
        .with("index_pos", &index.to_le_bytes())
        .with("conn_count", &length(connections))
        .with("chunk_count", &length(chunks));
    // The record is padded to a fixed length so that it can be written again when the index is known.
    let padding = HEADER_BYTES.saturating_sub(fields.0.len() + 8);
    fields.record(&vec![b' '; padding])
}
