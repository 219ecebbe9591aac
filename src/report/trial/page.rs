//! The page of a trial.

use super::{TrialRecord, figures};
use crate::body::Side;
use crate::report::page::Page;
use crate::report::plot::{Figure, PlotError};
use std::fs;
use std::path::{Path, PathBuf};

/// Writes a trial's page and its plots (SVG and PNG) into a folder. Returns the page's file.
///
/// # Errors
/// [`PlotError`] names the file that could not be written.
pub fn write(trial: &TrialRecord, folder: &Path) -> Result<PathBuf, PlotError> {
    let name = trial.name.clone();
    fs::create_dir_all(folder).map_err(|source| PlotError::Writing { path: folder.to_path_buf(), source })?;
    let header = &trial.header;
    let mut page = Page::new(format!("Trial {name}"), &format!("valet {}, {}", header.software, header.watermark));
    summary(&mut page, trial);
    let mut sheet = Sheet { page: &mut page, folder, name: &name };
    forces(&mut sheet, trial)?;
    learning(&mut sheet, trial)?;
    waypoints(sheet.page, trial);
    people(sheet.page, trial);
    let path = folder.join(format!("{name}.html"));
    page.save(&path)?;
    Ok(path)
}

/// A page with the folder that its plots go to as files.
pub(super) struct Sheet<'a> {
    pub(super) page: &'a mut Page,
    pub(super) folder: &'a Path,
    pub(super) name: &'a str,
}

impl Sheet<'_> {
    /// Draws a figure into the page and writes it beside it as SVG and PNG.
    pub(super) fn figure(&mut self, figure: &Figure, part: &str, caption: &str) -> Result<(), PlotError> {
        figure.save(self.folder, &format!("{}-{part}", self.name))?;
        self.page.figure(figure, caption).map(drop)
    }
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

fn forces(sheet: &mut Sheet<'_>, trial: &TrialRecord) -> Result<(), PlotError> {
    sheet.page.section("Forces");
    for side in Side::BOTH {
        if trial.forces.get(side).is_empty() {
            sheet.page.paragraph(&format!("No force of the {side} arm was recorded."));
            continue;
        }
        let caption = format!("Force at the {side} gripper, the detector's window and what it found.");
        sheet.figure(&figures::force(trial, side), &format!("force-{side}"), &caption)?;
    }
    Ok(())
}

fn learning(sheet: &mut Sheet<'_>, trial: &TrialRecord) -> Result<(), PlotError> {
    sheet.page.section("Iterations");
    if trial.iterations.is_empty() {
        sheet.page.paragraph("No iteration was finished.");
        return Ok(());
    }
    let one = std::slice::from_ref(trial);
    sheet.page.table("Iterations", &ITERATION_HEAD, &iteration_rows(trial));
    sheet.figure(&figures::energy(one), "energy", "Energy: the sum of the detected resistances of an iteration.")?;
    sheet.figure(&figures::duration(one), "duration", "Duration of the iterations.")?;
    sheet.page.section("Paths");
    for pass in &trial.iterations {
        let part = format!("path-{}-{}", pass.side, pass.summary.iteration);
        let caption = "Planned, travelled and updated path; ellipses: two deviations of the movement space.";
        sheet.figure(&figures::paths(trial, pass), &part, caption)?;
    }
    Ok(())
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
    let blank = |question: &str| vec![question.to_owned(), "1   2   3   4   5   6   7".to_owned()];
    let participant = [
        "The robot dressed me successfully.",
        "The force that I felt was appropriate.",
        "I was comfortable.",
        "The robot coped with my movement.",
    ];
    let operator = ["I knew at every moment what the robot would do next.", "I could have stopped it at any moment."];
    let head = ["statement", "1 disagree \u{2013} 7 agree"];
    page.table("Participant (to be filled in by hand)", &head, &participant.map(blank));
    page.table("Operator (to be filled in by hand)", &head, &operator.map(blank));
}
