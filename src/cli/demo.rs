//! `valet demo`: the whole thing with a simulated robot and person (the default).

use super::exit::Failure;

/// The whole thing with a simulated robot and person (the default).
#[derive(Debug, Default, clap::Args)]
pub(super) struct Arguments {}

pub(super) fn run(_arguments: &Arguments) -> Result<(), Failure> {
    Err(Failure::Fault("demo: not built yet".into()))
}
