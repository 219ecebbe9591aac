//! The damped least-squares step of an arm, on arrays of fixed size: the inner loop of inverse kinematics.
//!
//! Solves (J Jᵀ + λ 1) y = e over the free joints and returns Jᵀ y. The matrix is symmetric and positive definite for λ > 0, so
//! a Cholesky factorisation without roots and without pivoting is stable.
#![expect(clippy::indexing_slicing, reason = "all indices run over the constant sizes of the arrays")]

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
    let mut gram = Gram::new(jacobian, damping);
    let mut remaining = twist;
    let mut free = [true; JOINTS];
    let mut next = *joints;
    for _ in 0..PASSES {
        let step = gram.step(jacobian, &remaining);
        let largest =
            step.iter().zip(free).fold(0.0, |most: f64, (value, free)| if free { most.max(value.abs()) } else { most });
        let scale = (STEP_CAP / largest).min(1.0);
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
                gram.leave_out(jacobian, index);
            }
        }
        if !blocked {
            break;
        }
    }
    next
}

/// The step of all joints for a twist.
pub(super) fn damped_step(jacobian: &Jacobian, twist: &Vector6<f64>, damping: f64) -> JointVector {
    Gram::new(jacobian, damping).step(jacobian, twist)
}

/// The damped matrix J Jᵀ + λ 1 of the free joints. Only its lower triangle is used.
#[derive(Clone, Copy)]
struct Gram([[f64; ROWS]; ROWS]);

impl Gram {
    fn new(jacobian: &Jacobian, damping: f64) -> Self {
        let columns: &[[f64; ROWS]; JOINTS] = &jacobian.data.0;
        let mut gram = [[0.0; ROWS]; ROWS];
        for other in 0..ROWS {
            // From the even row before the diagonal on: whole pairs make vector instructions.
            for row in (other & !1)..ROWS {
                gram[other][row] = (0..JOINTS).map(|joint| columns[joint][row] * columns[joint][other]).sum();
            }
            gram[other][other] += damping;
        }
        Self(gram)
    }

    /// Takes out the share of a joint that is not free any more.
    fn leave_out(&mut self, jacobian: &Jacobian, joint: usize) {
        let column = &jacobian.data.0[joint];
        for other in 0..ROWS {
            for row in (other & !1)..ROWS {
                self.0[other][row] -= column[row] * column[other];
            }
        }
    }

    /// The step of the joints for a twist; what it says for a joint that was left out means nothing.
    fn step(&self, jacobian: &Jacobian, twist: &Vector6<f64>) -> JointVector {
        let mut matrix = self.0;
        let solved = solve(&mut matrix, twist.data.0[0]);
        let columns: &[[f64; ROWS]; JOINTS] = &jacobian.data.0;
        JointVector::from_fn(|joint, _| (0..ROWS).map(|row| columns[joint][row] * solved[row]).sum())
    }
}

/// Factorises the symmetric matrix in place, given by its columns from the diagonal down, and solves for one right-hand side.
fn solve(matrix: &mut [[f64; ROWS]; ROWS], mut side: [f64; ROWS]) -> [f64; ROWS] {
    let mut inverse_pivot = [0.0; ROWS];
    for column in 0..ROWS {
        let inverse = matrix[column][column].recip();
        inverse_pivot[column] = inverse;
        let below = matrix[column];
        for next in column + 1..ROWS {
            let factor = below[next] * inverse;
            for row in (next & !1)..ROWS {
                matrix[next][row] -= below[row] * factor;
            }
            side[next] -= side[column] * factor;
        }
    }
    for column in (0..ROWS).rev() {
        let below: f64 = (column + 1..ROWS).map(|row| matrix[column][row] * side[row]).sum();
        side[column] = (side[column] - below) * inverse_pivot[column];
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
            let mut left = Gram::new(&jacobian, damping);
            for (index, _) in free.iter().enumerate().filter(|(_, free)| !**free) {
                left.leave_out(&jacobian, index);
            }
            let step = left.step(&jacobian, &twist).zip_map(&JointVector::from(free.map(f64::from)), |step, free| step * free);
            prop_assert!((step - expected).amax() < 1e-7 * (1.0 + expected.amax()));
        }
    }
}
