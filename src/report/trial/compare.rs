//! The page that compares several trials: one row a trial, the strategies side by side, learning and last paths.

use super::answers::STATEMENTS;
use super::page::{Drawings, Sketch};
use super::{Iteration, TrialRecord, figures};
use crate::body::Side;
use crate::report::page::Page;
use crate::report::plot::PlotError;
use crate::strategy::StrategyKind;
use std::path::{Path, PathBuf};

const NOTHING: &str = "\u{2013}";

/// Writes the page that compares several trials, `index.html`.
///
/// # Errors
/// [`PlotError`] names the file that could not be written.
pub fn compare(trials: &[TrialRecord], folder: &Path) -> Result<PathBuf, PlotError> {
    let mut page = Page::new("Trials compared", &format!("{} trials side by side", trials.len()));
    page.section("Trials");
    let rows: Vec<_> = trials.iter().map(trial_row).collect();
    let head = [
        "trial",
        "person",
        "strategy",
        "seed",
        "iterations",
        "first energy, both arms (N)",
        "last energy, both arms (N)",
        "duration (s)",
        "outcome",
    ];
    page.table("Trials", &head, &rows);
    strategies(&mut page, trials);
    let drawings = Drawings::draw(sketches(trials), folder)?;
    page.section("Learning");
    drawings.put(&mut page, "compared-");
    page.section("Last paths");
    for trial in trials {
        drawings.put(&mut page, &format!("{}-last-", trial.name));
    }
    let path = folder.join("index.html");
    page.save(&path)?;
    Ok(path)
}

/// Every figure of the page that compares trials.
fn sketches(trials: &[TrialRecord]) -> Vec<Sketch> {
    let learned = [
        ("energy", "Energy by iteration; dashed: left arm.", figures::energy(trials)),
        ("duration", "Duration of the iterations; dashed: left arm.", figures::duration(trials)),
    ];
    let learned = learned.map(|(part, caption, figure)| Sketch {
        stem: format!("compared-{part}"),
        caption: caption.into(),
        figure,
    });
    let last = |trial: &TrialRecord, side: Side| {
        let pass = trial.passes(side).last()?;
        let caption = format!("{}: the last iteration of the {side} arm.", trial.name);
        Some(Sketch { stem: format!("{}-last-{side}", trial.name), caption, figure: figures::paths(trial, pass) })
    };
    let paths = trials.iter().flat_map(|trial| Side::BOTH.into_iter().filter_map(move |side| last(trial, side)));
    learned.into_iter().chain(paths).collect()
}

fn trial_row(trial: &TrialRecord) -> Vec<String> {
    let newtons = |energy: Option<f64>| energy.map_or(NOTHING.into(), |energy| format!("{energy:.2}"));
    vec![
        trial.name.clone(),
        trial.header.profile.clone(),
        trial.strategy().map_or(NOTHING.into(), |strategy| strategy.to_string()),
        trial.header.seed.to_string(),
        trial.iterations.len().to_string(),
        newtons(energy(trial, |mut passes| passes.next())),
        newtons(energy(trial, Iterator::last)),
        format!("{:.1}", trial.seconds),
        trial.end.as_ref().map_or("not ended".into(), |(outcome, _)| outcome.words().to_owned()),
    ]
}

/// A quantity that strategies are compared by: its name, and its value of a trial where it has one.
type Criterion = (&'static str, fn(&TrialRecord) -> Option<f64>);

/// What the thesis compares by: energy, iterations, execution time, reachability, and how often the person was where they
/// can move to.
const CRITERIA: [Criterion; 8] = [
    ("energy of the first iterations (N)", |trial| energy(trial, |mut passes| passes.next())),
    ("energy of the last iterations (N)", |trial| energy(trial, Iterator::last)),
    ("iterations", |trial| (!trial.iterations.is_empty()).then_some(trial.iterations.len() as f64)),
    ("resistances", |trial| summed(trial, |pass| f64::from(pass.summary.contacts))),
    ("execution time (s)", |trial| Some(trial.seconds)),
    ("time in iterations (s)", |trial| summed(trial, |pass| pass.duration_seconds)),
    ("reachability of the last iterations", |trial| {
        let last = Side::BOTH.into_iter().filter_map(|side| trial.passes(side).last());
        mean(last.filter_map(|pass| pass.summary.reachability))
    }),
    ("poses inside the movement space (%)", |trial| {
        let (inside, poses) = trial
            .compliance
            .iter()
            .fold((0, 0), |(inside, poses), (_, _, count)| (inside + count.inside, poses + count.poses));
        (poses > 0).then(|| 100.0 * inside as f64 / poses as f64)
    }),
];

fn mean(values: impl Iterator<Item = f64>) -> Option<f64> {
    let (sum, count) = values.fold((0.0, 0_u32), |(sum, count), value| (sum + value, count + 1));
    (count > 0).then(|| sum / f64::from(count))
}

fn summed(trial: &TrialRecord, value: impl Fn(&Iteration) -> f64) -> Option<f64> {
    (!trial.iterations.is_empty()).then(|| trial.iterations.iter().map(value).sum())
}

/// The sum over both arms of the energy of one iteration each; `None` where no arm has one.
fn energy<'a>(
    trial: &'a TrialRecord,
    of: impl Fn(Box<dyn Iterator<Item = &'a Iteration> + 'a>) -> Option<&'a Iteration>,
) -> Option<f64> {
    let passes: Vec<f64> = Side::BOTH
        .into_iter()
        .filter_map(|side| of(Box::new(trial.passes(side))).map(|pass| pass.summary.energy))
        .collect();
    (!passes.is_empty()).then(|| passes.iter().sum())
}

/// One column a strategy that was run, one row a criterion; means over the strategy's trials.
fn strategies(page: &mut Page, trials: &[TrialRecord]) {
    let run: Vec<StrategyKind> = StrategyKind::ALL
        .into_iter()
        .filter(|kind| trials.iter().any(|trial| trial.strategy() == Some(*kind)))
        .collect();
    if run.is_empty() {
        return;
    }
    page.section("Strategies side by side");
    let of = |kind: StrategyKind| trials.iter().filter(move |trial| trial.strategy() == Some(kind));
    let count = |kind: StrategyKind| of(kind).count().to_string();
    let counts = std::iter::once("trials".to_owned()).chain(run.iter().map(|kind| count(*kind))).collect();
    let row = |name: &str, value: &dyn Fn(&TrialRecord) -> Option<f64>| {
        let cell = |kind: &StrategyKind| {
            mean(of(*kind).filter_map(value)).map_or(NOTHING.to_owned(), |value| format!("{value:.2}"))
        };
        std::iter::once(name.to_owned()).chain(run.iter().map(cell)).collect()
    };
    let mut rows: Vec<Vec<String>> = vec![counts];
    rows.extend(CRITERIA.map(|(name, value)| row(name, &value)));
    // What people said stands below what was measured, where anybody was asked.
    for statement in &STATEMENTS {
        let answer = |trial: &TrialRecord| trial.answers.to(statement).map(f64::from);
        if trials.iter().any(|trial| answer(trial).is_some()) {
            rows.push(row(&format!("{} (1 to 7)", statement.text), &answer));
        }
    }
    let head: Vec<&str> = std::iter::once("mean of the trials").chain(run.iter().map(|kind| kind.name())).collect();
    page.table("A trial counts for the strategy that it began with", &head, &rows);
}

#[cfg(test)]
mod tests;
