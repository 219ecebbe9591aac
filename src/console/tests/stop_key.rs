//! The stop key works everywhere, and nothing that anybody types or drags can start a motion unasked.

use super::*;
use crate::console::dialog::Dialog;
use crate::snapshot::{TrialPhase, Watermark};
use proptest::prelude::*;
use ratatui::crossterm::event::{MouseButton, MouseEvent, MouseEventKind};

/// Keys that lead from a screen into each dialog and text field.
const WAYS: [&[&str]; 16] = [
    &[],
    &["?"],
    &["?", "/", "x"],
    &["o"],
    &["o", "n", "o", "t", "e"],
    &["/", "x"],
    &[","],
    &["R", "r", "e"],
    &["E"],
    &["S"],
    &["W"],
    &["A"],
    &["s"],
    &["5"],
    &["q"],
    &["f"],
];

#[test]
fn s_43_the_stop_key_works_on_every_screen_dialog_field_size_and_situation() {
    for situation in Situation::ALL {
        for watermark in [Watermark::Live, Watermark::Watch, Watermark::Replay] {
            for screen in Screen::ALL {
                for way in WAYS {
                    for size in SIZES {
                        for stop in ["space", "ctrl-c"] {
                            let snapshot = Snapshot { watermark, ..fixture_of(situation) };
                            let mut app = app(screen);
                            app.on_resize(size.0, size.1);
                            press(&mut app, &snapshot, way);
                            let reactions = press(&mut app, &snapshot, &[stop]);
                            assert_eq!(reactions.first(), Some(&Reaction::Stop), "{stop} after {way:?} on {screen:?}");
                            let open = app.view.dialog.as_ref().is_some_and(Dialog::may_move);
                            assert!(!open, "a question about motion stays open: {way:?}");
                        }
                    }
                }
            }
        }
    }
}

/// Fixtures are made once: this walk needs many.
fn fixture_of(situation: Situation) -> Snapshot {
    static MADE: std::sync::OnceLock<Vec<Snapshot>> = std::sync::OnceLock::new();
    MADE.get_or_init(|| Situation::ALL.map(fixture).to_vec())[situation as usize].clone()
}

#[test]
fn control_c_asks_once_and_leaves_the_second_time() {
    let live = fixture(Situation::Live);
    let mut app = app(Screen::Log);
    let first = press(&mut app, &live, &["ctrl-c"]);
    assert!(!first.iter().any(|reaction| matches!(reaction, Reaction::Leave(_))));
    let second = press(&mut app, &live, &["ctrl-c"]);
    assert_eq!(second.last(), Some(&Reaction::Leave(ExitReason::QuitAfterStop)));
}

#[test]
fn a_stop_from_elsewhere_closes_the_question_about_motion() {
    let live = fixture(Situation::Live);
    let mut app = app(Screen::Trial);
    app.on_snapshot(&live);
    press(&mut app, &live, &["5", "y"]);
    assert!(app.view.dialog.is_some());
    app.on_snapshot(&fixture(Situation::Stopped));
    assert!(app.view.dialog.is_none());
    let sent = press(&mut app, &fixture(Situation::Stopped), &["enter"]);
    assert!(!sent.iter().any(may_move), "{sent:?}");
}

fn may_move(reaction: &Reaction) -> bool {
    matches!(reaction, Reaction::Send(command) if command.may_move())
}

#[derive(Clone, Debug)]
enum Happening {
    Key(&'static str),
    Resize(u16, u16),
    Click(u16, u16),
    Scroll,
    Snapshot(Situation),
}

/// Every key of the table, letters and digits, but neither `y`, Tab, the arrows nor Enter, with which Yes is chosen.
fn unconfirming_keys() -> Vec<&'static str> {
    let table = TABLE.iter().flat_map(|entry| entry.keys.iter().copied());
    let more = ["a", "e", "n", "z", "1", "9", "backspace", "esc", "home", "f5"];
    let yes = ["y", "tab", "shift-tab", "left", "right", "enter"];
    table.chain(more).filter(|key| !yes.contains(key)).collect()
}

fn happening(keys: Vec<&'static str>) -> impl Strategy<Value = Happening> {
    prop_oneof![
        8 => proptest::sample::select(keys).prop_map(Happening::Key),
        1 => (0_u16..=200, 0_u16..=60).prop_map(|(columns, rows)| Happening::Resize(columns, rows)),
        1 => (0_u16..200, 0_u16..60).prop_map(|(column, row)| Happening::Click(column, row)),
        1 => Just(Happening::Scroll),
        1 => proptest::sample::select(Situation::ALL.to_vec()).prop_map(Happening::Snapshot),
    ]
}

/// Carries happenings out, drawing after each, and returns everything that was asked for.
fn live_through(happenings: &[Happening], phase: TrialPhase) -> Vec<Reaction> {
    let mut app = app(Screen::Trial);
    let mut snapshot = fixture_of(Situation::Live);
    snapshot.trial.phase = phase;
    let mut reactions = Vec::new();
    for happening in happenings {
        let mouse = |kind, column, row| MouseEvent { kind, column, row, modifiers: KeyModifiers::NONE };
        match happening {
            Happening::Key(text) => reactions.extend(app.on_key(key(text), &snapshot)),
            Happening::Resize(columns, rows) => app.on_resize(*columns, *rows),
            Happening::Click(column, row) => {
                app.on_mouse(mouse(MouseEventKind::Down(MouseButton::Left), *column, *row), &snapshot);
            }
            Happening::Scroll => app.on_mouse(mouse(MouseEventKind::ScrollDown, 0, 0), &snapshot),
            Happening::Snapshot(situation) => {
                snapshot = fixture_of(*situation);
                snapshot.trial.phase = phase;
                reactions.extend(app.on_snapshot(&snapshot));
            }
        }
        drawn(&snapshot, &app.view, if app.view.mouse { ASCII } else { COLOUR }, app.view.size);
    }
    reactions
}

const PHASES: [TrialPhase; 8] = [
    TrialPhase::Idle,
    TrialPhase::Waiting,
    TrialPhase::Positioning,
    TrialPhase::Dressing,
    TrialPhase::Withdrawing,
    TrialPhase::Holding,
    TrialPhase::Stopped,
    TrialPhase::Ended,
];

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn nothing_moves_without_yes_and_enter(
        happenings in proptest::collection::vec(happening(unconfirming_keys()), 1..40),
        phase in proptest::sample::select(PHASES.to_vec()),
    ) {
        // A change of strategy at rest is asked for at once: it moves nothing.
        let asked = live_through(&happenings, phase);
        let moving = asked.iter().filter(|reaction| {
            may_move(reaction) && (phase.moves() || !matches!(reaction, Reaction::Send(Command::SelectStrategy(_))))
        });
        prop_assert_eq!(moving.count(), 0);
    }

    #[test]
    fn a_question_about_motion_needs_its_own_yes(
        keys in proptest::collection::vec(proptest::sample::select(vec!["enter", "W", "E", "S", "n", "i", "p", "esc"]), 1..40),
    ) {
        // Enter alone, however often, confirms nothing.
        let happenings: Vec<_> = keys.into_iter().map(Happening::Key).collect();
        let asked = live_through(&happenings, TrialPhase::Dressing);
        prop_assert!(!asked.iter().any(may_move));
    }

    #[test]
    fn every_size_is_drawn(columns in 0_u16..=200, rows in 0_u16..=80, situation in proptest::sample::select(Situation::ALL.to_vec())) {
        for screen in Screen::ALL {
            let view = ViewState { screen, ..ViewState::default() };
            drawn(&fixture_of(situation), &view, ASCII, (columns, rows));
        }
    }
}
