//! From keys to actions: the default table with the operator's differences, checked for conflicts by name.
//!
//! The stop keys cannot be taken away, only added to. They are met by the input thread before anything here.

mod chord;
mod table;

pub use chord::Chord;
pub use table::{Action, Entry, Guard, Scope, Screen, TABLE};

use super::options::KeyNames;
use ratatui::crossterm::event::KeyCode;
use std::collections::BTreeMap;
use thiserror::Error;

/// Why a `[console.keys]` table is not usable.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum KeyMapError {
    /// There is no such action.
    #[error("keys: there is no action \"{name}\"; `valet keys --list` names them all")]
    UnknownAction {
        /// The name that stands there.
        name: String,
    },
    /// That is no key.
    #[error("keys: \"{key}\" (for {action}) is no key: write a letter, space, enter, tab, up, page-up, f1 or ctrl-l")]
    UnknownKey {
        /// For which action.
        action: String,
        /// What stands there.
        key: String,
    },
    /// Two actions want the same key on the same screen.
    #[error("keys: \"{key}\" would mean both {first} and {second} ({place}): give one of them another key")]
    Conflict {
        /// The key.
        key: String,
        /// The first action.
        first: String,
        /// The second action.
        second: String,
        /// The screens that they share.
        place: String,
    },
    /// A terminal multiplexer or flow control takes the key before valet sees it.
    #[error("keys: \"{key}\" (for {action}) is taken by terminal multiplexers or flow control: choose another one")]
    Swallowed {
        /// For which action.
        action: String,
        /// The key.
        key: String,
    },
    /// A stop key must not be one that dialogs or letters need.
    #[error("keys: \"{key}\" cannot be a stop key: dialogs and text fields need it")]
    NoStopKey {
        /// The key.
        key: String,
    },
}

/// Control with these letters is eaten by tmux, screen or the terminal's flow control.
const SWALLOWED: [char; 6] = ['a', 'b', 'j', 'k', 's', 'q'];

/// The keys as they are in force.
#[derive(Clone, Debug)]
pub struct KeyMap {
    keys: Vec<(Chord, &'static Entry)>,
}

impl KeyMap {
    /// The default table with an operator's differences.
    ///
    /// # Errors
    /// A [`KeyMapError`] that names action and key.
    pub fn new(differences: &BTreeMap<String, KeyNames>) -> Result<Self, KeyMapError> {
        if let Some(name) = differences.keys().find(|name| !TABLE.iter().any(|entry| entry.name == name.as_str())) {
            return Err(KeyMapError::UnknownAction { name: name.clone() });
        }
        let mut keys = Vec::with_capacity(TABLE.len() * 2);
        for entry in TABLE {
            let different = differences.get(entry.name);
            if different.is_none() || entry.guard == Guard::Immediate {
                for key in entry.keys {
                    keys.push((read(entry, key)?, entry));
                }
            }
            for key in different.into_iter().flat_map(KeyNames::iter) {
                let chord = read(entry, key)?;
                if entry.guard == Guard::Immediate && is_needed_by_dialogs(chord) {
                    return Err(KeyMapError::NoStopKey { key: key.into() });
                }
                if !keys.contains_pair(chord, entry) {
                    keys.push((chord, entry));
                }
            }
        }
        let map = Self { keys };
        map.check()?;
        Ok(map)
    }

    /// What a key does on a screen.
    #[must_use]
    pub fn action(&self, chord: Chord, screen: Screen) -> Option<Action> {
        self.keys
            .iter()
            .find(|(key, entry)| *key == chord && entry.scope.contains(screen))
            .map(|(_, entry)| entry.action)
    }

    /// The emergency stop that a key is, wherever it is pressed.
    #[must_use]
    pub fn stop(&self, chord: Chord) -> Option<Action> {
        self.keys
            .iter()
            .find(|(key, entry)| *key == chord && entry.guard == Guard::Immediate)
            .map(|(_, entry)| entry.action)
    }

    /// The keys of an action, as they are written.
    #[must_use]
    pub fn keys_of(&self, action: Action) -> Vec<String> {
        self.keys.iter().filter(|(_, entry)| entry.action == action).map(|(chord, _)| chord.to_string()).collect()
    }

    /// The first key of an action, as it is written; empty where it has none.
    #[must_use]
    pub fn first_key(&self, action: Action) -> String {
        self.keys
            .iter()
            .find(|(_, entry)| entry.action == action)
            .map(|(chord, _)| chord.to_string())
            .unwrap_or_default()
    }

    fn check(&self) -> Result<(), KeyMapError> {
        for (index, (key, first)) in self.keys.iter().enumerate() {
            let same = |(other, second): &&(Chord, &'static Entry)| {
                other == key && first.scope.intersects(second.scope) && first.action != second.action
            };
            if let Some((_, second)) = self.keys.iter().skip(index + 1).find(same) {
                let shared: Vec<_> = Screen::ALL
                    .into_iter()
                    .filter(|screen| first.scope.contains(*screen) && second.scope.contains(*screen))
                    .map(Screen::name)
                    .collect();
                return Err(KeyMapError::Conflict {
                    key: key.to_string(),
                    first: first.name.into(),
                    second: second.name.into(),
                    place: shared.join(", "),
                });
            }
        }
        Ok(())
    }
}

/// Whether a list of keys already has a key for an entry.
trait ContainsPair {
    fn contains_pair(&self, chord: Chord, entry: &Entry) -> bool;
}

impl ContainsPair for Vec<(Chord, &'static Entry)> {
    fn contains_pair(&self, chord: Chord, entry: &Entry) -> bool {
        self.iter().any(|(key, known)| *key == chord && known.action == entry.action)
    }
}

fn read(entry: &Entry, key: &str) -> Result<Chord, KeyMapError> {
    let unknown = || KeyMapError::UnknownKey { action: entry.name.into(), key: key.into() };
    let chord = Chord::parse(key).ok_or_else(unknown)?;
    let swallowed = chord.control() && matches!(chord.code(), KeyCode::Char(letter) if SWALLOWED.contains(&letter));
    if swallowed {
        return Err(KeyMapError::Swallowed { action: entry.name.into(), key: key.into() });
    }
    Ok(chord)
}

fn is_needed_by_dialogs(chord: Chord) -> bool {
    let editing = matches!(
        chord.code(),
        KeyCode::Enter
            | KeyCode::Esc
            | KeyCode::Backspace
            | KeyCode::Tab
            | KeyCode::BackTab
            | KeyCode::Up
            | KeyCode::Down
            | KeyCode::Left
            | KeyCode::Right
    );
    let typed = chord.letter().is_some_and(char::is_alphanumeric);
    editing || typed
}

#[cfg(test)]
mod tests;
