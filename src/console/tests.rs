//! The console as a whole, on a terminal made of memory.

mod keys;
mod pictures;
mod stop_key;

use super::*;
use ratatui::buffer::Buffer;
use ratatui::crossterm::event::{KeyCode, KeyEvent, KeyModifiers};
use ratatui::layout::Rect;
use std::collections::BTreeMap;

/// The size of each tier, one below the smallest, and the smallest there is.
const SIZES: [(u16, u16); 5] = [(120, 40), (80, 24), (60, 15), (39, 9), (1, 1)];

const COLOUR: Look = Look { theme: ThemeName::Terminal, ascii: false };
const MONO: Look = Look { theme: ThemeName::Mono, ascii: false };
const ASCII: Look = Look { theme: ThemeName::Terminal, ascii: true };

fn usual_keys() -> KeyMap {
    KeyMap::new(&BTreeMap::new()).unwrap()
}

fn app(screen: Screen) -> App {
    App::new(usual_keys(), ViewState { screen, size: (120, 40), ..ViewState::default() })
}

/// The key that a text names.
fn key(text: &str) -> KeyEvent {
    let chord = Chord::parse(text).unwrap();
    let modifiers = if chord.control() { KeyModifiers::CONTROL } else { KeyModifiers::NONE };
    KeyEvent::new(chord.code(), modifiers)
}

fn press(app: &mut App, snapshot: &Snapshot, keys: &[&str]) -> Vec<Reaction> {
    keys.iter().flat_map(|text| app.on_key(key(text), snapshot)).collect()
}

fn drawn(snapshot: &Snapshot, view: &ViewState, look: Look, size: (u16, u16)) -> Buffer {
    let area = Rect::new(0, 0, size.0, size.1);
    let view = ViewState { size, ..view.clone() };
    let mut buffer = Buffer::empty(area);
    let keys = usual_keys();
    draw(&Scene { live: snapshot, view: &view, look, keys: &keys }, area, &mut buffer);
    buffer
}

fn text_of(buffer: &Buffer) -> String {
    let area = buffer.area;
    let row = |y| (0..area.width).map(|x| buffer[(x, y)].symbol()).collect::<String>().trim_end().to_owned();
    (0..area.height).map(row).collect::<Vec<_>>().join("\n")
}

#[test]
fn reset_enable_and_start_are_three_acts_and_reset_needs_its_word() {
    let stopped = fixture(Situation::Stopped);
    let mut app = app(Screen::Trial);
    assert_eq!(press(&mut app, &stopped, &["E"]), [], "enabling is refused while the stop is latched");
    assert_eq!(press(&mut app, &stopped, &["S"]), []);
    assert_eq!(press(&mut app, &stopped, &["R", "enter"]), []);
    let sent = press(&mut app, &stopped, &["r", "e", "s", "e", "t", "enter"]);
    assert_eq!(sent, [Reaction::Send(Command::Reset)]);
}

#[test]
fn what_can_move_the_robot_asks_first_and_names_what_will_move() {
    let mut live = fixture(Situation::Live);
    live.trial.phase = crate::snapshot::TrialPhase::Waiting;
    let mut app = app(Screen::Trial);
    assert_eq!(press(&mut app, &live, &["enter"]), []);
    let screen = text_of(&drawn(&live, &app.view, COLOUR, (120, 40)));
    for words in ["right gripper", "strategy force", "iteration 3 of 8", "[ No ]"] {
        assert!(screen.contains(words), "{words}\n{screen}");
    }
    assert_eq!(press(&mut app, &live, &["enter"]), [], "the default answer is No");
    assert_eq!(press(&mut app, &live, &["enter", "y", "enter"]), [Reaction::Send(Command::GoAhead)]);
}

#[test]
fn what_cannot_be_read_cannot_be_confirmed() {
    let mut live = fixture(Situation::Live);
    live.trial.phase = crate::snapshot::TrialPhase::Waiting;
    let mut app = app(Screen::Trial);
    app.on_resize(30, 5);
    assert_eq!(press(&mut app, &live, &["enter", "y", "enter"]), []);
    assert!(app.view.message.as_ref().is_some_and(|message| message.refused));
}

#[test]
fn a_watching_screen_can_stop_and_do_nothing_else() {
    let mut live = fixture(Situation::Live);
    live.watermark = crate::snapshot::Watermark::Watch;
    for screen in Screen::ALL {
        for entry in TABLE {
            let mut app = app(screen);
            let keys = app.keys.keys_of(entry.action);
            let mut reactions = Vec::new();
            for text in keys.iter().map(String::as_str) {
                reactions.extend(press(&mut app, &live, &[text, "y", "enter", "enter"]));
            }
            let sent = reactions
                .iter()
                .filter(|reaction| matches!(reaction, Reaction::Send(command) if *command != Command::Stop));
            assert_eq!(sent.count(), 0, "{} on {}", entry.name, screen.name());
        }
    }
}

#[test]
fn leaving_while_a_trial_runs_holds_first_and_asks() {
    let live = fixture(Situation::Live);
    let mut app = app(Screen::Force);
    assert_eq!(press(&mut app, &live, &["q"]), [Reaction::Send(Command::Hold)]);
    assert_eq!(press(&mut app, &live, &["enter"]), []);
    assert_eq!(press(&mut app, &live, &["q", "y", "enter"]).last(), Some(&Reaction::Leave(ExitReason::Quit)));
    let idle = fixture(Situation::Empty);
    assert_eq!(press(&mut self::app(Screen::Trial), &idle, &["q"]), [Reaction::Leave(ExitReason::Quit)]);
}

#[test]
fn suspending_is_refused_while_an_arm_may_move() {
    let live = fixture(Situation::Live);
    assert_eq!(press(&mut app(Screen::Trial), &live, &["ctrl-z"]), []);
    let idle = fixture(Situation::Empty);
    assert_eq!(press(&mut app(Screen::Trial), &idle, &["ctrl-z"]), [Reaction::Suspend]);
}

#[test]
fn a_setting_keeps_its_limits_and_can_be_undone() {
    let live = fixture(Situation::Live);
    let mut app = app(Screen::Trial);
    let sent = press(&mut app, &live, &[",", "+", "u", "down", "-"]);
    let changed = |key: &str, value| Reaction::Send(Command::SetSetting { key: key.into(), value });
    let undo = Reaction::Send(Command::UndoSetting { key: "force.threshold_newtons".into() });
    assert_eq!(sent, [changed("force.threshold_newtons", 5.5), undo, changed("strategy.step_metres", 0.015)]);
    let mut full = live.clone();
    full.settings.make_mut()[0].value = 10.0;
    assert_eq!(press(&mut self::app(Screen::Trial), &full, &[",", "+"]), []);
}

#[test]
fn a_strategy_switch_asks_only_while_the_arm_moves() {
    let mut live = fixture(Situation::Live);
    let multimodal = [Reaction::Send(Command::SelectStrategy(crate::strategy::StrategyKind::Multimodal))];
    assert_eq!(press(&mut app(Screen::Log), &live, &["5"]), []);
    assert_eq!(press(&mut app(Screen::Log), &live, &["5", "y", "enter"]), multimodal);
    live.trial.phase = crate::snapshot::TrialPhase::Holding;
    assert_eq!(press(&mut app(Screen::Log), &live, &["5"]), multimodal);
}

#[test]
fn a_plot_mark_leads_to_its_line_of_the_log() {
    let live = fixture(Situation::Live);
    let mut app = app(Screen::Force);
    press(&mut app, &live, &["[", "enter"]);
    assert_eq!(app.view.screen, Screen::Log);
    assert_eq!(app.view.log_lines(&live).nth(app.view.row).unwrap().id, 58);
}

#[test]
fn freezing_keeps_the_plots_and_not_the_stop_state() {
    let mut app = app(Screen::Force);
    press(&mut app, &fixture(Situation::Live), &["f"]);
    let screen = text_of(&drawn(&fixture(Situation::Stopped), &app.view, COLOUR, (120, 40)));
    assert!(screen.contains("FROZEN") && screen.contains("EMERGENCY STOP (software)"), "{screen}");
    press(&mut app, &fixture(Situation::Stopped), &["f"]);
    assert!(app.view.frozen.is_none());
}

#[test]
fn a_stale_value_is_never_shown_as_a_number() {
    let stale = fixture(Situation::Stale);
    for screen in Screen::ALL {
        let view = ViewState { screen, ..ViewState::default() };
        let text = text_of(&drawn(&stale, &view, COLOUR, (120, 40)));
        assert!(text.contains("ROBOT STATE STALE"), "{text}");
        assert!(!text.contains("ENABLED"), "{text}");
    }
    let view = ViewState { screen: Screen::Force, ..ViewState::default() };
    let text = text_of(&drawn(&stale, &view, COLOUR, (120, 40)));
    assert_eq!(text.matches(" STALE ").count(), 2 + 16 + 2, "headings, strips, the robot and the data\n{text}");
}

#[test]
fn help_shows_every_action_with_the_keys_in_force() {
    let live = fixture(Situation::Live);
    let mut app = app(Screen::Path);
    press(&mut app, &live, &["?"]);
    let mut seen = String::new();
    for _ in 0..20 {
        seen.push_str(&text_of(&drawn(&live, &app.view, COLOUR, (120, 40))));
        press(&mut app, &live, &["page-down"]);
    }
    for entry in TABLE {
        assert!(seen.contains(entry.text), "{}", entry.name);
    }
}

#[test]
fn letters_of_a_release_or_with_alt_do_nothing() {
    let live = fixture(Situation::Live);
    let mut app = app(Screen::Trial);
    let alt = KeyEvent::new(KeyCode::Char('q'), KeyModifiers::ALT);
    assert_eq!(app.on_key(alt, &live), []);
}

#[test]
fn a_key_that_can_do_nothing_now_says_so_and_asks_nothing() {
    let idle = fixture(Situation::Empty);
    let live = fixture(Situation::Live);
    let cases: [(&Snapshot, &str, &str); 7] = [
        (&idle, "n", "no trial runs"),
        (&idle, "i", "no trial runs"),
        (&idle, "p", "no trial runs"),
        (&live, "n", "nothing waits"),
        (&live, "W", "hold first"),
        (&live, "b", "withdraw"),
        (&live, "E", "enabled already"),
    ];
    for (snapshot, typed, words) in cases {
        let mut app = app(Screen::Trial);
        assert_eq!(press(&mut app, snapshot, &[typed]), [], "{typed}");
        assert!(app.view.dialog.is_none(), "{typed}");
        let message = app.view.message.map(|message| message.text).unwrap_or_default();
        assert!(message.contains(words), "{typed}: {message}");
    }
}

#[test]
fn an_answer_takes_the_place_of_the_question() {
    let mut live = fixture(Situation::Live);
    let mut app = app(Screen::Trial);
    app.on_snapshot(&live);
    press(&mut app, &live, &["p"]);
    assert!(app.view.message.is_some());
    live.now = live.now + std::time::Duration::from_millis(20);
    let receipt = crate::command::CommandReceipt::accepted(Command::Hold, "now");
    live.receipts.push(crate::snapshot::ReceiptLine {
        stamp: live.now,
        origin: crate::command::Origin::OperatorKey,
        receipt,
    });
    app.on_snapshot(&live);
    assert_eq!(app.view.message, None);
}

#[test]
fn a_start_names_what_will_move_first() {
    let mut ready = fixture(Situation::Live);
    ready.trial.phase = crate::snapshot::TrialPhase::Idle;
    ready.trial.first_arm = Some(crate::body::Side::Left);
    let mut app = app(Screen::Trial);
    press(&mut app, &ready, &["S"]);
    let screen = text_of(&drawn(&ready, &app.view, COLOUR, (120, 40)));
    assert!(screen.contains("take the start posture") && screen.contains("left arm first"), "{screen}");
}

#[test]
fn the_keys_of_a_replay_drive_it_and_nothing_else_is_asked() {
    let mut replay = fixture(Situation::Live);
    replay.watermark = crate::snapshot::Watermark::Replay;
    let view = crate::snapshot::ReplayView { position: 12.3, length: 140.0, speed: 2.0, paused: true };
    replay.replay = Some(view);
    let mut app = app(Screen::Trial);
    let asked = press(&mut app, &replay, &["p", ".", "{", "}", "<", ">", "E", "S", "W", "t", "r", "o"]);
    let request = |request| Reaction::Replay(request);
    assert_eq!(
        asked,
        [
            request(ReplayRequest::PauseOrGoOn),
            request(ReplayRequest::Step),
            request(ReplayRequest::Speed(0.5)),
            request(ReplayRequest::Speed(2.0)),
            request(ReplayRequest::Seek(-10.0)),
            request(ReplayRequest::Seek(10.0)),
        ]
    );
    let screen = text_of(&drawn(&replay, &app.view, COLOUR, (120, 40)));
    assert!(screen.contains("REPLAY") && screen.contains("paused 12.3/140.0 s x2"), "{screen}");
    let live = text_of(&drawn(&fixture(Situation::Live), &ViewState::default(), COLOUR, (120, 40)));
    assert!(!live.contains("slower"), "keys of a replay are not offered in a trial: {live}");
}

#[test]
fn after_the_reset_of_a_latched_stop_enable_and_then_start_are_offered() {
    // As the supervisor shows it: latched until Start, with the robot's own stop already clear.
    let mut reset = fixture(Situation::Stopped);
    reset.stop.is_reset = true;
    let robot = reset.robot.state.as_mut().unwrap();
    (robot.stopped, robot.enabled) = (false, false);
    let mut app = app(Screen::Trial);
    assert_eq!(press(&mut app, &reset, &["E", "y", "enter"]), [Reaction::Send(Command::Enable)]);
    assert_eq!(press(&mut app, &reset, &["S", "y", "enter"]), [], "not before it is enabled");
    assert_eq!(press(&mut app, &reset, &["R"]), [], "it is reset already");
    assert!(app.view.dialog.is_none());
    let screen = text_of(&drawn(&reset, &app.view, COLOUR, (120, 40)));
    assert!(screen.contains("STOP RESET") && screen.contains("Enable and Start are left"), "{screen}");
    reset.robot.state.as_mut().unwrap().enabled = true;
    assert_eq!(press(&mut app, &reset, &["p", "y", "enter"]), [], "a hold is not left before Start");
    press(&mut app, &reset, &["S"]);
    let screen = text_of(&drawn(&reset, &app.view, COLOUR, (120, 40)));
    assert!(screen.contains("nothing yet: the trial holds"), "{screen}");
    press(&mut app, &reset, &["esc"]);
    assert_eq!(press(&mut app, &reset, &["S", "y", "enter"]), [Reaction::Send(Command::Start)]);
}

#[test]
fn the_banner_says_what_became_of_a_stop_at_every_width() {
    let stopped = fixture(Situation::Stopped);
    for width in [40, 60, 80, 100, 120] {
        let text = text_of(&drawn(&stopped, &ViewState::default(), COLOUR, (width, 24)));
        assert!(text.contains("confirmed by the robot after"), "{width}\n{text}");
        assert!(text.contains("red button: "), "{width}\n{text}");
    }
}
