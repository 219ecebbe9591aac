//! A covariance whose smallest variance is not below a floor.

use nalgebra::{Cholesky, SMatrix};

/// Sweeps of Jacobi's method: it doubles its digits each time, so this is far more than any matrix needs.
const SWEEPS: usize = 30;

/// The matrix with its eigenvalues raised to `floor` where they are below: the exact maximum of the likelihood under
/// that bound, so expectation and maximisation stay monotone.
pub(super) fn floored<const D: usize>(matrix: &SMatrix<f64, D, D>, floor: f64) -> SMatrix<f64, D, D> {
    let symmetric = (matrix + matrix.transpose()) * 0.5;
    // What is left above the floor is positive definite: nothing to raise. This is the rule, and cheap.
    if Cholesky::new(symmetric - SMatrix::from_diagonal_element(floor)).is_some() {
        return symmetric;
    }
    let (values, vectors) = symmetric_eigen(symmetric);
    let mut raised = SMatrix::zeros();
    for (index, vector) in vectors.column_iter().enumerate() {
        let value = values.get((index, index)).map_or(floor, |value: &f64| value.max(floor));
        raised += vector * vector.transpose() * value;
    }
    (raised + raised.transpose()) * 0.5
}

/// Jacobi's rotations: the diagonal holds the eigenvalues, the columns of the second matrix the eigenvectors.
fn symmetric_eigen<const D: usize>(mut matrix: SMatrix<f64, D, D>) -> (SMatrix<f64, D, D>, SMatrix<f64, D, D>) {
    let mut vectors = SMatrix::<f64, D, D>::identity();
    for _ in 0..SWEEPS {
        let mut largest = 0.0_f64;
        for row in 0..D {
            for column in row + 1..D {
                largest = largest.max(rotate(&mut matrix, &mut vectors, row, column));
            }
        }
        if largest < 1e-15 * matrix.abs().max() {
            break;
        }
    }
    (matrix, vectors)
}

/// Turns one pair of axes so that the entry between them vanishes; gives that entry's size before.
fn rotate<const D: usize>(
    matrix: &mut SMatrix<f64, D, D>,
    vectors: &mut SMatrix<f64, D, D>,
    row: usize,
    column: usize,
) -> f64 {
    let entry = |matrix: &SMatrix<f64, D, D>, row: usize, column: usize| {
        matrix.get((row, column)).map_or(0.0, |value: &f64| *value)
    };
    let off = entry(matrix, row, column);
    if off == 0.0 {
        return 0.0;
    }
    let difference = entry(matrix, column, column) - entry(matrix, row, row);
    let angle = 0.5 * (2.0 * off).atan2(difference);
    let (sine, cosine) = angle.sin_cos();
    let mut turn = SMatrix::<f64, D, D>::identity();
    let corners = [((row, row), cosine), ((row, column), sine), ((column, row), -sine), ((column, column), cosine)];
    for (place, value) in corners {
        if let Some(slot) = turn.get_mut(place) {
            *slot = value;
        }
    }
    *matrix = turn.transpose() * *matrix * turn;
    *vectors *= turn;
    off.abs()
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Matrix3;

    #[test]
    fn a_covariance_above_the_floor_is_left_alone() {
        let matrix = Matrix3::new(0.02, 0.005, 0.0, 0.005, 0.03, -0.004, 0.0, -0.004, 0.01);
        assert!((floored(&matrix, 1e-4) - matrix).norm() < 1e-15);
    }

    #[test]
    fn a_flat_covariance_is_raised_across_its_plane_only() {
        let direction = nalgebra::Vector3::new(1.0, 2.0, -1.0).normalize();
        let flat = (Matrix3::identity() - direction * direction.transpose()) * 0.04;
        let raised = floored(&flat, 1e-4);
        assert!(((raised - flat) - direction * direction.transpose() * 1e-4).norm() < 1e-12);
        assert!((floored(&Matrix3::zeros(), 1e-4) - Matrix3::identity() * 1e-4).norm() < 1e-15);
    }
}
