//! Simulated trials in which everything goes wrong that can: in virtual time, from a seed, with every invariant checked at
//! every step.
//!
//! The real supervisor meets the simulated world over a lane that loses, delays, repeats, reorders and corrupts messages;
//! clocks jump, topics fall silent, the person pulls away, the red button is pressed, and the operator does what operators
//! do and more. A [`Witness`] that shares no code with the supervisor watches what leaves it. A trial is repeated exactly
//! by its seed.

mod lane;
mod operator;
mod plan;
mod witness;

pub use witness::{Invariant, Violation};

use crate::command::Origin;
use crate::kinematics::RobotModel;
use crate::sim::World;
use crate::snapshot::Outcome;
use crate::supervisor::{Effect, Input, Supervisor};
use crate::time::Stamp;
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
            witness: Witness::new(model, limits),
            fingerprint: DefaultHasher::new(),
            result: TortureResult { seed, ..TortureResult::default() },
            plan,
        })
    }

    fn run(mut self) -> TortureResult {
        let mut world_time = START;
        for beat in 0..self.plan.beats {
            world_time = world_time + BEAT;
            let now = self.plan.clock(START, world_time);
            self.beat(world_time, now);
            if beat % BEATS_PER_LOOK == 0 {
                self.look(now);
            }
            if self.result.violation.is_some() || self.result.outcome.is_some() {
                break;
            }
        }
        self.result.seconds = world_time.since(START).as_secs_f64();
        self.result.fingerprint = self.fingerprint.finish();
        self.result
    }

    fn beat(&mut self, world_time: Stamp, now: Stamp) {
        let seconds = world_time.since(START).as_secs_f64();
        let said = self.world.step(world_time).into_inputs();
        for input in self.lane.pass(seconds, said) {
            self.step(world_time, now, &input);
        }
        self.step(world_time, now, &Input::Tick);
    }

    fn look(&mut self, now: Stamp) {
        let seen = self.supervisor.snapshot(now);
        self.witness.look(now, seen.trial.phase);
        let Some((command, origin)) = self.operator.act(&seen) else { return };
        let world_time = now;
        self.step(world_time, now, &Input::Operator { command, origin });
    }

    fn step(&mut self, world_time: Stamp, now: Stamp, input: &Input) {
        if self.result.violation.is_some() {
            return;
        }
        let effects = self.supervisor.step(now, input);
        self.result.steps += 1;
        self.result.violation = self.witness.judge(now, input, &effects);
        for effect in &effects {
            self.carry_out(world_time, effect);
        }
    }

    fn carry_out(&mut self, world_time: Stamp, effect: &Effect) {
        // JSON, since its bytes are what a record of the trial would hold.
        serde_json::to_string(effect).unwrap_or_default().hash(&mut self.fingerprint);
        match effect {
            Effect::Setpoint { side, joints } => {
                self.result.setpoints += 1;
                self.world.command_joints(*side, joints, world_time);
            }
            Effect::Switch(request) => self.world.switch(*request, world_time),
            Effect::Stopped { .. } => self.result.stops += 1,
            Effect::Iteration { .. } => self.result.iterations += 1,
            Effect::TrialEnded { outcome, .. } => self.result.outcome = Some(*outcome),
            _ => {}
        }
    }
}

/// Who asks, in the operator's place.
const fn origin(from_service: bool) -> Origin {
    if from_service { Origin::RosService } else { Origin::OperatorKey }
}

#[cfg(test)]
mod tests;
