//! The command line: what may be typed, and which command does it.
//!
//! Each command lives in a file of its own under `cli/` with its arguments and one `run` function. Nothing here decides
//! anything about a robot. ROS arguments (`name:=value`) are taken out before the rest is read: the node reads them itself.

pub mod exit;
pub mod output;
mod planning;

mod anew;
mod bench;
mod config;
mod console;
mod demo;
mod doctor;
mod export;
mod eyes;
mod faults;
mod fit;
mod images;
mod key;
mod keys;
mod label;
mod log;
mod profile;
mod recorded_pose;
mod recording;
mod replay;
mod report;
mod reproduce;
mod screen;
mod session;
mod shell;
mod sim;
mod sim_images;
mod torture;
mod train;
mod watch;

use clap::{Parser, Subcommand};
use exit::Failure;
use std::process::ExitCode;

/// Robot-assisted dressing trials on a Baxter: node, operator console and simulator.
///
/// Without a command, valet opens the console on a simulated robot and person (the same as `valet demo`).
/// ROS arguments (`__name:=`, `_parameter:=`, `from:=to`) are accepted by every command that makes a node.
#[derive(Debug, Parser)]
#[command(name = "valet", version, propagate_version = true, after_help = exit::HELP)]
pub struct CommandLine {
    #[command(subcommand)]
    command: Option<Command>,
}

#[derive(Debug, Subcommand)]
enum Command {
    Demo(demo::Arguments),
    Console(console::Arguments),
    Sim(sim::Arguments),
    Doctor(doctor::Arguments),
    Fit(fit::Arguments),
    Train(train::Arguments),
    Label(label::Arguments),
    Reproduce(reproduce::Arguments),
    Torture(torture::Arguments),
    Bench(bench::Arguments),
    Replay(replay::Arguments),
    Report(report::Arguments),
    Export(export::Arguments),
    Profile(profile::Arguments),
    Config(config::Arguments),
    Keys(keys::Arguments),
    #[command(hide = true)]
    Shell(shell::Arguments),
}

/// Reads the process' arguments, runs the command and reports a failure in words.
#[must_use]
pub fn main() -> ExitCode {
    let typed = without_ros_arguments(std::env::args());
    let line = match CommandLine::try_parse_from(typed) {
        Ok(line) => line,
        Err(error) => {
            // Nothing sensible can be done where even this cannot be printed.
            let _ = error.print();
            return if error.use_stderr() { ExitCode::from(exit::BAD_ARGUMENTS) } else { ExitCode::SUCCESS };
        }
    };
    match run(line) {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            output::complain(&failure);
            failure.code()
        }
    }
}

fn run(line: CommandLine) -> Result<(), Failure> {
    match line.command.unwrap_or_else(|| Command::Demo(demo::Arguments::default())) {
        Command::Demo(arguments) => demo::run(&arguments),
        Command::Console(arguments) => console::run(&arguments),
        Command::Sim(arguments) => sim::run(&arguments),
        Command::Doctor(arguments) => doctor::run(&arguments),
        Command::Fit(arguments) => fit::run(&arguments),
        Command::Train(arguments) => train::run(&arguments),
        Command::Label(arguments) => label::run(&arguments),
        Command::Reproduce(arguments) => reproduce::run(&arguments),
        Command::Torture(arguments) => torture::run(&arguments),
        Command::Bench(arguments) => bench::run(&arguments),
        Command::Replay(arguments) => replay::run(&arguments),
        Command::Report(arguments) => report::run(&arguments),
        Command::Export(arguments) => export::run(&arguments),
        Command::Profile(arguments) => profile::run(&arguments),
        Command::Config(arguments) => config::run(&arguments),
        Command::Keys(arguments) => keys::run(&arguments),
        Command::Shell(arguments) => shell::run(&arguments),
    }
}

/// The arguments without those that are meant for ROS (`from:=to`, `__name:=`, `_parameter:=`).
fn without_ros_arguments(typed: impl Iterator<Item = String>) -> impl Iterator<Item = String> {
    typed.filter(|argument| !argument.contains(":="))
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::CommandFactory;

    #[test]
    fn the_command_line_is_consistent() {
        CommandLine::command().debug_assert();
    }

    #[test]
    fn ros_arguments_are_left_to_the_node() {
        let typed = ["valet", "sim", "__name:=robot", "_rate:=30", "/a:=/b", "--seed", "3"].map(String::from);
        let kept: Vec<_> = without_ros_arguments(typed.into_iter()).collect();
        assert_eq!(kept, ["valet", "sim", "--seed", "3"]);
    }
}
