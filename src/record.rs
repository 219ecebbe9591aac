//! The trial's journal: everything that came into the core and everything it decided, so that a trial can be shown,
//! replayed exactly and explained.
//!
//! The container is MCAP with lz4 chunks. Two channels hold the exact record (`/valet/input`, `/valet/effect`, CBOR, which
//! carries numbers that are not finite); beside them stand ROS 1 messages on Baxter's own topics, so that Foxglove and
//! other tools open the file. `docs/records.md` describes the format. Writing never blocks the robot: what does not fit
//! into the queue is counted and reported. Nothing here decides anything.

mod ahead;
mod bag;
mod channels;
mod chunk;
mod entry;
mod error;
mod export;
mod file;
mod foreign_bag;
mod player;
mod reader;
mod recorder;
mod replay;
mod ros_message;
mod writer;

pub use bag::write_bag;
pub use entry::{Header, Step};
pub use error::{JournalError, Problem};
pub use export::{CsvFiles, write_csv};
pub use file::{JournalFile, close_journal};
pub use player::{Change, Player};
pub use reader::{Reading, read, read_header};
pub use recorder::{Recorder, RecorderNotice, RecorderStatus, Told};
pub use replay::{Difference, Learned, Replay, learned_in};
pub use writer::JournalWriter;
