//! Thesis section 5.2.1: the strategies of chapters 3, 4 and 5, and those beyond, on scenes in which reachability and
//! comfort contradict each other.

use super::figure_4_5::flat;
use super::findings::{Drawing, ExperimentError, Findings, Row};
use super::synthetic::{Scene, seed_of};
use crate::geometry::Point;
use crate::modelling::stick::{Space, StickFit};
use crate::planning::criteria::{Reach, comfort};
use crate::planning::{OptimiserSettings, SecondMoment};
use crate::report::plot::{Axis, Colour, Dash, Figure, Layer, Plot};
use crate::strategy::rehearse::{self, Probing};
use crate::strategy::{
    ArmContext, BlendSettings, BlendStrategy, FixedPath, ForceStrategy, KernelSettings, LearningSettings,
    MultimodalSettings, MultimodalStrategy, OffsetFieldSettings, Strategy, kernel_step, offset_field,
};
use rayon::prelude::*;

/// Scenes of the table.
const SCENES: u64 = 200;
/// How far the reference force path strays from the initial path.
const DEVIATION: f64 = 0.9;
/// Section 5.2.1.
const STEP: f64 = 0.3;
const THRESHOLD: f64 = 0.1;
const ENERGY_THRESHOLD: f64 = 0.01;
const MAXIMUM_ITERATIONS: u32 = 10;
const LEARNING_RATE: f64 = 0.1;
/// Paths are judged every 0.1.
const SPACING: f64 = 0.1;
/// The components of the thesis' four scenes.
const FOUR: [[usize; 3]; 4] = [[3, 2, 1], [3, 3, 3], [2, 4, 2], [2, 3, 2]];

/// What is run on a scene.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Contestant {
    Chapter3,
    Chapter4(SecondMoment),
    /// Algorithm 3 as printed.
    Literal,
    /// With the guard near the goal, the shoulder free.
    Guarded,
    /// With the guard, the present goal among the candidates and the shoulder pinned.
    Recommended,
    Kernel,
    OffsetField,
    Blend(f64),
}

const CONTESTANTS: [Contestant; 13] = [
    Contestant::Chapter3,
    Contestant::Chapter4(SecondMoment::Norm),
    Contestant::Chapter4(SecondMoment::Axis),
    Contestant::Literal,
    Contestant::Guarded,
    Contestant::Recommended,
    Contestant::Kernel,
    Contestant::OffsetField,
    Contestant::Blend(1.0),
    Contestant::Blend(2.0),
    Contestant::Blend(3.0),
    Contestant::Blend(4.0),
    Contestant::Blend(6.0),
];

impl Contestant {
    fn name(self) -> String {
        match self {
            Self::Chapter3 => "chapter 3".into(),
            Self::Chapter4(moment) => format!("chapter 4 ({})", moment.name()),
            Self::Literal => "chapter 5 as printed".into(),
            Self::Guarded => "chapter 5 guarded".into(),
            Self::Recommended => "chapter 5 recommended".into(),
            Self::Kernel => "kernel".into(),
            Self::OffsetField => "offset_field".into(),
            Self::Blend(weight) => format!("blend {weight}"),
        }
    }

    fn strategy(self, scene: &Scene, reach: &Reach, seed: u64) -> Box<dyn Strategy> {
        let mut learning = learning();
        match self {
            Self::Chapter3 => Box::new(FixedPath::along(scene.initial.to_vec())),
            Self::Chapter4(second_moment) => {
                learning.optimiser.second_moment = second_moment;
                Box::new(ForceStrategy::new(&scene.initial, &learning))
            }
            Self::Literal => multimodal(scene, seed, |settings| {
                settings.guard_radii = 0.0;
                settings.include_current = false;
                settings.pin_last = false;
            }),
            Self::Guarded => multimodal(scene, seed, |settings| {
                settings.include_current = false;
                settings.pin_last = false;
            }),
            Self::Recommended => multimodal(scene, seed, |_| {}),
            Self::Kernel => Box::new(kernel_step(&scene.initial, &nodes(), &kernel())),
            Self::OffsetField => Box::new(offset_field(&scene.initial, &nodes(), &field())),
            Self::Blend(weight) => {
                let comfort = kernel_step(&scene.initial, &nodes(), &kernel());
                let settings = BlendSettings { weight, distance_scale: 1.0 };
                Box::new(BlendStrategy::new(comfort, reach.clone(), &scene.initial, &settings))
            }
        }
    }
}

fn learning() -> LearningSettings {
    LearningSettings {
        optimiser: OptimiserSettings { learning_rate: LEARNING_RATE, ..OptimiserSettings::default() },
        step: STEP,
        maximum_step: f64::MAX,
        maximum_iterations: MAXIMUM_ITERATIONS,
        energy_threshold: ENERGY_THRESHOLD,
        end_tolerance: 1e-9,
        ..LearningSettings::default()
    }
}

fn nodes() -> LearningSettings {
    LearningSettings { maximum_step: 1.0, ..learning() }
}

const fn kernel() -> KernelSettings {
    KernelSettings { gain: 1.0, length_scale: 0.8, stiffness: 1.0, learn_stiffness: false }
}

const fn field() -> OffsetFieldSettings {
    OffsetFieldSettings {
        length_scale: 0.8,
        deviation: 0.6,
        noise: 0.03,
        relative_noise: 0.1,
        stiffness: 1.0,
        learn_stiffness: false,
    }
}

fn multimodal(scene: &Scene, seed: u64, change: impl FnOnce(&mut MultimodalSettings)) -> Box<dyn Strategy> {
    let mut settings = MultimodalSettings {
        end_radius: 0.5,
        middle_radius: 0.2,
        space: Space::Planar,
        ..MultimodalSettings::default()
    };
    change(&mut settings);
    let context = ArmContext { initial: scene.initial, space: None, seed };
    Box::new(MultimodalStrategy::new(&context, &scene.space, &learning(), &settings))
}

/// What came of one strategy on one scene.
struct Outcome {
    path: Vec<Point>,
    reach: f64,
    inside: f64,
    distance: f64,
    beyond: f64,
    iterations: f64,
    contacts: f64,
    length: f64,
}

fn run_one(contestant: Contestant, scene: &Scene, seed: u64) -> Result<Outcome, ExperimentError> {
    let coarse = Reach::new(scene.space.clone(), &scene.initial, StickFit::coarse(Space::Planar));
    let mut strategy = contestant.strategy(scene, &coarse, seed);
    let (mut iterations, mut contacts) = (0.0, 0.0);
    // Chapter 3 does not learn: its path is judged as it is.
    if contestant != Contestant::Chapter3 {
        let probing = Probing { step: STEP, threshold: THRESHOLD };
        let summaries = rehearse::run(strategy.as_mut(), &probing, |point| scene.reference.displacement(point))?;
        iterations = summaries.len() as f64;
        contacts = summaries.iter().map(|summary| f64::from(summary.contacts)).sum();
    }
    let reach = Reach::new(scene.space.clone(), &scene.initial, StickFit::new(Space::Planar));
    let reached = reach.along(strategy.path(), SPACING);
    let comfort = comfort(strategy.path(), &scene.reference, THRESHOLD, SPACING);
    Ok(Outcome {
        path: strategy.path().to_vec(),
        reach: reached.score,
        inside: reached.inside_share,
        distance: comfort.mean_distance,
        beyond: comfort.share_beyond,
        iterations,
        contacts,
        length: crate::geometry::polyline_length(strategy.path()),
    })
}

/// The strategies on 200 random scenes.
///
/// # Errors
/// [`ExperimentError`] where a scene cannot be made or a strategy refuses.
pub fn table(seed: u64) -> Result<Findings, ExperimentError> {
    let mut findings = Findings::default();
    for contestant in CONTESTANTS {
        let runs = (0..SCENES).into_par_iter().map(|index| {
            let scene = Scene::any(DEVIATION, seed_of(seed, index))?;
            run_one(contestant, &scene, seed_of(seed, index))
        });
        findings.rows.push(row(contestant, &runs.collect::<Result<Vec<_>, _>>()?));
    }
    findings.drawings.push(front(&findings.rows));
    findings.remarks = remarks();
    Ok(findings)
}

fn row(contestant: Contestant, outcomes: &[Outcome]) -> Row {
    let of = |value: fn(&Outcome) -> f64| outcomes.iter().map(value).collect::<Vec<_>>();
    let mut lengths = of(|outcome| outcome.length);
    lengths.sort_by(f64::total_cmp);
    let diverged = outcomes.iter().filter(|outcome| outcome.distance > 1.0).count();
    Row::of("5")
        .with("strategy", contestant.name())
        .with("scenes", outcomes.len())
        .with_statistics("reach", of(|outcome| outcome.reach))
        .with_statistics("inside_share", of(|outcome| outcome.inside))
        .with_statistics("distance", of(|outcome| outcome.distance))
        .with_statistics("share_beyond_threshold", of(|outcome| outcome.beyond))
        .with_statistics("iterations", of(|outcome| outcome.iterations))
        .with_statistics("contacts", of(|outcome| outcome.contacts))
        .with("length_median", lengths.get(lengths.len() / 2).copied().unwrap_or_default())
        .with("diverged_share", diverged as f64 / outcomes.len().max(1) as f64)
}

fn front(rows: &[Row]) -> Drawing {
    let point = |row: &Row| [row.number("distance_mean"), row.number("reach_mean")];
    let is_blend = |row: &&Row| row.value("strategy").is_some_and(|name| name.to_string().contains("blend"));
    let mut plot = Plot::new(
        "Reachability against comfort, mean of 200 scenes",
        Axis::new("mean distance from the path without force"),
        Axis::new("reachability (nats, 0 is best)"),
    )
    .line("blend, weights 6 to 1", rows.iter().rev().filter(is_blend).map(point).collect::<Vec<_>>());
    // The printed algorithm diverges and would squeeze all else into a corner; its row is in the table.
    let shown = rows.iter().filter(|row| !is_blend(row) && row.number("distance_mean") < 1.0);
    for row in shown {
        let name = row.value("strategy").and_then(serde_json::Value::as_str).unwrap_or_default();
        plot = plot.scatter(name, [point(row)]);
    }
    Drawing {
        stem: "table-5".into(),
        figure: Figure::single(plot).panel_size(760, 460),
        caption:
            "Upper left is better. Chapter 5 is a compromise between chapters 3 and 4; the blend reaches the same \
                  compromise or a better one with fewer contacts, and its weight is the operator's choice. The printed \
                  algorithm of chapter 5 lies far outside."
                .into(),
    }
}

fn remarks() -> Vec<String> {
    [
        "Reachability is the log density of the best limb through a place less the best possible, averaged over the \
         path; inside_share is the share of the path where some limb has both joints in a 95 % region; distance is the \
         mean distance to the reference force path. Neither criterion decides alone.",
        "The printed algorithm 3 diverges in most scenes: near the goal the direction of the limb is noise, and the goal \
         runs away. One guard mends it: no new goal is drawn within two relaxation radii of the present one.",
        "Chapter 5 does not dominate: it lies between chapters 3 and 4 in both criteria. Finding the comfort path first \
         and moving it towards the movement space once needs a tenth of the contacts.",
    ]
    .map(ToOwned::to_owned)
    .to_vec()
}

/// The thesis' four scenes (their numbers of Gaussians; the rest is drawn), with the three chapters' paths and a blend.
///
/// # Errors
/// As [`table`].
pub fn figures(seed: u64) -> Result<Findings, ExperimentError> {
    const SHOWN: [(Contestant, &str, Colour); 4] = [
        (Contestant::Chapter3, "chapter 3", Colour::Black),
        (Contestant::Chapter4(SecondMoment::Norm), "chapter 4", Colour::Blue),
        (Contestant::Recommended, "chapter 5", Colour::BluishGreen),
        (Contestant::Blend(4.0), "blend", Colour::Orange),
    ];
    let mut findings = Findings::default();
    let mut panels = Vec::new();
    for (index, components) in FOUR.into_iter().enumerate() {
        let number = index as u64;
        let scene = Scene::random(components, DEVIATION, seed_of(seed, number))?;
        let mut plot = scene_plot(&scene, index + 1);
        for (contestant, name, colour) in SHOWN {
            let outcome = run_one(contestant, &scene, seed_of(seed, number))?;
            plot = plot.with(Layer::line(name, flat(&outcome.path)).coloured(colour));
            findings.rows.push(
                Row::of("figures-5")
                    .with("scene", number + 1)
                    .with("strategy", contestant.name())
                    .with("reach", outcome.reach)
                    .with("inside_share", outcome.inside)
                    .with("distance", outcome.distance)
                    .with("iterations", outcome.iterations)
                    .with("contacts", outcome.contacts),
            );
        }
        panels.push(plot);
    }
    findings.drawings.push(Drawing {
        stem: "figures-5".into(),
        figure: Figure::grid("", 2, panels).panel_size(520, 340),
        caption: "Figures 5.2 to 5.7 in one: the 95 % regions of the joints' Gaussians (the denser the heavier), the \
                  reference force path, and the paths of the three chapters and of the blend. The thesis gives only the \
                  numbers of Gaussians; everything else is drawn from the seed."
            .into(),
    });
    Ok(findings)
}

fn scene_plot(scene: &Scene, number: usize) -> Plot {
    let deviations = Space::Planar.region_95().sqrt();
    let ellipses = scene.space.dressed().into_iter().flat_map(crate::modelling::Mixture::components).map(|component| {
        let (mean, covariance) = (component.mean(), component.covariance());
        let rows = [[covariance.m11, covariance.m12], [covariance.m21, covariance.m22]];
        Layer::ellipse("movement space", [mean.x, mean.y], rows, deviations, 0.3 * component.weight())
            .coloured(Colour::SkyBlue)
    });
    let reference = Layer::line("reference force path", flat(scene.reference.points()))
        .coloured(Colour::Vermillion)
        .dashed(Dash::Dashed);
    Plot::new(format!("Scene {number}"), Axis::new("x"), Axis::new("y"))
        .equal_units()
        .with_all(ellipses.collect::<Vec<_>>())
        .with(reference)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn mean(contestant: Contestant, value: fn(&Outcome) -> f64) -> f64 {
        let outcomes = (0..12).map(|seed| run_one(contestant, &Scene::any(DEVIATION, seed).unwrap(), seed).unwrap());
        outcomes.map(|outcome| value(&outcome)).sum::<f64>() / 12.0
    }

    #[test]
    fn the_printed_algorithm_runs_away_and_the_guard_mends_it() {
        let length = |contestant| mean(contestant, |outcome| outcome.length);
        assert!(length(Contestant::Literal) > 3.0 * length(Contestant::Recommended));
    }

    #[test]
    fn force_alone_is_most_comfortable_and_the_movement_space_alone_most_reachable() {
        let reach = |contestant| mean(contestant, |outcome| outcome.reach);
        let distance = |contestant| mean(contestant, |outcome| outcome.distance);
        let (gmm, force) = (Contestant::Chapter3, Contestant::Chapter4(SecondMoment::Norm));
        assert!(distance(force) < distance(Contestant::Recommended));
        assert!(distance(Contestant::Recommended) < distance(gmm));
        assert!(reach(gmm) > reach(force));
        let blend = Contestant::Blend(4.0);
        assert!(distance(blend) < distance(gmm) && reach(blend) > reach(force));
    }
}
