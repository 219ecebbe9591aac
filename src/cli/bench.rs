//! `valet bench`: speeds that matter to a user, measured on this machine.

mod console;
mod ik;
mod motion;
mod pose;

use super::exit::Failure;

/// Speeds that matter to a user.
#[derive(Debug, clap::Args)]
pub(super) struct Arguments {
    #[command(subcommand)]
    bench: Bench,
}

#[derive(Debug, clap::Subcommand)]
enum Bench {
    Console(console::Arguments),
    Ik(ik::Arguments),
    Motion(motion::Arguments),
    Pose(pose::Arguments),
}

pub(super) fn run(arguments: &Arguments) -> Result<(), Failure> {
    match &arguments.bench {
        Bench::Console(arguments) => console::run(arguments),
        Bench::Ik(arguments) => ik::run(arguments),
        Bench::Motion(arguments) => motion::run(arguments),
        Bench::Pose(arguments) => pose::run(arguments),
    }
}
