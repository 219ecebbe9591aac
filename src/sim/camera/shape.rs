//! Analytic shapes in the camera frame, and the part of the image that each can cover.

use super::ray::Prepared;
use crate::geometry::{Point, Vector};
use crate::vision::Intrinsics;
use nalgebra::Matrix3;

/// A closed surface in the camera frame, in metres.
#[derive(Clone, Debug)]
pub(super) enum Shape {
    /// A sphere that sweeps from one end to the other while its radius changes evenly.
    Cone { start: Point, end: Point, start_radius: f64, end_radius: f64 },
    /// An ellipsoid; `to_unit` takes it to the unit sphere.
    Ellipsoid { centre: Point, to_unit: Matrix3<f64>, reach: f64 },
    /// A box, upright even where its axes are not quite so; `to_unit` takes it to the cube from -1 to 1, `from_unit` back.
    Block { centre: Point, to_unit: Matrix3<f64>, from_unit: Matrix3<f64> },
}

/// Columns and rows that a shape can cover, ends excluded.
#[derive(Clone, Copy, Debug)]
pub(super) struct Window {
    pub(super) columns: (usize, usize),
    pub(super) rows: (usize, usize),
}

impl Shape {
    /// An ellipsoid from its centre, the directions of its axes (columns, orthonormal) and its half lengths.
    pub(super) fn ellipsoid(centre: Point, axes: &Matrix3<f64>, half: Vector) -> Self {
        Self::Ellipsoid { centre, to_unit: to_unit(axes, &half), reach: half.amax() }
    }

    /// A box, likewise; axes that do not stand on each other make it oblique.
    pub(super) fn block(centre: Point, axes: &Matrix3<f64>, half: Vector) -> Self {
        let to_unit = to_unit(axes, &half);
        // Without an inverse it reaches the camera, and is looked for in all of the image.
        let from_unit = to_unit.try_inverse().unwrap_or_else(|| Matrix3::identity() * UNBOUNDED);
        Self::Block { centre, to_unit, from_unit }
    }

    /// The shape with everything worked out that is the same for all rays.
    pub(super) fn prepare(&self) -> Prepared {
        match self {
            Self::Cone { start, end, start_radius, end_radius } => {
                Prepared::cone(start, end, *start_radius, *end_radius)
            }
            Self::Ellipsoid { centre, to_unit, .. } => Prepared::ellipsoid(centre, to_unit),
            Self::Block { centre, to_unit, .. } => Prepared::block(centre, to_unit),
        }
    }

    /// The least depth that a point of the shape can have, in metres.
    pub(super) fn nearest(&self) -> f64 {
        self.balls().map(|(centre, radius)| centre.z - radius).fold(f64::INFINITY, f64::min)
    }

    /// What of the image the shape can cover; all of it where the shape comes too near to tell.
    pub(super) fn window(&self, camera: &Intrinsics, width: usize, height: usize) -> Window {
        let mut window = (f64::INFINITY, f64::NEG_INFINITY, f64::INFINITY, f64::NEG_INFINITY);
        for (centre, radius) in self.balls() {
            let near = centre.z - radius;
            if near < 0.05 {
                return Window { columns: (0, width), rows: (0, height) };
            }
            for depth in [near, centre.z + radius] {
                let (left, right) = (centre.x - radius, centre.x + radius);
                let (top, bottom) = (centre.y - radius, centre.y + radius);
                window.0 = window.0.min(left / depth * camera.fx + camera.cx);
                window.1 = window.1.max(right / depth * camera.fx + camera.cx);
                window.2 = window.2.min(top / depth * camera.fy + camera.cy);
                window.3 = window.3.max(bottom / depth * camera.fy + camera.cy);
            }
        }
        Window {
            columns: (clamp(window.0.floor(), width), clamp(window.1.ceil() + 1.0, width)),
            rows: (clamp(window.2.floor(), height), clamp(window.3.ceil() + 1.0, height)),
        }
    }

    /// Balls whose hull holds the shape: its ends, the ball about it, or a box's corners.
    fn balls(&self) -> impl Iterator<Item = (Point, f64)> {
        let (balls, count) = match self {
            Self::Cone { start, end, start_radius, end_radius } => {
                let mut balls = [(*start, *start_radius); 8];
                balls[1] = (*end, *end_radius);
                (balls, 2)
            }
            Self::Ellipsoid { centre, reach, .. } => ([(*centre, *reach); 8], 1),
            Self::Block { centre, from_unit, .. } => {
                let corner = |signs: [f64; 3]| (centre + from_unit * Vector::from(signs), 0.0);
                (CORNERS.map(corner), CORNERS.len())
            }
        };
        balls.into_iter().take(count)
    }
}

/// Farther than anything in a room, in metres.
const UNBOUNDED: f64 = 100.0;

/// A cube's corners.
const CORNERS: [[f64; 3]; 8] = [
    [-1.0, -1.0, -1.0],
    [1.0, -1.0, -1.0],
    [-1.0, 1.0, -1.0],
    [1.0, 1.0, -1.0],
    [-1.0, -1.0, 1.0],
    [1.0, -1.0, 1.0],
    [-1.0, 1.0, 1.0],
    [1.0, 1.0, 1.0],
];

fn to_unit(axes: &Matrix3<f64>, half: &Vector) -> Matrix3<f64> {
    Matrix3::from_diagonal(&half.map(|length| 1.0 / length)) * axes.transpose()
}

#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped to the image first")]
fn clamp(value: f64, limit: usize) -> usize {
    value.clamp(0.0, limit as f64) as usize
}
