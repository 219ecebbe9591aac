//! Figures 5.8 to 5.10 of the thesis: three people with movement limits, dressed by the strategies of chapters 3, 4 and 5.
//!
//! As in section 5.2.2 each person's movement is recorded first and modelled, the initial path lies where the joints are
//! most often, and the person likes a movement within the limits best.

use super::dresser::{DressingRecord, dress_with};
use super::present::other;
use crate::body::{PerSide, Side};
use crate::experiments::findings::{Drawing, ExperimentError, Findings, Row};
use crate::geometry::Curve;
use crate::modelling::stick::{Space, StickFit};
use crate::modelling::{ArmSpace, FitSettings, Mixture, MovementSpace};
use crate::planning::criteria::{Reach, comfort};
use crate::report::plot::{Colour, Dash, Figure, Layer, Marker, Plot, View, covariance_in, path_in, project};
use crate::sim::WorldSetup;
use crate::sim::person::{MovementKind, SimulatedPerson};
use crate::strategy::StrategyKind;
use rayon::prelude::*;

/// How far the liked movement lies from the straight one for a flexible arm, in metres (ours: beyond the free play).
const LIKED_METRES: f64 = 0.09;
/// The less flexible arm's share of the movement (thesis figure 5.10; ours).
const LESS_FLEXIBLE: f64 = 0.4;
/// Paths are judged every centimetre, and lie on the liked one within the free play of a sleeve.
const SPACING_METRES: f64 = 0.01;
const PLAY_METRES: f64 = 0.035;

/// One of the thesis' three kinds of limits.
#[derive(Clone, Copy)]
struct Limit {
    figure: &'static str,
    name: &'static str,
    kind: MovementKind,
    left_share: f64,
    /// Direction of the liked movement: forward, outward, up.
    liked: [f64; 3],
}

const LIMITS: [Limit; 3] = [
    Limit { figure: "5.8", name: "left_right", kind: MovementKind::LeftRight, left_share: 1.0, liked: [0.0, 1.0, 0.0] },
    Limit {
        figure: "5.9",
        name: "forward_backward",
        kind: MovementKind::ForwardBackward,
        left_share: 1.0,
        liked: [-1.0, 0.0, 0.0],
    },
    Limit {
        figure: "5.10",
        name: "left_arm_less_flexible",
        kind: MovementKind::UpDown,
        left_share: LESS_FLEXIBLE,
        liked: [0.0, 0.0, 1.0],
    },
];

const STRATEGIES: [(StrategyKind, &str); 3] =
    [(StrategyKind::Gmm, "chapter 3"), (StrategyKind::Force, "chapter 4"), (StrategyKind::Multimodal, "chapter 5")];

impl Limit {
    fn person(&self) -> SimulatedPerson {
        let mut person = SimulatedPerson::default();
        let arm = |share: f64| {
            let mut arm = person.right.clone();
            (arm.movement.kind, arm.movement.flexibility_share) = (self.kind, share);
            arm.preferred_offset_metres = self.liked.map(|part| part * LIKED_METRES * share);
            arm
        };
        (person.left, person.right) = (Some(arm(self.left_share)), arm(1.0));
        person
    }
}

/// What came of one strategy on one arm.
struct Outcome {
    side: Side,
    strategy: usize,
    record: DressingRecord,
}

/// The three figures: each person's movement spaces with the final paths of the three strategies, and how reachable and how
/// comfortable they are.
///
/// # Errors
/// Where a movement space cannot be fitted or an experiment cannot be run.
pub fn figures_5_real(seed: u64) -> Result<Findings, ExperimentError> {
    let mut findings = Findings::default();
    for limit in LIMITS {
        let person = limit.person();
        let seen = person.exercise(seed);
        let fitted = |side| ArmSpace::fit(seen.get(side), &FitSettings::default(), seed).map_err(other);
        let spaces = MovementSpace { arms: PerSide { left: fitted(Side::Left)?, right: fitted(Side::Right)? } };
        let outcomes = outcomes(&person, &spaces, seed)?;
        findings.rows.extend(outcomes.iter().map(|outcome| row(&limit, &person, &spaces.arms, outcome)));
        findings.drawings.push(drawing(&limit, &spaces.arms, &outcomes));
    }
    findings.remarks.push(
        "Reach is the mean over the path of the log density of the best limb, less the best possible (0 is best); distance is \
         the mean distance from the path that the simulated person likes best, which no strategy sees. The people are \
         simulated: the movement of each was recorded, modelled and dressed as in section 5.2.2."
            .into(),
    );
    Ok(findings)
}

fn outcomes(person: &SimulatedPerson, spaces: &MovementSpace, seed: u64) -> Result<Vec<Outcome>, ExperimentError> {
    let cases: Vec<(Side, usize)> =
        Side::BOTH.into_iter().flat_map(|side| (0..STRATEGIES.len()).map(move |strategy| (side, strategy))).collect();
    let run = |(side, strategy): (Side, usize)| {
        let setup = WorldSetup { person: person.clone(), seed, ..WorldSetup::default() };
        let kind = STRATEGIES.get(strategy).map_or(StrategyKind::Force, |(kind, _)| *kind);
        let record = dress_with(&setup, side, kind, Some(spaces)).map_err(other)?;
        Ok(Outcome { side, strategy, record })
    };
    cases.into_par_iter().map(run).collect()
}

fn row(limit: &Limit, person: &SimulatedPerson, spaces: &PerSide<ArmSpace>, outcome: &Outcome) -> Row {
    let Outcome { side, strategy, record } = outcome;
    let space = spaces.get(*side);
    let last = record.passes.last();
    let path = last.map(|pass| pass.summary.path.clone()).unwrap_or_default();
    let [hand, elbow, shoulder] = person.posture().get(*side).dressed();
    let initial = [hand, elbow, shoulder];
    let reach = Reach::new(space.clone(), &initial, StickFit::new(Space::Spatial)).along(&path, SPACING_METRES);
    let comfort = comfort(&path, &Curve::new(person.preferred_path(*side)), PLAY_METRES, SPACING_METRES);
    let components = |mixture: &Mixture| mixture.components().len();
    Row::of(limit.figure)
        .with("limits", limit.name)
        .with("arm", side.to_string())
        .with("strategy", STRATEGIES.get(*strategy).map(|(_, name)| *name))
        .with("components_hand", components(&space.hand))
        .with("components_elbow", components(&space.elbow))
        .with("components_shoulder", components(&space.shoulder))
        .with("iterations", record.iterations())
        .with("energy_newtons", record.energy_newtons())
        .with("energy_newtons_last", last.map(|pass| pass.summary.energy))
        .with("reach", reach.score)
        .with("inside_share", reach.inside_share)
        .with("distance_metres", comfort.mean_distance)
}

/// The colours of hand, elbow and shoulder as in the thesis: black, green and cyan on the left; red, blue and yellow on the
/// right.
const COLOURS: PerSide<[Colour; 3]> = PerSide {
    left: [Colour::Black, Colour::BluishGreen, Colour::SkyBlue],
    right: [Colour::Vermillion, Colour::Blue, Colour::Yellow],
};

fn drawing(limit: &Limit, spaces: &PerSide<ArmSpace>, outcomes: &[Outcome]) -> Drawing {
    let panels = STRATEGIES.iter().enumerate().map(|(strategy, (_, name))| {
        let plot = View::Front.plot(*name).with_all(ellipses(spaces));
        outcomes.iter().filter(|outcome| outcome.strategy == strategy).fold(plot, with_paths)
    });
    Drawing {
        stem: format!("figure-{}", limit.figure),
        figure: Figure::grid("", 3, panels).panel_size(420, 380),
        caption: format!(
            "Movement limits '{}': movement spaces of hand, elbow and shoulder (two deviations), the initial path (dashed) and \
             the final one, seen from the robot.",
            limit.name
        ),
    }
}

fn ellipses(spaces: &PerSide<ArmSpace>) -> Vec<Layer> {
    let of_arm = |side: Side| {
        let joints = spaces.get(side).dressed().into_iter().zip(COLOURS.get(side));
        joints.flat_map(|(mixture, colour)| mixture.components().iter().map(move |component| (component, *colour)))
    };
    let layer = |(component, colour): (&crate::modelling::mixture::Component, Colour)| {
        let covariance = (*component.covariance()).into();
        let centre = project(View::Front, &component.mean().to_owned().into());
        let strength = 0.15 + 0.5 * component.weight();
        Layer::ellipse("", centre, covariance_in(View::Front, &covariance), 2.0, strength).coloured(colour)
    };
    Side::BOTH.into_iter().flat_map(of_arm).map(layer).collect()
}

fn with_paths(plot: Plot, outcome: &Outcome) -> Plot {
    let view = View::Front;
    let path = |pass: Option<&[crate::geometry::Point]>| path_in(view, pass.unwrap_or_default());
    let first = path(outcome.record.passes.first().map(|pass| pass.planned.as_slice()));
    let last = path(outcome.record.passes.last().map(|pass| pass.summary.path.as_slice()));
    plot.with(Layer::line("initial", first).coloured(Colour::Black).dashed(Dash::Dashed).marked(Marker::Ring))
        .with(Layer::line("final", last).coloured(Colour::Blue).marked(Marker::Disc))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn three_people_two_arms_three_strategies_comfort_costs_reach() {
        let findings = figures_5_real(1).unwrap();
        assert_eq!((findings.rows.len(), findings.drawings.len()), (18, 3));
        let mean = |strategy: &str, name: &str| {
            let rows = findings.rows.iter().filter(|row| row.value("strategy").unwrap() == strategy);
            rows.map(|row| row.number(name)).sum::<f64>() / 6.0
        };
        for learned in ["chapter 4", "chapter 5"] {
            assert!(mean(learned, "distance_metres") < 0.5 * mean("chapter 3", "distance_metres"));
            assert!(mean(learned, "energy_newtons_last").abs() < 1e-9);
            assert!(mean("chapter 3", "reach") > mean(learned, "reach"));
        }
    }
}
