//! What can be configured about the screen: theme, keys, frame rate, glyphs, mouse and bell.
//!
//! Plain serde data, embedded by the configuration file as its `[console]` table. Never written by valet.

use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// Which colours are used.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum ThemeName {
    /// The terminal's own 16 colours.
    #[default]
    Terminal,
    /// Bright on black, for a bad screen or tired eyes.
    HighContrast,
    /// No colour at all: bold, underline and reverse only.
    Mono,
    /// The colour-blind-safe set of Okabe and Ito (2008), in true colour.
    OkabeIto,
}

/// Whether colour is used, as `--color` says.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum ColourChoice {
    /// Yes, unless `NO_COLOR` is set or the terminal is dumb.
    #[default]
    Auto,
    /// Yes.
    Always,
    /// No: the theme is mono.
    Never,
}

/// Which glyphs are used.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum GlyphChoice {
    /// Unicode where the locale says UTF-8, else ASCII.
    #[default]
    Auto,
    /// Unicode with braille plots.
    Unicode,
    /// ASCII only.
    Ascii,
}

/// One key or several, as they stand in a configuration file.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(untagged)]
pub enum KeyNames {
    /// One.
    One(String),
    /// Several, or none.
    Several(Vec<String>),
}

impl KeyNames {
    /// The names, one by one.
    pub fn iter(&self) -> impl Iterator<Item = &str> {
        match self {
            Self::One(name) => std::slice::from_ref(name),
            Self::Several(names) => names.as_slice(),
        }
        .iter()
        .map(String::as_str)
    }
}

/// Everything that can be configured about the screen.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct ConsoleOptions {
    /// Colours.
    pub theme: ThemeName,
    /// Whether colour is used at all.
    pub colour: ColourChoice,
    /// Glyphs.
    pub glyphs: GlyphChoice,
    /// Frames a second at the most, from 1 to 30: 10 is right for a slow ssh line.
    pub frames_per_second: u32,
    /// Whether the mouse focuses and scrolls. It takes the terminal's own selection away.
    pub mouse: bool,
    /// Whether the terminal's bell rings at a resistance and at a stop.
    pub bell: bool,
    /// Differences to the key table: action name to key or keys.
    pub keys: BTreeMap<String, KeyNames>,
}

impl Default for ConsoleOptions {
    fn default() -> Self {
        Self {
            theme: ThemeName::default(),
            colour: ColourChoice::default(),
            glyphs: GlyphChoice::default(),
            frames_per_second: 30,
            mouse: false,
            bell: false,
            keys: BTreeMap::new(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_printed_default_is_read_back_as_the_default() {
        let text = toml::to_string(&ConsoleOptions::default()).unwrap();
        assert_eq!(toml::from_str::<ConsoleOptions>(&text).unwrap(), ConsoleOptions::default());
        assert_eq!(toml::from_str::<ConsoleOptions>("").unwrap(), ConsoleOptions::default());
    }

    #[test]
    fn a_key_may_be_one_or_several_and_an_unknown_setting_is_named() {
        let options: ConsoleOptions = toml::from_str("[keys]\nfreeze = \"F\"\nquit = [\"q\", \"ctrl-d\"]").unwrap();
        let keys: Vec<&str> = options.keys.values().flat_map(KeyNames::iter).collect();
        assert_eq!(keys, ["F", "q", "ctrl-d"]);
        let error = toml::from_str::<ConsoleOptions>("them = \"mono\"").unwrap_err().to_string();
        assert!(error.contains("them"), "{error}");
    }
}
