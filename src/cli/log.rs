//! The program's own log: a file a day below `$XDG_STATE_HOME/valet/logs`, the newest ones kept. Panics, stops and what the
//! supervisor tells end there too. Never writes to the terminal, and never waits for the disk.

use crate::snapshot::Level;
use crate::supervisor::Effect;
use std::path::Path;
use tracing_appender::non_blocking::WorkerGuard;
use tracing_appender::rolling::{Builder, Rotation};

/// Files that are kept, one a day.
const KEPT: usize = 14;

/// The log while it is written; what is still under way is written when it is dropped.
#[derive(Debug)]
pub(super) struct ProgramLog {
    _writer: Option<WorkerGuard>,
}

impl ProgramLog {
    /// Begins the log in a folder. A folder that cannot be written to leaves the program without its log: the trial's own
    /// record does not depend on it.
    pub(super) fn start(folder: &Path) -> Self {
        // The builder complains on the terminal about a folder that does not exist.
        if std::fs::create_dir_all(folder).is_err() {
            return Self { _writer: None };
        }
        let files = Builder::new().rotation(Rotation::DAILY).filename_prefix("valet").filename_suffix("log");
        let Ok(files) = files.max_log_files(KEPT).build(folder) else { return Self { _writer: None } };
        let (lines, writer) = tracing_appender::non_blocking(files);
        // A process has one log: where there is one already, it goes on.
        let started = tracing_subscriber::fmt().with_writer(lines).with_ansi(false).try_init();
        tracing::info!("valet {} begins: {:?}", env!("CARGO_PKG_VERSION"), std::env::args().collect::<Vec<_>>());
        Self { _writer: started.is_ok().then_some(writer) }
    }
}

/// Writes what the supervisor tells into the log.
pub(super) fn tell(effect: &Effect) {
    match effect {
        Effect::Log { level: Level::Error, text } => tracing::error!("{text}"),
        Effect::Log { level: Level::Warning, text } => tracing::warn!("{text}"),
        Effect::Log { text, .. } => tracing::info!("{text}"),
        _ => {}
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_told_is_in_the_file_once_the_log_has_ended() {
        let folder = tempfile::tempdir().unwrap();
        let log = ProgramLog::start(&folder.path().join("logs"));
        tell(&Effect::Log { level: Level::Warning, text: "the left wrench is late".into() });
        drop(log);
        let files: Vec<_> = std::fs::read_dir(folder.path().join("logs")).unwrap().flatten().collect();
        assert_eq!(files.len(), 1);
        let text = std::fs::read_to_string(files[0].path()).unwrap();
        assert!(text.contains("WARN") && text.contains("the left wrench is late"), "{text}");
    }

    #[test]
    fn a_folder_that_cannot_be_made_is_no_reason_to_fail() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("file");
        std::fs::write(&file, "").unwrap();
        let ProgramLog { _writer: writer } = ProgramLog::start(&file.join("logs"));
        assert!(writer.is_none());
    }
}
