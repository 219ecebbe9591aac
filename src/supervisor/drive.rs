//! The motion that is under way: where in it the arms are, how fast it runs, and how it is brought to a halt.
//!
//! Sampling only: plans come from the kinematics room, and whether anything may move is decided before this is asked.

use crate::body::{PerSide, Side};
use crate::geometry::Vector;
use crate::kinematics::{JointVector, PairMotion, Setpoint};
use std::time::Duration;

/// How fast the ratio of motion time to real time may change, per second: half speed is reached within 0.5 s. A joint at
/// speed v is accelerated by v times this beside what was planned; at the highest joint speed (1 rad/s) that is 1 rad/s², and
/// with the planned 2 rad/s² it stays below the 4 rad/s² at which the guard refuses a step.
const RATIO_PER_SECOND: f64 = 1.0;

/// What a drive does.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Phase {
    /// Nothing is under way: the arms hold their last setpoint, where there is one.
    Holding,
    /// On the way to the goal.
    Moving,
    /// Braking along the path.
    Halting,
}

/// What a tick brought.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Arrival {
    /// Still under way, or nothing was.
    None,
    /// The goal is reached.
    AtGoal,
    /// The halt is complete.
    Halted,
}

/// The motion of both arms.
#[derive(Debug)]
pub(crate) struct Drive {
    motion: Option<PairMotion>,
    phase: Phase,
    elapsed: Duration,
    ratio: f64,
    wanted_ratio: f64,
    last: Option<PerSide<Setpoint>>,
    velocity: PerSide<Vector>,
    acceleration: PerSide<Vector>,
    /// Seconds over which the velocity was measured.
    measured_seconds: f64,
}

impl Drive {
    pub(crate) const fn new() -> Self {
        let still = PerSide { left: Vector::new(0.0, 0.0, 0.0), right: Vector::new(0.0, 0.0, 0.0) };
        Self {
            motion: None,
            phase: Phase::Holding,
            elapsed: Duration::ZERO,
            ratio: 1.0,
            wanted_ratio: 1.0,
            last: None,
            velocity: still,
            acceleration: still,
            measured_seconds: 0.0,
        }
    }

    /// The share of its planned speed at which the motion runs.
    pub(crate) const fn ratio(&self) -> f64 {
        self.ratio
    }

    pub(crate) const fn phase(&self) -> Phase {
        self.phase
    }

    /// Time since the motion began, in motion time.
    pub(crate) const fn elapsed(&self) -> Duration {
        self.elapsed
    }

    /// The setpoints that were sent last.
    pub(crate) const fn last(&self) -> Option<&PerSide<Setpoint>> {
        self.last.as_ref()
    }

    /// The joints from which the next plan must start: those that were sent last, so that no setpoint jumps.
    pub(crate) fn joints(&self) -> Option<PerSide<JointVector>> {
        self.last.as_ref().map(|last| last.map(|_, setpoint| setpoint.joints))
    }

    /// Begins a motion.
    pub(crate) fn start(&mut self, motion: PairMotion) {
        self.motion = Some(motion);
        self.phase = Phase::Moving;
        self.elapsed = Duration::ZERO;
    }

    /// Brakes along the path. Nothing happens where nothing moves.
    pub(crate) fn halt(&mut self) {
        if self.phase != Phase::Moving {
            return;
        }
        if let Some(motion) = &self.motion {
            self.motion = Some(motion.halt_slowed(self.elapsed, self.ratio));
            self.phase = Phase::Halting;
            self.elapsed = Duration::ZERO;
            // The halt is planned from the speed that the arms have: its time is the clock's.
            self.ratio = 1.0;
        }
    }

    /// Forgets everything, the posture to hold included: after this nothing is sent until a new motion begins.
    pub(crate) fn drop_motion(&mut self) {
        *self = Self::new();
    }

    /// The share of its planned speed at which the motion is to run, from 0 to 1.
    pub(crate) const fn set_ratio(&mut self, ratio: f64) {
        self.wanted_ratio = ratio.clamp(0.0, 1.0);
    }

    /// Velocity of a gripper as commanded, in m/s in `base`.
    pub(crate) const fn velocity(&self, side: Side) -> Vector {
        *self.velocity.get(side)
    }

    /// Acceleration of a gripper as commanded, in m/s² in `base`.
    pub(crate) const fn acceleration(&self, side: Side) -> Vector {
        *self.acceleration.get(side)
    }

    fn measure(&mut self, next: &PerSide<Setpoint>, seconds: f64) {
        let Some(last) = self.last.as_ref().filter(|_| seconds > 0.0) else { return };
        for side in Side::BOTH {
            let moved = next.get(side).pose.translation.vector - last.get(side).pose.translation.vector;
            let velocity = moved / seconds;
            // Each velocity holds for the middle of its own span; beats are not always equally far apart.
            let between = 0.5 * (seconds + if self.measured_seconds > 0.0 { self.measured_seconds } else { seconds });
            *self.acceleration.get_mut(side) = (velocity - self.velocity.get(side)) / between;
            *self.velocity.get_mut(side) = velocity;
        }
        self.measured_seconds = seconds;
    }

    /// A halt is never slowed down.
    fn change_ratio(&mut self, seconds: f64) {
        if self.phase != Phase::Halting {
            let most = RATIO_PER_SECOND * seconds;
            self.ratio += (self.wanted_ratio - self.ratio).clamp(-most, most);
        }
    }

    /// Lets `span` pass and says what came of it.
    pub(crate) fn tick(&mut self, span: Duration) -> Arrival {
        self.change_ratio(span.as_secs_f64());
        let Some(motion) = &self.motion else {
            self.velocity = PerSide::default();
            self.acceleration = PerSide::default();
            return Arrival::None;
        };
        self.elapsed += span.mul_f64(self.ratio);
        let next = motion.sample(self.elapsed);
        let arrived = self.elapsed >= motion.duration();
        self.measure(&next, span.as_secs_f64());
        self.last = Some(next);
        if !arrived {
            return Arrival::None;
        }
        self.motion = None;
        match std::mem::replace(&mut self.phase, Phase::Holding) {
            Phase::Moving => Arrival::AtGoal,
            Phase::Halting => Arrival::Halted,
            Phase::Holding => Arrival::None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Point;
    use crate::kinematics::{MotionLimits, RobotModel, Scene, Target, dressing_orientation, plan_pair, start_postures};

    const BEAT: Duration = Duration::from_millis(10);

    /// A drive on its way along 17 cm, and the limits of the motion.
    fn moving() -> (Drive, MotionLimits) {
        let (model, scene, limits) = (RobotModel::baxter().unwrap(), Scene::default(), MotionLimits::default());
        let places = PerSide { left: Point::new(0.65, 0.2, 0.05), right: Point::new(0.65, -0.2, 0.05) };
        let orientations = PerSide { left: dressing_orientation(), right: dressing_orientation() };
        let start = start_postures(&model, &scene, &[places], &orientations, &limits).unwrap();
        let goal = |y: f64| Some(Target::position(Point::new(0.65, y, -0.12)));
        let targets = PerSide { left: goal(0.2), right: goal(-0.2) };
        let mut drive = Drive::new();
        drive.start(plan_pair(&model, &scene, &start, &targets, &limits).unwrap());
        (drive, limits)
    }

    /// The largest joint acceleration of `beats` beats, as a share of its limit.
    fn largest_acceleration(drive: &mut Drive, limits: &MotionLimits, beats: usize) -> f64 {
        let joints: Vec<JointVector> = (0..beats)
            .map(|_| {
                drive.tick(BEAT);
                drive.joints().unwrap().right
            })
            .collect();
        let seconds = BEAT.as_secs_f64();
        joints.windows(3).fold(0.0, |most, three| {
            let acceleration = (three[2] - three[1] * 2.0 + three[0]) / (seconds * seconds);
            acceleration.component_div(&limits.joint_acceleration).amax().max(most)
        })
    }

    #[test]
    fn slowing_down_and_making_haste_stay_within_what_the_guard_lets_pass() {
        let (mut drive, limits) = moving();
        let mut most = largest_acceleration(&mut drive, &limits, 40);
        for ratio in [0.5, 1.0, 0.5] {
            drive.set_ratio(ratio);
            most = most.max(largest_acceleration(&mut drive, &limits, 30));
        }
        assert!(most < 1.5, "{most} of the limit");
    }

    #[test]
    fn a_halt_of_a_slowed_motion_begins_at_its_speed_and_not_at_the_planned_one() {
        let (mut drive, limits) = moving();
        drive.set_ratio(0.5);
        for _ in 0..100 {
            drive.tick(BEAT);
        }
        assert!((drive.ratio() - 0.5).abs() < 1e-9);
        let before = drive.joints().unwrap().right;
        drive.tick(BEAT);
        let speed = (drive.joints().unwrap().right - before).norm();
        drive.halt();
        let last = drive.joints().unwrap().right;
        drive.tick(BEAT);
        let next = (drive.joints().unwrap().right - last).norm();
        assert!(next <= speed * 1.02, "{next} after {speed}");
        assert!(largest_acceleration(&mut drive, &limits, 80) < 1.5);
        assert_eq!(drive.phase(), Phase::Holding);
    }

    /// Beats from a halt until the arms stand, after a second at a ratio.
    fn beats_to_stand(ratio: f64) -> usize {
        let (mut drive, _) = moving();
        drive.set_ratio(ratio);
        for _ in 0..150 {
            drive.tick(BEAT);
        }
        assert_eq!(drive.phase(), Phase::Moving, "still on its way");
        drive.halt();
        (1..1000).find(|_| drive.tick(BEAT) == Arrival::Halted).unwrap()
    }

    #[test]
    fn s_39_a_halt_of_a_slowed_motion_takes_no_longer_than_one_at_full_speed() {
        let full = beats_to_stand(0.9);
        for ratio in [0.0, 0.05, 0.25, 0.5, 0.75] {
            assert!(beats_to_stand(ratio) <= full + 1, "at {ratio}: {} beats, and {full}", beats_to_stand(ratio));
        }
    }

    #[test]
    fn s_39_a_motion_that_was_slowed_to_a_stand_does_not_go_on_in_a_halt() {
        let (mut drive, _) = moving();
        drive.set_ratio(0.0);
        for _ in 0..150 {
            drive.tick(BEAT);
        }
        let before = drive.joints().unwrap();
        drive.halt();
        for _ in 0..100 {
            drive.tick(BEAT);
        }
        assert_eq!(drive.joints().unwrap(), before);
    }
}
