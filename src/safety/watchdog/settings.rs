//! The limits of the watchdogs.

use serde::{Deserialize, Serialize};
use std::time::Duration;

/// From which age on an input does not hold any more, and what no force can be. The limits are ours: six periods of the
/// wrench, ten of the robot's state.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct WatchSettings {
    /// Force: hold.
    pub force: Duration,
    /// Joint positions: hold.
    pub joints: Duration,
    /// The robot's state: hold.
    pub robot_state: Duration,
    /// The person's pose: slow.
    pub pose: Duration,
    /// The person's pose: hold.
    pub pose_hold: Duration,
    /// The planner's answer: hold.
    pub planner: Duration,
    /// The console's heartbeat: hold.
    pub console: Duration,
    /// The supervisor's own beat: hold.
    pub tick: Duration,
    /// A step of the clock that cannot be a late beat: hold.
    pub clock_jump: Duration,
    /// Samples that are equal to the last digit: the sensor is frozen.
    pub frozen_samples: u32,
    /// A force component that Baxter's springs cannot measure, in newtons: the sensor is saturated.
    pub saturated_newtons: f64,
}

impl Default for WatchSettings {
    fn default() -> Self {
        Self {
            force: Duration::from_millis(60),
            joints: Duration::from_millis(100),
            robot_state: Duration::from_millis(100),
            pose: Duration::from_millis(500),
            pose_hold: Duration::from_secs(2),
            planner: Duration::from_millis(200),
            console: Duration::from_secs(1),
            tick: Duration::from_millis(100),
            clock_jump: Duration::from_secs(1),
            frozen_samples: 50,
            saturated_newtons: 150.0,
        }
    }
}
