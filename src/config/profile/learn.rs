//! Writes what a trial has learned into a person's profile, so that the next trial can begin with it.

use super::{LearnedPath, LoadedProfile};
use crate::body::PerSide;
use crate::config::{ConfigError, Key, write_whole};
use crate::modelling::{ArmSpace, MovementSpace};
use serde::Serialize;

#[derive(Serialize)]
struct Addition<'a> {
    #[serde(skip_serializing_if = "<[_]>::is_empty")]
    learned: &'a [LearnedPath],
    #[serde(skip_serializing_if = "Option::is_none")]
    movement_space: Option<&'a MovementSpace>,
}

impl LoadedProfile {
    /// True where the profile is a person's own file: what is built in or simulated keeps nothing.
    #[must_use]
    pub fn keeps_learned(&self) -> bool {
        self.profile.simulated.is_none() && self.path.is_file()
    }

    /// The movement space that was recorded, where this profile can take it: both arms were recorded, and it has none yet.
    ///
    /// # Errors
    /// What keeps it out, and what to do, in words.
    pub fn takes_space(&self, recorded: &PerSide<Option<ArmSpace>>) -> Result<MovementSpace, String> {
        let [left, right] = [&recorded.left, &recorded.right];
        let (Some(left), Some(right)) = (left, right) else {
            return Err("a movement space needs both arms: record the other one in the same session".into());
        };
        if self.profile.movement_space.is_some() {
            return Err(format!(
                "{} has a movement space already, which stays: remove its `movement_space` tables to take the new one",
                self.path.display()
            ));
        }
        Ok(MovementSpace { arms: PerSide { left: left.clone(), right: right.clone() } })
    }

    /// Adds learned paths and a movement space at the end of the profile's file; comments and order of what stands there stay. An encrypted
    /// profile is encrypted again with `key`.
    ///
    /// # Errors
    /// [`ConfigError`] names the file and the key where the profile is no file, where it could not be read any more with
    /// the addition, or where it cannot be written.
    pub fn add_learned(
        &self,
        learned: &[LearnedPath],
        movement_space: Option<&MovementSpace>,
        key: Option<&Key>,
    ) -> Result<Self, ConfigError> {
        let refused = |reason: String| ConfigError::value(&self.path, "learned", reason);
        if !self.path.is_file() {
            return Err(refused(
                "this profile is built in and has no file: save it with `valet profile export` first".into(),
            ));
        }
        let addition =
            toml::to_string(&Addition { learned, movement_space }).map_err(|error| refused(error.to_string()))?;
        let text = format!("{}\n\n{addition}", self.text.trim_end());
        // A file that cannot be read back must never be written.
        let mut changed = Self::parse(&self.path, &text)?;
        let bytes = match (self.is_encrypted, key) {
            (false, _) => text.into_bytes(),
            (true, Some(key)) => {
                key.encrypt(&self.path, text.as_bytes()).map_err(|error| refused(error.to_string()))?
            }
            (true, None) => return Err(ConfigError::Encrypted { path: self.path.clone() }),
        };
        write_whole(&self.path, &bytes).map_err(|error| refused(error.to_string()))?;
        changed.is_encrypted = self.is_encrypted;
        Ok(changed)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::body::Side;
    use crate::planning::ArmRelative;
    use crate::strategy::StrategyKind;
    use std::fs;
    use std::path::Path;

    fn path(trial: &str) -> LearnedPath {
        LearnedPath {
            side: Side::Right,
            strategy: StrategyKind::Force,
            trial: trial.into(),
            energy_newtons: 7.5,
            elbow: None,
            waypoints: vec![ArmRelative(0, 0.0, [0.0; 3]), ArmRelative(1, 1.0, [0.0, 0.02, 0.01])],
        }
    }

    fn profile_in(folder: &Path, text: &str) -> LoadedProfile {
        let file = folder.join("p-01.toml");
        fs::write(&file, text).unwrap();
        LoadedProfile::read(&file, None).unwrap()
    }

    #[test]
    fn what_is_learned_is_added_and_the_newest_is_offered() {
        let folder = tempfile::tempdir().unwrap();
        let text =
            "version = 1\npseudonym = \"p-01\"\n# stiff left elbow\n[settings.window]\nthreshold_newtons = 5.0\n";
        let before = profile_in(folder.path(), text);
        before.add_learned(&[path("one")], None, None).unwrap().add_learned(&[path("two")], None, None).unwrap();
        let after = LoadedProfile::read(&before.path, None).unwrap();
        assert!(after.text.starts_with(text.trim_end()), "{}", after.text);
        assert_eq!(after.profile.learned, [path("one"), path("two")]);
        assert_eq!(after.profile.settings, before.profile.settings);
        assert_eq!(after.profile.learned_path(Side::Right, StrategyKind::Force).unwrap().trial, "two");
        assert!(after.profile.learned_path(Side::Left, StrategyKind::Force).is_none());
    }

    #[test]
    fn a_recorded_movement_space_is_written_once_both_arms_are_there() {
        let folder = tempfile::tempdir().unwrap();
        let before = profile_in(folder.path(), "version = 1\npseudonym = \"p-01\"\n");
        let seen = crate::sim::person::SimulatedPerson::default().exercise(1);
        let fitted = |side| ArmSpace::fit(seen.get(side), &crate::modelling::FitSettings::default(), 1).unwrap();
        let one = PerSide { left: None, right: Some(fitted(Side::Right)) };
        assert!(before.takes_space(&one).unwrap_err().contains("other"));
        let both = PerSide::from_fn(|side| Some(fitted(side)));
        let space = before.takes_space(&both).unwrap();
        let after = before.add_learned(&[], Some(&space), None).unwrap();
        assert_eq!(after.profile.movement_space.as_ref(), Some(&space));
        assert_eq!(LoadedProfile::read(&before.path, None).unwrap().profile.movement_space, Some(space));
        assert!(after.takes_space(&both).unwrap_err().contains("already"));
    }

    #[test]
    fn a_profile_that_the_addition_would_break_stays_as_it_is() {
        let folder = tempfile::tempdir().unwrap();
        let text = "version = 1\npseudonym = \"p-01\"\nlearned = []\n";
        let before = profile_in(folder.path(), text);
        let error = before.add_learned(&[path("one")], None, None).unwrap_err().to_string();
        assert!(error.contains("p-01.toml"), "{error}");
        assert_eq!(fs::read_to_string(&before.path).unwrap(), text);
    }
}
