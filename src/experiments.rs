//! The thesis' tables and figures, and valet's own, each from a command that anyone can run.
//!
//! Nothing here is used while a trial runs.

pub mod detectors;
pub mod torture;
