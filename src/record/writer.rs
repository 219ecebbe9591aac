//! Writes a journal, chunk by chunk. Blocks on the disk: on a robot it runs behind the [`Recorder`](super::Recorder)'s queue.

use super::channels::{CHANNELS, EFFECT, INPUT};
use super::entry::{EffectEntry, Header, InputEntry, bytes_of};
use super::error::JournalError;
use super::ros_message::{self, RosMessage};
use crate::supervisor::{Effect, Input};
use crate::time::Stamp;
use mcap::records::{MessageHeader, Metadata};
use std::collections::BTreeMap;
use std::fs::{self, File, OpenOptions};
use std::io::BufWriter;
use std::path::{Path, PathBuf};

/// The format of journals that this version writes.
pub(super) const FORMAT: u32 = 1;
/// The name of the metadata record that holds the header.
pub(super) const METADATA: &str = "valet";

/// A journal that is being written.
pub struct JournalWriter {
    path: PathBuf,
    writer: mcap::Writer<BufWriter<File>>,
    disk: File,
    input: u16,
    effect: u16,
    ros: Vec<u16>,
    next: u64,
}

impl std::fmt::Debug for JournalWriter {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        formatter
            .debug_struct("JournalWriter")
            .field("path", &self.path)
            .field("next", &self.next)
            .finish_non_exhaustive()
    }
}

impl JournalWriter {
    /// Begins a journal in a folder, which is made where it does not exist. An older file is never touched: the name
    /// (profile, strategy or watermark, seed) gets the first free number.
    ///
    /// # Errors
    /// [`JournalError`] names the file and the reason.
    pub fn create(folder: &Path, header: &Header) -> Result<Self, JournalError> {
        fs::create_dir_all(folder).map_err(|source| JournalError::file(folder, source))?;
        let (path, file) = fresh_file(folder, header)?;
        let disk = file.try_clone().map_err(|source| JournalError::file(&path, source))?;
        let failed = |error: mcap::McapError| JournalError::container(&path, error);
        let options = mcap::WriteOptions::new()
            .profile("valet")
            .library(format!("valet {}", env!("CARGO_PKG_VERSION")))
            .compression(Some(mcap::Compression::Lz4));
        let mut writer = options.create(BufWriter::new(file)).map_err(failed)?;
        writer.write_metadata(&metadata_of(header)).map_err(failed)?;
        let none = BTreeMap::new();
        let input = writer.add_channel(0, INPUT, "cbor", &none).map_err(failed)?;
        let effect = writer.add_channel(0, EFFECT, "cbor", &none).map_err(failed)?;
        let mut ros = Vec::with_capacity(CHANNELS.len());
        for channel in CHANNELS {
            let kind = channel.kind;
            let schema = writer.add_schema(kind.name, "ros1msg", kind.definition.as_bytes()).map_err(failed)?;
            let details = BTreeMap::from([
                ("md5sum".to_owned(), kind.md5.to_owned()),
                ("callerid".to_owned(), "/valet".to_owned()),
                ("topic".to_owned(), channel.topic.to_owned()),
            ]);
            ros.push(writer.add_channel(schema, channel.topic, "ros1", &details).map_err(failed)?);
        }
        writer.flush().map_err(failed)?;
        Ok(Self { path, writer, disk, input, effect, ros, next: 0 })
    }

    /// The file.
    #[must_use]
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Writes one step. `lost_before` steps could not be written before it.
    ///
    /// # Errors
    /// [`JournalError`] where the disk refuses.
    pub fn step(
        &mut self,
        now: Stamp,
        input: &Input,
        effects: &[Effect],
        lost_before: u64,
    ) -> Result<(), JournalError> {
        let number = self.next + lost_before;
        self.next = number + 1;
        let entry = bytes_of(&InputEntry { number, now, lost_before, input });
        let entry = entry.map_err(|reason| JournalError::container(&self.path, reason))?;
        self.message(self.input, number, now, &entry)?;
        if !effects.is_empty() {
            let entry = bytes_of(&EffectEntry { number, effects });
            let entry = entry.map_err(|reason| JournalError::container(&self.path, reason))?;
            self.message(self.effect, number, now, &entry)?;
        }
        let beside = ros_message::of_input(input).into_iter();
        let beside = beside.chain(effects.iter().filter_map(|effect| ros_message::of_effect(now, effect)));
        for message in beside {
            self.ros_message(number, now, &message)?;
        }
        Ok(())
    }

    /// Writes a depth image (16 bits a pixel, millimetres) beside the record, as compressed depth.
    ///
    /// # Errors
    /// [`JournalError`] where the image is not `width` by `height` or the disk refuses.
    pub fn depth(&mut self, stamp: Stamp, width: u32, height: u32, millimetres: &[u16]) -> Result<(), JournalError> {
        let failed = |error: png::EncodingError| JournalError::container(&self.path, error);
        let mut bytes = Vec::new();
        let mut encoder = png::Encoder::new(&mut bytes, width, height);
        encoder.set_color(png::ColorType::Grayscale);
        encoder.set_depth(png::BitDepth::Sixteen);
        encoder.set_compression(png::Compression::Fast);
        let pixels: Vec<u8> = millimetres.iter().flat_map(|depth| depth.to_be_bytes()).collect();
        encoder.write_header().and_then(|mut writer| writer.write_image_data(&pixels)).map_err(failed)?;
        self.ros_message(self.next, stamp, &ros_message::depth(stamp, &bytes))
    }

    fn ros_message(&mut self, number: u64, now: Stamp, message: &RosMessage) -> Result<(), JournalError> {
        let Some(channel) = self.ros.get(message.channel).copied() else { return Ok(()) };
        self.message(channel, number, now, &message.bytes)
    }

    fn message(&mut self, channel_id: u16, number: u64, now: Stamp, bytes: &[u8]) -> Result<(), JournalError> {
        let sequence = u32::try_from(number & u64::from(u32::MAX)).unwrap_or(u32::MAX);
        let header =
            MessageHeader { channel_id, sequence, log_time: now.nanoseconds(), publish_time: now.nanoseconds() };
        let written = self.writer.write_to_known_channel(&header, bytes);
        written.map_err(|error| JournalError::container(&self.path, error))
    }

    /// Ends the chunk and hands it to the operating system: from now on it survives the end of this process.
    ///
    /// # Errors
    /// [`JournalError`] where the disk refuses.
    pub fn flush(&mut self) -> Result<(), JournalError> {
        self.writer.flush().map_err(|error| JournalError::container(&self.path, error))
    }

    /// Flushes, and waits until the disk has it: from now on it survives the end of this machine's power too.
    ///
    /// # Errors
    /// [`JournalError`] where the disk refuses.
    pub fn save(&mut self) -> Result<(), JournalError> {
        self.flush()?;
        self.disk.sync_data().map_err(|source| JournalError::file(&self.path, source))
    }

    /// Ends the journal with its index.
    ///
    /// # Errors
    /// [`JournalError`] where the disk refuses.
    pub fn finish(mut self) -> Result<PathBuf, JournalError> {
        self.writer.finish().map_err(|error| JournalError::container(&self.path, error))?;
        Ok(self.path)
    }
}

fn fresh_file(folder: &Path, header: &Header) -> Result<(PathBuf, File), JournalError> {
    let profile = if header.profile.is_empty() { "trial" } else { &header.profile };
    let profile: String = profile.chars().map(|sign| if sign.is_alphanumeric() { sign } else { '-' }).collect();
    let mut number = 1_u32;
    loop {
        let path = folder.join(format!("{profile}-seed{}-{number:03}.mcap", header.seed));
        match OpenOptions::new().write(true).create_new(true).open(&path) {
            Ok(file) => return Ok((path, file)),
            Err(error) if error.kind() == std::io::ErrorKind::AlreadyExists => number += 1,
            Err(source) => return Err(JournalError::file(&path, source)),
        }
    }
}

fn metadata_of(header: &Header) -> Metadata {
    let entries = [
        ("format", FORMAT.to_string()),
        ("software", header.software.clone()),
        ("seed", header.seed.to_string()),
        ("profile", header.profile.clone()),
        ("profile_hash", header.profile_hash.clone()),
        ("profile_text", header.profile_text.clone()),
        ("garment", header.garment.clone()),
        ("recipe", header.recipe.clone()),
        ("watermark", header.watermark.clone()),
        ("began_nanoseconds", header.began_nanoseconds.to_string()),
    ];
    let metadata = entries.into_iter().map(|(key, value)| (key.to_owned(), value)).collect();
    Metadata { name: METADATA.to_owned(), metadata }
}
