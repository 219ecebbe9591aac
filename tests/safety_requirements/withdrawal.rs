//! S-41: the garment can be withdrawn from every hold.

use super::room::{BRAKING_BEATS, Room, pulled, unaltered};
use valet::body::Side;
use valet::command::Command;
use valet::geometry::{Point, Vector};
use valet::kinematics::MotionLimits;
use valet::snapshot::TrialPhase;
use valet::supervisor::{Input, LinkEvent};

/// How far a place is from a path of places.
fn distance(place: &Point, path: &[Point]) -> f64 {
    path.iter().map(|point| (point - place).norm()).fold(f64::INFINITY, f64::min)
}

/// From a hold: the garment is withdrawn along the path that was travelled, slowly, back to where the pass began.
fn withdraws(mut room: Room, what: &str, mut alter: impl FnMut(Input) -> Option<Input>) {
    assert_eq!(room.phase(), TrialPhase::Holding, "{what}");
    room.beats(BRAKING_BEATS, &mut alter);
    let travelled = room.places(Side::Right, 0);
    let since = room.sent.len();
    let receipt = room.ask(Command::Withdraw);
    assert!(receipt.is_accepted(), "{what}: {receipt:?}");
    room.until_with(TrialPhase::Waiting, &mut alter);
    let back = room.places(Side::Right, since);
    let far = back.iter().map(|place| distance(place, &travelled)).fold(0.0, f64::max);
    assert!(far < 0.01, "{what}: {far} m off the travelled path");
    let fastest = back.windows(2).map(|pair| (pair[1] - pair[0]).norm() / 0.01).fold(0.0, f64::max);
    let limit = MotionLimits::default().speed;
    assert!(fastest < 0.55 * limit, "{what}: {fastest} m/s");
    let hand = room.supervisor.trial().unwrap().joints(Side::Right)[0];
    let end = back.last().unwrap();
    assert!((end - hand).norm() < 0.05, "{what}: it ends {end}, the pass began at {hand}");
}

#[test]
fn s_41_from_a_hold_of_the_operator_the_garment_is_withdrawn() {
    let mut room = Room::dressing();
    room.ask(Command::Hold);
    withdraws(room, "operator", unaltered);
}

#[test]
fn s_41_from_a_hold_for_force_that_stays_the_garment_is_withdrawn() {
    let mut room = Room::dressing();
    let pull = Vector::new(0.0, 0.0, -18.0);
    room.until_with(TrialPhase::Holding, pulled(pull));
    room.beats(BRAKING_BEATS, pulled(pull));
    assert!(!room.ask(Command::Continue).is_accepted(), "18 N stand: forward is refused");
    withdraws(room, "force", pulled(pull));
}

#[test]
fn s_41_a_withdrawal_that_pulls_more_than_its_beginning_is_held() {
    let mut room = Room::dressing();
    room.until_with(TrialPhase::Holding, pulled(Vector::new(0.0, 0.0, -17.0)));
    room.beats(BRAKING_BEATS, pulled(Vector::new(0.0, 0.0, -17.0)));
    assert!(room.ask(Command::Withdraw).is_accepted());
    room.beats(30, pulled(Vector::new(0.0, 0.0, -17.0)));
    assert_eq!(room.phase(), TrialPhase::Withdrawing);
    room.beats(30, pulled(Vector::new(0.0, 0.0, -22.0)));
    assert_eq!(room.phase(), TrialPhase::Holding);
    assert!(room.hold_cause().contains("force"), "{}", room.hold_cause());
}

#[test]
fn s_41_without_the_camera_the_garment_is_withdrawn() {
    let mut room = Room::dressing();
    let blind = |input: Input| (!matches!(input, Input::Body(_))).then_some(input);
    room.until_with(TrialPhase::Holding, blind);
    assert!(!room.ask(Command::Continue).is_accepted());
    withdraws(room, "camera", blind);
}

#[test]
fn s_41_without_a_master_the_garment_is_withdrawn() {
    let mut room = Room::dressing();
    room.step(&Input::Link(LinkEvent::MasterLost));
    room.until(TrialPhase::Holding);
    assert!(room.hold_cause().contains("master"), "{}", room.hold_cause());
    room.beats(BRAKING_BEATS, unaltered);
    assert!(!room.ask(Command::Continue).is_accepted(), "no way forward without a master");
    withdraws(room, "master", unaltered);
}

#[test]
fn s_41_after_the_motors_were_off_the_garment_is_withdrawn() {
    let mut room = Room::dressing();
    room.ask(Command::Disable);
    room.beats(100, unaltered);
    assert!(!room.ask(Command::Withdraw).is_accepted(), "nothing moves while the motors are off");
    room.ask(Command::Enable);
    room.beats(100, unaltered);
    withdraws(room, "motors", unaltered);
}

#[test]
fn s_41_after_a_stop_the_garment_is_withdrawn_once_the_three_acts_were_done() {
    let mut room = Room::dressing();
    room.ask(Command::Stop);
    room.beats(100, unaltered);
    for command in [Command::Reset, Command::Enable, Command::Start] {
        assert!(!room.ask(Command::Withdraw).is_accepted(), "before {command}");
        assert!(room.ask(command).is_accepted());
        room.beats(100, unaltered);
    }
    withdraws(room, "stop", unaltered);
}

#[test]
fn s_41_where_the_garment_is_on_no_arm_nothing_moves_on() {
    let mut room = Room::new();
    room.until(TrialPhase::Positioning);
    room.beats(50, unaltered);
    room.ask(Command::Hold);
    room.beats(BRAKING_BEATS, unaltered);
    let since = room.sent.len();
    assert!(!room.ask(Command::Withdraw).is_accepted());
    room.beats(100, unaltered);
    assert_eq!((room.phase(), room.largest_step(since)), (TrialPhase::Holding, 0.0));
}
