//! S-11, S-12, S-17 to S-19: forces from outside in the middle of a pass, and zeros of the force.

use super::room::{BRAKING_BEATS, Room, pulled, unaltered};
use valet::body::Side;
use valet::command::Command;
use valet::geometry::Vector;
use valet::snapshot::TrialPhase;

/// How far the right gripper goes within 60 beats that follow on 40 with the same pull.
fn way_under(pull: Vector) -> (f64, TrialPhase) {
    let mut room = Room::dressing();
    room.beats(40, pulled(pull));
    let since = room.sent.len();
    room.beats(60, pulled(pull));
    let places = room.places(Side::Right, since);
    (places.windows(2).map(|pair| (pair[1] - pair[0]).norm()).sum(), room.phase())
}

#[test]
fn s_11_a_growing_force_slows_pauses_and_stops_a_whole_trial() {
    // Upwards, where the garment itself pulls least; what it adds stays below a tier's width.
    let up = |newtons: f64| Vector::z() * newtons;
    let (free, phase) = way_under(up(0.0));
    assert_eq!(phase, TrialPhase::Dressing);
    let (slowed, phase) = way_under(up(13.0));
    assert!(phase != TrialPhase::Holding && slowed < 0.7 * free, "{slowed} m at 13 N, {free} m without");
    let mut room = Room::dressing();
    let cause = rises(&mut room, TrialPhase::Holding);
    assert!(cause.contains("pause from 15.0 N"), "{cause}");
    assert!(!room.supervisor.is_stopped());
    let cause = rises(&mut room, TrialPhase::Stopped);
    assert!(
        room.supervisor.is_stopped() && cause.contains("stop from 25.0 N"),
        "a force that grows in a hold: {cause}"
    );
}

/// A pull upwards that grows by 5 N a second until the trial is in this phase; why it is.
fn rises(room: &mut Room, until: TrialPhase) -> String {
    for beat in 0..800 {
        room.beats(1, pulled(Vector::z() * (0.05 * f64::from(beat))));
        if room.phase() == until {
            let seen = room.supervisor.snapshot(room.now);
            return format!("{}{}", seen.trial.hold_cause, seen.stop.cause);
        }
    }
    panic!("never {until:?}: {:?} {}", room.phase(), room.hold_cause());
}

#[test]
fn s_12_near_the_shoulder_a_whole_trial_pauses_at_half_the_force() {
    let mut room = Room::dressing();
    let shoulder = room.supervisor.trial().unwrap().joints(Side::Right)[2];
    let away = |room: &Room| {
        let gripper = room.places(Side::Right, room.sent.len() - 1);
        gripper.first().map_or(f64::INFINITY, |place| (place - shoulder).norm())
    };
    for _ in 0..3000 {
        if away(&room) < 0.11 {
            break;
        }
        room.beats(1, unaltered);
    }
    assert!(away(&room) < 0.12 && room.phase() == TrialPhase::Dressing, "{} m, {}", away(&room), room.hold_cause());
    let cause = rises(&mut room, TrialPhase::Holding);
    assert!(cause.contains("pause from 7.5 N"), "{cause}");
}

#[test]
fn s_19_no_zero_is_taken_while_the_arms_move_and_one_is_once_they_stand() {
    let mut room = Room::dressing();
    assert!(!room.ask(Command::Tare(Side::Right)).is_accepted());
    room.ask(Command::Hold);
    room.beats(BRAKING_BEATS, unaltered);
    room.beats(100, unaltered);
    let receipt = room.ask(Command::Tare(Side::Right));
    assert!(receipt.is_accepted(), "{receipt:?}");
}
