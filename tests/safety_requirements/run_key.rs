//! S-46: where hold to run is chosen, the arms move only as long as the operator holds a key down.

use super::room::{BRAKING_BEATS, Room, unaltered};
use valet::command::{Command, Origin};
use valet::snapshot::{RunKeyView, TrialPhase};
use valet::supervisor::{Input, Setup};

fn room() -> Room {
    let mut setup = Setup::default();
    setup.settings.trial.hold_to_run = true;
    Room::with(setup)
}

/// So many beats under a key that repeats at ten a second, the slowest that is usual.
fn held(room: &mut Room, beats: usize) {
    for beat in 0..beats {
        if beat % 10 == 0 {
            room.ask(Command::Run);
        }
        room.beats(1, unaltered);
    }
}

fn run_key(room: &Room) -> RunKeyView {
    room.supervisor.snapshot(room.now).trial.run_key
}

fn dressing() -> Room {
    let mut room = room();
    for _ in 0..600 {
        if room.phase() == TrialPhase::Dressing {
            held(&mut room, 150);
            return room;
        }
        held(&mut room, 10);
    }
    panic!("never dressing: {:?} {}", room.phase(), room.hold_cause());
}

/// The largest step of a joint under this many beats of a held key, or of none.
fn moved(room: &mut Room, beats: usize, key: bool) -> f64 {
    let since = room.sent.len();
    if key {
        held(room, beats);
    } else {
        room.beats(beats, unaltered);
    }
    room.largest_step(since)
}

#[test]
fn s_46_a_started_trial_moves_only_under_the_key_and_stands_once_it_is_let_go() {
    let mut room = room();
    assert_eq!(moved(&mut room, 300, false), 0.0, "started, and nobody holds the key");
    assert_eq!((room.phase(), run_key(&room)), (TrialPhase::Holding, RunKeyView::Awaited));
    let mut room = dressing();
    for _ in 0..3 {
        // A key that repeats late is held still.
        room.beats(20, unaltered);
        assert_eq!(room.phase(), TrialPhase::Dressing);
        assert!(moved(&mut room, 50, true) > 0.0);
        room.beats(32, unaltered);
        assert_eq!(room.phase(), TrialPhase::Holding, "let go for 0.3 s");
        room.beats(BRAKING_BEATS, unaltered);
        assert_eq!(moved(&mut room, 500, false), 0.0);
        assert!(moved(&mut room, 100, true) > 0.0, "{}", room.hold_cause());
    }
}

#[test]
fn s_46_the_key_takes_up_nothing_that_holds_for_another_reason() {
    let mut room = dressing();
    room.beats(40, unaltered);
    assert_eq!(run_key(&room), RunKeyView::Awaited);
    // While the key is let go the force falls silent, and comes back.
    room.beats(30, |input| (!matches!(input, Input::Endpoint(_))).then_some(input));
    room.beats(BRAKING_BEATS, unaltered);
    assert!(room.hold_cause().contains("force"), "{}", room.hold_cause());
    assert!(!room.ask(Command::Run).is_accepted());
    assert_eq!(moved(&mut room, 100, true), 0.0);
    // The operator's own hold counts as much, be it asked for while the key is let go.
    assert!(room.ask(Command::Continue).is_accepted());
    held(&mut room, 50);
    room.beats(BRAKING_BEATS + 40, unaltered);
    room.ask(Command::Hold);
    assert_eq!(moved(&mut room, 100, true), 0.0);
    assert!(room.ask(Command::Continue).is_accepted());
    assert_eq!(moved(&mut room, 100, false), 0.0, "continued, and nobody holds the key");
    assert!(moved(&mut room, 100, true) > 0.0);
}

#[test]
fn s_46_the_key_is_no_way_round_a_stop_and_no_other_node_may_press_it() {
    let mut room = dressing();
    assert!(!room.ask_from(Command::Run, Origin::RosService).is_accepted());
    room.ask(Command::Stop);
    assert_eq!(moved(&mut room, 100, true), 0.0);
    for act in [Command::Reset, Command::Enable, Command::Start] {
        assert!(room.ask(act).is_accepted());
        assert_eq!(moved(&mut room, 60, true), 0.0);
    }
    assert!(room.ask(Command::Continue).is_accepted());
    assert!(moved(&mut room, 100, true) > 0.0);
}

#[test]
fn s_46_a_withdrawal_needs_the_key_too_and_stays_one() {
    let mut room = dressing();
    room.ask(Command::Hold);
    room.beats(BRAKING_BEATS, unaltered);
    assert!(room.ask(Command::Withdraw).is_accepted());
    room.beats(2, unaltered);
    assert_eq!(moved(&mut room, 100, false), 0.0);
    for _ in 0..3 {
        assert!(moved(&mut room, 60, true) > 0.0);
        assert_eq!(room.phase(), TrialPhase::Withdrawing, "{}", room.hold_cause());
        let share = room.supervisor.snapshot(room.now).trial.speed_share.unwrap();
        assert!(share <= 0.5, "as slow as every withdrawal: {share}");
        room.beats(BRAKING_BEATS + 40, unaltered);
    }
}

#[test]
fn s_46_without_the_setting_the_key_does_nothing() {
    let mut room = Room::dressing();
    assert!(!room.ask(Command::Run).is_accepted());
    assert_eq!(run_key(&room), RunKeyView::NotNeeded);
    assert!(moved(&mut room, 100, false) > 0.0);
}
