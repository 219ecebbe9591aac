//! `valet profile`: a person's profile: check, show, encrypt, forget.

use super::exit::Failure;

/// A person's profile: check, show, encrypt, forget.
#[derive(Debug, Default, clap::Args)]
pub(super) struct Arguments {}

pub(super) fn run(_arguments: &Arguments) -> Result<(), Failure> {
    Err(Failure::Fault("profile: not built yet".into()))
}
