//! A supervisor and a simulated world in virtual time, with a hand between them that may alter what is said.

use std::time::Duration;
use valet::body::{PerSide, Side};
use valet::command::{Command, CommandReceipt, Origin};
use valet::geometry::{Point, Vector};
use valet::kinematics::{JointVector, RobotModel};
use valet::sim::{World, WorldSetup};
use valet::snapshot::TrialPhase;
use valet::supervisor::{Effect, Input, Setup, Supervisor};
use valet::time::Stamp;

pub(super) const BEAT: Duration = Duration::from_millis(10);
/// Within this span an arm has braked from its highest speed.
pub(super) const BRAKING_BEATS: usize = 80;

/// A supervisor and a simulated world, with a hand between them that may alter what the supervisor is told.
pub(super) struct Room {
    pub(super) supervisor: Supervisor,
    pub(super) world: World,
    pub(super) model: RobotModel,
    pub(super) now: Stamp,
    /// What was sent to both arms, by beat.
    pub(super) sent: Vec<PerSide<Option<JointVector>>>,
    pub(super) told: Vec<Effect>,
    pub(super) measured: PerSide<Option<JointVector>>,
    /// True where what is asked of the robot's switch does not arrive.
    pub(super) switch_is_cut: bool,
}

#[expect(clippy::unnecessary_wraps, reason = "stands where a fault may swallow the input")]
pub(super) fn unaltered(input: Input) -> Option<Input> {
    Some(input)
}

impl Room {
    pub(super) fn new() -> Self {
        Self::with(Setup::default())
    }

    pub(super) fn with(setup: Setup) -> Self {
        let mut world = WorldSetup::default();
        world.wrench.noise_newtons = 0.2;
        let model = RobotModel::baxter().unwrap();
        let mut room = Self {
            supervisor: Supervisor::new(setup, model.clone()).unwrap(),
            world: World::new(&world).unwrap(),
            model,
            now: Stamp::from_nanoseconds(1_000_000_000),
            sent: Vec::new(),
            told: Vec::new(),
            measured: PerSide::default(),
            switch_is_cut: false,
        };
        room.beats(100, unaltered);
        assert!(room.ask(Command::Enable).is_accepted());
        room.beats(100, unaltered);
        assert!(room.ask(Command::Start).is_accepted());
        room
    }

    /// A trial whose garment is some way along the arm.
    pub(super) fn dressing() -> Self {
        let mut room = Self::new();
        room.until(TrialPhase::Dressing);
        room.beats(150, unaltered);
        assert_eq!(room.phase(), TrialPhase::Dressing);
        room
    }

    pub(super) fn step(&mut self, input: &Input) {
        let (mut sent, mut answer) = (PerSide::default(), None);
        for effect in self.supervisor.step(self.now, input) {
            match &effect {
                Effect::Setpoint { side, joints } => {
                    self.world.command_joints(*side, joints, self.now);
                    *sent.get_mut(*side) = Some(*joints);
                }
                Effect::Switch(request) if !self.switch_is_cut => self.world.switch(*request, self.now),
                Effect::FindStart(order) => answer = Some(order.answer(self.supervisor.model())),
                _ => {}
            }
            self.told.push(effect);
        }
        if let Some(answer) = answer {
            self.step(&answer);
        }
        if matches!(input, Input::Tick) {
            self.sent.push(sent);
        }
    }

    pub(super) fn beat(&mut self, alter: &mut impl FnMut(Input) -> Option<Input>) {
        self.now = self.now + BEAT;
        let said: Vec<Input> = self.world.step(self.now).into_inputs().filter_map(alter).collect();
        for input in said {
            self.measure(&input);
            self.step(&input);
        }
        self.step(&Input::Tick);
    }

    fn measure(&mut self, input: &Input) {
        if let Input::Joints(sample) = input {
            self.measured = sample.positions.map(|_, joints| {
                let known: Option<Vec<f64>> = joints.iter().copied().collect();
                known.map(|known| JointVector::from_column_slice(&known))
            });
        }
    }

    /// The world goes on for some beats, and nobody decides anything.
    pub(super) fn world_alone(&mut self, beats: usize) {
        for _ in 0..beats {
            self.now = self.now + BEAT;
            let said: Vec<Input> = self.world.step(self.now).into_inputs().collect();
            said.iter().for_each(|input| self.measure(input));
        }
    }

    pub(super) fn beats(&mut self, count: usize, mut alter: impl FnMut(Input) -> Option<Input>) {
        (0..count).for_each(|_| self.beat(&mut alter));
    }

    pub(super) fn until(&mut self, phase: TrialPhase) {
        self.until_with(phase, unaltered);
    }

    pub(super) fn until_with(&mut self, phase: TrialPhase, mut alter: impl FnMut(Input) -> Option<Input>) {
        for _ in 0..6000 {
            if self.phase() == phase {
                return;
            }
            self.beat(&mut alter);
        }
        let seen = self.supervisor.snapshot(self.now).trial;
        panic!("no {phase:?} within a minute: {:?} {}", seen.phase, seen.hold_cause);
    }

    pub(super) fn phase(&self) -> TrialPhase {
        self.supervisor.snapshot(self.now).trial.phase
    }

    pub(super) fn hold_cause(&self) -> String {
        self.supervisor.snapshot(self.now).trial.hold_cause.clone()
    }

    pub(super) fn ask(&mut self, command: Command) -> CommandReceipt {
        self.ask_from(command, Origin::OperatorKey)
    }

    pub(super) fn ask_from(&mut self, command: Command, origin: Origin) -> CommandReceipt {
        let before = self.told.len();
        self.step(&Input::Operator { command, origin });
        let receipt = self.told[before..].iter().find_map(|effect| match effect {
            Effect::Receipt(receipt) => Some(receipt.clone()),
            _ => None,
        });
        receipt.unwrap()
    }

    /// The places of a gripper as they were sent since a beat.
    pub(super) fn places(&self, side: Side, since: usize) -> Vec<Point> {
        let arm = self.model.arm(side);
        let joints = self.sent[since..].iter().filter_map(|sent| *sent.get(side));
        joints.map(|joints| arm.forward(&joints).translation.vector.into()).collect()
    }

    /// The largest step of a joint between two beats since a beat.
    pub(super) fn largest_step(&self, since: usize) -> f64 {
        let steps = Side::BOTH.into_iter().flat_map(|side| {
            let sent: Vec<JointVector> = self.sent[since..].iter().filter_map(|sent| *sent.get(side)).collect();
            sent.windows(2).map(|pair| (pair[1] - pair[0]).amax()).collect::<Vec<_>>()
        });
        steps.fold(0.0, f64::max)
    }
}

/// Adds a force from outside on the right gripper, in `base`: the robot reports it with the opposite sign.
pub(super) fn pulled(newtons: Vector) -> impl FnMut(Input) -> Option<Input> {
    move |mut input| {
        if let Input::Endpoint(sample) = &mut input
            && sample.side == Side::Right
        {
            sample.wrench.force -= newtons;
        }
        Some(input)
    }
}
