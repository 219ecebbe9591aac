//! How well foreground, body parts and joints are found on simulated people that the forest has not seen.
//!
//! Joints are judged by their centres, not by the skin; the thesis' mean of each part is judged by the same centres beside
//! them. Half of the images come with the empty scene. The errors are those of rendered images, not of a real camera.

use super::findings::{ExperimentError, Findings, Row};
use crate::body::Joint;
use crate::sim::camera::dataset::{Frame, Score};
use crate::vision::{PoseFinder, ViewError, generic};
use rayon::prelude::*;

/// Images, each of another person.
const IMAGES: u64 = 200;
/// People of this seed and on are never trained on.
const FIRST_UNSEEN_PERSON: u64 = 1 << 40;
/// Images that one thread judges at a time.
const PIECE: usize = 10;

/// What was found with the empty scene, and without.
#[derive(Default)]
struct Scores {
    with_empty: Score,
    without_empty: Score,
}

/// Runs it.
///
/// # Errors
/// Where the forest that valet brings along cannot be read, or an image cannot be used.
pub fn run(seed: u64) -> Result<Findings, ExperimentError> {
    let other = |error: &dyn std::fmt::Display| ExperimentError::Other(error.to_string());
    let forest = generic::forest().map_err(|error| other(&error))?;
    let frames: Vec<Frame> = Frame::list(IMAGES, 1, FIRST_UNSEEN_PERSON + (seed << 24)).collect();
    let judge = |frames: &[Frame]| {
        let mut finder = PoseFinder::new(forest.clone());
        frames.iter().try_fold(Scores::default(), |mut scores, frame| {
            let image = frame.render();
            let score = if image.empty.is_some() { &mut scores.with_empty } else { &mut scores.without_empty };
            score.judge(&mut finder, &image)?;
            Ok::<_, ViewError>(scores)
        })
    };
    let pieces: Vec<Scores> =
        frames.par_chunks(PIECE).map(judge).collect::<Result<_, _>>().map_err(|error| other(&error))?;
    let mut scores = Scores::default();
    for piece in pieces {
        scores.with_empty.add(&piece.with_empty);
        scores.without_empty.add(&piece.without_empty);
    }
    Ok(findings(scores))
}

fn findings(scores: Scores) -> Findings {
    let Scores { with_empty, without_empty } = scores;
    let mut rows = vec![parts_row("with", &with_empty), parts_row("without", &without_empty)];
    let mut all = with_empty;
    all.add(&without_empty);
    rows.extend(Joint::ALL.map(|joint| joint_row(joint.name(), all.error(Some(joint)), all.mean_error(Some(joint)))));
    rows.push(joint_row("all", all.error(None), all.mean_error(None)));
    let ratio = |(whole, part): (u64, u64)| part as f64 / whole.max(1) as f64;
    rows.push(
        Row::of("not-seen")
            .with("covered_joints", all.covered.0)
            .with("said_not_seen_share", ratio(all.covered))
            .with("visible_joints", all.visible.0)
            .with("said_seen_share", ratio(all.visible)),
    );
    Findings { rows, ..Findings::default() }
}

fn parts_row(empty_scene: &str, score: &Score) -> Row {
    let (precision, recall) = score.foreground_precision_recall();
    Row::of("parts")
        .with("empty_scene", empty_scene)
        .with("pixel_accuracy", score.accuracy())
        .with("accuracy_over_parts", score.accuracy_over_parts())
        .with("foreground_precision", precision)
        .with("foreground_recall", recall)
}

/// Errors in millimetres; the thesis' rule does not know elbow and wrist.
fn joint_row(name: &str, (mean, most): (f64, f64), thesis: (f64, f64)) -> Row {
    let row = Row::of("joints")
        .with("joint", name)
        .with("error_mean_millimetres", mean * 1e3)
        .with("error_95_percent_millimetres", most * 1e3);
    if thesis.0.is_nan() {
        return row;
    }
    row.with("mean_of_part_error_mean_millimetres", thesis.0 * 1e3)
        .with("mean_of_part_error_95_percent_millimetres", thesis.1 * 1e3)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_name_each_joint_and_what_the_thesis_rule_does_not_know_is_left_out() {
        let found = findings(Scores::default());
        let joints: Vec<_> = found.rows.iter().filter(|row| row.table() == "joints").collect();
        assert_eq!(joints.len(), Joint::ALL.len() + 1);
        assert!(
            joint_row("elbow", (0.02, 0.05), (f64::NAN, f64::NAN))
                .value("mean_of_part_error_mean_millimetres")
                .is_none()
        );
        let error = joint_row("hand", (0.02, 0.05), (0.07, 0.1)).value("error_mean_millimetres").unwrap().as_f64();
        assert!((error.unwrap() - 20.0).abs() < 1e-9);
    }
}
