//! Force and freshness: what the robot's numbers mean, whether they still hold, and whether they show resistance.
//!
//! Pure: time comes in as [`crate::time::Stamp`], forces as newtons. Nothing here decides what the robot does next; that
//! is the task of the safety and strategy rooms.

mod bias;
mod conversion;
mod freshness;
mod inertia;
mod two_rate;
mod window;

pub use bias::{BiasSettings, BiasTracker, Tare, TareError};
pub use conversion::{ForceAxes, ForceSign, WrenchConversion};
pub use freshness::{Freshness, FreshnessSettings};
pub use inertia::InertiaCompensation;
pub use two_rate::{TwoRate, TwoRateReading, TwoRateSettings};
pub use window::{BreakCause, Detection, ForceWindow, SensingError, WindowForm, WindowReading, WindowSettings};
