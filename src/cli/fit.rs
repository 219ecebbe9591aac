//! `valet fit`: fits a person's movement space from recorded joints.
//!
//! The recording is a CSV file with the columns `side` (left, right), `joint` (hand, elbow, shoulder), `x`, `y`, `z` in
//! metres in the robot's frame; other columns are ignored, and so are rows of other joints. The result is the
//! `[movement_space]` table of a profile, in a file of its own that the operator pastes or includes.

use super::exit::Failure;
use super::output::Output;
use crate::body::{Joint, PerSide, Side};
use crate::config::write_whole;
use crate::geometry::Vector;
use crate::modelling::{ArmSpace, Fit, FitSettings, MovementSpace, fit};
use serde::{Deserialize, Serialize};
use std::path::{Path, PathBuf};

/// Fits a person's movement space from recorded joints.
#[derive(Debug, Default, clap::Args)]
pub(super) struct Arguments {
    /// The recording: a CSV file with columns side, joint, x, y, z (metres).
    recording: PathBuf,
    /// Where the movement space is written (TOML); only reported where it is not given.
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
    /// Most Gaussians a joint.
    #[arg(long, default_value_t = FitSettings::default().most_components)]
    most_components: usize,
    /// Smallest standard deviation in any direction, in metres.
    #[arg(long, value_name = "METRES", default_value_t = FitSettings::default().floor)]
    floor: f64,
    /// Seed of the starting points.
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Print one JSON object a joint on stdout.
    #[arg(long)]
    json: bool,
}

#[derive(Deserialize)]
struct Sample {
    side: Side,
    joint: Joint,
    x: f64,
    y: f64,
    z: f64,
}

#[derive(Serialize)]
struct Report<'a> {
    event: &'static str,
    side: Side,
    joint: Joint,
    points: usize,
    components: usize,
    reached_most: bool,
    message_length_nats: f64,
    mode_metres: [f64; 3],
    weights: Vec<f64>,
    #[serde(skip)]
    fit: &'a Fit,
}

/// What stands in the file.
#[derive(Serialize)]
struct SpaceFile {
    movement_space: MovementSpace,
}

pub(super) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let points = read(&arguments.recording)?;
    let settings =
        FitSettings { most_components: arguments.most_components, floor: arguments.floor, ..FitSettings::default() };
    let mut output = Output::new(arguments.json);
    let left = fit_arm(Side::Left, &points.left, &settings, arguments.seed, &mut output)?;
    let right = fit_arm(Side::Right, &points.right, &settings, arguments.seed, &mut output)?;
    let Some(file) = &arguments.out else { return Ok(()) };
    let space = SpaceFile { movement_space: MovementSpace { arms: PerSide { left, right } } };
    let text = toml::to_string(&space).map_err(Failure::fault)?;
    write_whole(file, text.as_bytes()).map_err(Failure::configuration)?;
    output.line(format!("Written: {}. Put its table into the person's profile.", file.display()))
}

/// Points of hand, elbow and shoulder.
type ArmPoints = [Vec<Vector>; 3];

fn read(file: &Path) -> Result<PerSide<ArmPoints>, Failure> {
    let refuse = |error: csv::Error| Failure::Configuration(format!("cannot read {}: {error}", file.display()));
    let mut points = PerSide::<ArmPoints>::default();
    for sample in csv::Reader::from_path(file).map_err(refuse)?.deserialize() {
        let sample: Sample = sample.map_err(refuse)?;
        let joints = points.get_mut(sample.side).iter_mut().zip(Joint::DRESSED);
        for (list, _) in joints.filter(|(_, joint)| *joint == sample.joint) {
            list.push(Vector::new(sample.x, sample.y, sample.z));
        }
    }
    Ok(points)
}

fn fit_arm(
    side: Side,
    points: &ArmPoints,
    settings: &FitSettings,
    seed: u64,
    output: &mut Output,
) -> Result<ArmSpace, Failure> {
    let [hand, elbow, shoulder] = points;
    let mut joint = |joint: Joint, points: &[Vector]| {
        let fit =
            fit(points, settings, seed).map_err(|error| Failure::Configuration(format!("{side} {joint}: {error}")))?;
        report(side, joint, points.len(), &fit, output)?;
        Ok::<_, Failure>(fit.mixture)
    };
    Ok(ArmSpace {
        hand: joint(Joint::Hand, hand)?,
        elbow: joint(Joint::Elbow, elbow)?,
        shoulder: joint(Joint::Shoulder, shoulder)?,
        // Rows of a recording need not be of one moment: nothing is said about which hand goes with which elbow.
        whole: None,
    })
}

fn report(side: Side, joint: Joint, points: usize, fit: &Fit, output: &mut Output) -> Result<(), Failure> {
    let mode = fit.mixture.mode();
    let report = Report {
        event: "fit",
        side,
        joint,
        points,
        components: fit.mixture.components().len(),
        reached_most: fit.reached_most,
        message_length_nats: fit.message_length,
        mode_metres: [mode.x, mode.y, mode.z],
        weights: fit.mixture.components().iter().map(crate::modelling::mixture::Component::weight).collect(),
        fit,
    };
    output.event(&report)?;
    let note =
        if report.fit.reached_most { " (as many as allowed; more might describe the motion better)" } else { "" };
    output.line(format!(
        "{side} {joint}: {points} points, {} Gaussians{note}, most probable at {:.3} {:.3} {:.3} m",
        report.components, mode.x, mode.y, mode.z
    ))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::modelling::SplitMix64;
    use std::fmt::Write as _;

    fn recording(joints: &[&str]) -> String {
        let mut random = SplitMix64::new(2);
        let mut text = String::from("time,side,joint,x,y,z\n");
        for index in 0..400 {
            for side in ["left", "right"] {
                for (place, joint) in joints.iter().enumerate() {
                    let x = place as f64 * 0.3 + if index % 2 == 0 { 0.0 } else { 0.25 };
                    let [dx, dy, dz] = [0; 3].map(|_| 0.03 * random.normal());
                    writeln!(text, "{index},{side},{joint},{},{dy},{dz}", x + dx).unwrap();
                }
            }
        }
        text
    }

    #[test]
    fn a_recording_becomes_a_movement_space_that_reads_back() {
        let folder = tempfile::tempdir().unwrap();
        let (file, out) = (folder.path().join("motion.csv"), folder.path().join("space.toml"));
        std::fs::write(&file, recording(&["hand", "elbow", "shoulder", "wrist"])).unwrap();
        let settings = FitSettings::default();
        let arguments = Arguments {
            recording: file,
            out: Some(out.clone()),
            most_components: settings.most_components,
            floor: settings.floor,
            seed: 1,
            json: true,
        };
        run(&arguments).unwrap();
        let table: toml::Table = toml::from_str(&std::fs::read_to_string(out).unwrap()).unwrap();
        let space: MovementSpace = table["movement_space"].clone().try_into().unwrap();
        let elbow = &space.arms.right.elbow;
        assert_eq!(elbow.components().len(), 2);
        for x in [0.3, 0.55] {
            assert!((elbow.nearest_mean(&Vector::new(x, 0.0, 0.0)).1 - Vector::new(x, 0.0, 0.0)).norm() < 0.02);
        }
    }

    #[test]
    fn a_joint_without_points_is_named() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("motion.csv");
        std::fs::write(&file, recording(&["hand", "shoulder"])).unwrap();
        let arguments = Arguments { recording: file.clone(), most_components: 4, floor: 0.01, ..Arguments::default() };
        assert!(run(&arguments).unwrap_err().to_string().contains("left elbow: there are no points"));
        std::fs::write(&file, "side,joint,x,y,z\nleft,knee,0,0,0\n").unwrap();
        assert!(run(&arguments).unwrap_err().to_string().contains("knee"));
    }
}
