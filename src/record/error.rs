//! What can be wrong with a journal: file, offset, and what can still be read.

use crate::config::SecretError;
use std::fmt;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};
use thiserror::Error;

/// Why a journal cannot be written or read at all.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum JournalError {
    /// The file cannot be read or written.
    #[error("{path}: {source}: {}", what_to_do(source.kind()))]
    File {
        /// Which file.
        path: PathBuf,
        /// Why.
        source: std::io::Error,
    },
    /// The container cannot be written.
    #[error("{path}: the journal cannot be written: {reason}")]
    Container {
        /// Which file.
        path: PathBuf,
        /// Why.
        reason: String,
    },
    /// The file is not a journal of valet.
    #[error("{path} is not a trial that valet recorded: {reason}")]
    Foreign {
        /// Which file.
        path: PathBuf,
        /// What it is instead.
        reason: String,
    },
    /// The journal has a later format than this valet knows.
    #[error("{path}: the journal has format {found}, but this valet knows formats up to {known}: use a newer valet")]
    Future {
        /// Which file.
        path: PathBuf,
        /// Its format.
        found: u32,
        /// The newest format that is known.
        known: u32,
    },
    /// The journal is encrypted and no key was given.
    #[error("{path} is encrypted: give the person's key with --key FILE or --passphrase-file FILE")]
    Locked {
        /// Which file.
        path: PathBuf,
    },
    /// The key does not fit, or cannot be used.
    #[error(transparent)]
    Secret(#[from] SecretError),
}

fn what_to_do(kind: ErrorKind) -> &'static str {
    match kind {
        ErrorKind::NotFound => "check the path: there is no such file or folder",
        ErrorKind::PermissionDenied | ErrorKind::ReadOnlyFilesystem => "check who may read and write there",
        ErrorKind::StorageFull | ErrorKind::QuotaExceeded => "make room on the disk, or record elsewhere",
        _ => "check that the disk is there, and that the path names a file on it",
    }
}

impl JournalError {
    pub(super) fn file(path: &Path, source: std::io::Error) -> Self {
        Self::File { path: path.to_path_buf(), source }
    }

    pub(super) fn container(path: &Path, reason: impl fmt::Display) -> Self {
        Self::Container { path: path.to_path_buf(), reason: reason.to_string() }
    }

    pub(super) fn foreign(path: &Path, reason: impl Into<String>) -> Self {
        Self::Foreign { path: path.to_path_buf(), reason: reason.into() }
    }
}

/// A part of a journal that could not be read; the rest was.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Problem {
    /// Where in the file, in bytes from its start.
    pub offset: u64,
    /// What is wrong there, and what it means.
    pub what: String,
}

impl fmt::Display for Problem {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(formatter, "at byte {}: {}", self.offset, self.what)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_that_cannot_be_used_is_told_with_what_would_help() {
        let told = |kind: ErrorKind| JournalError::file(Path::new("/tmp/a.mcap"), kind.into()).to_string();
        assert!(
            told(ErrorKind::NotFound).contains("/tmp/a.mcap") && told(ErrorKind::NotFound).contains("check the path")
        );
        assert!(told(ErrorKind::PermissionDenied).contains("who may read"));
        assert!(told(ErrorKind::StorageFull).contains("make room"));
        assert!(told(ErrorKind::IsADirectory).contains("names a file"));
    }
}
