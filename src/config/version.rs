//! The version of a file is read before everything else: a later one may mean something else by the same words.

use super::ConfigError;
use serde::Deserialize;
use std::path::Path;

#[derive(Deserialize)]
struct Versioned {
    version: Option<u32>,
}

/// Refuses a file without a version or of a later version than `known`.
pub(super) fn check(path: &Path, text: &str, known: u32) -> Result<(), ConfigError> {
    let found: Versioned = toml::from_str(text).map_err(|error| ConfigError::syntax(path, &error))?;
    match found.version {
        None => Err(ConfigError::value(path, "version", format!("missing; write `version = {known}` at the top"))),
        Some(0) => Err(ConfigError::value(
            path,
            "version",
            format!("there is no version 0; the first is 1, the newest {known}"),
        )),
        Some(found) if found > known => Err(ConfigError::FutureVersion { path: path.to_path_buf(), found, known }),
        Some(_) => Ok(()),
    }
}
