//! What may not happen, whatever the strategy wants: force tiers, watchdogs, and the latch of the stop.
//!
//! Pure and always on. Each part judges and answers with a [`Verdict`]; of several the strictest counts. Nothing here
//! moves anything, and nothing here is safety-rated: `docs/safety.md` says what is claimed and what is not.

mod force;
mod latch;
mod verdict;
mod watchdog;

pub use force::{
    CatchLimits, ExpectedPull, ForceGuard, GuardError, GuardSample, GuardSettings, HARD_CAP_NEWTONS, Tiers, Zone,
};
pub use latch::{StopPhase, StopRefusal, StopState};
pub use verdict::{Reaction, Verdict};
pub use watchdog::{Watch, WatchSettings, Watchdogs};
