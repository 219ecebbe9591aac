//! A trial that runs: orders become motions, arrivals and contacts go back to the trial.

use super::drive::{Arrival, Phase};
use super::{Effect, Mode, Supervisor};
use crate::body::{PerSide, Side};
use crate::geometry::{Point, Vector};
use crate::kinematics::{JointVector, MotionRefusal, PairMotion, Scene, Target, plan_pair};
use crate::safety::Reaction;
use crate::sequencing::{Order, Stage, Trial, TrialEvent};
use crate::snapshot::{Level, Outcome};
use crate::strategy::StrategyError;
use crate::time::Stamp;
use std::time::Duration;

/// After a late beat the arms go on as if it had been on time, at most two beats at once: they never hurry to catch up.
const LONGEST_SPAN: Duration = Duration::from_millis(20);

impl Supervisor {
    /// Starts the motion that the trial asks for, where none is under way.
    pub(super) fn give_orders(&mut self, now: Stamp) {
        if self.drive.phase() != Phase::Holding || self.contact.is_some() || self.questions.is_open() {
            return;
        }
        let Some(Order::Move { targets, least_seconds }) = self.trial.as_ref().map(Trial::order) else {
            return;
        };
        let Some(start) = self.both_joints(now) else {
            self.hold(now, "the positions of the robot's joints are not known");
            return;
        };
        let mut limits = self.setup.settings.motion.clone();
        limits.minimum_duration = Duration::try_from_secs_f64(least_seconds).unwrap_or_default();
        let stands_back = self.trial.as_ref().is_some_and(|trial| matches!(trial.stage(), Stage::StandBack));
        if stands_back {
            self.ask_start(now, start, limits);
            return;
        }
        if self.plans_outside() {
            self.ask_planner(now, start, targets.map(|_, place| place.map(Target::position)), limits);
            return;
        }
        let targets = targets.map(|_, place| place.map(Target::position));
        let planned = plan_pair(&self.model, &self.surroundings(), &start, &targets, &limits);
        self.begin(now, planned);
    }

    /// Where both arms are: where they were told to be, or where the robot says that they are.
    pub(super) fn both_joints(&self, now: Stamp) -> Option<PerSide<JointVector>> {
        self.drive.joints().or_else(|| self.protection.joints(now))
    }

    /// Starts a motion that was planned, or holds where there is none.
    pub(super) fn begin(&mut self, now: Stamp, planned: Result<PairMotion, MotionRefusal>) {
        // Planning takes longer than a beat, and both arms are at rest meanwhile.
        self.protection.watchdogs_mut().pause_beat();
        match planned {
            Ok(motion) => {
                self.protection.motion_begins();
                self.drive.start(motion);
                self.show_motion(now);
            }
            Err(refusal) => self.hold(now, &format!("the next move is not possible: {refusal}")),
        }
    }

    /// What the arms keep away from while the person's `arm` is dressed: the person as seen, but for the arms that the
    /// garment is led along.
    pub(super) fn scene(&self, arm: Side) -> Scene {
        let Some(body) = self.body.as_ref() else { return Scene::default() };
        let first = self.setup.settings.trial.first_arm;
        Scene::around(body, &self.setup.build, &PerSide::from_fn(|side| side == arm || side == first))
    }

    /// What the guards at the ports are to keep the arms away from: what the motion under way was planned against.
    #[must_use]
    pub fn surroundings(&self) -> Scene {
        self.scene(self.trial.as_ref().map_or(self.setup.settings.trial.first_arm, Trial::arm))
    }

    /// Samples the motion, sends what comes of it and reports arrivals.
    pub(super) fn move_on(&mut self, now: Stamp, span: Duration) {
        if self.mode == Mode::Idle {
            return;
        }
        if !self.protection.may_command(now) {
            // The rest of a motion, be it only its braking, must not come when the robot can be commanded again.
            self.drive.drop_motion();
            return;
        }
        let arrival = self.drive.tick(span.min(LONGEST_SPAN));
        if let Some(last) = self.drive.last() {
            for (side, setpoint) in last.iter() {
                self.effects.push(Effect::Setpoint { side, joints: setpoint.joints });
            }
        }
        if self.mode != Mode::Running {
            return;
        }
        match arrival {
            Arrival::AtGoal => self.arrive(now),
            Arrival::None | Arrival::Halted if self.drive.phase() == Phase::Holding => self.give_way(now),
            Arrival::None | Arrival::Halted => {}
        }
    }

    fn arrive(&mut self, now: Stamp) {
        let Some(place) = self.leading_place() else { return };
        let residual = self.residual();
        let Some(trial) = self.trial.as_mut() else { return };
        if let Some(residual) = residual {
            trial.settled(&residual);
        }
        let events = trial.arrived(place);
        if !matches!(trial.stage(), Stage::Withdraw { .. }) {
            self.protection.end_retreat();
        }
        self.take_up_pending_strategy(now);
        self.follow(now, events);
    }

    /// What is left of the resistance that was given way to, now that the arms have arrived.
    fn residual(&mut self) -> Option<Vector> {
        let yielding = self.yielding.take()?;
        let felt = self.protection.reading(self.trial.as_ref()?.arm())?;
        Some(yielding.resistance + felt.force - yielding.force)
    }

    /// Answers a contact, once the arms stand still and the force has fallen below its pause tier.
    fn give_way(&mut self, now: Stamp) {
        if self.protection.judge_force().reaction >= Reaction::Hold {
            return;
        }
        let Some(contact) = self.contact.take() else { return };
        let Some(trial) = self.trial.as_mut() else { return };
        let side = trial.arm();
        let changes = trial.resisted(&contact);
        self.contact_since = None;
        self.protection.motion_begins();
        self.show_contact(now, side, &contact);
        for change in changes {
            self.log(now, Level::Information, "strategy", format!("{side} arm: {change}"));
            self.show_change(side, &change);
            self.effects.push(Effect::Waypoint { side, change });
        }
    }

    /// Where the dressing gripper was told to be: the end of what was planned.
    pub(super) fn leading_place(&self) -> Option<Point> {
        let side = self.trial.as_ref()?.arm();
        self.drive.last().map(|last| Point::from(last.get(side).pose.translation.vector))
    }

    pub(super) fn follow(&mut self, now: Stamp, events: Result<Vec<TrialEvent>, StrategyError>) {
        match events {
            Ok(events) => events.into_iter().for_each(|event| self.report(now, event)),
            Err(error) => self.hold(now, &format!("the strategy cannot begin its pass: {error}")),
        }
    }

    fn report(&mut self, now: Stamp, event: TrialEvent) {
        match event {
            TrialEvent::IterationBegan { side, iteration } => {
                self.pass_began = Some(now);
                self.retries.pass_begins();
                self.log(now, Level::Information, "trial", format!("{side} arm: iteration {iteration} begins"));
                self.show_iteration_began(now, side, iteration);
            }
            TrialEvent::IterationEnded { side, summary } => {
                let strategy = self.trial.as_ref().map_or(self.strategy, |trial| trial.strategy(side).kind());
                let duration_seconds = self.pass_began.take().map_or(0.0, |began| now.since(began).as_secs_f64());
                self.show_iteration_ended(side, strategy, &summary, duration_seconds);
                self.comparison.iteration_ended(side, strategy, &summary);
                let text = format!(
                    "{side} arm: iteration {} ended: energy {:.1} N, {} resistances",
                    summary.iteration, summary.energy, summary.contacts
                );
                self.log(now, Level::Information, "trial", text);
                self.effects.push(Effect::Iteration { side, strategy, summary, duration_seconds });
            }
            TrialEvent::ArmDressed { side } => {
                self.retries.pass_begins();
                self.log(now, Level::Information, "trial", format!("the {side} arm is dressed"));
                self.tell_learned(side);
            }
            TrialEvent::Completed => self.end_trial(now, Outcome::Completed, "both arms are dressed"),
        }
    }

    /// Ends the trial; the arms stay where they are.
    pub(super) fn end_trial(&mut self, now: Stamp, outcome: Outcome, reason: &str) {
        self.mode = Mode::Idle;
        self.trial = None;
        self.forget_contact();
        self.forget_question();
        self.pending_strategy = None;
        self.protection.end_retreat();
        self.drive.drop_motion();
        for side in Side::BOTH {
            self.effects.push(Effect::Release { side });
        }
        self.log(now, Level::Information, "trial", format!("the trial is {}: {reason}", outcome.words()));
        self.show_end(now, outcome);
        self.effects.push(Effect::TrialEnded { outcome, reason: reason.to_owned() });
    }

    /// The arms that the next motion would move.
    pub(super) fn arms_about_to_move(targets: &PerSide<Option<Point>>) -> Vec<Side> {
        Side::BOTH.into_iter().filter(|side| targets.get(*side).is_some()).collect()
    }
}
