//! The robot as its description gives it: two arms with limits, and the tool at each hand.
//!
//! Reads a URDF and nothing else. It never guesses: a description that lacks a joint, a link or a limit is refused.

use super::JointVector;
use super::chain::{ArmFrames, Chain, JOINTS, rotation_from_z};
use super::collision::{CollisionModel, Proximity, Tightest};
use super::description::Description;
use super::limits::JointLimits;
use super::scene::Scene;
use super::seeds::SeedTable;
use crate::body::{PerSide, Side};
use crate::geometry::Pose;
use serde::{Deserialize, Serialize};
use std::sync::{Arc, LazyLock};
use thiserror::Error;

/// The description that valet carries: the figures of Baxter's SDK 1.2.0 model, primitives only.
pub const BAXTER_URDF: &str = include_str!("../../urdf/baxter.urdf");

/// What is mounted at a hand: how far the tip `{side}_gripper` lies beyond the hand, along the hand's z axis.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Tool {
    /// Where the description puts it (0.025 m in the description that valet carries, as in the SDK up to 1.1).
    #[default]
    AsDescribed,
    /// Nothing (`null_gripper` of SDK 1.2): the tip is the hand.
    Bare,
    /// The electric gripper with extended fingers (SDK 1.2): 0.1577 m.
    ElectricExtended,
    /// The electric gripper with standard fingers: 0.120 m.
    ElectricStandard,
    /// Another tool: the tip's distance in metres.
    Distance(f64),
}

impl Tool {
    /// The tip's distance beyond the hand in metres; `None` where the description has to say it.
    ///
    /// Sources: `rethink_ee_description`, electric gripper: base 0.025 m, fingers 0.1127 or 0.075 m, tip 0.020 m.
    #[must_use]
    pub const fn distance(self) -> Option<f64> {
        match self {
            Self::AsDescribed => None,
            Self::Bare => Some(0.0),
            Self::ElectricExtended => Some(0.1577),
            Self::ElectricStandard => Some(0.120),
            Self::Distance(distance) => Some(distance),
        }
    }
}

/// Why a robot description cannot be used.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum ModelError {
    /// The text is no URDF.
    #[error("the robot description cannot be read: {reason}; check the parameter robot_description")]
    NotReadable {
        /// The parser's words.
        reason: String,
    },
    /// A link is missing.
    #[error("the robot description has no link '{link}'; is it the description of a Baxter?")]
    MissingLink {
        /// Its name.
        link: String,
    },
    /// A joint is missing, or is not in its place between base and tip.
    #[error(
        "the robot description has no joint '{joint}' between base and gripper; is it the description of a Baxter?"
    )]
    MissingJoint {
        /// Its name.
        joint: String,
    },
    /// A joint that moves where valet expects none.
    #[error("the robot description moves the {side} arm by '{joint}', which valet does not know")]
    UnknownJoint {
        /// Which arm.
        side: Side,
        /// The joint's name.
        joint: String,
    },
    /// A joint's limits make no range.
    #[error(
        "joint '{joint}' of the robot description has no usable limits (from {lower} to {upper} rad, {speed} rad/s)"
    )]
    Limits {
        /// Its name.
        joint: String,
        /// Lower end in radians.
        lower: f64,
        /// Upper end in radians.
        upper: f64,
        /// Speed in radians per second.
        speed: f64,
    },
    /// The tool's length is no sensible number.
    #[error("the tool at the {side} hand would be {distance} m long; give a number from 0 to 0.5 m")]
    Tool {
        /// Which hand.
        side: Side,
        /// The distance in metres.
        distance: f64,
    },
}

/// One arm from `base` to the tip of its gripper.
#[derive(Clone, Debug)]
pub struct ArmModel {
    pub(super) side: Side,
    pub(super) chain: Chain,
    pub(super) limits: JointLimits,
    pub(super) seeds: Arc<SeedTable>,
    joint_names: [String; JOINTS],
}

impl ArmModel {
    /// Which of the robot's arms this is.
    #[must_use]
    pub const fn side(&self) -> Side {
        self.side
    }

    /// The pose of the tip `{side}_gripper` in `base` for joint positions in radians. Total: limits are not asked.
    #[must_use]
    pub fn forward(&self, joints: &JointVector) -> Pose {
        self.chain.tip_pose(joints)
    }

    /// The limits that the description gives.
    #[must_use]
    pub const fn limits(&self) -> &JointLimits {
        &self.limits
    }

    /// The joints' names on the wire, such as `left_s0`, in the order of [`JointVector`].
    #[must_use]
    pub const fn joint_names(&self) -> &[String; JOINTS] {
        &self.joint_names
    }
}

/// Both arms of a robot, and the shapes that must not touch.
#[derive(Clone, Debug)]
pub struct RobotModel {
    arms: PerSide<ArmModel>,
    collision: CollisionModel,
}

impl RobotModel {
    /// The Baxter whose description valet carries, with the tip where that description puts it.
    ///
    /// # Errors
    /// None in practice: the description is part of the program and under test.
    pub fn baxter() -> Result<Self, ModelError> {
        // Read once: whoever simulates thousands of trials would spend a tenth of the time on reading it.
        static BAXTER: LazyLock<Result<RobotModel, ModelError>> =
            LazyLock::new(|| RobotModel::from_urdf(BAXTER_URDF, PerSide::default()));
        BAXTER.clone()
    }

    /// A robot from the text of its URDF, with the tool at each hand.
    ///
    /// # Errors
    /// A [`ModelError`] that names what the description lacks.
    pub fn from_urdf(text: &str, tool: PerSide<Tool>) -> Result<Self, ModelError> {
        let description = Description::read(text)?;
        let arm = |side| arm_model(&description, side, *tool.get(side));
        let (left, left_hand) = arm(Side::Left)?;
        let (right, right_hand) = arm(Side::Right)?;
        let hands = PerSide { left: left_hand, right: right_hand };
        let chains = PerSide { left: &left.chain, right: &right.chain };
        let collision = CollisionModel::new(&description, &hands, &chains)?;
        Ok(Self { arms: PerSide { left, right }, collision })
    }

    /// One arm.
    #[must_use]
    pub const fn arm(&self, side: Side) -> &ArmModel {
        self.arms.get(side)
    }

    /// The two things with the least room between them: parts of the arms against each other, the robot's body and the
    /// person. Joint positions in radians; a position that is not a number counts as contact.
    #[must_use]
    pub fn tightest(&self, joints: &PerSide<JointVector>, scene: &Scene) -> Proximity {
        self.collision.describe(&self.collision.tightest(&self.frames(joints), scene, f64::INFINITY), scene)
    }

    /// Where everything is: rules that ask for several things of the same joint positions work it out once.
    #[must_use]
    pub fn placed(&self, joints: &PerSide<JointVector>) -> Placement<'_> {
        Placement { model: self, frames: self.frames(joints) }
    }

    fn frames(&self, joints: &PerSide<JointVector>) -> PerSide<ArmFrames> {
        joints.map(|side, joints| self.arm(side).chain.frames(joints))
    }
}

/// Where all parts of both arms are for some joint positions.
#[derive(Debug)]
pub struct Placement<'a> {
    model: &'a RobotModel,
    frames: PerSide<ArmFrames>,
}

impl Placement<'_> {
    /// Distance of the grippers' tips in metres.
    #[must_use]
    pub fn gripper_distance(&self) -> f64 {
        (self.frames.left.tip.translation - self.frames.right.tip.translation).norm()
    }

    /// The two things with the least room to spare, if that is less than `below` metres beyond what they are to keep. A position
    /// that is not a number counts as contact.
    #[must_use]
    pub fn closer_than(&self, below: f64, scene: &Scene) -> Option<Proximity> {
        let tightest = self.tightest(below, scene);
        (tightest.room < below).then(|| self.describe(&tightest, scene))
    }

    pub(super) fn describe(&self, pair: &Tightest, scene: &Scene) -> Proximity {
        self.model.collision.describe(pair, scene)
    }

    /// The pair with the least room, of those with less than `below`; where there is none, `below` and no pair.
    pub(super) fn tightest(&self, below: f64, scene: &Scene) -> Tightest {
        self.model.collision.tightest(&self.frames, scene, below)
    }
}

/// An arm, and its hand and tip in the frame of its last link.
fn arm_model(description: &Description, side: Side, tool: Tool) -> Result<(ArmModel, (Pose, Pose)), ModelError> {
    let arm = description.arm(side)?;
    let tip = match tool.distance() {
        None => arm.tip,
        Some(distance) if (0.0..=0.5).contains(&distance) => arm.hand * Pose::translation(0.0, 0.0, distance),
        Some(distance) => return Err(ModelError::Tool { side, distance }),
    };
    let (_, last_axis) = arm.origins[JOINTS - 1];
    let unfolded = rotation_from_z(&last_axis).inverse();
    let hand_and_tip = (unfolded * arm.hand, unfolded * tip);
    let chain = Chain::new(&arm.origins, &tip);
    let seeds = Arc::new(SeedTable::new(&chain, &arm.limits));
    Ok((ArmModel { side, chain, limits: arm.limits, seeds, joint_names: arm.names }, hand_and_tip))
}

#[cfg(test)]
mod tests;
