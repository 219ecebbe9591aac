//! Marginals and conditionals of a mixture.

use super::{Mixture, MixtureError};
use nalgebra::{Cholesky, SMatrix, SVector};

impl<const D: usize> Mixture<D> {
    /// The mixture of some of the coordinates, in the order of `kept` (indices below `D`, others give 0).
    ///
    /// # Errors
    /// [`MixtureError::NotPositiveDefinite`] where `kept` names a coordinate twice or beyond the dimension.
    pub fn marginal<const M: usize>(&self, kept: [usize; M]) -> Result<Mixture<M>, MixtureError> {
        Mixture::new(self.components().iter().map(|component| {
            let mean = pick(component.mean(), kept);
            (component.weight(), mean, pick_block(component.covariance(), kept, kept))
        }))
    }

    /// The mixture of the coordinates `kept` where the coordinates `given` are known to be `values`.
    ///
    /// # Errors
    /// [`MixtureError`] where the indices overlap or repeat, or where every component is so far from `values` that no
    /// weight remains.
    pub fn conditional<const M: usize, const N: usize>(
        &self,
        kept: [usize; M],
        given: [usize; N],
        values: &SVector<f64, N>,
    ) -> Result<Mixture<M>, MixtureError> {
        let known = self.marginal(given)?;
        let total = known.log_density_at(values);
        let parts = self.components().iter().zip(known.components()).enumerate();
        let parts = parts.map(|(index, (component, known))| {
            let not_definite = MixtureError::NotPositiveDefinite { component: index };
            let factor = Cholesky::new(*known.covariance()).ok_or(not_definite)?;
            let cross = pick_block(component.covariance(), kept, given);
            let gain = factor.solve(&cross.transpose()).transpose();
            let mean = pick(component.mean(), kept) + gain * (values - known.mean());
            let covariance = pick_block(component.covariance(), kept, kept) - gain * cross.transpose();
            let weight = (known.log_weighted_density(values) - total).exp();
            Ok((weight, mean, (covariance + covariance.transpose()) * 0.5))
        });
        let mut parts = parts.collect::<Result<Vec<_>, _>>()?;
        // Components that the values rule out altogether carry no weight and would be refused.
        parts.retain(|(weight, _, _)| *weight > f64::MIN_POSITIVE);
        Mixture::new(parts)
    }
}

fn pick<const D: usize, const M: usize>(vector: &SVector<f64, D>, kept: [usize; M]) -> SVector<f64, M> {
    SVector::from_iterator(kept.into_iter().map(|index| vector.get(index).copied().unwrap_or_default()))
}

fn pick_block<const D: usize, const M: usize, const N: usize>(
    matrix: &SMatrix<f64, D, D>,
    rows: [usize; M],
    columns: [usize; N],
) -> SMatrix<f64, M, N> {
    let entry = |row: usize, column: usize| matrix.get((row, column)).map_or(0.0, |value: &f64| *value);
    SMatrix::from_row_iterator(
        rows.into_iter().flat_map(|row| columns.into_iter().map(move |column| entry(row, column))),
    )
}
