//! One key with its modifiers: how it is written, read and met.

use ratatui::crossterm::event::{KeyCode, KeyEvent, KeyModifiers};
use std::fmt;

/// A key, with Control or without. Shift is part of a letter; Alt is not used, as terminals disagree about it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd)]
pub struct Chord {
    code: KeyCode,
    control: bool,
}

const NAMED: [(&str, KeyCode); 14] = [
    ("space", KeyCode::Char(' ')),
    ("enter", KeyCode::Enter),
    ("esc", KeyCode::Esc),
    ("tab", KeyCode::Tab),
    ("shift-tab", KeyCode::BackTab),
    ("backspace", KeyCode::Backspace),
    ("up", KeyCode::Up),
    ("down", KeyCode::Down),
    ("left", KeyCode::Left),
    ("right", KeyCode::Right),
    ("page-up", KeyCode::PageUp),
    ("page-down", KeyCode::PageDown),
    ("home", KeyCode::Home),
    ("end", KeyCode::End),
];

impl Chord {
    /// The key of an event; `None` where Alt or another modifier is held that no key of ours has.
    #[must_use]
    pub fn from_event(event: KeyEvent) -> Option<Self> {
        let foreign = KeyModifiers::ALT | KeyModifiers::SUPER | KeyModifiers::HYPER | KeyModifiers::META;
        if event.modifiers.intersects(foreign) {
            return None;
        }
        let control = event.modifiers.contains(KeyModifiers::CONTROL);
        let code = match event.code {
            KeyCode::Char(letter) if control => KeyCode::Char(letter.to_ascii_lowercase()),
            code => code,
        };
        Some(Self { code, control })
    }

    /// Reads a key as it is written in a configuration file: `p`, `R`, `space`, `ctrl-l`, `f1`.
    #[must_use]
    pub fn parse(text: &str) -> Option<Self> {
        if let Some(rest) = text.strip_prefix("ctrl-") {
            let plain = Self::parse(rest).filter(|chord| !chord.control)?;
            let code = match plain.code {
                KeyCode::Char(letter) => KeyCode::Char(letter.to_ascii_lowercase()),
                code => code,
            };
            return Some(Self { code, control: true });
        }
        let named = NAMED.iter().find(|(name, _)| *name == text).map(|(_, code)| *code);
        let code = named.or_else(|| function_key(text)).or_else(|| single_letter(text))?;
        Some(Self { code, control: false })
    }

    /// The letter that this key types into a text field, if any.
    #[must_use]
    pub const fn letter(&self) -> Option<char> {
        match self.code {
            KeyCode::Char(letter) if !self.control => Some(letter),
            _ => None,
        }
    }

    /// Which key it is, without Control.
    #[must_use]
    pub const fn code(&self) -> KeyCode {
        self.code
    }

    /// True where Control is held.
    #[must_use]
    pub const fn control(&self) -> bool {
        self.control
    }
}

fn function_key(text: &str) -> Option<KeyCode> {
    let number: u8 = text.strip_prefix('f')?.parse().ok()?;
    (1..=12).contains(&number).then_some(KeyCode::F(number))
}

fn single_letter(text: &str) -> Option<KeyCode> {
    let mut letters = text.chars();
    let letter = letters.next()?;
    (letters.next().is_none() && !letter.is_control() && !letter.is_whitespace()).then_some(KeyCode::Char(letter))
}

/// As it is written in a configuration file.
impl fmt::Display for Chord {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.control {
            formatter.write_str("ctrl-")?;
        }
        if let Some((name, _)) = NAMED.iter().find(|(_, code)| *code == self.code) {
            return formatter.write_str(name);
        }
        match self.code {
            KeyCode::Char(letter) => write!(formatter, "{letter}"),
            KeyCode::F(number) => write!(formatter, "f{number}"),
            other => write!(formatter, "{other}"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn keys_are_read_as_they_are_written() {
        for text in ["p", "R", "space", "ctrl-c", "f1", "shift-tab", "?", "/", "+", "page-up", "esc"] {
            assert_eq!(Chord::parse(text).unwrap().to_string(), text);
        }
        for text in ["", "pp", "f13", "ctrl-", "alt-x", "ctrl-ctrl-a", " "] {
            assert_eq!(Chord::parse(text), None, "{text:?}");
        }
    }

    #[test]
    fn control_does_not_care_for_capitals_and_alt_is_no_key_of_ours() {
        let capital = KeyEvent::new(KeyCode::Char('C'), KeyModifiers::CONTROL | KeyModifiers::SHIFT);
        assert_eq!(Chord::from_event(capital), Chord::parse("ctrl-c"));
        assert_eq!(Chord::from_event(KeyEvent::new(KeyCode::Char('p'), KeyModifiers::ALT)), None);
    }

    proptest! {
        #[test]
        fn any_text_is_a_key_or_none_and_never_a_panic(text in ".{0,12}") {
            if let Some(chord) = Chord::parse(&text) {
                prop_assert_eq!(Chord::parse(&chord.to_string()), Some(chord));
            }
        }
    }
}
