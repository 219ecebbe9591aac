//! The guard before one arm: position, speed, acceleration, workspace, following, freshness and the stop latch.
//!
//! It judges each command by what was sent before and what was measured, not by what a planner promised. It keeps no clock: the
//! moment comes in with the command.

use super::breach::{Limit, LimitBreach};
use super::ports::{CommandError, Limb};
use crate::geometry::Point;
use crate::kinematics::{ArmModel, JOINT_TOLERANCE, JointVector, MotionLimits};
use crate::time::Stamp;
use serde::{Deserialize, Serialize};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

/// What a guard allows beside the motion limits.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct GuardSettings {
    /// Oldest measured joint positions with which an arm may be commanded.
    pub freshness: Duration,
    /// A pause in the commands after which the robot has gone back to holding, and the next command is a first one.
    pub command_timeout: Duration,
    /// How far a first command may be from the measured joints, in radians.
    pub first_step: f64,
    /// How far a joint may lag behind its command, in radians.
    pub following: f64,
    /// Shares by which a speed and an acceleration may exceed their limits: they are differences of commands whose moments are
    /// known to a fraction of a tick only: half a millisecond of ten is 1.5 rad/s² on a joint at 0.3 rad/s.
    pub tolerance: (f64, f64),
}

impl Default for GuardSettings {
    /// 0.1 s is ten messages of `/robot/joint_states`, 0.2 s Baxter's own command time-out, 0.05 rad six times its control error
    /// (0.5°), 0.35 rad what a joint lags at 0.75 rad/s behind the robot's slow position filter.
    fn default() -> Self {
        Self {
            freshness: Duration::from_millis(100),
            command_timeout: Duration::from_millis(200),
            first_step: 0.05,
            following: 0.35,
            tolerance: (0.05, 1.0),
        }
    }
}

/// Shortest time between two commands that a speed is computed with. The planner samples by the very moments that come in
/// here, so a short step is exact; this only keeps from dividing by nothing.
const SHORTEST_STEP: f64 = 0.0005;
/// Time between two commands that are on time, in seconds.
const USUAL_STEP: f64 = 0.01;
/// After a pause the supervisor lets a motion go on by at most this, in seconds (`LONGEST_SPAN` of its own).
const LONGEST_STEP: f64 = 0.02;

/// A command that was sent.
#[derive(Clone, Copy, Debug)]
struct Sent {
    stamp: Stamp,
    joints: JointVector,
    /// The least and the greatest speed that it may stand for, radians a second.
    speeds: (JointVector, JointVector),
    /// Seconds between this command and the one before.
    step: f64,
}

impl Sent {
    /// Seconds from this command to one that is sent now.
    fn step_until(&self, now: Stamp) -> f64 {
        now.since(self.stamp).as_secs_f64().max(SHORTEST_STEP)
    }
}

/// An arm behind its guard.
#[derive(Debug)]
pub struct GuardedLimb<L> {
    inner: L,
    arm: ArmModel,
    limits: MotionLimits,
    settings: GuardSettings,
    latch: Arc<AtomicBool>,
    measured: [Option<(Stamp, f64)>; 7],
    sent: Option<Sent>,
}

impl<L: Limb> GuardedLimb<L> {
    /// A guard before `inner`. While `latch` is true nothing passes.
    pub const fn new(
        inner: L,
        arm: ArmModel,
        limits: MotionLimits,
        settings: GuardSettings,
        latch: Arc<AtomicBool>,
    ) -> Self {
        Self { inner, arm, limits, settings, latch, measured: [None; 7], sent: None }
    }

    /// Takes measured joint positions (radians; `None` for those that a message did not name) with the moment of their arrival.
    pub fn observe(&mut self, arrival: Stamp, positions: &[Option<f64>; 7]) {
        for (slot, position) in self.measured.iter_mut().zip(positions) {
            if let Some(position) = position {
                *slot = Some((arrival, *position));
            }
        }
    }

    /// The joints as they were sent last, or else as they were measured; `None` while a joint is not known.
    #[must_use]
    pub fn joints(&self) -> Option<JointVector> {
        self.sent.map(|sent| sent.joints).or_else(|| self.measured_joints())
    }

    /// The arm that is guarded.
    #[must_use]
    pub const fn arm(&self) -> &ArmModel {
        &self.arm
    }

    /// What is behind the guard.
    #[must_use]
    pub const fn inner(&self) -> &L {
        &self.inner
    }

    /// The clock went back before what was sent or measured: when it comes to those moments again, that is long past.
    pub(super) fn forget_what_lies_ahead(&mut self, now: Stamp) {
        self.sent = self.sent.filter(|sent| sent.stamp <= now);
        for slot in &mut self.measured {
            *slot = slot.filter(|(stamp, _)| *stamp <= now || now.distance(*stamp) <= self.settings.freshness);
        }
    }

    fn measured_joints(&self) -> Option<JointVector> {
        let mut joints = JointVector::zeros();
        for (slot, measured) in joints.iter_mut().zip(&self.measured) {
            *slot = (*measured)?.1;
        }
        Some(joints)
    }

    /// Judges a command without sending it.
    ///
    /// # Errors
    /// The first limit that it breaks.
    pub fn judge(&self, now: Stamp, joints: &JointVector) -> Result<(), LimitBreach> {
        if self.latch.load(Ordering::SeqCst) {
            return Err(LimitBreach { what: Limit::StopLatch, value: 1.0, range: (0.0, 0.0) });
        }
        self.judge_positions(joints)?;
        let measured = self.judge_freshness(now)?;
        match self.previous(now) {
            None => self.judge_distance(joints, &measured, self.settings.first_step)?,
            Some(previous) => {
                self.judge_distance(&previous.joints, &measured, self.settings.following)?;
                self.judge_rates(now, &previous, joints)?;
            }
        }
        self.judge_workspace(joints, &measured)
    }

    /// What was sent before, where the robot still follows it. Where the clock went back, nobody knows: the next command is a
    /// first one.
    fn previous(&self, now: Stamp) -> Option<Sent> {
        self.sent.filter(|sent| now.checked_since(sent.stamp).is_some_and(|age| age < self.settings.command_timeout))
    }

    fn judge_positions(&self, joints: &JointVector) -> Result<(), LimitBreach> {
        match self.arm.limits().breach(joints, JOINT_TOLERANCE) {
            None => Ok(()),
            Some((index, value)) => Err(LimitBreach {
                what: Limit::JointPosition { joint: self.name(index) },
                value,
                range: self.arm.limits().range(index),
            }),
        }
    }

    fn judge_freshness(&self, now: Stamp) -> Result<JointVector, LimitBreach> {
        let oldest = self.measured.iter().map(|slot| slot.map(|(stamp, _)| stamp)).min().flatten();
        let age = oldest.map_or(f64::INFINITY, |stamp| now.since(stamp).as_secs_f64());
        let upper = self.settings.freshness.as_secs_f64();
        let breach = LimitBreach { what: Limit::Freshness { side: self.arm.side() }, value: age, range: (0.0, upper) };
        if age > upper { Err(breach) } else { self.measured_joints().ok_or(breach) }
    }

    fn judge_distance(&self, commanded: &JointVector, measured: &JointVector, most: f64) -> Result<(), LimitBreach> {
        self.first_beyond(&(commanded - measured), &JointVector::repeat(most), |joint| Limit::Following { joint })
    }

    fn judge_rates(&self, now: Stamp, previous: &Sent, joints: &JointVector) -> Result<(), LimitBreach> {
        let step = previous.step_until(now);
        let speed = (joints - previous.joints) / step;
        let (more_speed, more_acceleration) = self.settings.tolerance;
        let most = self.limits.joint_speed * (1.0 + more_speed);
        self.first_beyond(&speed, &most, |joint| Limit::JointSpeed { joint })?;
        // Each speed holds for the middle of its own step.
        let (least, greatest) = self.speeds_of(previous, joints, step);
        let faster = (least - previous.speeds.1).sup(&JointVector::zeros());
        let slower = (greatest - previous.speeds.0).inf(&JointVector::zeros());
        let acceleration = (faster + slower) / (0.5 * (step + previous.step));
        let most = self.limits.joint_acceleration * (1.0 + more_acceleration);
        self.first_beyond(&acceleration, &most, |joint| Limit::JointAcceleration { joint })
    }

    /// The least and the greatest speed that a command asks for. After a long pause it holds a place for which the arm has had the
    /// whole pause or only its last [`LONGEST_STEP`], and may stand for any speed between the two: a late beat, after which the
    /// motion goes on as planned, is no braking and no start, and neither is the beat after that.
    fn speeds_of(&self, previous: &Sent, joints: &JointVector, step: f64) -> (JointVector, JointVector) {
        let moved = joints - previous.joints;
        let (slow, fast) = (moved / step, moved / step.min(LONGEST_STEP));
        let most = self.limits.joint_speed * (1.0 + self.settings.tolerance.0);
        // A mean speed beyond the limit is judged by itself.
        let fast = fast.inf(&most.sup(&slow)).sup(&(-most).inf(&slow));
        (slow.inf(&fast), slow.sup(&fast))
    }

    fn first_beyond(
        &self,
        values: &JointVector,
        most: &JointVector,
        what: impl Fn(String) -> Limit,
    ) -> Result<(), LimitBreach> {
        let beyond = values
            .iter()
            .zip(most.iter())
            .enumerate()
            .find(|(_, (value, most))| value.is_nan() || value.abs() > **most);
        match beyond {
            None => Ok(()),
            Some((index, (value, most))) => {
                Err(LimitBreach { what: what(self.name(index)), value: *value, range: (-most, *most) })
            }
        }
    }

    /// A gripper that is outside already may come back, but go no further out.
    fn judge_workspace(&self, joints: &JointVector, measured: &JointVector) -> Result<(), LimitBreach> {
        let tip = |joints: &JointVector| Point::from(self.arm.forward(joints).translation.vector);
        let (place, here) = (tip(joints), tip(&self.sent.map_or(*measured, |sent| sent.joints)));
        let box_ = &self.limits.workspace;
        let Some(axis) = box_.breach(&place) else { return Ok(()) };
        let on_axis = |point: &Point| point.coords.get(axis).copied().unwrap_or(f64::NAN);
        let (value, range) = (on_axis(&place), (on_axis(&box_.lower), on_axis(&box_.upper)));
        let outside = |value: f64| (range.0 - value).max(value - range.1);
        if outside(on_axis(&here)) > 0.0 && outside(value) <= outside(on_axis(&here)) {
            return Ok(());
        }
        let axis = ['x', 'y', 'z'].get(axis).copied().unwrap_or('?');
        Err(LimitBreach { what: Limit::Workspace { side: self.arm.side(), axis }, value, range })
    }

    fn name(&self, index: usize) -> String {
        self.arm.joint_names().get(index).cloned().unwrap_or_default()
    }
}

impl<L: Limb> Limb for GuardedLimb<L> {
    fn command(&mut self, now: Stamp, joints: &JointVector) -> Result<(), CommandError> {
        self.forget_what_lies_ahead(now);
        self.judge(now, joints)?;
        self.inner.command(now, joints)?;
        let still = (JointVector::zeros(), JointVector::zeros());
        let (speeds, step) = self.previous(now).map_or((still, USUAL_STEP), |previous| {
            let step = previous.step_until(now);
            (self.speeds_of(&previous, joints, step), step)
        });
        self.sent = Some(Sent { stamp: now, joints: *joints, speeds, step });
        Ok(())
    }

    fn hold(&mut self, now: Stamp) {
        self.sent = None;
        self.inner.hold(now);
    }
}

#[cfg(test)]
mod tests;
