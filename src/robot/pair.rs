//! The guard before both arms: each arm's own guard, the distance between the grippers, and everything that must not touch.

use super::breach::{Limit, LimitBreach};
use super::guard::GuardedLimb;
use super::ports::{CommandError, Limb};
use crate::body::{PerSide, Side};
use crate::kinematics::{JointVector, MotionLimits, RobotModel, Scene};
use crate::time::Stamp;

/// Metres by which a command may miss a distance: planners round too.
const SLACK: f64 = 5e-4;

/// The share of a plan's distance to the person that commands keep. A person breathes and sways by some millimetres after a
/// plan was made with all of it; whoever comes nearer than half of it halts the arms.
pub(super) const STREAMED_SHARE: f64 = 0.5;

/// Both arms behind their guards.
#[derive(Debug)]
pub struct GuardedPair<L> {
    limbs: PerSide<GuardedLimb<L>>,
    model: RobotModel,
    limits: MotionLimits,
    scene: Scene,
}

impl<L: Limb> GuardedPair<L> {
    /// A guard before two guarded arms.
    pub fn new(limbs: PerSide<GuardedLimb<L>>, model: RobotModel, limits: MotionLimits) -> Self {
        Self { limbs, model, limits, scene: Scene::default() }
    }

    /// Takes measured joint positions (radians) with the moment of their arrival.
    pub fn observe(&mut self, arrival: Stamp, side: Side, positions: &[Option<f64>; 7]) {
        self.limbs.get_mut(side).observe(arrival, positions);
    }

    /// Takes where the person is: commands are judged by it from now on. Plans keep the scene's margin, commands
    /// `STREAMED_SHARE` of it.
    pub fn surround(&mut self, scene: Scene) {
        self.scene = Scene { margin: scene.margin * STREAMED_SHARE, ..scene };
    }

    /// One arm behind its guard.
    #[must_use]
    pub const fn limb(&self, side: Side) -> &GuardedLimb<L> {
        self.limbs.get(side)
    }

    /// Judges a command for one arm, the other staying where it was sent last, and sends it.
    ///
    /// # Errors
    /// A [`CommandError`]; then nothing was sent.
    pub fn command(&mut self, now: Stamp, side: Side, joints: &JointVector) -> Result<(), CommandError> {
        self.forget_what_lies_ahead(now);
        self.limbs.get(side).judge(now, joints)?;
        if let Some(here) = self.joints() {
            let mut next = here;
            *next.get_mut(side) = *joints;
            self.judge_together(&here, &next)?;
        }
        self.limbs.get_mut(side).command(now, joints)
    }

    /// Judges commands for both arms and sends both, or neither.
    ///
    /// # Errors
    /// A [`CommandError`]. Where a guard refuses, nothing was sent; where a port fails, both arms were told to hold.
    pub fn command_both(&mut self, now: Stamp, joints: &PerSide<JointVector>) -> Result<(), CommandError> {
        self.forget_what_lies_ahead(now);
        for (side, joints) in joints.iter() {
            self.limbs.get(side).judge(now, joints)?;
        }
        if let Some(here) = self.joints() {
            self.judge_together(&here, joints)?;
        }
        for (side, joints) in joints.iter() {
            if let Err(error) = self.limbs.get_mut(side).command(now, joints) {
                self.hold(now);
                return Err(error);
            }
        }
        Ok(())
    }

    fn forget_what_lies_ahead(&mut self, now: Stamp) {
        for side in Side::BOTH {
            self.limbs.get_mut(side).forget_what_lies_ahead(now);
        }
    }

    /// Makes both arms hold where they are.
    pub fn hold(&mut self, now: Stamp) {
        self.limbs.left.hold(now);
        self.limbs.right.hold(now);
    }

    fn joints(&self) -> Option<PerSide<JointVector>> {
        Some(PerSide { left: self.limbs.left.joints()?, right: self.limbs.right.joints()? })
    }

    /// Where a rule is broken already, the arms may leave, but go no deeper.
    fn judge_together(&self, here: &PerSide<JointVector>, next: &PerSide<JointVector>) -> Result<(), LimitBreach> {
        let range = (self.limits.minimum_gripper_distance, self.limits.maximum_gripper_distance);
        let (here, next) = (self.model.placed(here), self.model.placed(next));
        let (before, distance) = (here.gripper_distance(), next.gripper_distance());
        // No slack on what was before: tick by tick it would add up.
        let allowed = ((range.0 - SLACK).min(before), (range.1 + SLACK).max(before));
        if !(allowed.0..=allowed.1).contains(&distance) {
            return Err(LimitBreach { what: Limit::GripperDistance, value: distance, range });
        }
        let Some(tightest) = next.closer_than(-SLACK, &self.scene) else { return Ok(()) };
        let room = tightest.distance - tightest.least;
        let before = here.closer_than(f64::INFINITY, &self.scene);
        if before.is_some_and(|before| room >= before.distance - before.least) {
            return Ok(());
        }
        let what = Limit::Clearance { first: tightest.first, second: tightest.second };
        Err(LimitBreach { what, value: tightest.distance, range: (tightest.least, f64::INFINITY) })
    }
}

#[cfg(test)]
mod tests;
