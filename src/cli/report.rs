//! `valet report`: recorded trials as pages and plots.

use super::exit::Failure;
use super::key::KeyArguments;
use super::output::Output;
use crate::record::JournalFile;
use crate::report::trial::{Answers, TrialRecord, compare, write};
use serde::Serialize;
use std::path::{Path, PathBuf};

/// Recorded trials as self-contained HTML pages with SVG and PNG plots.
#[derive(Debug, Default, clap::Args)]
pub(super) struct Arguments {
    /// The journals (`*.mcap`).
    #[arg(required_unless_present = "print_answers")]
    trials: Vec<PathBuf>,
    /// The folder to write into.
    #[arg(long, value_name = "DIR", required_unless_present = "print_answers")]
    out: Option<PathBuf>,
    /// The answers to the questionnaires of one trial; without it they are looked for beside each trial, in
    /// `NAME.answers.toml`.
    #[arg(long, value_name = "FILE")]
    answers: Option<PathBuf>,
    /// Print a file of answers to be filled in, and do nothing else.
    #[arg(long, exclusive = true)]
    print_answers: bool,
    #[command(flatten)]
    key: KeyArguments,
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

/// The answers that were named, or those beside the journal, where there are any.
fn answers_of(journal: &JournalFile, named: Option<&Path>) -> Result<Answers, Failure> {
    let beside = Answers::place(journal.path(), &journal.name());
    match named {
        Some(file) => Answers::read(file),
        None if beside.is_file() => Answers::read(&beside),
        None => Ok(Answers::default()),
    }
    .map_err(Failure::configuration)
}

pub(super) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let mut output = Output::new(arguments.json);
    if arguments.print_answers {
        return output.line(Answers::blank().trim_end());
    }
    if arguments.answers.is_some() && arguments.trials.len() > 1 {
        let reason = "--answers belongs to one trial: put NAME.answers.toml beside each of several";
        return Err(Failure::Configuration(reason.into()));
    }
    // The command line does not allow it to be missing here.
    let out = arguments.out.as_deref().unwrap_or(Path::new("."));
    let key = arguments.key.given()?;
    let mut written = |page: PathBuf| {
        output.line(format!("written: {}", page.display()))?;
        output.event(&Written { event: "report", page })
    };
    let mut trials = Vec::with_capacity(arguments.trials.len());
    for path in &arguments.trials {
        let journal = JournalFile::new(path, key.clone());
        let mut trial = TrialRecord::gather(&journal).map_err(Failure::configuration)?;
        trial.answers = answers_of(&journal, arguments.answers.as_deref())?;
        name_apart(&mut trial, &trials);
        written(write(&trial, out).map_err(Failure::fault)?)?;
        trials.push(trial);
    }
    if trials.len() > 1 {
        written(compare(&trials, out).map_err(Failure::fault)?)?;
    }
    Ok(())
}
