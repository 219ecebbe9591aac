//! What the operator asks: carried out, or refused with the reason and with what would help.

use super::{Effect, Mode, Supervisor};
use crate::assembly::SwitchRequest;
use crate::body::{Joint, PerSide, Side};
use crate::command::{Command, CommandReceipt, Origin};
use crate::geometry::Point;
use crate::kinematics::RobotModel;
use crate::sequencing::{Next, PersonPlan, Stage, Trial};
use crate::snapshot::{Level, Outcome};
use crate::strategy::{self, ArmContext, Strategy, StrategyKind};
use crate::time::Stamp;

/// What a command comes to: when it takes effect, or why it is refused.
type Answer = Result<String, String>;

impl Supervisor {
    /// Obeys a command, or refuses it, and answers with a receipt in either case.
    pub(super) fn obey(&mut self, now: Stamp, command: &Command, origin: Origin) {
        let answer = match origin {
            Origin::RosService if !matches!(command, Command::Stop | Command::Hold) => {
                Err("another node may stop and hold, nothing else".to_owned())
            }
            _ => self.answer(now, command),
        };
        let receipt = match answer {
            Ok(effective) => CommandReceipt::accepted(command.clone(), effective),
            Err(reason) => CommandReceipt::refused(command.clone(), reason),
        };
        // A key that is held repeats: only its refusals are worth a line.
        if !(receipt.is_accepted() && matches!(command, Command::Run)) {
            self.show_receipt(now, origin, &receipt);
        }
        self.effects.push(Effect::Receipt(receipt));
    }

    fn answer(&mut self, now: Stamp, command: &Command) -> Answer {
        match command {
            Command::Stop => {
                self.stop(now, "the operator", Outcome::OperatorStop);
                Ok("now".into())
            }
            Command::Hold => self.obey_hold(now),
            Command::Continue => self.obey_continue(now),
            Command::Run => self.obey_run(now),
            Command::Abort => self.obey_abort(now),
            Command::Withdraw => self.obey_withdraw(now),
            Command::GoAhead | Command::NextIteration | Command::NextStep => self.obey_go_ahead(now),
            Command::PreviousStep => Err("a step is undone by withdrawing the garment: hold, then withdraw".into()),
            Command::FinishAfterThis => self.obey_finish(),
            Command::Reset => self.obey_reset(now),
            Command::Enable => self.obey_enable(now),
            Command::Disable => self.obey_disable(now),
            Command::Start => self.obey_start(now),
            Command::SelectStrategy(kind) => self.obey_strategy(now, *kind),
            Command::SelectFirstArm(side) => self.obey_first_arm(*side),
            Command::SetSetting { key, value } => self.obey_setting(now, key, *value),
            Command::UndoSetting { key } => self.obey_undo(now, key),
            Command::Tare(side) => self.obey_tare(now, *side),
            Command::Note(text) => {
                self.log(now, Level::Information, "note", text.clone());
                Ok("written down".into())
            }
            Command::SelectProfile(_) | Command::SelectGarment(_) => {
                Err("profile and garment are chosen when valet is started: --profile".into())
            }
            Command::SignCheck(side) => self.begin_sign_check(now, *side),
            Command::RecordMovement { side, seconds } => self.obey_record_movement(now, *side, *seconds),
            // The recorder sees the receipt and acts.
            Command::SetRecording(_) => Ok("now".into()),
        }
    }

    fn obey_hold(&mut self, now: Stamp) -> Answer {
        match self.mode {
            Mode::Running => {
                self.hold(now, "the operator");
                Ok("now".into())
            }
            Mode::Held => {
                // Where it holds for the run key only, that does no longer end it.
                self.hold(now, "the operator");
                Ok("it holds already".into())
            }
            Mode::Idle => Err("no trial runs: nothing moves".into()),
        }
    }

    /// What every motion needs; the words say what is missing and what to do.
    fn may_move(&self, now: Stamp) -> Result<(), String> {
        self.protection.readiness(now)
    }

    fn obey_continue(&mut self, now: Stamp) -> Answer {
        if self.mode != Mode::Held {
            return Err("nothing is held".into());
        }
        if let Err(reason) = self.may_move(now).and_then(|()| self.retries.check()) {
            // What keeps it now may be something else than what held it first.
            self.view.trial.hold_cause.clone_from(&reason);
            return Err(reason);
        }
        self.go_on(now);
        self.log(now, Level::Information, "operator", format!("the trial goes on{}", self.retries.words()));
        Ok("now".into())
    }

    /// Ends a hold; whether it may end was asked before.
    pub(super) fn go_on(&mut self, now: Stamp) {
        self.protection.watchdogs_mut().acknowledge();
        self.forget_run_key();
        self.mode = Mode::Running;
        self.show_continue(now);
    }

    fn obey_abort(&mut self, now: Stamp) -> Answer {
        if self.mode == Mode::Idle {
            return Err("no trial runs".into());
        }
        self.end_trial(now, Outcome::Aborted, "the operator gave it up; the arms stay where they are");
        Ok("now".into())
    }

    fn obey_withdraw(&mut self, now: Stamp) -> Answer {
        if self.mode != Mode::Held {
            return Err("hold first: the garment is withdrawn from a hold".into());
        }
        self.protection.may_retreat(now)?;
        let place = self.trial.as_ref().and_then(|trial| self.gripper(now, trial.arm()));
        let (Some(place), Some(trial)) = (place, self.trial.as_mut()) else {
            return Err("the gripper's position is not known".into());
        };
        if !trial.withdraw(place) {
            return Err("the garment is on no arm: continue, or abort".into());
        }
        self.go_on(now);
        self.protection.begin_retreat();
        self.log(now, Level::Information, "operator", "the garment is withdrawn along the travelled path".into());
        Ok("now, slowly".into())
    }

    fn obey_go_ahead(&mut self, now: Stamp) -> Answer {
        let stage = self.trial.as_ref().map(Trial::stage).cloned();
        let (Mode::Running, Some(Stage::AwaitGoAhead(next))) = (&self.mode, stage) else {
            return Err("the trial does not wait for a go-ahead".into());
        };
        self.may_move(now)?;
        if next == Next::SecondArm {
            self.prepare_second_arm(now)?;
        }
        let events = self.trial.as_mut().map_or_else(|| Ok(Vec::new()), Trial::go_ahead);
        self.follow(now, events);
        Ok("now".into())
    }

    /// The second arm has moved since the trial began: its path is laid out anew from where it is now.
    fn prepare_second_arm(&mut self, now: Stamp) -> Result<(), String> {
        let Some(side) = self.trial.as_ref().map(|trial| trial.arm().other()) else { return Ok(()) };
        let joints = self.arm_joints(side)?;
        let strategy = self.lay_out(now, side, joints)?;
        if let Some(trial) = self.trial.as_mut() {
            trial.lay_out(side, joints, strategy);
        }
        Ok(())
    }

    fn obey_finish(&mut self) -> Answer {
        let trial = self.trial.as_mut().ok_or("no trial runs")?;
        trial.finish_after_this();
        Ok("at the end of this iteration".into())
    }

    fn obey_reset(&mut self, now: Stamp) -> Answer {
        let robot = self.protection.robot(now).copied();
        self.protection.stop_mut().reset(now, robot.as_ref())?;
        self.ask_switch(now, SwitchRequest::Reset);
        self.log(now, Level::Information, "operator", "reset: the robot stays disabled until Enable".into());
        Ok("now; nothing moves before Enable and Start".into())
    }

    fn obey_enable(&mut self, now: Stamp) -> Answer {
        let robot = self.protection.robot(now).copied();
        self.protection.stop_mut().enable(robot.as_ref())?;
        self.ask_switch(now, SwitchRequest::Enable);
        self.log(
            now,
            Level::Information,
            "operator",
            "enable: the motors are switched on; nothing moves before Start".into(),
        );
        Ok("now; nothing moves before Start".into())
    }

    #[expect(clippy::unnecessary_wraps, reason = "every act is answered in the same form")]
    fn obey_disable(&mut self, now: Stamp) -> Answer {
        self.hold(now, "the operator disables the robot");
        self.drive.drop_motion();
        self.ask_switch(now, SwitchRequest::Disable);
        Ok("now; the arms sink".into())
    }

    fn obey_start(&mut self, now: Stamp) -> Answer {
        let robot = self.protection.robot(now).copied();
        if self.mode == Mode::Running {
            return Err("a trial runs already".into());
        }
        self.protection.stop_mut().start(robot.as_ref())?;
        self.show_stop_progress(now);
        if self.mode == Mode::Held {
            self.show_hold(now, "after a stop: continue, withdraw or abort");
            return Ok("the stop is over; the trial holds: continue, withdraw or abort".into());
        }
        if !self.view.recorder.fault.is_empty() {
            let fault = &self.view.recorder.fault;
            return Err(format!(
                "the trial would not be recorded ({fault}): mend that and start valet again, or start it with --no-record"
            ));
        }
        self.may_move(now)?;
        let plan =
            PersonPlan { arms: PerSide { left: self.arm_joints(Side::Left)?, right: self.arm_joints(Side::Right)? } };
        let strategies = PerSide {
            left: self.lay_out(now, Side::Left, plan.arms.left)?,
            right: self.lay_out(now, Side::Right, plan.arms.right)?,
        };
        self.trial = Some(Trial::new(self.setup.settings.trial.clone(), plan, strategies));
        self.end_movement_for_trial(now);
        self.retries.pass_begins();
        self.mode = Mode::Running;
        self.protection.watchdogs_mut().acknowledge();
        self.tare_at_rest(now);
        self.log(now, Level::Information, "trial", format!("the trial begins with the {} strategy", self.strategy));
        self.show_start(now);
        Ok("now".into())
    }

    /// Before a trial both arms stand still and free: the best moment for a zero.
    fn tare_at_rest(&mut self, now: Stamp) {
        for side in Side::BOTH {
            if let Err(reason) = self.protection.tare(now, side) {
                self.log(now, Level::Warning, "force", format!("the {side} force keeps its old zero: {reason}"));
            }
        }
    }

    /// Hand, elbow and shoulder of one of the person's arms, as they are seen now.
    pub(super) fn arm_joints(&self, side: Side) -> Result<[Point; 3], String> {
        let arm = self.body.as_ref().map(|body| body.arms.get(side));
        let place = |joint: Joint| {
            arm.and_then(|arm| arm.position(joint)).ok_or_else(|| {
                format!("the person's {side} {joint} is not seen: clear the camera's view, or ask the person to move a little")
            })
        };
        Ok([place(Joint::Hand)?, place(Joint::Elbow)?, place(Joint::Shoulder)?])
    }

    pub(super) fn build_strategy(
        &self,
        side: Side,
        kind: StrategyKind,
        joints: [Point; 3],
    ) -> Result<Box<dyn Strategy>, String> {
        let space = self.space_of(side).cloned();
        let context = ArmContext { initial: joints, space, seed: self.setup.seed };
        strategy::build(kind, &self.setup.settings.strategies, &context).map_err(|error| error.to_string())
    }

    /// The chosen strategy for an arm whose joints are there, begun with what an earlier trial learned where that is chosen.
    fn lay_out(&mut self, now: Stamp, side: Side, joints: [Point; 3]) -> Result<Box<dyn Strategy>, String> {
        let mut strategy = self.build_strategy(side, self.strategy, joints)?;
        self.start_warm(now, side, strategy.as_mut(), joints);
        Ok(strategy)
    }

    fn obey_strategy(&mut self, now: Stamp, kind: StrategyKind) -> Answer {
        let Some(trial) = self.trial.as_ref() else {
            self.strategy = kind;
            self.show_strategy(now);
            return Ok("with the next trial".into());
        };
        // A strategy that cannot work here is refused now, not at the safe point.
        self.build_strategy(trial.arm(), kind, self.arm_joints(trial.arm())?)?;
        let between_passes = trial.is_between_passes();
        self.pending_strategy = Some(kind);
        self.show_strategy(now);
        if between_passes {
            self.take_up_pending_strategy(now);
            return Ok("now".into());
        }
        Ok("when this pass of the garment has ended".into())
    }

    /// Puts a strategy that was chosen into the place of the present one, where the trial is between two passes.
    pub(super) fn take_up_pending_strategy(&mut self, now: Stamp) {
        let Some(kind) = self.pending_strategy else { return };
        let Some(trial) = self.trial.as_ref().filter(|trial| trial.is_between_passes()) else { return };
        self.pending_strategy = None;
        let side = trial.arm();
        let learned = trial.strategy(side).learned();
        let joints = self.trial.as_ref().map(|trial| trial.joints(side));
        let built = joints.ok_or_else(String::new).and_then(|joints| self.build_strategy(side, kind, joints));
        match built {
            Ok(mut strategy) => {
                let dropped = strategy.adopt(&learned);
                self.strategy = kind;
                if let Some(trial) = self.trial.as_mut() {
                    trial.replace_strategy(side, strategy);
                }
                let dropped = if dropped.is_empty() { "nothing is dropped".to_owned() } else { dropped.join("; ") };
                self.log(now, Level::Information, "strategy", format!("now {kind}: the path is kept, {dropped}"));
            }
            Err(reason) => self.log(now, Level::Warning, "strategy", format!("{kind} was not taken up: {reason}")),
        }
        self.show_strategy(now);
    }

    fn obey_first_arm(&mut self, side: Side) -> Answer {
        if self.mode != Mode::Idle {
            return Err("the first arm is chosen before a trial".into());
        }
        self.setup.settings.trial.first_arm = side;
        self.comparison.is_due();
        self.show_steps();
        Ok("with the next trial".into())
    }

    fn obey_tare(&mut self, now: Stamp, side: Side) -> Answer {
        if self.mode == Mode::Running && self.drive.phase() != super::drive::Phase::Holding {
            return Err("an arm moves: tare only while both stand still".into());
        }
        self.protection.tare(now, side).map(|zero| format!("now: zero is {:.1} {:.1} {:.1} N", zero.x, zero.y, zero.z))
    }

    /// The robot model that motions are planned with.
    #[must_use]
    pub const fn model(&self) -> &RobotModel {
        &self.model
    }
}
