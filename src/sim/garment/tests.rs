use super::*;

/// The force at which the guard pauses a trial by default, in newtons.
const PAUSE: f64 = 15.0;

/// What the back pulls at each gripper when the grippers are so far apart, in newtons.
fn pull(sizes: &GarmentSizes, metres: f64) -> f64 {
    let holder = |y: f64| Holder { tip: Point::new(0.6, y, 0.1), velocity: Vector::zeros() };
    let holders = PerSide { left: holder(metres), right: holder(0.0) };
    let forces = sizes.back_forces(&holders, &PerSide::default());
    assert!((forces.left + forces.right).norm() < 1e-12, "both grippers feel the same");
    forces.left.norm()
}

#[test]
fn up_to_its_largest_gripper_distance_a_garment_is_slack_and_the_pause_comes_a_tenth_of_a_metre_later() {
    let sizes = GarmentSizes::default();
    assert!((sizes.slack_metres() - 0.90).abs() < 1e-12);
    assert!(pull(&sizes, 0.90) < 1e-12);
    assert!(pull(&sizes, 1.00) < PAUSE && pull(&sizes, 1.02) > PAUSE);
}

#[test]
fn a_narrow_back_would_pull_far_beyond_the_pause_at_the_usual_garments_distance() {
    let narrow = GarmentSizes { back_reach_metres: 0.45, ..GarmentSizes::default() };
    assert!((pull(&narrow, 0.90) - 67.5).abs() < 0.01);
    assert!(pull(&narrow, narrow.slack_metres()) < 1e-12, "its own limit is slack");
}
