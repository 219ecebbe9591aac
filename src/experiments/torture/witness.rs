//! Watches what goes into the supervisor and what comes out of it, and knows what may never be.
//!
//! It shares no code with the supervisor's own checks: it keeps its own account of stops, of what has arrived and of what
//! was sent, and judges each step by that alone.

use crate::assembly::{RobotState, SwitchRequest};
use crate::body::{PerSide, Side};
use crate::command::{Command, Origin};
use crate::geometry::{Finite, Point};
use crate::kinematics::{JointVector, MotionLimits, RobotModel};
use crate::snapshot::TrialPhase;
use crate::supervisor::{Effect, Input};
use crate::time::Stamp;
use serde::Serialize;
use std::time::Duration;

/// Within this span an arm that moves must have braked, once it may not move any more: twice the time that the arm needs
/// from its highest speed at its set acceleration and jerk.
const BRAKING: Duration = Duration::from_millis(800);
/// Ages beyond which an input does not hold (requirements S-21 to S-23).
const FORCE_HOLDS: Duration = Duration::from_millis(60);
const JOINTS_HOLD: Duration = Duration::from_millis(100);
const ROBOT_HOLDS: Duration = Duration::from_millis(100);
/// A force in newtons that no bias explains: a stop must follow.
const UNBEARABLE_NEWTONS: f64 = 80.0;
/// Two beats: within them the stop must have been asked for.
const STOP_WITHIN: Duration = Duration::from_millis(20);
/// Setpoints further apart do not belong to one motion: the robot's own command time-out.
const ONE_MOTION: Duration = Duration::from_millis(200);
/// How far a first setpoint may be from where the arm is, in radians on a joint.
const FIRST_STEP: f64 = 0.3;

/// Between two planned postures a joint's spline may swing past its limit by this much, in radians: a tenth of a degree
/// stands against the robot's own control error of half a degree.
const RANGE_TOLERANCE: f64 = 1.5e-3;

/// What may never be broken.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Invariant {
    /// The trial of a seed can begin.
    TrialCanBegin,
    /// Nothing panics.
    NoPanic,
    /// After a stop no setpoint until Reset, Enable and Start were accepted, in this order.
    StopIsLatched,
    /// A stop that is asked for reaches the robot's switch in the same step.
    StopIsAtOnce,
    /// No setpoint while the robot is disabled, stopped, or its state not known.
    RobotIsEnabled,
    /// No motion on stale, missing or non-finite input, beyond braking.
    InputsAreFresh,
    /// Every setpoint is finite and inside the joints' ranges.
    JointRange,
    /// No joint and no gripper is faster than its limit.
    Speed,
    /// The first setpoint of a motion is where the arm is.
    FirstStep,
    /// The grippers keep their distance.
    GripperDistance,
    /// An unbearable force stops the robot.
    ForceStops,
    /// In a hold nothing moves, beyond braking, until the operator acts.
    HoldHolds,
    /// Another node may stop and hold, nothing else.
    ServiceMayOnlyStop,
    /// Figures of an iteration are finite and not negative.
    FiguresAreFinite,
}

/// A broken invariant.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Violation {
    /// Which one.
    pub invariant: Invariant,
    /// When, in seconds of the trial's clock.
    pub at_seconds: f64,
    /// What was seen, in words with numbers.
    pub text: String,
}

#[derive(Clone, Copy, Debug)]
struct Sent {
    at: Stamp,
    joints: JointVector,
    tip: Point,
}

/// What the witness knows of one arm.
#[derive(Clone, Copy, Debug, Default)]
struct Arm {
    force: Option<Stamp>,
    joints: Option<(Stamp, JointVector)>,
    sent: Option<Sent>,
    moved: Option<Stamp>,
}

/// The account of one trial.
#[derive(Debug)]
pub(super) struct Witness {
    model: RobotModel,
    limits: MotionLimits,
    arms: PerSide<Arm>,
    robot: Option<(Stamp, RobotState)>,
    /// Acts of Reset, Enable and Start that were accepted in order since the last stop; 3 where none is in force.
    acts: u8,
    unsafe_since: Option<Stamp>,
    unbearable_since: Option<Stamp>,
    held_since: Option<Stamp>,
}

type Judged = Result<(), (Invariant, String)>;

impl Witness {
    pub(super) fn new(model: RobotModel, limits: MotionLimits) -> Self {
        Self {
            model,
            limits,
            arms: PerSide::default(),
            robot: None,
            acts: 3,
            unsafe_since: None,
            unbearable_since: None,
            held_since: None,
        }
    }

    /// Is told ten times a second what the screen shows of the trial.
    pub(super) fn look(&mut self, now: Stamp, phase: TrialPhase) {
        if phase == TrialPhase::Holding {
            self.held_since.get_or_insert(now);
        } else {
            self.held_since = None;
        }
    }

    /// Judges a step.
    pub(super) fn judge(&mut self, now: Stamp, input: &Input, effects: &[Effect]) -> Option<Violation> {
        let acts_before = self.acts;
        self.take(now, input);
        let judged = self.judge_command(acts_before, input, effects).and_then(|()| self.judge_effects(now, effects));
        let judged = judged.and_then(|()| self.judge_force(now));
        judged.err().map(|(invariant, text)| Violation { invariant, at_seconds: now.seconds(), text })
    }

    fn take(&mut self, now: Stamp, input: &Input) {
        match input {
            Input::Endpoint(sample) => {
                let arm = self.arms.get_mut(sample.side);
                let good = sample.wrench.force.is_finite();
                arm.force = good.then_some(now);
                let moving = arm.moved.is_some_and(|moved| now.since(moved) <= Duration::from_millis(50));
                if good && moving && sample.wrench.force.norm() > UNBEARABLE_NEWTONS {
                    self.unbearable_since.get_or_insert(now);
                }
            }
            Input::Joints(sample) => {
                for side in Side::BOTH {
                    self.take_joints(now, side, sample.positions.get(side));
                }
            }
            Input::Robot(state) => {
                self.robot = Some((now, *state));
                if state.stopped {
                    // An accepted reset is under way while the robot still says so.
                    self.acts = u8::from(self.acts == 1);
                }
            }
            _ => {}
        }
    }

    fn take_joints(&mut self, now: Stamp, side: Side, positions: &[Option<f64>; 7]) {
        let arm = self.arms.get_mut(side);
        if positions.iter().flatten().any(|position| !position.is_finite()) {
            arm.joints = None;
            return;
        }
        let known: Vec<f64> = positions.iter().copied().flatten().collect();
        if known.len() == positions.len() {
            arm.joints = Some((now, JointVector::from_column_slice(&known)));
        }
    }

    fn judge_command(&mut self, acts_before: u8, input: &Input, effects: &[Effect]) -> Judged {
        let Input::Operator { command, origin } = input else { return Ok(()) };
        let receipt = effects.iter().find_map(|effect| match effect {
            Effect::Receipt(receipt) => Some(receipt),
            _ => None,
        });
        let accepted = receipt.is_some_and(crate::command::CommandReceipt::is_accepted);
        if accepted && *origin == Origin::RosService && !matches!(command, Command::Stop | Command::Hold) {
            return Err((Invariant::ServiceMayOnlyStop, format!("a service was allowed to {command}")));
        }
        let asks_stop = effects.iter().any(|effect| matches!(effect, Effect::Switch(SwitchRequest::Stop)));
        if *command == Command::Stop && acts_before == 3 && !asks_stop {
            return Err((Invariant::StopIsAtOnce, "a stop was asked for and did not leave".into()));
        }
        if accepted {
            self.acts = match (command, self.acts) {
                (Command::Reset, _) if self.acts != 3 => 1,
                (Command::Enable, 1 | 2) => 2,
                (Command::Start, 2) => 3,
                (_, acts) => acts,
            };
            if matches!(command, Command::Continue | Command::Withdraw | Command::GoAhead | Command::Start) {
                self.held_since = None;
            }
        }
        Ok(())
    }

    fn judge_effects(&mut self, now: Stamp, effects: &[Effect]) -> Judged {
        self.note_what_is_missing(now);
        for effect in effects {
            match effect {
                Effect::Switch(SwitchRequest::Stop) => {
                    self.acts = 0;
                    self.unbearable_since = None;
                }
                Effect::Setpoint { side, joints } => self.judge_setpoint(now, *side, joints)?,
                Effect::Iteration { summary, duration_seconds, .. } => {
                    let figures = [summary.energy, *duration_seconds];
                    if figures.iter().any(|figure| !figure.is_finite() || *figure < 0.0) {
                        return Err((Invariant::FiguresAreFinite, format!("{summary:?}")));
                    }
                }
                _ => {}
            }
        }
        self.judge_distance()
    }

    /// Keeps account of since when something that motion needs is missing.
    fn note_what_is_missing(&mut self, now: Stamp) {
        let missing = Side::BOTH.into_iter().any(|side| {
            let arm = self.arms.get(side);
            !holds(now, arm.force, FORCE_HOLDS) || !holds(now, arm.joints.map(|(at, _)| at), JOINTS_HOLD)
        });
        if missing {
            self.unsafe_since.get_or_insert(now);
        } else {
            self.unsafe_since = None;
        }
    }

    fn judge_setpoint(&mut self, now: Stamp, side: Side, joints: &JointVector) -> Judged {
        if self.acts != 3 {
            return Err((Invariant::StopIsLatched, format!("a setpoint after {} of the three acts", self.acts)));
        }
        let robot = self.robot.filter(|(at, _)| holds(now, Some(*at), ROBOT_HOLDS)).map(|(_, state)| state);
        if !robot.is_some_and(|state| state.enabled && !state.stopped) {
            return Err((Invariant::RobotIsEnabled, format!("a setpoint while the robot says {robot:?}")));
        }
        let limits = self.model.arm(side).limits();
        if joints.iter().any(|joint| !joint.is_finite()) || limits.breach(joints, RANGE_TOLERANCE).is_some() {
            return Err((Invariant::JointRange, format!("{side} {joints:?}")));
        }
        let tip: Point = self.model.arm(side).forward(joints).translation.vector.into();
        let sent = Sent { at: now, joints: *joints, tip };
        self.judge_step(now, side, &sent)?;
        self.arms.get_mut(side).sent = Some(sent);
        Ok(())
    }

    fn judge_step(&mut self, now: Stamp, side: Side, sent: &Sent) -> Judged {
        let arm = *self.arms.get(side);
        let Some(before) = arm.sent.filter(|before| holds(now, Some(before.at), ONE_MOTION)) else {
            return first_step(side, &arm, sent);
        };
        let step = sent.joints - before.joints;
        if step.amax() < 1e-9 {
            return Ok(());
        }
        self.arms.get_mut(side).moved = Some(now);
        let seconds = now.since(before.at).as_secs_f64().max(0.01);
        let speed = self.model.arm(side).limits().speed;
        if let Some((index, joint)) = step
            .iter()
            .enumerate()
            .find(|(index, joint)| speed.get(*index).is_some_and(|limit| joint.abs() / seconds > limit * 1.01))
        {
            return Err((Invariant::Speed, format!("{side} joint {index} at {:.2} rad/s", joint / seconds)));
        }
        let metres = (sent.tip - before.tip).norm() / seconds;
        if metres > self.limits.speed * 1.1 {
            return Err((Invariant::Speed, format!("{side} gripper at {metres:.3} m/s")));
        }
        self.judge_motion(now)
    }

    /// Something moved: was that allowed at this moment?
    fn judge_motion(&self, now: Stamp) -> Judged {
        let too_long = |since: Option<Stamp>| since.filter(|since| now.since(*since) > BRAKING);
        if let Some(since) = too_long(self.unsafe_since) {
            let seconds = now.since(since).as_secs_f64();
            return Err((Invariant::InputsAreFresh, format!("motion {seconds:.2} s after an input was lost")));
        }
        if let Some(since) = too_long(self.held_since) {
            let seconds = now.since(since).as_secs_f64();
            return Err((Invariant::HoldHolds, format!("motion {seconds:.2} s into a hold")));
        }
        Ok(())
    }

    fn judge_distance(&self) -> Judged {
        let (Some(left), Some(right)) = (self.arms.left.sent, self.arms.right.sent) else { return Ok(()) };
        if left.at != right.at {
            return Ok(());
        }
        let distance = (left.tip - right.tip).norm();
        if distance < self.limits.minimum_gripper_distance - 1e-3 {
            return Err((Invariant::GripperDistance, format!("the grippers are {distance:.3} m apart")));
        }
        Ok(())
    }

    fn judge_force(&self, now: Stamp) -> Judged {
        match self.unbearable_since {
            Some(since) if self.acts == 3 && now.since(since) > STOP_WITHIN => {
                Err((Invariant::ForceStops, format!("more than {UNBEARABLE_NEWTONS} N and no stop")))
            }
            _ => Ok(()),
        }
    }
}

/// Whether something that arrived at a moment holds still; where the clock went back it does not.
fn holds(now: Stamp, arrived: Option<Stamp>, span: Duration) -> bool {
    arrived.and_then(|arrived| now.checked_since(arrived)).is_some_and(|age| age <= span)
}

fn first_step(side: Side, arm: &Arm, sent: &Sent) -> Judged {
    let Some((_, joints)) = arm.joints else {
        return Err((Invariant::FirstStep, format!("{side}: a setpoint although the joints are not known")));
    };
    let step = (sent.joints - joints).amax();
    if step > FIRST_STEP {
        return Err((Invariant::FirstStep, format!("{side}: the first setpoint is {step:.2} rad from the arm")));
    }
    Ok(())
}
