use super::*;
use crate::geometry::closest_on_polyline;
use crate::planning::{Method, OptimiserSettings, SecondMoment};
use rehearse::Probing;
use serde_json::Value;

fn point(value: &Value) -> Point {
    let number = |axis: usize| value.get(axis).and_then(Value::as_f64).unwrap_or_default();
    Point::new(number(0), number(1), number(2))
}

fn points(value: &Value) -> Vec<Point> {
    value.as_array().unwrap().iter().map(point).collect()
}

fn settings(parameters: &Value) -> (LearningSettings, f64) {
    let number = |key: &str, otherwise: f64| parameters.get(key).and_then(Value::as_f64).unwrap_or(otherwise);
    let word = |key: &str| parameters.get(key).cloned();
    let optimiser = OptimiserSettings {
        method: word("method").map_or(Method::Adam, |value| serde_json::from_value(value).unwrap()),
        learning_rate: number("lr", 0.1),
        second_moment: word("second_moment").map_or(SecondMoment::Norm, |value| serde_json::from_value(value).unwrap()),
    };
    let learning = LearningSettings {
        optimiser,
        step: number("step", 0.05),
        maximum_step: f64::MAX,
        maximum_iterations: number("t_max", 40.0) as u32,
        energy_threshold: number("tau_energy", 0.05),
        maximum_waypoints: number("max_points", 2_500.0) as usize,
        end_tolerance: 1e-12,
        ..LearningSettings::default()
    };
    (learning, number("tau_g", 0.02))
}

fn assert_close(actual: &[Point], expected: &[Point], tolerance: f64, what: &str) {
    assert_eq!(actual.len(), expected.len(), "{what}");
    for (actual, expected) in actual.iter().zip(expected) {
        assert!((actual - expected).norm() < tolerance, "{what}: {actual} is not {expected}");
    }
}

#[test]
fn algorithm_2_makes_the_paths_of_the_vectors() {
    let file: Value = serde_json::from_str(include_str!("../../tests/vectors/algorithms/alg2_small.json")).unwrap();
    for case in file["cases"].as_array().unwrap() {
        let name = case["name"].as_str().unwrap();
        let (learning, threshold) = settings(&case["params"]);
        let optimal = points(&case["optimal"]);
        let mut strategy = ForceStrategy::new(&points(&case["initial"]), &learning);
        let sense = |position: &Point| position - closest_on_polyline(position, &optimal).unwrap();
        let summaries = rehearse::run(&mut strategy, &Probing { step: learning.step, threshold }, sense).unwrap();
        assert_eq!(summaries.len(), case["iterations"].as_u64().unwrap() as usize, "{name}");
        let paths = case["path_after_each_iteration"].as_array().unwrap();
        for (index, (summary, path)) in summaries.iter().zip(paths).enumerate() {
            assert_close(&summary.path, &points(path), 1e-9, name);
            assert!((summary.energy - case["energies"][index].as_f64().unwrap()).abs() < 1e-9, "{name}");
            assert_eq!(u64::from(summary.contacts), case["contacts"][index].as_u64().unwrap(), "{name}");
        }
        let finish = match case["status"].as_str().unwrap() {
            "converged" => Finish::Converged,
            "overflow" => Finish::Overflow,
            _ => Finish::MaximumReached,
        };
        assert_eq!(summaries.last().unwrap().finished, Some(finish), "{name}");
    }
}
