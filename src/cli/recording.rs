//! Whether and where trials are recorded: by default always, into the folder of this user; loudly said where not.

use super::exit::Failure;
use crate::config::{Key, LoadedProfile, RecordingSettings};
use crate::record::{Header, JournalError, JournalWriter, Recorder, Told, close_journal};
use crate::supervisor::Setup;
use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::time::{SystemTime, UNIX_EPOCH};

/// Where trials are recorded.
#[derive(Clone, Debug, Default, clap::Args)]
pub(super) struct RecordArguments {
    /// Record into this folder instead of the one of this user (`$XDG_DATA_HOME/valet/trials`, the demo's in `demos`).
    #[arg(long, value_name = "DIR", conflicts_with = "no_record")]
    record: Option<PathBuf>,
    /// Record nothing. What is not recorded cannot be shown, replayed or explained afterwards.
    #[arg(long)]
    no_record: bool,
}

/// A place to record into.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Recording {
    folder: PathBuf,
    /// True where the operator named the folder.
    is_asked: bool,
    /// The most journals that are kept: simulated trials can be made again from their seeds.
    keep: Option<usize>,
    settings: RecordingSettings,
}

/// Journals of simulated trials that are kept in the default folder.
const DEMOS_KEPT: usize = 20;

impl RecordArguments {
    /// Where to record trials with a robot; `None` where the operator refused it.
    pub(super) fn of_trials(&self, default: &Path, settings: &RecordingSettings) -> Option<Recording> {
        self.place(default, None, settings)
    }

    /// Where to record simulated trials: of those in the default folder only the newest are kept.
    pub(super) fn of_demos(&self, default: &Path, settings: &RecordingSettings) -> Option<Recording> {
        self.place(default, Some(DEMOS_KEPT), settings)
    }

    /// Takes a folder that comes from elsewhere, where nothing was typed. True where there was one.
    pub(super) fn take_folder(&mut self, folder: impl FnOnce() -> Option<PathBuf>) -> bool {
        if self.no_record || self.record.is_some() {
            return false;
        }
        self.record = folder();
        self.record.is_some()
    }

    fn place(&self, default: &Path, keep: Option<usize>, settings: &RecordingSettings) -> Option<Recording> {
        if self.no_record {
            warn("--no-record: NOTHING IS RECORDED. This trial cannot be shown, replayed or explained afterwards");
            return None;
        }
        let folder = self.record.clone().unwrap_or_else(|| default.to_path_buf());
        let is_asked = self.record.is_some();
        Some(Recording { folder, is_asked, keep: keep.filter(|_| !is_asked), settings: settings.clone() })
    }
}

impl Recording {
    /// Begins a journal behind a queue, beside a robot.
    ///
    /// # Errors
    /// Where the folder cannot be written to: a trial that nobody can look at afterwards is not begun by oversight.
    pub(super) fn start(&self, setup: &Setup, person: &LoadedProfile, told: Told) -> Result<Recorder, Failure> {
        self.make_room();
        let began = SystemTime::now().duration_since(UNIX_EPOCH).unwrap_or_default();
        let began = u64::try_from(began.as_nanos()).unwrap_or_default();
        let header = Header::of(setup, text_for_journals(person), began).map_err(Failure::Fault)?;
        Recorder::start(&self.folder, &header, &self.settings, told).map_err(|error| self.refusal(&error))
    }

    /// Begins a journal in virtual time. Where nobody asked for it and the folder cannot be written to, the trial runs
    /// without one and says so: its seed brings it back.
    ///
    /// # Errors
    /// Where the folder that the operator named cannot be written to.
    pub(super) fn write(&self, setup: &Setup, person: &LoadedProfile) -> Result<Option<JournalWriter>, Failure> {
        self.make_room();
        let header = Header::of(setup, text_for_journals(person), 0).map_err(Failure::Fault)?;
        match JournalWriter::create(&self.folder, &header) {
            Ok(journal) => Ok(Some(journal)),
            Err(error) if self.is_asked => Err(Failure::configuration(error)),
            Err(error) => {
                warn(&format!("this simulated trial is not recorded: {error}"));
                Ok(None)
            }
        }
    }

    /// Whether depth images are recorded too.
    pub(super) const fn has_depth(&self) -> bool {
        self.settings.depth
    }

    fn refusal(&self, error: &JournalError) -> Failure {
        let help = if self.is_asked { "" } else { "; name another folder with --record DIR, or run with --no-record" };
        Failure::Configuration(format!("{error}{help}"))
    }

    /// Takes the oldest journals out of the default folder of simulated trials, so that the next one fits.
    fn make_room(&self) {
        let Some(keep) = self.keep else { return };
        let Ok(entries) = fs::read_dir(&self.folder) else { return };
        let aged = |path: PathBuf| Some((fs::metadata(&path).ok()?.modified().ok()?, path));
        let journals = entries.flatten().map(|entry| entry.path());
        let journals = journals.filter(|path| path.extension().is_some_and(|extension| extension == "mcap"));
        let mut journals: Vec<_> = journals.filter_map(aged).collect();
        journals.sort();
        let surplus = (journals.len() + 1).saturating_sub(keep);
        for (_, path) in journals.iter().take(surplus) {
            // Another demo may have taken it out already.
            let _ = fs::remove_file(path);
        }
    }
}

/// Closes the finished journal of a person whose profile is encrypted with the key that opened it; any other stays as it is.
/// Returns where the journal is now.
///
/// # Errors
/// Where the closed file cannot be written: the plain one is kept then, and is named.
pub(super) fn sealed(journal: PathBuf, person: &LoadedProfile, key: Option<&Key>) -> Result<PathBuf, Failure> {
    let Some(key) = key.filter(|_| person.is_encrypted) else { return Ok(journal) };
    let plain = |error: JournalError| Failure::Fault(format!("{error}. {} is left unencrypted", journal.display()));
    close_journal(&journal, key).map_err(plain)
}

/// The profile's text as journals keep it: none where the profile is encrypted at rest, its hash alone tells it then.
fn text_for_journals(person: &LoadedProfile) -> &str {
    if person.is_encrypted { "" } else { &person.text }
}

/// Says something on stderr that must not be overlooked.
pub(super) fn warn(text: &str) {
    // Nothing can be done where even stderr is gone.
    let _ = writeln!(std::io::stderr(), "valet: {text}");
}

#[cfg(test)]
mod tests {
    use super::*;

    fn recording(arguments: &RecordArguments, folder: &Path) -> Option<Recording> {
        arguments.of_demos(folder, &RecordingSettings::default())
    }

    #[test]
    fn every_trial_is_recorded_unless_that_is_refused() {
        let place = recording(&RecordArguments::default(), Path::new("demos")).unwrap();
        assert_eq!((place.folder.as_path(), place.keep), (Path::new("demos"), Some(DEMOS_KEPT)));
        let asked = RecordArguments { record: Some("here".into()), no_record: false };
        let place = recording(&asked, Path::new("demos")).unwrap();
        assert_eq!((place.folder.as_path(), place.keep), (Path::new("here"), None));
        assert_eq!(recording(&RecordArguments { record: None, no_record: true }, Path::new("demos")), None);
    }

    #[test]
    fn only_journals_of_the_default_folder_of_demos_make_room() {
        let folder = tempfile::tempdir().unwrap();
        for number in 0..30 {
            fs::write(folder.path().join(format!("{number:02}.mcap")), "x").unwrap();
        }
        fs::write(folder.path().join("notes.txt"), "x").unwrap();
        let count = || fs::read_dir(folder.path()).unwrap().count();
        let asked = RecordArguments { record: Some(folder.path().into()), no_record: false };
        recording(&asked, Path::new("elsewhere")).unwrap().make_room();
        assert_eq!(count(), 31);
        recording(&RecordArguments::default(), folder.path()).unwrap().make_room();
        assert_eq!(count(), DEMOS_KEPT - 1 + 1);
        assert!(folder.path().join("notes.txt").exists());
    }

    #[test]
    fn a_folder_that_cannot_be_written_to_is_named_with_what_helps() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("file");
        fs::write(&file, "x").unwrap();
        let person = LoadedProfile::parse(Path::new("x.toml"), "version = 1\npseudonym = \"p-01\"\n").unwrap();
        let place = recording(&RecordArguments::default(), &file.join("demos")).unwrap();
        let error = place.start(&Setup::default(), &person, Box::new(|_| {})).unwrap_err().to_string();
        assert!(error.contains("file/demos") && error.contains("--no-record"), "{error}");
        assert!(place.write(&Setup::default(), &person).unwrap().is_none());
        let asked = RecordArguments { record: Some(file.join("demos")), no_record: false };
        assert!(recording(&asked, Path::new("x")).unwrap().write(&Setup::default(), &person).is_err());
    }
}
