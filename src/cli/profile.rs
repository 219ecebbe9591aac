//! `valet profile`: check, show, encrypt, decrypt, export and forget people's data.

use super::exit::Failure;
use super::key::KeyArguments;
use super::output::Output;
use crate::config::{Key, LoadedProfile, Places, Profile, Settings, profile_names, read_secret, write_whole};
use crate::record::{JournalFile, close_journal, learned_in, read_header};
use crate::snapshot::Watermark;
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
        #[command(flatten)]
        key: KeyArguments,
    },
    /// Show a profile in words.
    Show {
        /// Name or file.
        profile: String,
        #[command(flatten)]
        key: KeyArguments,
    },
    /// Write what a recorded trial has learned into its person's profile, for the next trial to begin with.
    Learn {
        /// The journal (`*.mcap`).
        trial: PathBuf,
        /// Name or file; the person of the trial where it is not given.
        #[arg(long)]
        profile: Option<String>,
        #[command(flatten)]
        key: KeyArguments,
    },
    /// Encrypt a profile's file or a recorded trial; the plain file is removed.
    Encrypt {
        /// Name or file; a journal (`*.mcap`).
        profile: String,
        #[command(flatten)]
        key: KeyArguments,
    },
    /// Decrypt a profile's file or a recorded trial; the encrypted file is removed.
    Decrypt {
        /// The encrypted file (`*.toml.age`, `*.mcap.age`).
        file: PathBuf,
        #[command(flatten)]
        key: KeyArguments,
    },
    /// Print a profile without free text and dates.
    Export {
        /// Name or file.
        profile: String,
        #[command(flatten)]
        key: KeyArguments,
    },
    /// Erase a person's profile and trials, and print a receipt.
    Forget {
        /// The pseudonym.
        id: String,
        /// A folder of trials; may be given more than once. The default ones where it is not given.
        #[arg(long, value_name = "DIR")]
        trials: Vec<PathBuf>,
        /// Really erase. Without it, only what would be erased is listed.
        #[arg(long)]
        yes: bool,
        #[command(flatten)]
        key: KeyArguments,
        /// Print one JSON object a line.
        #[arg(long)]
        json: bool,
    },
}

fn named(path: &Path, reason: impl std::fmt::Display) -> Failure {
    Failure::Configuration(format!("{}: {reason}", path.display()))
}

pub(super) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let mut output = Output::new(false);
    let places = Places::of_this_machine();
    let find = |name: &str, key: &KeyArguments| {
        LoadedProfile::find_with(name, &places, key.given()?.as_ref()).map_err(Failure::configuration)
    };
    match &arguments.action {
        Action::List => profile_names(&places).into_iter().try_for_each(|name| output.line(name)),
        Action::Check { profile, key } => {
            let found = find(profile, key)?;
            // A setting of this person counts only together with those below it.
            let settings = Settings::find(None, &places).map_err(Failure::configuration)?;
            settings.setup_for(&found, 0, Watermark::Live).map_err(Failure::configuration)?;
            output.line(format!("{}: everything can be used (hash {})", found.path.display(), found.short_hash()))
        }
        Action::Show { profile, key } => show(&mut output, &find(profile, key)?),
        Action::Learn { trial, profile, key } => {
            let name = match profile {
                Some(name) => name.clone(),
                None => read_header(JournalFile::new(trial, key.given()?)).map_err(Failure::configuration)?.profile,
            };
            learn(&mut output, &find(&name, key)?, trial, key.given()?.as_ref())
        }
        Action::Encrypt { profile, key } if is_journal(Path::new(profile)) => {
            let closed = close_journal(Path::new(profile), &key.needed()?).map_err(Failure::configuration)?;
            output.line(format!("encrypted: {}", closed.display()))
        }
        Action::Encrypt { profile, key } => {
            encrypt(&mut output, &find(profile, &KeyArguments::default())?, &key.needed()?)
        }
        Action::Decrypt { file, key } => decrypt(&mut output, file, &key.needed()?),
        Action::Export { profile, key } => output.line(exported(find(profile, key)?.profile)?.trim_end()),
        Action::Forget { id, trials, yes, key, json } => {
            let default = [places.trials.clone(), places.demos.clone()];
            let folders = if trials.is_empty() { &default[..] } else { trials };
            let key = key.given()?;
            let files = files_of(id, &places, folders, key.as_ref());
            if files.is_empty() {
                return Err(nothing_kept(id, &places, folders));
            }
            forget(&mut Output::new(*json), id, files, *yes)
        }
    }
}

/// Writes what a journal's trial has learned into a profile, and says what it is.
pub(super) fn learn(
    output: &mut Output,
    person: &LoadedProfile,
    trial: &Path,
    key: Option<&Key>,
) -> Result<(), Failure> {
    let learned = learned_in(JournalFile::new(trial, key.cloned())).map_err(Failure::configuration)?;
    let recorded = learned.spaces.iter().any(|(_, space)| space.is_some());
    let space = recorded.then(|| person.takes_space(&learned.spaces)).transpose();
    if let Err(reason) = &space {
        output.line(format!("The recorded movement is not kept: {reason}"))?;
    }
    let space = space.ok().flatten();
    if learned.paths.is_empty() && space.is_none() {
        return output.line(format!("{}: no arm was dressed to its end, nothing was learned", trial.display()));
    }
    person.add_learned(&learned.paths, space.as_ref(), key).map_err(Failure::configuration)?;
    if space.is_some() {
        output.line(format!("{}: the recorded movement space was written", person.path.display()))?;
    }
    for path in &learned.paths {
        output.line(format!(
            "{}: the next trial is offered the {} arm's path ({}, {:.1} N) of {}",
            person.path.display(),
            path.side,
            path.strategy,
            path.energy_newtons,
            path.trial
        ))?;
    }
    Ok(())
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
    if is_journal(&target) {
        write_whole(&target, &plain).map_err(Failure::fault)?;
        fs::remove_file(file).map_err(|error| named(file, error))?;
        return output.line(format!("{} is readable again", target.display()));
    }
    let text = String::from_utf8(plain).map_err(|error| named(file, error))?;
    LoadedProfile::parse(&target, &text).map_err(Failure::configuration)?;
    write_whole(&target, text.as_bytes()).map_err(Failure::fault)?;
    fs::remove_file(file).map_err(|error| named(file, error))?;
    output.line(format!("{} is readable again", target.display()))
}

fn is_journal(path: &Path) -> bool {
    path.extension().is_some_and(|extension| extension == "mcap")
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

/// Everything that is kept of a person: profile, journals and what stands beside them.
fn files_of(id: &str, places: &Places, trials: &[PathBuf], key: Option<&Key>) -> Vec<PathBuf> {
    let mut files: Vec<PathBuf> = places
        .profiles
        .iter()
        .flat_map(|folder| [folder.join(format!("{id}.toml")), folder.join(format!("{id}.toml.age"))])
        .filter(|path| path.is_file())
        .collect();
    files.extend(trials.iter().flat_map(|folder| trials_of(id, folder, key)));
    files
}

fn nothing_kept(id: &str, places: &Places, trials: &[PathBuf]) -> Failure {
    let folders: Vec<_> = trials.iter().map(|folder| folder.display().to_string()).collect();
    let (profiles, folders) = (places.profile_folders(), folders.join(", "));
    Failure::Configuration(format!("nothing is kept under {id}: looked in {profiles} and {folders}"))
}

fn forget(output: &mut Output, id: &str, files: Vec<PathBuf>, erase: bool) -> Result<(), Failure> {
    for path in files.iter().filter(|_| erase) {
        fs::remove_file(path).map_err(|error| named(path, error))?;
    }
    let word = if erase { "erased" } else { "would be erased (repeat with --yes)" };
    for path in &files {
        output.line(format!("{word}: {}", path.display()))?;
    }
    if erase {
        output.line(format!(
            "receipt: {} files of {id} were erased; copies elsewhere (backups, exports, reports) are not",
            files.len()
        ))?;
    }
    output.event(&Receipt { event: "forget", id, erased: erase, files })
}

/// The journals in a folder that are a person's: by what their header says, whatever they are called now; and all files,
/// as exports and damaged journals, that bear the pseudonym at the beginning of their name.
fn trials_of(id: &str, folder: &Path, key: Option<&Key>) -> Vec<PathBuf> {
    let Ok(entries) = fs::read_dir(folder) else { return Vec::new() };
    let mut files: Vec<PathBuf> = entries
        .flatten()
        .map(|entry| entry.path())
        .filter(|path| path.is_file() && (is_named_after(id, path) || is_journal_of(id, path, key)))
        .collect();
    files.sort();
    files
}

fn is_named_after(id: &str, path: &Path) -> bool {
    let name = path.file_name().and_then(|name| name.to_str()).unwrap_or_default();
    name.strip_prefix(id).is_some_and(|rest| rest.starts_with("-seed"))
}

fn is_journal_of(id: &str, path: &Path, key: Option<&Key>) -> bool {
    let plain = path.extension().filter(|extension| *extension == "age").map(|_| path.with_extension(""));
    is_journal(plain.as_deref().unwrap_or(path))
        && read_header(JournalFile::new(path, key.cloned())).is_ok_and(|header| header.profile == id)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::record::{Header, JournalWriter};
    use crate::supervisor::Setup;

    fn journal(folder: &Path, profile: &str) -> PathBuf {
        let setup = Setup { profile: profile.into(), ..Setup::default() };
        JournalWriter::create(folder, &Header::of(&setup, "", 0).unwrap()).unwrap().finish().unwrap()
    }

    #[test]
    fn forgetting_a_person_erases_profile_and_journals_under_any_name_and_nothing_else() {
        let folder = tempfile::tempdir().unwrap();
        let (profiles, trials) = (folder.path().join("profiles"), folder.path().join("trials"));
        fs::create_dir_all(&profiles).unwrap();
        let mine = journal(&trials, "p-01");
        let renamed = trials.join("monday.mcap");
        fs::rename(journal(&trials, "p-01"), &renamed).unwrap();
        let other = journal(&trials, "p-011");
        fs::write(profiles.join("p-01.toml"), "version = 1\npseudonym = \"p-01\"\n").unwrap();
        let places = Places {
            settings: Vec::new(),
            profiles: vec![profiles.clone()],
            trials: trials.clone(),
            demos: folder.path().join("demos"),
            logs: folder.path().join("logs"),
        };
        let mut output = Output::new(true);
        let folders = [trials];
        let kept = |key: Option<&Key>| files_of("p-01", &places, &folders, key);
        forget(&mut output, "p-01", kept(None), false).unwrap();
        assert!(mine.exists() && renamed.exists() && profiles.join("p-01.toml").exists());
        forget(&mut output, "p-01", kept(None), true).unwrap();
        assert!(!mine.exists() && !renamed.exists() && !profiles.join("p-01.toml").exists());
        assert!(other.exists());
        assert!(kept(None).is_empty());
        let words = nothing_kept("p-01", &places, &folders).to_string();
        assert!(words.contains("nothing is kept under p-01"), "{words}");
    }

    #[test]
    fn an_encrypted_journal_is_found_with_its_key_whatever_it_is_called() {
        let folder = tempfile::tempdir().unwrap();
        let key = Key::Passphrase("correct horse battery".to_owned().into());
        let closed = close_journal(&journal(folder.path(), "p-01"), &key).unwrap();
        let renamed = folder.path().join("monday.mcap.age");
        fs::rename(closed, &renamed).unwrap();
        assert!(trials_of("p-01", folder.path(), None).is_empty());
        assert_eq!(trials_of("p-01", folder.path(), Some(&key)), [renamed]);
    }

    #[test]
    fn an_exported_profile_has_no_free_text_and_no_date() {
        let text = "version = 1\npseudonym = \"p-01\"\nnotes = \"limps after a fall\"\n[consent]\nversion = \"2\"\n\
            date = \"2026-11-22\"\n[[learned]]\nside = \"left\"\nstrategy = \"force\"\ntrial = \"p-01-of-monday\"\n\
            energy_newtons = 3.0\nwaypoints = [[0, 0.0, [0.0, 0.0, 0.0]], [1, 1.0, [0.0, 0.0, 0.0]]]\n";
        let profile = LoadedProfile::parse(Path::new("p-01.toml"), text).unwrap().profile;
        let exported = exported(profile).unwrap();
        for word in ["limps", "2026", "monday", "consent"] {
            assert!(!exported.contains(word), "{word} in {exported}");
        }
        assert!(exported.contains("energy_newtons"));
    }
}
