//! Where the rays of a row of the image first meet a shape, many rays at a time.
//!
//! A ray is `t * (x, y, 1)`, so `t` is the depth along the optical axis in metres. Loops over a row have no branches, so that
//! the compiler takes several rays in one vector instruction.

use crate::geometry::{Point, Vector};
use nalgebra::Matrix3;

/// Below this the swept sphere's quadratic in the depth has no solution that can be trusted; its ends are asked instead.
const STEEP: f64 = -1e-15;

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

/// The coefficients of a quadratic in a ray's x: square, linear, constant.
type Quadratic = [f64; 3];

impl Prepared {
    /// A sphere that sweeps from one end to the other while its radius changes evenly.
    pub(super) fn cone(start: &Point, end: &Point, start_radius: f64, end_radius: f64) -> Self {
        Self::Cone(SweptSphere::new(start, end, start_radius, end_radius))
    }

    /// What `to_unit` takes to the unit sphere.
    pub(super) fn ellipsoid(centre: &Point, to_unit: &Matrix3<f64>) -> Self {
        Self::Ellipsoid { to_unit: *to_unit, sphere: Sphere::new(to_unit * centre.coords, 1.0) }
    }

    /// What `to_unit` takes to the cube from -1 to 1.
    pub(super) fn block(centre: &Point, to_unit: &Matrix3<f64>) -> Self {
        Self::Block { to_unit: *to_unit, middle: to_unit * centre.coords }
    }

    /// The depths at which rays of a row (their x) first meet the surface; infinite where they miss it.
    pub(super) fn meet(&self, across: &[f64], y: f64, depths: &mut [f64]) {
        match self {
            Self::Cone(cone) => cone.meet(across, y, depths),
            Self::Ellipsoid { to_unit, sphere } => {
                let turned = Turned::new(to_unit, y);
                for (x, depth) in across.iter().zip(depths) {
                    *depth = sphere.first(turned.at(*x));
                }
            }
            Self::Block { to_unit, middle } => {
                let turned = Turned::new(to_unit, y);
                for (x, depth) in across.iter().zip(depths) {
                    *depth = cube(turned.at(*x), middle);
                }
            }
        }
    }

    /// Between which x the rays of a row can meet the shape; `limits` are the x of the row's ends that matter.
    pub(super) fn span(&self, y: f64, limits: (f64, f64)) -> Option<(f64, f64)> {
        match self {
            Self::Cone(cone) => cone.span(y, limits),
            Self::Ellipsoid { to_unit, sphere } => {
                let (step, base) = (to_unit.column(0).into_owned(), to_unit * Vector::new(0.0, y, 1.0));
                let (along, fixed) = (step.dot(&sphere.centre), base.dot(&sphere.centre));
                not_negative([
                    along * along - step.norm_squared() * sphere.rest,
                    2.0 * (along * fixed - step.dot(&base) * sphere.rest),
                    fixed * fixed - base.norm_squared() * sphere.rest,
                ])
            }
            Self::Block { .. } => Some((f64::NEG_INFINITY, f64::INFINITY)),
        }
    }
}

/// The rays of a row, turned and scaled by a matrix.
struct Turned {
    step: [f64; 3],
    down: [f64; 3],
    ahead: [f64; 3],
}

impl Turned {
    fn new(matrix: &Matrix3<f64>, y: f64) -> Self {
        Self {
            step: matrix.column(0).into_owned().into(),
            down: (matrix.column(1) * y).into(),
            ahead: matrix.column(2).into_owned().into(),
        }
    }

    #[inline]
    fn at(&self, x: f64) -> [f64; 3] {
        let ([a, b, c], [d, e, f], [g, h, i]) = (self.step, self.down, self.ahead);
        [a * x + d + g, b * x + e + h, c * x + f + i]
    }
}

impl Sphere {
    fn new(centre: Vector, radius: f64) -> Self {
        Self { centre, rest: centre.norm_squared() - radius * radius }
    }

    /// The nearer solution of |t ray - centre| = radius in front of the camera, infinite where there is none.
    #[expect(clippy::inline_always, reason = "a loop that calls it takes one ray at a time, and twice as long")]
    #[inline(always)]
    fn first(&self, [x, y, z]: [f64; 3]) -> f64 {
        let square = x * x + y * y + z * z;
        let half = x * self.centre.x + y * self.centre.y + z * self.centre.z;
        let root = half * half - square * self.rest;
        let depth = (half - root.sqrt()) / square;
        // Of a negative number the root is no number, and no comparison with that holds.
        if depth > 0.0 { depth } else { f64::INFINITY }
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

    /// With one end inside the other there is no side to meet.
    fn has_side(&self) -> bool {
        self.length > 1e-12
    }

    /// The first meetings: with the cone between the ends, else with one of the end spheres.
    ///
    /// With q from the start to the point, the spheres through it solve s^2 L - 2 s (q.axis - r slope) + q^2 - r^2 = 0; on the
    /// surface both solutions fall together, which gives a quadratic in the depth.
    fn meet(&self, across: &[f64], y: f64, depths: &mut [f64]) {
        let (axis, start) = (&self.axis, &self.ends[0].centre);
        let has_side = self.has_side();
        for (x, depth) in across.iter().zip(depths.iter_mut()) {
            let forward = x * axis.x + y * axis.y + axis.z;
            let square = forward * forward - self.length * (x * x + y * y + 1.0);
            let half = forward * self.origin + self.length * (x * start.x + y * start.y + start.z);
            let root = half * half - square * self.rest;
            let side = (root.sqrt() - half) / square;
            // The cone's side is met where the touching sphere's centre lies between both ends.
            let share = (forward * side + self.origin) / self.length;
            let meets = side > 0.0 && (0.0..=1.0).contains(&share);
            // The end spheres lie inside the endless cone, so who misses that misses them, too. No number: ask the ends.
            let elsewhere = if root < 0.0 { f64::INFINITY } else { f64::NAN };
            let met = if meets { side } else { elsewhere };
            *depth = if has_side && square < STEEP { met } else { f64::NAN };
        }
        for (x, depth) in across.iter().zip(depths) {
            if depth.is_nan() {
                let ray = [*x, y, 1.0];
                *depth = self.ends[0].first(ray).min(self.ends[1].first(ray));
            }
        }
    }

    fn span(&self, y: f64, (low, high): (f64, f64)) -> Option<(f64, f64)> {
        let everywhere = Some((f64::NEG_INFINITY, f64::INFINITY));
        let (axis, start) = (&self.axis, &self.ends[0].centre);
        let forward = axis.y * y + axis.z;
        let square =
            [axis.x * axis.x - self.length, 2.0 * axis.x * forward, forward * forward - self.length * (y * y + 1.0)];
        let vertex = (-square[1] / (2.0 * square[0])).clamp(low, high);
        let steepest = [low, high, if vertex.is_nan() { low } else { vertex }].map(|x| value(square, x));
        if !self.has_side() || steepest.iter().any(|value| *value > -1e-9 * self.length) {
            return everywhere;
        }
        let along = axis.x * self.origin + self.length * start.x;
        let fixed = forward * self.origin + self.length * (start.y * y + start.z);
        not_negative([
            along * along - square[0] * self.rest,
            2.0 * along * fixed - square[1] * self.rest,
            fixed * fixed - square[2] * self.rest,
        ])
    }
}

fn value([square, linear, constant]: Quadratic, x: f64) -> f64 {
    (square * x + linear) * x + constant
}

/// Between which x a quadratic is not negative, a little more than less; everywhere where that is not between two.
fn not_negative([square, linear, constant]: Quadratic) -> Option<(f64, f64)> {
    if square > -1e-9 * (linear.abs() + constant.abs()) {
        return Some((f64::NEG_INFINITY, f64::INFINITY));
    }
    let product = 4.0 * square * constant;
    let under = linear * linear - product + 1e-12 * (linear * linear + product.abs());
    (under >= 0.0).then(|| {
        let root = under.sqrt();
        ((root - linear) / (2.0 * square), (-root - linear) / (2.0 * square))
    })
}

/// The first meeting with the cube from -1 to 1 about `centre` (slabs), infinite where there is none.
#[inline]
fn cube(ray: [f64; 3], centre: &Vector) -> f64 {
    let (mut enter, mut leave) = (0.0_f64, f64::INFINITY);
    for (direction, middle) in ray.into_iter().zip([centre.x, centre.y, centre.z]) {
        let per_direction = 1.0 / direction;
        let (first, second) = ((middle - 1.0) * per_direction, (middle + 1.0) * per_direction);
        let (near, far) = if first < second { (first, second) } else { (second, first) };
        enter = if near > enter { near } else { enter };
        leave = if far < leave { far } else { leave };
    }
    if enter <= leave && enter > 0.0 { enter } else { f64::INFINITY }
}

#[cfg(test)]
mod tests;
