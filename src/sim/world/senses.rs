//! What reaches the node of the simulated world besides the wrench estimate: encoder steps, contact detection, the pose.

use super::super::faults::ArmFaults;
use super::super::person::{ArmPoints, SimulatedPerson};
use super::super::random::Random;
use crate::body::{ArmPose, BodyPose, Evidence, Joint, JointEstimate, PerSide};
use crate::geometry::{Point, Pose, Vector, Wrench};
use crate::time::Stamp;
use nalgebra::Matrix3;
use std::time::Duration;

/// One step of a joint's encoder in radians: 14 bits a turn, as recordings of a real robot show.
const ENCODER_STEP: f64 = std::f64::consts::TAU / 16_384.0;
/// Squish: a steady force on one axis beyond this stops the arm, in newtons (a sample log of the maker's shows 16.0).
const SQUISH_NEWTONS: f64 = 16.0;
/// For how long it has to last, an assumption.
const SQUISH_AFTER: Duration = Duration::from_millis(100);
/// The arm goes on by itself after this time.
const SQUISH_PAUSE: Duration = Duration::from_secs(2);
/// Shortest distance between two poses in beats of 10 ms: 30 Hz, as three beats, three beats, four beats.
const FRAMES_A_SECOND: u64 = 30;
const TICKS_A_SECOND: u64 = 100;
/// The neck lies this far above the middle between the shoulders, in metres.
const NECK: f64 = 0.08;

/// A joint's position as its encoder gives it.
pub(super) fn encoder(position: f64) -> f64 {
    (position / ENCODER_STEP).round() * ENCODER_STEP
}

/// A reported wrench after the faults of its arm.
pub(super) fn with_faults(reported: Wrench, faults: &ArmFaults, frozen: &mut Option<Wrench>) -> Wrench {
    let mut wrench = reported;
    if let Some(newtons) = faults.bias {
        wrench.force += Vector::from(newtons);
    }
    if faults.frozen_force {
        return *frozen.get_or_insert(wrench);
    }
    *frozen = None;
    if faults.not_a_number {
        wrench.force = Vector::repeat(f64::NAN);
    }
    wrench
}

/// The robot's own contact detection: stops an arm under a steady force, and lets it go on by itself.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct ImpactDetection {
    since: Option<Stamp>,
    until: Option<Stamp>,
}

impl ImpactDetection {
    pub(super) const fn is_active(&self) -> bool {
        self.until.is_some()
    }

    /// Looks at the force on the gripper; tells the new state where it changed.
    pub(super) fn judge(&mut self, force: &Vector, now: Stamp) -> Option<bool> {
        if let Some(until) = self.until {
            if now < until {
                return None;
            }
            (self.since, self.until) = (None, None);
            return Some(false);
        }
        if force.amax() <= SQUISH_NEWTONS {
            self.since = None;
            return None;
        }
        let since = *self.since.get_or_insert(now);
        if now.since(since) < SQUISH_AFTER {
            return None;
        }
        self.until = Some(now + SQUISH_PAUSE);
        Some(true)
    }
}

/// The camera and its pose finder: joints with noise, 30 times a second.
#[derive(Debug)]
pub(super) struct Camera {
    noise: f64,
    random: Random,
    /// Whether the grippers hide joints from it.
    arms_hide_joints: bool,
}

/// A gripper and the sleeve that it holds open (some 0.2 m across, as a jacket's armhole is) cover what is so near, in metres.
const COVER_METRES: f64 = 0.12;

/// True where a gripper and what it holds cover a joint.
fn is_hidden(joint: &Point, grippers: &PerSide<Pose>) -> bool {
    grippers.iter().any(|(_, tip)| (joint.coords - tip.translation.vector).norm() < COVER_METRES)
}

impl Camera {
    pub(super) const fn new(noise: f64, random: Random, arms_hide_joints: bool) -> Self {
        Self { noise, random, arms_hide_joints }
    }

    /// The person's pose at a beat, where a frame is due.
    pub(super) fn look(
        &mut self,
        now: Stamp,
        tick: u64,
        arms: &PerSide<ArmPoints>,
        person: &SimulatedPerson,
        grippers: &PerSide<Pose>,
    ) -> Option<BodyPose> {
        let frame = |tick: u64| tick * FRAMES_A_SECOND / TICKS_A_SECOND;
        if tick > 0 && frame(tick) == frame(tick - 1) {
            return None;
        }
        let arms = PerSide::from_fn(|side| self.arm(arms.get(side), grippers));
        let [x, y, z] = person.chest_metres;
        let neck = self.joint(&Point::new(x, y, z + NECK), grippers);
        Some(BodyPose { stamp: now, arms, neck })
    }

    fn arm(&mut self, points: &ArmPoints, grippers: &PerSide<Pose>) -> ArmPose {
        let mut arm = ArmPose::default();
        for (joint, point) in [
            (Joint::Hand, points.hand),
            (Joint::Wrist, points.wrist),
            (Joint::Forearm, nalgebra::center(&points.wrist, &points.elbow)),
            (Joint::Elbow, points.elbow),
            (Joint::UpperArm, nalgebra::center(&points.elbow, &points.shoulder)),
            (Joint::Shoulder, points.shoulder),
        ] {
            arm.set(joint, self.joint(&point, grippers));
        }
        arm
    }

    /// A joint with its noise; `None` where a gripper hides it.
    fn joint(&mut self, point: &Point, grippers: &PerSide<Pose>) -> Option<JointEstimate> {
        let estimate = JointEstimate {
            position: point + self.random.normal_vector(self.noise),
            covariance: Matrix3::identity() * self.noise.powi(2).max(1e-8),
            confidence: 0.95,
            evidence: Evidence::Seen,
        };
        (!(self.arms_hide_joints && is_hidden(point, grippers))).then_some(estimate)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    #[test]
    fn before_a_trial_the_whole_person_is_seen() {
        use crate::sim::world::{World, WorldSetup};
        let setup = WorldSetup { arms_hide_joints: true, ..WorldSetup::default() };
        let mut world = World::new(&setup).unwrap();
        let body = world.step(Stamp::from_nanoseconds(1_000_000_000)).bodies.pop().unwrap();
        for (side, arm) in body.arms.iter() {
            for joint in [Joint::Hand, Joint::Elbow, Joint::Shoulder] {
                assert!(arm.joint(joint).is_some(), "{side} {joint}");
            }
        }
    }

    #[test]
    fn a_joint_is_hidden_by_a_gripper_that_has_come_to_it() {
        let at = |x: f64| Pose::translation(x, 0.4, 0.0);
        let hides = |x: f64| is_hidden(&Point::new(0.8, 0.4, 0.0), &PerSide { left: at(0.0), right: at(x) });
        assert!(hides(0.75) && !hides(0.6));
    }
}
