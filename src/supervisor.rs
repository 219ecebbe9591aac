//! The supervisor: owns everything that decides, and is stepped.
//!
//! [`Supervisor::step`] takes one input and the time and returns what is to be done. It has no clock, file, socket,
//! thread or random source: the same inputs at the same times bring the same effects, byte for byte.
//!
//! What it never does: let an arm move while a stop is latched, while the robot is not enabled, or on force, joints or
//! robot state that are stale or not finite. What it decides is checked once more by the guards at the ports.

mod compare;
mod drive;
pub mod effect;
pub mod input;
mod link;
mod movement;
mod operator;
mod planner;
mod protection;
mod retries;
mod run_key;
mod running;
mod settings;
mod sign_check;
mod start;
mod switching;
mod tuning;
mod view;
mod warm;

pub use effect::{Effect, Effects, PlanOrder};
pub use input::{EndpointSample, Input, JointSample, LinkEvent};
pub use movement::MovementOrder;
pub use settings::{PlannerKind, SettingsError, Setup, SupervisorSettings};
pub use start::{StartLeg, StartOrder};
pub use warm::WarmStart;

use crate::assembly::{RobotState, StopSource, SwitchRequest};
use crate::body::{BodyPose, PerSide, Side};
use crate::geometry::Vector;
use crate::kinematics::RobotModel;
use crate::modelling::ArmSpace;
use crate::safety::{Reaction, Verdict};
use crate::sequencing::Trial;
use crate::snapshot::{Level, Outcome, Snapshot};
use crate::strategy::{Contact, StrategyKind};
use crate::time::Stamp;
use drive::Drive;
use protection::Protection;

/// What the supervisor is about at the moment.
#[derive(Clone, Debug, PartialEq)]
enum Mode {
    /// No trial runs.
    Idle,
    /// A trial runs.
    Running,
    /// A trial is held, enabled and still, until the operator says how it goes on.
    Held,
}

/// A resistance while the arms give way to it: newtons in `base`, in the direction that the strategy is told.
#[derive(Clone, Copy, Debug)]
struct Yielding {
    resistance: Vector,
    force: Vector,
}

/// The engine's beat: 100 Hz.
const BEAT: std::time::Duration = std::time::Duration::from_millis(10);

/// A beat that seems later than this is a jump of the clock, or a pause after which the robot's own time-out (0.2 s) has
/// stopped the arms.
const LATEST: std::time::Duration = std::time::Duration::from_millis(200);

/// The share of its speed at which a motion goes on under a verdict of slow.
const SLOW_RATIO: f64 = 0.5;

/// How long the force of a contact may take to fall below the pause tier before it becomes a hold: a person yields within
/// a reaction time of 0.3 s and the movement that follows (0.12 to 0.28 s in studies of motor control), with room to spare.
const EASING: std::time::Duration = std::time::Duration::from_secs(2);

/// Owns sensing, strategies, sequencing, safety and motion of one trial after the other.
#[derive(Debug)]
pub struct Supervisor {
    setup: Setup,
    model: RobotModel,
    protection: Protection,
    drive: Drive,
    mode: Mode,
    trial: Option<Trial>,
    strategy: StrategyKind,
    pending_strategy: Option<StrategyKind>,
    contact: Option<Contact>,
    /// The resistance that the arms give way to, and the force when it was found: what is left of it is the difference.
    yielding: Option<Yielding>,
    contact_since: Option<Stamp>,
    pass_began: Option<Stamp>,
    retries: retries::Retries,
    run_key: run_key::RunKey,
    last_tick: Option<Stamp>,
    body: Option<BodyPose>,
    questions: planner::Questions,
    view: Snapshot,
    comparison: compare::Comparison,
    sign_check: Option<sign_check::SignCheck>,
    /// A recording of the person's movement, what earlier ones came to, and how many fits were asked for.
    movement: Option<movement::Recording>,
    recorded: PerSide<Option<ArmSpace>>,
    fits_asked: u64,
    /// What the robot's switch was asked and has not followed yet.
    asked: Option<switching::Asked>,
    effects: Effects,
}

impl Supervisor {
    /// A supervisor that has seen nothing yet and moves nothing.
    ///
    /// # Errors
    /// Where a setting is not usable; the error names its key.
    pub fn new(setup: Setup, model: RobotModel) -> Result<Self, SettingsError> {
        setup.validate()?;
        let mut supervisor = Self {
            protection: Protection::new(&setup.settings)?,
            strategy: setup.settings.strategy,
            setup,
            model,
            drive: Drive::new(),
            mode: Mode::Idle,
            trial: None,
            pending_strategy: None,
            contact: None,
            yielding: None,
            contact_since: None,
            pass_began: None,
            retries: retries::Retries::default(),
            run_key: run_key::RunKey::default(),
            last_tick: None,
            body: None,
            questions: planner::Questions::default(),
            view: Snapshot::default(),
            comparison: compare::Comparison::default(),
            sign_check: None,
            movement: None,
            recorded: PerSide::default(),
            fits_asked: 0,
            asked: None,
            effects: Effects::new(),
        };
        supervisor.prepare_view();
        Ok(supervisor)
    }

    /// Takes one input at a moment and returns what is to be done, in order.
    pub fn step(&mut self, now: Stamp, input: &Input) -> Effects {
        self.view.now = now;
        match input {
            Input::Tick => self.tick(now),
            Input::Endpoint(sample) => self.see_endpoint(now, sample),
            Input::Joints(sample) => self.protection.see_joints(now, sample),
            Input::Robot(state) => self.see_robot(now, state),
            Input::Collision { side, active } => self.see_collision(now, *side, *active),
            Input::Cuff { side, squeezed } => self.see_cuff(now, *side, *squeezed),
            Input::Body(pose) => self.see_body(now, pose),
            Input::Operator { command, origin } => self.obey(now, command, *origin),
            Input::Link(event) => self.see_link(now, event),
            Input::Planned { number, ways } => self.see_planned(now, *number, ways),
            Input::StartFound { number, joints } => self.see_start(now, *number, joints),
            Input::Fitted { number, space } => self.see_fitted(now, *number, space),
            Input::SetpointRefused { side, reason } => {
                self.hold(now, &format!("the {side} arm's next position was refused: {reason}"));
            }
        }
        std::mem::take(&mut self.effects)
    }

    fn tick(&mut self, now: Stamp) {
        let last = self.last_tick.replace(now).unwrap_or(now);
        if last > now {
            self.view.forget_what_lies_ahead(now);
        }
        // A clock that jumped, in either direction, says nothing about how long it was: the beat came as it always does, and an
        // arm that moves must neither stop short for one beat nor hurry.
        let span = now.checked_since(last).filter(|span| *span <= LATEST).unwrap_or(BEAT);
        let in_trial = self.mode != Mode::Idle;
        let inputs = self.protection.judge(now, in_trial);
        let force = if in_trial { self.protection.judge_force() } else { Verdict::clear() };
        let force = self.tempered(now, force);
        self.count_retries(&inputs, &force);
        self.obey_verdict(now, &inputs.stricter(force));
        self.follow_switch(now);
        self.follow_movement(now);
        self.await_start(now);
        if self.protection.stop().is_latched() {
            self.repeat_stop(now);
            return;
        }
        self.watch_run_key(now);
        if self.mode == Mode::Running {
            self.give_orders(now);
        }
        self.move_on(now, span);
    }

    /// Where the arms stand still for a contact, a pause is what happens already: it becomes a hold only where the force
    /// does not fall by itself.
    fn tempered(&self, now: Stamp, force: Verdict) -> Verdict {
        let easing = self.contact_since.is_some_and(|since| now.since(since) <= EASING);
        if easing && force.reaction == Reaction::Hold { Verdict { reaction: Reaction::Slow, ..force } } else { force }
    }

    /// A pass that force holds or stops: the operator may take it up again a few times only. A retreat is none of them.
    fn count_retries(&mut self, inputs: &Verdict, force: &Verdict) {
        let holds = force.reaction >= Reaction::Hold && force.reaction >= inputs.reaction;
        if holds && self.mode == Mode::Running && !self.protection.retreats() {
            self.retries.held_for_force();
        }
    }

    fn obey_verdict(&mut self, now: Stamp, verdict: &Verdict) {
        match verdict.reaction {
            Reaction::Clear | Reaction::Advise | Reaction::Slow if self.protection.retreats() => {
                self.drive.set_ratio(SLOW_RATIO);
            }
            Reaction::Clear | Reaction::Advise => self.drive.set_ratio(self.retries.ratio()),
            Reaction::Slow => self.drive.set_ratio(self.retries.ratio().min(SLOW_RATIO)),
            Reaction::Hold => self.hold(now, &verdict.cause),
            Reaction::Stop => self.stop(now, &verdict.cause, Outcome::SafetyStop),
        }
    }

    /// Stops the robot: latches, asks the robot's switch, forgets the motion. Works in every state.
    fn stop(&mut self, now: Stamp, cause: &str, outcome: Outcome) {
        if self.protection.stop_mut().request(now, cause) {
            self.ask_switch(now, SwitchRequest::Stop);
            self.enter_stop(now, cause, outcome);
        }
    }

    /// What a stop means in here, whoever asked for it.
    fn enter_stop(&mut self, now: Stamp, cause: &str, outcome: Outcome) {
        self.asked = None;
        self.forget_run_key();
        self.drive.drop_motion();
        self.forget_contact();
        self.protection.end_retreat();
        self.forget_question();
        self.effects.push(Effect::Stopped { outcome, cause: cause.to_owned() });
        self.log(now, Level::Error, "stop", format!("emergency stop (software): {cause}"));
        self.show_stop(now, cause);
        if self.mode != Mode::Idle {
            self.mode = Mode::Held;
        }
    }

    const fn forget_contact(&mut self) {
        self.contact = None;
        self.yielding = None;
        self.contact_since = None;
    }

    /// Until the robot confirms the stop, it is asked again at every tick.
    fn repeat_stop(&mut self, now: Stamp) {
        if self.protection.stop().needs_repeat() {
            self.ask_switch(now, SwitchRequest::Stop);
        }
        if self.protection.stop_mut().becomes_overdue(now) {
            let words = "the robot does not confirm the stop: press the red button".to_owned();
            self.log(now, Level::Error, "stop", words);
        }
    }

    /// Asks the robot's switch; the edge that follows is our own.
    fn ask_switch(&mut self, now: Stamp, request: SwitchRequest) {
        self.protection.watchdogs_mut().own_switching(now);
        self.asked = switching::Asked::new(now, request);
        self.effects.push(Effect::Switch(request));
    }

    /// Brings the arms to a halt and keeps the robot enabled where it is. Without a trial there is nothing to hold.
    fn hold(&mut self, now: Stamp, cause: &str) {
        if self.mode != Mode::Running {
            self.hold_for_more(now, cause);
            return;
        }
        self.mode = Mode::Held;
        self.forget_contact();
        self.protection.end_retreat();
        self.forget_question();
        self.drive.halt();
        self.log(now, Level::Warning, "supervisor", format!("hold: {cause}"));
        self.show_hold(now, cause);
    }

    fn see_endpoint(&mut self, now: Stamp, sample: &EndpointSample) {
        let position = sample.pose.translation.vector.into();
        let dressing = self.trial.as_ref().filter(|trial| trial.arm() == sample.side && trial.listens());
        let passed = dressing.map(|trial| trial.metres_at(&position));
        let detection = self.protection.see_endpoint(now, sample, passed, &self.drive);
        self.show_force(sample);
        self.stop_for_force(now);
        self.follow_sign_check(now, sample.side);
        let Some(detection) = detection else { return };
        let listens =
            self.trial.as_ref().is_some_and(|trial| trial.arm() == sample.side && trial.listens_at(&position));
        if self.mode == Mode::Running && listens && self.drive.phase() == drive::Phase::Moving {
            let resistance = detection.resistance;
            self.contact = Some(Contact { position, resistance });
            self.yielding =
                self.protection.reading(sample.side).map(|reading| Yielding { resistance, force: reading.force });
            self.contact_since = Some(now);
            self.drive.halt();
        }
    }

    /// A force that calls for a stop does so at once: the next sample may come before the next beat, and be a mild one.
    fn stop_for_force(&mut self, now: Stamp) {
        let force = self.protection.judge_force();
        if self.mode != Mode::Idle && force.reaction == Reaction::Stop {
            self.count_retries(&Verdict::clear(), &force);
            self.stop(now, &force.cause, Outcome::SafetyStop);
        }
    }

    fn see_robot(&mut self, now: Stamp, state: &RobotState) {
        let was_enabled = self.view.robot.state.is_some_and(|before| before.enabled);
        let stopped_itself = self.protection.see_robot(now, state);
        // How long it holds is counted by the time that is known here, not by the sender's.
        self.view.robot.state = Some(RobotState { stamp: now, ..*state });
        if let Some(cause) = stopped_itself {
            let outcome = if state.source == StopSource::Fault { Outcome::Fault } else { Outcome::OperatorStop };
            self.enter_stop(now, &cause, outcome);
        }
        self.show_stop_progress(now);
        if was_enabled && !state.enabled {
            // Motors are off: whatever was planned is void, and must not be taken up where the arms then are.
            let others = self.protection.others_switched().unwrap_or_else(|| "the robot was disabled".to_owned());
            self.hold(now, &others);
            self.drive.drop_motion();
        }
    }

    fn see_collision(&mut self, now: Stamp, side: Side, active: bool) {
        if let Some(cause) = self.protection.watchdogs_mut().collision(side, active) {
            self.hold(now, &cause);
        }
    }

    fn see_cuff(&mut self, now: Stamp, side: Side, squeezed: bool) {
        if let Some(cause) = self.protection.watchdogs_mut().cuff(side, squeezed) {
            self.hold(now, &cause);
            // Where the hand leaves the arm is not where the motion was: it must not be taken up there.
            self.drive.drop_motion();
        }
    }

    fn see_body(&mut self, now: Stamp, pose: &BodyPose) {
        self.protection.see_body(now, pose);
        if self.body.replace(*pose).is_none() {
            self.comparison.is_due();
        }
        self.show_body(now, pose);
        self.record_movement(pose);
    }

    /// Where both grippers and all joints are, as long as that is fresh.
    fn gripper(&self, now: Stamp, side: Side) -> Option<crate::geometry::Point> {
        self.protection.gripper(now, side)
    }

    /// What may be seen now.
    #[must_use]
    pub fn snapshot(&self, now: Stamp) -> Snapshot {
        self.draw_view(now)
    }

    /// True while a stop is latched.
    #[must_use]
    pub const fn is_stopped(&self) -> bool {
        self.protection.stop().is_latched()
    }

    /// True where the robot has confirmed the stop that is latched.
    #[must_use]
    pub const fn stop_is_confirmed(&self) -> bool {
        self.protection.stop().is_confirmed()
    }

    /// The strategies of both arms' trial, where one runs.
    #[must_use]
    pub const fn trial(&self) -> Option<&Trial> {
        self.trial.as_ref()
    }

    fn log(&mut self, now: Stamp, level: Level, source: &str, text: String) {
        self.show_log(now, level, source, &text);
        self.effects.push(Effect::Log { level, text });
    }
}
