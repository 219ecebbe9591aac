//! A journal's file and what opens it: plain, or closed with the key of the person that it tells of (`*.mcap.age`).
//!
//! A journal is plain while it grows, so that a crash leaves what can be read; it is closed when the trial has ended.

use super::error::JournalError;
use crate::config::{Key, write_whole};
use std::fs;
use std::path::{Path, PathBuf};

/// The first bytes of every file that age has encrypted.
const AGE: &[u8] = b"age-encryption.org/v1";

/// A journal's file with the key that opens it, where it needs one.
#[derive(Clone, Debug)]
pub struct JournalFile {
    path: PathBuf,
    key: Option<Key>,
}

/// What is in a journal's file.
pub(super) struct Contents {
    pub(super) bytes: Vec<u8>,
    /// Why an encrypted file cannot be opened to its end; what comes before is in `bytes`.
    pub(super) damage: Option<String>,
}

impl JournalFile {
    /// A file, with the key that was given for it. The key of a plain journal is not used.
    #[must_use]
    pub fn new(path: impl Into<PathBuf>, key: Option<Key>) -> Self {
        Self { path: path.into(), key }
    }

    /// Where it is.
    #[must_use]
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// What the trial is called: the file's name without its endings.
    #[must_use]
    pub fn name(&self) -> String {
        let name = self.path.file_name().map_or_else(|| "trial".into(), |name| name.to_string_lossy());
        let name = name.strip_suffix(".age").unwrap_or(&name);
        name.strip_suffix(".mcap").unwrap_or(name).to_owned()
    }

    /// True where the file is encrypted.
    ///
    /// # Errors
    /// [`JournalError::File`] where it cannot be read.
    pub(super) fn is_closed(&self) -> Result<bool, JournalError> {
        use std::io::Read;
        let failed = |source| JournalError::file(&self.path, source);
        let mut begin = Vec::new();
        let file = fs::File::open(&self.path).map_err(failed)?;
        file.take(AGE.len() as u64).read_to_end(&mut begin).map_err(failed)?;
        Ok(begin == AGE)
    }

    /// The journal itself.
    ///
    /// # Errors
    /// [`JournalError::Locked`] where it is encrypted and no key was given, [`JournalError::Secret`] where the key does not fit.
    pub(super) fn contents(&self) -> Result<Contents, JournalError> {
        let bytes = fs::read(&self.path).map_err(|source| JournalError::file(&self.path, source))?;
        if !bytes.starts_with(AGE) {
            return Ok(Contents { bytes, damage: None });
        }
        let key = self.key.as_ref().ok_or_else(|| JournalError::Locked { path: self.path.clone() })?;
        let (bytes, damage) = key.decrypt_what_is_intact(&self.path, &bytes)?;
        Ok(Contents { bytes, damage })
    }
}

impl From<&Path> for JournalFile {
    fn from(path: &Path) -> Self {
        Self::new(path, None)
    }
}

impl From<&PathBuf> for JournalFile {
    fn from(path: &PathBuf) -> Self {
        Self::new(path, None)
    }
}

impl From<&Self> for JournalFile {
    fn from(file: &Self) -> Self {
        file.clone()
    }
}

/// Encrypts a finished journal; the plain file is removed. Returns the encrypted file, `NAME.mcap.age`.
///
/// # Errors
/// [`JournalError`] where a file cannot be read or written or the key cannot be used; the plain file is kept then.
pub fn close_journal(path: &Path, key: &Key) -> Result<PathBuf, JournalError> {
    let bytes = fs::read(path).map_err(|source| JournalError::file(path, source))?;
    let target = PathBuf::from(format!("{}.age", path.display()));
    write_whole(&target, &key.encrypt(path, &bytes)?)?;
    fs::remove_file(path).map_err(|source| JournalError::file(path, source))?;
    Ok(target)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_trial_is_called_by_its_file_without_its_endings() {
        for name in ["p-01-seed1-001.mcap", "p-01-seed1-001.mcap.age", "p-01-seed1-001"] {
            assert_eq!(JournalFile::from(Path::new("folder").join(name).as_path()).name(), "p-01-seed1-001");
        }
    }
}
