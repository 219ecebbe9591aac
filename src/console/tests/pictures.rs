//! Pictures of every screen: each situation at five sizes, in colour, mono and ASCII.

use super::*;

/// Every size of a screen in one text, each in a frame that shows its edges.
fn at_all_sizes(snapshot: &Snapshot, view: &ViewState, look: Look) -> String {
    let picture = |size: (u16, u16)| {
        let text = text_of(&drawn(snapshot, view, look, size));
        let rows: Vec<String> = text.lines().map(|row| format!("|{row}")).collect();
        format!("{} x {}\n{}\n", size.0, size.1, rows.join("\n"))
    };
    SIZES.map(picture).join("\n")
}

/// Where each style begins: row, column, colours and weight.
fn styles(buffer: &Buffer) -> String {
    let mut lines = Vec::new();
    for y in 0..buffer.area.height {
        let mut last = None;
        let mut runs = Vec::new();
        for x in 0..buffer.area.width {
            let cell = &buffer[(x, y)];
            let style = (cell.fg, cell.bg, cell.modifier);
            if last != Some(style) {
                runs.push(format!("{x}:{:?}/{:?}/{:?}", cell.fg, cell.bg, cell.modifier));
                last = Some(style);
            }
        }
        lines.push(format!("{y:>2} {}", runs.join(" ")));
    }
    lines.join("\n")
}

fn each(mut check: impl FnMut(String, &Snapshot, &ViewState)) {
    for situation in Situation::ALL {
        let snapshot = fixture(situation);
        for screen in Screen::ALL {
            let view = ViewState { screen, ..ViewState::default() };
            check(format!("{}_{situation:?}", screen.name()).to_lowercase(), &snapshot, &view);
        }
    }
}

#[test]
fn every_screen_in_unicode() {
    each(|name, snapshot, view| {
        insta::assert_snapshot!(format!("unicode_{name}"), at_all_sizes(snapshot, view, COLOUR));
    });
}

#[test]
fn every_screen_in_ascii() {
    each(|name, snapshot, view| {
        let text = at_all_sizes(snapshot, view, ASCII);
        assert!(text.is_ascii(), "{name}\n{text}");
        insta::assert_snapshot!(format!("ascii_{name}"), text);
    });
}

#[test]
fn every_screen_in_colour_and_in_mono() {
    each(|name, snapshot, view| {
        let pictures = |look| SIZES.map(|size| drawn(snapshot, view, look, size));
        let (colour, mono) = (pictures(COLOUR), pictures(MONO));
        assert_eq!(colour.each_ref().map(text_of), mono.each_ref().map(text_of), "{name}: only styles may differ");
        insta::assert_snapshot!(format!("colour_{name}"), colour.each_ref().map(styles).join("\n\n"));
        insta::assert_snapshot!(format!("mono_{name}"), mono.each_ref().map(styles).join("\n\n"));
    });
}

#[test]
fn mono_and_no_color_emit_no_colour_at_any_size() {
    each(|name, snapshot, view| {
        for size in SIZES {
            let buffer = drawn(snapshot, view, MONO, size);
            let coloured = buffer
                .content
                .iter()
                .find(|cell| cell.fg != ratatui::style::Color::Reset || cell.bg != ratatui::style::Color::Reset);
            assert!(coloured.is_none(), "{name} {size:?} {coloured:?}");
        }
    });
}

#[test]
fn the_stop_state_is_on_every_screen_at_every_size_that_has_room_for_it() {
    each(|name, snapshot, view| {
        for size in SIZES.into_iter().filter(|size| size.0 >= 39) {
            let text = text_of(&drawn(snapshot, view, ASCII, size)).to_lowercase();
            let words = ["not stopped", "stop state not known", "# stop", "x stop not confirmed"];
            assert!(words.iter().any(|word| text.contains(word)), "{name} {size:?}\n{text}");
        }
    });
}

#[test]
fn every_dialog_has_its_picture() {
    let stopped = fixture(Situation::Stopped);
    let live = fixture(Situation::Live);
    let mut holding = live.clone();
    holding.trial.phase = crate::snapshot::TrialPhase::Holding;
    let ways: [(&str, &Snapshot, &[&str]); 10] = [
        ("help", &live, &["?"]),
        ("help_search", &live, &["?", "/", "t", "a", "r", "e"]),
        ("note", &live, &["o", "a", "_", "b"]),
        ("filter", &live, &["/", "x"]),
        ("settings", &live, &[","]),
        ("withdraw", &holding, &["W"]),
        ("strategies", &live, &["s", "down"]),
        ("quit", &live, &["q"]),
        ("quit_after_stop", &stopped, &["ctrl-c"]),
        ("reset", &stopped, &["R", "r", "e"]),
    ];
    for (name, snapshot, way) in ways {
        let mut app = app(Screen::Trial);
        press(&mut app, snapshot, way);
        insta::assert_snapshot!(format!("dialog_{name}"), at_all_sizes(snapshot, &app.view, COLOUR));
    }
}
