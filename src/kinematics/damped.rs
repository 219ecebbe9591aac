//! The damped least-squares step of an arm, on arrays of fixed size: the inner loop of inverse kinematics.
//!
//! Solves (J Jᵀ + λ 1) y = e over the free joints and returns Jᵀ y. The matrix is symmetric and positive definite for λ > 0, so
//! a Cholesky factorisation without roots and without pivoting is stable. Half the work of a general product and about a third of its time.
#![expect(clippy::indexing_slicing, reason = "all indices run over the constant sizes of the arrays")]
#![expect(clippy::needless_range_loop, reason = "triangular loops are read by their indices")]

use super::JointVector;
use super::chain::{JOINTS, Jacobian};
use super::limits::JointLimits;
use nalgebra::Vector6;

/// Rows of a Jacobian.
const ROWS: usize = 6;

/// Longest step of a joint in radians: beyond it the linear model says nothing.
const STEP_CAP: f64 = 1.0;
/// How often joints that reach the end of their range hand their share on to the others in one step.
const PASSES: usize = 3;

/// Joint positions after a damped least-squares step for a twist, inside the joint limits. A joint that would leave its range is
/// put to the end of it, and the others take over what is missing.
pub(super) fn projected_step(
    limits: &JointLimits,
    jacobian: &Jacobian,
    joints: &JointVector,
    twist: Vector6<f64>,
    damping: f64,
) -> JointVector {
    let mut remaining = twist;
    let mut free = [true; JOINTS];
    let mut next = *joints;
    for _ in 0..PASSES {
        let step = damped_step(jacobian, free, &remaining, damping);
        let scale = (STEP_CAP / step.amax()).min(1.0);
        let mut blocked = false;
        for index in 0..JOINTS {
            if !free[index] {
                continue;
            }
            let wanted = joints[index] + step[index] * scale;
            next[index] = wanted.clamp(limits.lower[index], limits.upper[index]);
            if (next[index] - wanted).abs() > 0.0 {
                free[index] = false;
                blocked = true;
                remaining -= jacobian.column(index) * (next[index] - joints[index]);
            }
        }
        if !blocked {
            break;
        }
    }
    next
}

/// The step of the free joints for a twist; zero for joints that are not free.
pub(super) fn damped_step(
    jacobian: &Jacobian,
    free: [bool; JOINTS],
    twist: &Vector6<f64>,
    damping: f64,
) -> JointVector {
    let columns: &[[f64; ROWS]; JOINTS] = &jacobian.data.0;
    let mut gram = [[0.0; ROWS]; ROWS];
    for (column, free) in columns.iter().zip(free) {
        if free {
            for row in 0..ROWS {
                for other in 0..=row {
                    gram[row][other] += column[row] * column[other];
                }
            }
        }
    }
    for row in 0..ROWS {
        gram[row][row] += damping;
    }
    let solved = solve(&mut gram, twist.data.0[0]);
    let mut step = JointVector::zeros();
    for ((value, column), free) in step.iter_mut().zip(columns).zip(free) {
        if free {
            *value = (0..ROWS).map(|row| column[row] * solved[row]).sum();
        }
    }
    step
}

/// Factorises the lower triangle in place and solves for one right-hand side.
fn solve(matrix: &mut [[f64; ROWS]; ROWS], mut side: [f64; ROWS]) -> [f64; ROWS] {
    let mut inverse_pivot = [0.0; ROWS];
    for column in 0..ROWS {
        let mut scaled = [0.0; ROWS];
        let mut pivot = matrix[column][column];
        for before in 0..column {
            scaled[before] = matrix[column][before] * matrix[before][before];
            pivot -= matrix[column][before] * scaled[before];
        }
        matrix[column][column] = pivot;
        inverse_pivot[column] = pivot.recip();
        for row in column + 1..ROWS {
            let mut value = matrix[row][column];
            for before in 0..column {
                value -= matrix[row][before] * scaled[before];
            }
            matrix[row][column] = value * inverse_pivot[column];
        }
    }
    for row in 0..ROWS {
        for before in 0..row {
            side[row] -= matrix[row][before] * side[before];
        }
    }
    for row in (0..ROWS).rev() {
        side[row] *= inverse_pivot[row];
        for after in row + 1..ROWS {
            side[row] -= matrix[after][row] * side[after];
        }
    }
    side
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Matrix6;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn the_step_is_that_of_a_general_solver(
            values in proptest::collection::vec(-1.0..1.0_f64, 42),
            twist in proptest::array::uniform6(-1.0..1.0_f64),
            free in proptest::array::uniform7(proptest::bool::ANY),
            damping in 1e-4..1.0_f64,
        ) {
            let jacobian = Jacobian::from_column_slice(&values);
            let mut open = jacobian;
            for (index, free) in free.iter().enumerate() {
                if !free {
                    open.column_mut(index).fill(0.0);
                }
            }
            let twist = Vector6::from(twist);
            let gram = open * open.transpose() + Matrix6::identity() * damping;
            let expected = open.transpose() * gram.lu().solve(&twist).unwrap();
            let step = damped_step(&jacobian, free, &twist, damping);
            prop_assert!((step - expected).amax() < 1e-7 * (1.0 + expected.amax()));
        }
    }
}
