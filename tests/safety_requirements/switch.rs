//! S-01 to S-06, S-10, S-40, S-44: stop, reset, enable and start of a whole trial, with a wire to the robot's switch that may be cut.

use super::room::{BRAKING_BEATS, Room, unaltered};
use valet::assembly::SwitchRequest;
use valet::command::Command;
use valet::snapshot::TrialPhase;
use valet::supervisor::Effect;

/// How often a request left since an effect.
fn asked(room: &Room, since: usize, wanted: SwitchRequest) -> usize {
    room.told[since..].iter().filter(|effect| matches!(effect, Effect::Switch(request) if *request == wanted)).count()
}

fn sends_nothing(room: &mut Room, beats: usize) {
    let since = room.sent.len();
    room.beats(beats, unaltered);
    let sent = room.sent[since..].iter().filter(|sent| sent.left.is_some() || sent.right.is_some()).count();
    assert_eq!(sent, 0, "{:?}", room.phase());
}

#[test]
fn s_01_in_the_middle_of_a_pass_nothing_moves_after_a_stop_before_all_three_acts() {
    let mut room = Room::dressing();
    assert!(room.ask(Command::Stop).is_accepted());
    sends_nothing(&mut room, 100);
    for command in [Command::Reset, Command::Enable, Command::Start] {
        for other in [Command::Continue, Command::Withdraw, Command::GoAhead, Command::NextIteration] {
            assert!(!room.ask(other.clone()).is_accepted(), "{other} before {command}");
        }
        assert!(room.ask(command).is_accepted());
        room.beats(60, unaltered);
    }
    // The three acts release the stop; the trial itself waits for one more.
    assert_eq!(room.phase(), TrialPhase::Holding);
    room.beats(BRAKING_BEATS, unaltered);
    let since = room.sent.len();
    room.beats(100, unaltered);
    assert_eq!(room.largest_step(since), 0.0);
    assert!(room.ask(Command::Continue).is_accepted());
}

#[test]
fn s_02_reset_alone_moves_nothing_and_leaves_the_robot_disabled() {
    let mut room = Room::dressing();
    room.ask(Command::Stop);
    room.beats(50, unaltered);
    assert!(room.ask(Command::Reset).is_accepted());
    sends_nothing(&mut room, 300);
    let robot = room.supervisor.snapshot(room.now).robot.state.unwrap();
    assert!(!robot.stopped && !robot.enabled, "{robot:?}");
    assert!(room.supervisor.is_stopped(), "the latch is closed still");
}

#[test]
fn s_03_enable_while_the_robot_is_stopped_asks_the_robot_for_nothing() {
    let mut room = Room::dressing();
    room.ask(Command::Stop);
    room.beats(50, unaltered);
    let since = room.told.len();
    assert!(!room.ask(Command::Enable).is_accepted());
    room.beats(100, unaltered);
    assert_eq!((asked(&room, since, SwitchRequest::Enable), asked(&room, since, SwitchRequest::Reset)), (0, 0));
    assert!(room.supervisor.snapshot(room.now).robot.state.unwrap().stopped);
}

#[test]
fn s_04_while_the_red_button_is_down_no_reset_leaves() {
    let mut room = Room::dressing();
    room.world.press_red_button(true);
    room.beats(10, unaltered);
    let since = room.told.len();
    assert!(!room.ask(Command::Reset).is_accepted());
    room.beats(100, unaltered);
    assert_eq!(asked(&room, since, SwitchRequest::Reset), 0);
    room.world.press_red_button(false);
    room.beats(10, unaltered);
    assert!(room.ask(Command::Reset).is_accepted());
}

#[test]
fn s_05_a_stop_that_does_not_arrive_is_asked_for_at_every_beat_and_never_called_confirmed() {
    let mut room = Room::dressing();
    room.switch_is_cut = true;
    let since = room.told.len();
    assert!(room.ask(Command::Stop).is_accepted());
    sends_nothing(&mut room, 100);
    assert!(asked(&room, since, SwitchRequest::Stop) >= 100);
    let stop = |room: &Room| room.supervisor.snapshot(room.now).stop.clone();
    assert!(stop(&room).latched && stop(&room).confirmed_at.is_none());
    room.switch_is_cut = false;
    room.beats(5, unaltered);
    assert!(stop(&room).confirmed_at.is_some());
    let since = room.told.len();
    room.beats(50, unaltered);
    assert_eq!(asked(&room, since, SwitchRequest::Stop), 0, "confirmed: no need to ask again");
}

#[test]
fn s_06_the_red_button_in_the_middle_of_a_pass_latches_valet_too_and_is_named() {
    let mut room = Room::dressing();
    room.world.press_red_button(true);
    room.beats(5, unaltered);
    let stop = room.supervisor.snapshot(room.now).stop.clone();
    assert!(stop.latched && stop.cause.contains("red button"), "{stop:?}");
    sends_nothing(&mut room, 100);
    room.world.press_red_button(false);
    sends_nothing(&mut room, 100);
}

#[test]
fn s_10_start_is_refused_while_the_robot_is_disabled() {
    let mut room = Room::dressing();
    assert!(room.ask(Command::Abort).is_accepted());
    assert!(room.ask(Command::Disable).is_accepted());
    room.beats(50, unaltered);
    assert!(!room.ask(Command::Start).is_accepted());
    sends_nothing(&mut room, 50);
    assert!(room.ask(Command::Enable).is_accepted());
    room.beats(100, unaltered);
    assert!(room.ask(Command::Start).is_accepted());
}

#[test]
fn s_40_a_robot_that_is_disabled_and_enabled_again_takes_nothing_up() {
    let mut room = Room::dressing();
    assert!(room.ask(Command::Disable).is_accepted());
    room.beats(50, unaltered);
    sends_nothing(&mut room, 50);
    assert!(room.ask(Command::Enable).is_accepted());
    sends_nothing(&mut room, 200);
    assert_eq!(room.phase(), TrialPhase::Holding);
    assert!(room.ask(Command::Continue).is_accepted());
}

#[test]
fn s_44_arms_whose_commander_is_gone_stand_within_the_robots_own_time_out() {
    let mut room = Room::dressing();
    let before = room.measured.right.unwrap();
    room.beats(10, unaltered);
    assert!((room.measured.right.unwrap() - before).amax() > 0.0, "the arm moves");
    // The node dies: nothing more is decided, and the world goes on. 0.2 s of time-out and what the arm lags.
    let at_death = room.measured.right.unwrap();
    room.world_alone(50);
    let stood = room.measured.right.unwrap();
    assert!((stood - at_death).amax() < 0.05, "the arm went on");
    room.world_alone(100);
    assert!((room.measured.right.unwrap() - stood).amax() < 2e-3, "and stands but for the encoders' steps");
}
