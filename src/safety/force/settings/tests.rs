//! What settings of the force guard are refused, and what is expected along an arm.

use super::*;

fn refused(change: impl FnOnce(&mut GuardSettings)) -> String {
    let mut settings = GuardSettings::default();
    change(&mut settings);
    settings.validate().unwrap_err().to_string()
}

#[test]
fn the_defaults_can_be_used() {
    assert_eq!(GuardSettings::default().validate(), Ok(()));
}

#[test]
fn tiers_out_of_order_or_beyond_a_cap_are_refused() {
    assert!(refused(|settings| settings.tiers.stop = 35.1).contains("at most 35 N"));
    assert!(refused(|settings| settings.tiers.pause = 11.0).contains("above 12 N"));
    assert!(refused(|settings| settings.tiers.advise = f64::NAN).contains("advise"));
    assert!(refused(|settings| settings.tiers.pause = 25.5).contains("at most 25 N"));
}

#[test]
fn every_number_has_a_range() {
    assert!(refused(|settings| settings.unknown_mass_kilograms = -1.0).contains("unknown_mass"));
    assert!(refused(|settings| settings.catch.newtons_per_metre = f64::INFINITY).contains("newtons_per_metre"));
    assert!(refused(|settings| settings.hard_catch.least_newtons = 9.0).contains("least_newtons"));
    assert!(refused(|settings| settings.catch.expected_share = 1.1).contains("expected_share"));
    assert!(refused(|settings| settings.catch.window_metres = 0.0).contains("window_metres"));
    assert!(refused(|settings| settings.work_free_newtons = f64::NAN).contains("work_free"));
    assert!(refused(|settings| settings.work_joules = 9.0).contains("work_joules"));
    assert!(refused(|settings| settings.catch_reaction = Reaction::Clear).contains("slow, hold or stop"));
}

#[test]
fn what_is_expected_lies_on_straight_lines_and_has_a_most() {
    let expected = ExpectedPull::default();
    for (metres, newtons) in [(-1.0, 0.25), (0.0, 0.25), (9.0, 9.7)] {
        assert!((expected.at(metres) - newtons).abs() < 1e-12, "{metres}");
    }
    assert!((expected.at(0.25) - 3.3).abs() < 1e-9, "half-way from 2.1 to 4.5 N");
    assert!(ExpectedPull::none().at(0.3).abs() < 1e-12);
    let refused_points = |points: &[[f64; 2]]| refused(|settings| settings.expected = ExpectedPull(points.to_vec()));
    assert!(refused_points(&[[0.0, 12.1]]).contains("from 0 to 12 N"));
    assert!(refused_points(&[[0.0, f64::NAN]]).contains("from 0 to 12 N"));
    assert!(refused_points(&[[0.1, 1.0], [0.1, 2.0]]).contains("rises"));
    assert!(refused_points(&[[f64::NAN, 1.0]]).contains("rises"));
}

#[test]
fn a_place_near_shoulder_or_neck_is_in_the_halved_zone() {
    let shoulder = Point::new(0.0, 0.2, 0.3);
    assert_eq!(Zone::of(&Point::new(0.0, 0.2, 0.2), [shoulder]), Zone::ShoulderOrNeck);
    assert_eq!(Zone::of(&Point::new(0.0, 0.2, 0.1), [shoulder]), Zone::Arm);
    assert_eq!(Zone::of(&shoulder, []), Zone::Arm);
}

#[test]
fn settings_survive_the_way_through_a_file_and_unknown_keys_are_refused() {
    let settings = GuardSettings::default();
    let text = toml::to_string(&settings).unwrap();
    assert_eq!(toml::from_str::<GuardSettings>(&text).unwrap(), settings);
    assert!(toml::from_str::<GuardSettings>("work = 3.0").is_err());
}
