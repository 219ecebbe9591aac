//! A planned motion of both arms: what the joints are to be at each moment, and how to stop on the way.
//!
//! A motion is data: sampling it moves nothing.

use super::JointVector;
use super::chain::Chain;
use super::path::JointPath;
use super::timing::{PathLimits, PathState, PathTiming};
use crate::body::{PerSide, Side};
use crate::geometry::Pose;
use std::time::Duration;

/// What one arm is to be and do at a moment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Setpoint {
    /// Joint positions in radians.
    pub joints: JointVector,
    /// The gripper's pose in `base` for these joints.
    pub pose: Pose,
    /// Joint speeds in radians per second.
    pub velocity: JointVector,
    /// Joint accelerations in radians per second squared.
    pub acceleration: JointVector,
}

/// A motion of both arms in step: they start, slow down and end together.
#[derive(Clone, Debug)]
pub struct PairMotion {
    pub(super) arms: PerSide<ArmMotion>,
    pub(super) timing: PathTiming,
    pub(super) limits: PathLimits,
    pub(super) braking: Braking,
}

/// What bounds how hard a motion may brake.
#[derive(Clone, Copy, Debug)]
pub(super) struct Braking {
    /// The highest acceleration of the parameter with which no gripper breaks its own limit.
    pub(super) grippers: f64,
    /// The highest acceleration of each joint in radians per second squared: the bends of the path need some of it.
    pub(super) joints: JointVector,
}

/// At so many places ahead is looked for how hard a motion may brake: some ten a knot's span on a usual stop.
const PLACES_AHEAD: usize = 48;

#[derive(Clone, Debug)]
pub(super) struct ArmMotion {
    pub(super) chain: Chain,
    pub(super) path: JointPath,
}

impl PairMotion {
    /// How long the motion takes.
    #[must_use]
    pub fn duration(&self) -> Duration {
        Duration::try_from_secs_f64(self.timing.seconds()).unwrap_or_default()
    }

    /// Where both arms are to be when `elapsed` has passed since the start; at and after the end, at rest at the end.
    #[must_use]
    pub fn sample(&self, elapsed: Duration) -> PerSide<Setpoint> {
        let state = self.timing.at(elapsed.as_secs_f64());
        self.arms.map(|_, arm| {
            let point = arm.path.at(state.parameter);
            Setpoint {
                joints: point.joints,
                pose: arm.chain.tip_pose(&point.joints),
                velocity: point.slope * state.speed,
                acceleration: point.slope * state.acceleration + point.curvature * (state.speed * state.speed),
            }
        })
    }

    /// Which share of the path lies behind the arms when `elapsed` has passed: 0 at its start, 1 at its end.
    #[must_use]
    pub fn progress(&self, elapsed: Duration) -> f64 {
        self.timing.at(elapsed.as_secs_f64()).parameter
    }

    /// True for an arm that this motion does not move.
    #[must_use]
    pub fn rests(&self, side: Side) -> bool {
        self.arms.get(side).path.knots().len() < 2
    }

    /// The motion that leads from the state at `elapsed` to rest as soon as acceleration and jerk allow it, on the same
    /// path and never beyond its end. Its time starts at the halt. A halted motion may be halted again.
    #[must_use]
    pub fn halt(&self, elapsed: Duration) -> Self {
        self.halt_slowed(elapsed, 1.0)
    }

    /// As `halt`, for a motion that runs at `ratio` of its planned speed (1: as planned; at 0 it stands already): less speed
    /// is braked, so that no halt of a slowed motion takes longer than one at full speed. Not finite counts as 1.
    #[must_use]
    pub fn halt_slowed(&self, elapsed: Duration, ratio: f64) -> Self {
        let ratio = if ratio.is_finite() { ratio.clamp(0.0, 1.0) } else { 1.0 };
        let planned = self.timing.at(elapsed.as_secs_f64());
        let state =
            PathState { speed: planned.speed * ratio, acceleration: planned.acceleration * ratio * ratio, ..planned };
        let limits = PathLimits { acceleration: self.deceleration(&state), ..self.limits };
        // A profile that the generator refuses cannot be followed: then standing still is the only safe answer.
        let timing = PathTiming::stop(&state, &limits).unwrap_or_else(|_| PathTiming::rest(state.parameter));
        Self { arms: self.arms.clone(), timing, ..*self }
    }

    /// How hard the motion may brake from a state: what the part of the path asks for that it could need to stop, less what its
    /// bends need at the speed that it has. The limits of the whole path are those of its steepest and its most bent place, half
    /// for each, and a stop elsewhere would take up to twice as long as it must.
    fn deceleration(&self, state: &PathState) -> f64 {
        let whole = &self.limits;
        // No stop is longer than that with the limits of the whole path, from its highest acceleration on.
        let seconds = state.speed / whole.acceleration + 2.0 * whole.acceleration / whole.jerk;
        let ahead = (state.speed + state.acceleration.max(0.0) * seconds) * seconds;
        // What speeds up when the halt begins does so until its acceleration has been taken back.
        let speed = state.speed + state.acceleration.max(0.0).powi(2) / (2.0 * whole.jerk);
        let mut most = self.braking.grippers;
        for index in 0..=PLACES_AHEAD {
            let parameter = state.parameter + ahead * index as f64 / PLACES_AHEAD as f64;
            for side in Side::BOTH {
                let point = self.arms.get(side).path.at(parameter);
                let rates = point.slope.iter().zip(point.curvature.iter()).zip(self.braking.joints.iter());
                most = rates.fold(most, |most, ((slope, curvature), acceleration)| {
                    most.min((acceleration - curvature.abs() * speed * speed) / slope.abs())
                });
            }
        }
        most.max(whole.acceleration)
    }
}

#[cfg(test)]
mod tests;
