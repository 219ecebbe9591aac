use super::super::random::{Purpose, Random};
use super::reaction::Pull;
use super::*;
use crate::geometry::{Vector, closest_on_polyline};
use proptest::prelude::*;

fn points(person: &SimulatedPerson, side: Side) -> ArmPoints {
    *person.posture().get(side)
}

#[test]
fn the_default_person_can_be_and_looks_away_with_the_right_arm_on_the_right() {
    let person = SimulatedPerson::default();
    person.check().unwrap();
    let right = points(&person, Side::Right);
    assert!(right.hand.y < right.elbow.y && right.elbow.y < right.shoulder.y && right.shoulder.y < 0.0);
    assert!(right.hand.z < right.shoulder.z);
}

#[test]
fn the_left_arm_mirrors_the_right_one_unless_it_is_given() {
    let mut person = SimulatedPerson::default();
    let (left, right) = (points(&person, Side::Left), points(&person, Side::Right));
    for (left, right) in left.dressed().into_iter().zip(right.dressed()) {
        assert!(
            (left.x - right.x).abs() < 1e-12 && (left.y + right.y).abs() < 1e-12 && (left.z - right.z).abs() < 1e-12
        );
    }
    let posture = ArmAngles { elbow_degrees: 80.0, ..ArmAngles::default() };
    person.left = Some(SimulatedArm { posture, ..SimulatedArm::default() });
    assert_ne!(points(&person, Side::Left).hand, left.hand);
}

#[test]
fn sizes_of_the_median_woman_are_those_of_the_survey() {
    // ANSUR II, women: upper arm 311.2 mm, forearm 241.3 mm, hand 181.1 mm on average.
    let sizes = BodySizes::default().arm_sizes();
    assert!((sizes.upper_arm_metres - 0.311).abs() < 0.002);
    assert!((sizes.forearm_metres - 0.241).abs() < 0.002);
    assert!((sizes.hand_metres - 0.181).abs() < 0.002);
    assert!((sizes.upper_arm_radius_metres - 0.048).abs() < 0.002);
}

#[test]
fn drawn_bodies_can_be_and_spread_as_in_the_survey() {
    let bodies: Vec<BodySizes> = (0..500).map(|seed| BodySizes::sampled(Sex::Male, seed)).collect();
    for body in &bodies {
        body.check().unwrap();
    }
    let arms: Vec<f64> = bodies.iter().map(|body| body.arm_sizes().upper_arm_metres).collect();
    let mean = arms.iter().sum::<f64>() / 500.0;
    let deviation = (arms.iter().map(|arm| (arm - mean).powi(2)).sum::<f64>() / 500.0).sqrt();
    assert!((mean - 0.3352).abs() < 0.003, "{mean}");
    assert!((deviation - 0.0175).abs() < 0.003, "{deviation}");
}

#[test]
fn a_person_that_cannot_be_is_refused_with_key_value_and_range() {
    let giant =
        SimulatedPerson { body: BodySizes { stature_metres: 2.6, ..BodySizes::default() }, ..Default::default() };
    let message = giant.check().unwrap_err().to_string();
    assert!(message.contains("stature_metres") && message.contains("2.6") && message.contains("2.1"), "{message}");

    let mut person = SimulatedPerson::default();
    person.right.posture.elbow_degrees = 170.0;
    assert!(person.check().unwrap_err().to_string().contains("right.posture.elbow_degrees"));

    let mut person = SimulatedPerson::default();
    person.right.response.yield_share = f64::NAN;
    assert!(person.check().is_err());

    let mut person = SimulatedPerson::default();
    (person.right.posture.plane_degrees, person.right.posture.elevation_degrees) = (-80.0, 100.0);
    assert!(matches!(person.check(), Err(PersonError::Contradiction { .. })));
}

#[test]
fn a_person_is_the_same_after_toml() {
    let left = SimulatedArm { preferred_offset_metres: [0.0, 0.01, 0.02], ..SimulatedArm::default() };
    let person = SimulatedPerson { left: Some(left), ..SimulatedPerson::default() };
    let text = toml::to_string(&person).unwrap();
    assert_eq!(toml::from_str::<SimulatedPerson>(&text).unwrap(), person);
    assert!(toml::from_str::<SimulatedPerson>("weight = 3").is_err());
}

fn reaction() -> Reaction {
    let person = SimulatedPerson::default();
    let response = Response { path_jitter_metres: 0.0, ..Response::default() };
    Reaction::new(response, person.preferred_path(Side::Right), Random::new(1, Purpose::RightArm))
}

#[test]
fn an_arm_stiffens_after_its_reaction_time_and_not_before() {
    let mut reaction = reaction();
    let pull = Pull { excess: Vector::new(0.0, 0.0, 0.02), speed: 0.1, advancing: true };
    let forces: Vec<f64> = (0..30).map(|_| reaction.react(&pull, 0.01).z).collect();
    assert!(forces[..15].iter().all(|force| *force == 0.0));
    // 170 N/s over 50 ms.
    assert!((forces[20] - forces[15] - 8.5).abs() < 1.8, "{forces:?}");
    assert!(forces.iter().all(|force| *force <= 15.0));
}

#[test]
fn a_person_gives_way_once_a_stop_and_keeps_a_share() {
    let mut reaction = reaction();
    let excess = Vector::new(0.0, 0.0, 0.02);
    let still = Pull { excess, speed: 0.0, advancing: false };
    for _ in 0..100 {
        reaction.react(&still, 0.01);
    }
    let given = reaction.displacement();
    assert!((given + excess * 0.25).norm() < 1e-12, "towards the gripper, once: {given:?}");
    reaction.end_pass();
    assert!((reaction.displacement() - given * 0.4).norm() < 1e-12);
}

#[test]
fn a_startled_arm_moves_no_faster_than_an_arm_can() {
    let mut reaction = reaction();
    reaction.pull_away(Vector::new(0.1, 0.0, 0.0));
    reaction.react(&Pull::default(), 0.01);
    assert!((reaction.displacement().x - 0.004).abs() < 1e-12);
    for _ in 0..100 {
        reaction.react(&Pull::default(), 0.01);
    }
    assert!((reaction.displacement().x - 0.1).abs() < 1e-12);
}

proptest! {
    #[test]
    fn an_arms_lengths_do_not_depend_on_its_posture(
        elevation in 0.0..180.0_f64, plane in -90.0..135.0_f64, rotation in -104.0..104.0_f64, elbow in 0.0..150.0_f64,
        left: bool,
    ) {
        let sizes = BodySizes::default().arm_sizes();
        let posture = ArmAngles {
            elevation_degrees: elevation, plane_degrees: plane, rotation_degrees: rotation, elbow_degrees: elbow,
        };
        let side = if left { Side::Left } else { Side::Right };
        let arm = posture.points(side, &Point::new(0.8, 0.2, 0.2), &sizes);
        prop_assert!(((arm.elbow - arm.shoulder).norm() - sizes.upper_arm_metres).abs() < 1e-9);
        prop_assert!(((arm.wrist - arm.elbow).norm() - sizes.forearm_metres).abs() < 1e-9);
        // The elbow's angle is the one that was asked for.
        let angle = (arm.wrist - arm.elbow).angle(&(arm.elbow - arm.shoulder)).to_degrees();
        prop_assert!((angle - elbow).abs() < 1e-4);
    }

    #[test]
    fn a_preferred_path_keeps_its_ends_and_its_offset(x in -0.1..0.1_f64, y in -0.1..0.1_f64, z in -0.1..0.1_f64) {
        let mut person = SimulatedPerson::default();
        person.right.preferred_offset_metres = [x, y, z];
        let straight = points(&person, Side::Right).dressed();
        let path = person.preferred_path(Side::Right);
        prop_assert!((path[0] - straight[0]).norm() < 1e-9);
        prop_assert!((path.last().unwrap() - straight[2]).norm() < 1e-9);
        let offset = Vector::new(x, -y, z).norm();
        for point in &path {
            let distance = (point - closest_on_polyline(point, &straight).unwrap()).norm();
            prop_assert!(distance <= offset + 1e-9);
        }
    }
}
