//! `valet bench`: speeds that matter to a user.

use super::exit::Failure;

/// Speeds that matter to a user.
#[derive(Debug, Default, clap::Args)]
pub(super) struct Arguments {}

pub(super) fn run(_arguments: &Arguments) -> Result<(), Failure> {
    Err(Failure::Fault("bench: not built yet".into()))
}
