//! The window against golden vectors of an independent reference, and against every kind of broken stream.

use super::*;
use proptest::prelude::*;
use serde::Deserialize;

#[derive(Deserialize)]
struct Golden {
    tolerance: f64,
    cases: Vec<Case>,
}

#[derive(Deserialize)]
#[serde(rename_all = "snake_case")]
struct Case {
    name: String,
    series: Vec<[f64; 3]>,
    #[serde(rename = "F")]
    combined: Vec<Option<f64>>,
    #[serde(rename = "F_axis_last")]
    axes_last: [f64; 3],
    first_alarm_tau5: Alarms,
}

#[derive(Deserialize)]
struct Alarms {
    magnitude: Option<usize>,
    axis: Option<usize>,
    vector: Option<usize>,
}

fn golden() -> Golden {
    serde_json::from_str(include_str!("../../../tests/vectors/force.json")).unwrap()
}

fn window(form: WindowForm) -> ForceWindow {
    ForceWindow::new(WindowSettings { form, ..WindowSettings::default() }).unwrap()
}

fn stamp(index: usize) -> Stamp {
    Stamp::from_nanoseconds(1_000_000_000 + index as u64 * 10_000_000)
}

fn first_alarm(series: &[[f64; 3]], form: WindowForm) -> Option<usize> {
    let mut window = window(form);
    series.iter().enumerate().position(|(index, force)| {
        window.push(stamp(index), Vector::from(*force));
        window.detect().is_some()
    })
}

#[test]
fn every_form_alarms_where_the_reference_does() {
    for case in golden().cases {
        let expected = &case.first_alarm_tau5;
        for (form, index) in [
            (WindowForm::Magnitude, expected.magnitude),
            (WindowForm::Axis, expected.axis),
            (WindowForm::Vector, expected.vector),
        ] {
            assert_eq!(first_alarm(&case.series, form), index, "{} {form:?}", case.name);
        }
    }
}

#[test]
fn the_magnitude_form_is_the_sum_that_the_thesis_prints() {
    let golden = golden();
    for case in golden.cases {
        let mut window = window(WindowForm::Magnitude);
        for (index, (force, expected)) in case.series.iter().zip(&case.combined).enumerate() {
            let reading = window.push(stamp(index), Vector::from(*force)).map(|reading| reading.combined);
            match (reading, expected) {
                (Some(reading), Some(expected)) => assert!((reading - expected).abs() <= golden.tolerance),
                (reading, expected) => assert_eq!(reading, *expected, "{} at {index}", case.name),
            }
        }
        let axes = window.reading().unwrap().axes;
        assert!((axes - Vector::from(case.axes_last)).norm() <= golden.tolerance, "{}", case.name);
    }
}

/// A full window of one steady force, the next sample being due at index 16.
fn full() -> ForceWindow {
    let mut window = window(WindowForm::Vector);
    for index in 0..16 {
        window.push(stamp(index), Vector::zeros());
    }
    assert_eq!(window.filled(), 15);
    window
}

#[test]
fn s_20_a_missing_sample_empties_the_window_and_does_not_shorten_it() {
    let mut window = full();
    assert_eq!(window.push(stamp(17), Vector::new(9.0, 0.0, 0.0)), None);
    assert_eq!(window.filled(), 0);
    assert!(matches!(window.last_break(), Some(BreakCause::Gap { seconds }) if (seconds - 0.02).abs() < 1e-9));
    for index in 18..32 {
        assert_eq!(window.push(stamp(index), Vector::zeros()), None);
    }
    assert!(window.push(stamp(32), Vector::zeros()).is_some());
}

#[test]
fn a_little_jitter_is_borne_and_a_late_sample_is_not() {
    let mut window = full();
    assert!(window.push(stamp(16) + std::time::Duration::from_millis(4), Vector::zeros()).is_some());
    let mut window = full();
    assert!(window.push(stamp(16) + std::time::Duration::from_millis(6), Vector::zeros()).is_none());
}

#[test]
fn samples_that_come_too_close_break_it_as_well() {
    let mut window = full();
    assert!(window.push(stamp(15) + std::time::Duration::from_millis(3), Vector::zeros()).is_none());
}

#[test]
fn the_same_message_twice_changes_nothing() {
    let mut window = full();
    let before = window.reading();
    assert_eq!(window.push(stamp(15), Vector::zeros()), before);
    assert_eq!(window.filled(), 15);
}

#[test]
fn an_older_sample_and_a_second_force_for_the_same_moment_break_it() {
    for (index, force) in [(9, Vector::zeros()), (15, Vector::x())] {
        let mut window = full();
        assert_eq!(window.push(stamp(index), force), None);
        assert_eq!(window.last_break(), Some(BreakCause::Reordered));
    }
}

#[test]
fn s_20_a_number_that_is_not_finite_leaves_nothing_behind() {
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        let mut window = full();
        assert_eq!(window.push(stamp(16), Vector::new(0.0, bad, 0.0)), None);
        assert_eq!((window.filled(), window.last_break()), (0, Some(BreakCause::NotFinite)));
        assert!(window.detect().is_none());
    }
}

#[test]
fn settings_out_of_range_are_refused_by_name() {
    let refused = |settings: WindowSettings| ForceWindow::new(settings).unwrap_err().key;
    let usual = WindowSettings::default();
    assert_eq!(refused(WindowSettings { length: 0, ..usual }), "length");
    assert_eq!(refused(WindowSettings { rate_hertz: f64::NAN, ..usual }), "rate_hertz");
    assert_eq!(refused(WindowSettings { threshold_newtons: 20.0, ..usual }), "threshold_newtons");
    assert_eq!(refused(WindowSettings { late_tolerance: 1.0, ..usual }), "late_tolerance");
}

proptest! {
    #[test]
    fn a_steady_bias_never_shows(bias in [-30.0..30.0_f64, -30.0..30.0, -30.0..30.0], moves in proptest::collection::vec([-3.0..3.0_f64, -3.0..3.0, -3.0..3.0], 16..60)) {
        for form in [WindowForm::Axis, WindowForm::Vector] {
            let (mut plain, mut biased) = (window(form), window(form));
            for (index, force) in moves.iter().enumerate() {
                let force = Vector::from(*force);
                let (plain, biased) = (plain.push(stamp(index), force), biased.push(stamp(index), force + Vector::from(bias)));
                prop_assert_eq!(plain.is_some(), biased.is_some());
                if let (Some(plain), Some(biased)) = (plain, biased) {
                    prop_assert!((plain.combined - biased.combined).abs() < 1e-9);
                }
            }
        }
    }

    #[test]
    fn the_vector_form_does_not_depend_on_the_axes(forces in proptest::collection::vec([-9.0..9.0_f64, -9.0..9.0, -9.0..9.0], 16..40), angle in 0.0..6.0_f64) {
        let turn = nalgebra::UnitQuaternion::from_euler_angles(angle, angle / 2.0, -angle);
        let (mut plain, mut turned) = (window(WindowForm::Vector), window(WindowForm::Vector));
        for (index, force) in forces.iter().enumerate() {
            plain.push(stamp(index), Vector::from(*force));
            turned.push(stamp(index), turn * Vector::from(*force));
        }
        prop_assert!((plain.reading().unwrap().combined - turned.reading().unwrap().combined).abs() < 1e-9);
    }

    #[test]
    fn no_ramp_below_33_newtons_a_second_is_ever_seen(rate in 0.0..33.3_f64) {
        let mut window = window(WindowForm::Vector);
        for index in 0..200 {
            window.push(stamp(index), Vector::new(rate * index as f64 * 0.01, 0.0, 0.0));
            prop_assert!(window.detect().is_none());
        }
    }

    #[test]
    fn whatever_the_stream_a_reading_spans_its_full_length(gaps in proptest::collection::vec(0_u64..30_000_000, 1..120)) {
        let mut window = window(WindowForm::Vector);
        let mut now = 0;
        for gap in gaps {
            now += gap;
            let reading = window.push(Stamp::from_nanoseconds(now), Vector::new(gap as f64, 0.0, 0.0));
            prop_assert_eq!(reading.is_some(), window.filled() == 15);
        }
    }
}
