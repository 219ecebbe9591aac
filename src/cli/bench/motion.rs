//! `valet bench motion`: how many straight lines an arm can follow, how exactly, and what checks, plans and halts cost.
//!
//! Everything is measured on one core through what a trial uses: look-ahead for the start posture, the planner with all its
//! checks, the samples of each tick.

mod lines;

use super::super::exit::Failure;
use super::super::output::Output;
use super::ik::ArmSide;
use crate::body::{PerSide, Side};
use crate::geometry::Point;
use crate::kinematics::{BodyPart, Capsule, JointVector, RobotModel, Scene};
use lines::Lines;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use serde::Serialize;
use std::time::{Duration, Instant};

/// Configurations that are checked against self, each other, torso, head and a person.
const CONFIGURATIONS: usize = 10_000;

/// Straight lines: how many an arm can follow, how exactly, and what checks, plans and halts cost.
#[derive(Debug, clap::Args)]
pub(in crate::cli) struct Arguments {
    /// Whose arm follows the lines; the other one is out of the way.
    #[arg(long, value_enum, default_value_t = ArmSide::Right)]
    side: ArmSide,
    /// Random lines of 0.25 to 0.6 m at fixed orientation in front of the robot.
    #[arg(long, default_value_t = 1000, value_parser = clap::value_parser!(u32).range(1..=100_000))]
    lines: u32,
    /// Seed of the lines and configurations.
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// One JSON object a line.
    #[arg(long)]
    json: bool,
}

/// What a repeated computation took. No mean: on a shared machine a few interruptions would make it up.
#[derive(Clone, Copy, Debug, Default, Serialize)]
pub(super) struct Cost {
    count: usize,
    median_microseconds: f64,
    p99_microseconds: f64,
}

impl Cost {
    /// Of all times taken, in any order.
    pub(super) fn of(mut times: Vec<Duration>) -> Self {
        times.sort_unstable();
        let count = times.len();
        let within = |share: usize| {
            let place = (count * share).div_ceil(100).saturating_sub(1);
            times.get(place).copied().unwrap_or_default().as_secs_f64() * 1e6
        };
        Self { count, median_microseconds: within(50), p99_microseconds: within(99) }
    }
}

#[derive(Serialize)]
struct CostEvent {
    event: &'static str,
    bench: &'static str,
    #[serde(flatten)]
    cost: Cost,
}

#[derive(Serialize)]
struct LinesEvent<'a> {
    event: &'static str,
    bench: &'static str,
    side: &'static str,
    #[serde(flatten)]
    lines: &'a Lines,
}

pub(in crate::cli) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let model = RobotModel::baxter().map_err(Failure::fault)?;
    let side = Side::from(arguments.side);
    let measured = lines::measure(&model, side, arguments.lines as usize, arguments.seed);
    let collision = check_cost(&model, arguments.seed);
    let costs = [
        ("one tick of both arms", "tick", measured.tick),
        ("one step of warm inverse kinematics", "warm_inverse", measured.warm_inverse),
        ("both arms against themselves, each other, the robot and a person", "collision", collision),
        ("start posture by looking ahead", "look_ahead", measured.look_ahead),
        ("a line planned, checked and timed", "plan", measured.plan),
        ("a jerk-limited halt", "halt", measured.halt),
    ];
    let mut output = Output::new(arguments.json);
    for (words, bench, cost) in costs {
        output.line(format!(
            "{words}: half of {} times within {:.2} µs, 99 of 100 within {:.2} µs",
            cost.count, cost.median_microseconds, cost.p99_microseconds
        ))?;
        output.event(&CostEvent { event: "bench", bench, cost })?;
    }
    output.line(measured.sentence(side))?;
    output.event(&LinesEvent { event: "bench", bench: "lines", side: side.name(), lines: &measured })
}

/// Times the check of both arms in random postures with a seated person of six parts in front of the robot.
fn check_cost(model: &RobotModel, seed: u64) -> Cost {
    let scene = seated_person();
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    let mut posture = |side: Side| {
        let limits = model.arm(side).limits();
        let share = JointVector::from_fn(|_, _| random.random_range(0.0..=1.0));
        limits.lower + share.component_mul(&(limits.upper - limits.lower))
    };
    let configurations: Vec<_> = (0..CONFIGURATIONS).map(|_| PerSide::from_fn(&mut posture)).collect();
    let times = configurations.iter().map(|joints| {
        let start = Instant::now();
        std::hint::black_box(model.tightest(std::hint::black_box(joints), &scene));
        start.elapsed()
    });
    Cost::of(times.collect())
}

/// A person who sits with the back to the robot: trunk, head, and both arms to the front.
fn seated_person() -> Scene {
    let part = |name: &str, start: [f64; 3], end: [f64; 3], radius: f64| BodyPart {
        name: name.into(),
        shape: Capsule { start: Point::from(start), end: Point::from(end), radius },
    };
    let mut person = vec![
        part("trunk", [0.85, 0.0, 0.0], [0.85, 0.0, -0.55], 0.11),
        part("head", [0.85, 0.0, 0.36], [0.85, 0.0, 0.36], 0.12),
    ];
    for (side, y) in [(1.0, 0.18), (-1.0, -0.18)] {
        person.push(part("upper arm", [0.85, y, 0.1], [0.9, y + 0.05 * side, -0.18], 0.048));
        person.push(part("forearm", [0.9, y + 0.05 * side, -0.18], [1.15, y, -0.2], 0.045));
    }
    Scene { person, ..Scene::default() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_99th_of_a_hundred_times_is_named() {
        let cost = Cost::of((1..=100).rev().map(Duration::from_micros).collect());
        assert_eq!(cost.count, 100);
        assert!((cost.median_microseconds - 50.0).abs() < 1e-9);
        assert!((cost.p99_microseconds - 99.0).abs() < 1e-9);
        assert_eq!(Cost::of(Vec::new()).count, 0);
    }

    #[test]
    fn lines_that_are_followed_keep_to_the_line_and_to_the_joints_limits() {
        let model = RobotModel::baxter().unwrap();
        for side in Side::BOTH {
            let lines = lines::measure(&model, side, 12, 3);
            assert_eq!(lines.lines, 12);
            assert!(lines.reachable >= lines.feasible && lines.feasible >= lines.tracked);
            assert!(lines.tracked >= 8, "{lines:?}");
            assert!(lines.worst_error_metres <= 1e-5 && lines.worst_error_radians <= 1e-5, "{lines:?}");
            assert!(lines.worst_joint_step_share <= 1.0, "{lines:?}");
        }
    }

    #[test]
    fn a_check_is_made_of_every_configuration() {
        assert_eq!(check_cost(&RobotModel::baxter().unwrap(), 1).count, CONFIGURATIONS);
    }
}
