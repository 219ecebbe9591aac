//! Points, directions, poses and wrenches in metres, radians, newtons and newton metres.
//!
//! Holds only what several rooms share. Frames are named in the documentation of each value: unless it says otherwise,
//! a point or pose is in the robot's `base` frame (x forward out of the chest, y to the robot's left, z up).

mod curve;

pub use curve::Curve;

use nalgebra::{Isometry3, Point3, Vector3};
use serde::{Deserialize, Serialize};

/// A position in metres.
pub type Point = Point3<f64>;
/// A direction or displacement in metres, or a force in newtons.
pub type Vector = Vector3<f64>;
/// A position and an orientation.
pub type Pose = Isometry3<f64>;

/// A force in newtons and a torque in newton metres.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Wrench {
    /// Force in newtons.
    pub force: Vector,
    /// Torque in newton metres.
    pub torque: Vector,
}

/// Whether every number in a value is finite: nothing else may reach a decision.
pub trait Finite {
    /// True where no number is NaN or infinite.
    fn is_finite(&self) -> bool;
}

impl Finite for Vector {
    fn is_finite(&self) -> bool {
        self.iter().all(|value| value.is_finite())
    }
}

impl Finite for Point {
    fn is_finite(&self) -> bool {
        self.coords.is_finite()
    }
}

impl Finite for Pose {
    fn is_finite(&self) -> bool {
        self.translation.vector.is_finite() && self.rotation.coords.iter().all(|value| value.is_finite())
    }
}

impl Finite for Wrench {
    fn is_finite(&self) -> bool {
        self.force.is_finite() && self.torque.is_finite()
    }
}

/// The point of the segment from `start` to `end` that lies closest to `point`; `start` where the segment has no length.
#[must_use]
pub fn closest_on_segment(point: &Point, start: &Point, end: &Point) -> Point {
    let along = end - start;
    let length_squared = along.norm_squared();
    if length_squared <= f64::EPSILON * f64::EPSILON {
        return *start;
    }
    let share = ((point - start).dot(&along) / length_squared).clamp(0.0, 1.0);
    start + along * share
}

/// The point of a polyline that lies closest to `point`; of equally close ones that of the first segment.
/// `None` where the polyline has no points.
#[must_use]
pub fn closest_on_polyline(point: &Point, polyline: &[Point]) -> Option<Point> {
    let first = *polyline.first()?;
    let mut best = first;
    let mut best_distance = f64::INFINITY;
    for (start, end) in polyline.iter().zip(polyline.iter().skip(1)) {
        let candidate = closest_on_segment(point, start, end);
        let distance = (point - candidate).norm_squared();
        if distance < best_distance {
            (best, best_distance) = (candidate, distance);
        }
    }
    Some(best)
}

/// The length of a polyline in metres.
#[must_use]
pub fn polyline_length(polyline: &[Point]) -> f64 {
    polyline.iter().zip(polyline.iter().skip(1)).map(|(start, end)| (end - start).norm()).sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn any_point() -> impl Strategy<Value = Point> {
        [-3.0..3.0, -3.0..3.0, -3.0..3.0_f64].prop_map(|[x, y, z]| Point::new(x, y, z))
    }

    #[test]
    fn a_number_that_is_not_finite_is_seen_wherever_it_hides() {
        let mut wrench = Wrench::default();
        assert!(wrench.is_finite());
        wrench.torque.y = f64::NAN;
        assert!(!wrench.is_finite());
        let mut pose = Pose::identity();
        pose.translation.vector.z = f64::INFINITY;
        assert!(!pose.is_finite());
    }

    #[test]
    fn a_segment_of_no_length_is_its_start() {
        let start = Point::new(1.0, 2.0, 3.0);
        assert_eq!(closest_on_segment(&Point::origin(), &start, &start), start);
    }

    #[test]
    fn an_empty_polyline_has_no_closest_point_and_a_single_point_is_its_own() {
        assert_eq!(closest_on_polyline(&Point::origin(), &[]), None);
        let only = Point::new(0.0, 1.0, 0.0);
        assert_eq!(closest_on_polyline(&Point::origin(), &[only]), Some(only));
    }

    proptest! {
        #[test]
        fn no_point_of_the_polyline_is_closer(
            point in any_point(),
            polyline in proptest::collection::vec(any_point(), 2..6),
            share in 0.0..1.0_f64,
        ) {
            let closest = closest_on_polyline(&point, &polyline).unwrap();
            for pair in polyline.windows(2) {
                let other = pair[0] + (pair[1] - pair[0]) * share;
                prop_assert!((point - closest).norm() <= (point - other).norm() + 1e-9);
            }
        }
    }
}
