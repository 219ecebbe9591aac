//! Reads a URDF and finds in it what the arms need: the seven joints of each, their limits, the hand and the tip.
//!
//! The only user of `urdf-rs`. Links and joints are looked up apart, because fixed joints share names with links.

use super::JointVector;
use super::chain::{JOINTS, rotation_from_z};
use super::limits::JointLimits;
use super::model::ModelError;
use crate::body::Side;
use crate::geometry::{Pose, Vector};
use nalgebra::{Isometry3, Translation3, UnitQuaternion};
use urdf_rs::{Joint, JointType, Robot};

/// The joints of an arm from the shoulder to the wrist, in the order in which Baxter's SDK lists them.
pub const JOINT_SUFFIXES: [&str; JOINTS] = ["s0", "s1", "e0", "e1", "w0", "w1", "w2"];
/// The frame in which valet works: the robot's root link.
const BASE: &str = "base";

/// What a link is fixed to: the robot's body (`None`), or a moving link (0 to 6) of an arm.
pub(super) type Holder = Option<(Side, usize)>;

/// A parsed description.
#[derive(Clone, Debug)]
pub(super) struct Description {
    robot: Robot,
}

/// What a description says of one arm.
#[derive(Clone, Debug)]
pub(super) struct ArmDescription {
    /// Fixed transformation before each joint, and the joint's axis.
    pub(super) origins: [(Pose, Vector); JOINTS],
    /// From the last moving link to the hand.
    pub(super) hand: Pose,
    /// From the last moving link to the tip.
    pub(super) tip: Pose,
    pub(super) limits: JointLimits,
    pub(super) names: [String; JOINTS],
}

impl Description {
    pub(super) fn read(text: &str) -> Result<Self, ModelError> {
        let robot =
            urdf_rs::read_from_string(text).map_err(|error| ModelError::NotReadable { reason: error.to_string() })?;
        Ok(Self { robot })
    }

    pub(super) const fn robot(&self) -> &Robot {
        &self.robot
    }

    /// The joint that holds a link.
    pub(super) fn joint_above(&self, link: &str) -> Option<&Joint> {
        self.robot.joints.iter().find(|joint| joint.child.link == link)
    }

    pub(super) fn arm(&self, side: Side) -> Result<ArmDescription, ModelError> {
        let names = JOINT_SUFFIXES.map(|suffix| format!("{side}_{suffix}"));
        let above = self.chain_to(&format!("{side}_gripper"))?;
        check_joints(side, &above, &names)?;
        let mut origins = [(Pose::identity(), Vector::z()); JOINTS];
        let mut limits =
            JointLimits { lower: JointVector::zeros(), upper: JointVector::zeros(), speed: JointVector::zeros() };
        let mut pending = Pose::identity();
        for joint in &above {
            pending *= pose_of(&joint.origin);
            let index = names.iter().position(|name| name == &joint.name).filter(|_| is_moving(joint));
            if let Some((index, slot)) = index.and_then(|index| Some((index, origins.get_mut(index)?))) {
                *slot = (std::mem::replace(&mut pending, Pose::identity()), Vector::from(joint.axis.xyz.0));
                let (lower, upper, speed) = checked_limits(joint)?;
                for (vector, value) in
                    [(&mut limits.lower, lower), (&mut limits.upper, upper), (&mut limits.speed, speed)]
                {
                    if let Some(slot) = vector.get_mut(index) {
                        *slot = value;
                    }
                }
            }
        }
        let hand = hand_offset(side, &above)?;
        Ok(ArmDescription { origins, hand, tip: pending, limits, names })
    }

    /// All joints from `base` to a link, in that order.
    fn chain_to(&self, link: &str) -> Result<Vec<&Joint>, ModelError> {
        if !self.robot.links.iter().any(|known| known.name == link) {
            return Err(ModelError::MissingLink { link: link.into() });
        }
        let mut chain = Vec::new();
        let mut current = link;
        // A tree has no more joints than links: more steps than that would be a loop.
        for _ in 0..=self.robot.joints.len() {
            if current == BASE {
                chain.reverse();
                return Ok(chain);
            }
            let Some(joint) = self.joint_above(current) else { break };
            chain.push(joint);
            current = &joint.parent.link;
        }
        Err(ModelError::MissingLink { link: BASE.into() })
    }

    /// What a link is fixed to: the robot's body (`None`) or a moving link of an arm (0 to 6), and its pose in the frame that
    /// the arm's chain has for that link. `None` for links that hang from other joints, such as the head or a finger.
    pub(super) fn holder(&self, link: &str) -> Result<Option<(Holder, Pose)>, ModelError> {
        let chain = self.chain_to(link)?;
        let fixed = chain.iter().rev().take_while(|joint| !is_moving(joint));
        let offset = fixed.fold(Pose::identity(), |pose, joint| pose_of(&joint.origin) * pose);
        let Some(joint) = chain.iter().rev().find(|joint| is_moving(joint)) else { return Ok(Some((None, offset))) };
        let arm_link = Side::BOTH.into_iter().find_map(|side| {
            let index = JOINT_SUFFIXES.iter().position(|suffix| joint.name == format!("{side}_{suffix}"))?;
            Some((side, index))
        });
        let unfolded = rotation_from_z(&Vector::from(joint.axis.xyz.0)).inverse();
        Ok(arm_link.map(|arm_link| (Some(arm_link), unfolded * offset)))
    }
}

/// A joint that moves, as far as an arm is concerned.
pub(super) const fn is_moving(joint: &Joint) -> bool {
    !matches!(joint.joint_type, JointType::Fixed)
}

/// The transformation that a URDF origin means: translation, then fixed-axis roll, pitch, yaw.
pub(super) fn pose_of(origin: &urdf_rs::Pose) -> Pose {
    let [x, y, z] = origin.xyz.0;
    let [roll, pitch, yaw] = origin.rpy.0;
    Isometry3::from_parts(Translation3::new(x, y, z), UnitQuaternion::from_euler_angles(roll, pitch, yaw))
}

/// From the last moving link to the hand.
fn hand_offset(side: Side, chain: &[&Joint]) -> Result<Pose, ModelError> {
    let hand = format!("{side}_hand");
    let end = chain.iter().position(|joint| joint.child.link == hand).ok_or(ModelError::MissingLink { link: hand })?;
    let offset = chain.iter().take(end + 1).rev().take_while(|joint| !is_moving(joint));
    Ok(offset.fold(Pose::identity(), |pose, joint| pose_of(&joint.origin) * pose))
}

fn check_joints(side: Side, chain: &[&Joint], names: &[String; JOINTS]) -> Result<(), ModelError> {
    let moving: Vec<_> = chain.iter().filter(|joint| is_moving(joint)).collect();
    for name in names {
        if !moving.iter().any(|joint| &joint.name == name && matches!(joint.joint_type, JointType::Revolute)) {
            return Err(ModelError::MissingJoint { joint: name.clone() });
        }
    }
    match moving.iter().zip(names).find(|(joint, name)| &joint.name != *name) {
        Some((joint, _)) => Err(ModelError::UnknownJoint { side, joint: joint.name.clone() }),
        None => {
            moving.get(JOINTS).map_or(Ok(()), |joint| Err(ModelError::UnknownJoint { side, joint: joint.name.clone() }))
        }
    }
}

fn checked_limits(joint: &Joint) -> Result<(f64, f64, f64), ModelError> {
    let (lower, upper, speed) = (joint.limit.lower, joint.limit.upper, joint.limit.velocity);
    let usable = lower.is_finite() && upper.is_finite() && lower < upper && speed.is_finite() && speed > 0.0;
    if usable {
        Ok((lower, upper, speed))
    } else {
        Err(ModelError::Limits { joint: joint.name.clone(), lower, upper, speed })
    }
}

#[cfg(test)]
mod tests;
