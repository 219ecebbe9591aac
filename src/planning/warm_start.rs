//! Carries a learned path over to another starting position: way-points relative to the arm that they were learned on.
//!
//! A way-point belongs to the nearer part of the arm (hand to elbow, elbow to shoulder) and is told by its share of that
//! part's length and its offset in metres, so it keeps its distance from the limb when the limb lies elsewhere, bends
//! otherwise or is of another length. Whether the path is used is decided by whoever asks; nothing here decides.

use crate::geometry::{Point, Vector, closest_on_segment};
use serde::{Deserialize, Serialize};

/// An arm's joints in metres, in one frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ArmJoints {
    /// The hand.
    pub hand: Point,
    /// The elbow.
    pub elbow: Point,
    /// The shoulder.
    pub shoulder: Point,
}

/// A way-point relative to an arm: part of the arm (0 hand to elbow, 1 elbow to shoulder), share of that part's length, and
/// offset in metres along the part, outwards (level, away from the body's middle for the right arm) and upwards.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct ArmRelative(pub u8, pub f64, pub [f64; 3]);

impl ArmRelative {
    /// True where the numbers can be those of a way-point near an arm.
    #[must_use]
    pub fn is_usable(&self) -> bool {
        self.0 <= 1 && (-1.0..=2.0).contains(&self.1) && self.2.iter().all(|offset| offset.abs() <= 0.5)
    }

    /// True where another way-point lies at the same place: the line between the two has no direction.
    #[must_use]
    pub fn is_at(&self, other: &Self) -> bool {
        let offsets = self.2.iter().zip(other.2);
        self.0 == other.0
            && (self.1 - other.1).abs() < SAME_PLACE
            && offsets.map(|(one, other)| (one - other).abs()).all(|apart| apart < SAME_PLACE)
    }
}

/// Shares and metres closer than this tell the same place.
const SAME_PLACE: f64 = 1e-6;

/// The directions of a part of an arm: along it, level across it, and upwards across it.
fn directions(start: &Point, end: &Point) -> Option<[Vector; 3]> {
    let along = (end - start).try_normalize(1e-6)?;
    // A part that stands upright has no level direction of its own: forward stands in for upward.
    let up = if along.z.abs() > 0.99 { Vector::x() } else { Vector::z() };
    let across = up.cross(&along).try_normalize(1e-6)?;
    Some([along, across, along.cross(&across)])
}

impl ArmJoints {
    fn part(&self, part: u8) -> [Point; 2] {
        if part == 0 { [self.hand, self.elbow] } else { [self.elbow, self.shoulder] }
    }

    /// A way-point relative to this arm; `None` where the arm has no length or a number is not finite.
    #[must_use]
    pub fn relative(&self, waypoint: &Point) -> Option<ArmRelative> {
        let distance = |part: u8| {
            let [start, end] = self.part(part);
            (closest_on_segment(waypoint, &start, &end) - waypoint).norm()
        };
        let part = u8::from(distance(1) < distance(0));
        let [start, end] = self.part(part);
        let nearest = closest_on_segment(waypoint, &start, &end);
        let share = (nearest - start).norm() / (end - start).norm();
        let offset = waypoint - nearest;
        let offsets = directions(&start, &end)?.map(|direction| direction.dot(&offset));
        (share.is_finite() && offsets.iter().all(|value| value.is_finite()))
            .then_some(ArmRelative(part, share, offsets))
    }

    /// The place of a relative way-point at this arm; `None` where the arm has no length.
    #[must_use]
    pub fn place(&self, waypoint: &ArmRelative) -> Option<Point> {
        let [start, end] = self.part(waypoint.0);
        let [along, across, up] = directions(&start, &end)?;
        let [lengthwise, outwards, upwards] = waypoint.2;
        Some(start + (end - start) * waypoint.1 + along * lengthwise + across * outwards + up * upwards)
    }
}

/// A learned path carried over from one position of an arm to another. The ends are those of the new arm where `path`
/// began at the hand and ended at the shoulder (within a centimetre). `None` where an arm has no length.
#[must_use]
pub fn carried_over(path: &[Point], from: &ArmJoints, to: &ArmJoints) -> Option<Vec<Point>> {
    path.iter().map(|waypoint| to.place(&from.relative(waypoint)?)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{Rotation3, Translation3};
    use proptest::prelude::*;

    fn arm() -> ArmJoints {
        ArmJoints {
            hand: Point::new(0.9, -0.35, 0.1),
            elbow: Point::new(0.75, -0.3, 0.15),
            shoulder: Point::new(0.6, -0.2, 0.35),
        }
    }

    fn path() -> Vec<Point> {
        let arm = arm();
        vec![arm.hand, Point::new(0.82, -0.37, 0.16), arm.elbow, Point::new(0.68, -0.3, 0.28), arm.shoulder]
    }

    #[test]
    fn on_the_same_arm_the_path_stays() {
        let carried = carried_over(&path(), &arm(), &arm()).unwrap();
        for (before, after) in path().iter().zip(&carried) {
            assert!((before - after).norm() < 1e-12);
        }
    }

    #[test]
    fn an_arm_that_was_moved_and_turned_takes_its_path_along() {
        let turn = Rotation3::from_axis_angle(&Vector::z_axis(), 0.4);
        let shift = Translation3::new(0.1, 0.05, -0.08);
        let move_point = |point: &Point| shift * (turn * point);
        let moved = ArmJoints {
            hand: move_point(&arm().hand),
            elbow: move_point(&arm().elbow),
            shoulder: move_point(&arm().shoulder),
        };
        let carried = carried_over(&path(), &arm(), &moved).unwrap();
        for (before, after) in path().iter().map(move_point).zip(&carried) {
            assert!((before - after).norm() < 1e-9);
        }
    }

    #[test]
    fn ends_go_to_the_new_hand_and_shoulder() {
        let other = ArmJoints { hand: Point::new(0.8, -0.5, 0.0), ..arm() };
        let carried = carried_over(&path(), &arm(), &other).unwrap();
        assert!((carried[0] - other.hand).norm() < 1e-12);
        assert!((carried[4] - other.shoulder).norm() < 1e-12);
    }

    #[test]
    fn an_arm_without_length_carries_nothing() {
        let nothing = ArmJoints { hand: Point::origin(), elbow: Point::origin(), shoulder: Point::origin() };
        assert_eq!(carried_over(&path(), &nothing, &arm()), None);
        assert_eq!(carried_over(&path(), &arm(), &nothing), None);
    }

    proptest! {
        #[test]
        fn a_point_near_an_arm_returns_to_its_place(offset in prop::array::uniform3(-0.1..0.1), share in 0.0..1.0_f64) {
            let point = arm().hand + (arm().shoulder - arm().hand) * share + Vector::from(offset);
            let relative = arm().relative(&point).unwrap();
            prop_assert!(relative.is_usable());
            prop_assert!((arm().place(&relative).unwrap() - point).norm() < 1e-9);
        }

        #[test]
        fn a_point_keeps_its_distance_from_an_arm_that_bends_otherwise(
            offset in prop::array::uniform3(-0.05..0.05), bend in prop::array::uniform3(-0.1..0.1)
        ) {
            let point = arm().elbow + (arm().shoulder - arm().elbow) * 0.5 + Vector::from(offset);
            let bent = ArmJoints { elbow: arm().elbow + Vector::from(bend), ..arm() };
            let relative = arm().relative(&point).unwrap();
            prop_assume!(relative.0 == 1);
            let place = bent.place(&relative).unwrap();
            let length = Vector::from(relative.2).norm();
            let nearest = bent.elbow + (bent.shoulder - bent.elbow) * relative.1;
            prop_assert!(((place - nearest).norm() - length).abs() < 1e-9);
        }
    }
}
