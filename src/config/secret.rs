//! Encrypts and decrypts profiles with age (age-encryption.org/v1): with a key file of age's own, or a passphrase.
//!
//! Never writes a key anywhere, and never keeps a passphrase longer than it is needed.

use age::secrecy::SecretString;
use std::fs;
use std::io::Read;
use std::path::{Path, PathBuf};
use std::str::FromStr;
use thiserror::Error;

/// Why a file cannot be encrypted or decrypted.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum SecretError {
    /// A file cannot be read or written.
    #[error("{path}: {source}")]
    File {
        /// Which file.
        path: PathBuf,
        /// Why.
        source: std::io::Error,
    },
    /// The key file holds no key.
    #[error("{path} holds no age key: a line that begins with AGE-SECRET-KEY-1 is needed (`age-keygen` makes one)")]
    NoKey {
        /// Which file.
        path: PathBuf,
    },
    /// The key does not fit.
    #[error("{path} cannot be decrypted: {reason}. Is this the key that it was encrypted with?")]
    WrongKey {
        /// Which file.
        path: PathBuf,
        /// The reason that age gives.
        reason: String,
    },
    /// It cannot be encrypted.
    #[error("{path} cannot be encrypted: {reason}")]
    Encryption {
        /// Which file.
        path: PathBuf,
        /// Why.
        reason: String,
    },
}

/// What opens and closes a file.
#[derive(Clone, Debug)]
pub enum Key {
    /// A file with an age key (`AGE-SECRET-KEY-1...`).
    File(PathBuf),
    /// A passphrase.
    Passphrase(SecretString),
}

fn file_error(path: &Path) -> impl FnOnce(std::io::Error) -> SecretError {
    let path = path.to_path_buf();
    move |source| SecretError::File { path, source }
}

fn identity_in(path: &Path) -> Result<age::x25519::Identity, SecretError> {
    let text = fs::read_to_string(path).map_err(file_error(path))?;
    let line = text.lines().map(str::trim).find(|line| line.starts_with("AGE-SECRET-KEY-1"));
    line.and_then(|line| age::x25519::Identity::from_str(line).ok())
        .ok_or_else(|| SecretError::NoKey { path: path.to_path_buf() })
}

impl Key {
    /// Encrypts `plain`; `path` is what errors call it.
    ///
    /// # Errors
    /// [`SecretError`] where the key cannot be read or used.
    pub fn encrypt(&self, path: &Path, plain: &[u8]) -> Result<Vec<u8>, SecretError> {
        let encrypted = match self {
            Self::File(file) => age::encrypt(&identity_in(file)?.to_public(), plain),
            Self::Passphrase(phrase) => age::encrypt(&age::scrypt::Recipient::new(phrase.clone()), plain),
        };
        encrypted.map_err(|error| SecretError::Encryption { path: path.to_path_buf(), reason: error.to_string() })
    }

    /// Decrypts `secret`; `path` is what errors call it.
    ///
    /// # Errors
    /// [`SecretError::WrongKey`] where the key does not fit.
    pub fn decrypt(&self, path: &Path, secret: &[u8]) -> Result<Vec<u8>, SecretError> {
        let decrypted = match self {
            Self::File(file) => age::decrypt(&identity_in(file)?, secret),
            Self::Passphrase(phrase) => age::decrypt(&age::scrypt::Identity::new(phrase.clone()), secret),
        };
        decrypted.map_err(|error| SecretError::WrongKey { path: path.to_path_buf(), reason: error.to_string() })
    }
}

impl Key {
    /// Decrypts what is intact of a long file: its beginning, and why the rest cannot be opened, where it was cut or
    /// damaged. Each piece that comes out is one that was put in: age seals them one by one.
    ///
    /// # Errors
    /// [`SecretError::WrongKey`] where the key does not fit or the beginning itself is damaged.
    pub fn decrypt_what_is_intact(&self, path: &Path, secret: &[u8]) -> Result<(Vec<u8>, Option<String>), SecretError> {
        let identity: Box<dyn age::Identity> = match self {
            Self::File(file) => Box::new(identity_in(file)?),
            Self::Passphrase(phrase) => Box::new(age::scrypt::Identity::new(phrase.clone())),
        };
        let refused = |error: age::DecryptError| SecretError::WrongKey { path: path.into(), reason: error.to_string() };
        let decryptor = age::Decryptor::new_buffered(secret).map_err(refused)?;
        let mut reader = decryptor.decrypt(std::iter::once(identity.as_ref())).map_err(refused)?;
        let mut plain = Vec::new();
        let damage = reader.read_to_end(&mut plain).err().map(|error| error.to_string());
        Ok((plain, damage))
    }
}

/// Reads a file that may be encrypted.
///
/// # Errors
/// [`SecretError`] where it cannot be read, or where it is encrypted and the key does not fit.
pub fn read_secret(path: &Path, key: &Key) -> Result<Vec<u8>, SecretError> {
    key.decrypt(path, &fs::read(path).map_err(file_error(path))?)
}

/// Writes a file so that it is either the old or the new one, whatever happens in between.
///
/// # Errors
/// [`SecretError::File`] names the file and the reason.
pub fn write_whole(path: &Path, bytes: &[u8]) -> Result<(), SecretError> {
    let beside = path.with_extension("new");
    fs::write(&beside, bytes).map_err(file_error(&beside))?;
    fs::rename(&beside, path).map_err(file_error(path))
}

#[cfg(test)]
mod tests {
    use super::*;
    use age::secrecy::ExposeSecret;

    fn key_file(folder: &Path, name: &str) -> Key {
        let path = folder.join(name);
        let key = age::x25519::Identity::generate();
        fs::write(&path, format!("# made by a test\n{}\n", key.to_string().expose_secret())).unwrap();
        Key::File(path)
    }

    #[test]
    fn what_a_key_file_closes_it_opens_and_another_does_not() {
        let folder = tempfile::tempdir().unwrap();
        let (right, wrong) = (key_file(folder.path(), "a"), key_file(folder.path(), "b"));
        let secret = right.encrypt(Path::new("p-01.toml"), b"version = 1").unwrap();
        assert!(secret.starts_with(b"age-encryption.org/v1"));
        assert_eq!(right.decrypt(Path::new("x"), &secret).unwrap(), b"version = 1");
        let error = wrong.decrypt(Path::new("p-01.toml.age"), &secret).unwrap_err();
        assert!(matches!(error, SecretError::WrongKey { .. }) && error.to_string().contains("p-01.toml.age"));
    }

    #[test]
    fn a_cut_secret_is_refused_whole() {
        let folder = tempfile::tempdir().unwrap();
        let key = key_file(folder.path(), "a");
        let secret = key.encrypt(Path::new("x"), &[7; 500]).unwrap();
        for length in [0, 10, secret.len() / 2, secret.len() - 1] {
            assert!(key.decrypt(Path::new("x"), &secret[..length]).is_err(), "{length}");
        }
    }

    #[test]
    fn the_beginning_of_a_cut_secret_is_read_and_a_wrong_key_reads_nothing() {
        let folder = tempfile::tempdir().unwrap();
        let (right, wrong) = (key_file(folder.path(), "a"), key_file(folder.path(), "b"));
        let plain: Vec<u8> = (0_u32..300_000).map(|number| u8::try_from(number % 251).unwrap()).collect();
        let secret = right.encrypt(Path::new("x"), &plain).unwrap();
        assert_eq!(right.decrypt_what_is_intact(Path::new("x"), &secret).unwrap(), (plain.clone(), None));
        let (read, damage) = right.decrypt_what_is_intact(Path::new("x"), &secret[..secret.len() / 2]).unwrap();
        assert!(read.len() > 60_000 && plain.starts_with(&read) && damage.is_some(), "{}: {damage:?}", read.len());
        assert!(wrong.decrypt_what_is_intact(Path::new("x"), &secret).is_err());
    }

    #[test]
    fn a_file_without_a_key_says_what_is_needed() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("empty");
        fs::write(&path, "nothing").unwrap();
        let error = Key::File(path).encrypt(Path::new("x"), b"x").unwrap_err().to_string();
        assert!(error.contains("AGE-SECRET-KEY-1"), "{error}");
    }
}
