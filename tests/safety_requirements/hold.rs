//! S-39: in a hold nothing moves.

use super::room::{BRAKING_BEATS, Room, pulled, unaltered};
use valet::command::Command;
use valet::geometry::Vector;
use valet::snapshot::TrialPhase;
use valet::supervisor::Input;

#[test]
fn s_39_in_a_hold_nothing_moves_beyond_braking_until_the_operator_acts() {
    for beats in [0, 7, 33, 90, 210] {
        let mut room = Room::new();
        room.until(TrialPhase::Dressing);
        room.beats(beats, unaltered);
        assert!(room.ask(Command::Hold).is_accepted(), "{beats}");
        room.beats(BRAKING_BEATS, unaltered);
        let since = room.sent.len();
        // The world goes on: the person is felt and pulls, a pose is lost, messages come late.
        room.beats(500, pulled(Vector::new(-6.0, 2.0, 0.0)));
        room.beats(300, |input| (!matches!(input, Input::Body(_))).then_some(input));
        room.beats(700, unaltered);
        assert_eq!(room.phase(), TrialPhase::Holding);
        assert_eq!(room.largest_step(since), 0.0);
        let since = room.sent.len();
        assert!(room.ask(Command::Continue).is_accepted());
        room.beats(200, unaltered);
        assert!(room.largest_step(since) > 0.0, "the operator acted, and it goes on");
    }
}
