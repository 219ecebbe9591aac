use super::*;
use crate::body::Side;
use crate::kinematics::RobotModel;
use crate::robot::dummy::{DummyLimb, Told};
use proptest::prelude::*;
use std::sync::LazyLock;

static MODEL: LazyLock<RobotModel> = LazyLock::new(|| RobotModel::baxter().unwrap());
/// A posture whose gripper is well inside the workspace.
const HOME: [f64; 7] = [-0.04, -0.15, 0.30, 1.44, -0.80, -0.65, 0.0];

fn at(milliseconds: u64) -> Stamp {
    Stamp::from_nanoseconds(milliseconds * 1_000_000)
}

fn guarded() -> GuardedLimb<DummyLimb> {
    let arm = MODEL.arm(Side::Right).clone();
    let latch = Arc::new(AtomicBool::new(false));
    let mut limb =
        GuardedLimb::new(DummyLimb::default(), arm, MotionLimits::default(), GuardSettings::default(), latch);
    limb.observe(at(1000), &HOME.map(Some));
    limb
}

fn refused(limb: &mut GuardedLimb<DummyLimb>, now: Stamp, joints: &JointVector) -> LimitBreach {
    let before = limb.inner().told.len();
    let error = limb.command(now, joints).unwrap_err();
    assert_eq!(limb.inner().told.len(), before, "nothing is sent");
    match error {
        CommandError::Refused(breach) => breach,
        CommandError::Port(error) => panic!("{error}"),
    }
}

#[test]
fn a_command_inside_all_limits_passes_unchanged() {
    let mut limb = guarded();
    let joints = JointVector::from(HOME);
    limb.command(at(1010), &joints).unwrap();
    assert_eq!(limb.inner().told, [(at(1010), Told::Command(joints))]);
    assert_eq!(limb.joints(), Some(joints));
}

#[test]
fn a_position_outside_the_limits_or_no_number_is_refused_by_name() {
    for value in [3.2, f64::NAN, f64::INFINITY] {
        let mut joints = JointVector::from(HOME);
        joints[5] = value;
        let breach = refused(&mut guarded(), at(1010), &joints);
        assert_eq!(breach.what, Limit::JointPosition { joint: "right_w1".into() });
    }
}

#[test]
fn stale_or_missing_joint_positions_are_refused() {
    let joints = JointVector::from(HOME);
    let breach = refused(&mut guarded(), at(1101), &joints);
    assert_eq!(breach.what, Limit::Freshness { side: Side::Right });
    assert!((breach.value - 0.101).abs() < 1e-9);
    let mut limb = guarded();
    limb.measured[3] = None;
    assert_eq!(refused(&mut limb, at(1010), &joints).what, Limit::Freshness { side: Side::Right });
}

#[test]
fn one_joint_that_is_not_heard_of_any_more_is_enough() {
    let mut limb = guarded();
    let mut newer = HOME.map(Some);
    newer[4] = None;
    limb.observe(at(1200), &newer);
    let breach = refused(&mut limb, at(1210), &JointVector::from(HOME));
    assert_eq!(breach.what, Limit::Freshness { side: Side::Right });
}

#[test]
fn after_the_clock_went_back_the_next_command_is_a_first_one() {
    let mut limb = guarded();
    let mut joints = JointVector::from(HOME);
    limb.command(at(1010), &joints).unwrap();
    limb.observe(at(500), &HOME.map(Some));
    joints[2] += 0.06;
    assert!(matches!(refused(&mut limb, at(510), &joints).what, Limit::Following { .. }));
    limb.command(at(510), &JointVector::from(HOME)).unwrap();
}

#[test]
fn what_was_sent_before_the_clock_went_back_does_not_count_again_when_the_clock_comes_there_once_more() {
    let mut limb = guarded();
    let mut joints = JointVector::from(HOME);
    limb.command(at(1010), &joints).unwrap();
    joints[2] += 0.06;
    for now in (510..1200).step_by(10) {
        limb.observe(at(now), &HOME.map(Some));
        let what = refused(&mut limb, at(now), &joints).what;
        assert!(matches!(what, Limit::Following { .. }), "at {now} ms: {what:?}");
    }
}

#[test]
fn joints_measured_before_the_clock_went_back_do_not_count_any_more() {
    let mut limb = guarded();
    let joints = JointVector::from(HOME);
    for now in [500, 1010] {
        assert_eq!(refused(&mut limb, at(now), &joints).what, Limit::Freshness { side: Side::Right }, "at {now} ms");
    }
}

#[test]
fn a_first_command_far_from_where_the_arm_is_is_refused() {
    let mut joints = JointVector::from(HOME);
    joints[2] += 0.06;
    let breach = refused(&mut guarded(), at(1010), &joints);
    assert_eq!(breach.what, Limit::Following { joint: "right_e0".into() });
}

#[test]
fn a_step_faster_than_the_joint_may_move_is_refused_with_its_speed() {
    let mut limb = guarded();
    let mut joints = JointVector::from(HOME);
    limb.command(at(1000), &joints).unwrap();
    joints[0] += 0.02;
    let breach = refused(&mut limb, at(1010), &joints);
    assert_eq!(breach.what, Limit::JointSpeed { joint: "right_s0".into() });
    assert!((breach.value - 2.0).abs() < 1e-9);
}

#[test]
fn a_sudden_start_is_refused_with_its_acceleration() {
    let mut limb = guarded();
    let mut joints = JointVector::from(HOME);
    limb.command(at(1000), &joints).unwrap();
    joints[1] -= 0.005;
    let breach = refused(&mut limb, at(1010), &joints);
    assert_eq!(breach.what, Limit::JointAcceleration { joint: "right_s1".into() });
}

/// A gentle start to 0.3 rad/s; then a command that is `late` milliseconds late, which holds the place of
/// `ticks` ticks of motion.
fn moving_then_late(late: u64, ticks: u64) -> (GuardedLimb<DummyLimb>, u64, JointVector) {
    let mut limb = guarded();
    let (mut joints, mut speed, mut now) = (JointVector::from(HOME), 0.0_f64, 1000);
    for _ in 0..40 {
        now += 10;
        limb.observe(at(now), &<[f64; 7]>::from(joints).map(Some));
        speed = (speed + 0.01).min(0.3);
        joints[2] += speed * 0.01;
        limb.command(at(now), &joints).unwrap();
    }
    now += 10 + late;
    limb.observe(at(now), &<[f64; 7]>::from(joints).map(Some));
    joints[2] += 0.3 * 0.01 * ticks as f64;
    (limb, now, joints)
}

#[test]
fn after_a_late_beat_a_motion_that_goes_on_as_planned_passes() {
    for (late, ticks) in [(10, 2), (30, 2), (60, 2), (30, 4)] {
        let (mut limb, now, mut joints) = moving_then_late(late, ticks);
        limb.command(at(now), &joints).unwrap();
        joints[2] += 0.003;
        limb.command(at(now + 10), &joints).unwrap();
    }
}

#[test]
fn a_beat_that_comes_early_after_a_late_one_passes() {
    let (mut limb, now, mut joints) = moving_then_late(15, 2);
    limb.command(at(now), &joints).unwrap();
    for _ in 0..3 {
        let early = limb.sent.unwrap().stamp + Duration::from_millis(2);
        joints[2] += 0.3 * 0.002;
        limb.command(early, &joints).unwrap();
    }
}

#[test]
fn a_late_beat_excuses_no_jump_and_no_sudden_stop_that_follows() {
    let (mut limb, now, mut joints) = moving_then_late(30, 30);
    assert_eq!(refused(&mut limb, at(now), &joints).what, Limit::JointSpeed { joint: "right_e0".into() });
    joints[2] -= 0.003 * 28.0;
    limb.command(at(now), &joints).unwrap();
    let breach = refused(&mut limb, at(now + 10), &joints);
    assert_eq!(breach.what, Limit::JointAcceleration { joint: "right_e0".into() });
}

#[test]
fn an_arm_that_does_not_follow_is_refused() {
    let mut limb = guarded();
    let joints = JointVector::from(HOME);
    limb.command(at(1000), &joints).unwrap();
    let mut held = HOME;
    held[6] -= 0.4;
    limb.observe(at(1005), &held.map(Some));
    let breach = refused(&mut limb, at(1010), &joints);
    assert_eq!(breach.what, Limit::Following { joint: "right_w2".into() });
}

#[test]
fn a_gripper_that_would_leave_the_workspace_is_refused_and_one_outside_may_come_back() {
    let mut limb = guarded();
    let here = MODEL.arm(Side::Right).forward(&JointVector::from(HOME)).translation.vector;
    limb.limits.workspace.upper.x = here.x - 0.01;
    let mut joints = JointVector::from(HOME);
    joints[1] += 0.001;
    let tip = |joints: &JointVector| MODEL.arm(Side::Right).forward(joints).translation.vector.x;
    let (outward, inward) = if tip(&joints) > here.x { (0.001, -0.001) } else { (-0.001, 0.001) };
    joints[1] = HOME[1] + outward;
    let breach = refused(&mut limb, at(1010), &joints);
    assert_eq!(breach.what, Limit::Workspace { side: Side::Right, axis: 'x' });
    joints[1] = HOME[1] + inward;
    limb.command(at(1010), &joints).unwrap();
}

#[test]
fn nothing_passes_while_the_stop_latch_is_set() {
    let mut limb = guarded();
    limb.latch.store(true, Ordering::SeqCst);
    assert_eq!(refused(&mut limb, at(1010), &JointVector::from(HOME)).what, Limit::StopLatch);
    limb.latch.store(false, Ordering::SeqCst);
    limb.command(at(1020), &JointVector::from(HOME)).unwrap();
}

#[test]
fn after_a_pause_the_next_command_must_be_where_the_arm_is() {
    let mut limb = guarded();
    limb.command(at(1000), &JointVector::from(HOME)).unwrap();
    let mut sunk = HOME;
    sunk[1] += 0.2;
    limb.observe(at(1300), &sunk.map(Some));
    let breach = refused(&mut limb, at(1310), &JointVector::from(HOME));
    assert_eq!(breach.what, Limit::Following { joint: "right_s1".into() });
    limb.command(at(1320), &JointVector::from(sunk)).unwrap();
}

#[test]
fn a_hold_is_never_refused_and_forgets_the_command() {
    let mut limb = guarded();
    limb.command(at(1000), &JointVector::from(HOME)).unwrap();
    limb.latch.store(true, Ordering::SeqCst);
    limb.hold(at(1010));
    assert_eq!(limb.inner().told.last(), Some(&(at(1010), Told::Hold)));
    assert_eq!(limb.joints(), Some(JointVector::from(HOME)), "measured again");
}

#[test]
fn a_port_that_fails_is_passed_on() {
    let mut limb = guarded();
    limb.inner.failure = Some("no wire".into());
    let error = limb.command(at(1000), &JointVector::from(HOME)).unwrap_err();
    assert_eq!(error.to_string(), "the dummy limb does not work: no wire");
}

proptest! {
    #[test]
    fn whatever_is_asked_nothing_outside_the_limits_leaves(
        steps in proptest::collection::vec((proptest::array::uniform7(-0.03..0.03_f64), 1..40_u64), 1..40),
    ) {
        let mut limb = guarded();
        let mut now = 1000;
        let mut joints = JointVector::from(HOME);
        for (step, milliseconds) in steps {
            now += milliseconds;
            let wanted = joints + JointVector::from(step);
            limb.observe(at(now), &std::array::from_fn(|index| Some(joints[index])));
            if limb.command(at(now), &wanted).is_ok() {
                joints = wanted;
            }
        }
        let limits = MotionLimits::default();
        let told: Vec<_> = limb.inner().told.iter().collect();
        for pair in told.windows(2) {
            let ((before, Told::Command(from)), (after, Told::Command(to))) = (pair[0], pair[1]) else { continue };
            let seconds = after.since(*before).as_secs_f64().max(SHORTEST_STEP);
            if seconds < 0.2 {
                let share = ((to - from) / seconds).abs().component_div(&limits.joint_speed).max();
                prop_assert!(share <= 1.05 + 1e-9);
            }
            prop_assert!(MODEL.arm(Side::Right).limits().breach(to, JOINT_TOLERANCE).is_none());
        }
    }

    // A busy computer's beats come early and late; the supervisor lets a motion go on by what has passed, at most two beats'
    // worth. At the planned acceleration nothing of it may be refused.
    #[test]
    fn a_planned_motion_passes_however_its_beats_come(
        beats in proptest::collection::vec(5_000..60_000_u64, 1..200),
        hertz in 0.3..1.0_f64,
    ) {
        let turn = std::f64::consts::TAU * hertz;
        let limits = MotionLimits::default();
        let amplitude = limits.joint_acceleration[2] / (turn * turn);
        let amplitude = amplitude.min(0.9 * limits.joint_speed[2] / turn).min(0.3);
        let mut limb = guarded();
        let (mut now, mut passed) = (Stamp::from_nanoseconds(1_000_000_000), 0.0);
        limb.command(now, &JointVector::from(HOME)).unwrap();
        for beat in beats {
            now = now + Duration::from_micros(beat);
            passed += Duration::from_micros(beat.min(20_000)).as_secs_f64();
            let mut joints = JointVector::from(HOME);
            joints[2] += amplitude * (1.0 - (turn * passed).cos());
            limb.observe(now, &<[f64; 7]>::from(joints).map(Some));
            let sent = limb.command(now, &joints);
            prop_assert!(sent.is_ok(), "after {passed} s: {}", sent.unwrap_err());
        }
    }
}
