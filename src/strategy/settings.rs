//! Settings of the strategies, in the units of the robot, and the checks that refuse values that cannot work.
//!
//! The thesis' values are the defaults where the thesis has one. Its synthetic problems have no units; their values are
//! made in `experiments`.

use super::StrategyError;
use crate::modelling::stick::Space;
use crate::planning::OptimiserSettings;
use serde::{Deserialize, Serialize};

/// The settings of all strategies.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct StrategySettings {
    /// What all learning strategies share.
    pub learning: LearningSettings,
    /// Of `multimodal`.
    pub multimodal: MultimodalSettings,
    /// Of `kernel`, and of the comfort phase of `blend`.
    pub kernel: KernelSettings,
    /// Of `offset_field`.
    pub offset_field: OffsetFieldSettings,
    /// Of `blend`.
    pub blend: BlendSettings,
}

/// What all learning strategies share.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct LearningSettings {
    /// How a resistance becomes a displacement.
    pub optimiser: OptimiserSettings,
    /// Metres between the points at which a straight line gives way at most once (thesis section 4.5.1: 0.05).
    pub step: f64,
    /// No displacement is longer than this many metres: on a person 0.05.
    pub maximum_step: f64,
    /// No more than this many iterations (section 5.2.2: 8).
    pub maximum_iterations: u32,
    /// Learning ends when an iteration's energy is at or below this many newtons (section 4.4.3: 0).
    pub energy_threshold: f64,
    /// Learning ends when the path has this many way-points.
    pub maximum_waypoints: usize,
    /// Inner way-points closer than this many metres to the one before are merged after an iteration; 0 (the thesis)
    /// keeps all.
    pub merge_distance: f64,
    /// A contact this many metres from the pinned last way-point or closer moves nothing.
    pub end_tolerance: f64,
    /// Guards against weak points of the printed rules; all off by default.
    pub guards: Guards,
}

impl Default for LearningSettings {
    fn default() -> Self {
        Self {
            optimiser: OptimiserSettings::default(),
            step: 0.05,
            maximum_step: 0.05,
            maximum_iterations: 8,
            energy_threshold: 0.0,
            maximum_waypoints: 2_500,
            merge_distance: 0.0,
            end_tolerance: 0.01,
            guards: Guards::default(),
        }
    }
}

/// Guards against weak points of normalised steps. The thesis has none of them.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Guards {
    /// No displacement is longer than this many metres a newton of the present resistance; 0 is off. Adam's first step
    /// has the same length for every force.
    pub maximum_gain: f64,
    /// Axes whose reading is this many newtons or less do not move; 0 is off. With second moments by axis, noise on a
    /// quiet axis is answered with a full step.
    pub quiet_axis: f64,
    /// The reading is shortened by this many newtons before it is used; 0 is off. A constant bias of the sensor pushes
    /// every normalised step away from the optimum.
    pub bias: f64,
}

/// Settings of chapter 5's strategy.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct MultimodalSettings {
    /// How many places are tried for the next goal (section 5.2.1: 20).
    pub draws: u32,
    /// Within how many metres of the goal (section 5.2.1: 0.5 for limbs about 2.7 long; here the same share of a
    /// forearm of 0.27 m).
    pub end_radius: f64,
    /// Within how many metres of the moved way-point (section 5.2.1: 0.2; here the same share).
    pub middle_radius: f64,
    /// Whether the present goal competes with the draws.
    pub include_current: bool,
    /// Keep the goal where the way-point is closer to it than this many middle radii: there the direction of the limb
    /// is noise, and without this guard the goal runs away. 0 is the printed algorithm.
    pub guard_radii: f64,
    /// Whether the shoulder stays where it is.
    pub pin_last: bool,
    /// Whether a limb's two ends are weighed by one mixture over the whole arm in place of the thesis' independent joints;
    /// needs a movement space whose joints were recorded together.
    pub whole_arm: bool,
    /// In a plane or in space.
    pub space: Space,
}

impl Default for MultimodalSettings {
    fn default() -> Self {
        Self {
            draws: 20,
            end_radius: 0.05,
            middle_radius: 0.02,
            include_current: true,
            guard_radii: 2.0,
            pin_last: true,
            whole_arm: false,
            space: Space::Spatial,
        }
    }
}

/// Settings of the kernel step.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct KernelSettings {
    /// Share of the way to the expected optimum that one step goes.
    pub gain: f64,
    /// How far along the path a correction is carried, in metres: about a seventh of the path.
    pub length_scale: f64,
    /// The first guess of the stiffness in newtons a metre: less than that of a simulated arm and sleeve (350), because
    /// nothing is felt until the sleeve's play is used up. Too large is safe: the first step is small.
    pub stiffness: f64,
    /// Whether the stiffness is learned from what is still felt after a step.
    pub learn_stiffness: bool,
}

impl Default for KernelSettings {
    fn default() -> Self {
        Self { gain: 0.8, length_scale: 0.08, stiffness: 200.0, learn_stiffness: true }
    }
}

/// Settings of the Gaussian-process field of offsets.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct OffsetFieldSettings {
    /// Length scale along the path in metres.
    pub length_scale: f64,
    /// Standard deviation of offsets before anything is known, in metres.
    pub deviation: f64,
    /// Standard deviation of an offset that a contact reports, in metres.
    pub noise: f64,
    /// The same as a share of the offset.
    pub relative_noise: f64,
    /// The first guess of the stiffness in newtons a metre.
    pub stiffness: f64,
    /// Whether the stiffness is learned from what is still felt after a step.
    pub learn_stiffness: bool,
}

impl Default for OffsetFieldSettings {
    fn default() -> Self {
        Self {
            length_scale: 0.08,
            deviation: 0.1,
            noise: 0.005,
            relative_noise: 0.4,
            stiffness: 200.0,
            learn_stiffness: true,
        }
    }
}

/// Settings of the blend of comfort and reach.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct BlendSettings {
    /// The weight of comfort: how many standard deviations a typical distance from the comfort path is worth. 0 follows
    /// the movement space alone.
    pub weight: f64,
    /// The typical distance from the comfort path in metres.
    pub distance_scale: f64,
}

impl Default for BlendSettings {
    fn default() -> Self {
        Self { weight: 4.0, distance_scale: 0.1 }
    }
}

impl StrategySettings {
    /// Checks every value.
    ///
    /// # Errors
    /// [`StrategyError::Setting`] with the key of the first value that cannot work, and why.
    pub fn validate(&self) -> Result<(), StrategyError> {
        self.learning.validate()?;
        let multimodal = &self.multimodal;
        positive("multimodal.draws", f64::from(multimodal.draws))?;
        positive("multimodal.end_radius", multimodal.end_radius)?;
        positive("multimodal.middle_radius", multimodal.middle_radius)?;
        not_negative("multimodal.guard_radii", multimodal.guard_radii)?;
        share("kernel.gain", self.kernel.gain)?;
        positive("kernel.length_scale", self.kernel.length_scale)?;
        positive("kernel.stiffness", self.kernel.stiffness)?;
        positive("offset_field.length_scale", self.offset_field.length_scale)?;
        positive("offset_field.deviation", self.offset_field.deviation)?;
        positive("offset_field.noise", self.offset_field.noise)?;
        not_negative("offset_field.relative_noise", self.offset_field.relative_noise)?;
        positive("offset_field.stiffness", self.offset_field.stiffness)?;
        not_negative("blend.weight", self.blend.weight)?;
        positive("blend.distance_scale", self.blend.distance_scale)
    }
}

impl LearningSettings {
    fn validate(&self) -> Result<(), StrategyError> {
        positive("learning.optimiser.learning_rate", self.optimiser.learning_rate)?;
        positive("learning.step", self.step)?;
        positive("learning.maximum_step", self.maximum_step)?;
        positive("learning.maximum_iterations", f64::from(self.maximum_iterations))?;
        not_negative("learning.energy_threshold", self.energy_threshold)?;
        check("learning.maximum_waypoints", self.maximum_waypoints as f64, "at least 3", |value| value >= 3.0)?;
        not_negative("learning.merge_distance", self.merge_distance)?;
        not_negative("learning.end_tolerance", self.end_tolerance)?;
        not_negative("learning.guards.maximum_gain", self.guards.maximum_gain)?;
        not_negative("learning.guards.quiet_axis", self.guards.quiet_axis)?;
        not_negative("learning.guards.bias", self.guards.bias)
    }
}

fn positive(key: &'static str, value: f64) -> Result<(), StrategyError> {
    check(key, value, "a finite number above 0", |value| value > 0.0)
}

fn not_negative(key: &'static str, value: f64) -> Result<(), StrategyError> {
    check(key, value, "a finite number of 0 or above", |value| value >= 0.0)
}

fn share(key: &'static str, value: f64) -> Result<(), StrategyError> {
    check(key, value, "above 0 and at most 1: a longer step overshoots", |value| value > 0.0 && value <= 1.0)
}

fn check(key: &'static str, value: f64, needed: &'static str, fits: impl Fn(f64) -> bool) -> Result<(), StrategyError> {
    if value.is_finite() && fits(value) { Ok(()) } else { Err(StrategyError::Setting { key, value, needed }) }
}
