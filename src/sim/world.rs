//! Everything together: steps robot, garment, person and senses at 100 Hz of virtual time.

mod senses;
mod setup;

pub use setup::{Backend, SimError, WorldSetup};

use super::baxter::{SimulatedLimb, Switch, UNTUCKED_LEFT, UNTUCKED_RIGHT};
use super::faults::{ActiveFaults, FaultPlan};
use super::garment::{Garment, Holder, Wearing};
use super::person::{Exercise, Reaction, SimulatedPerson};
use super::random::{Purpose, Random};
use super::wrench::WrenchSense;
use crate::assembly::{RobotState, SwitchRequest};
use crate::body::{BodyPose, PerSide, Side};
use crate::geometry::{Point, Vector};
use crate::kinematics::{JointVector, RobotModel};
use crate::supervisor::{EndpointSample, Input, JointSample};
use crate::time::Stamp;
use senses::{Camera, ImpactDetection};
use std::collections::VecDeque;
use std::time::Duration;

/// The robot's beat: endpoint and joint states come at 100 Hz.
const TICK: Duration = Duration::from_millis(10);
const TICK_SECONDS: f64 = 0.01;

/// What the world says after a step: the messages of the beats that have passed, oldest first.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SimOutput {
    /// `/robot/limb/{s}/endpoint_state`, at 100 Hz an arm.
    pub endpoints: Vec<EndpointSample>,
    /// `/robot/joint_states`, at 100 Hz.
    pub joints: Vec<JointSample>,
    /// `/robot/state`, at 100 Hz.
    pub robot: Vec<RobotState>,
    /// `/robot/limb/{s}/collision_detection_state` with its beat, where it changed.
    pub collisions: Vec<(Side, bool)>,
    /// The person's pose as the camera's pose finder gives it, at 30 Hz.
    pub bodies: Vec<BodyPose>,
}

impl SimOutput {
    /// The same as the supervisor's inputs.
    pub fn into_inputs(self) -> impl Iterator<Item = Input> {
        let Self { endpoints, joints, robot, collisions, bodies } = self;
        (robot.into_iter().map(Input::Robot))
            .chain(joints.into_iter().map(Input::Joints))
            .chain(endpoints.into_iter().map(Input::Endpoint))
            .chain(collisions.into_iter().map(|(side, active)| Input::Collision { side, active }))
            .chain(bodies.into_iter().map(Input::Body))
    }
}

/// One arm of the robot with what it feels.
#[derive(Debug)]
struct RobotArm {
    limb: SimulatedLimb,
    sense: WrenchSense,
    impact: ImpactDetection,
    tip: Point,
    velocity: Vector,
    frozen: Option<crate::geometry::Wrench>,
    late: VecDeque<(Stamp, JointVector)>,
}

/// The simulated world.
#[derive(Debug)]
pub struct World {
    arms: PerSide<RobotArm>,
    switch: Switch,
    garment: Box<dyn Garment>,
    person: SimulatedPerson,
    reactions: PerSide<Reaction>,
    exercise: Exercise,
    camera: Camera,
    faults: FaultPlan,
    losses: Random,
    start: Option<Stamp>,
    ticks: u64,
}

impl World {
    /// A world at its beginning: the robot disabled with its arms untucked, the garment in both grippers, the person waiting.
    ///
    /// # Errors
    /// A person, garment or sense that cannot be, with what to correct.
    pub fn new(setup: &WorldSetup) -> Result<Self, SimError> {
        setup.check()?;
        let model = RobotModel::baxter()?;
        let seed = setup.seed;
        let arms = PerSide::from_fn(|side| {
            let (purpose, untucked) = match side {
                Side::Left => (Purpose::LeftWrench, UNTUCKED_LEFT),
                Side::Right => (Purpose::RightWrench, UNTUCKED_RIGHT),
            };
            let posture = JointVector::from(untucked);
            let limb = SimulatedLimb::new(model.arm(side).clone(), setup.dynamics, posture);
            let tip = limb.model().forward(&posture).translation.vector.into();
            RobotArm {
                limb,
                sense: WrenchSense::new(setup.wrench, Random::new(seed, purpose)),
                impact: ImpactDetection::default(),
                tip,
                velocity: Vector::zeros(),
                frozen: None,
                late: VecDeque::new(),
            }
        });
        let reactions = PerSide::from_fn(|side| {
            let purpose = if side == Side::Left { Purpose::LeftArm } else { Purpose::RightArm };
            Reaction::of(&setup.person.arm(side), setup.preferred_path(side), Random::new(seed, purpose))
        });
        Ok(Self {
            arms,
            switch: Switch::default(),
            garment: setup.garment_model(),
            person: setup.person.clone(),
            reactions,
            exercise: Exercise::new(seed, setup.exercise_seconds),
            camera: Camera::new(setup.pose_noise_metres, Random::new(seed, Purpose::Camera), setup.arms_hide_joints),
            faults: setup.faults.clone(),
            losses: Random::new(seed, Purpose::Faults),
            start: None,
            ticks: 0,
        })
    }

    /// Joint positions for an arm (radians, s0 to w2), in position mode: they hold for 0.2 s and are ignored while the robot
    /// is disabled.
    pub fn command_joints(&mut self, side: Side, joints: &JointVector, now: Stamp) {
        let faults = self.active_faults(now);
        let arm_faults = faults.arms.get(side);
        if !self.switch.is_enabled() {
            return;
        }
        if arm_faults.dropped_commands.is_some_and(|share| self.losses.uniform() < share) {
            return;
        }
        let arm = self.arms.get_mut(side);
        match arm_faults.late_commands.and_then(|seconds| Duration::try_from_secs_f64(seconds).ok()) {
            Some(delay) => arm.late.push_back((now + delay, *joints)),
            None => arm.limb.follow(joints, now),
        }
    }

    /// `/robot/limb/{s}/set_speed_ratio`: a share of the arm's top speeds.
    pub fn set_speed_ratio(&mut self, side: Side, ratio: f64) {
        self.arms.get_mut(side).limb.set_speed_ratio(ratio);
    }

    /// `/robot/limb/{s}/joint_command_timeout`: how long a command holds before the arm stays where it is.
    pub fn set_command_timeout(&mut self, side: Side, timeout: Duration) {
        self.arms.get_mut(side).limb.set_command_timeout(timeout);
    }

    /// Where the person's arms are at this moment, metres in `base`: what a camera sees.
    #[must_use]
    pub fn person_arms(&self) -> PerSide<super::person::ArmPoints> {
        self.posture()
    }

    /// Asks something of the robot's switch (`/robot/set_super_stop`, `..._reset`, `..._enable`).
    pub fn switch(&mut self, request: SwitchRequest, now: Stamp) {
        self.switch.ask(request, now);
    }

    /// Somebody presses (`true`) or releases the red button.
    pub fn press_red_button(&mut self, down: bool) {
        self.switch.press_red_button(down);
    }

    /// How far the sleeves are on: the truth, which no message carries. For reports and tests.
    #[must_use]
    pub fn wearing(&self) -> PerSide<Wearing> {
        self.garment.wearing()
    }

    /// Advances to `now` in beats of 10 ms and returns what came of them. The first call sets the world's beginning.
    pub fn step(&mut self, now: Stamp) -> SimOutput {
        let start = *self.start.get_or_insert(now);
        let mut output = SimOutput::default();
        loop {
            let next = start + TICK.saturating_mul(u32::try_from(self.ticks).unwrap_or(u32::MAX));
            if next > now {
                return output;
            }
            self.tick(next, &mut output);
            self.ticks += 1;
        }
    }

    /// True where a fault keeps the camera from taking pictures.
    #[must_use]
    pub fn camera_is_lost(&self, now: Stamp) -> bool {
        self.faults.camera_is_lost(self.seconds(now))
    }

    fn seconds(&self, now: Stamp) -> f64 {
        self.start.map_or(0.0, |start| now.since(start).as_secs_f64())
    }

    fn active_faults(&self, now: Stamp) -> ActiveFaults {
        if self.faults.faults.is_empty() { ActiveFaults::default() } else { self.faults.at(self.seconds(now)) }
    }

    fn tick(&mut self, now: Stamp, output: &mut SimOutput) {
        let faults = self.active_faults(now);
        self.happen(&faults);
        let before = PerSide::from_fn(|side| self.arms.get(side).velocity);
        let poses = PerSide::from_fn(|side| self.move_arm(side, now));
        let holders = self.arms.map(|_, arm| Holder { tip: arm.tip, velocity: arm.velocity });
        let body = self.posture();
        let forces = self.garment.step(TICK_SECONDS, &holders, &body, &mut self.reactions);
        for side in Side::BOTH {
            let arm = self.arms.get_mut(side);
            let acceleration = (arm.velocity - before.get(side)) / TICK_SECONDS;
            let reported = arm.sense.report(forces.get(side), &arm.tip, &acceleration, TICK_SECONDS);
            let wrench = senses::with_faults(reported, faults.arms.get(side), &mut arm.frozen);
            if let Some(active) = arm.impact.judge(forces.get(side), now) {
                output.collisions.push((side, active));
            }
            if !faults.arms.get(side).stale_force {
                output.endpoints.push(EndpointSample { side, stamp: now, pose: *poses.get(side), wrench });
            }
        }
        output.joints.push(JointSample { stamp: now, positions: self.joint_positions(&faults) });
        output.robot.push(self.switch.state(now));
        if !faults.lost_camera
            && !faults.lost_pose
            && let Some(pose) = self.camera.look(now, self.ticks, &body, &self.person, &poses)
        {
            output.bodies.push(pose);
        }
    }

    /// Lets faults happen that are not errors of a message.
    fn happen(&mut self, faults: &ActiveFaults) {
        if self.faults.faults.is_empty() {
            return;
        }
        self.switch.press_red_button(faults.red_button);
        self.switch.joint_fault(faults.joint_fault);
        for side in Side::BOTH {
            let arm = faults.arms.get(side);
            self.garment.snag(side, arm.snag);
            if arm.garment_slip {
                self.garment.slip(side);
            }
            let outward = if side == Side::Left { 1.0 } else { -1.0 };
            let away = Vector::new(0.8, 0.6 * outward, 0.0) * arm.pull_away.unwrap_or_default();
            self.reactions.get_mut(side).pull_away(away);
        }
    }

    /// Moves one arm of the robot and returns the pose of its gripper.
    fn move_arm(&mut self, side: Side, now: Stamp) -> crate::geometry::Pose {
        let enabled = self.switch.is_enabled();
        let arm = self.arms.get_mut(side);
        while let Some((due, joints)) = arm.late.front().copied().filter(|(due, _)| *due <= now) {
            arm.late.pop_front();
            arm.limb.follow(&joints, due);
        }
        if enabled && !arm.impact.is_active() {
            arm.limb.advance(now, TICK_SECONDS);
        } else if !enabled {
            arm.limb.forget();
            arm.late.clear();
        }
        let pose = arm.limb.model().forward(arm.limb.positions());
        let tip: Point = pose.translation.vector.into();
        arm.velocity = (tip - arm.tip) / TICK_SECONDS;
        arm.tip = tip;
        pose
    }

    /// Where the person's arms are now: in the exercise, then at rest; the elbow gives way, hand and shoulder stay.
    fn posture(&self) -> PerSide<super::person::ArmPoints> {
        let rest = self.person.posture();
        let seconds = self.ticks as f64 * TICK_SECONDS;
        PerSide::from_fn(|side| {
            let mut arm = self.exercise.arm(&self.person, side, seconds).unwrap_or(*rest.get(side));
            arm.elbow += self.reactions.get(side).displacement();
            arm
        })
    }

    fn joint_positions(&self, faults: &ActiveFaults) -> PerSide<[Option<f64>; 7]> {
        PerSide::from_fn(|side| {
            if faults.arms.get(side).stale_joints {
                return [None; 7];
            }
            let positions: [f64; 7] = (*self.arms.get(side).limb.positions()).into();
            positions.map(|position| Some(senses::encoder(position)))
        })
    }
}

#[cfg(test)]
mod tests;
