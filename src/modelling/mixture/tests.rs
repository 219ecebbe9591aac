use super::*;
use nalgebra::Matrix3;
use proptest::prelude::*;
use serde_json::Value;

fn numbers(value: &Value) -> Vec<f64> {
    value.as_array().unwrap().iter().map(|number| number.as_f64().unwrap()).collect()
}

/// Reads a mixture of the vectors; those of the plane in the terms of space.
pub(crate) fn mixture(case: &Value) -> Mixture {
    let weights = numbers(&case["weights"]);
    let means = case["means"].as_array().unwrap();
    let covariances = case["covariances"].as_array().unwrap();
    let entries = |value: &Value| value.as_array().unwrap().iter().flat_map(numbers).collect::<Vec<_>>();
    if numbers(&means[0]).len() == 2 {
        Mixture::planar((0..weights.len()).map(|index| {
            let mean = Vector2::from_row_slice(&numbers(&means[index]));
            (weights[index], mean, Matrix2::from_row_slice(&entries(&covariances[index])))
        }))
        .unwrap()
    } else {
        Mixture::new((0..weights.len()).map(|index| {
            let mean = Vector::from_row_slice(&numbers(&means[index]));
            (weights[index], mean, Matrix3::from_row_slice(&entries(&covariances[index])))
        }))
        .unwrap()
    }
}

pub(crate) fn point(value: &Value) -> Point {
    let numbers = numbers(value);
    Point::new(numbers[0], numbers[1], numbers.get(2).copied().unwrap_or_default())
}

#[test]
fn densities_regions_and_modes_are_those_of_the_vectors() {
    let file: Value = serde_json::from_str(include_str!("../../../tests/vectors/algorithms/gmm.json")).unwrap();
    for case in file["cases"].as_array().unwrap() {
        let mixture = mixture(case);
        let planar = numbers(&case["mode"]).len() == 2;
        assert!((mixture.mode() - point(&case["mode"])).norm() < 1e-6);
        assert!((mixture.log_density(&mixture.mode()) - case["mode_logpdf"].as_f64().unwrap()).abs() < 1e-6);
        for query in case["points"].as_array().unwrap() {
            let position = point(&query["x"]);
            let expected = query["logpdf"].as_f64().unwrap();
            assert!((mixture.log_density(&position) - expected).abs() < 1e-9 * (1.0 + expected.abs()));
            let region = if planar { REGION_95_PLANAR } else { REGION_95_SPATIAL };
            assert_eq!(mixture.contains(&position.coords, region), query["inside95"].as_bool().unwrap());
            for (component, expected) in mixture.components().iter().zip(numbers(&query["mahalanobis2"])) {
                assert!((component.mahalanobis_squared(&position.coords) - expected).abs() < 1e-9 * (1.0 + expected));
            }
        }
    }
}

fn two() -> Mixture {
    let covariance = Matrix3::new(0.02, 0.005, 0.0, 0.005, 0.03, -0.004, 0.0, -0.004, 0.01);
    Mixture::new([(0.3, Vector::new(0.1, 0.2, 0.3), covariance), (0.7, Vector::new(0.6, -0.2, 0.1), covariance * 0.5)])
        .unwrap()
}

#[test]
fn what_is_no_mixture_is_refused_with_its_reason() {
    let unit = Matrix3::identity();
    let zero = Vector::zeros();
    assert_eq!(Mixture::<3>::new([]), Err(MixtureError::Empty));
    assert_eq!(Mixture::new([(0.0, zero, unit)]), Err(MixtureError::Weight { component: 0, weight: 0.0 }));
    assert_eq!(Mixture::new([(0.9, zero, unit)]), Err(MixtureError::WeightSum { sum: 0.9 }));
    assert_eq!(Mixture::new([(1.0, zero, -unit)]), Err(MixtureError::NotPositiveDefinite { component: 0 }));
    let lopsided = Matrix3::new(1.0, 0.5, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0);
    assert_eq!(Mixture::new([(1.0, zero, lopsided)]), Err(MixtureError::NotPositiveDefinite { component: 0 }));
    assert_eq!(Mixture::new([(f64::NAN, zero, unit)]), Err(MixtureError::NotFinite { component: 0 }));
}

#[test]
fn a_file_gives_back_the_mixture_and_names_what_is_wrong() {
    let text = serde_json::to_string(&two()).unwrap();
    assert_eq!(serde_json::from_str::<Mixture>(&text).unwrap(), two());
    let short = r#"[{"weight":1.0,"mean":[0.0,0.0],"covariance":[[1,0,0],[0,1,0],[0,0,1]]}]"#;
    let error = serde_json::from_str::<Mixture>(short).unwrap_err().to_string();
    assert!(error.contains("`mean` has 2 numbers where 3 are needed"), "{error}");
}

#[test]
fn a_joint_density_is_the_marginal_times_the_conditional() {
    let whole = two();
    let marginal: Mixture<1> = whole.marginal([1]).unwrap();
    for (x, y, z) in [(0.1, 0.2, 0.3), (0.5, -0.1, 0.2), (0.3, 0.0, 0.0)] {
        let given = SVector::<f64, 1>::new(y);
        let rest: Mixture<2> = whole.conditional([0, 2], [1], &given).unwrap();
        let product = marginal.log_density_at(&given) + rest.log_density_at(&Vector2::new(x, z));
        assert!((whole.log_density(&Point::new(x, y, z)) - product).abs() < 1e-9);
    }
}

#[test]
fn samples_have_the_mean_and_covariance_of_the_mixture() {
    let mixture = two();
    let mut random = SplitMix64::new(5);
    let count = 40_000;
    let samples: Vec<_> = (0..count).map(|_| mixture.sample(&mut random)).collect();
    let mean: Vector = samples.iter().sum::<Vector>() / f64::from(count);
    let expected: Vector = mixture.components().iter().map(|part| part.mean() * part.weight()).sum();
    assert!((mean - expected).norm() < 5e-3);
    let spread: f64 = samples.iter().map(|sample| (sample - mean).norm_squared()).sum::<f64>() / f64::from(count);
    let within: f64 = mixture.components().iter().map(|part| part.weight() * part.covariance().trace()).sum();
    let between: f64 =
        mixture.components().iter().map(|part| part.weight() * (part.mean() - expected).norm_squared()).sum();
    assert!((spread - within - between).abs() < 5e-3);
}

#[test]
fn the_nearest_mean_is_the_first_of_equally_close_ones() {
    let unit = Matrix3::identity();
    let mixture = Mixture::new([(0.5, Vector::x(), unit), (0.5, -Vector::x(), unit)]).unwrap();
    assert_eq!(mixture.nearest_mean(&Vector::zeros()).0, 0);
    assert_eq!(mixture.nearest_mean(&Vector::new(-0.1, 0.0, 0.0)).0, 1);
}

proptest! {
    #[test]
    fn nothing_is_more_probable_than_the_mode(x in -1.0..1.0_f64, y in -1.0..1.0_f64, z in -1.0..1.0_f64) {
        let mixture = two();
        prop_assert!(mixture.log_density(&Point::new(x, y, z)) <= mixture.log_density(&mixture.mode()) + 1e-12);
    }

    #[test]
    fn a_density_far_away_is_small_but_finite(distance in 1.0..1e6_f64) {
        prop_assert!(two().log_density(&Point::new(distance, 0.0, 0.0)).is_finite());
    }
}
