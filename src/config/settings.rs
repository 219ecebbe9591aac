//! The file of settings: found by XDG, read, never written.

use super::{ConfigError, LoadedProfile, Places, Profile, layered, version};
use crate::body::{PerSide, Side};
use crate::console::ConsoleOptions;
use crate::modelling::{ArmSpace, FitSettings, MovementSpace};
use crate::snapshot::Watermark;
use crate::supervisor::{Setup, SupervisorSettings};
use serde::{Deserialize, Serialize};
use std::fs;
use std::path::{Path, PathBuf};
use toml::Table;

/// How a trial is recorded.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct RecordingSettings {
    /// Steps that may wait for the disk. 8192 are some ten seconds of a robot at full rate.
    pub queue: usize,
    /// Recording ends, and says so, when less than this is free on the disk, in megabytes.
    pub least_free_megabytes: u64,
    /// Whether depth images are recorded.
    pub depth: bool,
}

impl Default for RecordingSettings {
    fn default() -> Self {
        Self { queue: 8192, least_free_megabytes: 500, depth: false }
    }
}

/// What the file says beside the settings of the core.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
struct Outer {
    version: u32,
    profile: String,
    recording: RecordingSettings,
    console: ConsoleOptions,
}

impl Default for Outer {
    fn default() -> Self {
        Self {
            version: Settings::VERSION,
            profile: "default".into(),
            recording: RecordingSettings::default(),
            console: ConsoleOptions::default(),
        }
    }
}

/// The keys of [`Outer`]; every other key belongs to the core.
const OUTER_KEYS: [&str; 4] = ["version", "profile", "recording", "console"];

/// All settings.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Settings {
    outer: Outer,
    /// Settings of the core.
    pub core: SupervisorSettings,
    layers: Vec<(PathBuf, Table)>,
}

impl Settings {
    /// The newest version of the format.
    pub const VERSION: u32 = 1;

    /// Reads the file that is given, or the first one that exists, or takes the defaults.
    ///
    /// # Errors
    /// [`ConfigError`] names file and key.
    pub fn find(given: Option<&Path>, places: &Places) -> Result<Self, ConfigError> {
        match given.map(Path::to_path_buf).or_else(|| places.settings.iter().find(|path| path.is_file()).cloned()) {
            Some(path) => Self::read(&path),
            None => Ok(Self::default()),
        }
    }

    /// Reads a file of settings.
    ///
    /// # Errors
    /// [`ConfigError`] names file and key.
    pub fn read(path: &Path) -> Result<Self, ConfigError> {
        let text =
            fs::read_to_string(path).map_err(|source| ConfigError::Unreadable { path: path.to_path_buf(), source })?;
        Self::parse(path, &text)
    }

    /// Reads settings from their text; `path` is what errors call it.
    ///
    /// # Errors
    /// [`ConfigError`] names file and key.
    pub fn parse(path: &Path, text: &str) -> Result<Self, ConfigError> {
        version::check(path, text, Self::VERSION)?;
        let mut core: Table = text.parse().map_err(|error| ConfigError::syntax(path, &error))?;
        let outer: Table =
            OUTER_KEYS.into_iter().filter_map(|key| core.remove(key).map(|value| (key.into(), value))).collect();
        let settings = Self { outer: layered(&[(path, &outer)])?, ..Self::default() };
        settings.with_layer(path, &core)
    }

    /// These settings with another layer over those of the core: what a profile or the command line says.
    ///
    /// # Errors
    /// [`ConfigError`] names the layer's file and the key.
    pub fn with_layer(mut self, path: &Path, layer: &Table) -> Result<Self, ConfigError> {
        self.layers.push((path.to_path_buf(), layer.clone()));
        let layers: Vec<(&Path, &Table)> = self.layers.iter().map(|(path, layer)| (path.as_path(), layer)).collect();
        self.core = layered(&layers)?;
        Setup { settings: self.core.clone(), ..Setup::default() }
            .validate()
            .map_err(|error| ConfigError::value(path, error.key, error.reason))?;
        Ok(self)
    }

    /// The name of the profile that is used where none is chosen.
    #[must_use]
    pub fn profile(&self) -> &str {
        &self.outer.profile
    }

    /// How trials are recorded.
    #[must_use]
    pub const fn recording(&self) -> &RecordingSettings {
        &self.outer.recording
    }

    /// The console's options.
    #[must_use]
    pub const fn console(&self) -> &ConsoleOptions {
        &self.outer.console
    }

    /// What a supervisor starts with for a person: these settings under those of the profile.
    ///
    /// # Errors
    /// [`ConfigError`] names the file and key of a setting that is not usable.
    pub fn setup_for(&self, person: &LoadedProfile, seed: u64, watermark: Watermark) -> Result<Setup, ConfigError> {
        let profile = &person.profile;
        let mut settings = self.clone().with_layer(&person.path, &profile.settings)?.core;
        if let Some(strategy) = profile.strategy {
            settings.strategy = strategy;
        }
        if let Some(side) = profile.first_arm {
            settings.trial.first_arm = side;
        }
        Ok(Setup {
            settings,
            space: movement_space(profile),
            seed,
            watermark,
            profile: profile.pseudonym.clone(),
            profile_hash: person.short_hash(),
            warm_start: profile.learned.clone(),
            garment: profile.garment(None).map(|garment| garment.name.clone()).unwrap_or_default(),
            ..Setup::default()
        })
    }

    /// The default settings as a file, to be copied and changed.
    ///
    /// # Errors
    /// The reason in words where a default cannot be put into TOML.
    pub fn print_default() -> Result<String, String> {
        let outer = toml::to_string(&Outer::default()).map_err(|error| error.to_string())?;
        let core = toml::to_string(&SupervisorSettings::default()).map_err(|error| error.to_string())?;
        // Single values stand before tables in TOML: those of both parts first, then the tables.
        let split = |text: &str| {
            let tables = text.find("\n[").map_or(text.len(), |at| at + 1);
            let (values, tables) = text.split_at(tables);
            (values.trim_end().to_owned(), tables.trim_end().to_owned())
        };
        let ((outer, outer_tables), (core, core_tables)) = (split(&outer), split(&core));
        Ok(format!(
            "# Settings of valet with their defaults. Keep only what you change: what is not here keeps its default.\n\
             # Place: $XDG_CONFIG_HOME/valet/config.toml, else /etc/valet/config.toml. valet never writes this file.\n\
             # Lengths in metres, forces in newtons, angles in radians, times in seconds unless the key says otherwise.\n\
             {outer}\n{core}\n\n{outer_tables}\n\n{core_tables}\n"
        ))
    }
}

/// The movement space of the profile. A person who is simulated and has none yet moves about first, as a real one does
/// before the first trial; the seed is fixed, so that it is the same person in every trial.
fn movement_space(profile: &Profile) -> Option<MovementSpace> {
    const SEED: u64 = 1;
    if let Some(space) = &profile.movement_space {
        return Some(space.clone());
    }
    let seen = profile.simulated.as_ref()?.exercise(SEED);
    let fitted = |side| ArmSpace::fit(seen.get(side), &FitSettings::default(), SEED).ok();
    Some(MovementSpace { arms: PerSide { left: fitted(Side::Left)?, right: fitted(Side::Right)? } })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parse(text: &str) -> Result<Settings, ConfigError> {
        Settings::parse(Path::new("config.toml"), text)
    }

    #[test]
    fn the_printed_defaults_are_the_defaults() {
        let text = Settings::print_default().unwrap();
        let settings = parse(&text).unwrap();
        assert_eq!(settings.core, SupervisorSettings::default());
        assert_eq!(settings.outer, Outer::default());
    }

    #[test]
    fn the_profile_lies_over_the_file_of_settings() {
        let settings = parse("version = 1\n[window]\nthreshold_newtons = 6.0\nlength = 11\n").unwrap();
        let person =
            "version = 1\npseudonym = \"p-01\"\nfirst_arm = \"left\"\n[settings.window]\nthreshold_newtons = 3.5\n";
        let person = LoadedProfile::parse(Path::new("p-01.toml"), person).unwrap();
        let setup = settings.setup_for(&person, 7, Watermark::Demo).unwrap();
        assert_eq!(
            (setup.settings.window.length, setup.settings.window.threshold_newtons.to_bits()),
            (11, 3.5_f64.to_bits())
        );
        assert_eq!((setup.settings.trial.first_arm, setup.seed), (crate::body::Side::Left, 7));
    }

    #[test]
    fn mistakes_are_named_with_file_and_key() {
        for (text, words) in [
            ("version = 1\n[windows]\nlength = 3", "windows"),
            ("version = 1\n[window]\nlength = 0", "length"),
            ("version = 1\n[trial]\ngarment_reach_metres = 30.0", "trial.garment_reach_metres"),
            ("version = 1\n[recording]\nqueue = -1", "queue"),
            ("version = 9", "version"),
            ("profile = \"x\"", "version"),
        ] {
            let error = parse(text).unwrap_err().to_string();
            assert!(error.contains("config.toml") && error.contains(words), "{text}: {error}");
        }
        let person = "version = 1\npseudonym = \"p-01\"\n[settings.window]\nlengths = 3\n";
        let person = LoadedProfile::parse(Path::new("p-01.toml"), person).unwrap();
        let error = Settings::default().setup_for(&person, 1, Watermark::Live).unwrap_err().to_string();
        assert!(error.contains("p-01.toml") && error.contains("lengths"), "{error}");
    }
}
