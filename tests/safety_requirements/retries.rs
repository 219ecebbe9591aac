//! S-45: after force has held a pass it goes on slower each time, three times at the most.

use super::room::{BRAKING_BEATS, Room, pulled, unaltered};
use valet::body::Side;
use valet::command::Command;
use valet::geometry::Vector;
use valet::kinematics::MotionLimits;
use valet::snapshot::TrialPhase;

/// A pull that holds the trial, and is gone again once the arms stand.
fn held_for_force(room: &mut Room) {
    room.until_with(TrialPhase::Holding, pulled(Vector::new(0.0, 0.0, -18.0)));
    assert!(room.hold_cause().contains("force"), "{}", room.hold_cause());
    room.beats(BRAKING_BEATS, unaltered);
    room.beats(100, unaltered);
}

/// The right gripper's highest speed within some beats that follow, m/s.
fn fastest(room: &mut Room, beats: usize) -> f64 {
    let since = room.sent.len();
    room.beats(beats, unaltered);
    let places = room.places(Side::Right, since);
    places.windows(2).map(|pair| (pair[1] - pair[0]).norm() / 0.01).fold(0.0, f64::max)
}

#[test]
fn s_45_after_force_has_held_a_pass_it_goes_on_slower_each_time_and_the_fourth_time_not_at_all() {
    let mut room = Room::dressing();
    let limit = MotionLimits::default().speed;
    for share in [0.5, 0.25, 0.125] {
        held_for_force(&mut room);
        let receipt = room.ask(Command::Continue);
        assert!(receipt.is_accepted(), "at {share}: {receipt:?}");
        let speed = fastest(&mut room, 60);
        assert!(speed > 0.0 && speed < 1.1 * share * limit, "{speed} m/s at a share of {share}");
        assert_eq!(room.phase(), TrialPhase::Dressing, "{}", room.hold_cause());
    }
    held_for_force(&mut room);
    assert!(!room.ask(Command::Continue).is_accepted());
    assert!(room.hold_cause().contains("withdraw the garment, or abort"), "{}", room.hold_cause());
    // The way out is open, and the next pass begins with all its retries.
    assert!(room.ask(Command::Withdraw).is_accepted());
    room.until(TrialPhase::Waiting);
    assert!(room.ask(Command::GoAhead).is_accepted());
    room.until(TrialPhase::Dressing);
    assert!(fastest(&mut room, 300) > 0.6 * limit);
    held_for_force(&mut room);
    assert!(room.ask(Command::Continue).is_accepted());
}

#[test]
fn s_45_a_hold_of_the_operator_is_no_retry() {
    let mut room = Room::dressing();
    for _ in 0..6 {
        room.ask(Command::Hold);
        room.beats(BRAKING_BEATS, unaltered);
        let receipt = room.ask(Command::Continue);
        assert!(receipt.is_accepted(), "{receipt:?}");
        room.beats(20, unaltered);
    }
}
