//! Keeps the snapshot up to date: everything that may be seen, written down as it happens.
//!
//! Nothing here decides. What only holds for a while (force, pose, robot state) goes into the snapshot with its stamp and
//! deadline, so that whoever draws it can tell stale from fresh.

use super::{EndpointSample, LinkEvent, Mode, Supervisor};
use crate::body::{BodyPose, Joint, PerSide, Side};
use crate::command::{CommandReceipt, Origin};
use crate::geometry::Point;
use crate::modelling::{ArmSpace, Mixture};
use crate::safety::StopPhase;
use crate::sequencing::{Next, Order, Stage, Step, Trial};
use crate::snapshot::{
    Detection, EllipseView, ForceSample, Freshness, IterationView, Level, LogLine, MotionNotice, Outcome, ReceiptLine,
    RunKeyView, Shared, Snapshot, StepRow, TimelineEvent, TimelineKind, TrialPhase, WaypointRow,
};
use crate::strategy::{Contact, IterationSummary, StrategyKind, WaypointChange};
use crate::time::Stamp;

/// A count as the screen shows it; beyond four billion it no longer matters.
fn count(number: usize) -> u32 {
    u32::try_from(number).unwrap_or(u32::MAX)
}

/// The components of an arm's movement space, as they are drawn.
fn ellipses_of(space: &ArmSpace) -> Vec<EllipseView> {
    let of_joint = |joint: Joint| {
        let components = space.joint(joint).map(Mixture::components).unwrap_or_default();
        components.iter().map(move |component| EllipseView {
            joint,
            weight: component.weight(),
            mean: Point::from(*component.mean()),
            covariance: [0, 1, 2].map(|row| [0, 1, 2].map(|column| component.covariance()[(row, column)])),
        })
    };
    Joint::DRESSED.into_iter().flat_map(of_joint).collect()
}

impl Supervisor {
    pub(super) fn prepare_view(&mut self) {
        self.view.watermark = self.setup.watermark;
        self.view.trial.profile.clone_from(&self.setup.profile);
        self.view.trial.profile_hash.clone_from(&self.setup.profile_hash);
        self.view.trial.garment.clone_from(&self.setup.garment);
        self.view.trial.seed = self.setup.seed;
        self.show_run_key();
        self.view.trial.strategy = Some(self.strategy);
        self.view.robot.deadline_seconds = self.protection.watch().robot_state.as_secs_f64();
        let deadline = self.protection.watch().pose.as_secs_f64();
        self.view.body.freshness = Freshness { last: None, deadline };
        for side in Side::BOTH {
            self.view.sides.get_mut(side).iterations_maximum =
                self.setup.settings.strategies.learning.maximum_iterations;
            let freshness = Freshness { last: None, deadline: self.protection.force_deadline().as_secs_f64() };
            self.view.sides.get_mut(side).force.freshness = freshness;
            self.show_space(side, None);
        }
        self.view.choices.make_mut().strategies = StrategyKind::ALL.to_vec();
        self.comparison.is_due();
        self.show_steps();
        self.show_settings();
    }

    /// Shows a movement space; where none is given, the one that is used.
    pub(super) fn show_space(&mut self, side: Side, space: Option<&ArmSpace>) {
        let ellipses = space.or_else(|| self.space_of(side)).map(ellipses_of).unwrap_or_default();
        self.view.sides.get_mut(side).path.ellipses = ellipses.into();
    }

    pub(super) fn show_steps(&mut self) {
        let first = self.setup.settings.trial.first_arm;
        let rows = Step::ALL.map(|step| StepRow {
            number: u32::from(step.number()),
            goals: PerSide::from_fn(|side| step.place(first, side).to_string()),
        });
        self.view.trial.steps = Shared::new(rows.to_vec());
        self.view.trial.first_arm = Some(first);
    }

    pub(super) fn show_force(&mut self, sample: &EndpointSample) {
        let reading = self.protection.reading(sample.side);
        let view = self.view.sides.get_mut(sample.side);
        view.force.freshness.last = Some(self.view.now);
        let Some(reading) = reading else { return };
        view.force.samples.push(ForceSample {
            stamp: sample.stamp,
            force: reading.force.into(),
            change: reading.change.map(Into::into),
            statistic: reading.statistic,
        });
    }

    pub(super) fn show_stop(&mut self, now: Stamp, cause: &str) {
        self.view.stop.latched = true;
        self.view.stop.requested_at = Some(now);
        self.view.stop.sent_at = Some(now);
        self.view.stop.confirmed_at = None;
        self.view.stop.is_reset = false;
        cause.clone_into(&mut self.view.stop.cause);
        self.mark(now, None, TimelineKind::Stop);
        self.enter(now, TrialPhase::Stopped);
    }

    pub(super) fn show_stop_progress(&mut self, now: Stamp) {
        let stop = self.protection.stop();
        self.view.stop.latched = stop.is_latched();
        self.view.stop.confirmed_at = stop.confirmed_at();
        self.view.stop.is_reset =
            matches!(stop.phase(), StopPhase::Disabled | StopPhase::Enabling | StopPhase::Enabled);
        if !stop.is_latched() && self.view.trial.phase == TrialPhase::Stopped {
            let phase = if self.mode == Mode::Held { TrialPhase::Holding } else { TrialPhase::Idle };
            self.enter(now, phase);
        }
    }

    pub(super) fn show_hold(&mut self, now: Stamp, cause: &str) {
        cause.clone_into(&mut self.view.trial.hold_cause);
        self.mark(now, None, TimelineKind::Hold);
        self.enter(now, TrialPhase::Holding);
    }

    /// Shows whether the arms need a held key.
    pub(super) const fn show_run_key(&mut self) {
        self.view.trial.run_key = match (self.setup.settings.trial.hold_to_run, self.waits_for_run_key()) {
            (false, _) => RunKeyView::NotNeeded,
            (true, false) => RunKeyView::Needed,
            (true, true) => RunKeyView::Awaited,
        };
    }

    pub(super) fn show_continue(&mut self, now: Stamp) {
        self.view.trial.hold_cause.clear();
        self.mark(now, None, TimelineKind::Continue);
        self.show_motion(now);
    }

    pub(super) fn show_body(&mut self, now: Stamp, pose: &BodyPose) {
        self.view.body.pose = Some(*pose);
        self.view.body.freshness.last = Some(now);
    }

    pub(super) fn show_link(&mut self, event: &LinkEvent) {
        match event {
            LinkEvent::MasterLost => self.view.master.connected = false,
            LinkEvent::MasterBack => self.view.master.connected = true,
            LinkEvent::RecorderFailed { reason } => self.view.recorder.fault.clone_from(reason),
            _ => {}
        }
    }

    pub(super) fn show_log(&mut self, now: Stamp, level: Level, source: &str, text: &str) {
        let id = self.view.log.last().map_or(0, |line| line.id + 1);
        self.view.log.push(LogLine { id, stamp: now, level, source: source.to_owned(), text: text.to_owned() });
    }

    pub(super) fn show_receipt(&mut self, now: Stamp, origin: Origin, receipt: &CommandReceipt) {
        self.view.receipts.push(ReceiptLine { stamp: now, origin, receipt: receipt.clone() });
    }

    pub(super) fn show_contact(&mut self, now: Stamp, side: Side, contact: &Contact) {
        let iteration = self.trial.as_ref().map_or(0, Trial::iteration);
        let log_line = self.view.log.last().map(|line| line.id + 1);
        self.view.sides.get_mut(side).force.detections.push(Detection {
            stamp: now,
            magnitude: contact.resistance.norm(),
            vector: contact.resistance.into(),
            iteration,
            waypoint: None,
            log_line,
        });
        let iterations = self.view.sides.get_mut(side).iterations.make_mut();
        if let Some(running) = iterations.last_mut().filter(|iteration| !iteration.finished) {
            running.energy += contact.resistance.norm();
            running.resistances += 1;
        }
        self.mark(now, Some(side), TimelineKind::Resistance);
    }

    pub(super) fn show_change(&mut self, side: Side, change: &WaypointChange) {
        let rows = &mut self.view.sides.get_mut(side).path.changes;
        let mut changes = rows.to_vec();
        changes.push(WaypointRow {
            index: change.index,
            iteration: change.iteration,
            old: change.from,
            new: change.to,
            force: change.resistance,
            reason: change.to_string(),
        });
        *rows = Shared::new(changes);
    }

    pub(super) fn show_iteration_began(&mut self, now: Stamp, side: Side, iteration: u32) {
        let Some(trial) = self.trial.as_ref() else { return };
        let planned = trial.strategy(side).path().to_vec();
        let strategy = trial.strategy(side).kind();
        let view = self.view.sides.get_mut(side);
        view.path.planned = Shared::new(planned);
        let mut iterations = view.iterations.to_vec();
        iterations.push(IterationView {
            number: iteration,
            strategy,
            energy: 0.0,
            resistances: 0,
            waypoints: 0,
            duration: 0.0,
            finished: false,
        });
        view.iterations = Shared::new(iterations);
        self.mark(now, Some(side), TimelineKind::Iteration(iteration));
    }

    pub(super) fn show_iteration_ended(
        &mut self,
        side: Side,
        strategy: StrategyKind,
        summary: &IterationSummary,
        duration_seconds: f64,
    ) {
        let view = self.view.sides.get_mut(side);
        view.path.updated = Shared::new(summary.path.clone());
        let mut iterations = view.iterations.to_vec();
        iterations.retain(|iteration| iteration.finished);
        iterations.push(IterationView {
            number: summary.iteration,
            strategy,
            energy: summary.energy,
            resistances: summary.contacts,
            waypoints: count(summary.path.len()),
            duration: duration_seconds,
            finished: true,
        });
        view.iterations = Shared::new(iterations);
    }

    pub(super) fn show_start(&mut self, now: Stamp) {
        self.comparison.trial_begins();
        for side in Side::BOTH {
            let view = self.view.sides.get_mut(side);
            view.iterations = Shared::default();
            view.path.changes = Shared::default();
            view.path.travelled = Shared::default();
        }
        self.view.trial.outcome = None;
        self.view.trial.hold_cause.clear();
        self.show_strategy(now);
        self.show_motion(now);
    }

    pub(super) fn show_end(&mut self, now: Stamp, outcome: Outcome) {
        self.view.trial.outcome = Some(outcome);
        self.view.trial.next = None;
        self.view.trial.hold_cause.clear();
        self.view.trial.arm = None;
        self.enter(now, TrialPhase::Ended);
    }

    pub(super) fn show_strategy(&mut self, _now: Stamp) {
        self.comparison.is_due();
        let at_work = self.trial.as_ref().map(|trial| trial.strategy(trial.arm()).kind());
        self.view.trial.strategy = Some(at_work.unwrap_or(self.strategy));
        self.view.trial.strategy_pending =
            self.pending_strategy.map(|kind| (kind, "when this pass of the garment has ended".to_owned()));
    }

    /// The phase and step that the trial has come to, when a motion begins or the trial goes on.
    pub(super) fn show_motion(&mut self, now: Stamp) {
        let Some(trial) = self.trial.as_ref() else { return };
        let phase = match trial.stage() {
            Stage::StandBack | Stage::Approach | Stage::Receive => TrialPhase::Positioning,
            Stage::Pass | Stage::Adjust { .. } => TrialPhase::Dressing,
            Stage::Withdraw { .. } => TrialPhase::Withdrawing,
            Stage::AwaitGoAhead(_) => TrialPhase::Waiting,
            Stage::Done => TrialPhase::Ended,
        };
        let step = u32::from(trial.step().number());
        let changed = self.view.trial.step != PerSide::from_fn(|_| Some(step));
        self.enter(now, phase);
        if changed {
            self.view.trial.step = PerSide::from_fn(|_| Some(step));
            self.mark(now, None, TimelineKind::Step(step));
        }
    }

    fn enter(&mut self, now: Stamp, phase: TrialPhase) {
        if self.view.trial.phase != phase {
            self.view.trial.phase = phase;
            self.view.trial.since = Some(now);
        }
    }

    fn mark(&mut self, stamp: Stamp, side: Option<Side>, kind: TimelineKind) {
        self.view.timeline.push(TimelineEvent { stamp, side, kind });
    }

    /// The snapshot with what changes from moment to moment filled in.
    pub(super) fn draw_view(&self, now: Stamp) -> Snapshot {
        let mut view = self.view.clone();
        view.now = now;
        view.trial.speed_share = Some(self.drive.ratio());
        for side in Side::BOTH {
            let shown = view.sides.get_mut(side);
            shown.path.gripper = self.gripper(now, side);
            self.protection.show(side, now, &mut shown.force);
        }
        if let Some(trial) = self.trial.as_ref() {
            self.draw_trial(now, trial, &mut view);
        }
        view
    }

    fn draw_trial(&self, now: Stamp, trial: &Trial, view: &mut Snapshot) {
        let arm = trial.arm();
        view.trial.arm = Some(arm);
        if self.mode == Mode::Running && matches!(trial.stage(), Stage::AwaitGoAhead(_)) {
            view.trial.phase = TrialPhase::Waiting;
        }
        view.trial.waiting_for = waiting_for(self.mode == Mode::Running, trial);
        view.trial.next = Self::notice(trial);
        let shown = view.sides.get_mut(arm);
        shown.path.travelled = Shared::new(trial.travelled().to_vec());
        shown.path.updated = Shared::new(trial.strategy(arm).path().to_vec());
        if trial.iteration() > 0 {
            shown.progress = self.gripper(now, arm).map(|place| trial.progress_at(&place));
        }
        let runs = shown.iterations.last().is_some_and(|iteration| !iteration.finished);
        if let Some(began) = self.pass_began.filter(|_| runs)
            && let Some(running) = shown.iterations.make_mut().last_mut()
        {
            running.duration = now.since(began).as_secs_f64();
        }
    }

    fn notice(trial: &Trial) -> Option<MotionNotice> {
        let Order::Move { targets, .. } = trial.order() else { return None };
        let arms = Self::arms_about_to_move(&targets);
        let what = match trial.stage() {
            Stage::StandBack => "take the start posture, back from the person".to_owned(),
            Stage::Approach => "go behind the shoulders".to_owned(),
            Stage::Receive => format!("go to the {} hand", trial.arm()),
            Stage::Pass => format!("pass the garment along the {} arm", trial.arm()),
            Stage::Adjust { .. } => "give way to the resistance".to_owned(),
            Stage::Withdraw { .. } => "withdraw the garment along the travelled path".to_owned(),
            Stage::AwaitGoAhead(_) | Stage::Done => return None,
        };
        let why =
            format!("step {} of table 3.1, strategy {}", trial.step().number(), trial.strategy(trial.arm()).kind());
        Some(MotionNotice { arms, what, why })
    }
}

fn waiting_for(running: bool, trial: &Trial) -> String {
    if !running {
        return String::new();
    }
    let other = trial.arm().other();
    match trial.stage() {
        Stage::AwaitGoAhead(Next::Iteration) => {
            format!("go-ahead for iteration {} of the {} arm", trial.iteration() + 1, trial.arm())
        }
        Stage::AwaitGoAhead(Next::SecondArm) => {
            format!("go-ahead for the {other} arm: ask the person to draw the {other} hand back")
        }
        _ => String::new(),
    }
}
