//! When a motion is where on its path: the path's parameter over time, with bounded speed, acceleration and jerk.
//!
//! The profiles come from `rsruckig` (the Ruckig method, Berscheid and Kroeger 2021). Knows nothing of arms.
#![expect(clippy::indexing_slicing, reason = "the generator has one degree of freedom, and its arrays one element")]

use rsruckig::prelude::{ControlInterface, InputParameter, Ruckig, ThrowErrorHandler, Trajectory};
use thiserror::Error;

/// The parameter and its first two derivatives by seconds.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct PathState {
    pub(super) parameter: f64,
    pub(super) speed: f64,
    pub(super) acceleration: f64,
}

/// Highest speed, acceleration and jerk of the parameter, in units per second and its powers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct PathLimits {
    pub(super) speed: f64,
    pub(super) acceleration: f64,
    pub(super) jerk: f64,
}

/// The parameter over time.
#[derive(Clone, Debug)]
pub(super) struct PathTiming {
    trajectory: Trajectory<1>,
}

/// No profile keeps the limits.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[error("no speed profile keeps the limits of the motion: {reason}")]
pub struct TimingError {
    /// What the generator says.
    pub reason: String,
}

impl PathTiming {
    /// From rest at 0 to rest at 1, in at least `minimum_seconds`.
    pub(super) fn rest_to_rest(limits: &PathLimits, minimum_seconds: f64) -> Result<Self, TimingError> {
        let mut input = bounded(limits);
        input.target_position[0] = 1.0;
        input.minimum_duration = Some(minimum_seconds);
        calculate(&input)
    }

    /// From a state on the way to rest, as soon as the limits allow it.
    pub(super) fn stop(state: &PathState, limits: &PathLimits) -> Result<Self, TimingError> {
        let mut input = bounded(limits);
        input.control_interface = ControlInterface::Velocity;
        input.current_position[0] = state.parameter;
        input.current_velocity[0] = state.speed;
        input.current_acceleration[0] = state.acceleration;
        calculate(&input)
    }

    /// At rest where it is.
    pub(super) fn rest(parameter: f64) -> Self {
        let mut trajectory = Trajectory::new(None);
        for section in &mut trajectory.profiles {
            section[0].p = [parameter; 8];
            section[0].pf = parameter;
        }
        Self { trajectory }
    }

    pub(super) fn seconds(&self) -> f64 {
        self.trajectory.get_duration()
    }

    /// The state after so many seconds; before the start and after the end it is at rest there.
    pub(super) fn at(&self, seconds: f64) -> PathState {
        let mut position = rsruckig::util::DataArrayOrVec::new(None, 0.0);
        let (mut speed, mut acceleration) = (position.clone(), position.clone());
        self.trajectory.at_time(
            seconds.clamp(0.0, self.seconds()),
            &mut Some(&mut position),
            &mut Some(&mut speed),
            &mut Some(&mut acceleration),
            &mut None,
            &mut None,
        );
        PathState { parameter: position[0].clamp(0.0, 1.0), speed: speed[0], acceleration: acceleration[0] }
    }
}

fn bounded(limits: &PathLimits) -> InputParameter<1> {
    let mut input = InputParameter::new(None);
    input.max_velocity[0] = limits.speed;
    input.max_acceleration[0] = limits.acceleration;
    input.max_jerk[0] = limits.jerk;
    input
}

fn calculate(input: &InputParameter<1>) -> Result<PathTiming, TimingError> {
    let mut generator = Ruckig::<1, ThrowErrorHandler>::new(None, 0.01);
    let mut trajectory = Trajectory::new(None);
    generator.calculate(input, &mut trajectory).map_err(|error| TimingError { reason: error.to_string() })?;
    Ok(PathTiming { trajectory })
}

#[cfg(test)]
mod tests;
