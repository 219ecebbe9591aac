//! How often the unsupervised fit finds the right number of Gaussians in fresh mixtures, and how long it takes.
//!
//! Mixtures of 1 to 4 components a few centimetres wide whose means lie well apart, as the reaches of a joint might; nothing of a
//! person is in them. Times are those of one core and belong to the machine.

use super::findings::{ExperimentError, Findings, Row};
use crate::geometry::Vector;
use crate::modelling::{FitSettings, Mixture, MixtureError, SplitMix64, fit};
use nalgebra::{Matrix3, Rotation3};
use rayon::prelude::*;
use std::time::Instant;

/// Fresh mixtures.
const SETS: u64 = 200;
/// Points drawn from each.
const POINTS: usize = 2_000;
/// Most components of a mixture, and of the fit.
const MOST: usize = 4;
const MOST_FITTED: usize = 10;
/// Standard deviations along a component's axes, in metres.
const DEVIATIONS: (f64, f64) = (0.02, 0.08);
/// Means lie apart by at least this many of the largest standard deviations of both.
const SEPARATION: f64 = 4.0;
/// Points and repetitions of the timed fit and of the timed density.
const TIMED_POINTS: usize = 5_000;
const TIMED_DENSITIES: usize = 10_000;
const REPETITIONS: u64 = 9;

/// Runs it.
///
/// # Errors
/// Where a drawn mixture is none, or a fit is refused.
pub fn run(seed: u64) -> Result<Findings, ExperimentError> {
    let settings = FitSettings { most_components: MOST_FITTED, ..FitSettings::default() };
    let one = |set: u64| {
        let mut random = SplitMix64::new(seed.wrapping_mul(0x9E37_79B9).wrapping_add(set));
        let truth = draw(&mut random, 1 + random_below(set))?;
        let points: Vec<Vector> = (0..POINTS).map(|_| truth.sample(&mut random)).collect();
        let found = fit(&points, &settings, set).map_err(|error| ExperimentError::Other(error.to_string()))?;
        Ok((truth.components().len(), found.mixture.components().len()))
    };
    let counts: Vec<(usize, usize)> = (0..SETS).into_par_iter().map(one).collect::<Result<_, ExperimentError>>()?;
    let mut rows: Vec<Row> = (1..=MOST).map(|count| count_row(&counts, Some(count))).collect();
    rows.push(count_row(&counts, None));
    rows.push(speed_row(&settings, seed)?);
    Ok(Findings { rows, ..Findings::default() })
}

/// Every number of components equally often.
#[expect(clippy::cast_possible_truncation, reason = "below 4")]
const fn random_below(set: u64) -> usize {
    (set % MOST as u64) as usize
}

fn count_row(counts: &[(usize, usize)], components: Option<usize>) -> Row {
    let of_this = || counts.iter().filter(move |(truth, _)| components.is_none_or(|wanted| *truth == wanted));
    let right = of_this().filter(|(truth, found)| truth == found).count();
    Row::of("mixtures")
        .with("components", components.map_or("all".to_owned(), |count| count.to_string()))
        .with("sets", of_this().count())
        .with("right", right)
        .with("right_share", right as f64 / of_this().count().max(1) as f64)
}

/// A mixture of components that lie well apart, in the space before a seated person.
fn draw(random: &mut SplitMix64, count: usize) -> Result<Mixture, MixtureError> {
    let mut parts: Vec<(f64, Vector, Matrix3<f64>)> = Vec::with_capacity(count);
    let mut widest: Vec<f64> = Vec::with_capacity(count);
    let between = |random: &mut SplitMix64, low: f64, high: f64| low + (high - low) * random.uniform();
    while parts.len() < count {
        let deviations = Vector::from_fn(|_, _| between(random, DEVIATIONS.0, DEVIATIONS.1));
        let mean = Vector::from_fn(|_, _| between(random, -0.6, 0.6));
        let [roll, pitch, yaw] = [0; 3].map(|_| between(random, -3.0, 3.0));
        let turn = Rotation3::from_euler_angles(roll, pitch, yaw).into_inner();
        let wide = deviations.max();
        let clear = parts
            .iter()
            .zip(&widest)
            .all(|((_, other, _), width)| (other - mean).norm() > SEPARATION * wide.max(*width));
        if clear {
            let covariance = turn * Matrix3::from_diagonal(&deviations.component_mul(&deviations)) * turn.transpose();
            parts.push((between(random, 0.5, 1.5), mean, (covariance + covariance.transpose()) * 0.5));
            widest.push(wide);
        }
    }
    let total: f64 = parts.iter().map(|(weight, ..)| weight).sum();
    Mixture::new(parts.into_iter().map(|(weight, mean, covariance)| (weight / total, mean, covariance)))
}

/// How long one fit of 5,000 points and 10,000 log densities take, each on one core: the median of several.
fn speed_row(settings: &FitSettings, seed: u64) -> Result<Row, ExperimentError> {
    let mut random = SplitMix64::new(seed);
    let truth = draw(&mut random, MOST)?;
    let single = FitSettings { restarts: 1, ..settings.clone() };
    let points: Vec<Vector> = (0..TIMED_DENSITIES).map(|_| truth.sample(&mut random)).collect();
    let (mut fits, mut densities) = (Vec::new(), Vec::new());
    for repetition in 0..REPETITIONS {
        let few = points.get(..TIMED_POINTS).unwrap_or(&points);
        let began = Instant::now();
        fit(few, &single, repetition).map_err(|error| ExperimentError::Other(error.to_string()))?;
        fits.push(began.elapsed().as_secs_f64());
        let began = Instant::now();
        std::hint::black_box(points.iter().map(|point| truth.log_density_at(point)).sum::<f64>());
        densities.push(began.elapsed().as_secs_f64());
    }
    Ok(Row::of("mixtures-speed")
        .with("fit_5000_points_wall_seconds", median(fits))
        .with("log_density_10000_points_wall_seconds", median(densities)))
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied().unwrap_or(f64::NAN)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn drawn_mixtures_have_their_components_well_apart() {
        for seed in 0..20 {
            let mixture = draw(&mut SplitMix64::new(seed), 4).unwrap();
            let parts = mixture.components();
            assert_eq!(parts.len(), 4);
            for (index, part) in parts.iter().enumerate() {
                for other in &parts[..index] {
                    assert!((part.mean() - other.mean()).norm() > SEPARATION * DEVIATIONS.0);
                }
            }
        }
    }

    #[test]
    fn rows_count_what_was_found_right() {
        let counts = [(1, 1), (2, 3), (2, 2)];
        let row = count_row(&counts, Some(2));
        assert_eq!((row.number("right"), row.number("sets")), (1.0, 2.0));
        assert!((count_row(&counts, None).number("right_share") - 2.0 / 3.0).abs() < 1e-12);
    }
}
