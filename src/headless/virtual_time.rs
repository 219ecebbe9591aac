//! A trial in virtual time: the supervisor and the simulated world in one process, beat by beat.
//!
//! No socket, no sleep, no clock. The order of everything within a beat is fixed, so the same seed brings the same bytes.

use super::operator::ScriptedOperator;
use super::report::TrialResult;
use crate::command::{Command, Origin};
use crate::kinematics::{ModelError, RobotModel};
use crate::sequencing::Trial;
use crate::sim::world::{SimError, World, WorldSetup};
use crate::snapshot::{Outcome, Snapshot};
use crate::supervisor::{Effect, Input, LinkEvent, SettingsError, Setup, Supervisor};
use crate::time::Stamp;
use std::time::Duration;
use thiserror::Error;

/// The beat of robot and supervisor: 100 Hz.
const BEAT: Duration = Duration::from_millis(10);
/// The operator looks at the screen ten times a second.
const BEATS_PER_LOOK: u64 = 10;
/// Virtual runs begin here, so that a stamp of zero can be told from the first moment.
const START: Stamp = Stamp::from_nanoseconds(1_000_000_000);

/// Why a virtual trial cannot begin.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum VirtualError {
    /// A setting is not usable.
    #[error("the settings cannot be used: {0}")]
    Settings(#[from] SettingsError),
    /// The simulated world cannot be.
    #[error("the simulation cannot begin: {0}")]
    World(#[from] SimError),
    /// The robot's description is not usable.
    #[error("the robot's description cannot be used: {0}")]
    Model(#[from] ModelError),
}

/// One trial in virtual time.
#[derive(Debug)]
pub struct VirtualTrial {
    supervisor: Supervisor,
    world: World,
    beats: u64,
    started: Option<Stamp>,
}

impl VirtualTrial {
    /// A supervisor and a world that have not met yet.
    ///
    /// # Errors
    /// A [`VirtualError`] that names what cannot be used.
    pub fn new(setup: Setup, world: &WorldSetup) -> Result<Self, VirtualError> {
        let supervisor = Supervisor::new(setup, RobotModel::baxter()?)?;
        Ok(Self { supervisor, world: World::new(world)?, beats: 0, started: None })
    }

    /// The present moment.
    #[must_use]
    pub fn now(&self) -> Stamp {
        START + BEAT.saturating_mul(u32::try_from(self.beats).unwrap_or(u32::MAX))
    }

    /// What may be seen now.
    #[must_use]
    pub fn snapshot(&self) -> Snapshot {
        self.supervisor.snapshot(self.now())
    }

    /// The trial that runs, with its strategies; `None` before it begins and after it has ended.
    #[must_use]
    pub const fn trial(&self) -> Option<&Trial> {
        self.supervisor.trial()
    }

    /// The world, for reports and tests: the truth that no message carries.
    #[must_use]
    pub const fn world(&self) -> &World {
        &self.world
    }

    /// The world, to press its red button.
    pub const fn world_mut(&mut self) -> &mut World {
        &mut self.world
    }

    /// Time since the first command to start, in seconds.
    #[must_use]
    pub fn trial_seconds(&self) -> f64 {
        self.started.map_or(0.0, |started| self.now().since(started).as_secs_f64())
    }

    /// Somebody asks for something now.
    pub fn ask(&mut self, command: Command, observe: &mut impl FnMut(Stamp, &Input, &[Effect])) -> Vec<Effect> {
        if command == Command::Start && self.started.is_none() {
            self.started = Some(self.now());
        }
        self.step(&Input::Operator { command, origin: Origin::Headless }, observe)
    }

    /// Something that did not come from the simulated world: news of the link, or a guard's refusal.
    pub fn feed(&mut self, input: &Input) -> Vec<Effect> {
        self.step(input, &mut |_, _, _| ())
    }

    /// News of the link to the robot.
    pub fn tell(&mut self, event: LinkEvent) -> Vec<Effect> {
        self.feed(&Input::Link(event))
    }

    /// One beat: the world moves on, its messages come in, time passes. Returns the effects, setpoints included.
    pub fn beat(&mut self, observe: &mut impl FnMut(Stamp, &Input, &[Effect])) -> Vec<Effect> {
        self.beats += 1;
        let now = self.now();
        let mut effects = Vec::new();
        for input in self.world.step(now).into_inputs() {
            effects.extend(self.step(&input, observe));
        }
        effects.extend(self.step(&Input::Tick, observe));
        effects
    }

    fn step(&mut self, input: &Input, observe: &mut impl FnMut(Stamp, &Input, &[Effect])) -> Vec<Effect> {
        let now = self.now();
        let mut effects = self.supervisor.step(now, input);
        observe(now, input, &effects);
        let mut answers = Vec::new();
        for effect in &effects {
            match effect {
                Effect::Setpoint { side, joints } => self.world.command_joints(*side, joints, now),
                Effect::Switch(request) => self.world.switch(*request, now),
                Effect::FindStart(order) => answers.push(order.answer(self.supervisor.model())),
                Effect::Fit(order) => answers.push(order.answer()),
                _ => {}
            }
        }
        for answer in answers {
            effects.extend(self.step(&answer, observe));
        }
        effects
    }

    /// Runs until the trial has ended, was stopped, or `at_most` has passed. Every step is shown to `observe`: the time,
    /// what came in, and what was decided.
    pub fn run(
        &mut self,
        operator: &mut ScriptedOperator,
        at_most: Duration,
        observe: impl FnMut(Stamp, &Input, &[Effect]),
    ) -> TrialResult {
        let ended = self.run_until(operator, at_most, observe, TrialResult::of);
        ended.unwrap_or_else(|| self.unfinished(at_most))
    }

    /// As [`Self::run`], until `wanted` finds what it waits for in an effect. `None` where `at_most` passed before.
    pub fn run_until(
        &mut self,
        operator: &mut ScriptedOperator,
        at_most: Duration,
        mut observe: impl FnMut(Stamp, &Input, &[Effect]),
        wanted: impl Fn(&Effect) -> Option<TrialResult>,
    ) -> Option<TrialResult> {
        let end = self.now() + at_most;
        while self.now() < end {
            let mut effects = self.beat(&mut observe);
            if self.beats.is_multiple_of(BEATS_PER_LOOK)
                && let Some(command) = operator.act(&self.snapshot())
            {
                effects.extend(self.ask(command, &mut observe));
            }
            if let Some(reason) = operator.gave_up() {
                return Some(TrialResult { outcome: Outcome::Fault, reason: reason.to_owned() });
            }
            if let Some(result) = effects.iter().find_map(&wanted) {
                return Some(result);
            }
        }
        None
    }

    /// What is said of a trial that takes too long.
    fn unfinished(&self, at_most: Duration) -> TrialResult {
        let seen = self.snapshot();
        let reason = format!(
            "no end within {:.0} s: {} {}",
            at_most.as_secs_f64(),
            seen.trial.phase.words(),
            seen.trial.waiting_for
        );
        TrialResult { outcome: Outcome::Fault, reason }
    }
}
