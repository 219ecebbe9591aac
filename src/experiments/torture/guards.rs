//! The guards before both arms, as a session has them: what they refuse does not leave.

use crate::body::{PerSide, Side};
use crate::kinematics::{JointVector, MotionLimits, RobotModel};
use crate::robot::{CommandError, GuardSettings, GuardedLimb, GuardedPair, Limb};
use crate::supervisor::Input;
use crate::time::Stamp;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// The wire behind a guard: what passes is sent by whoever asked.
#[derive(Debug)]
struct Wire;

impl Limb for Wire {
    fn command(&mut self, _now: Stamp, _joints: &JointVector) -> Result<(), CommandError> {
        Ok(())
    }

    fn hold(&mut self, _now: Stamp) {}
}

/// Both arms' guards with the latch that they look at.
#[derive(Debug)]
pub(super) struct Guards {
    pair: GuardedPair<Wire>,
    latch: Arc<AtomicBool>,
}

impl Guards {
    pub(super) fn new(model: &RobotModel, limits: &MotionLimits) -> Self {
        let latch = Arc::new(AtomicBool::new(false));
        let limbs = PerSide::from_fn(|side| {
            let arm = model.arm(side).clone();
            GuardedLimb::new(Wire, arm, limits.clone(), GuardSettings::default(), Arc::clone(&latch))
        });
        Self { pair: GuardedPair::new(limbs, model.clone(), limits.clone()), latch }
    }

    /// Takes what the guards see besides commands: measured joints and the stop.
    pub(super) fn observe(&mut self, now: Stamp, input: &Input, is_stopped: bool) {
        self.latch.store(is_stopped, Ordering::SeqCst);
        if let Input::Joints(sample) = input {
            for (side, positions) in sample.positions.iter() {
                self.pair.observe(now, side, positions);
            }
        }
    }

    /// Lets joint positions pass, or refuses them in words.
    pub(super) fn pass(&mut self, now: Stamp, side: Side, joints: &JointVector) -> Result<(), String> {
        self.pair.command(now, side, joints).map_err(|error| error.to_string())
    }
}
