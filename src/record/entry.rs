//! What a journal holds: one header, and steps.

use crate::kinematics::BodyBuild;
use crate::modelling::MovementSpace;
use crate::snapshot::Watermark;
use crate::supervisor::{Effect, Input, Setup, SupervisorSettings, WarmStart};
use crate::time::Stamp;
use serde::{Deserialize, Serialize};

/// What a trial was run with: enough to build the same core again.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Header {
    /// Version of valet that wrote it.
    pub software: String,
    /// Seed of everything random.
    pub seed: u64,
    /// The profile's name.
    pub profile: String,
    /// SHA-256 of the profile's text, shortened.
    pub profile_hash: String,
    /// The profile's text, whole.
    pub profile_text: String,
    /// The garment's name.
    pub garment: String,
    /// The core's settings, the movement space and the build of the person, as TOML.
    pub recipe: String,
    /// What kind of run it was, as in `live` or `demo`.
    pub watermark: String,
    /// When it began by the wall clock, in nanoseconds since 1970; 0 in virtual time.
    pub began_nanoseconds: u64,
}

/// What a core is built from, as a journal's header keeps it. TOML keeps every digit of a number.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Recipe {
    settings: SupervisorSettings,
    build: BodyBuild,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    space: Option<MovementSpace>,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    warm_start: Vec<WarmStart>,
}

impl Header {
    /// The header of a trial that a core with this setup runs. `profile_text` is the profile's file, `began_nanoseconds`
    /// the wall clock (0 in virtual time).
    ///
    /// # Errors
    /// The reason in words where the setup cannot be written down.
    pub fn of(setup: &Setup, profile_text: &str, began_nanoseconds: u64) -> Result<Self, String> {
        let recipe = Recipe {
            settings: setup.settings.clone(),
            build: setup.build,
            space: setup.space.clone(),
            warm_start: setup.warm_start.clone(),
        };
        Ok(Self {
            software: env!("CARGO_PKG_VERSION").to_owned(),
            seed: setup.seed,
            profile: setup.profile.clone(),
            profile_hash: setup.profile_hash.clone(),
            profile_text: profile_text.to_owned(),
            garment: setup.garment.clone(),
            recipe: toml::to_string(&recipe).map_err(|error| error.to_string())?,
            watermark: setup.watermark.word().unwrap_or("LIVE").to_owned(),
            began_nanoseconds,
        })
    }
}

impl Recipe {
    /// The setup that a header describes.
    pub(super) fn of_header(header: &Header) -> Result<Setup, String> {
        let recipe: Self = toml::from_str(&header.recipe).map_err(|error| error.to_string())?;
        Ok(Setup {
            settings: recipe.settings,
            space: recipe.space,
            warm_start: recipe.warm_start,
            build: recipe.build,
            seed: header.seed,
            watermark: Watermark::Replay,
            profile: header.profile.clone(),
            profile_hash: header.profile_hash.clone(),
            garment: header.garment.clone(),
        })
    }
}

/// One step of the core: what came in when, and what was decided.
#[derive(Clone, Debug, PartialEq)]
pub struct Step {
    /// Its number, from 0.
    pub number: u64,
    /// The core's time.
    pub now: Stamp,
    /// What came in.
    pub input: Input,
    /// What was decided, in order.
    pub effects: Vec<Effect>,
    /// Steps that were lost before this one because the queue was full.
    pub lost_before: u64,
}

/// The exact record of what came in.
#[derive(Serialize)]
pub(super) struct InputEntry<'a> {
    pub(super) number: u64,
    pub(super) now: Stamp,
    pub(super) lost_before: u64,
    pub(super) input: &'a Input,
}

/// The same, read back.
#[derive(Deserialize)]
pub(super) struct OwnedInputEntry {
    pub(super) number: u64,
    pub(super) now: Stamp,
    pub(super) lost_before: u64,
    pub(super) input: Input,
}

/// The exact record of what was decided. Steps without a decision have none.
#[derive(Serialize)]
pub(super) struct EffectEntry<'a> {
    pub(super) number: u64,
    pub(super) effects: &'a [Effect],
}

/// The same, read back.
#[derive(Deserialize)]
pub(super) struct OwnedEffectEntry {
    pub(super) number: u64,
    pub(super) effects: Vec<Effect>,
}

/// The bytes by which decisions are compared: equal bytes are equal decisions, numbers that are not finite included.
///
/// # Errors
/// Where a value cannot be put into CBOR.
pub(super) fn bytes_of(value: &impl Serialize) -> Result<Vec<u8>, String> {
    let mut bytes = Vec::new();
    ciborium::into_writer(value, &mut bytes).map_err(|error| error.to_string())?;
    Ok(bytes)
}

impl Step {
    /// True where `effects` are, byte for byte, what was recorded.
    #[must_use]
    pub fn decided(&self, effects: &[Effect]) -> bool {
        match (bytes_of(&self.effects), bytes_of(&effects)) {
            (Ok(recorded), Ok(now)) => recorded == now,
            _ => false,
        }
    }
}
