//! Takes away what the arm's own acceleration adds to the measured force.
//!
//! The held mass is a setting, not a measurement: what is left over is the safety room's business, which raises its
//! thresholds a little while the arm accelerates.

use super::window::{SensingError, within};
use crate::geometry::{Finite, Vector};
use serde::{Deserialize, Serialize};

/// Compensates the inertia of what the gripper holds.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct InertiaCompensation {
    /// Mass that the estimate of the wrench feels, in kilograms; 0 switches the compensation off.
    pub mass_kilograms: f64,
}

impl InertiaCompensation {
    /// Checks the mass.
    ///
    /// # Errors
    /// Where it is not from 0 to 3 kg: Baxter carries 2.2 kg.
    pub fn validate(&self) -> Result<(), SensingError> {
        let mass = self.mass_kilograms;
        within("inertia.mass_kilograms", mass, (0.0..=3.0).contains(&mass), "from 0 to 3 kg")
    }

    /// The force without the arm's own part: a mass that is accelerated pulls back on the gripper with `-m a`.
    ///
    /// `force` in newtons and `acceleration` (commanded, in m/s²) are in the same axes; an acceleration that is not finite
    /// is taken as none.
    #[must_use]
    pub fn apply(&self, force: Vector, acceleration: Vector) -> Vector {
        if acceleration.is_finite() { force + acceleration * self.mass_kilograms } else { force }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_pull_of_an_accelerated_mass_is_given_back() {
        let compensation = InertiaCompensation { mass_kilograms: 0.5 };
        let acceleration = Vector::new(1.0, 0.0, -2.0);
        let touch = Vector::new(0.0, 3.0, 0.0);
        let measured = touch - acceleration * 0.5;
        assert!((compensation.apply(measured, acceleration) - touch).norm() < 1e-12);
    }

    #[test]
    fn an_acceleration_that_is_no_number_changes_nothing() {
        let compensation = InertiaCompensation { mass_kilograms: 1.0 };
        assert_eq!(compensation.apply(Vector::x(), Vector::new(f64::NAN, 0.0, 0.0)), Vector::x());
    }

    #[test]
    fn a_mass_that_baxter_cannot_carry_is_refused() {
        assert!(InertiaCompensation { mass_kilograms: 3.5 }.validate().is_err());
        assert!(InertiaCompensation { mass_kilograms: f64::NAN }.validate().is_err());
        assert!(InertiaCompensation { mass_kilograms: 2.2 }.validate().is_ok());
    }
}
