//! The serial chain of one arm: where its tip is for given joint positions, and how the tip moves with each joint.
//!
//! Knows nothing of limits, of shapes or of where the figures came from.

use super::JointVector;
use crate::geometry::Pose;
use nalgebra::{Isometry3, Matrix3, Rotation3, SMatrix, Translation3, UnitQuaternion, Vector3};
use wide::f64x4;

/// Number of joints of a Baxter arm.
pub const JOINTS: usize = 7;
/// [`JOINTS`], filled up to whole vectors of four.
const LANES: usize = 8;

/// A rigid transformation as matrix and vector: cheaper to compose than a quaternion in the inner loop.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Frame {
    pub(super) rotation: Matrix3<f64>,
    pub(super) translation: Vector3<f64>,
}

impl Frame {
    pub(super) fn from_pose(pose: &Pose) -> Self {
        Self { rotation: *pose.rotation.to_rotation_matrix().matrix(), translation: pose.translation.vector }
    }

    pub(super) fn to_pose(self) -> Pose {
        let rotation = UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix_unchecked(self.rotation));
        Isometry3::from_parts(Translation3::from(self.translation), rotation)
    }

    pub(super) fn then(&self, next: &Self) -> Self {
        Self {
            rotation: self.rotation * next.rotation,
            translation: self.rotation * next.translation + self.translation,
        }
    }

    /// Turns the frame about its own z axis by an angle of this sine and cosine: only two columns change.
    fn turned_about_z(mut self, sine: f64, cosine: f64) -> Self {
        let x = self.rotation.column(0) * cosine + self.rotation.column(1) * sine;
        let y = self.rotation.column(1) * cosine - self.rotation.column(0) * sine;
        self.rotation.set_column(0, &x);
        self.rotation.set_column(1, &y);
        self
    }
}

/// The geometric Jacobian of the tip in `base`: linear rows (metres per radian) first, then angular rows.
pub(super) type Jacobian = SMatrix<f64, 6, JOINTS>;

/// The frames of an arm for one joint vector, in `base`.
#[derive(Clone, Copy, Debug)]
pub(super) struct ArmFrames {
    /// The frame that turns with each joint (the joint's child link).
    pub(super) links: [Frame; JOINTS],
    /// The tip of the gripper.
    pub(super) tip: Frame,
}

/// Seven revolute joints, each about the z axis of its own frame, from `base` to the gripper's tip.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Chain {
    origins: [Frame; JOINTS],
    tip: Frame,
}

impl Chain {
    /// A chain from the fixed transformation before each joint, the joint's axis in its own frame (unit length), and the
    /// fixed transformation from the last link to the tip.
    ///
    /// Axes other than z are folded into the transformations, so that the inner loop has one case only.
    pub(super) fn new(joints: &[(Pose, Vector3<f64>); JOINTS], tip: &Pose) -> Self {
        let mut pending = UnitQuaternion::identity();
        let origins = joints.each_ref().map(|(origin, axis)| {
            let to_axis = rotation_from_z(axis);
            let folded = pending * origin * to_axis;
            pending = to_axis.inverse();
            Frame::from_pose(&folded)
        });
        Self { origins, tip: Frame::from_pose(&(pending * tip)) }
    }

    /// All frames for joint positions in radians.
    pub(super) fn frames(&self, joints: &JointVector) -> ArmFrames {
        let mut frame = Frame { rotation: Matrix3::identity(), translation: Vector3::zeros() };
        let mut links = [frame; JOINTS];
        let (sines, cosines) = sines_and_cosines(joints);
        for (((link, origin), sine), cosine) in links.iter_mut().zip(&self.origins).zip(sines).zip(cosines) {
            frame = frame.then(origin).turned_about_z(sine, cosine);
            *link = frame;
        }
        ArmFrames { links, tip: frame.then(&self.tip) }
    }

    /// The pose of the tip in `base` for joint positions in radians.
    pub(super) fn tip_pose(&self, joints: &JointVector) -> Pose {
        self.frames(joints).tip.to_pose()
    }
}

impl ArmFrames {
    /// The Jacobian of the tip.
    pub(super) fn jacobian(&self) -> Jacobian {
        let mut jacobian = Jacobian::zeros();
        for (mut column, link) in jacobian.column_iter_mut().zip(&self.links) {
            let axis: Vector3<f64> = link.rotation.column(2).into();
            let lever = self.tip.translation - link.translation;
            column.fixed_rows_mut::<3>(0).copy_from(&axis.cross(&lever));
            column.fixed_rows_mut::<3>(3).copy_from(&axis);
        }
        jacobian
    }
}

/// Sine and cosine of each angle (radians) and of 0 as the eighth: side by side, which takes a third of the time of seven calls.
/// To within two units in the last place up to many turns; not a number where the angle is none or infinite.
fn sines_and_cosines(joints: &JointVector) -> ([f64; LANES], [f64; LANES]) {
    let [[s0, s1, e0, e1, w0, w1, w2]] = joints.data.0;
    let (first, second) = (f64x4::new([s0, s1, e0, e1]).sin_cos(), f64x4::new([w0, w1, w2, 0.0]).sin_cos());
    let side_by_side = |one: f64x4, other: f64x4| {
        let ([a, b, c, d], [e, f, g, h]) = (one.to_array(), other.to_array());
        [a, b, c, d, e, f, g, h]
    };
    (side_by_side(first.0, second.0), side_by_side(first.1, second.1))
}

/// The rotation that takes z to `axis`; for the axis that is opposite to z a half turn about x.
pub(super) fn rotation_from_z(axis: &Vector3<f64>) -> UnitQuaternion<f64> {
    UnitQuaternion::rotation_between(&Vector3::z(), axis)
        .unwrap_or_else(|| UnitQuaternion::from_axis_angle(&Vector3::x_axis(), std::f64::consts::PI))
}

#[cfg(test)]
mod tests;
