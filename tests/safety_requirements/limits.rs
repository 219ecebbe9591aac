//! S-34 and S-35: no setpoint leaves outside the limits, and the first one is where the arm is.

use super::room::{BEAT, BRAKING_BEATS, Room, unaltered};
use std::sync::Arc;
use std::sync::atomic::AtomicBool;
use valet::body::{PerSide, Side};
use valet::command::Command;
use valet::kinematics::{JointVector, MotionLimits};
use valet::robot::dummy::DummyLimb;
use valet::robot::{CommandError, GuardSettings, GuardedLimb, GuardedPair, Limit};
use valet::snapshot::TrialPhase;
use valet::supervisor::Input;

fn guarded(room: &Room) -> GuardedPair<DummyLimb> {
    let limits = MotionLimits::default();
    let limbs = PerSide::from_fn(|side| {
        let arm = room.model.arm(side).clone();
        GuardedLimb::new(
            DummyLimb::default(),
            arm,
            limits.clone(),
            GuardSettings::default(),
            Arc::new(AtomicBool::new(false)),
        )
    });
    GuardedPair::new(limbs, room.model.clone(), limits)
}

/// Offers a beat's setpoints to the guards.
fn offer(pair: &mut GuardedPair<DummyLimb>, room: &Room) -> Result<(), CommandError> {
    for (side, measured) in room.measured.iter() {
        if let Some(measured) = measured {
            let positions: [f64; 7] = (*measured).into();
            pair.observe(room.now, side, &positions.map(Some));
        }
    }
    let Some(sent) = room.sent.last() else { return Ok(()) };
    for (side, joints) in sent.iter() {
        if let Some(joints) = joints {
            pair.command(room.now, side, joints)?;
        }
    }
    Ok(())
}

#[test]
fn s_34_a_whole_pass_is_inside_all_limits_and_what_is_not_is_refused_and_held() {
    let mut room = Room::new();
    let mut pair = guarded(&room);
    let mut dressing_beats = 0;
    while dressing_beats < 300 {
        room.beat(&mut unaltered);
        offer(&mut pair, &room).unwrap();
        dressing_beats += usize::from(room.phase() == TrialPhase::Dressing);
        assert!(room.sent.len() < 6000, "no pass began");
    }
    let here = room.sent.last().unwrap().map(|_, joints| joints.unwrap());
    let refusal = |pair: &mut GuardedPair<DummyLimb>, joint: usize, by: f64| {
        let mut joints = here.right;
        joints[joint] += by;
        let before = pair.limb(Side::Right).inner().told.len();
        let error = pair.command(room.now + BEAT, Side::Right, &joints).unwrap_err();
        assert_eq!(pair.limb(Side::Right).inner().told.len(), before, "nothing was sent");
        error
    };
    let CommandError::Refused(range) = refusal(&mut pair, 5, 5.0) else { panic!("refused for its range") };
    assert!(matches!(range.what, Limit::JointPosition { .. }), "{range}");
    let CommandError::Refused(speed) = refusal(&mut pair, 3, 0.05) else { panic!("refused for its speed") };
    assert!(speed.to_string().contains("right"), "{speed}");
    // What the guard says goes back to the supervisor, as the engine does it.
    let refused = Input::SetpointRefused { side: Side::Right, reason: speed.to_string() };
    room.step(&refused);
    assert_eq!(room.phase(), TrialPhase::Holding);
    assert!(room.hold_cause().contains(&speed.to_string()), "{}", room.hold_cause());
    room.beats(BRAKING_BEATS, unaltered);
    let since = room.sent.len();
    room.beats(200, unaltered);
    assert_eq!(room.largest_step(since), 0.0);
}

#[test]
fn s_34_grippers_too_close_are_refused() {
    let mut room = Room::new();
    let mut pair = guarded(&room);
    room.beat(&mut unaltered);
    offer(&mut pair, &room).unwrap();
    // Each arm as it is, and the other one mirrored onto it: both grippers in one place.
    let measured = room.measured.map(|_, joints| joints.unwrap());
    let tip = |joints: &JointVector, side: Side| room.model.arm(side).forward(joints).translation.vector;
    let start = tip(&measured.right, Side::Right);
    let mut refused = None;
    let mut joints = measured.right;
    let mut now = room.now;
    // Turned inwards at the shoulder, slowly enough for every other limit.
    for beat in 0..4000 {
        now = now + BEAT;
        joints[0] += 0.001_f64.min(1e-5 * f64::from(beat));
        for (side, own) in [(Side::Right, joints), (Side::Left, measured.left)] {
            let positions: [f64; 7] = own.into();
            pair.observe(now, side, &positions.map(Some));
        }
        if let Err(CommandError::Refused(breach)) = pair.command(now, Side::Right, &joints) {
            refused = Some(breach);
            break;
        }
    }
    let breach = refused.expect("the arm went on into the other one");
    assert!(matches!(breach.what, Limit::GripperDistance | Limit::Clearance { .. }), "{breach}");
    assert!((tip(&joints, Side::Right) - start).norm() > 0.05, "not at once: {breach}");
}

#[test]
fn s_35_after_the_arm_was_moved_by_hand_the_first_setpoint_is_where_it_is_now() {
    let mut room = Room::dressing();
    assert!(room.ask(Command::Disable).is_accepted());
    room.beats(50, unaltered);
    // Somebody moves the arm while its motors are off.
    let moved = |mut input: Input| {
        if let Input::Joints(sample) = &mut input {
            for joint in sample.positions.right.iter_mut().flatten().take(2) {
                *joint += 0.04;
            }
        }
        Some(input)
    };
    room.beats(50, moved);
    assert!(room.ask(Command::Enable).is_accepted());
    room.beats(100, moved);
    let (since, measured) = (room.sent.len(), room.measured.right.unwrap());
    assert!(room.ask(Command::Continue).is_accepted());
    room.beats(30, moved);
    let first = room.sent[since..].iter().find_map(|sent| sent.right).expect("it went on");
    let off = (first - measured).amax();
    assert!(off < 0.01, "the first setpoint is {off} rad from the arm");
}

#[test]
fn s_35_a_first_setpoint_elsewhere_is_refused() {
    let mut room = Room::new();
    let mut pair = guarded(&room);
    room.beats(3, unaltered);
    let positions: [f64; 7] = room.measured.right.unwrap().into();
    pair.observe(room.now, Side::Right, &positions.map(Some));
    let mut joints = room.measured.right.unwrap();
    joints[2] += 0.2;
    let error = pair.command(room.now, Side::Right, &joints).unwrap_err();
    assert!(
        matches!(&error, CommandError::Refused(breach) if matches!(breach.what, Limit::Following { .. })),
        "{error}"
    );
    assert!(pair.limb(Side::Right).inner().told.is_empty());
}
