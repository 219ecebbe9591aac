//! `valet report`: recorded trials as pages and plots.

use super::exit::Failure;

/// Recorded trials as pages and plots.
#[derive(Debug, Default, clap::Args)]
pub(super) struct Arguments {}

pub(super) fn run(_arguments: &Arguments) -> Result<(), Failure> {
    Err(Failure::Fault("report: not built yet".into()))
}
