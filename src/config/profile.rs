//! A person's profile: everything valet knows about one person, under a pseudonym.
//!
//! Never holds a name, an address or a date of birth; such keys are refused. Shape and movement can still identify a
//! person, so a profile is health data: `valet profile encrypt` keeps it encrypted on disk.

mod camera;
mod check;
mod clothes;
mod learn;
mod load;

pub use camera::{CameraPlace, CameraSetup};
pub use clothes::{ArmClothes, Clothes, clothes_of, sample_colours};
pub use load::LoadedProfile;

use crate::body::Side;
use crate::modelling::MovementSpace;
use crate::sim::garment::GarmentSizes;
use crate::sim::person::SimulatedPerson;
use crate::strategy::StrategyKind;
use serde::{Deserialize, Serialize};
use std::path::PathBuf;

/// A person's profile.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Profile {
    /// The version of the format: 1.
    pub version: u32,
    /// The pseudonym: small letters, digits and dashes.
    pub pseudonym: String,
    /// What matters for dressing this person, in words without a name.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub notes: String,
    /// Which arm is dressed first, where it matters.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub first_arm: Option<Side>,
    /// The strategy that suits this person.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub strategy: Option<StrategyKind>,
    /// The consent; a trial with a person on a robot needs one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub consent: Option<Consent>,
    /// The person's decision tree for the depth camera: a file, relative to the profile.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub tree: Option<PathBuf>,
    /// The depth camera, where the person's pose is to come from it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub camera: Option<CameraSetup>,
    /// The colours that the person wears while images are taken to train from.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub clothes: Option<Clothes>,
    /// Garments by name.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub garments: Vec<Garment>,
    /// Settings that differ for this person: thresholds, limits, strategies. The keys are those of the file of settings.
    #[serde(default, skip_serializing_if = "toml::Table::is_empty")]
    pub settings: toml::Table,
    /// The movement space, as `valet fit` makes it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub movement_space: Option<MovementSpace>,
    /// Paths that earlier trials have learned.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub learned: Vec<LearnedPath>,
    /// The person for the simulator; absent for a real one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub simulated: Option<SimulatedPerson>,
}

/// What the person agreed to, and when.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Consent {
    /// Version of the consent form.
    pub version: String,
    /// Year, month and day, as in `2026-11-22`.
    pub date: String,
}

/// A garment: its sizes and its name.
pub type Garment = GarmentSizes;

/// A path that a trial has learned, in coordinates relative to the person's arm.
pub type LearnedPath = crate::supervisor::WarmStart;

impl Profile {
    /// The newest version of the format.
    pub const VERSION: u32 = 1;

    /// The garment of a name; the first one where no name is given.
    #[must_use]
    pub fn garment(&self, name: Option<&str>) -> Option<&Garment> {
        match name {
            Some(name) => self.garments.iter().find(|garment| garment.name == name),
            None => self.garments.first(),
        }
    }

    /// The path that was learned last for an arm.
    #[must_use]
    pub fn learned_path(&self, side: Side, strategy: StrategyKind) -> Option<&LearnedPath> {
        self.learned.iter().rev().find(|path| path.side == side && path.strategy == strategy)
    }
}

#[cfg(test)]
mod tests;
