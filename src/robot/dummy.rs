//! Ports that remember what they were asked, for tests: nothing moves.

use super::ports::{BodyPoseSource, CommandError, Limb, PortError, RobotSwitch};
use crate::assembly::SwitchRequest;
use crate::body::BodyPose;
use crate::kinematics::JointVector;
use crate::time::Stamp;

/// What a limb was told.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Told {
    /// To go to joint positions in radians.
    Command(JointVector),
    /// To hold.
    Hold,
}

/// A limb that remembers.
#[derive(Clone, Debug, Default)]
pub struct DummyLimb {
    /// All that it was told, in order.
    pub told: Vec<(Stamp, Told)>,
    /// The words with which it fails, where it is to fail.
    pub failure: Option<String>,
}

impl Limb for DummyLimb {
    fn command(&mut self, now: Stamp, joints: &JointVector) -> Result<(), CommandError> {
        if let Some(reason) = &self.failure {
            return Err(PortError { what: "the dummy limb".into(), reason: reason.clone() }.into());
        }
        self.told.push((now, Told::Command(*joints)));
        Ok(())
    }

    fn hold(&mut self, now: Stamp) {
        self.told.push((now, Told::Hold));
    }
}

/// A switch that remembers.
#[derive(Clone, Debug, Default)]
pub struct DummySwitch {
    /// All requests, in order.
    pub requests: Vec<(Stamp, SwitchRequest)>,
}

impl RobotSwitch for DummySwitch {
    fn request(&mut self, now: Stamp, request: SwitchRequest) -> Result<(), PortError> {
        self.requests.push((now, request));
        Ok(())
    }
}

/// A source that hands out one pose once.
#[derive(Clone, Debug, Default)]
pub struct DummyBodyPoseSource {
    /// The pose to hand out.
    pub pose: Option<BodyPose>,
}

impl BodyPoseSource for DummyBodyPoseSource {
    fn newest(&mut self) -> Option<BodyPose> {
        self.pose.take()
    }
}
