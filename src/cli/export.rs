//! `valet export`: a recorded trial as a rosbag or CSV files.

use super::exit::Failure;

/// A recorded trial as a rosbag or CSV files.
#[derive(Debug, Default, clap::Args)]
pub(super) struct Arguments {}

pub(super) fn run(_arguments: &Arguments) -> Result<(), Failure> {
    Err(Failure::Fault("export: not built yet".into()))
}
