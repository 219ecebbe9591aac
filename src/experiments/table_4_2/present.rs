//! The cohort's results as rows, figures and words for `valet reproduce`.

use super::cohort::cohort;
use super::dresser::{DressingRecord, PassRecord};
use super::example;
use super::run::{CohortRow, SERIES, experiments, table};
use crate::experiments::findings::{Drawing, ExperimentError, Findings, Row};
use crate::report::plot::{Axis, Figure, Layer, Plot};

pub(super) fn other(error: impl std::fmt::Display) -> ExperimentError {
    ExperimentError::Other(error.to_string())
}

/// Table 4.2: means of 200 experiments of each person beside the thesis' means of five, with figures 4.6 and 4.7 and the
/// worked example of figures 4.9 to 4.15.
///
/// # Errors
/// Where a shipped profile is unusable or an experiment cannot be run.
pub fn run(seed: u64) -> Result<Findings, ExperimentError> {
    let rows = table(SERIES, seed).map_err(other)?;
    let mut findings = Findings { rows: rows.iter().map(as_row).collect(), ..Findings::default() };
    findings.remarks.push(
        "Each simulated person was calibrated to one row of the thesis' table, so agreement says that the simulator can be such \
         people, not that the method helps real ones. Durations add the planning time of the thesis' robot to each \
         resistance. Each experiment is a trial of the node in virtual time, as `valet demo --headless` runs it."
            .into(),
    );
    findings.drawings.push(beside_the_thesis(&rows));
    let records = sixty(seed)?;
    findings.drawings.push(boxes(&records, &ENERGY).1);
    findings.drawings.push(boxes(&records, &DURATION).1);
    findings.drawings.extend(example::drawings(&records)?);
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

/// Simulated means with their deviations, and the thesis' means, by participant.
fn beside_the_thesis(rows: &[CohortRow]) -> Drawing {
    let panel = |label: &str, simulated: &dyn Fn(&CohortRow) -> [f64; 2], thesis: &dyn Fn(&CohortRow) -> f64| {
        let at = |row: &CohortRow| f64::from(row.participant);
        let bars = rows.iter().map(|row| {
            let [mean, deviation] = simulated(row);
            [at(row), mean, deviation]
        });
        Plot::new("", Axis::new("participant"), Axis::new(label).including(0.0))
            .with(Layer::bars("simulated, mean and deviation of 200", 0.6, bars))
            .with(Layer::scatter("thesis, mean of 5", rows.iter().map(|row| [at(row), thesis(row)])))
    };
    let panels = [
        panel("iterations", &|row| [row.iterations_mean, row.iterations_sd], &|row| row.thesis_iterations),
        panel("energy (N)", &|row| [row.energy_newtons_mean, row.energy_newtons_sd], &|row| row.thesis_energy_newtons),
        panel("duration (s)", &|row| [row.duration_seconds_mean, row.duration_seconds_sd], &|row| {
            row.thesis_duration_seconds
        }),
    ];
    Drawing {
        stem: "table-4.2".into(),
        figure: Figure::grid("", 1, panels).panel_size(720, 300),
        caption:
            "Twelve simulated people, 200 experiments each on seeds that the calibration had not seen, beside the \
                  thesis' means of five experiments."
                .into(),
    }
}

/// What is plotted over the iterations.
struct Quantity {
    number: &'static str,
    name: &'static str,
    label: &'static str,
    of: fn(&PassRecord) -> f64,
}

const ENERGY: Quantity =
    Quantity { number: "4.6", name: "energy_newtons", label: "energy (N)", of: |pass| pass.summary.energy };
const DURATION: Quantity =
    Quantity { number: "4.7", name: "duration_seconds", label: "execution time (s)", of: PassRecord::duration_seconds };

/// The energy of each iteration over the thesis' 60 experiments.
///
/// # Errors
/// Where a shipped profile is unusable or an experiment cannot be run.
pub fn energy_by_iteration(seed: u64) -> Result<Findings, ExperimentError> {
    by_iteration(seed, &ENERGY)
}

/// The execution time of each iteration over the thesis' 60 experiments.
///
/// # Errors
/// Where a shipped profile is unusable or an experiment cannot be run.
pub fn duration_by_iteration(seed: u64) -> Result<Findings, ExperimentError> {
    by_iteration(seed, &DURATION)
}

/// Five experiments of each of the twelve.
pub(super) fn sixty(seed: u64) -> Result<Vec<DressingRecord>, ExperimentError> {
    let mut records = Vec::new();
    for participant in cohort().map_err(other)? {
        records.extend(experiments(&participant, 1, seed).map_err(other)?);
    }
    Ok(records)
}

fn by_iteration(seed: u64, quantity: &Quantity) -> Result<Findings, ExperimentError> {
    let (rows, drawing) = boxes(&sixty(seed)?, quantity);
    Ok(Findings { rows, drawings: vec![drawing], ..Findings::default() })
}

fn boxes(records: &[DressingRecord], quantity: &Quantity) -> (Vec<Row>, Drawing) {
    let Quantity { number, name, label, of } = quantity;
    let longest = records.iter().map(DressingRecord::iterations).max().unwrap_or_default();
    let (mut rows, mut boxes) = (Vec::new(), Vec::new());
    for index in 0..longest {
        let values: Vec<f64> = records.iter().filter_map(|record| record.passes.get(index).map(of)).collect();
        let row = Row::of(number).with("iteration", index + 1).with("experiments", values.len());
        let median = median(values.clone());
        rows.push(row.with_statistics(name, values.iter().copied()).with(format!("{name}_median"), median));
        boxes.push(((index + 1) as f64, values));
    }
    let plot = Plot::new("", Axis::new("iteration"), Axis::new(*label).including(0.0));
    let drawing = Drawing {
        stem: format!("figure-{number}"),
        figure: Figure::single(plot.with(Layer::boxes(*name, 0.5, boxes))),
        caption: format!(
            "{label} by iteration, 60 experiments of twelve simulated people; only those still under way count"
        ),
    };
    (rows, drawing)
}

/// The middle value, the mean of the two middle ones of an even number; 0 of none.
fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    let middle = |index: usize| values.get(index).copied().unwrap_or_default();
    let count = values.len();
    if count.is_multiple_of(2) {
        f64::midpoint(middle((count / 2).saturating_sub(1)), middle(count / 2))
    } else {
        middle(count / 2)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn medians_of_odd_even_and_no_values() {
        let medians = [vec![3.0, 1.0, 2.0], vec![4.0, 1.0, 2.0, 3.0], vec![]].map(median);
        let away = medians.iter().zip([2.0, 2.5, 0.0]).map(|(median, wanted)| (median - wanted).abs());
        assert!(away.sum::<f64>() < 1e-12, "{medians:?}");
    }

    #[test]
    fn energy_falls_over_the_iterations_and_both_figures_are_drawn() {
        let records = sixty(3).unwrap();
        let ((rows, energy), (_, duration)) = (boxes(&records, &ENERGY), boxes(&records, &DURATION));
        let medians: Vec<f64> = rows.iter().map(|row| row.number("energy_newtons_median")).collect();
        assert!(medians.len() >= 3 && medians[0] > medians[1] && medians[1] >= medians[2], "{medians:?}");
        assert_eq!([energy.stem, duration.stem], ["figure-4.6", "figure-4.7"]);
    }
}
