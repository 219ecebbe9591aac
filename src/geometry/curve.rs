//! A polyline that is asked for its closest point very often. It never changes once it is made.

use super::{Point, Vector};

/// How many segments of a curve share a bounding ball.
const GROUP: usize = 5;

/// A polyline with balls round its pieces.
#[derive(Clone, Debug, PartialEq)]
pub struct Curve {
    points: Vec<Point>,
    pieces: Vec<Piece>,
}

/// Some segments of a curve and a ball round them: a piece whose ball is farther than what was found is passed over.
#[derive(Clone, Debug, PartialEq)]
struct Piece {
    centre: Point,
    radius: f64,
    /// Start, way to the end, and its squared length.
    segments: Vec<(Point, Vector, f64)>,
}

impl Piece {
    fn new(points: &[Point]) -> Self {
        let centre = Point::from(points.iter().map(|point| point.coords).sum::<Vector>() / points.len() as f64);
        let radius = points.iter().map(|point| (point - centre).norm()).fold(0.0, f64::max);
        let ends = points.iter().zip(points.iter().skip(1).chain(points.iter().take(usize::from(points.len() == 1))));
        let segments = ends.map(|(start, end)| (*start, end - start, (end - start).norm_squared())).collect();
        Self { centre, radius, segments }
    }

    /// The displacement from its closest point, and its squared length.
    fn displacement(&self, point: &Point) -> (Vector, f64) {
        let offsets = self.segments.iter().map(|(start, along, length_squared)| {
            let from_start = point - start;
            let share =
                if *length_squared > 0.0 { (from_start.dot(along) / length_squared).clamp(0.0, 1.0) } else { 0.0 };
            point - (start + along * share)
        });
        offsets.map(|offset| (offset, offset.norm_squared())).fold((Vector::zeros(), f64::INFINITY), closer)
    }
}

/// The closer of two displacements with their squared lengths; the first of equal ones.
fn closer(best: (Vector, f64), next: (Vector, f64)) -> (Vector, f64) {
    if next.1 < best.1 { next } else { best }
}

impl Curve {
    /// A curve through points.
    #[must_use]
    pub fn new(points: Vec<Point>) -> Self {
        let pieces = groups(&points).map(Piece::new).collect();
        Self { points, pieces }
    }

    /// Its points.
    #[must_use]
    pub fn points(&self) -> &[Point] {
        &self.points
    }

    /// The displacement from the closest point: the exact resistance of a synthetic problem.
    #[must_use]
    pub fn displacement(&self, point: &Point) -> Vector {
        let away = |piece: &Piece| (point - piece.centre).norm_squared();
        // The piece whose centre is nearest is searched first: after it, hardly another one has to be.
        let Some(nearest) = self.pieces.iter().min_by(|a, b| away(a).total_cmp(&away(b))) else {
            return Vector::zeros();
        };
        let mut best = nearest.displacement(point);
        let mut distance = best.1.sqrt();
        for piece in &self.pieces {
            let reach = distance + piece.radius;
            if away(piece) < reach * reach && !std::ptr::eq(piece, nearest) {
                best = closer(best, piece.displacement(point));
                distance = best.1.sqrt();
            }
        }
        best.0
    }
}

/// Groups of points of a polyline that share their ends.
fn groups(points: &[Point]) -> impl Iterator<Item = &[Point]> {
    let count = points.len().saturating_sub(1).div_ceil(GROUP).max(usize::from(!points.is_empty()));
    (0..count).filter_map(move |index| {
        let start = index * GROUP;
        points.get(start..(start + GROUP + 1).min(points.len()))
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::closest_on_polyline;
    use proptest::prelude::*;

    fn any_point() -> impl Strategy<Value = Point> {
        [-3.0..3.0, -3.0..3.0, -1.0..1.0_f64].prop_map(|[x, y, z]| Point::new(x, y, z))
    }

    proptest! {
        #[test]
        fn it_finds_the_closest_point_that_a_search_of_all_segments_finds(
            points in proptest::collection::vec(any_point(), 1..60),
            asked in any_point(),
        ) {
            let plain = asked - closest_on_polyline(&asked, &points).unwrap();
            let found = Curve::new(points).displacement(&asked);
            prop_assert!((found.norm() - plain.norm()).abs() < 1e-12);
        }
    }

    #[test]
    fn a_curve_of_one_point_or_none_is_told_from_a_line() {
        assert_eq!(Curve::new(Vec::new()).displacement(&Point::origin()), Vector::zeros());
        let only = Curve::new(vec![Point::new(0.0, 3.0, 0.0)]);
        assert_eq!(only.displacement(&Point::origin()), Vector::new(0.0, -3.0, 0.0));
    }
}
