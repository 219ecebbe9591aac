use super::*;
use proptest::prelude::*;
use ratatui::crossterm::event::{MouseButton, MouseEvent, MouseEventKind};

fn press(code: KeyCode) -> Event {
    key(code, KeyModifiers::NONE)
}

fn control(letter: char) -> Event {
    key(KeyCode::Char(letter), KeyModifiers::CONTROL)
}

/// What bytes mean when nothing follows them.
fn decode(bytes: &[u8]) -> Vec<Event> {
    let mut decoder = Decoder::default();
    let mut events = decoder.take(bytes);
    events.extend(decoder.flush());
    events
}

#[test]
fn letters_and_control_letters_are_keys() {
    assert_eq!(decode(b"aZ?"), [press(KeyCode::Char('a')), press(KeyCode::Char('Z')), press(KeyCode::Char('?'))]);
    assert_eq!(decode("ä€🦀".as_bytes()), ['ä', '€', '🦀'].map(|letter| press(KeyCode::Char(letter))));
    let named = [KeyCode::Enter, KeyCode::Tab, KeyCode::Backspace, KeyCode::Esc];
    assert_eq!(decode(b"\r\t\x7f\x1b"), named.map(press));
    assert_eq!(decode(b"\x03\x1a\x0c\x0a"), ['c', 'z', 'l', 'j'].map(control));
    assert_eq!(decode(b"\x1c\x1f"), ['4', '7'].map(control));
}

#[test]
fn sequences_of_every_kind_of_terminal_are_keys() {
    use KeyCode::{BackTab, Delete, Down, End, F, Home, Insert, Left, PageDown, PageUp, Right, Up};
    let rows: [(&[u8], KeyCode); 28] = [
        (b"\x1b[A", Up),
        (b"\x1b[B", Down),
        (b"\x1b[C", Right),
        (b"\x1b[D", Left),
        (b"\x1bOA", Up),
        (b"\x1bOH", Home),
        (b"\x1b[H", Home),
        (b"\x1b[1~", Home),
        (b"\x1b[7~", Home),
        (b"\x1b[F", End),
        (b"\x1b[4~", End),
        (b"\x1b[2~", Insert),
        (b"\x1b[3~", Delete),
        (b"\x1b[5~", PageUp),
        (b"\x1b[6~", PageDown),
        (b"\x1b[Z", BackTab),
        (b"\x1bOP", F(1)),
        (b"\x1b[11~", F(1)),
        (b"\x1b[[A", F(1)),
        (b"\x1b[[E", F(5)),
        (b"\x1b[15~", F(5)),
        (b"\x1b[17~", F(6)),
        (b"\x1b[21~", F(10)),
        (b"\x1b[23~", F(11)),
        (b"\x1b[24~", F(12)),
        (b"\x1b[13u", KeyCode::Enter),
        (b"\x1b[27u", KeyCode::Esc),
        (b"\x1b[112u", KeyCode::Char('p')),
    ];
    for (bytes, code) in rows {
        assert_eq!(decode(bytes), [press(code)], "{bytes:?}");
    }
    assert_eq!(decode(b"\x1b[1;5A"), [key(Up, KeyModifiers::CONTROL)]);
    assert_eq!(decode(b"\x1bp"), [key(KeyCode::Char('p'), KeyModifiers::ALT)]);
    assert_eq!(decode(b"\x1b\x1b[A"), [press(KeyCode::Esc), press(Up)]);
}

#[test]
fn the_mouse_is_heard_where_it_presses_and_turns() {
    let at = |kind, column, row| Event::Mouse(MouseEvent { kind, column, row, modifiers: KeyModifiers::NONE });
    assert_eq!(decode(b"\x1b[<0;12;3M"), [at(MouseEventKind::Down(MouseButton::Left), 11, 2)]);
    assert_eq!(decode(b"\x1b[<64;1;1M"), [at(MouseEventKind::ScrollUp, 0, 0)]);
    for nothing in [&b"\x1b[<0;12;3m"[..], b"\x1b[<35;12;3M", b"\x1b[<0;0;3M", b"\x1b[<0;99999999;3M"] {
        assert_eq!(decode(nothing), [], "{nothing:?}");
    }
}

#[test]
fn what_is_of_no_use_is_no_key() {
    for nothing in [&b"\x1b[I"[..], b"\x1b[?1;2c", b"\x1b[200~", b"\x1b[112;1:3u", b"\x1b[57441u", b"\x1b[12", b"\x1bO"]
    {
        assert_eq!(decode(nothing), [], "{nothing:?}");
    }
    assert_eq!(decode(&[&b"\x1b["[..], &[b'3'; 300], b"Ap"].concat()), [press(KeyCode::Char('p'))]);
    // Bytes that are no UTF-8, each before a letter that is still a key.
    for byte in 0x80..=0xff_u8 {
        assert_eq!(decode(&[byte, b'p']), [press(KeyCode::Char('p'))], "{byte:#x}");
    }
}

#[test]
fn stop_keys_are_stop_keys_with_whatever_else_is_held() {
    let space = [press(KeyCode::Char(' '))];
    for bytes in [&b" "[..], b"\0", b"\x1b[32u", b"\x1b[32;6u", b"\x1b[27;5;32~"] {
        assert_eq!(decode(bytes), space, "{bytes:?}");
    }
    for bytes in [&b"\x03"[..], b"\x1b[99;5u", b"\x1b[99;7u", b"\x1b[27;5;99~", b"\x1b[27;8;99~"] {
        assert_eq!(decode(bytes), [control('c')], "{bytes:?}");
    }
}

/// Bytes as a terminal may send them, and noise.
fn noise() -> impl Strategy<Value = Vec<u8>> {
    let pieces = prop_oneof![
        any::<u8>().prop_map(|byte| vec![byte]),
        prop::sample::select(vec!["\x1b", "\x1b[", "\x1bO", "\x1b[1;", "\x1b[<0;1", "\x1b[200~", "\x1b[M", "\x1b[["])
            .prop_map(|text| text.as_bytes().to_vec()),
        prop::collection::vec(b'0'..=b';', 0..100),
    ];
    prop::collection::vec(pieces, 0..20).prop_map(|pieces| pieces.concat())
}

proptest! {
    #[test]
    fn no_stop_key_is_lost_behind_anything(before in noise(), cut in 0_usize..200, stop in prop::sample::select(vec![b' ', CONTROL_C])) {
        let expected = plain(stop);
        let mut bytes = before;
        bytes.push(stop);
        let (first, second) = bytes.split_at(cut.min(bytes.len()));
        let mut decoder = Decoder::default();
        let mut events = decoder.take(first);
        events.extend(decoder.take(second));
        prop_assert_eq!(events.last(), Some(&expected));
        prop_assert!(!decoder.is_waiting());
    }

    #[test]
    fn it_makes_no_difference_where_reads_are_cut(bytes in noise(), cut in 0_usize..200) {
        let (first, second) = bytes.split_at(cut.min(bytes.len()));
        let (mut whole, mut cut) = (Decoder::default(), Decoder::default());
        let mut events = cut.take(first);
        events.extend(cut.take(second));
        prop_assert_eq!(whole.take(&bytes), events);
    }
}
