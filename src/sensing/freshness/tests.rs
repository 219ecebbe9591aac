//! Streams that stop, stutter, lag, arrive in a burst, or live under a clock that jumps.

use super::*;
use proptest::prelude::*;

fn force() -> Freshness {
    Freshness::new(FreshnessSettings::new(80.0, 120.0, Duration::from_millis(60)))
}

fn milliseconds(count: u64) -> Stamp {
    Stamp::from_nanoseconds(5_000_000_000 + count * 1_000_000)
}

fn steady(messages: u64) -> Freshness {
    let mut stream = force();
    for index in 0..messages {
        stream.observe(milliseconds(index * 10), Some(milliseconds(index * 10)));
    }
    stream
}

#[test]
fn nothing_is_fresh_before_the_first_message() {
    let stream = force();
    assert!(!stream.is_fresh(milliseconds(0)));
    assert_eq!((stream.age(milliseconds(0)), stream.rate(milliseconds(0))), (None, 0.0));
}

#[test]
fn the_rate_is_that_of_the_stream_and_falls_to_nothing_when_it_stops() {
    let stream = steady(300);
    let end = 2990;
    assert!((stream.rate(milliseconds(end)) - 100.0).abs() < 1.0);
    assert!(stream.rate_is_expected(milliseconds(end)));
    let rates: Vec<f64> = (0..=11).map(|step| stream.rate(milliseconds(end + step * 100))).collect();
    assert!(rates.windows(2).all(|pair| pair[1] <= pair[0]), "{rates:?}");
    assert!(rates[5] < 55.0 && rates[11] < 1e-12, "{rates:?}");
}

#[test]
fn a_value_holds_up_to_its_deadline() {
    let stream = steady(10);
    assert!(stream.is_fresh(milliseconds(150)));
    assert!(!stream.is_fresh(milliseconds(151)));
}

#[test]
fn s_33_a_backlog_that_arrives_in_a_burst_is_not_fresh() {
    let mut stream = steady(100);
    // For half a second nothing arrives, then everything at once.
    for index in 100..150 {
        stream.observe(milliseconds(1500), Some(milliseconds(index * 10)));
        let expected = 1500 - index * 10 <= 60;
        assert_eq!(stream.is_fresh(milliseconds(1500)), expected, "message {index}");
    }
}

#[test]
fn a_constant_difference_of_the_clocks_does_not_matter_and_a_new_one_is_taken_over_on_demand() {
    let mut stream = force();
    for index in 0..50 {
        stream.observe(milliseconds(index * 10 + 8000), Some(milliseconds(index * 10)));
    }
    assert!(stream.is_fresh(milliseconds(8495)));
    assert!((stream.stamp_lag().unwrap() - 8.0).abs() < 1e-9);
    // The robot's clock is set back by one second.
    stream.observe(milliseconds(8500), Some(milliseconds(0)));
    assert!(!stream.is_fresh(milliseconds(8500)));
    stream.rebase();
    assert!(stream.is_fresh(milliseconds(8500)));
}

#[test]
fn a_clock_that_goes_back_leaves_nothing_fresh_until_a_new_message() {
    let mut stream = steady(100);
    assert!(!stream.is_fresh(milliseconds(10)));
    assert_eq!(stream.age(milliseconds(10)), None);
    stream.observe(milliseconds(20), Some(milliseconds(20)));
    assert!(stream.is_fresh(milliseconds(20)));
    assert!(stream.rate(milliseconds(20)) < 1e-12);
}

#[test]
fn what_arrived_before_the_clock_went_back_is_not_fresh_when_the_clock_comes_there_again() {
    let mut stream = steady(100);
    assert!(stream.is_fresh(milliseconds(1000)));
    stream.forget_what_lies_ahead(milliseconds(500));
    assert_eq!(stream.last(), None);
    assert!(!stream.is_fresh(milliseconds(1000)));
    let mut stream = steady(100);
    stream.forget_what_lies_ahead(milliseconds(1000));
    assert!(stream.is_fresh(milliseconds(1000)), "nothing lies ahead");
}

#[test]
fn gaps_and_jitter_are_those_of_the_last_second() {
    let mut stream = steady(100);
    assert!(stream.jitter(milliseconds(990)) < 1e-9);
    stream.observe(milliseconds(1040), None);
    assert!((stream.gap(milliseconds(1040)) - 0.05).abs() < 1e-9);
    assert!(stream.jitter(milliseconds(1040)) > 0.003);
    assert!((stream.gap(milliseconds(1240)) - 0.2).abs() < 1e-9, "an open gap counts");
    assert!(stream.jitter(milliseconds(3000)) < 1e-12);
}

#[test]
fn stamps_that_go_back_are_counted() {
    let mut stream = steady(3);
    stream.observe(milliseconds(31), Some(milliseconds(5)));
    assert_eq!(stream.reordered(), 1);
}

proptest! {
    #[test]
    fn s_33_no_stream_is_fresh_after_its_deadline(arrivals in proptest::collection::vec(0_u64..100_000, 1..300), wait in 61_u64..10_000) {
        let mut stream = force();
        for arrival in &arrivals {
            stream.observe(milliseconds(*arrival), None);
        }
        let last = *arrivals.last().unwrap();
        prop_assert!(!stream.is_fresh(milliseconds(last + wait)));
        prop_assert!(stream.rate(milliseconds(last + wait)).is_finite());
    }
}

#[test]
fn stamps_that_jump_ahead_are_not_fresh_and_what_follows_is_not_old() {
    let mut stream = Freshness::new(FreshnessSettings::new(80.0, 120.0, Duration::from_millis(60)));
    let at = |milliseconds: u64| Stamp::from_nanoseconds(milliseconds * 1_000_000);
    let mut see = |from: u64, ahead: u64| {
        (from..from + 1000).step_by(10).for_each(|now| stream.observe(at(now), Some(at(now + ahead))));
        stream.is_fresh(at(from + 1000))
    };
    assert!(see(1000, 0));
    assert!(!see(2000, 3000), "three seconds ahead");
    assert!(see(3000, 0), "as before");
    for second in 4..9 {
        assert!(!see(second * 1000, 3000));
    }
    assert!(see(9000, 3000) && see(10_000, 3000), "a clock that was set");
}
