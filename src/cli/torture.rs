//! `valet torture`: simulated trials with faults, in virtual time, with every invariant checked.

use super::exit::Failure;
use super::output::Output;
use crate::experiments::torture::{TortureResult, torture};
use rayon::prelude::*;
use serde::Serialize;
use std::time::{Duration, Instant};

/// Trials that are started together: enough that no core waits, few enough that the time limit is kept.
const BATCH: u64 = 64;

/// Simulated trials with faults, in virtual time, with every invariant checked.
#[derive(Debug, Default, clap::Args)]
pub(super) struct Arguments {
    /// Stop after so many minutes of real time.
    #[arg(long, value_name = "N", value_parser = minutes)]
    minutes: Option<f64>,
    /// Stop after so many trials. Without --minutes and --trials: 1000 trials.
    #[arg(long, value_name = "N")]
    trials: Option<u64>,
    /// Seed of the first trial; the others follow. A failing seed is repeated by `--seed SEED --trials 1`.
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Print one JSON object a line.
    #[arg(long)]
    json: bool,
}

fn minutes(text: &str) -> Result<f64, String> {
    let value: f64 = text.parse().map_err(|_| format!("{text} is no number"))?;
    if (0.0..=100_000.0).contains(&value) { Ok(value) } else { Err(format!("{text} is not from 0 to 100000")) }
}

/// What came of all trials together.
#[derive(Debug, Default, Serialize)]
struct Summary {
    event: &'static str,
    trials: u64,
    violations: u64,
    first_seed: u64,
    virtual_seconds: f64,
    steps: u64,
    setpoints: u64,
    refused: u64,
    stops: u64,
    iterations: u64,
    completed: u64,
    wall_seconds: f64,
}

impl Summary {
    fn add(&mut self, result: &TortureResult) {
        self.trials += 1;
        self.violations += u64::from(result.violation.is_some());
        self.virtual_seconds += result.seconds;
        self.steps += result.steps;
        self.setpoints += result.setpoints;
        self.refused += result.refused;
        self.stops += u64::from(result.stops);
        self.iterations += u64::from(result.iterations);
        self.completed += u64::from(result.outcome == Some(crate::snapshot::Outcome::Completed));
    }
}

pub(super) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let mut output = Output::new(arguments.json);
    let begun = Instant::now();
    let limit = arguments.minutes.map(|minutes| Duration::from_secs_f64(minutes * 60.0));
    let most = arguments.trials.unwrap_or(if limit.is_some() { u64::MAX } else { 1000 });
    let mut summary = Summary { event: "torture", first_seed: arguments.seed, ..Summary::default() };
    while summary.trials < most && limit.is_none_or(|limit| begun.elapsed() < limit) {
        let first = arguments.seed.saturating_add(summary.trials);
        let count = BATCH.min(most - summary.trials);
        let results: Vec<_> = (first..first.saturating_add(count)).into_par_iter().map(torture).collect();
        for result in &results {
            summary.add(result);
            tell(&mut output, result)?;
        }
        if results.is_empty() {
            break;
        }
    }
    summary.wall_seconds = begun.elapsed().as_secs_f64();
    close(&mut output, &summary)
}

/// Tells of a broken invariant and of how to repeat it.
fn tell(output: &mut Output, result: &TortureResult) -> Result<(), Failure> {
    let Some(violation) = &result.violation else { return Ok(()) };
    output.event(&serde_json::json!({ "event": "violation", "seed": result.seed, "violation": violation }))?;
    output.line(format!(
        "seed {}: {:?} at {:.2} s: {} (repeat: valet torture --seed {} --trials 1)",
        result.seed, violation.invariant, violation.at_seconds, violation.text, result.seed
    ))
}

fn close(output: &mut Output, summary: &Summary) -> Result<(), Failure> {
    output.line(format!(
        "{} trials, {} with a broken invariant; {:.0} s of virtual time, {} stops, {} passes, {} trials completed, in {:.1} s",
        summary.trials,
        summary.violations,
        summary.virtual_seconds,
        summary.stops,
        summary.iterations,
        summary.completed,
        summary.wall_seconds
    ))?;
    output.event(summary)?;
    match summary.violations {
        0 => Ok(()),
        count => Err(Failure::Fault(format!("{count} of {} trials broke an invariant", summary.trials))),
    }
}
