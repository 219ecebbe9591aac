//! The table itself: the cohort dressed over and over, each figure beside the thesis' own.

use super::cohort::{CohortError, EXPERIMENTS, Participant, cohort};
use super::dresser::{DressingRecord, dress};
use crate::body::Side;
use crate::headless::VirtualError;
use rayon::prelude::*;
use serde::Serialize;
use thiserror::Error;

/// Series of five experiments of which the table's rows are the means: 200 experiments of each person.
pub const SERIES: u32 = 40;

/// Why the table could not be made.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum TableError {
    /// A shipped profile is unusable.
    #[error(transparent)]
    Cohort(#[from] CohortError),
    /// An experiment could not be run.
    #[error(transparent)]
    Dressing(#[from] VirtualError),
}

/// One row: a participant's means and sample deviations, with the thesis' means.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct CohortRow {
    /// Always `row`.
    pub event: &'static str,
    /// Always `4.2`.
    pub table: &'static str,
    /// From 1 to 12, as in the thesis.
    pub participant: u32,
    /// Experiments behind the means.
    pub experiments: usize,
    /// Mean iterations until no resistance was left.
    pub iterations_mean: f64,
    /// Their deviation.
    pub iterations_sd: f64,
    /// Mean sum of detected resistance.
    pub energy_newtons_mean: f64,
    /// Its deviation.
    pub energy_newtons_sd: f64,
    /// Mean duration, planning time of the thesis' robot included.
    pub duration_seconds_mean: f64,
    /// Its deviation.
    pub duration_seconds_sd: f64,
    /// Experiments that ended at the most iterations with resistance left, or in which the arm was not dressed.
    pub not_converged: usize,
    /// The thesis' iterations.
    pub thesis_iterations: f64,
    /// The thesis' energy.
    pub thesis_energy_newtons: f64,
    /// The thesis' time.
    pub thesis_duration_seconds: f64,
}

/// All experiments of one participant: `series` times five, each series with its first experiment unfamiliar.
///
/// # Errors
/// Where an experiment cannot be run.
pub fn experiments(participant: &Participant, series: u32, seed: u64) -> Result<Vec<DressingRecord>, VirtualError> {
    (0..series * EXPERIMENTS)
        .into_par_iter()
        .map(|index| {
            // Seeds of two participants or two runs of the table never meet.
            let own = (seed << 24) + (u64::from(participant.number) << 16) + u64::from(index);
            dress(&participant.setup(index % EXPERIMENTS, own), Side::Right)
        })
        .collect()
}

/// The table in the thesis' order of participants.
///
/// # Errors
/// Where a shipped profile is unusable or an experiment cannot be run.
pub fn table(series: u32, seed: u64) -> Result<Vec<CohortRow>, TableError> {
    let people = cohort()?;
    people.iter().map(|participant| Ok(row(participant, &experiments(participant, series, seed)?))).collect()
}

fn row(participant: &Participant, records: &[DressingRecord]) -> CohortRow {
    let iterations = statistics(records.iter().map(|record| record.iterations() as f64));
    let energy = statistics(records.iter().map(DressingRecord::energy_newtons));
    let duration = statistics(records.iter().map(DressingRecord::duration_seconds));
    CohortRow {
        event: "row",
        table: "4.2",
        participant: participant.number,
        experiments: records.len(),
        iterations_mean: iterations.0,
        iterations_sd: iterations.1,
        energy_newtons_mean: energy.0,
        energy_newtons_sd: energy.1,
        duration_seconds_mean: duration.0,
        duration_seconds_sd: duration.1,
        not_converged: records.iter().filter(|record| !record.is_free()).count(),
        thesis_iterations: participant.thesis.iterations,
        thesis_energy_newtons: participant.thesis.energy_newtons,
        thesis_duration_seconds: participant.thesis.seconds,
    }
}

/// Mean and sample deviation; zeros of nothing.
fn statistics(values: impl Iterator<Item = f64> + Clone) -> (f64, f64) {
    let count = values.clone().count() as f64;
    if count < 1.0 {
        return (0.0, 0.0);
    }
    let mean = values.clone().sum::<f64>() / count;
    let squares: f64 = values.map(|value| (value - mean).powi(2)).sum();
    (mean, if count > 1.0 { (squares / (count - 1.0)).sqrt() } else { 0.0 })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_cohort_is_read_and_mirrors_the_thesis_in_order() {
        let numbers: Vec<u32> = cohort().unwrap().iter().map(|participant| participant.number).collect();
        assert_eq!(numbers, (1..=12).collect::<Vec<_>>());
    }

    #[test]
    fn every_experiment_of_a_series_ends_with_falling_resistance_and_the_hard_need_more() {
        let rows = table(1, 7).unwrap();
        assert!(rows.iter().all(|row| row.experiments == 5 && row.iterations_mean <= 8.0));
        let mean = |numbers: [u32; 4]| {
            let chosen = rows.iter().filter(|row| numbers.contains(&row.participant));
            chosen.map(|row| row.energy_newtons_mean).sum::<f64>() / 4.0
        };
        let (hard, easy) = (mean([3, 7, 8, 12]), mean([1, 4, 5, 11]));
        assert!(hard > 1.8 * easy, "{hard} N against {easy} N");
    }

    #[test]
    fn a_seed_repeats_its_table() {
        let people = cohort().unwrap();
        let one = |seed| experiments(&people[0], 1, seed).unwrap();
        assert_eq!(one(3), one(3));
        assert_ne!(one(3), one(4));
    }

    #[test]
    fn statistics_of_nothing_and_of_one_are_no_division_by_nothing() {
        assert_eq!(statistics([].into_iter()), (0.0, 0.0));
        assert_eq!(statistics([3.0].into_iter()), (3.0, 0.0));
        assert_eq!(statistics([1.0, 3.0].into_iter()), (2.0, 2.0_f64.sqrt()));
    }
}
