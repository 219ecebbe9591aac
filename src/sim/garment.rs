//! The garment: a sleeveless jacket that both grippers hold at its shoulder parts.
//!
//! A garment notices by itself where the grippers are: its armhole goes onto a hand that a gripper brings it to, runs along
//! the arm, and comes off again. `Garment` is the trait that both backends implement.

mod cloth;
mod passage;
mod pull;
mod reduced;

pub use cloth::ClothGarment;
pub use reduced::ReducedGarment;

use super::person::{ArmPoints, Reaction};
use crate::body::PerSide;
use crate::geometry::{Point, Vector};
use serde::{Deserialize, Serialize};
use thiserror::Error;

/// Gravity in metres per second squared.
const GRAVITY: f64 = 9.81;

/// A garment's sizes and stuff, as a profile or the command line gives them.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct GarmentSizes {
    /// Its name for operators and records.
    pub name: String,
    /// Mass in kilograms.
    pub mass_kilograms: f64,
    /// Girth of an armhole in metres.
    pub armhole_girth_metres: f64,
    /// From one gripper to the other before the back is taut, in metres: the back panel and the depth of both armholes.
    pub back_reach_metres: f64,
    /// Stiffness of the taut back in newtons per metre.
    pub back_stiffness_newtons_per_metre: f64,
    /// Friction of the part of a sleeve that is past the wrist, in newtons per metre of it; 0 for a sleeveless garment.
    pub sleeve_friction_newtons_per_metre: f64,
    /// How stiffly the garment pulls where it is caught on fist or elbow, in newtons per metre.
    pub snag_stiffness_newtons_per_metre: f64,
    /// What a catch bears before the fabric works itself loose, in newtons.
    pub snag_ceiling_newtons: f64,
    /// Friction of fabric that missed the hand and drags over the arm, in newtons per metre.
    pub drape_newtons_per_metre: f64,
    /// Pull at which the fabric slips out of a gripper, in newtons.
    pub slip_newtons: f64,
}

impl Default for GarmentSizes {
    /// A wide sleeveless jacket: tailors' rule gives 0.48 m of armhole at a chest of 1.06 m; 0.45 m of back and twice 0.23 m
    /// of armhole let one side lie on a shoulder while the other goes to the opposite hand.
    fn default() -> Self {
        Self {
            name: "sleeveless jacket".into(),
            mass_kilograms: 0.4,
            armhole_girth_metres: 0.48,
            back_reach_metres: 0.91,
            back_stiffness_newtons_per_metre: 150.0,
            sleeve_friction_newtons_per_metre: 0.0,
            // Woven jackets snag at 200 to 600 N/m.
            snag_stiffness_newtons_per_metre: 300.0,
            snag_ceiling_newtons: 30.0,
            drape_newtons_per_metre: 7.7,
            slip_newtons: 35.0,
        }
    }
}

impl GarmentSizes {
    /// A hospital gown with long sleeves, as it was pulled over forearms in published measurements (Kapusta and others,
    /// RO-MAN 2016): the yardstick of the pull profiles.
    #[must_use]
    pub fn hospital_gown() -> Self {
        Self {
            name: "hospital gown".into(),
            mass_kilograms: 0.16,
            sleeve_friction_newtons_per_metre: 19.0,
            snag_stiffness_newtons_per_metre: 105.0,
            snag_ceiling_newtons: 10.5,
            ..Self::default()
        }
    }
}

/// Why a garment cannot be put on.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum GarmentError {
    /// A number that no garment has.
    #[error("garment.{key} is {value}, but garments have {lowest} to {highest}: correct it")]
    OutOfRange {
        /// The key.
        key: &'static str,
        /// Its value.
        value: f64,
        /// The lowest that is allowed.
        lowest: f64,
        /// The highest that is allowed.
        highest: f64,
    },
    /// The armhole cannot pass a part of the arm.
    #[error(
        "the armhole of '{name}' is {armhole:.3} m round and cannot pass the {part}, {girth:.3} m round: take a larger garment"
    )]
    TooTight {
        /// The garment.
        name: String,
        /// The part of the arm.
        part: &'static str,
        /// Girth of the armhole in metres.
        armhole: f64,
        /// Girth of that part in metres.
        girth: f64,
    },
}

impl GarmentSizes {
    /// Checks the garment, and that its armholes pass an arm's hand and upper arm.
    ///
    /// # Errors
    /// What is wrong, with the sizes.
    pub fn check(&self, arm: &super::person::ArmSizes) -> Result<(), GarmentError> {
        for (key, value, lowest, highest) in [
            ("mass_kilograms", self.mass_kilograms, 0.05, 3.0),
            ("armhole_girth_metres", self.armhole_girth_metres, 0.1, 1.2),
            ("back_reach_metres", self.back_reach_metres, 0.3, 1.5),
            ("back_stiffness_newtons_per_metre", self.back_stiffness_newtons_per_metre, 0.0, 2000.0),
            ("sleeve_friction_newtons_per_metre", self.sleeve_friction_newtons_per_metre, 0.0, 500.0),
            ("snag_stiffness_newtons_per_metre", self.snag_stiffness_newtons_per_metre, 1.0, 2000.0),
            ("snag_ceiling_newtons", self.snag_ceiling_newtons, 1.0, 100.0),
            ("drape_newtons_per_metre", self.drape_newtons_per_metre, 0.0, 100.0),
            ("slip_newtons", self.slip_newtons, 1.0, 100.0),
        ] {
            if !(lowest..=highest).contains(&value) {
                return Err(GarmentError::OutOfRange { key, value, lowest, highest });
            }
        }
        for (part, radius) in [("hand", arm.hand_radius_metres), ("upper arm", arm.upper_arm_radius_metres)] {
            let girth = std::f64::consts::TAU * radius;
            if self.armhole_girth_metres < girth {
                let (name, armhole) = (self.name.clone(), self.armhole_girth_metres);
                return Err(GarmentError::TooTight { name, part, armhole, girth });
            }
        }
        Ok(())
    }
}

/// Metres before the back is taut at which the grippers stop going apart: twenty times what a guard lets pass.
const BEFORE_TAUT: f64 = 0.01;

impl GarmentSizes {
    /// The furthest in metres that the grippers may be apart with this garment between them.
    #[must_use]
    pub const fn slack_metres(&self) -> f64 {
        self.back_reach_metres - BEFORE_TAUT
    }

    /// The force of the back on each gripper in newtons: none before it is taut or once a side has slipped.
    fn back_forces(&self, holders: &PerSide<Holder>, wearing: &PerSide<Wearing>) -> PerSide<Vector> {
        let across = holders.right.tip - holders.left.tip;
        let distance = across.norm();
        let stretch = distance - self.back_reach_metres;
        let slipped = wearing.iter().any(|(_, wearing)| *wearing == Wearing::Slipped);
        if slipped || stretch <= 0.0 {
            return PerSide { left: Vector::zeros(), right: Vector::zeros() };
        }
        let pull = across * (self.back_stiffness_newtons_per_metre * stretch / distance);
        PerSide { left: pull, right: -pull }
    }
}

/// A gripper as the garment feels it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Holder {
    /// Its tip in metres in `base`.
    pub(super) tip: Point,
    /// Its velocity in metres per second.
    pub(super) velocity: Vector,
}

/// How far a sleeve has gone onto an arm.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case", tag = "state")]
pub enum Wearing {
    /// Not on the arm.
    #[default]
    Off,
    /// Past the hand without going round it: the fabric drags over the arm.
    Missed {
        /// Metres along the arm.
        metres: f64,
    },
    /// Round the arm, with its rim this far from the hand.
    On {
        /// Metres along the arm.
        metres: f64,
    },
    /// Out of the gripper.
    Slipped,
}

/// A garment that reacts to the grippers.
pub(super) trait Garment: std::fmt::Debug + Send {
    /// Moves the garment on by `seconds` and returns the force on each gripper in newtons, `base` axes.
    fn step(
        &mut self,
        seconds: f64,
        holders: &PerSide<Holder>,
        arms: &PerSide<ArmPoints>,
        reactions: &mut PerSide<Reaction>,
    ) -> PerSide<Vector>;

    /// How far the sleeves are on.
    fn wearing(&self) -> PerSide<Wearing>;

    /// Catches the rim where it is (`true`), on fist, elbow or a fold of clothing, or frees it.
    fn snag(&mut self, side: crate::body::Side, caught: bool);

    /// Makes the garment slip out of a gripper.
    fn slip(&mut self, side: crate::body::Side);
}

#[cfg(test)]
mod tests;
