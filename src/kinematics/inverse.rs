//! Inverse kinematics: joint positions that bring the tip to a pose, inside the joint limits.
//!
//! Levenberg-Marquardt steps, projected into the box of the joint limits: where a joint would leave its range it is put to
//! the end of the range and the others take over its share. An attempt that stalls is given up, and the next one starts
//! from another posture of a table. `docs/motion.md` says how this was chosen and what it was compared with.
//! No randomness is left when a pose is solved: the same target and seed give the same answer.

use super::JointVector;
use super::chain::Frame;
use super::cone::OrientationTolerance;
use super::damped::{damped_step, projected_step};
use super::model::ArmModel;
use super::seeds::{Candidates, TABLE_SIZE};
use crate::geometry::{Finite, Pose};
use nalgebra::{Matrix3, UnitQuaternion, Vector3, Vector6};
use thiserror::Error;

/// Each component of the remaining twist is at most this, in metres and radians.
///
/// Half of the 1e-5 that the public IK comparisons use (TRAC-IK, 2015), so that a check in another arithmetic agrees.
pub const TOLERANCE: f64 = 5e-6;
/// Remaining twist along a planned path: far below what an encoder resolves (3.8e-4 rad), so that paths are smooth.
pub(super) const PATH_TOLERANCE: f64 = 1e-9;
/// Steps of one attempt. Those that succeed need about ten; 20 solved the most poses in the least time.
const STEPS: usize = 20;
/// Steps of an attempt of the second round, for the one pose in 30,000 that all short attempts miss.
const PATIENT_STEPS: usize = 120;
/// Attempts of the second round.
const PATIENT_ATTEMPTS: usize = 32;
/// Steps without progress before an attempt is given up.
const STALLS: usize = 3;
/// Two solutions are different where a joint differs by more than this, in radians.
const DIFFERENT: f64 = 0.2;

/// Why no joint positions were found.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum InverseError {
    /// A number of the target or the seed is NaN or infinite.
    #[error("the target pose or the joint positions to start from are not finite numbers; nothing was computed")]
    NotFinite,
    /// No attempt reached the pose.
    #[error(
        "no joint positions inside the limits bring the gripper to the pose; the nearest found is {position_error:.4} m \
         and {angle_error:.4} rad away"
    )]
    NotReached {
        /// Distance of the nearest pose found, in metres.
        position_error: f64,
        /// Angle of the nearest pose found, in radians.
        angle_error: f64,
        /// The joint positions of that pose, radians.
        nearest: JointVector,
    },
}

/// Nearer than this (metres, radians) a seed is that of a path: a tick at the highest speeds moves a gripper by 0.006 m.
const NEAR: f64 = 0.02;

fn is_near(from: &Pose, to: &Pose) -> bool {
    (from.translation.vector - to.translation.vector).norm() < NEAR && from.rotation.angle_to(&to.rotation) < NEAR
}

/// What an attempt has to reach.
struct Aim {
    target: Frame,
    tolerance: OrientationTolerance,
    /// Largest component of the twist that may remain, metres and radians.
    remaining: f64,
}

impl Aim {
    /// A pose of a path.
    fn path(target: &Pose) -> Self {
        Self { target: Frame::from_pose(target), tolerance: OrientationTolerance::NONE, remaining: PATH_TOLERANCE }
    }
}

/// One attempt's end.
enum Attempt {
    Reached(JointVector),
    Stalled(Nearest),
}

impl ArmModel {
    /// Joint positions (radians) that bring the tip `{side}_gripper` to a pose in `base`, inside the joint limits and within
    /// [`TOLERANCE`] on each component of the twist. The seed is tried first where it is close to the target; of several
    /// solutions the first one found is returned, so a warm seed keeps the posture.
    ///
    /// # Errors
    /// [`InverseError::NotFinite`] for a target or seed that is no number, [`InverseError::NotReached`] with the nearest
    /// posture found.
    pub fn inverse(&self, target: &Pose, seed: &JointVector) -> Result<JointVector, InverseError> {
        self.inverse_within(target, &OrientationTolerance::NONE, seed)
    }

    /// [`ArmModel::inverse`] where the orientation need only lie inside a tolerance. The place is kept exactly.
    ///
    /// # Errors
    /// As [`ArmModel::inverse`]; a tolerance that is no angle from 0 to π counts as a number that is not finite.
    pub fn inverse_within(
        &self,
        target: &Pose,
        tolerance: &OrientationTolerance,
        seed: &JointVector,
    ) -> Result<JointVector, InverseError> {
        if !target.is_finite() || !seed.iter().all(|value| value.is_finite()) || !tolerance.is_usable() {
            return Err(InverseError::NotFinite);
        }
        let aim = Aim { target: Frame::from_pose(target), tolerance: *tolerance, remaining: TOLERANCE };
        let seed = seed.zip_zip_map(&self.limits.lower, &self.limits.upper, f64::clamp);
        // On a path the seed is next to its target: no other posture need be looked for.
        if is_near(&self.forward(&seed), target)
            && let Attempt::Reached(joints) = self.attempt(&aim, seed, STEPS)
        {
            return Ok(joints);
        }
        let mut nearest = Nearest::default();
        for (steps, attempts) in [(STEPS, TABLE_SIZE + 1), (PATIENT_STEPS, PATIENT_ATTEMPTS)] {
            for joints in Candidates::new(self, target, seed).take(attempts) {
                match self.attempt(&aim, joints, steps) {
                    Attempt::Reached(joints) => return Ok(joints),
                    Attempt::Stalled(found) => {
                        nearest.offer(found.joints, &found.error);
                    }
                }
            }
        }
        Err(nearest.into_error())
    }

    /// Up to `count` clearly different joint positions (radians) for a pose in `base`, from many seeds: the choice that
    /// look-ahead starts with.
    ///
    /// # Errors
    /// As [`ArmModel::inverse`].
    pub fn solutions(&self, target: &Pose, count: usize) -> Result<Vec<JointVector>, InverseError> {
        let first = self.inverse(target, &self.limits.middle())?;
        let mut found = vec![self.follow(target, &first).unwrap_or(first)];
        let aim = Aim::path(target);
        for seed in Candidates::new(self, target, first) {
            if found.len() >= count {
                break;
            }
            if let Attempt::Reached(joints) = self.attempt(&aim, seed, STEPS)
                && found.iter().all(|other| (joints - other).amax() > DIFFERENT)
            {
                found.push(joints);
            }
        }
        Ok(found)
    }

    /// The part of a joint motion that leaves the tip where it is.
    pub(super) fn free_motion(&self, joints: &JointVector, wanted: &JointVector) -> JointVector {
        let jacobian = self.chain.frames(joints).jacobian();
        let moved = jacobian * wanted;
        wanted - damped_step(&jacobian, &moved, 1e-4)
    }

    /// One attempt from a seed that is already close: the inner step of path tracking.
    pub(super) fn follow(&self, target: &Pose, seed: &JointVector) -> Option<JointVector> {
        match self.attempt(&Aim::path(target), *seed, STEPS) {
            Attempt::Reached(joints) => Some(joints),
            Attempt::Stalled(_) => None,
        }
    }

    fn attempt(&self, aim: &Aim, mut joints: JointVector, steps: usize) -> Attempt {
        let mut best = Nearest::default();
        let mut damping = 1.0_f64;
        let mut stalls = 0;
        for _ in 0..=steps {
            let frames = self.chain.frames(&joints);
            let error = aim.tolerance.twist_between(&frames.tip, &aim.target);
            if error.amax() <= aim.remaining {
                return Attempt::Reached(joints);
            }
            let size = error.norm_squared();
            if best.offer(joints, &error) {
                damping = (damping * 0.5).max(1e-3);
            } else {
                damping *= 2.0;
                stalls += 1;
                if stalls >= STALLS {
                    break;
                }
            }
            let floor = 1e-6 + 0.01 * damping * size.min(1.0);
            joints = projected_step(&self.limits, &frames.jacobian(), &joints, error, floor);
        }
        Attempt::Stalled(best)
    }
}

/// The nearest posture so far.
struct Nearest {
    size: f64,
    joints: JointVector,
    error: Vector6<f64>,
}

impl Default for Nearest {
    fn default() -> Self {
        Self { size: f64::INFINITY, joints: JointVector::zeros(), error: Vector6::repeat(f64::INFINITY) }
    }
}

impl Nearest {
    /// Takes a posture that is nearer than the ones before; false for one that is not.
    fn offer(&mut self, joints: JointVector, error: &Vector6<f64>) -> bool {
        let size = error.norm_squared();
        let nearer = size < self.size;
        if nearer {
            *self = Self { size, joints, error: *error };
        }
        nearer
    }

    fn into_error(self) -> InverseError {
        InverseError::NotReached {
            position_error: self.error.fixed_rows::<3>(0).norm(),
            angle_error: self.error.fixed_rows::<3>(3).norm(),
            nearest: self.joints,
        }
    }
}

/// The twist (metres, radians, axes of `base`) that takes `from` to `to` in unit time.
pub(super) fn twist_between(from: &Frame, to: &Frame) -> Vector6<f64> {
    let linear = to.translation - from.translation;
    let angular = rotation_vector(&(to.rotation * from.rotation.transpose()));
    Vector6::new(linear.x, linear.y, linear.z, angular.x, angular.y, angular.z)
}

/// The rotation vector of a rotation matrix, stable for small turns and near a half turn.
pub(super) fn rotation_vector(rotation: &Matrix3<f64>) -> Vector3<f64> {
    let twice_sine =
        Vector3::new(rotation.m32 - rotation.m23, rotation.m13 - rotation.m31, rotation.m21 - rotation.m12);
    let sine = 0.5 * twice_sine.norm();
    let cosine = 0.5 * (rotation.trace() - 1.0);
    if sine < 1e-4 && cosine > 0.0 {
        return twice_sine * 0.5;
    }
    if cosine > -0.99 {
        return twice_sine * (0.5 * sine.atan2(cosine) / sine);
    }
    // The antisymmetric part vanishes near a half turn: the quaternion keeps the axis.
    UnitQuaternion::from_matrix(rotation).scaled_axis()
}

#[cfg(test)]
mod tests;
