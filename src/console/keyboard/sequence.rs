//! Letters and escape sequences of several bytes. Knows nothing of what came before or after.

use super::{ESCAPE, Reading, key, plain};
use ratatui::crossterm::event::{Event, KeyCode, KeyModifiers, MouseButton, MouseEvent, MouseEventKind};

/// Reads what has been begun: at least two bytes, the first Esc or the first of a letter.
pub(super) fn read(bytes: &[u8]) -> Reading {
    match bytes {
        [ESCAPE, b'[', rest @ ..] => control_sequence(rest),
        [ESCAPE, b'O'] => Reading::More,
        [ESCAPE, b'O', last] => arrow(*last, KeyModifiers::NONE).map_or(Reading::Foreign, Reading::Key),
        // Esc once more: the first one was the Esc key.
        [ESCAPE, ESCAPE] => Reading::Foreign,
        [ESCAPE, letter] => with_alt(*letter),
        [first, .., last] => letter(bytes, letter_length(*first), *last),
        _ => Reading::Nothing,
    }
}

/// How many bytes a letter of UTF-8 has that begins so; 1 for what begins none.
pub(super) const fn letter_length(first: u8) -> usize {
    match first {
        0xc2..=0xdf => 2,
        0xe0..=0xef => 3,
        0xf0..=0xf4 => 4,
        _ => 1,
    }
}

fn letter(bytes: &[u8], length: usize, last: u8) -> Reading {
    if !(0x80..=0xbf).contains(&last) {
        return Reading::Foreign;
    }
    if bytes.len() < length {
        return Reading::More;
    }
    let whole = std::str::from_utf8(bytes).ok().and_then(|text| text.chars().next());
    whole.map_or(Reading::Nothing, |letter| Reading::Key(key(KeyCode::Char(letter), KeyModifiers::NONE)))
}

fn with_alt(byte: u8) -> Reading {
    match plain(byte) {
        Event::Key(pressed) if byte.is_ascii() => {
            Reading::Key(key(pressed.code, pressed.modifiers | KeyModifiers::ALT))
        }
        _ => Reading::Foreign,
    }
}

/// What follows Esc and an opening bracket.
fn control_sequence(rest: &[u8]) -> Reading {
    let Some((last, middle)) = rest.split_last() else { return Reading::More };
    if middle == b"[" {
        // F1 to F5 of the Linux console.
        return if (b'A'..=b'E').contains(last) { function(i32::from(last - b'A') + 1) } else { Reading::Foreign };
    }
    match *last {
        b'[' if middle.is_empty() => Reading::More,
        b'!'..=b'?' => Reading::More,
        b'@'..=b'~' => whole_sequence(middle, *last),
        _ => Reading::Foreign,
    }
}

/// The numbers of a sequence; what follows a colon is kept apart from them.
struct Numbers(Vec<Vec<u32>>);

impl Numbers {
    fn read(text: &[u8]) -> Option<Self> {
        let text = std::str::from_utf8(text).ok()?;
        let number = |part: &str| if part.is_empty() { Some(1) } else { part.parse().ok() };
        let field = |field: &str| field.split(':').map(number).collect::<Option<Vec<u32>>>();
        text.split(';').map(field).collect::<Option<_>>().map(Self)
    }

    fn get(&self, field: usize, part: usize) -> Option<u32> {
        self.0.get(field)?.get(part).copied()
    }

    /// What is held, from a field that is one more than the sum of 1 for Shift, 2 for Alt, 4 for Control and 8 for Super.
    fn modifiers(&self, field: usize) -> KeyModifiers {
        let held = self.get(field, 0).unwrap_or(1).saturating_sub(1);
        let named =
            [(1, KeyModifiers::SHIFT), (2, KeyModifiers::ALT), (4, KeyModifiers::CONTROL), (8, KeyModifiers::SUPER)];
        named.into_iter().filter(|(bit, _)| held & bit != 0).map(|(_, modifier)| modifier).collect()
    }

    /// True where the key was let go and not pressed.
    fn is_release(&self, field: usize) -> bool {
        self.get(field, 1) == Some(3)
    }
}

fn whole_sequence(middle: &[u8], last: u8) -> Reading {
    if let [b'<', mouse @ ..] = middle {
        return Numbers::read(mouse)
            .and_then(|numbers| mouse_event(&numbers, last))
            .map_or(Reading::Nothing, Reading::Key);
    }
    let Some(numbers) = Numbers::read(middle) else { return Reading::Nothing };
    if numbers.is_release(1) {
        return Reading::Nothing;
    }
    match last {
        b'~' => numbered(&numbers),
        b'u' => coded(&numbers, 0, 1),
        b'Z' => Reading::Key(key(KeyCode::BackTab, KeyModifiers::NONE)),
        last => arrow(last, numbers.modifiers(1)).map_or(Reading::Nothing, Reading::Key),
    }
}

fn arrow(last: u8, held: KeyModifiers) -> Option<Event> {
    let code = match last {
        b'A' => KeyCode::Up,
        b'B' => KeyCode::Down,
        b'C' => KeyCode::Right,
        b'D' => KeyCode::Left,
        b'H' => KeyCode::Home,
        b'F' => KeyCode::End,
        b'P'..=b'S' => KeyCode::F(last - b'P' + 1),
        _ => return None,
    };
    Some(key(code, held))
}

fn numbered(numbers: &Numbers) -> Reading {
    let code = match numbers.get(0, 0) {
        Some(1 | 7) => KeyCode::Home,
        Some(2) => KeyCode::Insert,
        Some(3) => KeyCode::Delete,
        Some(4 | 8) => KeyCode::End,
        Some(5) => KeyCode::PageUp,
        Some(6) => KeyCode::PageDown,
        Some(number @ 11..=15) => return function(number.cast_signed() - 10),
        Some(number @ 17..=21) => return function(number.cast_signed() - 11),
        Some(number @ 23..=24) => return function(number.cast_signed() - 12),
        // Any key with a modifier, as xterm writes it when it is told to.
        Some(27) => return coded(numbers, 2, 1),
        _ => return Reading::Nothing,
    };
    Reading::Key(key(code, numbers.modifiers(1)))
}

fn function(number: i32) -> Reading {
    u8::try_from(number).map_or(Reading::Nothing, |number| Reading::Key(key(KeyCode::F(number), KeyModifiers::NONE)))
}

/// A key that is told by the number of its letter.
fn coded(numbers: &Numbers, code: usize, held: usize) -> Reading {
    let code = match numbers.get(code, 0) {
        Some(9) => KeyCode::Tab,
        Some(13) => KeyCode::Enter,
        Some(27) => KeyCode::Esc,
        Some(127) => KeyCode::Backspace,
        // Above are keys without a letter, in an area of Unicode that is left to private use.
        Some(number @ 32..0xe000) => match char::from_u32(number) {
            Some(letter) => KeyCode::Char(letter),
            None => return Reading::Nothing,
        },
        _ => return Reading::Nothing,
    };
    Reading::Key(key(code, numbers.modifiers(held)))
}

/// A press or a turn of the wheel. Columns and rows count from 1 on the wire.
fn mouse_event(numbers: &Numbers, last: u8) -> Option<Event> {
    let kind = match (numbers.get(0, 0)?, last) {
        (0, b'M') => MouseEventKind::Down(MouseButton::Left),
        (1, b'M') => MouseEventKind::Down(MouseButton::Middle),
        (2, b'M') => MouseEventKind::Down(MouseButton::Right),
        (64, b'M') => MouseEventKind::ScrollUp,
        (65, b'M') => MouseEventKind::ScrollDown,
        _ => return None,
    };
    let place = |field| u16::try_from(numbers.get(field, 0)?.checked_sub(1)?).ok();
    let (column, row) = (place(1)?, place(2)?);
    Some(Event::Mouse(MouseEvent { kind, column, row, modifiers: KeyModifiers::NONE }))
}
