//! Gaussian mixtures: density, mode, marginals, conditionals, sampling and regions.
//!
//! A mixture is checked when it is made (also when it is read from a file), so everything after that is arithmetic that
//! cannot fail. Never fits anything: that is `fit`. The dimension is a constant: 3 for a joint, 9 for a whole arm.

mod condition;
mod file;

use super::random::SplitMix64;
use crate::geometry::{Point, Vector};
use nalgebra::{Cholesky, Matrix2, SMatrix, SVector, Vector2};
use std::f64::consts::TAU;
use thiserror::Error;

/// By how much the weights of a mixture may miss 1 before it is refused: rounding of a file with six digits.
const WEIGHT_TOLERANCE: f64 = 1e-4;

/// The 95 % quantile of the chi-squared distribution with 2 degrees of freedom: the squared Mahalanobis radius in a plane.
pub const REGION_95_PLANAR: f64 = 5.991_464_547_107_979;
/// The 95 % quantile of the chi-squared distribution with 3 degrees of freedom: the squared Mahalanobis radius in space.
pub const REGION_95_SPATIAL: f64 = 7.814_727_903_251_179;

/// Why numbers are not a mixture.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum MixtureError {
    /// There is no component.
    #[error("a mixture needs at least one component; record the person's movement and fit it again")]
    Empty,
    /// A list has another length than the dimension asks for.
    #[error("component {component} (counted from 0): `{key}` has {found} numbers where {expected} are needed")]
    Shape {
        /// Which component.
        component: usize,
        /// Which key.
        key: &'static str,
        /// How many numbers it has.
        found: usize,
        /// How many it needs.
        expected: usize,
    },
    /// A weight, mean or covariance holds NaN or infinity.
    #[error("component {component} (counted from 0) holds a number that is not finite; fit the movement space again")]
    NotFinite {
        /// Which component.
        component: usize,
    },
    /// A weight is zero or below.
    #[error("component {component} (counted from 0): `weight` is {weight}, and it must be above 0")]
    Weight {
        /// Which component.
        component: usize,
        /// Its weight.
        weight: f64,
    },
    /// The weights do not add up to 1.
    #[error("the `weight`s add up to {sum}, and they must add up to 1")]
    WeightSum {
        /// What they add up to.
        sum: f64,
    },
    /// A covariance is not symmetric and positive definite.
    #[error("component {component} (counted from 0): `covariance` is not symmetric and positive definite")]
    NotPositiveDefinite {
        /// Which component.
        component: usize,
    },
}

/// One Gaussian of a mixture.
#[derive(Clone, Debug, PartialEq)]
pub struct Component<const D: usize = 3> {
    weight: f64,
    mean: SVector<f64, D>,
    covariance: SMatrix<f64, D, D>,
    /// The inverse of the covariance's lower Cholesky factor: it turns a displacement into standard deviations.
    whitening: SMatrix<f64, D, D>,
    /// Natural logarithm of weight and normalising constant.
    log_scale: f64,
}

impl<const D: usize> Component<D> {
    fn new(
        index: usize,
        weight: f64,
        mean: SVector<f64, D>,
        covariance: SMatrix<f64, D, D>,
    ) -> Result<Self, MixtureError> {
        let finite = weight.is_finite() && mean.iter().chain(covariance.iter()).all(|number| number.is_finite());
        if !finite {
            return Err(MixtureError::NotFinite { component: index });
        }
        if weight <= 0.0 {
            return Err(MixtureError::Weight { component: index, weight });
        }
        let not_definite = MixtureError::NotPositiveDefinite { component: index };
        let asymmetry = (covariance - covariance.transpose()).abs().max();
        if asymmetry > 1e-9 * covariance.abs().max() {
            return Err(not_definite);
        }
        let lower = Cholesky::new(covariance).ok_or(not_definite)?.l();
        let whitening = lower.solve_lower_triangular(&SMatrix::identity()).ok_or(not_definite)?;
        let log_determinant: f64 = lower.diagonal().iter().map(|value| value.ln()).sum();
        if !log_determinant.is_finite() {
            return Err(not_definite);
        }
        let log_scale = weight.ln() - 0.5 * D as f64 * TAU.ln() - log_determinant;
        Ok(Self { weight, mean, covariance, whitening, log_scale })
    }

    /// The share of the mixture, above 0 and up to 1.
    #[must_use]
    pub const fn weight(&self) -> f64 {
        self.weight
    }

    /// The mean in metres.
    #[must_use]
    pub const fn mean(&self) -> &SVector<f64, D> {
        &self.mean
    }

    /// The covariance in square metres.
    #[must_use]
    pub const fn covariance(&self) -> &SMatrix<f64, D, D> {
        &self.covariance
    }

    /// The squared Mahalanobis distance of a position.
    #[must_use]
    pub fn mahalanobis_squared(&self, position: &SVector<f64, D>) -> f64 {
        (self.whitening * (position - self.mean)).norm_squared()
    }

    /// The natural logarithm of weight times density at a position.
    #[must_use]
    pub fn log_weighted_density(&self, position: &SVector<f64, D>) -> f64 {
        self.log_scale - 0.5 * self.mahalanobis_squared(position)
    }

    fn precision(&self) -> SMatrix<f64, D, D> {
        self.whitening.transpose() * self.whitening
    }
}

/// A Gaussian mixture: at least one component, weights that add up to 1, positive definite covariances.
#[derive(Clone, Debug, PartialEq)]
pub struct Mixture<const D: usize = 3> {
    components: Vec<Component<D>>,
}

impl<const D: usize> Mixture<D> {
    /// A mixture from weights, means (metres) and covariances (square metres).
    ///
    /// # Errors
    /// [`MixtureError`] where there is no component, a number is not finite, a weight is not positive, the weights do not
    /// add up to 1 or a covariance is not symmetric and positive definite.
    pub fn new(
        parts: impl IntoIterator<Item = (f64, SVector<f64, D>, SMatrix<f64, D, D>)>,
    ) -> Result<Self, MixtureError> {
        let parts: Vec<_> = parts.into_iter().collect();
        if parts.is_empty() {
            return Err(MixtureError::Empty);
        }
        let checked = parts
            .iter()
            .enumerate()
            .map(|(index, (weight, mean, covariance))| Component::new(index, *weight, *mean, *covariance));
        let components = checked.collect::<Result<Vec<_>, _>>()?;
        let sum: f64 = components.iter().map(Component::weight).sum();
        if (sum - 1.0).abs() > WEIGHT_TOLERANCE {
            return Err(MixtureError::WeightSum { sum });
        }
        Ok(Self { components })
    }

    /// The components, at least one.
    #[must_use]
    pub fn components(&self) -> &[Component<D>] {
        &self.components
    }

    /// The natural logarithm of the density at a position; finite wherever the position is not absurdly far.
    #[must_use]
    pub fn log_density_at(&self, position: &SVector<f64, D>) -> f64 {
        // One pass: the running sum is rescaled whenever a larger term appears, so nothing under- or overflows.
        let mut highest = f64::NEG_INFINITY;
        let mut sum = 0.0;
        for component in &self.components {
            let term = component.log_weighted_density(position);
            if term > highest {
                sum = sum * (highest - term).exp() + 1.0;
                highest = term;
            } else {
                sum += (term - highest).exp();
            }
        }
        highest + f64::ln(sum)
    }

    /// Whether a position lies in the region of some component that a squared Mahalanobis radius bounds.
    #[must_use]
    pub fn contains(&self, position: &SVector<f64, D>, squared_radius: f64) -> bool {
        self.components.iter().any(|component| component.mahalanobis_squared(position) <= squared_radius)
    }

    /// The mean that is closest to a position (thesis equation 3.5); of equally close ones the first. The index counts
    /// components from 0.
    #[must_use]
    pub fn nearest_mean(&self, position: &SVector<f64, D>) -> (usize, SVector<f64, D>) {
        let mut best = (0, *position);
        let mut best_distance = f64::INFINITY;
        for (index, component) in self.components.iter().enumerate() {
            let distance = (component.mean - position).norm_squared();
            if distance < best_distance {
                (best, best_distance) = ((index, component.mean), distance);
            }
        }
        best
    }

    /// The position of highest density: the highest fixed point of mean shift from every mean.
    #[must_use]
    pub fn mode_position(&self) -> SVector<f64, D> {
        let mut best = SVector::zeros();
        let mut best_density = f64::NEG_INFINITY;
        for component in &self.components {
            let summit = self.climb(component.mean);
            let density = self.log_density_at(&summit);
            if density > best_density {
                (best, best_density) = (summit, density);
            }
        }
        best
    }

    /// Mean shift with full covariances: each step solves for the point at which the gradients' weighted sum vanishes.
    fn climb(&self, start: SVector<f64, D>) -> SVector<f64, D> {
        /// Mean shift converges linearly; this many steps reach 1e-12 m in every mixture met so far.
        const MAXIMUM_STEPS: usize = 5_000;
        let mut position = start;
        for _ in 0..MAXIMUM_STEPS {
            let total = self.log_density_at(&position);
            let mut precision = SMatrix::zeros();
            let mut pull = SVector::zeros();
            for component in &self.components {
                let share = (component.log_weighted_density(&position) - total).exp();
                let weighted = component.precision() * share;
                precision += weighted;
                pull += weighted * component.mean;
            }
            let Some(factor) = Cholesky::new(precision) else { return position };
            let next = factor.solve(&pull);
            let moved = (next - position).norm();
            position = next;
            if moved < 1e-13 {
                break;
            }
        }
        position
    }

    /// A random draw.
    #[must_use]
    pub fn sample(&self, random: &mut SplitMix64) -> SVector<f64, D> {
        let mut rest = random.uniform();
        let chosen = self.components.iter().find(|component| {
            rest -= component.weight;
            rest < 0.0
        });
        let Some(component) = chosen.or(self.components.last()) else { return SVector::zeros() };
        let standard = SVector::from_fn(|_, _| random.normal());
        // The whitening matrix is lower triangular and regular by construction.
        let offset = component.whitening.solve_lower_triangular(&standard).unwrap_or_else(SVector::zeros);
        component.mean + offset
    }
}

impl Mixture<3> {
    /// The natural logarithm of the density (per cubic metre) at a point.
    #[must_use]
    pub fn log_density(&self, point: &Point) -> f64 {
        self.log_density_at(&point.coords)
    }

    /// The point of highest density.
    #[must_use]
    pub fn mode(&self) -> Point {
        Point::from(self.mode_position())
    }

    /// A mixture of the plane z = 0, as thesis section 5.2.1 uses it, in the terms of space.
    ///
    /// Across the plane each component gets the variance 1/(2 pi), whose density at z = 0 is 1: in the plane the density
    /// is exactly the planar one.
    ///
    /// # Errors
    /// As [`Mixture::new`].
    pub fn planar(parts: impl IntoIterator<Item = (f64, Vector2<f64>, Matrix2<f64>)>) -> Result<Self, MixtureError> {
        Self::new(parts.into_iter().map(|(weight, mean, covariance)| {
            let mut spatial = SMatrix::<f64, 3, 3>::zeros();
            spatial.fixed_view_mut::<2, 2>(0, 0).copy_from(&covariance);
            spatial.m33 = 1.0 / TAU;
            (weight, Vector::new(mean.x, mean.y, 0.0), spatial)
        }))
    }
}

#[cfg(test)]
pub(crate) mod tests;
