//! S-07 to S-09: a second stop on the way back, what a stop says of itself, and a robot that does not follow.

use super::room::{Room, unaltered};
use valet::command::Command;
use valet::snapshot::{StopView, TrialPhase};
use valet::supervisor::{Effect, Input, LinkEvent};

fn stop(room: &Room) -> StopView {
    room.supervisor.snapshot(room.now).stop.clone()
}

/// How many lines of the log since an effect bear these words.
fn told(room: &Room, since: usize, words: &str) -> usize {
    let lines = room.told[since..].iter();
    lines.filter(|effect| matches!(effect, Effect::Log { text, .. } if text.contains(words))).count()
}

#[test]
fn s_07_a_second_stop_on_the_way_back_makes_every_act_necessary_again() {
    let way = [Command::Reset, Command::Enable, Command::Start];
    for done in 1..=3 {
        let mut room = Room::dressing();
        room.ask(Command::Stop);
        room.beats(50, unaltered);
        for act in &way[..done] {
            assert!(room.ask(act.clone()).is_accepted(), "{act}");
            room.beats(60, unaltered);
        }
        room.ask(Command::Stop);
        let since = room.sent.len();
        room.beats(60, unaltered);
        assert!(!room.ask(Command::Enable).is_accepted(), "after {done} acts");
        assert!(!room.ask(Command::Start).is_accepted(), "after {done} acts");
        room.beats(60, unaltered);
        assert!(room.sent[since..].iter().all(|sent| sent.left.is_none() && sent.right.is_none()));
        for act in &way {
            assert!(room.ask(act.clone()).is_accepted(), "{act} after {done} acts and a second stop");
            room.beats(60, unaltered);
        }
        assert_eq!(room.phase(), TrialPhase::Holding);
    }
}

#[test]
fn s_08_the_first_cause_of_a_stop_and_its_time_outlive_all_that_follows() {
    let mut room = Room::dressing();
    room.world.press_red_button(true);
    room.beats(2, unaltered);
    let first = stop(&room);
    assert!(first.cause.contains("red button"), "{}", first.cause);
    room.ask(Command::Stop);
    room.step(&Input::Link(LinkEvent::MasterLost));
    room.beats(100, |input| (!matches!(input, Input::Endpoint(_))).then_some(input));
    room.ask(Command::Stop);
    room.beats(500, unaltered);
    let later = stop(&room);
    assert_eq!((later.cause, later.requested_at), (first.cause, first.requested_at));
}

#[test]
fn s_09_a_stop_that_the_robot_does_not_confirm_points_the_operator_to_the_red_button_once() {
    let mut room = Room::dressing();
    room.switch_is_cut = true;
    let since = room.told.len();
    room.ask(Command::Stop);
    room.beats(295, unaltered);
    assert_eq!(told(&room, since, "red button"), 0);
    room.beats(300, unaltered);
    assert_eq!(told(&room, since, "red button"), 1);
    assert!(stop(&room).confirmed_at.is_none());
}

#[test]
fn s_09_a_reset_and_an_enable_that_do_not_arrive_are_told_with_what_to_look_at() {
    let mut room = Room::dressing();
    room.ask(Command::Stop);
    room.beats(50, unaltered);
    room.switch_is_cut = true;
    let since = room.told.len();
    assert!(room.ask(Command::Reset).is_accepted());
    room.beats(400, unaltered);
    assert_eq!(told(&room, since, "does not answer the reset"), 1, "a robot that stays stopped");
    room.switch_is_cut = false;
    assert!(room.ask(Command::Reset).is_accepted());
    room.beats(60, unaltered);
    room.switch_is_cut = true;
    let since = room.told.len();
    assert!(room.ask(Command::Enable).is_accepted());
    room.beats(300, unaltered);
    assert_eq!(told(&room, since, "cable"), 1, "motors that stay off");
    assert!(!room.ask(Command::Start).is_accepted());
}
