//! `valet config`: the configuration: print the default one, check a file.

use super::exit::Failure;

/// The configuration: print the default one, check a file.
#[derive(Debug, Default, clap::Args)]
pub(super) struct Arguments {}

pub(super) fn run(_arguments: &Arguments) -> Result<(), Failure> {
    Err(Failure::Fault("config: not built yet".into()))
}
