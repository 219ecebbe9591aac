//! `valet train`: trains a person's decision tree, or the generic forest, from depth images.

use super::exit::Failure;

/// Trains a person's decision tree, or the generic forest, from depth images.
#[derive(Debug, Default, clap::Args)]
pub(super) struct Arguments {}

pub(super) fn run(_arguments: &Arguments) -> Result<(), Failure> {
    Err(Failure::Fault("train: not built yet".into()))
}
