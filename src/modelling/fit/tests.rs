use super::*;
use crate::geometry::Vector;
use proptest::prelude::*;
use serde_json::Value;

fn points(text: &str) -> Vec<Vector> {
    let number = |word: &str| word.trim().parse::<f64>();
    let rows = text.lines().filter_map(|line| line.split(',').map(number).collect::<Result<Vec<_>, _>>().ok());
    rows.filter(|row| row.len() == 3).map(|row| Vector::new(row[0], row[1], row[2])).collect()
}

macro_rules! golden {
    ($name:literal) => {
        (
            $name,
            include_str!(concat!("../../../tests/vectors/mixtures/", $name, ".json")),
            include_str!(concat!("../../../tests/vectors/mixtures/", $name, ".csv")),
        )
    };
}

fn whole(value: &Value) -> usize {
    usize::try_from(value.as_u64().unwrap()).unwrap()
}

fn settings(case: &Value) -> FitSettings {
    FitSettings {
        least_components: whole(&case["config"]["kmin"]),
        most_components: whole(&case["config"]["kmax"]),
        ..FitSettings::default()
    }
}

fn starts(case: &Value) -> Vec<usize> {
    case["init_indices"].as_array().unwrap().iter().map(whole).collect()
}

#[test]
fn mixtures_of_known_components_are_found_as_in_the_golden_sets() {
    for (name, json, csv) in
        [golden!("mix_k1_n2000"), golden!("mix_k2_n2000"), golden!("mix_k3_n2000"), golden!("mix_k4_n2000")]
    {
        let case: Value = serde_json::from_str(json).unwrap();
        let fit = fit_from(&points(csv), &settings(&case), &starts(&case)).unwrap();
        let expected = &case["expected"];
        assert_eq!(fit.mixture.components().len() as u64, expected["k"].as_u64().unwrap(), "{name}");
        let length = expected["message_length"].as_f64().unwrap();
        assert!((fit.message_length - length).abs() <= 1.0, "{name}: {} is not {length}", fit.message_length);
        for mean in expected["means"].as_array().unwrap() {
            let numbers: Vec<f64> = mean.as_array().unwrap().iter().map(|number| number.as_f64().unwrap()).collect();
            let mean = Vector::new(numbers[0], numbers[1], numbers[2]);
            let (_, nearest) = fit.mixture.nearest_mean(&mean);
            assert!((nearest - mean).norm() <= 2e-3, "{name}: no mean at {mean}");
        }
        assert!(!fit.reached_most);
    }
}

#[test]
fn odd_clouds_give_a_proper_mixture_with_the_expected_number_of_components() {
    for (name, json, csv) in [
        golden!("edge_identical_n50"),
        golden!("edge_line_n1000"),
        golden!("edge_n3"),
        golden!("edge_n5"),
        golden!("edge_n12"),
        golden!("edge_outliers_n2020"),
        golden!("edge_planar_n1000"),
        golden!("edge_two_points_n60"),
    ] {
        let case: Value = serde_json::from_str(json).unwrap();
        let fit = fit_from(&points(csv), &settings(&case), &starts(&case)).unwrap();
        let count = fit.mixture.components().len() as u64;
        match name {
            "edge_line_n1000" | "edge_outliers_n2020" => assert!(count <= 6, "{name}: {count}"),
            "edge_n3" => assert_eq!(count, 1, "{name}"),
            _ => assert_eq!(count, case["expected"]["k"].as_u64().unwrap(), "{name}"),
        }
        for component in fit.mixture.components() {
            let floor = component.covariance() - nalgebra::Matrix3::identity() * (1e-4 - 1e-12);
            assert!(nalgebra::Cholesky::new(floor).is_some(), "{name}: thinner than the floor");
        }
    }
}

#[test]
fn seeds_repeat_a_fit_and_restarts_do_not_make_it_worse() {
    let cloud = points(golden!("mix_k3_n2000").2);
    let settings = FitSettings { restarts: 1, ..FitSettings::default() };
    let once = fit(&cloud, &settings, 7).unwrap();
    assert_eq!(once, fit(&cloud, &settings, 7).unwrap());
    let more = fit(&cloud, &FitSettings { restarts: 3, ..settings }, 7).unwrap();
    assert!(more.message_length <= once.message_length);
}

#[test]
fn what_cannot_be_fitted_is_refused_with_its_reason() {
    let defaults = FitSettings::default();
    assert_eq!(fit::<3>(&[], &defaults, 1).unwrap_err(), FitError::NoPoints);
    let bad = [Vector::zeros(), Vector::new(0.0, f64::NAN, 0.0)];
    assert_eq!(fit(&bad, &defaults, 1).unwrap_err(), FitError::NotFinite { index: 1 });
    let none = FitSettings { most_components: 0, ..defaults.clone() };
    assert!(fit(&[Vector::zeros()], &none, 1).unwrap_err().to_string().contains("most_components"));
    assert_eq!(fit_from(&[Vector::zeros()], &defaults, &[3]).unwrap_err(), FitError::Start { index: 3, points: 1 });
}

#[test]
fn the_largest_number_of_components_is_reported_where_it_wins() {
    let cloud = points(golden!("mix_k4_n2000").2);
    let found = fit(&cloud, &FitSettings::default(), 3).unwrap();
    assert_eq!(found.mixture.components().len(), 4);
    assert!(found.reached_most);
}

/// Some places of `D` numbers drawn from a seed, in a few heaps that lie apart.
fn heaps<const D: usize>(count: usize, heaps: u64, seed: u64) -> Vec<SVector<f64, D>> {
    let mut random = SplitMix64::new(seed);
    let centres: Vec<SVector<f64, D>> =
        (0..heaps).map(|_| SVector::from_fn(|_, _| random.between(-0.5, 0.5))).collect();
    let place = |index: usize| centres[index % centres.len()];
    (0..count).map(|index| place(index) + SVector::from_fn(|_, _| 0.1 * random.between(-0.5, 0.5))).collect()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    // A component of nine numbers costs 27 points: with 60 points the weights before they are scaled add up to about a
    // half, and an error of rounding that the scaling carried on would double in every sweep.
    #[test]
    fn few_points_give_weights_that_add_up_to_1(count in 1_usize..90, groups in 1_u64..6, seed in any::<u64>()) {
        for restarts in [1, 3] {
            let settings = FitSettings { restarts, ..FitSettings::default() };
            fit(&heaps::<3>(count, groups, seed), &settings, seed).unwrap();
            fit(&heaps::<9>(count, groups, seed), &settings, seed).unwrap();
        }
    }
}
