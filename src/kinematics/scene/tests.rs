use super::*;
use crate::body::Evidence;
use nalgebra::Matrix3;
use proptest::prelude::*;

fn any_point() -> impl Strategy<Value = Point> {
    [-1.0..1.0, -1.0..1.0, -1.0..1.0_f64].prop_map(|[x, y, z]| Point::new(x, y, z))
}

fn any_capsule() -> impl Strategy<Value = Capsule> {
    (any_point(), any_point(), 0.0..0.3_f64).prop_map(|(start, end, radius)| Capsule { start, end, radius })
}

proptest! {
    #[test]
    fn no_two_points_of_the_axes_are_closer_than_the_distance_says(
        one in any_capsule(), other in any_capsule(), share in 0.0..1.0_f64, other_share in 0.0..1.0_f64,
    ) {
        let point = one.start + (one.end - one.start) * share;
        let opposite = other.start + (other.end - other.start) * other_share;
        let axes = one.distance(&other) + one.radius + other.radius;
        prop_assert!(axes <= (point - opposite).norm() + 1e-12);
    }

    #[test]
    fn the_distance_is_reached_by_some_pair_of_points(one in any_capsule(), other in any_capsule()) {
        // Alternating projection between two convex sets converges to their distance.
        let mut point = one.start;
        for _ in 0..20_000 {
            let opposite = crate::geometry::closest_on_segment(&point, &other.start, &other.end);
            point = crate::geometry::closest_on_segment(&opposite, &one.start, &one.end);
        }
        let opposite = crate::geometry::closest_on_segment(&point, &other.start, &other.end);
        let axes = one.distance(&other) + one.radius + other.radius;
        prop_assert!((axes - (point - opposite).norm()).abs() < 1e-5);
    }

    #[test]
    fn the_distance_does_not_depend_on_the_order(one in any_capsule(), other in any_capsule()) {
        prop_assert!((one.distance(&other) - other.distance(&one)).abs() < 1e-9);
    }
}

#[test]
fn known_distances_come_out() {
    let along_x = Capsule { start: Point::origin(), end: Point::new(1.0, 0.0, 0.0), radius: 0.1 };
    let crossing = Capsule { start: Point::new(0.5, -1.0, 0.5), end: Point::new(0.5, 1.0, 0.5), radius: 0.2 };
    let parallel = Capsule { start: Point::new(0.2, 0.4, 0.0), end: Point::new(0.8, 0.4, 0.0), radius: 0.0 };
    let beyond = Capsule::sphere(Point::new(1.5, 0.0, 0.0), 0.1);
    assert!((along_x.distance(&crossing) - 0.2).abs() < 1e-12);
    assert!((along_x.distance(&parallel) - 0.3).abs() < 1e-12);
    assert!((along_x.distance(&beyond) - 0.3).abs() < 1e-12);
    assert!((beyond.distance(&along_x) - 0.3).abs() < 1e-12);
    assert!((beyond.distance(&beyond) + 0.2).abs() < 1e-12);
}

fn estimate(x: f64, y: f64, z: f64, deviation: f64) -> JointEstimate {
    JointEstimate {
        position: Point::new(x, y, z),
        covariance: Matrix3::from_diagonal(&nalgebra::Vector3::new(deviation * deviation, 0.0, 0.0)),
        confidence: 1.0,
        evidence: Evidence::Seen,
    }
}

fn person() -> BodyPose {
    let mut body = BodyPose { neck: Some(estimate(0.8, 0.0, 0.3, 0.0)), ..BodyPose::default() };
    for (side, sign) in [(Side::Left, 1.0), (Side::Right, -1.0)] {
        let arm = body.arms.get_mut(side);
        arm.set(Joint::Shoulder, Some(estimate(0.8, sign * 0.2, 0.2, 0.0)));
        arm.set(Joint::Elbow, Some(estimate(0.8, sign * 0.4, 0.0, 0.01)));
        arm.set(Joint::Hand, Some(estimate(0.75, sign * 0.55, -0.1, 0.0)));
    }
    body
}

#[test]
fn the_arm_that_is_dressed_is_left_out_and_the_rest_is_there() {
    let scene = Scene::around(&person(), &BodyBuild::default(), &PerSide { left: false, right: true });
    let names: Vec<_> = scene.person.iter().map(|part| part.name.as_str()).collect();
    assert_eq!(
        names,
        ["the person's left forearm", "the person's left upper arm", "the person's trunk", "the person's head"]
    );
}

#[test]
fn an_uncertain_joint_makes_its_parts_thicker() {
    let scene = Scene::around(&person(), &BodyBuild::default(), &PerSide { left: false, right: true });
    assert!((scene.person[0].shape.radius - 0.065).abs() < 1e-12);
}

#[test]
fn a_part_with_an_unknown_end_is_not_there() {
    let mut body = person();
    body.neck = None;
    body.arms.left.set(Joint::Hand, None);
    let scene = Scene::around(&body, &BodyBuild::default(), &PerSide { left: false, right: true });
    assert_eq!(scene.person.len(), 1);
    assert_eq!(scene.person[0].name, "the person's left upper arm");
}
