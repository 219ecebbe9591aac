//! What can be wrong with a file of settings or a profile, with the file and the key.

use std::path::{Path, PathBuf};
use thiserror::Error;

/// Why a file of settings or a profile cannot be used.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum ConfigError {
    /// The file cannot be read.
    #[error("{path} cannot be read: {source}")]
    Unreadable {
        /// Which file.
        path: PathBuf,
        /// Why.
        source: std::io::Error,
    },
    /// The file is no TOML, or holds an unknown key or a value of the wrong kind.
    #[error("{path}: {reason}")]
    Syntax {
        /// Which file.
        path: PathBuf,
        /// Line, key and reason.
        reason: String,
    },
    /// A value cannot be used.
    #[error("{path}: {key}: {reason}")]
    Value {
        /// Which file.
        path: PathBuf,
        /// Which key.
        key: String,
        /// Why, with what is allowed.
        reason: String,
    },
    /// The file is of a later version than this valet knows.
    #[error("{path}: version: it is {found}, but this valet knows versions up to {known}: use a newer valet")]
    FutureVersion {
        /// Which file.
        path: PathBuf,
        /// Its version.
        found: u32,
        /// The newest version that is known.
        known: u32,
    },
    /// No profile of this name is there.
    #[error("there is no profile {name}: looked in {places}; known are {known}")]
    NoProfile {
        /// The name.
        name: String,
        /// Where it was looked for.
        places: String,
        /// What is there.
        known: String,
    },
    /// The file is encrypted, and it was not opened with the key that was given.
    #[error(transparent)]
    Secret(#[from] super::SecretError),
    /// The file is encrypted.
    #[error(
        "{path} is encrypted: give its key with --key FILE or --passphrase-file FILE, or decrypt it first with `valet profile decrypt`"
    )]
    Encrypted {
        /// Which file.
        path: PathBuf,
    },
}

impl ConfigError {
    pub(super) fn value(path: &Path, key: impl Into<String>, reason: impl std::fmt::Display) -> Self {
        Self::Value { path: path.to_path_buf(), key: key.into(), reason: reason.to_string() }
    }

    /// An error of the TOML reader, with its line.
    pub(super) fn syntax(path: &Path, error: &toml::de::Error) -> Self {
        // The reader's own words show line, column and the line itself.
        Self::Syntax { path: path.to_path_buf(), reason: error.to_string().trim_end().to_owned() }
    }
}
