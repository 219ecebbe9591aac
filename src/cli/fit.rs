//! `valet fit`: fits a person's movement space from recorded joints.

use super::exit::Failure;

/// Fits a person's movement space from recorded joints.
#[derive(Debug, Default, clap::Args)]
pub(super) struct Arguments {}

pub(super) fn run(_arguments: &Arguments) -> Result<(), Failure> {
    Err(Failure::Fault("fit: not built yet".into()))
}
