//! Finds, reads and checks a profile.

use super::{Profile, check};
use crate::config::{ConfigError, Key, Places, builtin, profile_names, version};
use sha2::{Digest, Sha256};
use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};

/// A profile with where it came from.
#[derive(Clone, Debug, PartialEq)]
pub struct LoadedProfile {
    /// The profile.
    pub profile: Profile,
    /// Its file; `built in/NAME.toml` where it is built into the binary.
    pub path: PathBuf,
    /// The SHA-256 of its text, in hexadecimal digits.
    pub hash: String,
    /// Its text.
    pub text: String,
    /// True where its file is encrypted: what valet writes elsewhere must then not hold its text.
    pub is_encrypted: bool,
}

impl LoadedProfile {
    /// Finds a profile by name, or reads the file that `name` is the path of.
    ///
    /// # Errors
    /// [`ConfigError`] names the file and the key, or where the profile was looked for.
    pub fn find(name: &str, places: &Places) -> Result<Self, ConfigError> {
        Self::find_with(name, places, None)
    }

    /// The same, with the key that opens it where it is encrypted.
    ///
    /// # Errors
    /// [`ConfigError`] names the file and the key, or where the profile was looked for.
    pub fn find_with(name: &str, places: &Places, key: Option<&Key>) -> Result<Self, ConfigError> {
        let as_file = Path::new(name);
        if as_file.components().count() > 1 || as_file.extension().is_some() {
            return Self::read(as_file, key);
        }
        if let Some(path) = places.profile_file(name) {
            return Self::read(&path, key);
        }
        if let Some(text) = builtin::profile(name) {
            return Self::parse(Path::new(&format!("built in/{name}.toml")), text);
        }
        Err(ConfigError::NoProfile {
            name: name.to_owned(),
            places: places.profile_folders(),
            known: profile_names(places).join(", "),
        })
    }

    /// Reads a profile's file; `key` opens it where it is encrypted.
    ///
    /// # Errors
    /// [`ConfigError`] names the file and the key.
    pub fn read(path: &Path, key: Option<&Key>) -> Result<Self, ConfigError> {
        let mut bytes =
            fs::read(path).map_err(|source| ConfigError::Unreadable { path: path.to_path_buf(), source })?;
        let is_encrypted = bytes.starts_with(b"age-encryption.org/") || bytes.starts_with(b"-----BEGIN AGE");
        if is_encrypted {
            let key = key.ok_or_else(|| ConfigError::Encrypted { path: path.to_path_buf() })?;
            bytes = key.decrypt(path, &bytes)?;
        }
        let text = String::from_utf8(bytes)
            .map_err(|error| ConfigError::value(path, "encoding", format!("no UTF-8 text: {error}")))?;
        Ok(Self { is_encrypted, ..Self::parse(path, &text)? })
    }

    /// Reads a profile from its text; `path` is what errors call it.
    ///
    /// # Errors
    /// [`ConfigError`] names the file and the key.
    pub fn parse(path: &Path, text: &str) -> Result<Self, ConfigError> {
        version::check(path, text, Profile::VERSION)?;
        let table: toml::Table = text.parse().map_err(|error| ConfigError::syntax(path, &error))?;
        if let Some(key) = check::forbidden_key(&table) {
            let reason =
                "a profile holds no names and no addresses: take it out, and keep the list of pseudonyms elsewhere";
            return Err(ConfigError::value(path, key, reason));
        }
        let profile: Profile = toml::from_str(text).map_err(|error| ConfigError::syntax(path, &error))?;
        check::check(&profile).map_err(|(key, reason)| ConfigError::value(path, key, reason))?;
        Ok(Self { profile, path: path.to_path_buf(), hash: hash_of(text), text: text.to_owned(), is_encrypted: false })
    }

    /// The hash, shortened for screens.
    #[must_use]
    pub fn short_hash(&self) -> String {
        self.hash.chars().take(12).collect()
    }
}

fn hash_of(text: &str) -> String {
    let mut hash = String::with_capacity(64);
    for byte in Sha256::digest(text.as_bytes()) {
        // Writing into a string cannot fail.
        let _ = write!(hash, "{byte:02x}");
    }
    hash
}
