//! `valet keys`: the table of keys.

use super::exit::Failure;

/// The table of keys.
#[derive(Debug, Default, clap::Args)]
pub(super) struct Arguments {}

pub(super) fn run(_arguments: &Arguments) -> Result<(), Failure> {
    Err(Failure::Fault("keys: not built yet".into()))
}
