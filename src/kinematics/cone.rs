//! How far a gripper's orientation may be from the wanted one: a cone round its axis, and a turn about that axis.
//!
//! Used by inverse kinematics where a place matters more than the exact orientation. Zero and zero is the full pose.

use super::chain::Frame;
use super::inverse::{rotation_vector, twist_between};
use nalgebra::{Matrix3, Vector3, Vector6};

/// What orientation is as good as the wanted one. Angles in radians, 0 to π.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct OrientationTolerance {
    /// Half the opening of the cone in which the gripper's axis (its z) has to lie.
    pub cone: f64,
    /// How far the gripper may be turned about its axis, to either side.
    pub turn: f64,
}

impl OrientationTolerance {
    /// The exact orientation.
    pub const NONE: Self = Self { cone: 0.0, turn: 0.0 };

    /// True for numbers that are angles.
    pub(super) fn is_usable(&self) -> bool {
        [self.cone, self.turn].iter().all(|angle| (0.0..=std::f64::consts::PI).contains(angle))
    }

    /// The twist (metres, radians, axes of `base`) that takes `from` to `to`, less what is tolerated.
    pub(super) fn twist_between(&self, from: &Frame, to: &Frame) -> Vector6<f64> {
        let mut twist = twist_between(from, to);
        if *self != Self::NONE {
            let (tilt, turn) = tilt_and_turn(from, to);
            let axis: Vector3<f64> = to.rotation.column(2).into();
            let angular = beyond(tilt, self.cone) + beyond(axis * turn, self.turn);
            twist.fixed_rows_mut::<3>(3).copy_from(&angular);
        }
        twist
    }
}

/// The part of a rotation vector that is longer than tolerated.
fn beyond(rotation: Vector3<f64>, tolerated: f64) -> Vector3<f64> {
    let angle = rotation.norm();
    if angle <= tolerated { Vector3::zeros() } else { rotation * (1.0 - tolerated / angle) }
}

/// The shortest rotation vector that takes the axis of `from` to that of `to`, and the turn about this axis that remains.
fn tilt_and_turn(from: &Frame, to: &Frame) -> (Vector3<f64>, f64) {
    let (start, end) = (from.rotation.column(2), to.rotation.column(2));
    let (normal, cosine) = (start.cross(&end), start.dot(&end));
    let sine = normal.norm();
    let tilt: Vector3<f64> = if sine > 1e-9 {
        normal * (sine.atan2(cosine) / sine)
    } else if cosine > 0.0 {
        Vector3::zeros()
    } else {
        // Opposite axes: every half turn across them is as short, the one about the gripper's own x is taken.
        from.rotation.column(0) * std::f64::consts::PI
    };
    let tilted: Matrix3<f64> = *nalgebra::Rotation3::new(tilt).matrix() * from.rotation;
    let rest = rotation_vector(&(to.rotation * tilted.transpose()));
    (tilt, rest.dot(&end))
}

#[cfg(test)]
mod tests;
