//! Watches what goes into the supervisor and what comes out of it, and knows what may never be.
//!
//! It shares no code with the supervisor's own checks: it keeps its own account of stops, of what has arrived and of what
//! was sent, and judges each step by that alone.

use super::invariant::{Invariant, Violation};
use crate::assembly::{RobotState, SwitchRequest};
use crate::body::{PerSide, Side};
use crate::command::{Command, Origin};
use crate::geometry::{Finite, Point};
use crate::kinematics::{JointVector, MotionLimits, RobotModel};
use crate::snapshot::{Snapshot, TrialPhase};
use crate::supervisor::{Effect, Input};
use crate::time::Stamp;
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
/// How far a first setpoint may be from where the arm is, in radians on a joint: six times the robot's own control error.
const FIRST_STEP: f64 = 0.05;

/// Between two planned postures a joint's spline may swing past its limit by this much, in radians: a ninth of the robot's own
/// control error of half a degree. What plans and guards allow too.
const RANGE_TOLERANCE: f64 = 1e-3;
/// By this factor a joint's acceleration may exceed its limit: it is the second difference of setpoints, which a moving ratio of
/// time bends a little.
const ACCELERATION_TOLERANCE: f64 = 2.0;

#[derive(Clone, Copy, Debug)]
struct Sent {
    at: Stamp,
    /// The same moment by the computer's clock.
    clock: Stamp,
    joints: JointVector,
    tip: Point,
    /// Joint speeds since the setpoint before, where that was one beat ago.
    speed: Option<JointVector>,
}

/// What the witness knows of one arm.
#[derive(Clone, Copy, Debug, Default)]
struct Arm {
    force: Option<Stamp>,
    /// When a force came in last, whatever it was.
    heard: Option<Stamp>,
    joints: Option<(Stamp, JointVector)>,
    sent: Option<Sent>,
    moved: Option<Stamp>,
}

/// Seconds within which a beat that came late is still made up for: until the robot's own time-out has stopped the arms.
const LATE: f64 = 0.2;

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
    ended: bool,
    /// How far apart the grippers were sent last, in metres.
    apart: f64,
    /// The time of the world, which no jump of the computer's clock changes: how long something lasts is measured by it.
    lived: Stamp,
}

pub(super) type Judged = Result<(), (Invariant, String)>;

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
            ended: false,
            apart: f64::INFINITY,
            lived: Stamp::ZERO,
        }
    }

    /// Is told the time of the world.
    pub(super) const fn live(&mut self, world_time: Stamp) {
        self.lived = world_time;
    }

    /// Judges, ten times a second, what the screen shows.
    pub(super) fn look(&mut self, now: Stamp, seen: &Snapshot) -> Judged {
        if seen.trial.phase == TrialPhase::Holding {
            self.held_since.get_or_insert(self.lived);
        } else {
            self.held_since = None;
        }
        for side in Side::BOTH {
            let shown = seen.sides.get(side).force.fresh_sample(now).is_some();
            if shown && !holds(now, self.arms.get(side).heard, FORCE_HOLDS) {
                return Err((Invariant::StaleDisappears, format!("the {side} force is shown although it is stale")));
            }
        }
        let heard = self.robot.map(|(at, _)| at);
        if seen.robot.fresh(now).is_some() && !holds(now, heard, ROBOT_HOLDS) {
            return Err((Invariant::StaleDisappears, "the robot's state is shown although it is stale".into()));
        }
        Ok(())
    }

    /// Judges a step.
    pub(super) fn judge(&mut self, now: Stamp, input: &Input, effects: &[Effect]) -> Option<Violation> {
        let acts_before = self.acts;
        self.take(now, input);
        let judged = self.judge_command(acts_before, input, effects).and_then(|()| self.judge_effects(now, effects));
        let judged = judged.and_then(|()| self.judge_force());
        judged.err().map(|(invariant, text)| Violation { invariant, at_seconds: now.seconds(), text })
    }

    fn take(&mut self, now: Stamp, input: &Input) {
        let lived = self.lived;
        match input {
            Input::Endpoint(sample) => {
                let arm = self.arms.get_mut(sample.side);
                let good = sample.wrench.force.is_finite();
                arm.heard = Some(now);
                arm.force = good.then_some(now);
                // After the end of a trial nothing is commanded any more: a stop would only take the decision from the operator.
                // Under a stop there is none to ask for.
                let moving = !self.ended
                    && self.acts == 3
                    && arm.moved.is_some_and(|moved| lived.since(moved) <= Duration::from_millis(50));
                if good && moving && sample.wrench.force.norm() > UNBEARABLE_NEWTONS {
                    self.unbearable_since.get_or_insert(lived);
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
            if *command == Command::Start {
                self.ended = false;
            }
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
                Effect::TrialEnded { .. } | Effect::Release { .. } => self.ended = true,
                Effect::Iteration { summary, duration_seconds, .. } => {
                    let figures = [summary.energy, *duration_seconds];
                    if figures.iter().any(|figure| !figure.is_finite() || *figure < 0.0) {
                        return Err((Invariant::FiguresAreFinite, format!("{summary:?}")));
                    }
                }
                _ => {}
            }
        }
        Ok(())
    }

    /// Keeps account of since when something that motion needs is missing.
    fn note_what_is_missing(&mut self, now: Stamp) {
        let missing = Side::BOTH.into_iter().any(|side| {
            let arm = self.arms.get(side);
            !holds(now, arm.force, FORCE_HOLDS) || !holds(now, arm.joints.map(|(at, _)| at), JOINTS_HOLD)
        });
        if missing {
            self.unsafe_since.get_or_insert(self.lived);
        } else {
            self.unsafe_since = None;
        }
    }

    /// Judges a setpoint that was decided: may anything be sent at all?
    fn judge_setpoint(&self, now: Stamp, side: Side, joints: &JointVector) -> Judged {
        if self.ended {
            return Err((Invariant::EndedIsStill, "a setpoint although no trial runs".into()));
        }
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
        Ok(())
    }

    /// Judges a setpoint that has left: where it leads and how fast.
    pub(super) fn judge_sent(&mut self, clock: Stamp, side: Side, joints: &JointVector) -> Judged {
        let tip: Point = self.model.arm(side).forward(joints).translation.vector.into();
        let (now, arm) = (self.lived, *self.arms.get(side));
        let before = arm.sent.filter(|before| holds(now, Some(before.at), ONE_MOTION));
        let mut sent = Sent { at: now, clock, joints: *joints, tip, speed: None };
        let next = before.filter(|before| now.since(before.at) <= Duration::from_millis(20));
        sent.speed = next.map(|before| (joints - before.joints) / seconds_between(&before, &sent));
        match &before {
            None => first_step(side, &arm, &sent)?,
            Some(before) => self.judge_step(side, before, &sent)?,
        }
        self.judge_workspace(side, arm.sent.map(|before| before.tip), &sent)?;
        self.arms.get_mut(side).sent = Some(sent);
        self.judge_distance()
    }

    fn judge_workspace(&self, side: Side, before: Option<Point>, sent: &Sent) -> Judged {
        let (lower, upper) = (self.limits.workspace.lower, self.limits.workspace.upper);
        let outside = |place: &Point| (lower - place).sup(&(place - upper)).max().max(0.0);
        // A gripper that is outside already may come back.
        let allowed = before.map_or(f64::INFINITY, |before| outside(&before));
        if outside(&sent.tip) > allowed.max(1e-6) {
            return Err((Invariant::Workspace, format!("the {side} gripper goes to {}", sent.tip)));
        }
        Ok(())
    }

    fn judge_step(&mut self, side: Side, before: &Sent, sent: &Sent) -> Judged {
        self.judge_acceleration(side, before, sent)?;
        let step = sent.joints - before.joints;
        if step.amax() < 1e-9 {
            return Ok(());
        }
        self.arms.get_mut(side).moved = Some(self.lived);
        let seconds = seconds_between(before, sent);
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
        self.judge_motion()
    }

    fn judge_acceleration(&self, side: Side, before: &Sent, sent: &Sent) -> Judged {
        let Some((was, is)) = before.speed.zip(sent.speed) else { return Ok(()) };
        let beat = seconds_between(before, sent);
        let most = self.limits.joint_acceleration * ACCELERATION_TOLERANCE;
        let beyond = ((is - was) / beat).iter().zip(most.iter()).position(|(value, most)| value.abs() > *most);
        match beyond {
            None => Ok(()),
            Some(joint) => {
                let value = (is - was).get(joint).copied().unwrap_or_default() / beat;
                Err((Invariant::Acceleration, format!("{side} joint {joint} at {value:.2} rad/s²")))
            }
        }
    }

    /// Something moved: was that allowed at this moment?
    fn judge_motion(&self) -> Judged {
        let too_long = |since: Option<Stamp>| since.filter(|since| self.lived.since(*since) > BRAKING);
        if let Some(since) = too_long(self.unsafe_since) {
            let seconds = self.lived.since(since).as_secs_f64();
            return Err((Invariant::InputsAreFresh, format!("motion {seconds:.2} s after an input was lost")));
        }
        if let Some(since) = too_long(self.held_since) {
            let seconds = self.lived.since(since).as_secs_f64();
            return Err((Invariant::HoldHolds, format!("motion {seconds:.2} s into a hold")));
        }
        Ok(())
    }

    fn judge_distance(&mut self) -> Judged {
        let (Some(left), Some(right)) = (self.arms.left.sent, self.arms.right.sent) else { return Ok(()) };
        if left.at != right.at {
            return Ok(());
        }
        let distance = (left.tip - right.tip).norm();
        // Before the garment is taken the grippers may be further apart than it reaches; they may come closer then.
        let furthest = self.limits.maximum_gripper_distance.max(self.apart) + 1e-3;
        self.apart = distance;
        if !(self.limits.minimum_gripper_distance - 1e-3..=furthest).contains(&distance) {
            return Err((Invariant::GripperDistance, format!("the grippers are {distance:.3} m apart")));
        }
        Ok(())
    }

    fn judge_force(&self) -> Judged {
        match self.unbearable_since {
            Some(since) if self.acts == 3 && self.lived.since(since) > STOP_WITHIN => {
                Err((Invariant::ForceStops, format!("more than {UNBEARABLE_NEWTONS} N and no stop")))
            }
            _ => Ok(()),
        }
    }
}

/// The time that a step may take: by the world, and where the clock jumped a little ahead, by as much of it as a late beat makes
/// up for. What is later than [`LATE`] is made up for by nothing.
fn seconds_between(before: &Sent, sent: &Sent) -> f64 {
    let by_clock = sent.clock.since(before.clock).as_secs_f64();
    let made_up_for = if by_clock <= LATE { by_clock.min(0.02) } else { 0.0 };
    sent.at.since(before.at).as_secs_f64().max(made_up_for).max(0.01)
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
