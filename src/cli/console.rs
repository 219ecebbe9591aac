//! `valet console`: the operator console on a ROS graph.

use super::exit::Failure;

/// The operator console on a ROS graph.
#[derive(Debug, Default, clap::Args)]
pub(super) struct Arguments {}

pub(super) fn run(_arguments: &Arguments) -> Result<(), Failure> {
    Err(Failure::Fault("console: not built yet".into()))
}
