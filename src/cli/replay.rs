//! `valet replay`: a recorded trial through the same core.

use super::exit::Failure;

/// A recorded trial through the same core.
#[derive(Debug, Default, clap::Args)]
pub(super) struct Arguments {}

pub(super) fn run(_arguments: &Arguments) -> Result<(), Failure> {
    Err(Failure::Fault("replay: not built yet".into()))
}
