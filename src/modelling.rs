//! What a person can reach: Gaussian mixtures of joint positions, how they are fitted, and the stick between two joints.
//!
//! Holds the movement space of thesis section 3.3 and the stick model of section 5.1.2. Never reads a file, a clock or a
//! random source of its own: seeds and starting points come in as arguments. Positions are metres in `base`.

pub mod fit;
pub mod mixture;
pub mod random;
pub mod space;
pub mod stick;

pub use fit::{Fit, FitError, FitSettings, fit};
pub use mixture::{Mixture, MixtureError};
pub use random::SplitMix64;
pub use space::{ArmSpace, MovementSpace};
