//! From the wrench as the robot gives it to the force that the algorithms mean.
//!
//! The algorithms use *gripper-force axes* (thesis section 4.2): parallel to `base`, and opposite to it in sign, so that
//! `p - step(F)` gives way to the force. What frame and sign Baxter's `endpoint_state` has is not stated by its maker, and
//! published uses disagree: both are settings, and the sign check before a trial shows which ones are right.

use crate::geometry::{Pose, Vector, Wrench};
use serde::{Deserialize, Serialize};

/// To which axes the robot's wrench is parallel.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum ForceAxes {
    /// The robot's `base`: what the thesis' observations imply.
    #[default]
    Base,
    /// The gripper's own axes.
    Gripper,
}

/// Which way the robot's wrench counts.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum ForceSign {
    /// As the force on the gripper from outside.
    Plus,
    /// As the force of the gripper on the world: what the thesis' observations imply.
    #[default]
    Minus,
}

/// How the robot's wrench is read.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct WrenchConversion {
    /// Axes of the robot's wrench.
    pub axes: ForceAxes,
    /// Sign of the robot's wrench.
    pub sign: ForceSign,
}

impl WrenchConversion {
    /// The force from outside on the gripper, in `base`, in newtons.
    #[must_use]
    pub fn external_force(&self, wrench: &Wrench, gripper: &Pose) -> Vector {
        let parallel = match self.axes {
            ForceAxes::Base => wrench.force,
            ForceAxes::Gripper => gripper.rotation * wrench.force,
        };
        match self.sign {
            ForceSign::Plus => parallel,
            ForceSign::Minus => -parallel,
        }
    }

    /// The force in gripper-force axes, in newtons: `x_force = -x_base` (thesis section 4.2), so that a pull of the sleeve
    /// towards -x of `base` is positive along x and `p - step(F)` yields to it.
    ///
    /// ```
    /// use valet::geometry::{Pose, Vector, Wrench};
    /// use valet::sensing::WrenchConversion;
    ///
    /// // Baxter, as the thesis saw it, reports what the gripper does to the world: it pulls the sleeve towards +x.
    /// let wrench = Wrench { force: Vector::new(6.0, 0.0, 0.0), torque: Vector::zeros() };
    /// let conversion = WrenchConversion::default();
    /// assert_eq!(conversion.external_force(&wrench, &Pose::identity()), Vector::new(-6.0, 0.0, 0.0));
    /// assert_eq!(conversion.gripper_force(&wrench, &Pose::identity()), Vector::new(6.0, 0.0, 0.0));
    /// ```
    #[must_use]
    pub fn gripper_force(&self, wrench: &Wrench, gripper: &Pose) -> Vector {
        -self.external_force(wrench, gripper)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{Translation3, UnitQuaternion};
    use proptest::prelude::*;

    fn quarter_turn() -> Pose {
        let turn = UnitQuaternion::from_axis_angle(&Vector::z_axis(), std::f64::consts::FRAC_PI_2);
        Pose::from_parts(Translation3::new(1.0, 2.0, 3.0), turn)
    }

    fn wrench(x: f64, y: f64, z: f64) -> Wrench {
        Wrench { force: Vector::new(x, y, z), torque: Vector::zeros() }
    }

    #[test]
    fn yielding_along_the_external_force_is_moving_against_the_gripper_force() {
        for axes in [ForceAxes::Base, ForceAxes::Gripper] {
            for sign in [ForceSign::Plus, ForceSign::Minus] {
                let conversion = WrenchConversion { axes, sign };
                let sum = conversion.external_force(&wrench(1.0, -2.0, 3.0), &quarter_turn())
                    + conversion.gripper_force(&wrench(1.0, -2.0, 3.0), &quarter_turn());
                assert!(sum.norm() < 1e-12);
            }
        }
    }

    #[test]
    fn gripper_axes_turn_with_the_gripper_and_do_not_move_with_it() {
        let conversion = WrenchConversion { axes: ForceAxes::Gripper, sign: ForceSign::Plus };
        let force = conversion.external_force(&wrench(1.0, 0.0, 0.0), &quarter_turn());
        assert!((force - Vector::y()).norm() < 1e-12, "{force}");
    }

    #[test]
    fn settings_are_written_as_words() {
        let text = serde_json::to_string(&WrenchConversion::default()).unwrap();
        assert_eq!(text, r#"{"axes":"base","sign":"minus"}"#);
        assert!(serde_json::from_str::<WrenchConversion>(r#"{"axis":"base"}"#).is_err());
    }

    proptest! {
        #[test]
        fn no_conversion_changes_how_strong_a_force_is(x in -50.0..50.0_f64, y in -50.0..50.0_f64, z in -50.0..50.0_f64) {
            for axes in [ForceAxes::Base, ForceAxes::Gripper] {
                let conversion = WrenchConversion { axes, sign: ForceSign::Minus };
                let force = conversion.gripper_force(&wrench(x, y, z), &quarter_turn());
                prop_assert!((force.norm() - wrench(x, y, z).force.norm()).abs() < 1e-9);
            }
        }
    }
}
