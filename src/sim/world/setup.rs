//! What a world is made of.

use super::super::baxter::ArmDynamics;
use super::super::faults::FaultPlan;
use super::super::garment::{ClothGarment, Garment, GarmentError, GarmentSizes, ReducedGarment};
use super::super::person::{PersonError, SimulatedPerson};
use super::super::wrench::WrenchErrors;
use crate::body::{PerSide, Side};
use crate::geometry::Point;
use crate::kinematics::ModelError;
use serde::{Deserialize, Serialize};
use thiserror::Error;

/// Which model of the garment is used.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Backend {
    /// A tube round the preferred path: fast, smooth, exact.
    #[default]
    Reduced,
    /// An armhole of cloth round a moving arm, on rapier's soft bodies: believable, some tens of times real time.
    Cloth,
}

/// What a world is made of: everything that can differ between two simulated trials.
#[derive(Clone, Debug, PartialEq)]
pub struct WorldSetup {
    /// The person.
    pub person: SimulatedPerson,
    /// The garment.
    pub garment: GarmentSizes,
    /// The model of the garment.
    pub backend: Backend,
    /// How the wrench estimate errs.
    pub wrench: WrenchErrors,
    /// How the arms follow.
    pub dynamics: ArmDynamics,
    /// Standard deviation of a joint's position as the pose finder gives it, in metres on each axis.
    pub pose_noise_metres: f64,
    /// Whether the pose finder loses joints that the robot's grippers hide from its camera.
    pub arms_hide_joints: bool,
    /// The person's how manieth experiment this is, from 0: in the first the preferred movement is further off.
    pub experiment: u32,
    /// For so many seconds from the start the person moves both arms about, as before a first trial (thesis section 3.3).
    pub exercise_seconds: f64,
    /// What goes wrong, and when.
    pub faults: FaultPlan,
    /// Everything random comes from it.
    pub seed: u64,
}

impl Default for WorldSetup {
    fn default() -> Self {
        Self {
            person: SimulatedPerson::default(),
            garment: GarmentSizes::default(),
            backend: Backend::default(),
            wrench: WrenchErrors::default(),
            dynamics: ArmDynamics::default(),
            // The pose finder averages the pixels of a part: a few millimetres.
            pose_noise_metres: 0.004,
            arms_hide_joints: false,
            experiment: 1,
            exercise_seconds: 0.0,
            faults: FaultPlan::default(),
            seed: 1,
        }
    }
}

/// Why a world cannot be made.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum SimError {
    /// The person cannot be.
    #[error(transparent)]
    Person(#[from] PersonError),
    /// The garment cannot be put on.
    #[error(transparent)]
    Garment(#[from] GarmentError),
    /// The robot cannot be.
    #[error(transparent)]
    Robot(#[from] ModelError),
    /// A sense cannot be.
    #[error("simulation.{key} is {value}: give a number from {lowest} to {highest}")]
    Sense {
        /// The key.
        key: &'static str,
        /// Its value.
        value: f64,
        /// The lowest that is allowed.
        lowest: f64,
        /// The highest that is allowed.
        highest: f64,
    },
}

impl WorldSetup {
    /// Checks person, garment and senses.
    ///
    /// # Errors
    /// The first thing that cannot be, with what to correct.
    pub fn check(&self) -> Result<(), SimError> {
        self.person.check()?;
        self.garment.check(&self.person.body.arm_sizes())?;
        for (key, value, lowest, highest) in [
            ("wrench.noise_newtons", self.wrench.noise_newtons, 0.0, 20.0),
            ("wrench.bias_newtons", self.wrench.bias_newtons, 0.0, 50.0),
            ("wrench.bias_period_metres", self.wrench.bias_period_metres, 0.05, 100.0),
            ("wrench.drift_newtons", self.wrench.drift_newtons, 0.0, 5.0),
            ("wrench.quantum_newtons", self.wrench.quantum_newtons, 0.0, 5.0),
            ("wrench.unmodelled_mass_kilograms", self.wrench.unmodelled_mass_kilograms, 0.0, 5.0),
            ("dynamics.lag_seconds", self.dynamics.lag_seconds, 0.0, 1.0),
            ("pose_noise_metres", self.pose_noise_metres, 0.0, 0.2),
            ("exercise_seconds", self.exercise_seconds, 0.0, 600.0),
        ] {
            if !(lowest..=highest).contains(&value) {
                return Err(SimError::Sense { key, value, lowest, highest });
            }
        }
        Ok(())
    }

    /// The garment in both grippers, on nobody, of the chosen model.
    pub(in crate::sim) fn garment_model(&self) -> Box<dyn Garment> {
        let sizes = self.garment.clone();
        match self.backend {
            Backend::Reduced => Box::new(ReducedGarment::new(sizes)),
            Backend::Cloth => Box::new(ClothGarment::new(sizes, self.person.body.arm_sizes())),
        }
    }

    /// The path that the person likes best in this experiment, metres in `base`.
    pub(in crate::sim) fn preferred_path(&self, side: Side) -> Vec<Point> {
        let mut arm = self.person.arm(side);
        if self.experiment == 0 {
            arm.preferred_offset_metres =
                arm.preferred_offset_metres.map(|value| value * arm.response.unfamiliar_factor);
        }
        let posture: PerSide<_> = self.person.posture();
        arm.preferred_path(side, &posture.get(side).dressed())
    }
}
