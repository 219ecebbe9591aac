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
    let whole = |key: &str, otherwise: u32| {
        parameters.get(key).and_then(Value::as_u64).map_or(otherwise, |value| u32::try_from(value).unwrap())
    };
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
        maximum_iterations: whole("t_max", 40),
        energy_threshold: number("tau_energy", 0.05),
        maximum_waypoints: whole("max_points", 2_500) as usize,
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
        assert_eq!(summaries.len(), usize::try_from(case["iterations"].as_u64().unwrap()).unwrap(), "{name}");
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

#[test]
fn algorithm_3_makes_the_paths_of_the_vectors() {
    use crate::modelling::mixture::tests::mixture;
    let file: Value = serde_json::from_str(include_str!("../../tests/vectors/algorithms/alg3_small.json")).unwrap();
    let cases = file["cases"].as_array().unwrap();
    for case in cases {
        let scene = cases.iter().find(|other| other["scene_seed"] == case["scene_seed"]).unwrap();
        let mixtures = scene["gmms"].as_array().unwrap();
        let space = ArmSpace {
            hand: mixture(&mixtures[0]),
            elbow: mixture(&mixtures[1]),
            shoulder: mixture(&mixtures[2]),
            whole: None,
        };
        let joints = points(&scene["joints"]);
        let context = ArmContext {
            initial: [joints[0], joints[1], joints[2]],
            space: None,
            seed: case["rng_seed"].as_u64().unwrap(),
        };
        let parameters = &case["params"];
        let learning = LearningSettings { step: 0.3, energy_threshold: 0.01, ..settings(parameters).0 };
        let multimodal = MultimodalSettings {
            whole_arm: false,
            draws: 20,
            end_radius: 0.5,
            middle_radius: 0.2,
            include_current: parameters["include_current"].as_bool().unwrap_or(true),
            guard_radii: parameters["min_dist"].as_f64().map_or(2.0, |distance| distance / 0.2),
            pin_last: parameters["pin_last"].as_bool().unwrap_or(true),
            space: crate::modelling::stick::Space::Planar,
        };
        let mut strategy = MultimodalStrategy::new(&context, &space, &learning, &multimodal);
        let reference = points(&scene["reference"]);
        let mut sense = |position: &Point| position - closest_on_polyline(position, &reference).unwrap();
        let probing = Probing { step: 0.3, threshold: 0.1 };
        let name = case["name"].as_str().unwrap();
        let iterations = case["subpaths_after_each_iteration"].as_array().unwrap();
        for (index, expected) in iterations.iter().enumerate() {
            let summary = rehearse::iteration(&mut strategy, &probing, &mut sense).unwrap();
            assert_eq!(u64::from(summary.contacts), case["contacts"][index].as_u64().unwrap(), "{name}");
            for (limb, expected) in strategy.limbs().iter().zip(expected.as_array().unwrap()) {
                assert_close(limb, &points(expected), 1e-8, name);
            }
            assert!((summary.energy - case["energies"][index].as_f64().unwrap()).abs() < 1e-8, "{name}");
        }
    }
}

#[test]
fn the_kernel_step_makes_the_paths_of_the_vectors() {
    let file: Value = serde_json::from_str(include_str!("../../tests/vectors/algorithms/kernel_step.json")).unwrap();
    for case in file["cases"].as_array().unwrap() {
        let parameters = &case["params"];
        let number = |key: &str, otherwise: f64| parameters.get(key).and_then(Value::as_f64).unwrap_or(otherwise);
        let learning = LearningSettings {
            step: number("step", 0.1),
            maximum_step: f64::MAX,
            maximum_iterations: 40,
            energy_threshold: 0.05,
            end_tolerance: 0.0,
            ..LearningSettings::default()
        };
        let gain = number("eta", 1.0);
        let learning = LearningSettings { maximum_step: number("clip", 0.3) / gain, ..learning };
        let kernel = KernelSettings {
            gain,
            length_scale: 0.4,
            stiffness: number("k0", 1.0),
            learn_stiffness: parameters["learn"].as_bool().unwrap_or(false),
        };
        let mut strategy = kernel_step(&points(&case["initial"]), &learning, &kernel);
        let optimal = points(&case["optimal"]);
        let stiffness = case["true_stiffness"].as_f64().unwrap();
        let sense = |position: &Point| (position - closest_on_polyline(position, &optimal).unwrap()) * stiffness;
        let probing = Probing { step: 10.0, threshold: 0.02 };
        let summaries = rehearse::run(&mut strategy, &probing, sense).unwrap();
        let paths = case["path_after_each_iteration"].as_array().unwrap();
        assert_eq!(summaries.len(), paths.len());
        for (index, (summary, path)) in summaries.iter().zip(paths).enumerate() {
            assert_close(&summary.path, &points(path), 1e-9, case["name"].as_str().unwrap());
            assert_eq!(u64::from(summary.contacts), case["contacts"][index].as_u64().unwrap());
        }
        assert!((strategy.stiffness() - case["stiffness"].as_f64().unwrap()).abs() < 1e-9);
    }
}

fn arm_space() -> ArmSpace {
    use crate::modelling::Mixture;
    let around = |mean: Vector| {
        let covariance = nalgebra::Matrix3::identity() * 0.004;
        Mixture::new([(0.7, mean, covariance), (0.3, mean + Vector::new(0.05, 0.05, 0.0), covariance)]).unwrap()
    };
    ArmSpace {
        hand: around(Vector::new(0.80, -0.30, 0.10)),
        elbow: around(Vector::new(0.78, -0.02, 0.12)),
        shoulder: around(Vector::new(0.62, 0.15, 0.25)),
        whole: None,
    }
}

fn robot_context(space: Option<ArmSpace>) -> ArmContext {
    let initial = [Point::new(0.80, -0.31, 0.10), Point::new(0.77, -0.03, 0.12), Point::new(0.62, 0.15, 0.25)];
    ArmContext { initial, space, seed: 1 }
}

/// An arm that is somewhat beside the straight path, with cloth of 300 N/m and a detector's threshold of 5 N.
fn resistance(position: &Point) -> Vector {
    let initial = robot_context(None).initial;
    let bend = [initial[0], initial[1] + Vector::new(0.06, 0.0, 0.05), initial[2]];
    (position - closest_on_polyline(position, &bend).unwrap()) * 300.0
}

#[test]
fn every_strategy_ends_on_the_robot_with_its_ends_where_they_were() {
    let context = robot_context(Some(arm_space()));
    for kind in StrategyKind::ALL {
        let mut strategy = build(kind, &StrategySettings::default(), &context).unwrap();
        let ends = |path: &[Point]| (path[0], path[path.len() - 1]);
        let before = ends(strategy.path());
        let probing = Probing { step: 0.01, threshold: 5.0 };
        let summaries = rehearse::run(strategy.as_mut(), &probing, resistance).unwrap();
        assert!(summaries.len() <= 8, "{kind}");
        assert_eq!(ends(strategy.path()), before, "{kind}");
        let (first, last) = (&summaries[0], &summaries[summaries.len() - 1]);
        assert!(first.contacts > 0 && first.reachability.is_some(), "{kind}");
        if matches!(kind, StrategyKind::Force | StrategyKind::Kernel | StrategyKind::OffsetField) {
            assert!(last.energy < 0.5 * first.energy, "{kind}: {} then {}", first.energy, last.energy);
        }
        assert!(strategy.begin().is_err() || kind == StrategyKind::Gmm, "{kind}");
    }
}

#[test]
fn a_switch_of_strategy_keeps_the_path_and_says_what_it_drops() {
    let context = robot_context(Some(arm_space()));
    let settings = StrategySettings::default();
    let probing = Probing { step: 0.01, threshold: 5.0 };
    for from in StrategyKind::ALL {
        let mut old = build(from, &settings, &context).unwrap();
        rehearse::iteration(old.as_mut(), &probing, &mut |position| resistance(position)).unwrap();
        let learned = old.learned();
        for to in StrategyKind::ALL {
            let mut new = build(to, &settings, &context).unwrap();
            let dropped = new.adopt(&learned);
            for point in &learned.path {
                let distance = (point - closest_on_polyline(point, new.path()).unwrap()).norm();
                assert!(distance < 1e-9, "{from} to {to} loses {point}");
            }
            if learned.optimiser.is_some() && matches!(to, StrategyKind::Kernel | StrategyKind::Gmm) {
                assert!(dropped.iter().any(|words| words.contains("moments")), "{from} to {to}: {dropped:?}");
            }
        }
    }
}

#[test]
fn a_contact_that_moves_nothing_says_why() {
    let context = robot_context(None);
    let mut strategy = build(StrategyKind::Force, &StrategySettings::default(), &context).unwrap();
    let contact = |position| Contact { position, resistance: Vector::new(6.0, 0.0, 0.0) };
    assert_eq!(strategy.resisted(&contact(Point::origin())).ignored, Some(Ignored::NotUnderWay));
    strategy.begin().unwrap();
    let bad = Contact { position: Point::origin(), resistance: Vector::new(f64::NAN, 0.0, 0.0) };
    assert_eq!(strategy.resisted(&bad).ignored, Some(Ignored::NotFinite));
    strategy.arrived();
    assert_eq!(strategy.resisted(&contact(context.initial[2])).ignored, Some(Ignored::PinnedEnd));
    let mut given = 0;
    let reason = loop {
        let middle = Point::from((context.initial[1].coords + context.initial[2].coords) * 0.5);
        match strategy.resisted(&contact(middle)).ignored {
            Some(reason) => break reason,
            None => given += 1,
        }
        assert!(given < 100, "the way to the pinned end has no bound");
    };
    assert_eq!(reason, Ignored::BudgetSpent);
}

#[test]
fn a_change_says_in_one_line_what_moved_it_and_what_it_did() {
    let context = robot_context(Some(arm_space()));
    let mut strategy = build(StrategyKind::Multimodal, &StrategySettings::default(), &context).unwrap();
    strategy.begin().unwrap();
    let position = context.initial[0] + (context.initial[1] - context.initial[0]) * 0.3;
    let reaction = strategy.resisted(&Contact { position, resistance: Vector::new(0.0, 0.0, 7.5) });
    let change = reaction.changes[0];
    assert_eq!(reaction.move_to, change.to);
    assert!((change.to - (position - Vector::new(0.0, 0.0, 0.03))).norm() < 1e-6);
    let line = change.to_string();
    assert!(line.starts_with("7.5 N: gives way to the force (adam step), moved 30 mm, reach "), "{line}");
}

#[test]
fn bad_settings_and_paths_are_refused_with_key_and_reason() {
    let context = robot_context(None);
    let refused = |settings: &str| {
        let settings: StrategySettings = serde_json::from_str(settings).unwrap();
        build(StrategyKind::Force, &settings, &context).unwrap_err().to_string()
    };
    let none = refused(r#"{"learning":{"maximum_iterations":0}}"#);
    assert_eq!(none, "`learning.maximum_iterations` is 0, and it must be a finite number above 0");
    assert!(refused(r#"{"learning":{"optimiser":{"learning_rate":-1.0}}}"#).contains("learning_rate"));
    assert!(refused(r#"{"kernel":{"gain":1.5}}"#).contains("kernel.gain"));
    assert!(serde_json::from_str::<StrategySettings>(r#"{"lerning":{}}"#).is_err());
    let mut twice = context.clone();
    twice.initial[1] = twice.initial[0];
    let build_force = |context: &ArmContext| build(StrategyKind::Force, &StrategySettings::default(), context);
    assert_eq!(build_force(&twice).unwrap_err(), StrategyError::NoLength { index: 0 });
    twice.initial[1].x = f64::NAN;
    assert_eq!(build_force(&twice).unwrap_err(), StrategyError::NotFinite { index: 1 });
    let gmm = build(StrategyKind::Gmm, &StrategySettings::default(), &context).unwrap_err();
    assert_eq!(gmm, StrategyError::NoMovementSpace { strategy: StrategyKind::Gmm });
}

#[test]
fn guards_are_off_unless_asked_for_and_then_bound_the_step() {
    let contact = Contact { position: Point::new(0.79, -0.2, 0.1), resistance: Vector::new(6.0, 0.4, 0.0) };
    let first_move = |guards: Guards| {
        let mut settings = StrategySettings::default();
        settings.learning.guards = guards;
        settings.learning.optimiser.second_moment = SecondMoment::Axis;
        let mut strategy = build(StrategyKind::Force, &settings, &robot_context(None)).unwrap();
        strategy.begin().unwrap();
        contact.position - strategy.resisted(&contact).move_to
    };
    let printed = first_move(Guards::default());
    assert!((printed.y - 0.03).abs() < 1e-6, "Adam by axis moves a quiet axis a full step");
    assert!(first_move(Guards { quiet_axis: 0.5, ..Guards::default() }).y.abs() < 1e-12);
    assert!(first_move(Guards { maximum_gain: 0.001, ..Guards::default() }).norm() < 0.007);
    assert!(first_move(Guards { bias: 10.0, ..Guards::default() }).norm() < 1e-12);
}

#[test]
fn a_path_of_dense_nodes_takes_as_long_as_the_thesis_path_and_heeds_contacts_between_its_nodes() {
    let context = robot_context(Some(arm_space()));
    for kind in StrategyKind::ALL {
        let mut strategy = build(kind, &StrategySettings::default(), &context).unwrap();
        strategy.begin().unwrap();
        let legs = strategy.path().len() - 1;
        let pass = legs as f64 * strategy.interval_share();
        assert!(pass <= 4.0 + 1e-12, "{kind}: {pass} intervals");
        let [start, next] = [strategy.path()[0], strategy.goal().unwrap()];
        let between = start + (next - start) * 0.4;
        assert!(strategy.heeds(&between), "{kind}");
    }
}

/// Places of an arm that swings about its elbow as a whole: hand and elbow go together.
fn swinging_arm() -> [Vec<Vector>; 3] {
    let mut random = crate::modelling::SplitMix64::new(5);
    let mut places = <[Vec<Vector>; 3]>::default();
    for _ in 0..400 {
        let swing = Vector::new(0.0, 0.0, 0.08) * random.normal();
        let joints = [
            Vector::new(0.80, -0.30, 0.10) + swing,
            Vector::new(0.78, -0.02, 0.12) + swing,
            Vector::new(0.62, 0.15, 0.25),
        ];
        for (list, joint) in places.iter_mut().zip(joints) {
            list.push(joint + Vector::new(random.normal(), random.normal(), random.normal()) * 0.01);
        }
    }
    places
}

#[test]
fn the_whole_arm_stands_in_for_the_stick_where_it_is_asked_for_and_known() {
    let mut settings = StrategySettings::default();
    settings.multimodal.whole_arm = true;
    let refused = build(StrategyKind::Multimodal, &settings, &robot_context(Some(arm_space())));
    assert!(refused.is_err_and(|error| error.to_string().contains("whole arm")));
    let space = ArmSpace::fit(&swinging_arm(), &crate::modelling::FitSettings::default(), 1).unwrap();
    let [forearm, _] = space.limbs_together().unwrap();
    let limb =
        crate::modelling::stick::Limb { start: &space.hand, end: &space.elbow, together: Some(&forearm), length: 0.28 };
    let (hand, elbow) = (Point::new(0.80, -0.30, 0.22), Point::new(0.78, -0.02, 0.24));
    let together = limb.log_density(&hand, &elbow) - limb.log_density(&hand, &(elbow - Vector::z() * 0.24));
    assert!(together > 20.0, "a high hand goes with a high elbow, not with a low one: {together}");
    let mut strategy = build(StrategyKind::Multimodal, &settings, &robot_context(Some(space))).unwrap();
    strategy.begin().unwrap();
    let contact = Contact { position: Point::new(0.79, -0.2, 0.11), resistance: Vector::new(0.0, 0.0, -6.0) };
    let reaction = strategy.resisted(&contact);
    assert!(reaction.changes.iter().any(|change| matches!(change.rule, Rule::GoalChosen { .. })), "{reaction:?}");
}
