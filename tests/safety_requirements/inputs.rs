//! S-15, S-21 to S-24, S-26 to S-33: in the middle of a pass an input is lost, spoilt, late or foreign. The trial holds in its
//! time and says why, nothing moves by itself, and it goes on when the operator acts.

use super::room::{BRAKING_BEATS, Room, unaltered};
use std::time::Duration;
use valet::body::Side;
use valet::command::Command;
use valet::snapshot::TrialPhase;
use valet::supervisor::{Input, LinkEvent};

/// What a fault makes of an input.
type Fault = fn(Input) -> Option<Input>;

/// From now on nothing moves, whatever comes in: beyond braking.
fn stands(room: &mut Room, fault: Fault) {
    let since = room.sent.len();
    room.beats(100, fault);
    assert_eq!((room.phase(), room.largest_step(since)), (TrialPhase::Holding, 0.0), "{}", room.hold_cause());
}

/// A hold that began with these words stands after its cause has gone, and ends when the operator acts.
fn ends_by_the_operator(room: &mut Room, words: &str) {
    assert!(room.hold_cause().contains(words), "{}", room.hold_cause());
    room.beats(BRAKING_BEATS, unaltered);
    stands(room, unaltered);
    assert!(room.ask(Command::Continue).is_accepted(), "after {words}");
    let since = room.sent.len();
    room.beats(200, unaltered);
    assert!(room.largest_step(since) > 0.0, "it goes on after {words}");
}

/// A fault that stands: the trial goes on for `before` beats, holds within `until`, and cannot be continued while it stands.
fn holds(before: usize, until: usize, words: &str, fault: Fault) {
    let mut room = Room::dressing();
    room.beats(before, fault);
    assert_eq!(room.phase(), TrialPhase::Dressing, "{words}: too early, {}", room.hold_cause());
    room.beats(until - before, fault);
    assert_eq!(room.phase(), TrialPhase::Holding, "{words}: not within {until} beats");
    room.beats(BRAKING_BEATS, fault);
    stands(&mut room, fault);
    assert!(!room.ask(Command::Continue).is_accepted(), "{words}: it still stands");
    ends_by_the_operator(&mut room, words);
}

#[test]
fn s_21_an_arm_whose_force_falls_silent_is_held_after_60_ms() {
    holds(5, 8, "the right force", |input| {
        (!matches!(&input, Input::Endpoint(sample) if sample.side == Side::Right)).then_some(input)
    });
    // The other arm only carries the garment: it counts as much.
    holds(5, 8, "the left force", |input| {
        (!matches!(&input, Input::Endpoint(sample) if sample.side == Side::Left)).then_some(input)
    });
}

#[test]
fn s_22_an_arm_whose_joints_fall_silent_or_lack_one_is_held_after_100_ms() {
    holds(9, 12, "the right arm's joints", |mut input| {
        if let Input::Joints(sample) = &mut input {
            sample.positions.right = [None; 7];
        }
        Some(input)
    });
    holds(9, 12, "not all in the robot's messages", |mut input| {
        if let Input::Joints(sample) = &mut input {
            sample.positions.right[3] = None;
        }
        Some(input)
    });
}

#[test]
fn s_22_a_joint_that_is_no_number_is_held_at_once() {
    holds(0, 2, "not finite", |mut input| {
        if let Input::Joints(sample) = &mut input {
            sample.positions.right[3] = Some(f64::NAN);
        }
        Some(input)
    });
}

#[test]
fn s_23_while_the_robots_state_is_silent_it_is_held_and_told_nothing() {
    let silent: Fault = |input| (!matches!(input, Input::Robot(_))).then_some(input);
    holds(9, 12, "the robot's state", silent);
    let mut room = Room::dressing();
    room.beats(15, silent);
    let since = room.sent.len();
    room.beats(100, silent);
    let told = room.sent[since..].iter().filter(|sent| sent.left.is_some() || sent.right.is_some()).count();
    assert_eq!(told, 0, "a robot of which nothing is known gets no setpoint");
}

#[test]
fn s_24_a_person_who_is_not_seen_slows_and_then_holds_the_trial() {
    let blind: Fault = |input| (!matches!(input, Input::Body(_))).then_some(input);
    holds(190, 215, "the person's pose", blind);
    let way = |fault: Fault| {
        let mut room = Room::dressing();
        room.beats(100, fault);
        let since = room.sent.len();
        room.beats(60, fault);
        let places = room.places(Side::Right, since);
        places.windows(2).map(|pair| (pair[1] - pair[0]).norm()).sum::<f64>()
    };
    let (seen, unseen) = (way(unaltered), way(blind));
    assert!(unseen > 0.0 && unseen < 0.7 * seen, "{unseen} m unseen, {seen} m seen");
}

#[test]
fn s_26_a_screen_that_was_there_and_falls_silent_holds_the_trial_after_a_second() {
    let mut room = Room::dressing();
    for _ in 0..50 {
        room.step(&Input::Link(LinkEvent::ConsoleBeat));
        room.beats(1, unaltered);
    }
    room.beats(98, unaltered);
    assert_eq!(room.phase(), TrialPhase::Dressing);
    room.beats(5, unaltered);
    assert_eq!(room.phase(), TrialPhase::Holding);
    assert!(room.hold_cause().contains("console"), "{}", room.hold_cause());
    room.step(&Input::Link(LinkEvent::ConsoleBeat));
    stands_after_braking(&mut room);
}

fn stands_after_braking(room: &mut Room) {
    room.beats(BRAKING_BEATS, unaltered);
    stands(room, unaltered);
}

#[test]
fn s_27_a_clock_that_jumps_either_way_and_a_beat_that_is_late_hold_the_trial() {
    let ahead = |room: &mut Room, span: Duration| room.now = room.now + span;
    let mut room = Room::dressing();
    ahead(&mut room, Duration::from_millis(150));
    room.beats(1, unaltered);
    ends_by_the_operator(&mut room, "ms late");
    let mut room = Room::dressing();
    ahead(&mut room, Duration::from_secs(5));
    room.beats(1, unaltered);
    assert_eq!(room.phase(), TrialPhase::Holding);
    assert!(room.hold_cause().contains("ahead"), "{}", room.hold_cause());
    stands_after_braking(&mut room);
    let mut room = Room::dressing();
    let (world_goes_on, before) = (room.now, room.now.nanoseconds());
    room.now = valet::time::Stamp::from_nanoseconds(before - 500_000_000);
    room.step(&Input::Tick);
    assert_eq!(room.phase(), TrialPhase::Holding);
    assert!(room.hold_cause().contains("went back"), "{}", room.hold_cause());
    room.now = world_goes_on;
    stands_after_braking(&mut room);
}

#[test]
fn s_28_a_force_that_freezes_is_held_after_50_samples_although_messages_come() {
    holds(45, 53, "frozen", |mut input| {
        if let Input::Endpoint(sample) = &mut input
            && sample.side == Side::Right
        {
            sample.wrench.force = [1.0, 0.0, 0.5].into();
        }
        Some(input)
    });
}

#[test]
fn s_15_a_force_that_is_no_number_is_held_at_once_and_never_taken_for_none() {
    holds(0, 2, "not finite", |mut input| {
        if let Input::Endpoint(sample) = &mut input
            && sample.side == Side::Right
        {
            sample.wrench.force.y = f64::NAN;
        }
        Some(input)
    });
}

#[test]
fn s_29_after_the_robots_own_contact_the_trial_stays_held_when_the_robot_would_go_on() {
    let mut room = Room::dressing();
    room.step(&Input::Collision { side: Side::Left, active: true });
    room.beats(200, unaltered);
    assert!(!room.ask(Command::Continue).is_accepted(), "the robot still pauses");
    // By itself the robot goes on now.
    room.step(&Input::Collision { side: Side::Left, active: false });
    ends_by_the_operator(&mut room, "contact on its left arm");
}

#[test]
fn s_30_motors_that_somebody_else_switches_off_and_on_do_not_take_the_trial_up_again() {
    let mut room = Room::dressing();
    room.beats(10, |mut input| {
        if let Input::Robot(state) = &mut input {
            state.enabled = false;
        }
        Some(input)
    });
    room.beats(2, unaltered);
    ends_by_the_operator(&mut room, "somebody else");
}

#[test]
fn s_31_a_foreign_publisher_holds_the_trial_by_name_until_it_is_gone() {
    let mut room = Room::dressing();
    let who = || ("/robot/limb/left/joint_command".to_owned(), "/other_valet".to_owned());
    let (topic, node) = who();
    room.step(&Input::Link(LinkEvent::ForeignPublisher { topic, node }));
    room.beats(BRAKING_BEATS, unaltered);
    stands(&mut room, unaltered);
    assert!(!room.ask(Command::Continue).is_accepted(), "it still publishes");
    let (topic, node) = who();
    room.step(&Input::Link(LinkEvent::ForeignPublisherGone { topic, node }));
    ends_by_the_operator(&mut room, "/other_valet");
}

#[test]
fn s_33_messages_that_were_kept_back_and_come_in_a_burst_do_not_count_as_fresh() {
    let mut room = Room::dressing();
    let mut kept = Vec::new();
    room.beats(30, |input| match input {
        Input::Endpoint(sample) if sample.side == Side::Right => {
            kept.push(input);
            None
        }
        other => Some(other),
    });
    assert_eq!(room.phase(), TrialPhase::Holding);
    // All but the newest 0.1 s at once.
    kept.truncate(20);
    kept.iter().for_each(|input| room.step(input));
    room.beats(1, |input| (!matches!(&input, Input::Endpoint(sample) if sample.side == Side::Right)).then_some(input));
    assert!(!room.ask(Command::Continue).is_accepted(), "old news are no news");
    ends_by_the_operator(&mut room, "the right force");
}

#[test]
fn s_32_of_two_causes_each_must_be_gone_before_the_operator_can_go_on_and_nothing_goes_on_by_itself() {
    let mut room = Room::dressing();
    let silent: Fault =
        |input| (!matches!(&input, Input::Endpoint(sample) if sample.side == Side::Left)).then_some(input);
    room.step(&Input::Link(LinkEvent::MasterLost));
    room.beats(BRAKING_BEATS, silent);
    stands(&mut room, silent);
    assert!(!room.ask(Command::Continue).is_accepted(), "both stand");
    room.step(&Input::Link(LinkEvent::MasterBack));
    stands(&mut room, silent);
    assert!(!room.ask(Command::Continue).is_accepted(), "one stands");
    room.beats(50, unaltered);
    // Ten seconds without a cause, and without an act.
    for _ in 0..10 {
        stands(&mut room, unaltered);
    }
    assert!(room.ask(Command::Continue).is_accepted());
}
