//! How a path learns from one iteration to the next: the names of the strategies.

use serde::{Deserialize, Serialize};
use std::fmt;

/// A strategy that an operator can choose.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum StrategyKind {
    /// A fixed path from the person's movement space (thesis chapter 3).
    Gmm,
    /// A path that gives way to the force, iteration by iteration (chapter 4, algorithm 2).
    Force,
    /// Force and movement space together (chapter 5, algorithm 3).
    Multimodal,
    /// A contact's correction is carried along the path.
    Kernel,
    /// A Gaussian-process field of offsets.
    OffsetField,
    /// The comfort path blended towards the movement space.
    Blend,
}

impl StrategyKind {
    /// All strategies, the thesis' three first.
    pub const ALL: [Self; 6] = [Self::Gmm, Self::Force, Self::Multimodal, Self::Kernel, Self::OffsetField, Self::Blend];

    /// The name that files, arguments and screens share.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Gmm => "gmm",
            Self::Force => "force",
            Self::Multimodal => "multimodal",
            Self::Kernel => "kernel",
            Self::OffsetField => "offset_field",
            Self::Blend => "blend",
        }
    }
}

impl fmt::Display for StrategyKind {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.pad(self.name())
    }
}
