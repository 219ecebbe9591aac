//! Where files are looked for: the XDG folders, `/etc`, `/usr/share`, and what is built into the binary.

use super::builtin;
use std::env;
use std::path::{Path, PathBuf};

/// The folders of settings and data.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Places {
    /// Candidates for the file of settings, the first that exists counts.
    pub settings: Vec<PathBuf>,
    /// Folders of profiles, in the order in which they are searched.
    pub profiles: Vec<PathBuf>,
    /// Where trials are recorded unless a folder is given.
    pub trials: PathBuf,
    /// Where simulated trials are recorded unless a folder is given.
    pub demos: PathBuf,
    /// Where the program writes its own log.
    pub logs: PathBuf,
}

impl Places {
    /// The places of this machine and user: `$XDG_CONFIG_HOME/valet/config.toml`, then `/etc/valet/config.toml`; profiles
    /// in `profiles/` here, `$XDG_DATA_HOME/valet/profiles`, `/usr/share/valet/profiles`; trials in
    /// `$XDG_DATA_HOME/valet/trials`, simulated ones in `$XDG_DATA_HOME/valet/demos`; the program's log in
    /// `$XDG_STATE_HOME/valet/logs`.
    #[must_use]
    pub fn of_this_machine() -> Self {
        let home = env::var_os("HOME").map(PathBuf::from).unwrap_or_default();
        let folder = |variable: &str, otherwise: &str| {
            let given = env::var_os(variable).map(PathBuf::from).filter(|path| path.is_absolute());
            given.unwrap_or_else(|| home.join(otherwise)).join("valet")
        };
        let data = folder("XDG_DATA_HOME", ".local/share");
        Self {
            settings: vec![folder("XDG_CONFIG_HOME", ".config").join("config.toml"), "/etc/valet/config.toml".into()],
            profiles: vec!["profiles".into(), data.join("profiles"), "/usr/share/valet/profiles".into()],
            trials: data.join("trials"),
            demos: data.join("demos"),
            logs: folder("XDG_STATE_HOME", ".local/state").join("logs"),
        }
    }

    /// The file of a profile: `NAME.toml`, or `NAME.toml.age` where it is encrypted.
    #[must_use]
    pub fn profile_file(&self, name: &str) -> Option<PathBuf> {
        let candidates = self
            .profiles
            .iter()
            .flat_map(|folder| [folder.join(format!("{name}.toml")), folder.join(format!("{name}.toml.age"))]);
        candidates.into_iter().find(|path| path.is_file())
    }

    /// The folders of profiles in words.
    #[must_use]
    pub fn profile_folders(&self) -> String {
        self.profiles.iter().map(|folder| folder.display().to_string()).collect::<Vec<_>>().join(", ")
    }
}

/// The names of all profiles that can be loaded, in order.
#[must_use]
pub fn profile_names(places: &Places) -> Vec<String> {
    let mut names: Vec<String> = builtin::PROFILES.iter().map(|(name, _)| (*name).to_owned()).collect();
    for folder in &places.profiles {
        let Ok(entries) = std::fs::read_dir(folder) else { continue };
        names.extend(entries.flatten().filter_map(|entry| name_of(&entry.path())));
    }
    names.sort();
    names.dedup();
    names
}

fn name_of(path: &Path) -> Option<String> {
    let file = path.file_name()?.to_str()?;
    file.strip_suffix(".toml").or_else(|| file.strip_suffix(".toml.age")).map(str::to_owned)
}
