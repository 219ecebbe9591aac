//! The filter against golden vectors, and what its bounded freeze is for.

use super::*;
use proptest::prelude::*;
use serde::Deserialize;

#[derive(Deserialize)]
struct Golden {
    cases: Vec<Case>,
}

#[derive(Deserialize)]
struct Case {
    name: String,
    series: Vec<[f64; 3]>,
    two_rate_contact: Vec<bool>,
    two_rate_change_last: [f64; 3],
}

#[test]
fn contact_and_change_are_those_of_the_reference() {
    let golden: Golden = serde_json::from_str(include_str!("../../../tests/vectors/force.json")).unwrap();
    for case in golden.cases {
        let mut filter = TwoRate::new(TwoRateSettings::default()).unwrap();
        for (index, (force, contact)) in case.series.iter().zip(&case.two_rate_contact).enumerate() {
            let reading = filter.push(Vector::from(*force), 0.01);
            assert_eq!(reading.contact, *contact, "{} at {index}", case.name);
        }
        let change = filter.reading().change;
        assert!((change - Vector::from(case.two_rate_change_last)).norm() < 1e-9, "{}: {change}", case.name);
    }
}

fn seconds_of_contact(freeze_seconds: f64) -> f64 {
    let settings = TwoRateSettings { freeze_seconds, ..TwoRateSettings::default() };
    let mut filter = TwoRate::new(settings).unwrap();
    filter.push(Vector::zeros(), 0.01);
    let contacts = (0..3000).filter(|_| filter.push(Vector::new(8.0, 0.0, 0.0), 0.01).contact).count();
    contacts as f64 * 0.01
}

#[test]
fn a_lasting_change_of_bias_is_not_held_as_contact_for_ever() {
    let (free, frozen) = (seconds_of_contact(0.0), seconds_of_contact(3.0));
    assert!(frozen > free + 2.5 && frozen < free + 3.5, "free {free} s, frozen {frozen} s");
}

#[test]
fn what_is_no_number_empties_it() {
    let mut filter = TwoRate::new(TwoRateSettings::default()).unwrap();
    filter.push(Vector::zeros(), 0.01);
    for (force, seconds) in [(Vector::new(f64::NAN, 0.0, 0.0), 0.01), (Vector::x(), f64::NAN), (Vector::x(), -1.0)] {
        filter.push(Vector::new(9.0, 0.0, 0.0), 0.2);
        assert_eq!(filter.push(force, seconds), TwoRateReading::default());
        assert_eq!(filter.push(Vector::x() * 50.0, 0.01).change, Vector::zeros(), "the next force is its own mean");
    }
}

#[test]
fn settings_out_of_range_are_refused_by_name() {
    let usual = TwoRateSettings::default();
    let refused = |settings: TwoRateSettings| TwoRate::new(settings).unwrap_err().key;
    assert_eq!(refused(TwoRateSettings { fast_seconds: 0.0, ..usual }), "fast_seconds");
    assert_eq!(refused(TwoRateSettings { slow_seconds: 0.05, ..usual }), "slow_seconds");
    assert_eq!(refused(TwoRateSettings { threshold_newtons: f64::INFINITY, ..usual }), "threshold_newtons");
    assert_eq!(refused(TwoRateSettings { release_share: 0.0, ..usual }), "release_share");
    assert_eq!(refused(TwoRateSettings { freeze_seconds: 60.0, ..usual }), "freeze_seconds");
}

proptest! {
    #[test]
    fn a_bias_that_is_there_from_the_start_never_shows(x in -40.0..40.0_f64, y in -40.0..40.0_f64) {
        let mut filter = TwoRate::new(TwoRateSettings::default()).unwrap();
        for _ in 0..300 {
            prop_assert!(!filter.push(Vector::new(x, y, 0.0), 0.01).contact);
        }
    }

    #[test]
    fn twenty_newtons_a_second_is_found_before_ten_newtons(angle in 0.0..6.0_f64) {
        let mut filter = TwoRate::new(TwoRateSettings::default()).unwrap();
        let way = Vector::new(angle.cos(), angle.sin(), 0.0);
        let found = (0..50).find(|index| filter.push(way * (0.2 * f64::from(*index)), 0.01).contact);
        prop_assert!(found.is_some());
    }
}
