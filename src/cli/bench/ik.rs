//! `valet bench ik`: how many poses inverse kinematics solves, and how fast.
//!
//! The protocol of the public comparisons (TRAC-IK, 2015): poses that are reachable by construction, the seed in the middle of the
//! joint ranges, solved where each component of the remaining twist is at most 1e-5 (m, rad) and every joint is in its range.
//! The mean is of the processor's time, the 99th of a hundred of the time that passed.

use super::super::exit::Failure;
use super::super::output::Output;
use crate::body::Side;
use crate::geometry::{Finite, Pose};
use crate::kinematics::{ArmModel, InverseError, JointVector, RobotModel};
use nalgebra::{Isometry3, Quaternion, Translation3, UnitQuaternion};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use serde::Serialize;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

/// Largest component of the twist that counts as solved, metres and radians.
const SOLVED: f64 = 1e-5;
/// Poses without a file, as many as the public comparisons take.
const POSES: usize = 10_000;
/// Poses that are solved before the clock runs, so that it does not measure a cold cache.
const WARM_UP: usize = 200;

/// Inverse kinematics: how many poses are solved, and how fast.
#[derive(Debug, clap::Args)]
pub(in crate::cli) struct Arguments {
    /// Whose arm.
    #[arg(long, value_enum, default_value_t = ArmSide::Right)]
    side: ArmSide,
    /// Poses of the gripper's tip in the robot's base frame, one a row: px,py,pz,qx,qy,qz,qw (m). Without it, 10,000 poses are
    /// made from uniform joint samples.
    #[arg(long, value_name = "FILE")]
    targets: Option<PathBuf>,
    /// Seed of the poses that are made without a file.
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// One JSON object a line.
    #[arg(long)]
    json: bool,
}

#[derive(Clone, Copy, Debug, clap::ValueEnum)]
pub(super) enum ArmSide {
    Left,
    Right,
}

impl From<ArmSide> for Side {
    fn from(side: ArmSide) -> Self {
        match side {
            ArmSide::Left => Self::Left,
            ArmSide::Right => Self::Right,
        }
    }
}

#[derive(Debug, Serialize)]
struct Summary {
    event: &'static str,
    solved: usize,
    total: usize,
    mean_microseconds: f64,
    p99_microseconds: f64,
}

pub(in crate::cli) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let model = RobotModel::baxter().map_err(Failure::fault)?;
    let side = Side::from(arguments.side);
    let arm = model.arm(side);
    let targets = match &arguments.targets {
        Some(path) => read_targets(path)?,
        None => sampled_targets(arm, arguments.seed),
    };
    let summary = measure(arm, &targets);
    let mut output = Output::new(arguments.json);
    output.line(format!(
        "{side} arm: {} of {} poses solved, mean {:.2} µs, 99 of 100 within {:.2} µs",
        summary.solved, summary.total, summary.mean_microseconds, summary.p99_microseconds
    ))?;
    output.event(&summary)
}

fn measure(arm: &ArmModel, targets: &[Pose]) -> Summary {
    let seed = arm.limits().middle();
    for target in targets.iter().take(WARM_UP) {
        let _ = std::hint::black_box(arm.inverse(target, &seed));
    }
    let mut answers = Vec::with_capacity(targets.len());
    let mut times: Vec<Duration> = Vec::with_capacity(targets.len());
    let before = processor_time();
    for target in targets {
        let start = Instant::now();
        let answer = std::hint::black_box(arm.inverse(std::hint::black_box(target), &seed));
        times.push(start.elapsed());
        answers.push(answer);
    }
    let spent = processor_time().saturating_sub(before);
    let is_right = |(target, answer): &(&Pose, Result<JointVector, InverseError>)| {
        answer.as_ref().is_ok_and(|joints| is_solved(arm, target, joints))
    };
    let solved = targets.iter().zip(answers).filter(is_right).count();
    times.sort_unstable();
    let last = times.len().saturating_sub(1);
    let p99 = times.get((times.len() * 99).div_ceil(100).saturating_sub(1).min(last)).copied().unwrap_or_default();
    Summary {
        event: "bench",
        solved,
        total: targets.len(),
        mean_microseconds: spent.as_secs_f64() * 1e6 / times.len().max(1) as f64,
        p99_microseconds: p99.as_secs_f64() * 1e6,
    }
}

/// What this thread has spent on a core: unlike the time of day it does not count what other programs take from it.
fn processor_time() -> Duration {
    let spent = rustix::time::clock_gettime(rustix::time::ClockId::ThreadCPUTime);
    Duration::try_from(spent).unwrap_or_default()
}

/// Checks an answer by forward kinematics, apart from what the solver says of itself.
fn is_solved(arm: &ArmModel, target: &Pose, joints: &JointVector) -> bool {
    let reached = arm.forward(joints);
    let linear = (target.translation.vector - reached.translation.vector).amax();
    let angular = (target.rotation * reached.rotation.inverse()).scaled_axis().amax();
    linear <= SOLVED && angular <= SOLVED && arm.limits().breach(joints, 0.0).is_none()
}

fn sampled_targets(arm: &ArmModel, seed: u64) -> Vec<Pose> {
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    let limits = arm.limits();
    let span = limits.upper - limits.lower;
    let mut pose = || {
        let share = JointVector::from_fn(|_, _| random.random_range(0.0..=1.0));
        arm.forward(&(limits.lower + share.component_mul(&span)))
    };
    (0..POSES).map(|_| pose()).collect()
}

/// Reads the poses. A first row that is no row of numbers is taken as a heading.
fn read_targets(path: &Path) -> Result<Vec<Pose>, Failure> {
    let named = |what: String| Failure::Configuration(format!("{}: {what}", path.display()));
    let mut reader = csv::ReaderBuilder::new()
        .has_headers(false)
        .flexible(true)
        .comment(Some(b'#'))
        .trim(csv::Trim::All)
        .from_path(path)
        .map_err(|error| named(format!("cannot be read: {error}")))?;
    let mut targets = Vec::new();
    for (index, record) in reader.records().enumerate() {
        let record = record.map_err(|error| named(error.to_string()))?;
        let line = record.position().map_or(index as u64 + 1, csv::Position::line);
        match read_pose(&record) {
            Ok(pose) => targets.push(pose),
            Err(_) if index == 0 && record.iter().all(|field| field.parse::<f64>().is_err()) => {}
            Err(reason) => return Err(named(format!("line {line}: {reason}"))),
        }
    }
    if targets.is_empty() {
        return Err(named("holds no pose; each row is px,py,pz,qx,qy,qz,qw".into()));
    }
    Ok(targets)
}

fn read_pose(record: &csv::StringRecord) -> Result<Pose, String> {
    let numbers: Vec<f64> = record
        .iter()
        .map(|field| field.parse().map_err(|_| format!("'{field}' is no number")))
        .collect::<Result<_, _>>()?;
    let [px, py, pz, qx, qy, qz, qw] = numbers.as_slice() else {
        return Err(format!("has {} numbers; a pose is px,py,pz,qx,qy,qz,qw", numbers.len()));
    };
    let quaternion = Quaternion::new(*qw, *qx, *qy, *qz);
    if (quaternion.norm() - 1.0).abs().partial_cmp(&1e-3) != Some(std::cmp::Ordering::Less) {
        return Err(format!("the quaternion has length {:.4}, not 1", quaternion.norm()));
    }
    let pose = Isometry3::from_parts(Translation3::new(*px, *py, *pz), UnitQuaternion::from_quaternion(quaternion));
    if pose.is_finite() { Ok(pose) } else { Err("the position is not finite".into()) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::io::Write;

    fn read(text: &str) -> Result<Vec<Pose>, String> {
        let mut file = tempfile::NamedTempFile::new().unwrap();
        file.write_all(text.as_bytes()).unwrap();
        read_targets(file.path()).map_err(|failure| failure.to_string())
    }

    #[test]
    fn rows_are_poses_with_the_scalar_last_and_a_heading_is_skipped() {
        let poses = read("px,py,pz,qx,qy,qz,qw\n0.6, -0.2, 0.1, 0, 1, 0, 0\n").unwrap();
        assert_eq!(poses.len(), 1);
        assert!((poses[0].translation.vector.x - 0.6).abs() < 1e-12);
        assert!((poses[0].rotation.quaternion().j - 1.0).abs() < 1e-12);
    }

    #[test]
    fn a_bad_row_is_named_by_its_line_and_what_is_wrong() {
        let good = "0.6,-0.2,0.1,0,1,0,0\n";
        for (row, words) in [
            ("0.6,-0.2,0.1,0,1,0", "line 2: has 6 numbers"),
            ("0.6,-0.2,left,0,1,0,0", "line 2: 'left' is no number"),
            ("0.6,-0.2,0.1,0,2,0,0", "line 2: the quaternion has length 2.0000"),
            ("0.6,-0.2,0.1,0,NaN,0,0", "line 2: the quaternion"),
            ("inf,-0.2,0.1,0,1,0,0", "line 2: the position is not finite"),
        ] {
            let refusal = read(&format!("{good}{row}\n")).unwrap_err();
            assert!(refusal.contains(words), "{refusal}");
        }
        assert!(read("").unwrap_err().contains("holds no pose"));
    }

    #[test]
    fn poses_from_joint_samples_are_all_solved() {
        let model = RobotModel::baxter().unwrap();
        for side in Side::BOTH {
            let targets: Vec<_> = sampled_targets(model.arm(side), 5).into_iter().take(500).collect();
            let summary = measure(model.arm(side), &targets);
            assert_eq!((summary.solved, summary.total), (500, 500));
        }
    }

    #[test]
    fn a_pose_out_of_reach_counts_as_not_solved() {
        let model = RobotModel::baxter().unwrap();
        let summary = measure(model.arm(Side::Left), &[Pose::translation(4.0, 0.0, 0.0)]);
        assert_eq!((summary.solved, summary.total), (0, 1));
    }
}
