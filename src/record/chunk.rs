//! Opens a chunk of a journal: its checksum is tested before anything in it is believed.

use mcap::records::Record;
use mcap::sans_io::linear_reader::{LinearReadEvent, LinearReader, LinearReaderOptions};

/// No chunk of valet is larger than this, compressed or not; a damaged length must not take all memory.
const LARGEST: usize = 64 << 20;

/// Shows every record of a chunk to `visit`. `chunk` is the whole chunk record with its opcode and length.
///
/// # Errors
/// In words where the chunk is damaged; nothing, or only a part, was shown then.
pub(super) fn records_of(chunk: &[u8], mut visit: impl FnMut(Record<'_>)) -> Result<(), String> {
    let options = LinearReaderOptions::default()
        .with_skip_start_magic(true)
        .with_skip_end_magic(true)
        .with_prevalidate_chunk_crcs(true)
        .with_record_length_limit(LARGEST);
    let mut reader = LinearReader::new_with_options(options);
    let mut rest = chunk;
    while let Some(event) = reader.next_event() {
        match event.map_err(|error| error.to_string())? {
            LinearReadEvent::ReadRequest(_) if rest.is_empty() => return Ok(()),
            LinearReadEvent::ReadRequest(wanted) => {
                let (now, later) = rest.split_at(wanted.min(rest.len()));
                if let Some(place) = reader.insert(now.len()).get_mut(..now.len()) {
                    place.copy_from_slice(now);
                }
                reader.notify_read(now.len());
                rest = later;
            }
            LinearReadEvent::Record { opcode, data } => {
                visit(mcap::read::parse_record(opcode, data).map_err(|error| error.to_string())?);
            }
        }
    }
    Ok(())
}
