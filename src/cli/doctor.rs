//! `valet doctor`: the checklist before a trial: each line with age, value and what to do.

use super::exit::Failure;

/// The checklist before a trial: each line with age, value and what to do.
#[derive(Debug, Default, clap::Args)]
pub(super) struct Arguments {}

pub(super) fn run(_arguments: &Arguments) -> Result<(), Failure> {
    Err(Failure::Fault("doctor: not built yet".into()))
}
