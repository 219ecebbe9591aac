//! How many Gaussians, and which: the unsupervised fit of Figueiredo and Jain (IEEE PAMI 24(3), 2002).
//!
//! Minimum message length with component-wise expectation and maximisation: components that are not worth their
//! parameters die, and after each convergence the lightest is removed until one is left; the cheapest of all mixtures
//! met wins. Cost and weights follow the authors' published program, and every covariance keeps its standard deviations
//! above a floor, so that points on a plane, a line or in one place are no trouble.

mod eigen;
mod expectation;
mod lanes;

use super::mixture::{Mixture, MixtureError};
use super::random::SplitMix64;
use expectation::State;
use lanes::Cloud;
use nalgebra::{SMatrix, SVector};
use serde::{Deserialize, Serialize};
use thiserror::Error;

/// Fewer points than this are described by one Gaussian.
const LEAST_POINTS: usize = 5;
/// The initial covariance is this share of the mean variance of the data along the axes.
const INITIAL_SHARE: f64 = 0.1;

/// How a mixture is fitted.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct FitSettings {
    /// Fewest components.
    pub least_components: usize,
    /// Most components. The thesis found 1 to 4 a joint; motion is no mixture of Gaussians, so more is always "better".
    pub most_components: usize,
    /// The smallest standard deviation in any direction, in metres: about the noise of a joint's position.
    pub floor: f64,
    /// A change of the message length below this share of it ends a sweep's run.
    pub tolerance: f64,
    /// Most sweeps for one number of components.
    pub most_sweeps: u32,
    /// How often to start anew; the cheapest result wins.
    pub restarts: u32,
}

impl Default for FitSettings {
    fn default() -> Self {
        Self { least_components: 1, most_components: 4, floor: 0.01, tolerance: 1e-6, most_sweeps: 2_000, restarts: 3 }
    }
}

/// Why a mixture could not be fitted.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum FitError {
    /// There are no points.
    #[error("there are no points to fit; record the joint while it is seen")]
    NoPoints,
    /// A point is not finite.
    #[error("point {index} (counted from 0) is not a finite position; remove it and fit again")]
    NotFinite {
        /// Which one.
        index: usize,
    },
    /// A setting has a value that cannot work.
    #[error("`{key}` of the fit must be {needed}")]
    Setting {
        /// Its key.
        key: &'static str,
        /// What it must be.
        needed: &'static str,
    },
    /// A starting point is not the number of a point.
    #[error("starting point {index} is not the number of one of {points} points")]
    Start {
        /// The number.
        index: usize,
        /// How many points there are.
        points: usize,
    },
    /// The result is no mixture, which the floor excludes.
    #[error(transparent)]
    Mixture(#[from] MixtureError),
}

/// A fitted mixture and how it came about.
#[derive(Clone, Debug, PartialEq)]
pub struct Fit<const D: usize = 3> {
    /// The mixture.
    pub mixture: Mixture<D>,
    /// Its message length in nats: less is better.
    pub message_length: f64,
    /// The log likelihood of the points in nats.
    pub log_likelihood: f64,
    /// Sweeps over all numbers of components, of all restarts.
    pub sweeps: u32,
    /// Whether the largest allowed number of components won: more might describe the points better.
    pub reached_most: bool,
}

impl FitSettings {
    fn validate(&self) -> Result<(), FitError> {
        let refuse = |key, needed| Err(FitError::Setting { key, needed });
        if self.least_components == 0 || self.most_components < self.least_components {
            return refuse("most_components", "at least `least_components`, which is at least 1");
        }
        if !(self.floor.is_finite() && self.floor > 0.0) {
            return refuse("floor", "a finite number of metres above 0");
        }
        if !(self.tolerance.is_finite() && self.tolerance > 0.0) {
            return refuse("tolerance", "a finite number above 0");
        }
        if self.most_sweeps == 0 || self.restarts == 0 {
            return refuse("most_sweeps", "at least 1, and `restarts` too");
        }
        Ok(())
    }
}

/// Fits a mixture to points in metres. Starting points are drawn with the seed.
///
/// # Errors
/// [`FitError`] where there are no points, a point is not finite or a setting cannot work.
pub fn fit<const D: usize>(points: &[SVector<f64, D>], settings: &FitSettings, seed: u64) -> Result<Fit<D>, FitError> {
    check(points, settings)?;
    let mut random = SplitMix64::new(seed);
    let mut best: Option<Fit<D>> = None;
    let mut sweeps = 0;
    for _ in 0..settings.restarts {
        let found = fit_from(points, settings, &starting_points(points.len(), settings.most_components, &mut random))?;
        sweeps += found.sweeps;
        if best.as_ref().is_none_or(|best| found.message_length < best.message_length) {
            best = Some(found);
        }
    }
    best.map(|fit| Fit { sweeps, ..fit }).ok_or(FitError::NoPoints)
}

/// Fits a mixture whose components start at the points with these numbers, once.
///
/// # Errors
/// As [`fit`], and [`FitError::Start`] where a number is not that of a point.
pub fn fit_from<const D: usize>(
    points: &[SVector<f64, D>],
    settings: &FitSettings,
    starts: &[usize],
) -> Result<Fit<D>, FitError> {
    check(points, settings)?;
    let means = starts
        .iter()
        .map(|index| points.get(*index).copied().ok_or(FitError::Start { index: *index, points: points.len() }));
    let means = means.collect::<Result<Vec<_>, _>>()?;
    let (mean, covariance) = moments(points);
    let floored = eigen::floored(&covariance, settings.floor * settings.floor);
    let cloud = Cloud::new(points, mean);
    let one = State::new(&cloud, vec![mean], floored, settings.floor);
    if points.len() < LEAST_POINTS || means.is_empty() {
        return finish(&one, settings, 0);
    }
    let initial = covariance.trace() / D as f64 * INITIAL_SHARE;
    let spread = eigen::floored(&SMatrix::from_diagonal_element(initial), settings.floor * settings.floor);
    let state = State::new(&cloud, means, spread, settings.floor);
    match anneal(state, settings) {
        (Some(best), sweeps) => finish(&best, settings, sweeps),
        (None, sweeps) => finish(&one, settings, sweeps),
    }
}

/// From as many components as the state has down to the fewest; the cheapest converged state, and the sweeps it took.
fn anneal<'a, const D: usize>(mut state: State<'a, D>, settings: &FitSettings) -> (Option<State<'a, D>>, u32) {
    let mut best: Option<State<'a, D>> = None;
    let mut sweeps = 0;
    loop {
        let mut before = state.message_length();
        for _ in 0..settings.most_sweeps {
            sweeps += 1;
            state.sweep();
            let length = state.message_length();
            if state.count() == 0 || (length - before).abs() < settings.tolerance * before.abs() {
                break;
            }
            before = length;
        }
        if state.count() < settings.least_components.max(1) {
            return (best, sweeps);
        }
        if best.as_ref().is_none_or(|best| state.message_length() < best.message_length()) {
            best = Some(state.clone());
        }
        if state.count() <= settings.least_components.max(1) {
            return (best, sweeps);
        }
        state.remove_lightest();
    }
}

fn finish<const D: usize>(state: &State<'_, D>, settings: &FitSettings, sweeps: u32) -> Result<Fit<D>, FitError> {
    Ok(Fit {
        mixture: Mixture::new(state.parts())?,
        message_length: state.message_length(),
        log_likelihood: state.log_likelihood(),
        sweeps,
        reached_most: state.count() == settings.most_components && state.count() > 1,
    })
}

fn check<const D: usize>(points: &[SVector<f64, D>], settings: &FitSettings) -> Result<(), FitError> {
    settings.validate()?;
    if points.is_empty() {
        return Err(FitError::NoPoints);
    }
    match points.iter().position(|point| point.iter().any(|number| !number.is_finite())) {
        Some(index) => Err(FitError::NotFinite { index }),
        None => Ok(()),
    }
}

/// Numbers of distinct points, no more than there are (the beginning of a Fisher and Yates shuffle).
fn starting_points(points: usize, wanted: usize, random: &mut SplitMix64) -> Vec<usize> {
    let mut numbers: Vec<usize> = (0..points).collect();
    let count = wanted.min(points);
    for index in 0..count {
        numbers.swap(index, index + random.below(points - index));
    }
    numbers.truncate(count);
    numbers
}

fn moments<const D: usize>(points: &[SVector<f64, D>]) -> (SVector<f64, D>, SMatrix<f64, D, D>) {
    let count = points.len() as f64;
    let mean: SVector<f64, D> = points.iter().sum::<SVector<f64, D>>() / count;
    let mut covariance = SMatrix::zeros();
    for point in points {
        let offset = point - mean;
        covariance += offset * offset.transpose();
    }
    (mean, covariance / count)
}

#[cfg(test)]
mod tests;
