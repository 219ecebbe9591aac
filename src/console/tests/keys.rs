//! What single keys and the mouse do, and what the screen says of it.

use super::*;

#[test]
fn keys_that_come_faster_than_the_core_answers_add_up_to_numbers_of_few_digits() {
    let mut live = fixture(Situation::Live);
    {
        let setting = &mut live.settings.make_mut()[1];
        (setting.value, setting.step) = (0.03, 0.005);
    }
    let mut app = app(Screen::Trial);
    let values = |reactions: Vec<Reaction>| -> Vec<f64> {
        let value = |reaction| match reaction {
            Reaction::Send(Command::SetSetting { value, .. }) => Some(value),
            _ => None,
        };
        reactions.into_iter().filter_map(value).collect()
    };
    assert_eq!(values(press(&mut app, &live, &[",", "down", "-", "-", "+"])), [0.025, 0.02, 0.025]);
    // Nothing came of it: what the core says counts again.
    live.now = live.now + std::time::Duration::from_secs(1);
    assert_eq!(values(press(&mut app, &live, &["-"])), [0.025]);
    assert_eq!(values(press(&mut app, &live, &["u", "-"])), [0.025], "an undo forgets what was asked");
}

#[test]
fn the_run_key_is_passed_on_only_while_it_repeats_and_only_where_hold_to_run_is_chosen() {
    let mut live = fixture(Situation::Live);
    let mut app = app(Screen::Force);
    assert_eq!(press(&mut app, &live, &["c", "c", "c"]), []);
    assert!(app.view.message.as_ref().is_some_and(|message| message.text.contains("--hold-to-run")));
    live.trial.run_key = crate::snapshot::RunKeyView::Needed;
    let run = Reaction::Send(Command::Run);
    assert_eq!(press(&mut app, &live, &["c"]), [], "a single press moves nothing");
    assert_eq!(press(&mut app, &live, &["c", "c"]), [run.clone(), run]);
    live.now = live.now + std::time::Duration::from_millis(1500);
    assert_eq!(press(&mut app, &live, &["c"]), [], "it had been let go");
    let screen = text_of(&drawn(&live, &self::app(Screen::Trial).view, COLOUR, (120, 40)));
    assert!(screen.contains("only as long as c is held down"), "{screen}");
    live.stop.latched = true;
    live.stop.requested_at = Some(live.now);
    assert_eq!(press(&mut app, &live, &["c"]), [], "no way round a stop");
}

#[test]
fn a_choice_begins_at_what_holds_now() {
    let mut ready = fixture(Situation::Live);
    ready.trial.phase = crate::snapshot::TrialPhase::Idle;
    ready.trial.first_arm = Some(crate::body::Side::Left);
    let mut app = app(Screen::Trial);
    press(&mut app, &ready, &["y"]);
    let screen = text_of(&drawn(&ready, &app.view, COLOUR, (120, 40)));
    assert!(screen.lines().any(|row| row.contains("left arm") && row.contains("now")), "{screen}");
    let left = Reaction::Send(Command::SelectFirstArm(crate::body::Side::Left));
    assert_eq!(press(&mut app, &ready, &["enter"]), [left]);
}

#[test]
fn a_stop_is_left_from_every_screen_and_a_key_of_another_screen_says_of_which() {
    let mut ready = fixture(Situation::Live);
    ready.trial.phase = crate::snapshot::TrialPhase::Idle;
    for screen in Screen::ALL {
        let mut app = app(screen);
        assert_eq!(press(&mut app, &ready, &["S", "y", "enter"]), [Reaction::Send(Command::Start)], "{screen:?}");
    }
    let mut app = app(Screen::Log);
    press(&mut app, &ready, &["t"]);
    let message = app.view.message.map(|message| message.text).unwrap_or_default();
    assert!(message.contains("on the force screen"), "{message}");
}

#[test]
fn the_mouse_focuses_an_arm_and_scrolls_within_the_list_alone() {
    use ratatui::crossterm::event::{MouseButton, MouseEvent, MouseEventKind};
    let live = fixture(Situation::Live);
    let mouse = |kind, column, row| MouseEvent { kind, column, row, modifiers: KeyModifiers::NONE };
    let click = MouseEventKind::Down(MouseButton::Left);
    let mut app = app(Screen::Force);
    app.on_mouse(mouse(click, 5, 10), &live);
    assert_eq!(app.view.side, crate::body::Side::Right, "the mouse is off at first");
    press(&mut app, &live, &["m"]);
    app.on_mouse(mouse(click, 5, 10), &live);
    assert_eq!(app.view.side, crate::body::Side::Left);
    app.on_mouse(mouse(click, 5, 30), &live);
    assert_eq!(app.view.side, crate::body::Side::Right);
    press(&mut app, &live, &["L"]);
    let last = app.view.log_lines(&live).count() - 1;
    for _ in 0..1000 {
        app.on_mouse(mouse(MouseEventKind::ScrollDown, 5, 10), &live);
    }
    assert_eq!(app.view.row, last);
    app.on_mouse(mouse(MouseEventKind::ScrollUp, 5, 10), &live);
    assert_eq!((app.view.row, app.view.follow), (last - 3, false), "one notch is seen at once");
}

#[test]
fn what_is_to_be_checked_is_not_called_late() {
    let mut idle = fixture(Situation::Empty);
    let stamp = idle.now;
    idle.robot = fixture(Situation::Live).robot;
    let robot = idle.robot.state.as_mut().unwrap();
    (robot.stamp, robot.enabled, robot.stopped) = (stamp, false, false);
    idle.checks = crate::snapshot::Shared::new(idle.check_list());
    let screen = text_of(&drawn(&idle, &ViewState::default(), COLOUR, (120, 40)));
    let row = screen.lines().find(|row| row.contains("robot ") && row.contains("disabled")).unwrap_or_default();
    assert!(row.contains("CHECK") && !row.contains("LATE"), "{row}\n{screen}");
}

#[test]
fn what_came_of_something_later_than_its_answer_is_seen_on_every_screen() {
    let mut live = fixture(Situation::Live);
    let at = |milliseconds: u64| live.now + std::time::Duration::from_millis(milliseconds);
    let (asked, found) = (at(10), at(20));
    let receipt = crate::command::CommandReceipt::accepted(Command::SignCheck(crate::body::Side::Right), "push it");
    live.receipts.push(crate::snapshot::ReceiptLine {
        stamp: asked,
        origin: crate::command::Origin::OperatorKey,
        receipt,
    });
    let bottom = |live: &Snapshot| {
        let screen = text_of(&drawn(live, &ViewState::default(), COLOUR, (120, 40)));
        screen.lines().nth(38).unwrap_or_default().to_owned()
    };
    assert!(bottom(&live).contains("push it"), "{}", bottom(&live));
    live.log.push(crate::snapshot::LogLine {
        id: 99,
        stamp: found,
        level: crate::snapshot::Level::Warning,
        source: "sign check".into(),
        text: "no push was felt".into(),
    });
    assert!(bottom(&live).contains("sign check: no push was felt"), "{}", bottom(&live));
}

#[test]
fn the_health_screen_shows_the_worst_of_what_other_nodes_say_of_themselves() {
    use crate::snapshot::{DiagnosisView, Verdict};
    let mut live = fixture(Situation::Live);
    let shown = |live: &Snapshot| {
        let view = ViewState { screen: Screen::Health, ..ViewState::default() };
        text_of(&drawn(live, &view, COLOUR, (120, 40)))
    };
    assert!(!shown(&live).contains("Diagnostics of other nodes"));
    let now = live.now;
    let said =
        |name: &str, verdict, text: &str, heard| DiagnosisView { name: name.into(), verdict, text: text.into(), heard };
    let old = crate::time::Stamp::from_nanoseconds(now.nanoseconds() - 7_000_000_000);
    live.diagnoses = crate::snapshot::Shared::new(vec![
        said("camera", Verdict::Late, "few frames", now),
        said("gripper", Verdict::Good, "calibrated", now),
        said("left arm", Verdict::Fault, "motor hot", now),
        said("old driver", Verdict::Good, "fine", old),
    ]);
    let screen = shown(&live);
    let row = |words: &str| screen.lines().position(|row| row.contains(words)).unwrap_or(usize::MAX);
    let rows = [row("Diagnostics of other nodes: 1 of 4 well"), row("left arm: motor hot"), row("old driver: fine (7")];
    assert!(rows.is_sorted() && rows[2] < row("camera: few frames"), "{screen}");
    let warning = screen.lines().find(|row| row.contains("camera:")).unwrap_or_default();
    assert!(warning.contains("WARN") && row("camera: few frames") < usize::MAX, "{screen}");
}
