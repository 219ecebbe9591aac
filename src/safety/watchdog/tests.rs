//! Every input lost, late, frozen or foreign, one at a time.

use super::*;
use crate::safety::Reaction::{Clear, Hold, Slow};

fn at(milliseconds: u64) -> Stamp {
    Stamp::from_nanoseconds(1_000_000_000 + milliseconds * 1_000_000)
}

const JOINTS: [Option<f64>; 7] = [Some(0.1); 7];

fn enabled() -> RobotState {
    RobotState { enabled: true, ..RobotState::default() }
}

/// What does not come in any more, or not as it should, after half a second in which everything did.
#[derive(Clone, Copy, PartialEq)]
enum Missing {
    Nothing,
    Only(Watch),
}

/// One beat of 10 ms in which everything comes in but what is missing.
fn beat(watchdogs: &mut Watchdogs, now: u64, missing: Missing) {
    let here = |watch: Watch| missing != Missing::Only(watch);
    for side in Side::BOTH {
        if here(Watch::Force(side)) {
            watchdogs.force(at(now), side, at(now), Vector::new(now as f64 * 0.001, 0.0, 0.0));
        }
        if here(Watch::Joints(side)) {
            watchdogs.joints(at(now), side, at(now), &JOINTS);
        }
    }
    if here(Watch::RobotState) {
        watchdogs.robot(at(now), &enabled());
    }
    if here(Watch::Pose) && now.is_multiple_of(30) {
        watchdogs.pose(at(now), at(now));
    }
    if here(Watch::Console) {
        watchdogs.console(at(now));
    }
    if here(Watch::Tick) {
        watchdogs.tick(at(now));
    }
}

fn running() -> Watchdogs {
    let mut watchdogs = Watchdogs::new(WatchSettings::default());
    for now in (0..=600).step_by(10) {
        beat(&mut watchdogs, now, Missing::Nothing);
        assert_eq!(watchdogs.judge(at(now)), Verdict::clear(), "at {now}");
    }
    watchdogs
}

/// Milliseconds after the last good message at which the reaction begins.
fn reacts_after(watch: Watch, reaction: Reaction) -> u64 {
    let mut watchdogs = running();
    for now in (610..5000).step_by(10) {
        beat(&mut watchdogs, now, Missing::Only(watch));
        for millisecond in now..now + 10 {
            if watchdogs.judge(at(millisecond)).reaction >= reaction {
                return millisecond - 600;
            }
        }
    }
    panic!("{watch:?} is never missed");
}

#[test]
fn s_21_a_force_older_than_60_ms_holds() {
    for side in Side::BOTH {
        assert_eq!(reacts_after(Watch::Force(side), Hold), 61);
    }
}

#[test]
fn s_22_joints_older_than_100_ms_hold() {
    for side in Side::BOTH {
        assert_eq!(reacts_after(Watch::Joints(side), Hold), 101);
    }
}

#[test]
fn s_23_a_robot_state_older_than_100_ms_holds() {
    assert_eq!(reacts_after(Watch::RobotState, Hold), 101);
}

#[test]
fn s_24_a_lost_pose_slows_after_500_ms_and_holds_after_2_s() {
    assert_eq!(reacts_after(Watch::Pose, Slow), 501);
    assert_eq!(reacts_after(Watch::Pose, Hold), 2001);
}

#[test]
fn s_25_a_planner_that_is_200_ms_late_holds() {
    let mut watchdogs = running();
    watchdogs.planner_asked(at(600));
    beat(&mut watchdogs, 610, Missing::Nothing);
    watchdogs.require_only(&[]);
    assert_eq!(watchdogs.judge(at(800)).reaction, Clear);
    assert_eq!(watchdogs.judge(at(801)).reaction, Hold);
    watchdogs.planner_answered();
    watchdogs.acknowledge();
    assert_eq!(watchdogs.judge(at(802)).reaction, Clear);
}

#[test]
fn s_26_a_console_that_was_there_and_is_gone_for_1_s_holds() {
    assert_eq!(reacts_after(Watch::Console, Hold), 1001);
    let mut without_console = Watchdogs::new(WatchSettings::default());
    without_console.require_only(&[]);
    assert_eq!(without_console.judge(at(9000)).reaction, Clear);
}

#[test]
fn s_27_a_clock_that_jumps_and_a_beat_that_is_late_hold() {
    for (next, words) in [(500, "went back"), (2700, "ahead at once"), (760, "160 ms late")] {
        let mut watchdogs = running();
        watchdogs.require_only(&[]);
        watchdogs.tick(at(next));
        let cause = watchdogs.latched().map(|(watch, cause)| (watch, cause.to_owned())).next().unwrap();
        assert_eq!(cause.0, Watch::Tick);
        assert!(cause.1.contains(words), "{}", cause.1);
        assert_eq!(watchdogs.judge(at(next)).reaction, Hold);
    }
}

#[test]
fn s_27_inputs_of_before_the_clock_went_back_are_old_when_the_clock_comes_there_again() {
    let mut watchdogs = running();
    watchdogs.tick(at(500));
    watchdogs.acknowledge();
    // The last inputs were those of 600 ms.
    for now in [505, 600, 605] {
        let verdict = watchdogs.judge(at(now));
        assert_eq!(verdict.reaction, Hold, "at {now} ms: {}", verdict.cause);
    }
}

#[test]
fn s_28_a_frozen_force_is_a_fault_and_never_zero() {
    let mut watchdogs = running();
    for (count, now) in (610..).step_by(10).take(50).enumerate() {
        beat(&mut watchdogs, now, Missing::Only(Watch::Force(Side::Left)));
        watchdogs.force(at(now), Side::Left, at(now), Vector::zeros());
        let expected = if count + 1 < 50 { Clear } else { Hold };
        assert_eq!(watchdogs.judge(at(now)).reaction, expected, "sample {count}");
    }
    assert!(watchdogs.readiness(at(1100)).unwrap_err().contains("frozen"));
}

#[test]
fn s_28_a_force_that_is_not_finite_or_saturated_is_a_fault() {
    for (bad, words) in [(f64::NAN, "not finite"), (f64::INFINITY, "not finite"), (151.0, "cannot measure")] {
        let mut watchdogs = running();
        watchdogs.force(at(605), Side::Right, at(605), Vector::new(0.0, 0.0, -bad));
        let verdict = watchdogs.judge(at(606));
        assert_eq!(verdict.reaction, Hold);
        assert!(verdict.cause.contains(words), "{}", verdict.cause);
    }
}

#[test]
fn s_22_joints_that_are_missing_from_the_messages_or_not_finite_hold() {
    let mut watchdogs = running();
    let mut partial = JOINTS;
    partial[3] = None;
    for now in (610..=720).step_by(10) {
        beat(&mut watchdogs, now, Missing::Only(Watch::Joints(Side::Left)));
        watchdogs.joints(at(now), Side::Left, at(now), &partial);
    }
    assert!(watchdogs.judge(at(720)).cause.contains("not all"), "{:?}", watchdogs.judge(at(720)));
    let mut watchdogs = running();
    watchdogs.joints(at(605), Side::Left, at(605), &[Some(f64::NAN); 7]);
    assert!(watchdogs.judge(at(606)).cause.contains("not finite"));
}

#[test]
fn messages_that_carry_only_the_fingers_are_not_joints_of_the_arm() {
    let mut watchdogs = running();
    for now in (610..=710).step_by(10) {
        beat(&mut watchdogs, now, Missing::Only(Watch::Joints(Side::Left)));
        watchdogs.joints(at(now), Side::Left, at(now), &[None; 7]);
    }
    assert_eq!(watchdogs.judge(at(710)).reaction, Hold);
}

#[test]
fn s_42_a_squeezed_cuff_holds_until_it_is_let_go_and_the_operator_acts() {
    let mut watchdogs = Watchdogs::new(WatchSettings::default());
    watchdogs.require_only(&[]);
    assert_eq!(watchdogs.cuff(Side::Left, false), None);
    let told = watchdogs.cuff(Side::Left, true);
    assert!(told.is_some_and(|cause| cause.contains("left arm's cuff")));
    assert_eq!(watchdogs.cuff(Side::Left, true), None, "a squeeze is told once");
    watchdogs.acknowledge();
    assert_eq!(watchdogs.judge(at(10)).reaction, Hold, "whoever continues before the hand has gone holds again");
    assert_eq!(watchdogs.cuff(Side::Left, false), None);
    let verdict = watchdogs.judge(at(20));
    assert!(verdict.reaction == Hold && verdict.cause.contains("left arm's cuff"), "{verdict:?}");
    watchdogs.acknowledge();
    assert_eq!(watchdogs.judge(at(30)).reaction, Clear);
}

#[test]
fn s_29_the_rising_edge_of_the_robots_own_contact_is_latched_beyond_its_two_seconds() {
    let mut watchdogs = Watchdogs::new(WatchSettings::default());
    let told = watchdogs.collision(Side::Right, true);
    assert!(told.is_some_and(|cause| cause.contains("right arm")));
    assert_eq!(watchdogs.collision(Side::Right, true), None, "an edge is told once");
    assert_eq!(watchdogs.collision(Side::Right, false), None);
    watchdogs.require_only(&[]);
    let verdict = watchdogs.judge(at(5000));
    assert_eq!(verdict.reaction, Hold);
    assert!(verdict.cause.contains("right arm"));
}

#[test]
fn s_30_motors_that_somebody_else_switches_are_held_and_valets_own_are_not() {
    for first in [true, false] {
        let mut watchdogs = running();
        watchdogs.robot(at(601), &RobotState { enabled: first, ..RobotState::default() });
        watchdogs.robot(at(602), &RobotState { enabled: !first, ..RobotState::default() });
        assert!(watchdogs.judge(at(603)).cause.contains("somebody else"), "first {first}");
    }
    let mut watchdogs = running();
    watchdogs.own_switching(at(600));
    watchdogs.robot(at(602), &RobotState::default());
    watchdogs.robot(at(604), &enabled());
    assert_eq!(watchdogs.judge(at(605)).reaction, Clear);
}

#[test]
fn s_31_a_foreign_publisher_is_named_and_held() {
    let mut watchdogs = running();
    watchdogs.foreign_publisher("/robot/limb/left/joint_command", "/other_valet");
    let verdict = watchdogs.judge(at(601));
    assert_eq!(verdict.reaction, Hold);
    assert!(verdict.cause.contains("/other_valet") && verdict.cause.contains("joint_command"));
    watchdogs.acknowledge();
    assert_eq!(watchdogs.judge(at(602)).reaction, Hold, "it still publishes");
    assert!(watchdogs.readiness(at(602)).unwrap_err().contains("/other_valet"));
    watchdogs.foreign_publisher_gone("/robot/limb/left/joint_command", "/other_valet");
    assert_eq!(watchdogs.judge(at(603)).reaction, Hold, "the operator has not acted");
    watchdogs.acknowledge();
    assert_eq!(watchdogs.judge(at(604)).reaction, Clear);
}

#[test]
fn s_31_a_master_that_is_gone_holds_until_it_is_back_and_the_operator_acts() {
    let mut watchdogs = running();
    watchdogs.master(false);
    assert!(watchdogs.judge(at(601)).cause.contains("roscore"));
    watchdogs.acknowledge();
    assert_eq!(watchdogs.judge(at(602)).reaction, Hold, "it is still gone");
    watchdogs.master(true);
    assert_eq!(watchdogs.judge(at(603)).reaction, Hold, "the operator has not acted");
    watchdogs.acknowledge();
    assert_eq!(watchdogs.judge(at(604)).reaction, Clear);
}

#[test]
fn s_32_a_hold_stays_after_its_cause_is_gone_until_the_operator_acknowledges_it() {
    let mut watchdogs = running();
    for now in (610..=700).step_by(10) {
        beat(&mut watchdogs, now, Missing::Only(Watch::Force(Side::Left)));
        watchdogs.judge(at(now));
    }
    for now in (710..=900).step_by(10) {
        beat(&mut watchdogs, now, Missing::Nothing);
        assert_eq!(watchdogs.judge(at(now)).reaction, Hold, "at {now}");
    }
    assert_eq!(watchdogs.readiness(at(900)), Ok(()), "the cause itself is gone");
    watchdogs.acknowledge();
    assert_eq!(watchdogs.judge(at(900)).reaction, Clear);
}

#[test]
fn s_32_acknowledging_a_cause_that_still_stands_does_not_help() {
    let mut watchdogs = running();
    watchdogs.judge(at(700));
    watchdogs.acknowledge();
    assert_eq!(watchdogs.judge(at(700)).reaction, Hold);
    assert!(watchdogs.readiness(at(700)).is_err());
}

#[test]
fn nothing_is_ready_before_everything_has_come_in() {
    let mut watchdogs = Watchdogs::new(WatchSettings::default());
    assert!(watchdogs.readiness(at(0)).unwrap_err().contains("nothing has come in"));
    beat(&mut watchdogs, 0, Missing::Nothing);
    assert_eq!(watchdogs.readiness(at(0)), Ok(()));
}

#[test]
fn a_stop_by_the_robot_is_no_foreign_switching() {
    let mut watchdogs = running();
    watchdogs.robot(at(601), &RobotState { stopped: true, ..RobotState::default() });
    assert_eq!(watchdogs.judge(at(602)).reaction, Clear);
}
