//! How long the learning rooms take: a fit of 5,000 points with up to 10 Gaussians, 10,000 log densities, one whole
//! experiment of table 4.1 with Adam, and what a strategy costs between two control steps.
//!
//! Run with `cargo bench --bench learning`.

#![expect(clippy::expect_used, reason = "a benchmark of numbers that are no mixture should not run")]

use criterion::{Criterion, criterion_group, criterion_main};
use nalgebra::Matrix3;
use std::hint::black_box;
use valet::experiments::synthetic::{Pair, PairSet, SensorError};
use valet::experiments::table_4_1::{Contestant, rehearse_pair};
use valet::geometry::{Point, Vector};
use valet::modelling::{ArmSpace, FitSettings, Mixture, SplitMix64, fit};
use valet::planning::{Method, SecondMoment};
use valet::strategy::{ArmContext, Contact, StrategyKind, StrategySettings, build};

fn four() -> Mixture {
    let means = [(0.0, 0.0), (0.3, 0.1), (0.1, 0.35), (-0.3, 0.2)];
    let parts = means.map(|(x, y)| {
        let covariance = Matrix3::new(0.004, 0.001, 0.0, 0.001, 0.002, 0.0, 0.0, 0.0, 0.003);
        (0.25, Vector::new(x, y, 1.0), covariance)
    });
    Mixture::new(parts).expect("the numbers above are a mixture")
}

fn learning(criterion: &mut Criterion) {
    let mixture = four();
    let mut random = SplitMix64::new(1);
    let points: Vec<Vector> = (0..10_000).map(|_| mixture.sample(&mut random)).collect();
    let (few, _) = points.split_at(5_000);
    let settings = FitSettings { most_components: 10, restarts: 1, ..FitSettings::default() };
    criterion.bench_function("fit of 5,000 points, at most 10 Gaussians", |bencher| {
        bencher.iter(|| fit(black_box(few), &settings, 1));
    });
    criterion.bench_function("10,000 log densities of 4 Gaussians", |bencher| {
        bencher.iter(|| points.iter().map(|point| mixture.log_density_at(black_box(point))).sum::<f64>());
    });
    let pair = Pair::random(PairSet::A, 1);
    criterion.bench_function("one experiment of table 4.1 with Adam", |bencher| {
        bencher.iter(|| {
            let mut strategy = Contestant::Optimiser(Method::Adam, SecondMoment::Norm).strategy(&pair, false);
            rehearse_pair(strategy.as_mut(), black_box(&pair), SensorError::None, 1)
        });
    });
}

fn between_control_steps(criterion: &mut Criterion) {
    let context = ArmContext {
        initial: [Point::new(0.3, 0.1, 1.0), Point::new(0.0, 0.0, 1.0), Point::new(-0.3, 0.2, 1.0)],
        space: Some(ArmSpace { hand: four(), elbow: four(), shoulder: four(), whole: None }),
        seed: 1,
    };
    let contact = Contact { position: Point::new(0.15, 0.05, 1.0), resistance: Vector::new(0.0, 0.0, 7.0) };
    for kind in StrategyKind::ALL {
        criterion.bench_function(&format!("{kind}: a contact with its reasons"), |bencher| {
            bencher.iter(|| {
                let mut strategy = build(kind, &StrategySettings::default(), &context).expect("the settings are valid");
                strategy.begin().expect("nothing has been learned yet");
                strategy.resisted(black_box(&contact))
            });
        });
    }
}

criterion_group!(benches, learning, between_control_steps);
criterion_main!(benches);
