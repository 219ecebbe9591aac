//! A program of ours on a pseudo-terminal, and what it costs: frames, bytes, processor time, memory.

use crate::cli::exit::Failure;
use portable_pty::{Child, CommandBuilder, PtySize, native_pty_system};
use std::fs;
use std::io::{Read, Write};
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::thread;
use std::time::Duration;

/// What begins a frame: a synchronized update.
const FRAME: &[u8] = b"\x1b[?2026h";

/// What has come out of the program so far.
#[derive(Debug, Default)]
struct Written {
    bytes: AtomicU64,
    frames: AtomicU64,
}

/// What the program had cost at one moment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Cost {
    pub(super) bytes: u64,
    pub(super) frames: u64,
    /// Processor time of the thread that draws, and of the whole process.
    pub(super) screen: Duration,
    pub(super) process: Duration,
}

/// A program on a terminal of its own. Dropping it ends the program.
pub(super) struct Terminal {
    child: Box<dyn Child + Send + Sync>,
    keys: Box<dyn Write + Send>,
    written: Arc<Written>,
}

impl Drop for Terminal {
    fn drop(&mut self) {
        // It may have ended by itself; then there is nothing to end.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

impl Terminal {
    /// Starts this program with `arguments` on a terminal of 120 x 40.
    pub(super) fn start(arguments: &[String], variables: &[(&str, String)]) -> Result<Self, Failure> {
        let size = PtySize { rows: 40, cols: 120, pixel_width: 0, pixel_height: 0 };
        let pair = native_pty_system().openpty(size).map_err(Failure::fault)?;
        let mut command = CommandBuilder::new(std::env::current_exe().map_err(Failure::fault)?);
        command.args(arguments);
        command.env("LANG", "C.UTF-8");
        command.env("TERM", "xterm-256color");
        for (name, value) in variables {
            command.env(name, value);
        }
        let child = pair.slave.spawn_command(command).map_err(Failure::fault)?;
        drop(pair.slave);
        let mut reader = pair.master.try_clone_reader().map_err(Failure::fault)?;
        let keys = pair.master.take_writer().map_err(Failure::fault)?;
        let written = Arc::<Written>::default();
        let count = Arc::clone(&written);
        thread::Builder::new()
            .name("terminal".into())
            .spawn(move || {
                let _terminal = pair.master;
                read_all(&mut reader, &count);
            })
            .map_err(Failure::fault)?;
        Ok(Self { child, keys, written })
    }

    /// Types keys.
    pub(super) fn press(&mut self, keys: &[u8]) -> Result<(), Failure> {
        self.keys.write_all(keys).and_then(|()| self.keys.flush()).map_err(Failure::fault)
    }

    /// What it has cost so far.
    pub(super) fn cost(&self) -> Result<Cost, Failure> {
        let process = self.process()?;
        let threads = fs::read_dir(format!("/proc/{process}/task")).map_err(Failure::fault)?;
        let threads = threads.flatten().filter_map(|thread| thread.file_name().into_string().ok());
        // A thread may end between the list and the look at it: it has no time to add then.
        let time = |thread: &str| processor_time(&format!("/proc/{process}/task/{thread}/schedstat"));
        Ok(Cost {
            bytes: self.written.bytes.load(Ordering::Relaxed),
            frames: self.written.frames.load(Ordering::Relaxed),
            screen: time(&process.to_string()).unwrap_or_default(),
            process: threads.filter_map(|thread| time(&thread)).sum(),
        })
    }

    /// Resident memory in kilobytes.
    pub(super) fn memory(&self) -> Result<u64, Failure> {
        let status = fs::read_to_string(format!("/proc/{}/status", self.process()?)).map_err(Failure::fault)?;
        let resident = status.lines().find_map(|line| line.strip_prefix("VmRSS:"));
        let kilobytes = resident.and_then(|line| line.split_whitespace().next()).and_then(|number| number.parse().ok());
        kilobytes.ok_or_else(|| Failure::Fault("the system does not tell how much memory the console has".into()))
    }

    fn process(&self) -> Result<u32, Failure> {
        self.child.process_id().ok_or_else(|| Failure::Fault("the console has ended".into()))
    }
}

/// The first number of a `schedstat` file: nanoseconds on a processor.
fn processor_time(path: &str) -> Option<Duration> {
    let text = fs::read_to_string(path).ok()?;
    text.split_whitespace().next()?.parse().ok().map(Duration::from_nanos)
}

fn read_all(reader: &mut dyn Read, written: &Written) {
    let mut bytes = vec![0; 1 << 16];
    while let Ok(count @ 1..) = reader.read(&mut bytes) {
        let seen = bytes.get(..count).unwrap_or_default();
        let frames = seen.windows(FRAME.len()).filter(|window| *window == FRAME).count();
        written.bytes.fetch_add(count as u64, Ordering::Relaxed);
        // A mark that is cut in two by a read is missed: one in thousands.
        written.frames.fetch_add(frames as u64, Ordering::Relaxed);
    }
}
