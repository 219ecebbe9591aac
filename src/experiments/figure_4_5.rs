//! Thesis figure 4.5: eight pairs of paths and the path after each iteration.

use super::findings::{Drawing, ExperimentError, Findings, Row};
use super::synthetic::{Pair, PairSet, SensorError, seed_of};
use super::table_4_1::{Contestant, rehearse_pair};
use crate::geometry::Point;
use crate::planning::{Method, SecondMoment};
use crate::report::plot::{Axis, Colour, Figure, Layer, Marker, Plot};

/// As many examples as the thesis shows.
const EXAMPLES: u64 = 8;

/// Eight examples with Adam, the thesis' method.
///
/// # Errors
/// [`ExperimentError`] where the strategy refuses.
pub fn run(seed: u64) -> Result<Findings, ExperimentError> {
    let mut findings = Findings::default();
    let mut panels = Vec::new();
    for example in 0..EXAMPLES {
        let set = if example % 2 == 0 { PairSet::C } else { PairSet::A };
        let pair = Pair::random(set, seed_of(seed, example));
        let mut strategy = Contestant::Optimiser(Method::Adam, SecondMoment::Norm).strategy(&pair, false);
        let summaries = rehearse_pair(strategy.as_mut(), &pair, SensorError::None, seed)?;
        findings.rows.extend(summaries.iter().map(|summary| {
            Row::of("figure-4.5")
                .with("example", example + 1)
                .with("iteration", summary.iteration)
                .with("energy", summary.energy)
                .with("contacts", summary.contacts)
                .with("waypoints", summary.path.len())
                .with("error", pair.error(&summary.path))
        }));
        let (last, before) = summaries.split_last().map_or((None, &[][..]), |(last, before)| (Some(last), before));
        let mut plot = Plot::new(format!("Example {}", example + 1), Axis::new("x"), Axis::new("y")).equal_units();
        for summary in before {
            let line = Layer::line("after each iteration", flat(&summary.path)).coloured(Colour::SkyBlue);
            plot = plot.with(line);
        }
        let final_points = last.map(|last| flat(&last.path)).unwrap_or_default();
        panels.push(
            plot.with(Layer::line("initial path", flat(&pair.initial)).coloured(Colour::ReddishPurple))
                .with(Layer::line("optimal path", flat(pair.optimal.points())).coloured(Colour::Vermillion))
                .with(Layer::scatter("final way-points", final_points).coloured(Colour::Black).marked(Marker::Disc)),
        );
    }
    findings.drawings.push(Drawing {
        stem: "figure-4.5".into(),
        figure: Figure::grid("", 2, panels).panel_size(460, 260),
        caption:
            "Eight examples of the iterations with Adam. As in the thesis, the final way-points lie on the optimal \
                  path within the threshold; unlike there, far more way-points are kept on strongly bent paths."
                .into(),
    });
    Ok(findings)
}

pub(super) fn flat(path: &[Point]) -> Vec<[f64; 2]> {
    path.iter().map(|point| [point.x, point.y]).collect()
}
