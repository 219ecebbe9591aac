//! Analytic shapes and where a ray from the camera's centre first meets them.
//!
//! A ray is `t * (x, y, 1)`, so `t` is the depth along the optical axis in metres.

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
    /// A box; `to_unit` takes it to the cube from -1 to 1.
    Block { centre: Point, to_unit: Matrix3<f64>, reach: f64 },
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

    /// A box, likewise.
    pub(super) fn block(centre: Point, axes: &Matrix3<f64>, half: Vector) -> Self {
        Self::Block { centre, to_unit: to_unit(axes, &half), reach: half.norm() }
    }

    /// The shape with everything worked out that is the same for all rays.
    pub(super) fn prepare(&self) -> Prepared {
        match self {
            Self::Cone { start, end, start_radius, end_radius } => {
                Prepared::Cone(SweptSphere::new(start, end, *start_radius, *end_radius))
            }
            Self::Ellipsoid { centre, to_unit, .. } => {
                Prepared::Ellipsoid { to_unit: *to_unit, sphere: Sphere::new(to_unit * centre.coords, 1.0) }
            }
            Self::Block { centre, to_unit, .. } => {
                Prepared::Block { to_unit: *to_unit, middle: to_unit * centre.coords }
            }
        }
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

    fn balls(&self) -> impl Iterator<Item = (Point, f64)> {
        match self {
            Self::Cone { start, end, start_radius, end_radius } => {
                [Some((*start, *start_radius)), Some((*end, *end_radius))]
            }
            Self::Ellipsoid { centre, reach, .. } | Self::Block { centre, reach, .. } => {
                [Some((*centre, *reach)), None]
            }
        }
        .into_iter()
        .flatten()
    }
}

fn to_unit(axes: &Matrix3<f64>, half: &Vector) -> Matrix3<f64> {
    Matrix3::from_diagonal(&half.map(|length| 1.0 / length)) * axes.transpose()
}

#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped to the image first")]
fn clamp(value: f64, limit: usize) -> usize {
    value.clamp(0.0, limit as f64) as usize
}

/// A shape that is ready for many rays.
#[derive(Clone, Copy, Debug)]
pub(super) enum Prepared {
    Cone(SweptSphere),
    Ellipsoid { to_unit: Matrix3<f64>, sphere: Sphere },
    Block { to_unit: Matrix3<f64>, middle: Vector },
}

/// A sphere; `rest` is the square of its centre's distance from the camera less that of its radius.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sphere {
    centre: Vector,
    rest: f64,
}

/// A sphere swept along an axis, with what its quadratic is made of.
#[derive(Clone, Copy, Debug)]
pub(super) struct SweptSphere {
    axis: Vector,
    length: f64,
    origin: f64,
    rest: f64,
    ends: [Sphere; 2],
}

impl Prepared {
    /// The depth at which a ray first meets the surface.
    pub(super) fn hit(&self, ray: &Vector) -> Option<f64> {
        match self {
            Self::Cone(cone) => cone.hit(ray),
            Self::Ellipsoid { to_unit, sphere } => sphere.hit(&(to_unit * ray)),
            Self::Block { to_unit, middle } => cube(&(to_unit * ray), middle),
        }
    }
}

impl Sphere {
    fn new(centre: Vector, radius: f64) -> Self {
        Self { centre, rest: centre.norm_squared() - radius * radius }
    }

    /// The nearer solution of |t ray - centre| = radius, in front of the camera.
    fn hit(&self, ray: &Vector) -> Option<f64> {
        let (square, half) = (ray.norm_squared(), ray.dot(&self.centre));
        let root = half * half - square * self.rest;
        (root >= 0.0).then(|| (half - root.sqrt()) / square).filter(|depth| *depth > 0.0)
    }
}

impl SweptSphere {
    fn new(start: &Point, end: &Point, start_radius: f64, end_radius: f64) -> Self {
        let axis = end - start;
        let slope = start_radius - end_radius;
        let length = axis.norm_squared() - slope * slope;
        let origin = -start.coords.dot(&axis) - slope * start_radius;
        let ends = [Sphere::new(start.coords, start_radius), Sphere::new(end.coords, end_radius)];
        Self { axis, length, origin, rest: origin * origin - length * ends[0].rest, ends }
    }

    /// The first meeting: with the cone between the ends, else with one of the end spheres.
    ///
    /// With q from the start to the point, the spheres through it solve s^2 L - 2 s (q.axis - r slope) + q^2 - r^2 = 0; on the
    /// surface both solutions fall together, which gives a quadratic in the depth.
    fn hit(&self, ray: &Vector) -> Option<f64> {
        let forward = ray.dot(&self.axis);
        let square = forward * forward - self.length * ray.norm_squared();
        if self.length > 1e-12 && square < -1e-15 {
            let half = forward * self.origin + self.length * ray.dot(&self.ends[0].centre);
            let root = half * half - square * self.rest;
            if root < 0.0 {
                // The end spheres lie inside the endless cone, so they are missed too.
                return None;
            }
            let depth = (-half + root.sqrt()) / square;
            // The cone's side is met where the touching sphere's centre lies between both ends.
            let share = (forward * depth + self.origin) / self.length;
            if depth > 0.0 && (0.0..=1.0).contains(&share) {
                return Some(depth);
            }
        }
        self.ends.iter().filter_map(|end| end.hit(ray)).reduce(f64::min)
    }
}

/// The first meeting with the cube from -1 to 1 about `centre` (slabs).
fn cube(ray: &Vector, centre: &Vector) -> Option<f64> {
    let (mut enter, mut leave) = (0.0_f64, f64::INFINITY);
    for (direction, middle) in ray.iter().zip(centre.iter()) {
        let per_direction = 1.0 / direction;
        let (first, second) = ((middle - 1.0) * per_direction, (middle + 1.0) * per_direction);
        enter = enter.max(first.min(second));
        leave = leave.min(first.max(second));
    }
    (enter <= leave && enter > 0.0).then_some(enter)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_ray_meets_the_near_side_of_each_shape() {
        let ray = Vector::new(0.0, 0.0, 1.0);
        let ball = Shape::ellipsoid(Point::new(0.0, 0.0, 2.0), &Matrix3::identity(), Vector::new(0.3, 0.2, 0.5));
        assert!((ball.prepare().hit(&ray).unwrap() - 1.5).abs() < 1e-12);
        let block = Shape::block(Point::new(0.05, 0.0, 2.0), &Matrix3::identity(), Vector::new(0.3, 0.2, 0.25));
        assert!((block.prepare().hit(&ray).unwrap() - 1.75).abs() < 1e-12);
        assert_eq!(block.prepare().hit(&Vector::new(0.5, 0.0, 1.0)), None);
    }

    #[test]
    fn a_cone_s_surface_is_its_radius_away_from_its_axis() {
        let (start, end) = (Point::new(-0.3, 0.0, 1.5), Point::new(0.3, 0.1, 1.8));
        let cone = Shape::Cone { start, end, start_radius: 0.05, end_radius: 0.05 };
        let mut hits = 0;
        for step in 0..200 {
            let ray = Vector::new(f64::from(step) * 0.003 - 0.3, 0.02, 1.0);
            if let Some(depth) = cone.prepare().hit(&ray) {
                let point = Point::from(ray * depth);
                let foot = crate::geometry::closest_on_segment(&point, &start, &end);
                assert!(((point - foot).norm() - 0.05).abs() < 1e-9);
                hits += 1;
            }
        }
        assert!(hits > 50);
    }

    #[test]
    fn a_tapering_cone_touches_its_own_sphere_at_every_hit() {
        let (start, end) = (Point::new(-0.2, 0.0, 1.5), Point::new(0.3, 0.1, 1.4));
        let cone = Shape::Cone { start, end, start_radius: 0.07, end_radius: 0.03 };
        for step in 0..400 {
            let ray = Vector::new(f64::from(step) * 0.0015 - 0.25, 0.0, 1.0);
            let Some(depth) = cone.prepare().hit(&ray) else { continue };
            let point = ray * depth;
            let gap = (0..=10_000)
                .map(|share| {
                    let share = f64::from(share) / 10_000.0;
                    (point - (start + (end - start) * share).coords).norm() - (0.07 - 0.04 * share)
                })
                .fold(f64::INFINITY, f64::min);
            assert!(gap.abs() < 1e-5, "{gap}");
        }
    }
}
