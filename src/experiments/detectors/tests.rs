//! The figures that the protection against soft catches rests on, with fewer runs than the command makes.

use super::*;

const RUNS: u32 = 300;

/// The rows of a sleeve at the noise and drift for which the claims are made.
fn claimed(detector: &str, sleeve: Sleeve) -> Vec<DetectorRow> {
    let kinds = [0.67, 0.44]
        .map(|drift_metres| SPEEDS.map(|speed| Pull { sleeve, speed, noise: 1.5, drift: 5.0, drift_metres }));
    let kinds = kinds.concat();
    let settings = DetectorRuns { runs: RUNS, seed: 4 };
    let rows = kinds.iter().enumerate().flat_map(|(index, pull)| rows_of(pull, index as u64, settings));
    rows.filter(|row| row.detector == detector).collect()
}

fn mean(values: impl Iterator<Item = f64>) -> f64 {
    let values: Vec<f64> = values.collect();
    values.iter().sum::<f64>() / values.len() as f64
}

#[test]
fn s_14_a_soft_catch_is_found_before_10_newtons_in_99_of_100_pulls() {
    let rows = claimed(Bank::GUARD, Sleeve::Soft);
    let found = mean(rows.iter().filter_map(|row| row.found_share));
    assert!(found >= 0.985, "{found} of {RUNS} pulls at each speed; 0.99 less the spread of so few");
    assert!(rows.iter().all(|row| row.force_newtons_p99.is_some_and(|force| force < 10.0)));
}

#[test]
fn s_14_at_most_one_clean_pull_in_20_is_stopped() {
    for row in claimed(Bank::GUARD, Sleeve::Good) {
        assert!(row.false_stop_share <= 0.07, "{row:?}: 0.05 and the spread of so few");
    }
}

#[test]
fn the_thesis_window_does_not_see_a_soft_catch_without_noise() {
    let mut generator = ChaCha8Rng::seed_from_u64(3);
    for speed in SPEEDS {
        let pull = Pull { sleeve: Sleeve::Soft, speed, noise: 0.0, drift: 0.0, drift_metres: 0.67 };
        let findings = findings_of(&pull, &mut generator);
        for (name, finding) in Bank::NAMES.iter().zip(&findings) {
            assert!(!name.starts_with("window") || finding.found.is_none(), "{name} at {speed} m/s");
        }
        assert!(findings.last().is_some_and(|guard| guard.found.is_some()), "the guard at {speed} m/s");
    }
}

#[test]
fn rows_repeat_with_the_seed_and_differ_with_another() {
    let pull = Pull { sleeve: Sleeve::Caught, speed: 0.1, noise: 1.5, drift: 5.0, drift_metres: 0.67 };
    let rows = |seed| rows_of(&pull, 0, DetectorRuns { runs: 20, seed });
    assert_eq!(rows(1), rows(1));
    assert_ne!(rows(1), rows(2));
}

#[test]
fn a_sleeve_that_does_not_catch_has_no_miss_rate() {
    let pull = Pull { sleeve: Sleeve::Good, speed: 0.1, noise: 0.5, drift: 0.0, drift_metres: 0.67 };
    for row in rows_of(&pull, 0, DetectorRuns { runs: 3, seed: 1 }) {
        assert_eq!((row.found_share, row.miss_rate, row.delay_seconds_median), (None, None, None));
    }
}
