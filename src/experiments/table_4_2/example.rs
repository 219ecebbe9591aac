//! Figures 4.9 to 4.15 of the thesis: one experiment pass by pass, with what was planned, travelled, felt and changed.

use super::dresser::{DressingRecord, PassRecord};
use super::present::sixty;
use crate::experiments::findings::{Drawing, ExperimentError, Findings, Row};
use crate::report::plot::{Axis, Colour, Dash, Figure, Layer, Marker, Plot, View, path_in, project};
use crate::strategy::Rule;

/// The energies of the thesis' example in newtons, iteration by iteration (figure 4.15).
const THESIS_ENERGIES: [f64; 3] = [22.21, 8.54, 0.0];

/// The experiment of the cohort that is most like the thesis' example.
///
/// # Errors
/// Where a shipped profile is unusable or an experiment cannot be run.
pub fn worked_example(seed: u64) -> Result<Findings, ExperimentError> {
    let records = sixty(seed)?;
    let example = likest(&records)?;
    let rows = example.passes.iter().zip(1..).map(|(pass, iteration)| {
        Row::of("4.15")
            .with("iteration", iteration)
            .with("energy_newtons", pass.summary.energy)
            .with("resistances", pass.summary.contacts)
            .with("waypoints", pass.summary.path.len())
            .with("duration_seconds", pass.duration_seconds())
            .with("thesis_energy_newtons", THESIS_ENERGIES.get(iteration - 1).copied())
    });
    Ok(Findings { rows: rows.collect(), drawings: drawings(&records)?, ..Findings::default() })
}

/// The figures of the example among some experiments.
pub(super) fn drawings(records: &[DressingRecord]) -> Result<Vec<Drawing>, ExperimentError> {
    let example = likest(records)?;
    let panels = example.passes.iter().zip(1..).map(|(pass, iteration)| panel(pass, iteration));
    let energies = |energies: &mut dyn Iterator<Item = f64>| -> Vec<[f64; 2]> {
        energies.zip(1..).map(|(energy, iteration)| [f64::from(iteration), energy]).collect()
    };
    let simulated = energies(&mut example.passes.iter().map(|pass| pass.summary.energy));
    let energy = Plot::new("", Axis::new("iteration"), Axis::new("energy (N)").including(0.0))
        .with(Layer::line("simulated", simulated).marked(Marker::Disc))
        .with(
            Layer::line("thesis", energies(&mut THESIS_ENERGIES.into_iter())).dashed(Dash::Dashed).marked(Marker::Ring),
        );
    Ok(vec![
        Drawing {
            stem: "figures-4.9-to-4.14".into(),
            figure: Figure::grid("", 2, panels).panel_size(520, 420),
            caption: "One experiment, iteration by iteration, seen from the robot: the planned path (blue, dashed), what the \
                      gripper travelled (green), resistances (stars), goals that moved with a way-point (red, dashed) and the \
                      path that the next iteration follows (filled)."
                .into(),
        },
        Drawing {
            stem: "figure-4.15".into(),
            figure: Figure::single(energy),
            caption: "Energy by iteration of that experiment, beside the thesis' example.".into(),
        },
    ])
}

/// The experiment with as many passes as the thesis' example whose energies are nearest to its.
fn likest(records: &[DressingRecord]) -> Result<&DressingRecord, ExperimentError> {
    let distance = |record: &DressingRecord| -> f64 {
        let pairs = record.passes.iter().zip(THESIS_ENERGIES);
        let missing = record.passes.len().abs_diff(THESIS_ENERGIES.len()) as f64;
        pairs.map(|(pass, energy)| (pass.summary.energy - energy).abs()).sum::<f64>() + 1e3 * missing
    };
    let nearest = records.iter().min_by(|one, two| distance(one).total_cmp(&distance(two)));
    nearest.ok_or_else(|| ExperimentError::Other("the cohort is empty".into()))
}

fn panel(pass: &PassRecord, iteration: usize) -> Plot {
    let view = View::Front;
    let stars = pass.contacts.iter().map(|contact| project(view, &contact.position));
    let moved =
        pass.contacts.iter().flat_map(|contact| &contact.changes).filter(|change| change.rule == Rule::GoalFollows);
    let moved = moved.map(|change| Layer::line("goal moved", path_in(view, &[change.from, change.to])));
    view.plot(format!("Iteration {iteration}: {:.2} N", pass.summary.energy))
        .with(Layer::line("travelled", path_in(view, &pass.travelled)).coloured(Colour::BluishGreen))
        .with(
            Layer::line("planned", path_in(view, &pass.planned))
                .coloured(Colour::Blue)
                .dashed(Dash::Dashed)
                .marked(Marker::Ring),
        )
        .with_all(moved.map(|layer| layer.coloured(Colour::Vermillion).dashed(Dash::Dotted)))
        .with(Layer::scatter("resistance", stars).coloured(Colour::Vermillion).marked(Marker::Star))
        .with(
            Layer::scatter("updated", path_in(view, &pass.summary.path))
                .coloured(Colour::BluishGreen)
                .marked(Marker::Disc),
        )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_example_has_the_thesis_three_iterations_with_falling_energy_that_ends_at_nothing() {
        let findings = worked_example(1).unwrap();
        let energies: Vec<f64> = findings.rows.iter().map(|row| row.number("energy_newtons")).collect();
        assert_eq!(energies.len(), 3, "{energies:?}");
        assert!(energies[0] > energies[1] && energies[1] > 0.0 && energies[2] == 0.0, "{energies:?}");
        let stems: Vec<&str> = findings.drawings.iter().map(|drawing| drawing.stem.as_str()).collect();
        assert_eq!(stems, ["figures-4.9-to-4.14", "figure-4.15"]);
    }

    #[test]
    fn of_no_experiments_none_is_the_example() {
        assert!(likest(&[]).is_err());
    }
}
