use super::*;
use proptest::prelude::*;

fn knots() -> impl Strategy<Value = Vec<JointVector>> {
    proptest::collection::vec(proptest::array::uniform7(-2.0..2.0_f64).prop_map(JointVector::from), 2..12)
}

proptest! {
    #[test]
    fn the_way_goes_through_its_knots(knots in knots()) {
        let path = JointPath::through(knots.clone()).unwrap();
        let spans = (knots.len() - 1) as f64;
        for (index, knot) in knots.iter().enumerate() {
            prop_assert!((path.at(index as f64 / spans).joints - knot).amax() < 1e-9);
        }
    }

    #[test]
    fn slope_and_curvature_are_the_derivatives(knots in knots(), share in 0.01..0.99_f64) {
        let path = JointPath::through(knots.clone()).unwrap();
        let step = 1e-6;
        let (before, here, after) = (path.at(share - step), path.at(share), path.at(share + step));
        let scale = 1.0 + here.curvature.amax();
        prop_assert!(((after.joints - before.joints) / (2.0 * step) - here.slope).amax() < 1e-4 * scale);
        prop_assert!((after.slope - here.slope - (here.slope - before.slope)).amax() < 1e-3 * scale);
    }

    #[test]
    fn position_speed_and_acceleration_do_not_jump_at_a_knot(knots in knots()) {
        let path = JointPath::through(knots.clone()).unwrap();
        let spans = (knots.len() - 1) as f64;
        for index in 1..knots.len() - 1 {
            let share = index as f64 / spans;
            let (before, after) = (path.at(share - 1e-9), path.at(share + 1e-9));
            let scale = 1.0 + path.curvature.iter().map(JointVector::amax).fold(0.0, f64::max);
            prop_assert!((after.slope - before.slope).amax() < 1e-6 * scale);
            prop_assert!((after.curvature - before.curvature).amax() < 1e-6 * scale);
        }
    }
}

#[test]
fn a_single_knot_stays_and_no_knot_is_no_way() {
    let only = JointVector::repeat(0.3);
    let path = JointPath::through(vec![only]).unwrap();
    for share in [0.0, 0.4, 1.0] {
        assert_eq!(path.at(share).joints, only);
        assert_eq!(path.at(share).slope, JointVector::zeros());
    }
    assert_eq!(JointPath::through(Vec::new()), None);
}

#[test]
fn two_knots_make_a_straight_way_and_beyond_the_ends_are_the_ends() {
    let path = JointPath::through(vec![JointVector::zeros(), JointVector::repeat(2.0)]).unwrap();
    assert!((path.at(0.25).joints - JointVector::repeat(0.5)).amax() < 1e-12);
    assert_eq!(path.at(-1.0).joints, JointVector::zeros());
    assert!((path.at(7.0).joints - JointVector::repeat(2.0)).amax() < 1e-12);
}
