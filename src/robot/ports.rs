//! What the node needs of a robot and its senses, as traits.

use super::breach::LimitBreach;
use crate::assembly::SwitchRequest;
use crate::body::BodyPose;
use crate::kinematics::JointVector;
use crate::time::Stamp;
use thiserror::Error;

/// Something behind a port does not work.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[error("{what} does not work: {reason}")]
pub struct PortError {
    /// What, in the operator's words.
    pub what: String,
    /// Why.
    pub reason: String,
}

/// Why a command did not leave the node.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum CommandError {
    /// A guard refused it.
    #[error(transparent)]
    Refused(#[from] LimitBreach),
    /// The port could not carry it out.
    #[error(transparent)]
    Port(#[from] PortError),
}

/// One arm that follows joint positions.
pub trait Limb {
    /// Sends joint positions (radians, order s0, s1, e0, e1, w0, w1, w2) in position mode, in which the robot's own collision
    /// avoidance stays active. To be repeated at 100 Hz: where commands stop, the arm holds (after 0.2 s on a Baxter).
    ///
    /// # Errors
    /// A [`CommandError`] where a guard refuses or the port fails; then nothing was sent.
    fn command(&mut self, now: Stamp, joints: &JointVector) -> Result<(), CommandError>;

    /// Makes the arm hold where it is, by whatever means the port has. Never refused and never allowed to fail: the least that an
    /// adapter does is to send nothing more.
    fn hold(&mut self, now: Stamp);
}

/// The robot's switch.
pub trait RobotSwitch {
    /// Asks for a stop, a reset, power on or off. Whether it happened, `/robot/state` tells.
    ///
    /// # Errors
    /// A [`PortError`] where the request could not even be sent.
    fn request(&mut self, now: Stamp, request: SwitchRequest) -> Result<(), PortError>;
}

/// Whatever sees the person: the depth image's classifier, a skeleton tracker, or the simulator.
pub trait BodyPoseSource {
    /// The newest pose in `base` that has not been handed out yet. Old ones are dropped, never queued.
    fn newest(&mut self) -> Option<BodyPose>;
}
