//! From what was typed or written to what is needed: settings, and the profiles of people.
//!
//! Settings come from a file that valet never writes; a profile is one TOML file a person, under a pseudonym. Every error
//! names the file and the key. Nothing here talks to a robot.

mod builtin;
mod error;
mod layers;
mod places;
mod profile;
mod secret;
mod settings;
mod version;

pub use error::ConfigError;
pub use layers::layered;
pub use places::{Places, profile_names};
pub use profile::{
    ArmClothes, CameraPlace, CameraSetup, Clothes, Consent, Garment, LearnedPath, LoadedProfile, Profile, clothes_of,
    sample_colours,
};
pub use secret::{Key, SecretError, read_secret, write_whole};
pub use settings::{RecordingSettings, Settings};
