//! The figures of a trial: forces, energy, paths, durations.

use super::{Iteration, TrialRecord};
use crate::body::{Joint, Side};
use crate::report::plot::{Axis, Colour, Dash, Figure, Layer, Marker, Plot, View, covariance_in, path_in, project};

/// Samples further apart than this are not joined: half a second without force is a gap, in seconds.
const GAP_SECONDS: f64 = 0.5;
/// Points of a force line: more cannot be told apart on paper. Each column keeps its lowest and highest sample.
const COLUMNS: usize = 700;

/// Force and the detector's statistic of an arm over the trial, with the resistances that were found.
pub(super) fn force(trial: &TrialRecord, side: Side) -> Figure {
    let time = |stamp: crate::time::Stamp| stamp.since(trial.began).as_secs_f64();
    let samples = trial.forces.get(side);
    let magnitude: Vec<_> = samples.iter().map(|sample| [time(sample.stamp), sample.magnitude()]).collect();
    let statistic: Vec<_> =
        samples.iter().map(|sample| [time(sample.stamp), sample.statistic.unwrap_or(f64::NAN)]).collect();
    let found = trial.detections.get(side).iter().map(|found| [time(found.stamp), found.magnitude]);
    let threshold = *trial.thresholds.get(side);
    let mut plot = Plot::new(format!("{side} arm"), Axis::new("time (s)"), Axis::new("force (N)").including(0.0))
        .with(Layer::line("force", enveloped(&magnitude)).coloured(Colour::SkyBlue).wide(1.2))
        .with(Layer::line("window statistic", enveloped(&statistic)).coloured(Colour::Blue).wide(1.2))
        .with(Layer::scatter("resistance", found).marked(Marker::Star).coloured(Colour::Vermillion));
    if threshold > 0.0 {
        plot = plot.with(Layer::across(format!("threshold {threshold:.1} N"), threshold).coloured(Colour::Vermillion));
    }
    for (seconds, _) in &trial.stops {
        plot = plot.with(Layer::upright("hold, warning or stop", *seconds).coloured(Colour::Black));
    }
    Figure::single(plot).panel_size(900, 320)
}

/// The lowest and highest point of each column, so that a spike of one sample is still drawn; gaps stay gaps.
fn enveloped(points: &[[f64; 2]]) -> Vec<[f64; 2]> {
    let size = points.len().div_ceil(COLUMNS).max(1);
    let mut line: Vec<[f64; 2]> = Vec::new();
    for column in points.chunks(size) {
        let Some(first) = column.first() else { continue };
        if line.last().is_some_and(|last| first[0] - last[0] > GAP_SECONDS) {
            line.push([first[0], f64::NAN]);
        }
        let low = column.iter().min_by(|left, right| left[1].total_cmp(&right[1]));
        let high = column.iter().max_by(|left, right| left[1].total_cmp(&right[1]));
        let mut pair: Vec<[f64; 2]> = low.into_iter().chain(high).copied().collect();
        pair.sort_by(|left, right| left[0].total_cmp(&right[0]));
        line.extend(pair);
    }
    line
}

/// Energy by iteration, a line an arm and trial (thesis figure 4.15).
pub(super) fn energy(trials: &[TrialRecord]) -> Figure {
    by_iteration(trials, "energy (N)", |iteration| iteration.summary.energy)
}

/// Duration by iteration.
pub(super) fn duration(trials: &[TrialRecord]) -> Figure {
    by_iteration(trials, "duration (s)", |iteration| iteration.duration_seconds)
}

fn by_iteration(trials: &[TrialRecord], quantity: &str, value: impl Fn(&Iteration) -> f64) -> Figure {
    let markers = [Marker::Disc, Marker::Square, Marker::Triangle, Marker::Ring, Marker::Cross];
    let mut plot = Plot::new("", Axis::new("iteration").whole(), Axis::new(quantity).including(0.0));
    let mut number = 0;
    for trial in trials {
        for side in Side::BOTH {
            let points: Vec<_> =
                trial.passes(side).map(|pass| [f64::from(pass.summary.iteration), value(pass)]).collect();
            if points.is_empty() {
                continue;
            }
            let marker = markers.get(number % markers.len()).copied().unwrap_or_default();
            let dash = if side == Side::Left { Dash::Dashed } else { Dash::Solid };
            plot = plot.with(Layer::line(label(trial, side, trials.len()), points).marked(marker).dashed(dash));
            number += 1;
        }
    }
    Figure::single(plot)
}

fn label(trial: &TrialRecord, side: Side, trials: usize) -> String {
    let strategy = trial.strategy().map_or("no strategy", crate::strategy::StrategyKind::name);
    if trials > 1 { format!("{strategy}, {side}, {}", trial.name) } else { format!("{side} arm") }
}

/// One pass in top and front view: planned, travelled and updated path with the movement space (figures 4.9 to 4.16 and
/// 5.8 to 5.10).
pub(super) fn paths(trial: &TrialRecord, iteration: &Iteration) -> Figure {
    let plots = [View::Top, View::Front].map(|view| {
        let ellipses = iteration.ellipses.iter().map(|ellipse| {
            let (label, colour) = looks(ellipse.joint);
            let covariance = covariance_in(view, &ellipse.covariance);
            Layer::ellipse(label, project(view, &ellipse.mean), covariance, 2.0, ellipse.weight).coloured(colour)
        });
        let places = trial
            .waypoints
            .iter()
            .filter(|(_, side, change)| *side == iteration.side && change.iteration == iteration.summary.iteration);
        let places = places.map(|(_, _, change)| project(view, &change.from));
        let planned = Layer::line("planned", path_in(view, &iteration.planned)).dashed(Dash::Dashed);
        let updated = Layer::line("updated", path_in(view, &iteration.summary.path));
        view.plot(view.name())
            .with_all(ellipses)
            .with(planned.marked(Marker::Ring).coloured(Colour::Blue))
            .with(Layer::line("travelled", path_in(view, &iteration.travelled)).coloured(Colour::Grey).wide(1.2))
            .with(updated.marked(Marker::Disc).coloured(Colour::BluishGreen))
            .with(Layer::scatter("resistance", places).marked(Marker::Star).coloured(Colour::Vermillion))
    });
    let title = format!("{} arm, iteration {}, {}", iteration.side, iteration.summary.iteration, iteration.strategy);
    Figure::grid(title, 2, plots).panel_size(440, 420)
}

const fn looks(joint: Joint) -> (&'static str, Colour) {
    match joint {
        Joint::Elbow | Joint::Forearm => ("movement space: elbow", Colour::Orange),
        Joint::Shoulder | Joint::UpperArm => ("movement space: shoulder", Colour::ReddishPurple),
        Joint::Hand | Joint::Wrist => ("movement space: hand", Colour::SkyBlue),
    }
}
