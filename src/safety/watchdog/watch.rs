//! What is watched: a name for each input and each act of somebody else.

use crate::body::Side;
use serde::{Deserialize, Serialize};

/// What is watched.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Watch {
    /// Force of an arm.
    Force(Side),
    /// Joint positions of an arm.
    Joints(Side),
    /// The robot's state.
    RobotState,
    /// The person's pose.
    Pose,
    /// The planner's answer.
    Planner,
    /// The console's heartbeat.
    Console,
    /// The supervisor's own beat, and the clock.
    Tick,
    /// The robot's own contact detection.
    Collision(Side),
    /// The cuff at an arm's wrist, by which a hand takes the arm over.
    Cuff(Side),
    /// The robot's motors, switched by somebody else.
    Enable,
    /// Another node that publishes where only valet may.
    ForeignPublisher,
    /// The ROS master.
    Master,
}
