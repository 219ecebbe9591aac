use super::*;
use proptest::prelude::*;

fn any_limits() -> impl Strategy<Value = PathLimits> {
    (0.05..2.0_f64, 0.1..10.0_f64, 0.5..50.0_f64).prop_map(|(speed, acceleration, jerk)| PathLimits {
        speed,
        acceleration,
        jerk,
    })
}

/// Checks a profile at many moments: bounds, and that acceleration changes no faster than the jerk allows.
fn keeps(timing: &PathTiming, limits: &PathLimits) {
    let steps = 400;
    let width = timing.seconds() / f64::from(steps);
    let mut before = timing.at(0.0);
    for index in 1..=steps {
        let here = timing.at(width * f64::from(index));
        assert!(here.parameter >= before.parameter - 1e-9, "never backwards");
        assert!(here.speed <= limits.speed * (1.0 + 1e-6));
        assert!(here.acceleration.abs() <= limits.acceleration * (1.0 + 1e-6));
        assert!((here.acceleration - before.acceleration).abs() <= limits.jerk * width * (1.0 + 1e-6) + 1e-6);
        before = here;
    }
}

proptest! {
    #[test]
    fn a_profile_goes_from_rest_to_rest_inside_its_limits(limits in any_limits(), minimum in 0.0..5.0_f64) {
        let timing = PathTiming::rest_to_rest(&limits, minimum).unwrap();
        prop_assert!(timing.seconds() >= minimum - 1e-9);
        let (start, end) = (timing.at(0.0), timing.at(timing.seconds()));
        prop_assert!(start.parameter.abs() < 1e-9 && start.speed.abs() < 1e-9);
        prop_assert!((end.parameter - 1.0).abs() < 1e-7 && end.speed.abs() < 1e-6);
        keeps(&timing, &limits);
    }

    #[test]
    fn a_stop_from_anywhere_ends_at_rest_on_the_path_inside_the_limits(
        limits in any_limits(), minimum in 0.0..5.0_f64, share in 0.0..1.0_f64,
    ) {
        let timing = PathTiming::rest_to_rest(&limits, minimum).unwrap();
        let state = timing.at(timing.seconds() * share);
        let stop = PathTiming::stop(&state, &limits).unwrap();
        let (start, end) = (stop.at(0.0), stop.at(stop.seconds()));
        prop_assert!((start.parameter - state.parameter).abs() < 1e-9);
        prop_assert!((start.speed - state.speed).abs() < 1e-9);
        prop_assert!(end.speed.abs() < 1e-6);
        prop_assert!(end.parameter <= 1.0);
        prop_assert!(stop.seconds() <= timing.seconds() * (1.0 - share) + 1e-6, "a stop takes no longer than the rest of the way");
        keeps(&stop, &limits);
    }
}

#[test]
fn limits_that_are_no_limits_are_an_error() {
    let limits = PathLimits { speed: f64::NAN, acceleration: 1.0, jerk: 1.0 };
    assert!(PathTiming::rest_to_rest(&limits, 1.0).is_err());
    let limits = PathLimits { speed: 1.0, acceleration: -1.0, jerk: 1.0 };
    assert!(PathTiming::rest_to_rest(&limits, 1.0).is_err());
}

#[test]
fn rest_is_rest() {
    let rest = PathTiming::rest(0.4);
    for seconds in [0.0, 1.0, 100.0] {
        assert_eq!(rest.at(seconds), PathState { parameter: 0.4, speed: 0.0, acceleration: 0.0 });
    }
}
