//! From the bytes of a terminal to keys: the stop keys first, whatever stands before them.
//!
//! It reads nothing itself. A key of letters may arrive behind half an escape sequence, an Esc, a byte that is no UTF-8 or
//! a pasted page: Space and Ctrl-C are keys of their own wherever their bytes stand, and end what was begun before them.
//! The sequences are those of ECMA-48 as xterm, the Linux console and the kitty keyboard protocol send them.

mod sequence;

use ratatui::crossterm::event::{Event, KeyCode, KeyEvent, KeyModifiers};

/// The byte that begins a sequence.
const ESCAPE: u8 = 0x1b;
/// The byte of Ctrl-C.
const CONTROL_C: u8 = 0x03;
/// Longer than any sequence of ours: what goes on longer is noise.
const LONGEST: usize = 32;

/// What has arrived and is not a whole key yet.
#[derive(Debug, Default)]
pub(super) struct Decoder {
    pending: Vec<u8>,
}

impl Decoder {
    /// Takes bytes in and returns the keys that they complete, oldest first.
    pub(super) fn take(&mut self, bytes: &[u8]) -> Vec<Event> {
        let mut events = Vec::new();
        for byte in bytes {
            self.push(*byte, &mut events);
        }
        events
    }

    /// True where the next byte may belong to what has come.
    pub(super) fn is_waiting(&self) -> bool {
        !self.pending.is_empty()
    }

    /// Nothing more came for a while: an Esc that nothing followed is the Esc key, half a sequence is nothing.
    pub(super) fn flush(&mut self) -> Vec<Event> {
        let alone = self.pending == [ESCAPE];
        self.pending.clear();
        if alone { vec![key(KeyCode::Esc, KeyModifiers::NONE)] } else { Vec::new() }
    }

    fn push(&mut self, byte: u8, events: &mut Vec<Event>) {
        if matches!(byte, b' ' | CONTROL_C) {
            events.extend(self.flush());
            events.push(plain(byte));
            return;
        }
        if self.pending.is_empty() {
            self.begin(byte, events);
            return;
        }
        self.pending.push(byte);
        match sequence::read(&self.pending) {
            // The rest of what goes on too long is no key either.
            Reading::More => self.pending.truncate(LONGEST),
            Reading::Key(event) => {
                self.pending.clear();
                events.push(event);
            }
            Reading::Nothing => self.pending.clear(),
            Reading::Foreign => {
                // This byte is no part of what was begun; it may begin something itself.
                self.pending.pop();
                events.extend(self.flush());
                self.begin(byte, events);
            }
        }
    }

    fn begin(&mut self, byte: u8, events: &mut Vec<Event>) {
        if byte == ESCAPE || sequence::letter_length(byte) > 1 {
            self.pending.push(byte);
        } else if byte.is_ascii() {
            events.push(plain(byte));
        }
    }
}

/// What some bytes are.
#[derive(Debug, PartialEq)]
enum Reading {
    /// The beginning of something.
    More,
    /// Whole.
    Key(Event),
    /// Whole, and of no use to us.
    Nothing,
    /// The last byte does not belong to the ones before.
    Foreign,
}

/// The key of one byte.
fn plain(byte: u8) -> Event {
    let control = |first: u8, letter: char| {
        let offset = u32::from(byte.saturating_sub(first));
        let letter = char::from_u32(u32::from(letter) + offset).unwrap_or(letter);
        key(KeyCode::Char(letter), KeyModifiers::CONTROL)
    };
    match byte {
        // Space with Control held is Space.
        0 => key(KeyCode::Char(' '), KeyModifiers::NONE),
        b'\r' => key(KeyCode::Enter, KeyModifiers::NONE),
        b'\t' => key(KeyCode::Tab, KeyModifiers::NONE),
        ESCAPE => key(KeyCode::Esc, KeyModifiers::NONE),
        0x7f => key(KeyCode::Backspace, KeyModifiers::NONE),
        0x01..=0x1a => control(1, 'a'),
        0x1c..=0x1f => control(0x1c, '4'),
        _ => key(KeyCode::Char(char::from(byte)), KeyModifiers::NONE),
    }
}

/// A key; a stop key is the same with whatever else is held.
fn key(code: KeyCode, modifiers: KeyModifiers) -> Event {
    let modifiers = match code {
        KeyCode::Char(' ') => KeyModifiers::NONE,
        KeyCode::Char('c' | 'C') if modifiers.contains(KeyModifiers::CONTROL) => KeyModifiers::CONTROL,
        _ => modifiers,
    };
    Event::Key(KeyEvent::new(code, modifiers))
}

#[cfg(test)]
mod tests;
