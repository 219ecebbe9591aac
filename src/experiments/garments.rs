//! The two models of the garment against each other: the same passes beside the path that the person likes best.
//!
//! The reduced model is fast and was fitted to the thesis' table 4.2; the armhole of cloth knows nothing of that table. Where
//! both say the same of a displaced path, the fast one can be believed. No noise, no robot: the forces themselves.

use super::findings::{Drawing, ExperimentError, Findings, Row};
use crate::body::Side;
use crate::geometry::{Point, Vector};
use crate::report::plot::{Axis, Figure, Layer, Marker, Plot};
use crate::sim::SimError;
use crate::sim::person::SimulatedPerson;
use crate::sim::rig::{BEAT_SECONDS, Rig};
use crate::sim::world::{Backend, WorldSetup};
use crate::sim::wrench::WrenchErrors;
use rayon::prelude::*;

/// The gripper's speed in metres per second (thesis section 3.5).
const SPEED: f64 = 0.1;
/// How far the elbow's way-point is moved, in metres.
const DISPLACEMENTS: [f64; 7] = [0.0, 0.03, 0.06, 0.09, 0.12, 0.15, 0.18];
/// In which direction, in `base`.
const DIRECTIONS: [(&str, [f64; 3]); 2] = [("up", [0.0, 0.0, 1.0]), ("forward", [1.0, 0.0, 0.0])];

/// What a gripper felt on one pass, in newtons.
#[derive(Clone, Copy, Debug)]
struct Felt {
    mean: f64,
    peak: f64,
}

/// Direction and length of a displacement, what is felt with the cloth, and with the reduced model.
type Case = (&'static str, f64, Felt, Felt);

/// Force on the gripper by how far the path is from the liked one, with both models.
///
/// # Errors
/// Where a pass cannot be run.
pub fn run(seed: u64) -> Result<Findings, ExperimentError> {
    let cases: Vec<(usize, f64)> = (0..DIRECTIONS.len())
        .flat_map(|direction| DISPLACEMENTS.into_iter().map(move |displacement| (direction, displacement)))
        .collect();
    let felt = |(index, displacement): (usize, f64)| {
        let (name, direction) = DIRECTIONS.get(index).copied().unwrap_or_default();
        let offset = Vector::from(direction) * displacement;
        Ok((name, displacement, pass(Backend::Cloth, offset, seed)?, pass(Backend::Reduced, offset, seed)?))
    };
    let felt: Vec<Case> = cases
        .into_par_iter()
        .map(felt)
        .collect::<Result<_, SimError>>()
        .map_err(|error| ExperimentError::Other(error.to_string()))?;
    let rows = felt.iter().map(|(direction, displacement, cloth, reduced)| {
        Row::of("garments")
            .with("direction", *direction)
            .with("displacement_metres", *displacement)
            .with("cloth_newtons_peak", cloth.peak)
            .with("reduced_newtons_peak", reduced.peak)
            .with("cloth_newtons_mean", cloth.mean)
            .with("reduced_newtons_mean", reduced.mean)
    });
    let panels = DIRECTIONS.map(|(name, _)| {
        let of = |peak: fn(&Case) -> f64| -> Vec<[f64; 2]> {
            felt.iter().filter(|case| case.0 == name).map(|case| [case.1, peak(case)]).collect()
        };
        let across = Axis::new(format!("elbow's way-point moved {name} (m)"));
        Plot::new("", across, Axis::new("largest force (N)").including(0.0))
            .with(Layer::line("cloth", of(|case| case.2.peak)).marked(Marker::Disc))
            .with(Layer::line("reduced", of(|case| case.3.peak)).marked(Marker::Ring))
    });
    let drawing = Drawing {
        stem: "garments".into(),
        figure: Figure::grid("", 2, panels).panel_size(460, 320),
        caption: "Largest force of a pass over the elbow's displaced way-point, for both models of the garment.".into(),
    };
    Ok(Findings { rows: rows.collect(), drawings: vec![drawing], ..Findings::default() })
}

/// One pass from the hand over the displaced elbow to the shoulder of a person who likes the straight way best.
fn pass(backend: Backend, offset: Vector, seed: u64) -> Result<Felt, SimError> {
    let mut person = SimulatedPerson::default();
    person.right.preferred_offset_metres = [0.0; 3];
    person.right.response.path_jitter_metres = 0.0;
    let setup = WorldSetup { person, backend, seed, wrench: WrenchErrors::NONE, ..WorldSetup::default() };
    let mut rig = Rig::new(&setup, Side::Right)?;
    let [hand, elbow, shoulder] = rig.dressed();
    // The cloth settles round the hand first.
    for _ in 0..50 {
        rig.place(hand);
    }
    let forces: Vec<f64> =
        places(&[hand, elbow + offset, shoulder]).into_iter().map(|place| rig.place(place).force.norm()).collect();
    let mean = forces.iter().sum::<f64>() / (forces.len() as f64).max(1.0);
    Ok(Felt { mean, peak: forces.into_iter().fold(0.0, f64::max) })
}

/// The places of a gripper beat by beat along a path.
fn places(path: &[Point]) -> Vec<Point> {
    let mut places = Vec::new();
    for (from, to) in path.iter().zip(path.iter().skip(1)) {
        let way = to - from;
        let (length, mut done) = (way.norm(), 0.0);
        while done < length {
            done = (done + SPEED * BEAT_SECONDS).min(length);
            places.push(from + way * (done / length));
        }
    }
    places
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn on_the_liked_path_both_models_pull_little_and_far_from_it_both_pull_hard() {
        for backend in [Backend::Cloth, Backend::Reduced] {
            let near = pass(backend, Vector::zeros(), 1).unwrap();
            let far = pass(backend, Vector::z() * 0.15, 1).unwrap();
            assert!(near.mean < 4.0 && near.peak < 8.0, "{backend:?}: {near:?}");
            assert!(far.peak > near.peak + 3.0 && far.peak < 45.0, "{backend:?}: {far:?} against {near:?}");
        }
    }
}
