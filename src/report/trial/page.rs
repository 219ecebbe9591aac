//! The page of a trial.

use super::answers::{Respondent, STATEMENTS, Statement};
use super::{TrialRecord, figures};
use crate::body::Side;
use crate::report::page::Page;
use crate::report::plot::{Figure, PlotError};
use rayon::prelude::*;
use std::fs;
use std::path::{Path, PathBuf};

/// Writes a trial's page and its plots (SVG and PNG) into a folder. Returns the page's file.
///
/// # Errors
/// [`PlotError`] names the file that could not be written.
pub fn write(trial: &TrialRecord, folder: &Path) -> Result<PathBuf, PlotError> {
    let name = &trial.name;
    let drawings = Drawings::draw(sketches(trial), folder)?;
    let header = &trial.header;
    let mut page = Page::new(format!("Trial {name}"), &format!("valet {}, {}", header.software, header.watermark));
    summary(&mut page, trial);
    forces(&mut page, trial, &drawings);
    learning(&mut page, trial, &drawings);
    waypoints(&mut page, trial);
    people(&mut page, trial);
    let path = folder.join(format!("{name}.html"));
    page.save(&path)?;
    Ok(path)
}

/// A figure that is to be drawn: the stem of its files, what stands below it, and what it shows.
pub(super) struct Sketch {
    pub(super) stem: String,
    pub(super) caption: String,
    pub(super) figure: Figure,
}

/// The figures of a page as SVG documents, under the stems of their files.
pub(super) struct Drawings(Vec<(Sketch, String)>);

impl Drawings {
    /// Draws figures side by side on all cores and writes each as SVG and PNG into a folder, which is made where it does
    /// not exist.
    pub(super) fn draw(sketches: Vec<Sketch>, folder: &Path) -> Result<Self, PlotError> {
        fs::create_dir_all(folder).map_err(|source| PlotError::Writing { path: folder.to_path_buf(), source })?;
        let drawn = sketches.into_par_iter().map(|sketch| {
            let document = sketch.figure.save(folder, &sketch.stem)?;
            Ok((sketch, document))
        });
        drawn.collect::<Result<_, PlotError>>().map(Self)
    }

    /// Puts the figures whose stem begins so into a page, in their order. False where there are none.
    pub(super) fn put(&self, page: &mut Page, stem: &str) -> bool {
        let mut any = false;
        for (sketch, document) in self.0.iter().filter(|(sketch, _)| sketch.stem.starts_with(stem)) {
            page.drawing(document, &sketch.caption);
            any = true;
        }
        any
    }
}

/// Every figure of a trial's page.
fn sketches(trial: &TrialRecord) -> Vec<Sketch> {
    let sketch =
        |part: String, caption: String, figure| Sketch { stem: format!("{}-{part}", trial.name), caption, figure };
    let felt = Side::BOTH.into_iter().filter(|side| !trial.forces.get(*side).is_empty());
    let forces = felt.map(|side| {
        let caption = format!("Force at the {side} gripper, the detector's window and what it found.");
        sketch(format!("force-{side}"), caption, figures::force(trial, side))
    });
    let one = std::slice::from_ref(trial);
    let learned = [
        ("energy", "Energy: the sum of the detected resistances of an iteration.", figures::energy(one)),
        ("duration", "Duration of the iterations.", figures::duration(one)),
    ];
    let learned = learned.map(|(part, caption, figure)| sketch(part.into(), caption.into(), figure));
    let paths = trial.iterations.iter().map(|pass| {
        let part = format!("path-{}-{}", pass.side, pass.summary.iteration);
        let caption = "Planned, travelled and updated path; ellipses: two deviations of the movement space.";
        sketch(part, caption.into(), figures::paths(trial, pass))
    });
    let learned = learned.into_iter().filter(|_| !trial.iterations.is_empty());
    forces.chain(learned).chain(paths).collect()
}

fn summary(page: &mut Page, trial: &TrialRecord) {
    let header = &trial.header;
    let end = trial.end.as_ref().map_or("the journal ends before the trial does".to_owned(), |(outcome, reason)| {
        format!("{}: {reason}", outcome.words())
    });
    page.section("Summary").facts([
        ("outcome", end),
        ("person", format!("{} (profile {})", header.profile, header.profile_hash)),
        ("garment", header.garment.clone()),
        ("strategy", trial.strategy().map_or("none was run".to_owned(), |strategy| strategy.to_string())),
        ("seed", header.seed.to_string()),
        ("duration", format!("{:.1} s", trial.seconds)),
        ("steps of the core", trial.reading.steps.to_string()),
    ]);
    for problem in &trial.reading.problems {
        page.notice(&format!("Not readable: {problem}"));
    }
    if trial.reading.lost > 0 {
        page.notice(&format!("{} steps were not recorded: the queue was full.", trial.reading.lost));
    }
    if trial.differences > 0 {
        let count = trial.differences;
        page.notice(&format!("{count} steps are decided otherwise by this version; the plots show its decisions."));
    }
    let rows: Vec<_> = trial.stops.iter().map(|(time, text)| vec![format!("{time:.2}"), text.clone()]).collect();
    if rows.is_empty() {
        page.paragraph("No stop, no hold, no warning.");
    } else {
        page.table("Stops, holds and warnings", &["time (s)", "what and why"], &rows);
    }
}

fn forces(page: &mut Page, trial: &TrialRecord, drawings: &Drawings) {
    page.section("Forces");
    for side in Side::BOTH {
        if !drawings.put(page, &format!("{}-force-{side}", trial.name)) {
            page.paragraph(&format!("No force of the {side} arm was recorded."));
        }
    }
}

fn learning(page: &mut Page, trial: &TrialRecord, drawings: &Drawings) {
    page.section("Iterations");
    if trial.iterations.is_empty() {
        page.paragraph("No iteration was finished.");
        return;
    }
    page.table("Iterations", &ITERATION_HEAD, &iteration_rows(trial));
    for part in ["energy", "duration"] {
        drawings.put(page, &format!("{}-{part}", trial.name));
    }
    page.section("Paths");
    drawings.put(page, &format!("{}-path-", trial.name));
}

const ITERATION_HEAD: [&str; 9] = [
    "arm",
    "strategy",
    "iteration",
    "energy (N)",
    "resistances",
    "way-points",
    "duration (s)",
    "reachability",
    "mean resistance (N)",
];

fn iteration_rows(trial: &TrialRecord) -> Vec<Vec<String>> {
    let number = |value: Option<f64>| value.map_or("\u{2013}".to_owned(), |value| format!("{value:.2}"));
    let row = |pass: &super::Iteration| {
        vec![
            pass.side.to_string(),
            pass.strategy.to_string(),
            pass.summary.iteration.to_string(),
            format!("{:.2}", pass.summary.energy),
            pass.summary.contacts.to_string(),
            pass.summary.path.len().to_string(),
            format!("{:.1}", pass.duration_seconds),
            number(pass.summary.reachability),
            number(pass.summary.mean_resistance),
        ]
    };
    trial.iterations.iter().map(row).collect()
}

fn waypoints(page: &mut Page, trial: &TrialRecord) {
    page.section("Way-points and reasons");
    let place = |point: &crate::geometry::Point| format!("{:.3}, {:.3}, {:.3}", point.x, point.y, point.z);
    let rows: Vec<_> = trial
        .waypoints
        .iter()
        .map(|(time, side, change)| {
            vec![
                format!("{time:.2}"),
                side.to_string(),
                change.iteration.to_string(),
                change.index.to_string(),
                place(&change.from),
                place(&change.to),
                change.to_string(),
            ]
        })
        .collect();
    if rows.is_empty() {
        page.paragraph("No way-point moved.");
    } else {
        let head = ["time (s)", "arm", "iteration", "way-point", "from (m)", "to (m)", "why"];
        page.table("Way-points that moved, in base", &head, &rows);
    }
}

fn people(page: &mut Page, trial: &TrialRecord) {
    page.section("Person and operator");
    let rows: Vec<_> = trial
        .compliance
        .iter()
        .map(|(side, joint, count)| {
            let share = 100.0 * count.inside as f64 / count.poses as f64;
            vec![side.to_string(), joint.to_string(), count.poses.to_string(), format!("{share:.0} %")]
        })
        .collect();
    if rows.is_empty() {
        page.paragraph("The profile has no movement space: compliance with it cannot be told.");
    } else {
        page.table("Poses inside the 95 % region of the movement space", &["arm", "joint", "poses", "inside"], &rows);
    }
    let notes: Vec<_> = trial.notes.iter().map(|(time, text)| vec![format!("{time:.2}"), text.clone()]).collect();
    if notes.is_empty() {
        page.paragraph("The operator wrote no notes.");
    } else {
        page.table("Notes of the operator", &["time (s)", "note"], &notes);
    }
    questionnaire(page, trial, Respondent::Participant, "Participant");
    questionnaire(page, trial, Respondent::Operator, "Operator");
}

/// The answers that were given, and a scale to be marked by hand where none was.
fn questionnaire(page: &mut Page, trial: &TrialRecord, respondent: Respondent, title: &str) {
    let statements = STATEMENTS.iter().filter(|statement| statement.respondent == respondent);
    let row = |statement: &Statement| {
        let answer = trial.answers.to(statement);
        let cell = answer.map_or_else(|| "1   2   3   4   5   6   7".to_owned(), |answer| answer.to_string());
        vec![statement.text.to_owned(), cell]
    };
    let rows: Vec<_> = statements.clone().map(row).collect();
    let is_open = statements.clone().all(|statement| trial.answers.to(statement).is_none());
    let title = if is_open { format!("{title} (to be filled in by hand)") } else { title.to_owned() };
    page.table(&title, &["statement", "1 disagree \u{2013} 7 agree"], &rows);
}
