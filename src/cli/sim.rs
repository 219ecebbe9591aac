//! `valet sim`: the simulated Baxter, person and camera as a ROS node.

use super::exit::Failure;

/// The simulated Baxter, person and camera as a ROS node.
#[derive(Debug, Default, clap::Args)]
pub(super) struct Arguments {}

pub(super) fn run(_arguments: &Arguments) -> Result<(), Failure> {
    Err(Failure::Fault("sim: not built yet".into()))
}
