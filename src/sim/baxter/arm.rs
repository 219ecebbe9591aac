//! One arm that follows joint positions.

use crate::kinematics::{ArmModel, JointVector};
use crate::time::Stamp;
use serde::{Deserialize, Serialize};
use std::time::Duration;

/// How long a joint command holds (`/robot/limb/{s}/joint_command_timeout`, default 0.2 s).
const COMMAND_TIMEOUT: Duration = Duration::from_millis(200);

/// The left arm's posture after `tuck_arms.py -u` (`baxter_tools`), radians in the order s0, s1, e0, e1, w0, w1, w2.
pub const UNTUCKED_LEFT: [f64; 7] = [-0.08, -1.0, -1.19, 1.94, 0.67, 1.03, -0.50];
/// The right arm's posture after `tuck_arms.py -u` (`baxter_tools`).
pub const UNTUCKED_RIGHT: [f64; 7] = [0.08, -1.0, 1.19, 1.94, -0.67, 1.03, 0.50];

/// How an arm follows.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct ArmDynamics {
    /// Time constant of the joints in seconds: an arm lags a moving command by about this much.
    pub lag_seconds: f64,
    /// The arm's highest joint speeds in rad/s, s0 to w2, before the speed ratio.
    pub top_speeds: [f64; 7],
}

impl Default for ArmDynamics {
    /// Hardware speeds as commonly given for Baxter (2 rad/s at shoulder and elbow, 4 rad/s at the wrist); the lag is an
    /// assumption.
    fn default() -> Self {
        Self { lag_seconds: 0.03, top_speeds: [2.0, 2.0, 2.0, 2.0, 4.0, 4.0, 4.0] }
    }
}

/// One simulated arm.
#[derive(Clone, Debug)]
pub(in crate::sim) struct SimulatedLimb {
    model: ArmModel,
    dynamics: ArmDynamics,
    positions: JointVector,
    speed_ratio: f64,
    timeout: Duration,
    command: Option<(JointVector, Stamp)>,
}

impl SimulatedLimb {
    pub(in crate::sim) const fn new(model: ArmModel, dynamics: ArmDynamics, positions: JointVector) -> Self {
        Self { model, dynamics, positions, speed_ratio: 1.0, timeout: COMMAND_TIMEOUT, command: None }
    }

    pub(in crate::sim) const fn positions(&self) -> &JointVector {
        &self.positions
    }

    pub(in crate::sim) const fn model(&self) -> &ArmModel {
        &self.model
    }

    /// A joint command in position mode. Numbers that are not finite are not followed, as the robot's own checks would.
    pub(in crate::sim) fn follow(&mut self, joints: &JointVector, now: Stamp) {
        if joints.iter().all(|value| value.is_finite()) {
            self.command = Some((*joints, now));
        }
    }

    /// `/robot/limb/{s}/set_speed_ratio`: a share of the top speeds, from 0 to 1.
    pub(in crate::sim) fn set_speed_ratio(&mut self, ratio: f64) {
        if ratio.is_finite() {
            self.speed_ratio = ratio.clamp(0.0, 1.0);
        }
    }

    /// `/robot/limb/{s}/joint_command_timeout`: how long a command holds.
    pub(in crate::sim) const fn set_command_timeout(&mut self, timeout: Duration) {
        self.timeout = timeout;
    }

    /// Forgets what was commanded: after a stop nothing old may be followed.
    pub(in crate::sim) const fn forget(&mut self) {
        self.command = None;
    }

    /// Moves for `seconds` up to `now`; stays where the command is too old.
    pub(in crate::sim) fn advance(&mut self, now: Stamp, seconds: f64) {
        let Some((goal, at)) = self.command else { return };
        if now.since(at) > self.timeout {
            self.command = None;
            return;
        }
        let share = 1.0 - (-seconds / self.dynamics.lag_seconds.max(1e-3)).exp();
        let limits = self.model.limits();
        let reach = JointVector::from(self.dynamics.top_speeds) * (self.speed_ratio * seconds);
        let step = ((goal - self.positions) * share).inf(&reach).sup(&-reach);
        self.positions = (self.positions + step).sup(&limits.lower).inf(&limits.upper);
    }
}
