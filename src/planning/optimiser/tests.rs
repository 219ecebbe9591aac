use super::*;
use serde_json::Value;

const TOLERANCE: f64 = 1e-12;

fn vectors() -> Vec<Value> {
    let file: Value = serde_json::from_str(include_str!("../../../tests/vectors/algorithms/optimiser.json")).unwrap();
    file["cases"].as_array().unwrap().clone()
}

fn settings(case: &Value) -> OptimiserSettings {
    OptimiserSettings {
        method: serde_json::from_value(case["method"].clone()).unwrap(),
        learning_rate: case["lr"].as_f64().unwrap(),
        second_moment: serde_json::from_value(case["second_moment"].clone()).unwrap(),
    }
}

fn numbers(value: &Value) -> Vec<f64> {
    value.as_array().unwrap().iter().map(|number| number.as_f64().unwrap()).collect()
}

fn vector(value: &Value) -> Vector {
    let numbers = numbers(value);
    Vector::new(numbers[0], numbers[1], numbers.get(2).copied().unwrap_or_default())
}

fn assert_close(actual: &Vector, expected: &Value) {
    for (actual, expected) in actual.iter().zip(numbers(expected)) {
        assert!((actual - expected).abs() < TOLERANCE, "{actual} is not {expected}");
    }
}

#[test]
fn displacements_and_moments_are_those_of_the_vectors() {
    let mut seen = 0;
    for case in vectors().iter().filter(|case| case.get("iterations").is_some()) {
        let mut optimiser = Optimiser::new(settings(case));
        let iterations = case["iterations"].as_array().unwrap().iter();
        for (contacts, expected) in iterations.zip(case["expected"].as_array().unwrap()) {
            optimiser.begin();
            let displacements = expected["displacements"].as_array().unwrap();
            for (contact, displacement) in contacts.as_array().unwrap().iter().zip(displacements) {
                assert_close(&optimiser.step(&vector(contact)), displacement);
            }
            optimiser.end();
            assert_close(&optimiser.state().moments.first, &expected["m"]);
            assert_close(&optimiser.state().moments.second, &expected["v"]);
            seen += 1;
        }
    }
    assert!(seen > 50);
}

#[test]
fn a_parabola_is_minimised_as_in_the_vectors() {
    for case in vectors().iter().filter(|case| case.get("iterations").is_none()) {
        let mut optimiser = Optimiser::new(settings(case));
        let mut position = Vector::x();
        for expected in numbers(&case["minimise_half_x_squared_from_1"]) {
            optimiser.begin();
            position -= optimiser.step(&position.clone());
            optimiser.end();
            assert!((position.x - expected).abs() < TOLERANCE);
        }
    }
}

#[test]
fn a_saved_optimiser_goes_on_as_if_it_had_never_stopped() {
    for method in Method::ALL {
        let settings = OptimiserSettings { method, ..OptimiserSettings::default() };
        let mut whole = Optimiser::new(settings);
        whole.begin();
        whole.step(&Vector::new(6.0, -1.0, 0.5));
        whole.end();
        let text = serde_json::to_string(whole.state()).unwrap();
        let mut resumed = Optimiser::resume(settings, serde_json::from_str(&text).unwrap());
        for optimiser in [&mut whole, &mut resumed] {
            optimiser.begin();
        }
        let resistance = Vector::new(0.0, 5.5, -7.0);
        assert_eq!(whole.step(&resistance), resumed.step(&resistance));
    }
}

#[test]
fn adam_in_its_first_step_ignores_how_strong_the_force_is() {
    let mut optimiser = Optimiser::new(OptimiserSettings::default());
    optimiser.begin();
    for strength in [5.1, 50.0] {
        let displacement = optimiser.step(&(Vector::y() * strength));
        assert!((displacement.norm() - 0.03).abs() < 1e-9);
    }
}
