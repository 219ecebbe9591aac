//! `valet reproduce`: the thesis' tables and figures beside the thesis' own numbers.

use super::exit::Failure;

/// The thesis' tables and figures beside the thesis' own numbers.
#[derive(Debug, Default, clap::Args)]
pub(super) struct Arguments {}

pub(super) fn run(_arguments: &Arguments) -> Result<(), Failure> {
    Err(Failure::Fault("reproduce: not built yet".into()))
}
