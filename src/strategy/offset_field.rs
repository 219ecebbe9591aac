//! A Gaussian process over the path: every contact says where the optimum lies, with noise, and all of them together say
//! how far each node should be from the base path.
//!
//! Matern 5/2 over the distance along the path, with both ends pinned to no offset. Best where the force is noisy: a
//! wrong reading is outvoted by its neighbours.

use super::nodes::Correction;
use super::{OffsetFieldSettings, Rule};
use crate::geometry::{Point, Vector};
use nalgebra::{DMatrix, DVector, MatrixXx3};

/// Keeps the pinned ends' variances regular, as a share of the prior variance.
const JITTER: f64 = 1e-9;

/// The correction of the offset field.
#[derive(Debug)]
pub(super) struct OffsetField {
    settings: OffsetFieldSettings,
    base: Vec<Point>,
    mean: MatrixXx3<f64>,
    covariance: DMatrix<f64>,
}

impl OffsetField {
    pub(super) fn new(settings: &OffsetFieldSettings) -> Self {
        Self {
            settings: settings.clone(),
            base: Vec::new(),
            mean: MatrixXx3::zeros(0),
            covariance: DMatrix::zeros(0, 0),
        }
    }

    /// Takes in that the offset at a node is `offset`, known with a variance.
    fn observe(&mut self, index: usize, offset: &Vector, variance: f64) {
        let column: DVector<f64> = self.covariance.column(index).into_owned();
        let total = column.get(index).copied().unwrap_or(0.0) + variance;
        let gain = &column / total;
        let surprise = offset.transpose() - self.mean.row(index);
        self.mean += &gain * surprise;
        self.covariance -= gain * column.transpose();
    }
}

impl Correction for OffsetField {
    fn rebase(&mut self, nodes: &[Point], step: f64) {
        let count = nodes.len();
        let variance = self.settings.deviation.powi(2);
        let scale = 5.0_f64.sqrt() * step / self.settings.length_scale;
        self.base = nodes.to_vec();
        self.mean = MatrixXx3::zeros(count);
        self.covariance = DMatrix::from_fn(count, count, |row, column| {
            let distance = row.abs_diff(column) as f64 * scale;
            variance * (1.0 + distance + distance * distance / 3.0) * (-distance).exp()
        });
        for end in [0, count.saturating_sub(1)] {
            self.observe(end, &Vector::zeros(), JITTER * variance);
        }
    }

    fn correct(&mut self, nodes: &mut [Point], index: usize, towards_optimum: &Vector) {
        let Some((node, base)) = nodes.get(index).zip(self.base.get(index)) else { return };
        let offset = node + towards_optimum - base;
        let variance = self.settings.noise.powi(2) + (self.settings.relative_noise * towards_optimum.norm()).powi(2);
        self.observe(index, &offset, variance);
        let last = nodes.len().saturating_sub(1);
        for (other, (node, base)) in nodes.iter_mut().zip(&self.base).enumerate().take(last).skip(1) {
            *node = base + self.mean.row(other).transpose();
        }
    }

    fn rule(&self, stiffness: f64) -> Rule {
        Rule::OffsetField { stiffness }
    }
}
