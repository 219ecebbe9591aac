//! Simulated trials in which everything goes wrong that can: in virtual time, from a seed, with every invariant checked at
//! every step.
//!
//! The real supervisor meets the simulated world over a lane that loses, delays, repeats, reorders and corrupts messages;
//! clocks jump, topics fall silent, the person pulls away, the red button is pressed, and the operator does what operators
//! do and more. A witness that shares no code with the supervisor watches what leaves it. A trial is repeated exactly
//! by its seed.

mod crash;
mod guards;
mod invariant;
mod lane;
mod operator;
mod plan;
mod witness;

pub use invariant::{Invariant, Violation};

use crate::assembly::SwitchRequest;
use crate::body::Side;
use crate::command::Origin;
use crate::kinematics::{JointVector, RobotModel};
use crate::sim::World;
use crate::snapshot::Outcome;
use crate::supervisor::{Effect, Input, Supervisor};
use crate::time::Stamp;
use crash::Record;
use guards::Guards;
use lane::Lane;
use operator::ErringOperator;
use plan::TrialPlan;
use serde::Serialize;
use std::collections::hash_map::DefaultHasher;
use std::hash::{Hash, Hasher};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::time::Duration;
use witness::Witness;

/// The beat of robot and supervisor: 100 Hz.
const BEAT: Duration = Duration::from_millis(10);
/// The operator looks at the screen ten times a second.
const BEATS_PER_LOOK: u32 = 10;
/// After the end of a trial it is watched for so many beats more: nothing may move then.
const BEATS_AFTER_THE_END: u32 = 60;
/// Virtual runs begin here, far enough from zero that a clock can be set back.
const START: Stamp = Stamp::from_nanoseconds(1_000_000_000_000);

/// What came of one trial.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct TortureResult {
    /// Its seed.
    pub seed: u64,
    /// Virtual time that it took.
    pub seconds: f64,
    /// Steps of the supervisor.
    pub steps: u64,
    /// Joint positions that left for an arm.
    pub setpoints: u64,
    /// Joint positions that a guard refused.
    pub refused: u64,
    /// Emergency stops.
    pub stops: u32,
    /// Passes of the garment that ended.
    pub iterations: u32,
    /// How it ended; `None` where its time was up.
    pub outcome: Option<Outcome>,
    /// The first invariant that was broken.
    pub violation: Option<Violation>,
    /// A fingerprint of everything that the supervisor decided.
    pub fingerprint: u64,
}

/// Runs the trial of a seed. A panic anywhere in it is a violation like any other.
#[must_use]
pub fn torture(seed: u64) -> TortureResult {
    let run = catch_unwind(AssertUnwindSafe(|| TortureTrial::new(seed).map(TortureTrial::run)));
    let broken = |invariant, text: String| TortureResult {
        seed,
        violation: Some(Violation { invariant, at_seconds: 0.0, text }),
        ..TortureResult::default()
    };
    match run {
        Ok(Ok(result)) => result,
        Ok(Err(reason)) => broken(Invariant::TrialCanBegin, reason),
        Err(panic) => {
            let text = panic.downcast_ref::<String>().cloned();
            let text = text.or_else(|| panic.downcast_ref::<&str>().map(ToString::to_string));
            broken(Invariant::NoPanic, text.unwrap_or_else(|| "a panic without words".into()))
        }
    }
}

/// One trial under way.
struct TortureTrial {
    plan: TrialPlan,
    supervisor: Supervisor,
    world: World,
    lane: Lane,
    operator: ErringOperator,
    witness: Witness,
    guards: Guards,
    record: Option<Record>,
    fingerprint: DefaultHasher,
    result: TortureResult,
}

impl TortureTrial {
    fn new(seed: u64) -> Result<Self, String> {
        let plan = TrialPlan::from_seed(seed);
        let model = RobotModel::baxter().map_err(|error| error.to_string())?;
        let limits = plan.setup.settings.motion.clone();
        Ok(Self {
            supervisor: Supervisor::new(plan.setup.clone(), model.clone()).map_err(|error| error.to_string())?,
            world: World::new(&plan.world).map_err(|error| error.to_string())?,
            lane: Lane::new(plan.lane.clone(), seed),
            operator: ErringOperator::new(seed, plan.errs),
            guards: Guards::new(&model, &limits),
            record: Record::begin(seed, &plan.setup)?,
            witness: Witness::new(model, limits),
            fingerprint: DefaultHasher::new(),
            result: TortureResult { seed, ..TortureResult::default() },
            plan,
        })
    }

    fn run(mut self) -> TortureResult {
        let mut world_time = START;
        let mut left = BEATS_AFTER_THE_END;
        for beat in 0..self.plan.beats {
            world_time = world_time + BEAT;
            let now = self.plan.clock(START, world_time);
            self.beat(world_time, now);
            if beat % BEATS_PER_LOOK == 0 {
                self.look(world_time, now);
            }
            left -= u32::from(self.result.outcome.is_some());
            if self.result.violation.is_some() || left == 0 {
                break;
            }
        }
        if let Some(Err((invariant, text))) = self.record.take().map(Record::crash) {
            self.violate(world_time, invariant, text);
        }
        self.result.seconds = world_time.since(START).as_secs_f64();
        self.result.fingerprint = self.fingerprint.finish();
        self.result
    }

    fn violate(&mut self, now: Stamp, invariant: Invariant, text: String) {
        let violation = Violation { invariant, at_seconds: now.seconds(), text };
        self.result.violation.get_or_insert(violation);
    }

    fn beat(&mut self, world_time: Stamp, now: Stamp) {
        let seconds = world_time.since(START).as_secs_f64();
        if self.plan.restarts(seconds) {
            // The robot's computer was started anew: its motors are off, and nobody here asked for that.
            self.world.switch(SwitchRequest::Disable, world_time);
        }
        let said = self.world.step(world_time).into_inputs();
        for input in self.lane.pass(seconds, said) {
            self.step(world_time, now, &input);
        }
        self.step(world_time, now, &Input::Tick);
    }

    fn look(&mut self, world_time: Stamp, now: Stamp) {
        let seen = self.supervisor.snapshot(now);
        if let Err((invariant, text)) = self.witness.look(now, &seen) {
            self.violate(now, invariant, text);
        }
        if self.result.outcome.is_some() {
            // The trial is over, and nobody begins another one.
            return;
        }
        let Some((command, origin)) = self.operator.act(&seen) else { return };
        self.step(world_time, now, &Input::Operator { command, origin });
    }

    fn step(&mut self, world_time: Stamp, now: Stamp, input: &Input) {
        if self.result.violation.is_some() {
            return;
        }
        let effects = self.supervisor.step(now, input);
        self.witness.live(world_time);
        self.result.steps += 1;
        self.guards.observe(now, input, self.supervisor.is_stopped());
        self.result.violation = self.witness.judge(now, input, &effects);
        if let Some(Err(reason)) = self.record.as_mut().map(|record| record.step(now, input, &effects)) {
            self.violate(now, Invariant::RecordSurvives, reason);
        }
        for effect in &effects {
            self.carry_out(world_time, now, effect);
        }
    }

    fn carry_out(&mut self, world_time: Stamp, now: Stamp, effect: &Effect) {
        // JSON, since its bytes are what a record of the trial would hold.
        serde_json::to_string(effect).unwrap_or_default().hash(&mut self.fingerprint);
        match effect {
            Effect::Setpoint { side, joints } => self.send(world_time, now, *side, joints),
            Effect::Switch(request) => self.world.switch(*request, world_time),
            Effect::FindStart(order) => {
                let answer = order.answer(self.supervisor.model());
                self.step(world_time, now, &answer);
            }
            Effect::Stopped { .. } => self.result.stops += 1,
            Effect::Iteration { .. } => self.result.iterations += 1,
            Effect::TrialEnded { outcome, .. } => self.result.outcome = Some(*outcome),
            _ => {}
        }
    }
}

impl TortureTrial {
    /// Sends joint positions through the guards, as a session does it; a refusal goes back to the supervisor.
    fn send(&mut self, world_time: Stamp, now: Stamp, side: Side, joints: &JointVector) {
        match self.guards.pass(now, side, joints) {
            Ok(()) => {
                self.result.setpoints += 1;
                if let Err((invariant, text)) = self.witness.judge_sent(now, side, joints) {
                    self.violate(now, invariant, text);
                }
                self.world.command_joints(side, joints, world_time);
            }
            Err(reason) => {
                self.result.refused += 1;
                self.step(world_time, now, &Input::SetpointRefused { side, reason });
            }
        }
    }
}

/// Who asks, in the operator's place.
const fn origin(from_service: bool) -> Origin {
    if from_service { Origin::RosService } else { Origin::OperatorKey }
}

#[cfg(test)]
mod tests;
