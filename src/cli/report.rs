//! `valet report`: recorded trials as pages and plots.

use super::exit::Failure;
use super::output::Output;
use crate::report::trial::{TrialRecord, compare, write};
use serde::Serialize;
use std::path::PathBuf;

/// Recorded trials as self-contained HTML pages with SVG and PNG plots.
#[derive(Debug, Default, clap::Args)]
pub(super) struct Arguments {
    /// The journals (`*.mcap`).
    #[arg(required = true)]
    trials: Vec<PathBuf>,
    /// The folder to write into.
    #[arg(long, value_name = "DIR")]
    out: PathBuf,
    /// Print one JSON object a line.
    #[arg(long)]
    json: bool,
}

#[derive(Serialize)]
struct Written {
    event: &'static str,
    page: PathBuf,
}

/// Trials of several folders may bear the same name: each keeps a page of its own.
fn name_apart(trial: &mut TrialRecord, others: &[TrialRecord]) {
    let taken = |name: &str| others.iter().any(|other| other.name == name);
    let (first, mut number) = (trial.name.clone(), 1);
    while taken(&trial.name) {
        number += 1;
        trial.name = format!("{first}-{number}");
    }
}

pub(super) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let mut output = Output::new(arguments.json);
    let mut written = |page: PathBuf| {
        output.line(format!("written: {}", page.display()))?;
        output.event(&Written { event: "report", page })
    };
    let mut trials = Vec::with_capacity(arguments.trials.len());
    for path in &arguments.trials {
        let mut trial = TrialRecord::gather(path).map_err(Failure::configuration)?;
        name_apart(&mut trial, &trials);
        written(write(&trial, &arguments.out).map_err(Failure::fault)?)?;
        trials.push(trial);
    }
    if trials.len() > 1 {
        written(compare(&trials, &arguments.out).map_err(Failure::fault)?)?;
    }
    Ok(())
}
