//! The stop and the way back, row by row of the robot's state table, and in every order.

use super::*;
use crate::assembly::StopSource;
use proptest::prelude::*;

fn at(milliseconds: u64) -> Stamp {
    Stamp::from_nanoseconds(1_000_000_000 + milliseconds * 1_000_000)
}

fn running() -> RobotState {
    RobotState { enabled: true, ready: Some(true), ..RobotState::default() }
}

fn disabled() -> RobotState {
    RobotState { ready: Some(false), ..RobotState::default() }
}

fn stopped_by_software() -> RobotState {
    RobotState { stopped: true, button: RedButton::Unknown, source: StopSource::Unknown, ..RobotState::default() }
}

fn button_down() -> RobotState {
    RobotState { stopped: true, button: RedButton::Pressed, source: StopSource::User, ..RobotState::default() }
}

fn button_released() -> RobotState {
    RobotState { button: RedButton::Released, ..button_down() }
}

fn stopped() -> StopState {
    let mut latch = StopState::default();
    latch.request(at(0), "the operator");
    latch.observe(at(10), &stopped_by_software());
    latch
}

#[test]
fn s_01_reset_enable_and_start_are_three_acts_in_this_order() {
    let mut latch = stopped();
    assert_eq!(latch.enable(Some(&stopped_by_software())), Err(StopRefusal::ResetFirst));
    assert_eq!(latch.start(Some(&stopped_by_software())), Err(StopRefusal::ResetFirst));
    latch.reset(at(30), Some(&stopped_by_software())).unwrap();
    latch.observe(at(40), &disabled());
    assert_eq!((latch.phase(), latch.is_latched()), (StopPhase::Disabled, true));
    assert_eq!(latch.start(Some(&disabled())), Err(StopRefusal::EnableFirst));
    latch.enable(Some(&disabled())).unwrap();
    latch.observe(at(70), &running());
    assert_eq!((latch.phase(), latch.is_latched()), (StopPhase::Enabled, true));
    latch.start(Some(&running())).unwrap();
    assert!(!latch.is_latched());
}

#[test]
fn s_02_reset_alone_leaves_the_latch_closed_whatever_the_robot_then_says() {
    for after in [disabled(), running(), stopped_by_software()] {
        let mut latch = stopped();
        latch.reset(at(20), Some(&stopped_by_software())).unwrap();
        latch.observe(at(30), &after);
        assert!(latch.is_latched(), "{after:?}");
        assert!(latch.start(Some(&after)).is_err(), "{after:?}");
    }
}

#[test]
fn s_03_enable_is_refused_while_the_robot_is_stopped_and_resets_nothing() {
    let mut latch = StopState::default();
    assert_eq!(latch.enable(Some(&stopped_by_software())), Err(StopRefusal::ResetFirst));
    let mut latch = stopped();
    latch.reset(at(20), Some(&stopped_by_software())).unwrap();
    assert_eq!(latch.enable(Some(&stopped_by_software())), Err(StopRefusal::ResetFirst));
    assert_eq!(latch.phase(), StopPhase::Resetting);
}

#[test]
fn s_04_reset_is_refused_while_the_red_button_is_down_and_allowed_once_it_is_released() {
    let mut latch = StopState::default();
    latch.observe(at(0), &button_down());
    assert_eq!(latch.reset(at(10), Some(&button_down())), Err(StopRefusal::ButtonDown));
    assert_eq!(latch.enable(Some(&button_down())), Err(StopRefusal::ButtonDown));
    assert_eq!(latch.start(Some(&button_down())), Err(StopRefusal::ButtonDown));
    latch.observe(at(20), &button_released());
    assert_eq!(latch.reset(at(30), Some(&button_released())), Ok(()));
}

#[test]
fn s_05_a_stop_is_confirmed_only_by_the_robot_and_asked_for_again_until_then() {
    let mut latch = StopState::default();
    latch.request(at(0), "the operator");
    latch.observe(at(10), &running());
    assert!(!latch.is_confirmed() && latch.needs_repeat());
    assert_eq!(latch.reset(at(15), Some(&running())), Err(StopRefusal::NotConfirmed));
    latch.observe(at(20), &stopped_by_software());
    assert!(latch.is_confirmed() && !latch.needs_repeat());
    assert_eq!((latch.requested_at(), latch.confirmed_at()), (Some(at(0)), Some(at(20))));
}

#[test]
fn s_06_a_robot_that_stops_by_itself_latches_and_says_why() {
    let cases = [
        (button_down(), "red button is down"),
        (button_released(), "red button was pressed"),
        (RobotState { source: StopSource::Fault, ..stopped_by_software() }, "fault of a joint"),
        (RobotState { source: StopSource::Brain, ..stopped_by_software() }, "lost its computer"),
        (stopped_by_software(), "other software"),
    ];
    for (state, words) in cases {
        let mut latch = StopState::default();
        let cause = latch.observe(at(0), &state).unwrap();
        assert!(cause.contains(words), "{cause}");
        assert!(latch.is_latched() && latch.is_confirmed());
        assert_eq!(latch.observe(at(10), &state), None, "told once");
    }
}

#[test]
fn s_07_a_stop_on_the_way_back_begins_the_way_anew() {
    for acts in 0..4 {
        let mut latch = stopped();
        if acts > 0 {
            latch.reset(at(20), Some(&stopped_by_software())).unwrap();
        }
        if acts > 1 {
            latch.observe(at(30), &disabled());
        }
        if acts > 2 {
            latch.enable(Some(&disabled())).unwrap();
            latch.observe(at(50), &running());
        }
        latch.request(at(60), "again");
        assert!(latch.start(Some(&running())).is_err(), "after {acts} acts");
        assert!(latch.enable(Some(&running())).is_err(), "after {acts} acts");
    }
}

#[test]
fn s_08_the_first_cause_and_its_time_stay() {
    let mut latch = StopState::default();
    assert!(latch.request(at(1), "force 26 N"));
    assert!(!latch.request(at(2), "the operator"));
    assert_eq!((latch.cause(), latch.requested_at()), ("force 26 N", Some(at(1))));
}

#[test]
fn s_09_a_stop_that_is_not_confirmed_within_3_s_is_told_once() {
    let mut latch = StopState::default();
    latch.request(at(0), "the operator");
    assert!(!latch.becomes_overdue(at(3000)));
    assert!(latch.becomes_overdue(at(3001)) && !latch.becomes_overdue(at(3010)), "once");
    latch.observe(at(3020), &stopped_by_software());
    latch.reset(at(3030), Some(&stopped_by_software())).unwrap();
    latch.request(at(4000), "again");
    assert!(!latch.becomes_overdue(at(6999)) && latch.becomes_overdue(at(7001)), "and anew for the next stop");
    assert!(!stopped().becomes_overdue(at(9000)), "a confirmed stop owes nothing");
}

#[test]
fn s_10_start_needs_a_robot_that_is_known_enabled_ready_and_without_fault() {
    let mut latch = StopState::default();
    assert_eq!(latch.start(None), Err(StopRefusal::StateUnknown));
    assert_eq!(latch.enable(None), Err(StopRefusal::StateUnknown));
    assert_eq!(latch.reset(at(0), None), Err(StopRefusal::StateUnknown));
    assert_eq!(latch.start(Some(&disabled())), Err(StopRefusal::EnableFirst));
    let homing = RobotState { ready: Some(false), ..running() };
    assert_eq!(latch.start(Some(&homing)), Err(StopRefusal::NotReady));
    let faulty = RobotState { error: true, ..running() };
    assert_eq!(latch.start(Some(&faulty)), Err(StopRefusal::RobotFault));
    let older_release = RobotState { ready: None, ..running() };
    assert_eq!(latch.start(Some(&older_release)), Ok(()));
}

#[test]
fn s_01_somebody_else_who_resets_and_enables_does_not_open_the_latch() {
    let mut latch = stopped();
    latch.observe(at(20), &disabled());
    latch.observe(at(30), &running());
    assert!(latch.is_latched());
    assert_eq!(latch.enable(Some(&running())), Err(StopRefusal::ResetFirst));
    assert_eq!(latch.start(Some(&running())), Err(StopRefusal::ResetFirst));
}

#[test]
fn motors_that_go_off_again_before_start_must_be_enabled_again() {
    let mut latch = stopped();
    latch.reset(at(20), Some(&stopped_by_software())).unwrap();
    latch.observe(at(30), &disabled());
    latch.enable(Some(&disabled())).unwrap();
    latch.observe(at(50), &running());
    latch.observe(at(60), &disabled());
    assert_eq!(latch.phase(), StopPhase::Disabled);
    assert_eq!(latch.start(Some(&running())), Err(StopRefusal::EnableFirst));
}

#[test]
fn a_fault_without_a_stop_comes_back_by_the_same_three_acts() {
    let faulty = RobotState { error: true, ..disabled() };
    let mut latch = StopState::default();
    latch.reset(at(0), Some(&faulty)).unwrap();
    latch.observe(at(10), &faulty);
    assert_eq!(latch.phase(), StopPhase::Resetting);
    latch.observe(at(20), &disabled());
    assert_eq!(latch.phase(), StopPhase::Disabled);
}

#[test]
fn there_is_nothing_to_reset_without_a_stop() {
    assert_eq!(StopState::default().reset(at(0), Some(&running())), Err(StopRefusal::NotStopped));
}

#[derive(Clone, Copy, Debug)]
enum Act {
    Stop,
    Reset,
    Enable,
    Start,
    Robot(u8),
}

fn state(kind: u8) -> RobotState {
    [running(), disabled(), stopped_by_software(), button_down(), button_released()][usize::from(kind) % 5]
}

fn any_act() -> impl Strategy<Value = Act> {
    prop_oneof![
        Just(Act::Stop),
        Just(Act::Reset),
        Just(Act::Enable),
        Just(Act::Start),
        (0_u8..5).prop_map(Act::Robot),
        (0_u8..5).prop_map(Act::Robot)
    ]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]

    #[test]
    fn s_01_after_a_stop_the_latch_opens_only_by_accepted_reset_enable_and_start(acts in proptest::collection::vec(any_act(), 1..60)) {
        let mut latch = StopState::default();
        let mut robot = running();
        // How many of the three acts were accepted, in order, since the last stop; 3 where none is in force.
        let mut accepted = 3;
        for (index, act) in acts.into_iter().enumerate() {
            let now = at(index as u64 * 10);
            match act {
                Act::Stop => {
                    latch.request(now, "the operator");
                    accepted = 0;
                }
                Act::Robot(kind) => {
                    robot = state(kind);
                    if latch.observe(now, &robot).is_some() {
                        accepted = 0;
                    }
                }
                Act::Reset => if latch.reset(now, Some(&robot)).is_ok() { accepted = 1 },
                Act::Enable => if latch.enable(Some(&robot)).is_ok() && accepted == 1 { accepted = 2 },
                Act::Start => if latch.start(Some(&robot)).is_ok() {
                    prop_assert!(accepted >= 2, "opened after {} acts", accepted);
                    prop_assert!(robot.enabled && !robot.stopped);
                    accepted = 3;
                },
            }
            prop_assert_eq!(latch.is_latched(), accepted != 3);
        }
    }
}
