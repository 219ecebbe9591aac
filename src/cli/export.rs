//! `valet export`: a recorded trial as a rosbag or as tables.

use super::exit::Failure;
use super::key::KeyArguments;
use super::output::Output;
use crate::record::{JournalFile, Reading, write_bag, write_csv};
use serde::Serialize;
use std::path::PathBuf;

/// A recorded trial as a rosbag or CSV files.
#[derive(Debug, clap::Args)]
pub(super) struct Arguments {
    /// The journal (`*.mcap`).
    trial: PathBuf,
    /// `bag` (rosbag 2.0, one file) or `csv` (a folder of tables).
    #[arg(long, value_enum, default_value_t = Format::Bag)]
    format: Format,
    /// The file or folder to write; beside the trial where it is not given.
    #[arg(long, value_name = "PATH")]
    out: Option<PathBuf>,
    /// Leave out free text and absolute time.
    #[arg(long)]
    anonymous: bool,
    #[command(flatten)]
    key: KeyArguments,
    /// Print one JSON object a line.
    #[arg(long)]
    json: bool,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
enum Format {
    Bag,
    Csv,
}

#[derive(Serialize)]
struct Exported {
    event: &'static str,
    out: PathBuf,
    steps: u64,
    problems: Vec<String>,
}

pub(super) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let mut output = Output::new(arguments.json);
    let journal = JournalFile::new(&arguments.trial, arguments.key.given()?);
    let ending = match arguments.format {
        Format::Bag => "bag",
        Format::Csv => "csv",
    };
    let beside = arguments.trial.with_file_name(format!("{}.{ending}", journal.name()));
    let out = arguments.out.clone().unwrap_or(beside);
    let reading: Reading = match arguments.format {
        Format::Bag => write_bag(&journal, &out, arguments.anonymous),
        Format::Csv => write_csv(&journal, &out, arguments.anonymous),
    }
    .map_err(Failure::configuration)?;
    for problem in &reading.problems {
        output.line(format!("not readable and left out: {problem}"))?;
    }
    output.line(format!("{} steps written to {}", reading.steps, out.display()))?;
    let problems = reading.problems.iter().map(ToString::to_string).collect();
    output.event(&Exported { event: "export", out, steps: reading.steps, problems })
}
