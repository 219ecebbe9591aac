//! Random straight lines, planned and walked through tick by tick.
//!
//! A line is reachable where each of its points has joint positions inside the limits, and feasible where these are
//! connected from its start to its end. It is tracked where a plan keeps the line and every joint's speed, and at full speed where
//! the plan takes no longer than the gripper's own limits ask for.

use super::Cost;
use crate::body::{PerSide, Side};
use crate::geometry::{Point, Pose};
use crate::kinematics::{
    ArmModel, JointVector, MotionLimits, PairMotion, RobotModel, Scene, Target, dressing_orientation, plan_pair,
    start_postures,
};
use nalgebra::{Isometry3, Translation3, UnitQuaternion, Vector3};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use serde::Serialize;
use std::time::{Duration, Instant};

/// The 100 Hz beat.
const TICK: Duration = Duration::from_millis(10);
/// Where the lines lie for the right arm, in `base`, metres: in front of the robot, from the hips to the shoulders of
/// somebody who sits there.
const BOX: [(f64, f64); 3] = [(0.45, 0.95), (-0.75, 0.20), (-0.10, 0.55)];
/// Lengths of the lines in metres.
const LENGTHS: std::ops::RangeInclusive<f64> = 0.25..=0.6;
/// How far below the horizontal the gripper points, degrees.
const PITCHES: [f64; 4] = [0.0, 30.0, 60.0, 90.0];
/// Distance of the points that are asked whether a line is possible, in metres.
const SPACING: f64 = 0.01;
/// Postures of neighbouring points that may belong to one way: further apart than a joint would have to turn between them, so that
/// rather too many lines count as feasible.
const NEIGHBOURS: f64 = 0.3;
/// Postures that are looked for at a point.
const POSTURES: usize = 200;
/// A plan may take so much longer than its gripper's limits ask for, and still counts as one at full speed.
const FULL_SPEED: f64 = 1.15;
/// Every so-manieth tick is also solved by inverse kinematics from the tick before, and halted at.
const STRIDE: usize = 20;

/// What came of the lines.
#[expect(clippy::struct_field_names, reason = "the fields are the keys of the printed object")]
#[derive(Debug, Default, Serialize)]
pub(in crate::cli) struct Lines {
    pub(super) lines: usize,
    pub(super) reachable: usize,
    pub(super) feasible: usize,
    pub(super) tracked: usize,
    at_full_speed: usize,
    tracked_share: f64,
    pub(super) worst_error_metres: f64,
    pub(super) worst_error_radians: f64,
    pub(super) worst_joint_step_share: f64,
    #[serde(skip)]
    pub(super) tick: Cost,
    #[serde(skip)]
    pub(super) warm_inverse: Cost,
    #[serde(skip)]
    pub(super) look_ahead: Cost,
    #[serde(skip)]
    pub(super) plan: Cost,
    #[serde(skip)]
    pub(super) halt: Cost,
}

impl Lines {
    pub(super) fn sentence(&self, side: Side) -> String {
        format!(
            "{side} arm: {} of {} feasible lines tracked ({:.1} %), {} at full speed; {} lines, {} with every point in reach; \
             largest error {:.1e} m and {:.1e} rad, largest joint step {:.2} of its limit",
            self.tracked,
            self.feasible,
            100.0 * self.tracked_share,
            self.at_full_speed,
            self.lines,
            self.reachable,
            self.worst_error_metres,
            self.worst_error_radians,
            self.worst_joint_step_share
        )
    }
}

/// A line of one gripper at fixed orientation.
#[derive(Clone, Copy, Debug)]
struct Line {
    from: Point,
    to: Point,
    orientation: UnitQuaternion<f64>,
}

impl Line {
    fn length(&self) -> f64 {
        (self.to - self.from).norm()
    }

    fn pose(&self, share: f64) -> Pose {
        Isometry3::from_parts(Translation3::from(self.from.coords.lerp(&self.to.coords, share)), self.orientation)
    }

    /// Evenly spaced poses from the start to the end.
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "at most a hundred points")]
    fn points(&self) -> impl Iterator<Item = Pose> {
        let spans = (self.length() / SPACING).ceil() as usize;
        (0..=spans).map(move |index| self.pose(index as f64 / spans as f64))
    }
}

#[derive(Default)]
struct Times {
    tick: Vec<Duration>,
    warm_inverse: Vec<Duration>,
    look_ahead: Vec<Duration>,
    plan: Vec<Duration>,
    halt: Vec<Duration>,
}

/// Draws lines until there are `count`, and follows them.
pub(super) fn measure(model: &RobotModel, side: Side, count: usize, seed: u64) -> Lines {
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    let mut found = Lines { lines: count, ..Lines::default() };
    let mut times = Times::default();
    for _ in 0..count {
        let line = random_line(&mut random, side);
        if !is_reachable(model.arm(side), &line) {
            continue;
        }
        found.reachable += 1;
        match plan(model, side, &line, &mut times) {
            Some(motion) => {
                found.feasible += 1;
                follow(model, side, &line, &motion, &mut found, &mut times);
            }
            None => found.feasible += usize::from(is_connected(model.arm(side), &line)),
        }
    }
    found.tracked_share = found.tracked as f64 / found.feasible.max(1) as f64;
    let Times { tick, warm_inverse, look_ahead, plan, halt } = times;
    Lines {
        tick: Cost::of(tick),
        warm_inverse: Cost::of(warm_inverse),
        look_ahead: Cost::of(look_ahead),
        plan: Cost::of(plan),
        halt: Cost::of(halt),
        ..found
    }
}

fn random_line(random: &mut ChaCha8Rng, side: Side) -> Line {
    let mirror = if side == Side::Left { -1.0 } else { 1.0 };
    let mut point = || {
        let [x, y, z] = BOX.map(|(lower, upper)| random.random_range(lower..upper));
        Point::new(x, y * mirror, z)
    };
    let (from, to) = loop {
        let ends = (point(), point());
        if LENGTHS.contains(&(ends.1 - ends.0).norm()) {
            break ends;
        }
    };
    let pitch = PITCHES.get(random.random_range(0..PITCHES.len())).copied().unwrap_or_default().to_radians();
    let orientation = UnitQuaternion::from_axis_angle(&Vector3::y_axis(), std::f64::consts::FRAC_PI_2 + pitch);
    Line { from, to, orientation }
}

fn is_reachable(arm: &ArmModel, line: &Line) -> bool {
    let mut seed = arm.limits().middle();
    line.points().all(|pose| arm.inverse(&pose, &seed).map(|joints| seed = joints).is_ok())
}

/// True where postures of neighbouring points lead from the start to the end without a jump.
fn is_connected(arm: &ArmModel, line: &Line) -> bool {
    let near = |one: &JointVector, other: &JointVector| (one - other).amax() < NEIGHBOURS;
    let mut ways: Option<Vec<JointVector>> = None;
    for pose in line.points() {
        let mut next = arm.solutions(&pose, POSTURES).unwrap_or_default();
        if let Some(before) = ways {
            next.extend(before.iter().filter_map(|joints| arm.inverse(&pose, joints).ok()));
            next.retain(|joints| before.iter().any(|other| near(joints, other)));
        }
        if next.is_empty() {
            return false;
        }
        next.truncate(POSTURES);
        ways = Some(next);
    }
    true
}

/// The other arm is out of the way, and how far apart the grippers are does not matter here.
fn limits() -> MotionLimits {
    MotionLimits {
        minimum_gripper_distance: 0.0,
        maximum_gripper_distance: 10.0,
        minimum_duration: Duration::ZERO,
        ..MotionLimits::default()
    }
}

fn plan(model: &RobotModel, side: Side, line: &Line, times: &mut Times) -> Option<PairMotion> {
    let aside = Point::new(0.3, if side == Side::Right { 1.0 } else { -1.0 }, 0.1);
    let pair = |moving: Point| {
        let mut points = PerSide { left: aside, right: aside };
        *points.get_mut(side) = moving;
        points
    };
    let mut orientations = PerSide { left: dressing_orientation(), right: dressing_orientation() };
    *orientations.get_mut(side) = line.orientation;
    let mut targets = PerSide::default();
    *targets.get_mut(side) = Some(Target::position(line.to));
    let (limits, scene) = (limits(), Scene::default());
    let began = Instant::now();
    let start = start_postures(model, &scene, &[pair(line.from), pair(line.to)], &orientations, &limits);
    times.look_ahead.push(began.elapsed());
    let start = start.ok()?;
    let began = Instant::now();
    let motion = plan_pair(model, &scene, &start, &targets, &limits);
    times.plan.push(began.elapsed());
    motion.ok()
}

/// Walks through a motion tick by tick and takes down how far it leaves the line.
fn follow(model: &RobotModel, side: Side, line: &Line, motion: &PairMotion, found: &mut Lines, times: &mut Times) {
    let (arm, limits) = (model.arm(side), limits());
    let mut elapsed = Duration::ZERO;
    let mut before: Option<JointVector> = None;
    let (mut error, mut angle, mut step) = (0.0_f64, 0.0_f64, 0.0_f64);
    for index in 0.. {
        let began = Instant::now();
        let setpoints = std::hint::black_box(motion.sample(std::hint::black_box(elapsed)));
        times.tick.push(began.elapsed());
        let setpoint = setpoints.get(side);
        // Forward kinematics of the joints that are sent, against the line itself.
        let pose = arm.forward(&setpoint.joints);
        error = error.max(distance_to_line(&pose, line));
        angle = angle.max(pose.rotation.angle_to(&line.orientation));
        if let Some(before) = before {
            let share = (setpoint.joints - before).abs().component_div(&(limits.joint_speed * TICK.as_secs_f64()));
            step = step.max(share.max());
            if index % STRIDE == 0 {
                time_one_step(arm, &pose, &before, motion, elapsed, times);
            }
        }
        before = Some(setpoint.joints);
        if elapsed >= motion.duration() {
            break;
        }
        elapsed += TICK;
    }
    found.worst_error_metres = found.worst_error_metres.max(error);
    found.worst_error_radians = found.worst_error_radians.max(angle);
    found.worst_joint_step_share = found.worst_joint_step_share.max(step);
    if step <= 1.0 {
        found.tracked += 1;
        found.at_full_speed += usize::from(motion.duration().as_secs_f64() <= FULL_SPEED * shortest(line, &limits));
    }
}

fn time_one_step(
    arm: &ArmModel,
    pose: &Pose,
    before: &JointVector,
    motion: &PairMotion,
    elapsed: Duration,
    times: &mut Times,
) {
    let began = Instant::now();
    let _ = std::hint::black_box(arm.inverse(pose, before));
    times.warm_inverse.push(began.elapsed());
    let began = Instant::now();
    std::hint::black_box(motion.halt(elapsed));
    times.halt.push(began.elapsed());
}

/// Seconds that the gripper's own speed and acceleration ask for.
fn shortest(line: &Line, limits: &MotionLimits) -> f64 {
    line.length() / limits.speed + limits.speed / limits.acceleration
}

fn distance_to_line(pose: &Pose, line: &Line) -> f64 {
    let along = (line.to - line.from).normalize();
    let from_start = pose.translation.vector - line.from.coords;
    let share = from_start.dot(&along).clamp(0.0, line.length());
    (from_start - along * share).norm()
}
