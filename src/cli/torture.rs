//! `valet torture`: simulated trials with faults, in virtual time, with every invariant checked.

use super::exit::Failure;

/// Simulated trials with faults, in virtual time, with every invariant checked.
#[derive(Debug, Default, clap::Args)]
pub(super) struct Arguments {}

pub(super) fn run(_arguments: &Arguments) -> Result<(), Failure> {
    Err(Failure::Fault("torture: not built yet".into()))
}
