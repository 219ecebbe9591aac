//! Force as the screen sees it: raw, through the detector's window, and against the safety tiers.

use super::health::Freshness;
use super::history::{History, Shared};
use crate::time::Stamp;
use serde::{Deserialize, Serialize};
use std::fmt;

/// One sample of an arm's force, and what the detector made of it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct ForceSample {
    /// The sample's own stamp. A hole between stamps is a gap, and is drawn as one.
    pub stamp: Stamp,
    /// Force in newtons along x, y, z of the gripper's force axes, after bias.
    pub force: [f64; 3],
    /// The window's change along each axis in newtons; `None` while the window fills.
    pub change: Option<[f64; 3]>,
    /// The statistic that is compared with the threshold, in newtons; `None` while the window fills.
    pub statistic: Option<f64>,
}

impl ForceSample {
    /// The magnitude of the force in newtons.
    #[must_use]
    pub fn magnitude(&self) -> f64 {
        self.force.iter().map(|value| value * value).sum::<f64>().sqrt()
    }
}

/// The detector's window.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct WindowView {
    /// Which detector and which form, in words, as in "window, vector form".
    pub detector: String,
    /// Differences in the window now.
    pub filled: u32,
    /// Differences in a full window (the thesis' N).
    pub length: u32,
    /// The threshold in newtons.
    pub threshold: f64,
    /// Why the window was broken last, in words; empty where it never was.
    pub broken: String,
}

/// A resistance that the detector found.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Detection {
    /// When.
    pub stamp: Stamp,
    /// The statistic in newtons.
    pub magnitude: f64,
    /// Its parts along x, y, z in newtons.
    pub vector: [f64; 3],
    /// In which iteration, from 1.
    pub iteration: u32,
    /// The way-point that it moved, from 0.
    pub waypoint: Option<u32>,
    /// The line of the log that tells of it.
    pub log_line: Option<u64>,
}

/// How far force protection has gone, independently of the strategy.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum ForceTier {
    /// Nothing to say.
    #[default]
    Normal,
    /// The operator is told.
    Advise,
    /// The arm slows down.
    Slow,
    /// The arm holds until the operator goes on.
    Pause,
    /// Emergency stop.
    Stop,
}

impl ForceTier {
    /// The tier as a word.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Normal => "normal",
            Self::Advise => "advise",
            Self::Slow => "slow",
            Self::Pause => "pause",
            Self::Stop => "stop",
        }
    }
}

impl fmt::Display for ForceTier {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.pad(self.name())
    }
}

/// Where a tier begins at this place of the arm.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct TierMargin {
    /// Which tier.
    pub tier: ForceTier,
    /// Where it begins, in newtons.
    pub limit: f64,
}

/// The force of one side.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct ForceView {
    /// Samples, oldest first.
    pub samples: History<ForceSample>,
    /// Whether the newest sample still holds.
    pub freshness: Freshness,
    /// The detector's window.
    pub window: WindowView,
    /// Resistances found, oldest first.
    pub detections: History<Detection>,
    /// The tier in force.
    pub tier: ForceTier,
    /// What brought it about, in words; empty at [`ForceTier::Normal`].
    pub tier_cause: String,
    /// The force in newtons that the tiers are compared with; `None` where it is not known.
    pub load: Option<f64>,
    /// Where the tiers begin here, the mildest first.
    pub margins: Shared<Vec<TierMargin>>,
    /// The zero that was taken last, in newtons along x, y, z; `None` where none was.
    pub tare: Option<[f64; 3]>,
}

impl ForceView {
    /// The newest sample, as long as it still holds.
    #[must_use]
    pub fn fresh_sample(&self, now: Stamp) -> Option<&ForceSample> {
        self.samples.last().filter(|_| self.freshness.is_fresh(now))
    }

    /// The next tier up and the newtons that remain until it begins.
    #[must_use]
    pub fn next_margin(&self) -> Option<(ForceTier, f64)> {
        let load = self.load?;
        self.margins.iter().find(|margin| margin.tier > self.tier).map(|margin| (margin.tier, margin.limit - load))
    }
}
