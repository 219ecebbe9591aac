//! `valet profile`: check, show, encrypt, decrypt, export and forget people's data.

use super::exit::Failure;
use super::output::Output;
use crate::config::{Key, LoadedProfile, Places, Profile, profile_names, read_secret, write_whole};
use age::secrecy::SecretString;
use clap::Subcommand;
use serde::Serialize;
use std::fs;
use std::path::{Path, PathBuf};

/// A person's profile: check, show, encrypt, forget.
#[derive(Debug, clap::Args)]
pub(super) struct Arguments {
    #[command(subcommand)]
    action: Action,
}

#[derive(Debug, Subcommand)]
enum Action {
    /// The profiles that can be found.
    List,
    /// Check a profile; every mistake is named with file and key.
    Check {
        /// Name or file.
        profile: String,
    },
    /// Show a profile in words.
    Show {
        /// Name or file.
        profile: String,
    },
    /// Encrypt a profile's file; the plain file is removed.
    Encrypt {
        /// Name or file.
        profile: String,
        #[command(flatten)]
        key: KeyArguments,
    },
    /// Decrypt a profile's file; the encrypted file is removed.
    Decrypt {
        /// The encrypted file (`*.toml.age`).
        file: PathBuf,
        #[command(flatten)]
        key: KeyArguments,
    },
    /// Print a profile without free text and dates.
    Export {
        /// Name or file.
        profile: String,
    },
    /// Erase a person's profile and trials, and print a receipt.
    Forget {
        /// The pseudonym.
        id: String,
        /// The folder of the trials; the default one where it is not given.
        #[arg(long, value_name = "DIR")]
        trials: Option<PathBuf>,
        /// Really erase. Without it, only what would be erased is listed.
        #[arg(long)]
        yes: bool,
        /// Print one JSON object a line.
        #[arg(long)]
        json: bool,
    },
}

#[derive(Debug, clap::Args)]
struct KeyArguments {
    /// A file with an age key.
    #[arg(long, value_name = "FILE", conflicts_with = "passphrase_file")]
    key: Option<PathBuf>,
    /// A file whose first line is the passphrase.
    #[arg(long, value_name = "FILE")]
    passphrase_file: Option<PathBuf>,
}

impl KeyArguments {
    fn key(&self) -> Result<Key, Failure> {
        match (&self.key, &self.passphrase_file) {
            (Some(file), _) => Ok(Key::File(file.clone())),
            (None, Some(file)) => {
                let text = fs::read_to_string(file).map_err(|error| named(file, error))?;
                let phrase = text.lines().next().unwrap_or_default().to_owned();
                if phrase.len() < 12 {
                    return Err(named(file, "its first line is shorter than the 12 letters that a passphrase needs"));
                }
                Ok(Key::Passphrase(SecretString::from(phrase)))
            }
            (None, None) => Err(Failure::Configuration("give a key with --key FILE or --passphrase-file FILE".into())),
        }
    }
}

fn named(path: &Path, reason: impl std::fmt::Display) -> Failure {
    Failure::Configuration(format!("{}: {reason}", path.display()))
}

pub(super) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let mut output = Output::new(false);
    let places = Places::of_this_machine();
    let find = |name: &str| LoadedProfile::find(name, &places).map_err(Failure::configuration);
    match &arguments.action {
        Action::List => profile_names(&places).into_iter().try_for_each(|name| output.line(name)),
        Action::Check { profile } => {
            let found = find(profile)?;
            output.line(format!("{}: everything can be used (hash {})", found.path.display(), found.short_hash()))
        }
        Action::Show { profile } => show(&mut output, &find(profile)?),
        Action::Encrypt { profile, key } => encrypt(&mut output, &find(profile)?, &key.key()?),
        Action::Decrypt { file, key } => decrypt(&mut output, file, &key.key()?),
        Action::Export { profile } => output.line(exported(find(profile)?.profile)?.trim_end()),
        Action::Forget { id, trials, yes, json } => {
            forget(&mut Output::new(*json), &places, id, trials.as_deref().unwrap_or(&places.trials), *yes)
        }
    }
}

fn show(output: &mut Output, found: &LoadedProfile) -> Result<(), Failure> {
    let profile = &found.profile;
    output.line(format!("{} ({}, hash {})", profile.pseudonym, found.path.display(), found.short_hash()))?;
    if !profile.notes.is_empty() {
        output.line(format!("notes: {}", profile.notes))?;
    }
    let consent = profile
        .consent
        .as_ref()
        .map_or("none recorded".to_owned(), |consent| format!("form {} of {}", consent.version, consent.date));
    output.line(format!("consent: {consent}"))?;
    output.line(format!("movement space: {}", if profile.movement_space.is_some() { "yes" } else { "none" }))?;
    output.line(format!("simulated: {}", if profile.simulated.is_some() { "yes" } else { "no" }))?;
    for garment in &profile.garments {
        output.line(format!("garment: {}", garment.name))?;
    }
    for path in &profile.learned {
        let (points, newtons) = (path.waypoints.len(), path.energy_newtons);
        output.line(format!(
            "learned: {} arm, {}, {points} way-points, {newtons:.1} N, from {}",
            path.side, path.strategy, path.trial
        ))?;
    }
    Ok(())
}

fn encrypt(output: &mut Output, found: &LoadedProfile, key: &Key) -> Result<(), Failure> {
    if !found.path.is_file() {
        return Err(Failure::Configuration(format!("{} is built in and has no file", found.profile.pseudonym)));
    }
    let target = PathBuf::from(format!("{}.age", found.path.display()));
    let secret = key.encrypt(&found.path, found.text.as_bytes()).map_err(Failure::configuration)?;
    write_whole(&target, &secret).map_err(Failure::fault)?;
    fs::remove_file(&found.path).map_err(|error| named(&found.path, error))?;
    output.line(format!("{} is encrypted; the plain file is gone", target.display()))
}

fn decrypt(output: &mut Output, file: &Path, key: &Key) -> Result<(), Failure> {
    if file.extension().is_none_or(|extension| extension != "age") {
        return Err(named(file, "an encrypted profile ends in .age"));
    }
    let plain = read_secret(file, key).map_err(Failure::configuration)?;
    let target = file.with_extension("");
    let text = String::from_utf8(plain).map_err(|error| named(file, error))?;
    LoadedProfile::parse(&target, &text).map_err(Failure::configuration)?;
    write_whole(&target, text.as_bytes()).map_err(Failure::fault)?;
    fs::remove_file(file).map_err(|error| named(file, error))?;
    output.line(format!("{} is readable again", target.display()))
}

/// A profile without free text and without dates.
fn exported(mut profile: Profile) -> Result<String, Failure> {
    profile.notes = String::new();
    profile.consent = None;
    profile.learned.iter_mut().for_each(|path| path.trial = String::new());
    toml::to_string(&profile).map_err(Failure::fault)
}

#[derive(Serialize)]
struct Receipt<'a> {
    event: &'static str,
    id: &'a str,
    erased: bool,
    files: Vec<PathBuf>,
}

fn forget(output: &mut Output, places: &Places, id: &str, trials: &Path, erase: bool) -> Result<(), Failure> {
    let mut files: Vec<PathBuf> = places
        .profiles
        .iter()
        .flat_map(|folder| [folder.join(format!("{id}.toml")), folder.join(format!("{id}.toml.age"))])
        .filter(|path| path.is_file())
        .collect();
    files.extend(trials_of(id, trials));
    if files.is_empty() {
        return Err(Failure::Configuration(format!(
            "nothing is kept under {id}: looked in {} and {}",
            places.profile_folders(),
            trials.display()
        )));
    }
    for path in files.iter().filter(|_| erase) {
        fs::remove_file(path).map_err(|error| named(path, error))?;
    }
    let word = if erase { "erased" } else { "would be erased (repeat with --yes)" };
    for path in &files {
        output.line(format!("{word}: {}", path.display()))?;
    }
    if erase {
        output.line(format!(
            "receipt: {} files of {id} were erased; copies elsewhere (backups, exports) are not",
            files.len()
        ))?;
    }
    output.event(&Receipt { event: "forget", id, erased: erase, files })
}

/// The files in the folder of trials that bear the pseudonym at the beginning of their name.
fn trials_of(id: &str, folder: &Path) -> Vec<PathBuf> {
    let Ok(entries) = fs::read_dir(folder) else { return Vec::new() };
    let belongs = |path: &PathBuf| {
        let name = path.file_name().and_then(|name| name.to_str()).unwrap_or_default();
        name.strip_prefix(id).is_some_and(|rest| rest.starts_with("-seed"))
    };
    let mut files: Vec<PathBuf> = entries.flatten().map(|entry| entry.path()).filter(belongs).collect();
    files.sort();
    files
}
