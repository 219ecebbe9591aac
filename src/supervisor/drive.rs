//! The motion that is under way: where in it the arms are, how fast it runs, and how it is brought to a halt.
//!
//! Sampling only: plans come from the kinematics room, and whether anything may move is decided before this is asked.

use crate::body::{PerSide, Side};
use crate::geometry::Vector;
use crate::kinematics::{JointVector, PairMotion, Setpoint};
use std::time::Duration;

/// How fast the ratio of motion time to real time may change, per second: half speed is reached within 0.2 s, so that
/// slowing down is no jerk of its own.
const RATIO_PER_SECOND: f64 = 2.5;

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
            self.motion = Some(motion.halt(self.elapsed));
            self.phase = Phase::Halting;
            self.elapsed = Duration::ZERO;
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

    /// Lets `span` pass and says what came of it.
    pub(crate) fn tick(&mut self, span: Duration) -> Arrival {
        let most = RATIO_PER_SECOND * span.as_secs_f64();
        self.ratio += (self.wanted_ratio - self.ratio).clamp(-most, most);
        let Some(motion) = &self.motion else {
            self.velocity = PerSide::default();
            self.acceleration = PerSide::default();
            return Arrival::None;
        };
        // A halt is never slowed down.
        let ratio = if self.phase == Phase::Halting { 1.0 } else { self.ratio };
        self.elapsed += span.mul_f64(ratio);
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
