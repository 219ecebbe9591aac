//! The cohort's results as rows, figures and words for `valet reproduce`.

use super::cohort::cohort;
use super::dresser::DressingRecord;
use super::run::{CohortRow, SERIES, experiments, table};
use crate::experiments::findings::{Drawing, ExperimentError, Findings, Row};
use crate::report::plot::{Axis, Figure, Layer, Plot};

/// Table 4.2: means of 200 experiments of each person beside the thesis' means of five.
///
/// # Errors
/// Where a shipped profile is unusable or an experiment cannot be run.
pub fn run(seed: u64) -> Result<Findings, ExperimentError> {
    let rows = table(SERIES, seed).map_err(|error| ExperimentError::Other(error.to_string()))?;
    let mut findings = Findings { rows: rows.iter().map(as_row).collect(), ..Findings::default() };
    findings.remarks.push(
        "The people are simulated and were calibrated to this very table: agreement shows that the simulator can be such \
         people, not that the method helps real ones. Durations add the planning time of the thesis' robot to each \
         resistance. The gripper moves without a robot's joints, at the same speeds."
            .into(),
    );
    Ok(findings)
}

fn as_row(row: &CohortRow) -> Row {
    Row::of(row.table)
        .with("participant", row.participant)
        .with("experiments", row.experiments)
        .with("iterations_mean", row.iterations_mean)
        .with("iterations_sd", row.iterations_sd)
        .with("energy_newtons_mean", row.energy_newtons_mean)
        .with("energy_newtons_sd", row.energy_newtons_sd)
        .with("duration_seconds_mean", row.duration_seconds_mean)
        .with("duration_seconds_sd", row.duration_seconds_sd)
        .with("not_converged", row.not_converged)
        .with("thesis_iterations", row.thesis_iterations)
        .with("thesis_energy_newtons", row.thesis_energy_newtons)
        .with("thesis_duration_seconds", row.thesis_duration_seconds)
}

/// The energy of each iteration over the thesis' 60 experiments.
///
/// # Errors
/// Where a shipped profile is unusable or an experiment cannot be run.
pub fn energy_by_iteration(seed: u64) -> Result<Findings, ExperimentError> {
    by_iteration(seed, "4.6", ("energy", "energy in newtons"), |record, index| {
        record.passes.get(index).map(|pass| pass.summary.energy)
    })
}

/// The resistances of each iteration over the thesis' 60 experiments.
///
/// # Errors
/// Where a shipped profile is unusable or an experiment cannot be run.
pub fn contacts_by_iteration(seed: u64) -> Result<Findings, ExperimentError> {
    by_iteration(seed, "4.7", ("resistances", "resistances"), |record, index| {
        record.passes.get(index).map(|pass| f64::from(pass.summary.contacts))
    })
}

fn by_iteration(
    seed: u64,
    number: &str,
    (name, label): (&str, &str),
    value: impl Fn(&DressingRecord, usize) -> Option<f64>,
) -> Result<Findings, ExperimentError> {
    let other = |error: String| ExperimentError::Other(error);
    let mut records = Vec::new();
    for participant in cohort().map_err(|error| other(error.to_string()))? {
        records.extend(experiments(&participant, 1, seed).map_err(|error| other(error.to_string()))?);
    }
    let longest = records.iter().map(DressingRecord::iterations).max().unwrap_or_default();
    let mut findings = Findings::default();
    let mut boxes = Vec::new();
    for index in 0..longest {
        let values: Vec<f64> = records.iter().filter_map(|record| value(record, index)).collect();
        let row = Row::of(number).with("iteration", index + 1).with("experiments", values.len());
        findings.rows.push(row.with_statistics(name, values.iter().copied()));
        boxes.push(((index + 1) as f64, values));
    }
    let plot = Plot::new("", Axis::new("iteration"), Axis::new(label).including(0.0));
    findings.drawings.push(Drawing {
        stem: format!("figure-{number}"),
        figure: Figure::single(plot.with(Layer::boxes(name, 0.5, boxes))),
        caption: format!(
            "{label} by iteration, 60 experiments of twelve simulated people; only those still under way count"
        ),
    });
    Ok(findings)
}
