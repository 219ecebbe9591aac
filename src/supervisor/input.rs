//! Everything that may reach the supervisor, in plain words: the only door into the core.
//!
//! Adapters decode messages into these and put them into the engine's inbox. Numbers are passed on as they came, NaN
//! included: judging them is the core's task.

use crate::assembly::RobotState;
use crate::body::{BodyPose, PerSide, Side};
use crate::command::{Command, Origin};
use crate::geometry::{Pose, Wrench};
use crate::kinematics::{JointVector, Ways};
use crate::modelling::ArmSpace;
use crate::time::Stamp;
use serde::{Deserialize, Serialize};

/// One thing that happened.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Input {
    /// Time has passed: the engine's 100 Hz beat.
    Tick,
    /// An arm's end point and wrench (`/robot/limb/{s}/endpoint_state`).
    Endpoint(EndpointSample),
    /// Joint positions (`/robot/joint_states`).
    Joints(JointSample),
    /// The robot's state (`/robot/state`).
    Robot(RobotState),
    /// The robot's own contact detection (`/robot/limb/{s}/collision_detection_state`).
    Collision {
        /// Which arm.
        side: Side,
        /// True while the robot pauses for an impact or a squish.
        active: bool,
    },
    /// The cuff at an arm's wrist (`/robot/digital_io/{s}_lower_cuff/state`), where it changed.
    Cuff {
        /// Which arm.
        side: Side,
        /// True while a hand squeezes it: the arm follows the hand and no command.
        squeezed: bool,
    },
    /// The person's pose, from whichever source.
    Body(BodyPose),
    /// Somebody asks for something.
    Operator {
        /// What is asked.
        command: Command,
        /// Who asks.
        origin: Origin,
    },
    /// Something about the connection to the robot changed.
    Link(LinkEvent),
    /// The planner outside has answered.
    Planned {
        /// Which question.
        number: u64,
        /// The ways, or why there are none.
        ways: Result<Ways, String>,
    },
    /// The search for a posture to begin from has ended, as [`super::Effect::FindStart`] asked.
    StartFound {
        /// Which question.
        number: u64,
        /// Radians in the order s0, s1, e0, e1, w0, w1, w2 of both arms, or why there is no such posture.
        joints: Result<PerSide<JointVector>, String>,
    },
    /// A movement space was fitted, as [`super::Effect::Fit`] asked.
    Fitted {
        /// Which question.
        number: u64,
        /// The space, or why there is none.
        space: Result<Box<ArmSpace>, String>,
    },
    /// A setpoint did not leave: a guard refused it. The text says what, value and range.
    SetpointRefused {
        /// Which arm.
        side: Side,
        /// The guard's words.
        reason: String,
    },
}

impl Input {
    /// True for what somebody asked, and for answers: they come once, and nothing repeats them.
    #[must_use]
    pub const fn is_asked_for(&self) -> bool {
        matches!(self, Self::Operator { .. } | Self::Planned { .. } | Self::StartFound { .. } | Self::Fitted { .. })
    }
}

/// An arm's end point as the robot reports it.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct EndpointSample {
    /// Which of the robot's arms.
    pub side: Side,
    /// The message's header stamp.
    pub stamp: Stamp,
    /// Pose of the gripper in `base`.
    pub pose: Pose,
    /// The wrench exactly as the robot gives it: axes and sign are a setting of the sensing room.
    pub wrench: Wrench,
}

/// Joint positions as the robot reports them, sorted to the arms. One message may carry any part of them.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct JointSample {
    /// The message's header stamp.
    pub stamp: Stamp,
    /// Radians in the order s0, s1, e0, e1, w0, w1, w2; `None` where the message did not name the joint.
    pub positions: PerSide<[Option<f64>; 7]>,
}

/// What may happen to the connection.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum LinkEvent {
    /// The ROS master does not answer any more.
    MasterLost,
    /// The ROS master answers again, and this node is registered with it.
    MasterBack,
    /// Another node publishes where only this one may.
    ForeignPublisher {
        /// The topic.
        topic: String,
        /// The node.
        node: String,
    },
    /// A node that published where only this one may has gone.
    ForeignPublisherGone {
        /// The topic.
        topic: String,
        /// The node.
        node: String,
    },
    /// A node publishes by another definition than is read here: nothing of what it sends can be used.
    WrongDefinition {
        /// The topic.
        topic: String,
        /// The node.
        node: String,
        /// What it publishes: type and digest.
        found: String,
        /// What is read: type and digest.
        wanted: String,
    },
    /// A motion was under way when its handle was dropped, or a worker of the engine died.
    WorkerLost {
        /// Which one.
        name: String,
    },
    /// Samples were thrown away because the inbox was full.
    InboxOverflow {
        /// How many since the last report.
        lost: u64,
    },
    /// The depth camera's images give no pose of the person.
    CannotSee {
        /// Why, and what to do.
        reason: String,
    },
    /// The recorder cannot write any more.
    RecorderFailed {
        /// Why.
        reason: String,
    },
    /// The recorder's queue was full: the journal has a hole.
    RecorderOverflow {
        /// Steps that are missing since the last report.
        lost: u64,
    },
    /// The console took a snapshot: it lives. From the first beat on its silence counts.
    ConsoleBeat,
    /// The console's process or its terminal is gone.
    ConsoleLost,
}
