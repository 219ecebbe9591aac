use super::*;
use crate::body::{PerSide, Side};
use crate::geometry::Point;
use crate::kinematics::{
    JointVector, MotionLimits, RobotModel, Scene, Target, dressing_orientation, plan_pair, start_postures,
};
use crate::robot::dummy::{DummyLimb, Told};
use crate::robot::{GuardSettings, GuardedLimb, Limit};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, LazyLock};
use std::time::Duration;

static MODEL: LazyLock<RobotModel> = LazyLock::new(|| RobotModel::baxter().unwrap());
static MOTION: LazyLock<PairMotion> = LazyLock::new(|| {
    let (scene, limits) = (Scene::default(), MotionLimits::default());
    let place = PerSide { left: Point::new(0.65, 0.2, 0.05), right: Point::new(0.65, -0.2, 0.05) };
    let orientations = PerSide { left: dressing_orientation(), right: dressing_orientation() };
    let start = start_postures(&MODEL, &scene, &[place], &orientations, &limits).unwrap();
    let targets = PerSide {
        left: Some(Target::position(Point::new(0.70, 0.2, -0.02))),
        right: Some(Target::position(Point::new(0.70, -0.2, -0.02))),
    };
    plan_pair(&MODEL, &scene, &start, &targets, &limits).unwrap()
});
const START: Stamp = Stamp::from_nanoseconds(5_000_000_000);

struct Setup {
    pair: GuardedPair<DummyLimb>,
    latch: Arc<AtomicBool>,
}

fn setup() -> Setup {
    let latch = Arc::new(AtomicBool::new(false));
    let limb = |side: Side| {
        let arm = MODEL.arm(side).clone();
        let settings = GuardSettings::default();
        GuardedLimb::new(DummyLimb::default(), arm, MotionLimits::default(), settings, Arc::clone(&latch))
    };
    let limbs = PerSide { left: limb(Side::Left), right: limb(Side::Right) };
    Setup { pair: GuardedPair::new(limbs, MODEL.clone(), MotionLimits::default()), latch }
}

/// The robot follows at once: it measures what the motion says.
fn measure(handle: &mut MotionHandle<'_, DummyLimb>, now: Stamp) {
    let joints = handle.motion.sample(now.since(handle.start)).map(|_, setpoint| setpoint.joints);
    for (side, joints) in joints.iter() {
        handle.pair.observe(now, side, &std::array::from_fn(|index| Some(joints[index])));
    }
}

fn last_told(pair: &GuardedPair<DummyLimb>, side: Side) -> Told {
    pair.limb(side).inner().told.last().unwrap().1
}

#[test]
fn a_motion_passes_its_guards_tick_by_tick_and_arrives() {
    let Setup { mut pair, .. } = setup();
    let mut handle = MotionHandle::begin(&mut pair, MOTION.clone(), START);
    let mut now = START;
    let ticks = loop {
        measure(&mut handle, now);
        match handle.step(now).unwrap() {
            Progress::Arrived => break now.since(START),
            Progress::Moving => now = now + Duration::from_millis(10),
        }
    };
    assert!(ticks >= MOTION.duration());
    drop(handle);
    for side in Side::BOTH {
        let end: JointVector = MOTION.sample(MOTION.duration()).get(side).joints;
        assert_eq!(last_told(&pair, side), Told::Command(end), "an arrived motion needs no hold");
    }
}

#[test]
fn dropping_a_motion_handle_stops_the_motion() {
    let Setup { mut pair, .. } = setup();
    {
        let mut handle = MotionHandle::begin(&mut pair, MOTION.clone(), START);
        for tick in 0..50 {
            let now = START + Duration::from_millis(10 * tick);
            measure(&mut handle, now);
            assert_eq!(handle.step(now), Ok(Progress::Moving));
        }
    }
    for side in Side::BOTH {
        assert_eq!(last_told(&pair, side), Told::Hold);
    }
}

#[test]
fn a_refused_step_makes_both_arms_hold() {
    let Setup { mut pair, latch } = setup();
    let mut handle = MotionHandle::begin(&mut pair, MOTION.clone(), START);
    measure(&mut handle, START);
    handle.step(START).unwrap();
    latch.store(true, Ordering::SeqCst);
    let now = START + Duration::from_millis(10);
    measure(&mut handle, now);
    match handle.step(now) {
        Err(CommandError::Refused(breach)) => assert_eq!(breach.what, Limit::StopLatch),
        other => panic!("{other:?}"),
    }
    for side in Side::BOTH {
        assert_eq!(last_told(handle.pair, side), Told::Hold);
    }
}

#[test]
fn a_halt_brakes_inside_the_guards_limits_and_arrives_at_rest() {
    let Setup { mut pair, .. } = setup();
    let mut handle = MotionHandle::begin(&mut pair, MOTION.clone(), START);
    let mut now = START;
    for tick in 0..400 {
        measure(&mut handle, now);
        if tick == 150 {
            handle.halt(now);
        }
        if handle.step(now).unwrap() == Progress::Arrived {
            break;
        }
        now = now + Duration::from_millis(10);
    }
    assert!(now.since(START) < Duration::from_millis(1500) + Duration::from_secs(1));
    assert!(handle.arrived);
}
