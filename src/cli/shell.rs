//! `valet shell`: man page and shell completions, for packagers.

use super::exit::Failure;

/// Man page and shell completions, for packagers.
#[derive(Debug, Default, clap::Args)]
pub(super) struct Arguments {}

pub(super) fn run(_arguments: &Arguments) -> Result<(), Failure> {
    Err(Failure::Fault("shell: not built yet".into()))
}
