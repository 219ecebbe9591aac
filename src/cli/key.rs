//! The key that opens a person's encrypted profile: a file with an age key, or a passphrase.

use super::exit::Failure;
use crate::config::Key;
use age::secrecy::SecretString;
use std::fs;
use std::path::{Path, PathBuf};

/// The key of an encrypted profile.
#[derive(Clone, Debug, Default, clap::Args)]
pub(super) struct KeyArguments {
    /// A file with the age key of an encrypted profile.
    #[arg(long, value_name = "FILE", conflicts_with = "passphrase_file")]
    key: Option<PathBuf>,
    /// A file whose first line is the passphrase of an encrypted profile.
    #[arg(long, value_name = "FILE")]
    passphrase_file: Option<PathBuf>,
}

/// The shortest passphrase that is taken, in bytes.
const SHORTEST_PASSPHRASE: usize = 12;

impl KeyArguments {
    /// The key, where one was given.
    ///
    /// # Errors
    /// Where the passphrase cannot be read or is too short.
    pub(super) fn given(&self) -> Result<Option<Key>, Failure> {
        match (&self.key, &self.passphrase_file) {
            (Some(file), _) => Ok(Some(Key::File(file.clone()))),
            (None, Some(file)) => passphrase_in(file).map(Some),
            (None, None) => Ok(None),
        }
    }

    /// The key, which must have been given.
    ///
    /// # Errors
    /// Where none was given, or the passphrase cannot be read or is too short.
    pub(super) fn needed(&self) -> Result<Key, Failure> {
        let none = || Failure::Configuration("give a key with --key FILE or --passphrase-file FILE".into());
        self.given()?.ok_or_else(none)
    }
}

fn passphrase_in(file: &Path) -> Result<Key, Failure> {
    let named = |reason: String| Failure::Configuration(format!("{}: {reason}", file.display()));
    let text = fs::read_to_string(file).map_err(|error| named(error.to_string()))?;
    let phrase = text.lines().next().unwrap_or_default().to_owned();
    if phrase.len() < SHORTEST_PASSPHRASE {
        return Err(named(format!(
            "its first line is shorter than the {SHORTEST_PASSPHRASE} letters that a passphrase needs"
        )));
    }
    Ok(Key::Passphrase(SecretString::from(phrase)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_short_passphrase_is_refused_and_a_missing_key_is_asked_for() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("phrase");
        let arguments = KeyArguments { key: None, passphrase_file: Some(file.clone()) };
        assert!(arguments.given().unwrap_err().to_string().contains("phrase"));
        fs::write(&file, "too short\n").unwrap();
        assert!(arguments.given().unwrap_err().to_string().contains("12 letters"));
        fs::write(&file, "correct horse battery\nmore").unwrap();
        assert!(matches!(arguments.needed().unwrap(), Key::Passphrase(_)));
        assert!(KeyArguments::default().given().unwrap().is_none());
        assert!(KeyArguments::default().needed().unwrap_err().to_string().contains("--key"));
    }
}
