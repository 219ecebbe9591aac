//! A trial without a screen: an operator that follows a fixed script, and lines or JSON in place of a console.
//!
//! The same supervisor as everywhere. In virtual time it is joined to the simulator in one process: no sockets, no
//! sleeping, no clock, so a seed repeats a trial byte for byte.

pub mod operator;
pub mod report;
pub mod typed;
pub mod virtual_time;

pub use operator::ScriptedOperator;
pub use report::{Report, TrialResult};
pub use typed::{NoCommand, Typed};
pub use virtual_time::{VirtualError, VirtualTrial};
