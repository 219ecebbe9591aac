//! The engine with the guards of a session behind it: what the supervisor knows of the person reaches the port, and the port refuses.

use super::*;
use crate::body::{BodyPose, Evidence, JointEstimate, PerSide};
use crate::geometry::{Point, Vector};
use crate::kinematics::{BodyBuild, MotionLimits, dressing_orientation, start_postures};
use crate::robot::dummy::DummyLimb;
use crate::robot::{GuardSettings, GuardedLimb, GuardedPair};
use nalgebra::Matrix3;
use std::sync::atomic::AtomicBool;

/// An outlet as a session has it, with limbs that only remember.
struct Guarded {
    pair: GuardedPair<DummyLimb>,
    heard: Sender<Input>,
}

impl Outlet for Guarded {
    fn setpoint(&mut self, now: Stamp, side: Side, joints: &JointVector) -> Result<(), String> {
        self.pair.command(now, side, joints).map_err(|error| error.to_string())
    }
    fn release(&mut self, _: Side) {}
    fn surround(&mut self, scene: Scene) {
        self.pair.surround(scene);
    }
    fn plan(&mut self, _: PlanOrder) {}
    fn switch(&mut self, _: SwitchRequest) {}
    fn show(&mut self, _: &Snapshot) {}
    fn record(&mut self, _: Stamp, input: &Input, _: &[Effect]) {
        self.heard.send(input.clone()).unwrap();
    }
}

/// Both grippers in front of the robot, 0.4 m apart, and the right one `metres` further on towards the person.
fn postures(model: &RobotModel, metres: f64) -> (PerSide<JointVector>, JointVector) {
    let place = PerSide { left: Point::new(0.65, 0.2, 0.05), right: Point::new(0.65, -0.2, 0.05) };
    let orientations = PerSide { left: dressing_orientation(), right: dressing_orientation() };
    let limits = MotionLimits::default();
    let here = start_postures(model, &Scene::default(), &[place], &orientations, &limits).unwrap();
    let arm = model.arm(Side::Right);
    let mut pose = arm.forward(&here.right);
    pose.translation.vector += dressing_orientation() * Vector::z() * metres;
    (here, arm.inverse(&pose, &here.right).unwrap())
}

/// A person whose face is `metres` before the end of the right hand, which lies 0.015 m beyond the tip.
fn person_before(model: &RobotModel, here: &PerSide<JointVector>, metres: f64, stamp: Stamp) -> BodyPose {
    let build = BodyBuild::default();
    let tip = Point::from(model.arm(Side::Right).forward(&here.right).translation.vector);
    let face = tip + dressing_orientation() * Vector::z() * (0.015 + metres + build.head);
    let position = face - Vector::z() * build.head_height;
    let neck = JointEstimate { position, covariance: Matrix3::zeros(), confidence: 1.0, evidence: Evidence::Seen };
    BodyPose { stamp, neck: Some(neck), ..BodyPose::default() }
}

/// A bench whose limbs are guarded and measured where they are.
fn guarded(here: &PerSide<JointVector>, model: &RobotModel) -> (Bench, Receiver<Input>) {
    let mut bench = Bench::new(None);
    // Nothing here is timed: positions stay fresh however busy the computer is.
    let settings = GuardSettings { freshness: Duration::from_secs(3600), ..GuardSettings::default() };
    let limbs = PerSide::from_fn(|side| {
        let (arm, latch) = (model.arm(side).clone(), Arc::new(AtomicBool::new(false)));
        GuardedLimb::new(DummyLimb::default(), arm, MotionLimits::default(), settings.clone(), latch)
    });
    let mut pair = GuardedPair::new(limbs, model.clone(), MotionLimits::default());
    for (side, joints) in here.iter() {
        pair.observe(bench.worker.clock.now(), side, &std::array::from_fn(|index| Some(joints[index])));
    }
    let (heard, inputs) = unbounded();
    bench.worker.outlet = Box::new(Guarded { pair, heard });
    (bench, inputs)
}

/// What the port says to the right gripper's going on by 4 mm while a face is this far before the hand.
fn refusal(metres: f64) -> Option<String> {
    let model = RobotModel::baxter().unwrap();
    let (here, onward) = postures(&model, 0.004);
    let (mut bench, inputs) = guarded(&here, &model);
    let now = bench.worker.clock.now();
    bench.worker.step(&Input::Body(person_before(&model, &here, metres, now)));
    // The guards are told of the person at each beat.
    bench.worker.step(&Input::Tick);
    bench.worker.carry_out(bench.worker.clock.now(), Effect::Setpoint { side: Side::Right, joints: onward });
    inputs.try_iter().find_map(|input| match input {
        Input::SetpointRefused { side: Side::Right, reason } => Some(reason),
        _ => None,
    })
}

#[test]
fn a_person_who_is_closer_than_the_limit_is_refused_at_the_port_by_name_and_distance() {
    assert_eq!(refusal(0.030), None, "far enough");
    let words = refusal(0.011).unwrap();
    assert!(words.contains("within 0.00") && words.contains("of the person's head"), "{words}");
    assert!(words.contains("at least 0.0100 m is kept") && words.ends_with("further off would do"), "{words}");
}
