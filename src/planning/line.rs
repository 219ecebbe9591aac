//! Straight lines in steps: how a path is sampled, counted and drawn anew.

use crate::geometry::{Point, polyline_length};

/// Rounding that a division by the step may leave: a line of exactly two steps has two points, not three.
const STEP_ROUNDING: f64 = 1e-9;

/// How many steps of length `step` a length needs, the last one shorter where it must be.
#[must_use]
#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "negative and NaN saturate to 0")]
pub fn steps(length: f64, step: f64) -> u32 {
    (length / step - STEP_ROUNDING).ceil() as u32
}

/// The points from `from` (left out) to `to` (taken in), `step` apart; none where the two coincide.
pub fn points(from: Point, to: Point, step: f64) -> impl Iterator<Item = Point> {
    let along = to - from;
    let length = along.norm();
    let count = steps(length, step);
    (1..=count).map(move |index| if index == count { to } else { from + along * (f64::from(index) * step / length) })
}

/// The polyline with nodes at equal distances along it, at most `step` apart and at least one inside; both ends stay exactly where they are.
#[must_use]
pub fn resample(polyline: &[Point], step: f64) -> Vec<Point> {
    let (Some(first), Some(last)) = (polyline.first(), polyline.last()) else { return Vec::new() };
    let length = polyline_length(polyline);
    let count = steps(length, step).max(2);
    let spacing = length / f64::from(count);
    let mut nodes = vec![*first];
    let mut segments = polyline.iter().zip(polyline.iter().skip(1));
    let mut segment = segments.next();
    let mut before = 0.0;
    for index in 1..count {
        let wanted = f64::from(index) * spacing;
        while let Some((start, end)) = segment {
            let here = (end - start).norm();
            if before + here >= wanted && here > 0.0 {
                nodes.push(start + (end - start) * ((wanted - before) / here));
                break;
            }
            before += here;
            segment = segments.next();
        }
    }
    nodes.push(*last);
    nodes
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::Value;

    fn point(value: &Value) -> Point {
        let number = |axis: usize| value.get(axis).and_then(Value::as_f64).unwrap_or_default();
        Point::new(number(0), number(1), number(2))
    }

    fn points_of(value: &Value) -> Vec<Point> {
        value.as_array().unwrap().iter().map(point).collect()
    }

    fn assert_close(actual: &[Point], expected: &[Point]) {
        assert_eq!(actual.len(), expected.len());
        for (actual, expected) in actual.iter().zip(expected) {
            assert!((actual - expected).norm() < 1e-12, "{actual} is not {expected}");
        }
    }

    fn vectors() -> Value {
        serde_json::from_str(include_str!("../../tests/vectors/algorithms/geometry.json")).unwrap()
    }

    #[test]
    fn lines_have_the_points_of_the_vectors() {
        for case in vectors()["plan"].as_array().unwrap() {
            let made: Vec<_> =
                points(point(&case["from"]), point(&case["to"]), case["step"].as_f64().unwrap()).collect();
            assert_close(&made, &points_of(&case["points"]));
        }
    }

    #[test]
    fn resampled_lines_are_those_of_the_vectors() {
        for case in vectors()["resample"].as_array().unwrap() {
            let made = resample(&points_of(&case["line"]), case["step"].as_f64().unwrap());
            assert_close(&made, &points_of(&case["points"]));
        }
    }

    #[test]
    fn closest_points_are_those_of_the_vectors() {
        for case in vectors()["closest"].as_array().unwrap() {
            let line = points_of(&case["line"]);
            for query in case["queries"].as_array().unwrap() {
                let closest = crate::geometry::closest_on_polyline(&point(&query["p"]), &line).unwrap();
                assert!((closest - point(&query["point"])).norm() < 1e-12);
            }
        }
    }

    #[test]
    fn a_line_without_length_or_points_is_left_alone() {
        assert!(resample(&[], 0.1).is_empty());
        let twice = [Point::origin(), Point::origin()];
        assert_eq!(resample(&twice, 0.1), twice);
    }
}
