//! Requirements of `docs/safety.md` that the whole of supervisor, guards and simulated world must keep, each with its fault
//! injected; and that every requirement has a test that bears its number.

#![allow(clippy::unwrap_used, clippy::panic, clippy::indexing_slicing, reason = "a test may fail loudly anywhere")]
#![allow(clippy::float_cmp, reason = "an arm that is held is commanded the very same joints")]

use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;
use std::time::Duration;
use valet::body::{PerSide, Side};
use valet::command::{Command, CommandReceipt, Origin};
use valet::geometry::{Point, Vector};
use valet::kinematics::{JointVector, MotionLimits, RobotModel};
use valet::robot::dummy::DummyLimb;
use valet::robot::{CommandError, GuardSettings, GuardedLimb, GuardedPair, Limit};
use valet::sim::{World, WorldSetup};
use valet::snapshot::TrialPhase;
use valet::strategy::StrategyKind;
use valet::supervisor::{Effect, Input, Setup, Supervisor};
use valet::time::Stamp;

const BEAT: Duration = Duration::from_millis(10);
/// Within this span an arm has braked from its highest speed.
const BRAKING_BEATS: usize = 80;

/// A supervisor and a simulated world, with a hand between them that may alter what the supervisor is told.
struct Room {
    supervisor: Supervisor,
    world: World,
    model: RobotModel,
    now: Stamp,
    /// What was sent to both arms, by beat.
    sent: Vec<PerSide<Option<JointVector>>>,
    told: Vec<Effect>,
    measured: PerSide<Option<JointVector>>,
}

#[expect(clippy::unnecessary_wraps, reason = "stands where a fault may swallow the input")]
fn unaltered(input: Input) -> Option<Input> {
    Some(input)
}

impl Room {
    fn new() -> Self {
        Self::with(Setup::default())
    }

    fn with(setup: Setup) -> Self {
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
        };
        room.beats(100, unaltered);
        assert!(room.ask(Command::Enable).is_accepted());
        room.beats(100, unaltered);
        assert!(room.ask(Command::Start).is_accepted());
        room
    }

    /// A trial whose garment is some way along the arm.
    fn dressing() -> Self {
        let mut room = Self::new();
        room.until(TrialPhase::Dressing);
        room.beats(150, unaltered);
        assert_eq!(room.phase(), TrialPhase::Dressing);
        room
    }

    fn step(&mut self, input: &Input) {
        let mut sent = PerSide::default();
        for effect in self.supervisor.step(self.now, input) {
            match &effect {
                Effect::Setpoint { side, joints } => {
                    self.world.command_joints(*side, joints, self.now);
                    *sent.get_mut(*side) = Some(*joints);
                }
                Effect::Switch(request) => self.world.switch(*request, self.now),
                _ => {}
            }
            self.told.push(effect);
        }
        if matches!(input, Input::Tick) {
            self.sent.push(sent);
        }
    }

    fn beat(&mut self, alter: &mut impl FnMut(Input) -> Option<Input>) {
        self.now = self.now + BEAT;
        let said: Vec<Input> = self.world.step(self.now).into_inputs().filter_map(alter).collect();
        for input in said {
            if let Input::Joints(sample) = &input {
                self.measured = sample.positions.map(|_, joints| {
                    let known: Option<Vec<f64>> = joints.iter().copied().collect();
                    known.map(|known| JointVector::from_column_slice(&known))
                });
            }
            self.step(&input);
        }
        self.step(&Input::Tick);
    }

    fn beats(&mut self, count: usize, mut alter: impl FnMut(Input) -> Option<Input>) {
        (0..count).for_each(|_| self.beat(&mut alter));
    }

    fn until(&mut self, phase: TrialPhase) {
        self.until_with(phase, unaltered);
    }

    fn until_with(&mut self, phase: TrialPhase, mut alter: impl FnMut(Input) -> Option<Input>) {
        for _ in 0..6000 {
            if self.phase() == phase {
                return;
            }
            self.beat(&mut alter);
        }
        let seen = self.supervisor.snapshot(self.now).trial;
        panic!("no {phase:?} within a minute: {:?} {}", seen.phase, seen.hold_cause);
    }

    fn phase(&self) -> TrialPhase {
        self.supervisor.snapshot(self.now).trial.phase
    }

    fn hold_cause(&self) -> String {
        self.supervisor.snapshot(self.now).trial.hold_cause.clone()
    }

    fn ask(&mut self, command: Command) -> CommandReceipt {
        self.ask_from(command, Origin::OperatorKey)
    }

    fn ask_from(&mut self, command: Command, origin: Origin) -> CommandReceipt {
        let before = self.told.len();
        self.step(&Input::Operator { command, origin });
        let receipt = self.told[before..].iter().find_map(|effect| match effect {
            Effect::Receipt(receipt) => Some(receipt.clone()),
            _ => None,
        });
        receipt.unwrap()
    }

    /// The places of a gripper as they were sent since a beat.
    fn places(&self, side: Side, since: usize) -> Vec<Point> {
        let arm = self.model.arm(side);
        let joints = self.sent[since..].iter().filter_map(|sent| *sent.get(side));
        joints.map(|joints| arm.forward(&joints).translation.vector.into()).collect()
    }

    /// The largest step of a joint between two beats since a beat.
    fn largest_step(&self, since: usize) -> f64 {
        let steps = Side::BOTH.into_iter().flat_map(|side| {
            let sent: Vec<JointVector> = self.sent[since..].iter().filter_map(|sent| *sent.get(side)).collect();
            sent.windows(2).map(|pair| (pair[1] - pair[0]).amax()).collect::<Vec<_>>()
        });
        steps.fold(0.0, f64::max)
    }
}

/// Adds a force from outside on the right gripper, in `base`: the robot reports it with the opposite sign.
fn pulled(newtons: Vector) -> impl FnMut(Input) -> Option<Input> {
    move |mut input| {
        if let Input::Endpoint(sample) = &mut input
            && sample.side == Side::Right
        {
            sample.wrench.force -= newtons;
        }
        Some(input)
    }
}

fn guarded(room: &Room) -> GuardedPair<DummyLimb> {
    let limits = MotionLimits::default();
    let limbs = PerSide::from_fn(|side| {
        let arm = room.model.arm(side).clone();
        GuardedLimb::new(
            DummyLimb::default(),
            arm,
            limits.clone(),
            GuardSettings::default(),
            Arc::new(AtomicBool::new(false)),
        )
    });
    GuardedPair::new(limbs, room.model.clone(), limits)
}

/// Offers a beat's setpoints to the guards.
fn offer(pair: &mut GuardedPair<DummyLimb>, room: &Room) -> Result<(), CommandError> {
    for (side, measured) in room.measured.iter() {
        if let Some(measured) = measured {
            let positions: [f64; 7] = (*measured).into();
            pair.observe(room.now, side, &positions.map(Some));
        }
    }
    let Some(sent) = room.sent.last() else { return Ok(()) };
    for (side, joints) in sent.iter() {
        if let Some(joints) = joints {
            pair.command(room.now, side, joints)?;
        }
    }
    Ok(())
}

#[test]
fn s_34_a_whole_pass_is_inside_all_limits_and_what_is_not_is_refused_and_held() {
    let mut room = Room::new();
    let mut pair = guarded(&room);
    let mut dressing_beats = 0;
    while dressing_beats < 300 {
        room.beat(&mut unaltered);
        offer(&mut pair, &room).unwrap();
        dressing_beats += usize::from(room.phase() == TrialPhase::Dressing);
        assert!(room.sent.len() < 6000, "no pass began");
    }
    let here = room.sent.last().unwrap().map(|_, joints| joints.unwrap());
    let refusal = |pair: &mut GuardedPair<DummyLimb>, joint: usize, by: f64| {
        let mut joints = here.right;
        joints[joint] += by;
        let before = pair.limb(Side::Right).inner().told.len();
        let error = pair.command(room.now + BEAT, Side::Right, &joints).unwrap_err();
        assert_eq!(pair.limb(Side::Right).inner().told.len(), before, "nothing was sent");
        error
    };
    let CommandError::Refused(range) = refusal(&mut pair, 5, 5.0) else { panic!("refused for its range") };
    assert!(matches!(range.what, Limit::JointPosition { .. }), "{range}");
    let CommandError::Refused(speed) = refusal(&mut pair, 3, 0.05) else { panic!("refused for its speed") };
    assert!(speed.to_string().contains("right"), "{speed}");
    // What the guard says goes back to the supervisor, as the engine does it.
    let refused = Input::SetpointRefused { side: Side::Right, reason: speed.to_string() };
    room.step(&refused);
    assert_eq!(room.phase(), TrialPhase::Holding);
    assert!(room.hold_cause().contains(&speed.to_string()), "{}", room.hold_cause());
    room.beats(BRAKING_BEATS, unaltered);
    let since = room.sent.len();
    room.beats(200, unaltered);
    assert_eq!(room.largest_step(since), 0.0);
}

#[test]
fn s_34_grippers_too_close_are_refused() {
    let mut room = Room::new();
    let mut pair = guarded(&room);
    room.beat(&mut unaltered);
    offer(&mut pair, &room).unwrap();
    // Each arm as it is, and the other one mirrored onto it: both grippers in one place.
    let measured = room.measured.map(|_, joints| joints.unwrap());
    let tip = |joints: &JointVector, side: Side| room.model.arm(side).forward(joints).translation.vector;
    let start = tip(&measured.right, Side::Right);
    let mut refused = None;
    let mut joints = measured.right;
    let mut now = room.now;
    // Turned inwards at the shoulder, slowly enough for every other limit.
    for beat in 0..4000 {
        now = now + BEAT;
        joints[0] += 0.001_f64.min(1e-5 * f64::from(beat));
        for (side, own) in [(Side::Right, joints), (Side::Left, measured.left)] {
            let positions: [f64; 7] = own.into();
            pair.observe(now, side, &positions.map(Some));
        }
        if let Err(CommandError::Refused(breach)) = pair.command(now, Side::Right, &joints) {
            refused = Some(breach);
            break;
        }
    }
    let breach = refused.expect("the arm went on into the other one");
    assert!(matches!(breach.what, Limit::GripperDistance | Limit::Clearance { .. }), "{breach}");
    assert!((tip(&joints, Side::Right) - start).norm() > 0.05, "not at once: {breach}");
}

#[test]
fn s_35_after_the_arm_was_moved_by_hand_the_first_setpoint_is_where_it_is_now() {
    let mut room = Room::dressing();
    assert!(room.ask(Command::Disable).is_accepted());
    room.beats(50, unaltered);
    // Somebody moves the arm while its motors are off.
    let moved = |mut input: Input| {
        if let Input::Joints(sample) = &mut input {
            for joint in sample.positions.right.iter_mut().flatten().take(2) {
                *joint += 0.04;
            }
        }
        Some(input)
    };
    room.beats(50, moved);
    assert!(room.ask(Command::Enable).is_accepted());
    room.beats(100, moved);
    let (since, measured) = (room.sent.len(), room.measured.right.unwrap());
    assert!(room.ask(Command::Continue).is_accepted());
    room.beats(30, moved);
    let first = room.sent[since..].iter().find_map(|sent| sent.right).expect("it went on");
    let off = (first - measured).amax();
    assert!(off < 0.01, "the first setpoint is {off} rad from the arm");
}

#[test]
fn s_35_a_first_setpoint_elsewhere_is_refused() {
    let mut room = Room::new();
    let mut pair = guarded(&room);
    room.beats(3, unaltered);
    let positions: [f64; 7] = room.measured.right.unwrap().into();
    pair.observe(room.now, Side::Right, &positions.map(Some));
    let mut joints = room.measured.right.unwrap();
    joints[2] += 0.2;
    let error = pair.command(room.now, Side::Right, &joints).unwrap_err();
    assert!(
        matches!(&error, CommandError::Refused(breach) if matches!(breach.what, Limit::Following { .. })),
        "{error}"
    );
    assert!(pair.limb(Side::Right).inner().told.is_empty());
}

fn every_command() -> Vec<Command> {
    vec![
        Command::Continue,
        Command::Abort,
        Command::Withdraw,
        Command::GoAhead,
        Command::NextIteration,
        Command::NextStep,
        Command::PreviousStep,
        Command::FinishAfterThis,
        Command::Reset,
        Command::Enable,
        Command::Disable,
        Command::Start,
        Command::SelectStrategy(StrategyKind::Gmm),
        Command::SelectFirstArm(Side::Left),
        Command::SetSetting { key: "window.threshold_newtons".into(), value: 9.0 },
        Command::UndoSetting { key: "window.threshold_newtons".into() },
        Command::Tare(Side::Left),
        Command::Note("x".into()),
        Command::SelectProfile("x".into()),
        Command::SelectGarment("x".into()),
    ]
}

#[test]
fn s_36_another_node_may_stop_and_hold_and_nothing_else() {
    for command in every_command() {
        let mut room = Room::dressing();
        let before = room.supervisor.snapshot(room.now);
        let receipt = room.ask_from(command.clone(), Origin::RosService);
        assert!(!receipt.is_accepted(), "{command}");
        let after = room.supervisor.snapshot(room.now);
        assert_eq!(before.trial.phase, after.trial.phase, "{command}");
        assert_eq!(before.robot.state, after.robot.state);
    }
    let mut room = Room::dressing();
    assert!(room.ask_from(Command::Hold, Origin::RosService).is_accepted());
    assert_eq!(room.phase(), TrialPhase::Holding);
    assert!(!room.ask_from(Command::Continue, Origin::RosService).is_accepted());
    assert!(room.ask_from(Command::Stop, Origin::RosService).is_accepted());
    assert!(room.supervisor.is_stopped());
}

#[test]
fn s_39_in_a_hold_nothing_moves_beyond_braking_until_the_operator_acts() {
    for beats in [0, 7, 33, 90, 210] {
        let mut room = Room::new();
        room.until(TrialPhase::Dressing);
        room.beats(beats, unaltered);
        assert!(room.ask(Command::Hold).is_accepted(), "{beats}");
        room.beats(BRAKING_BEATS, unaltered);
        let since = room.sent.len();
        // The world goes on: the person is felt and pulls, a pose is lost, messages come late.
        room.beats(500, pulled(Vector::new(-6.0, 2.0, 0.0)));
        room.beats(300, |input| (!matches!(input, Input::Body(_))).then_some(input));
        room.beats(700, unaltered);
        assert_eq!(room.phase(), TrialPhase::Holding);
        assert_eq!(room.largest_step(since), 0.0);
        let since = room.sent.len();
        assert!(room.ask(Command::Continue).is_accepted());
        room.beats(200, unaltered);
        assert!(room.largest_step(since) > 0.0, "the operator acted, and it goes on");
    }
}

/// How far a place is from a path of places.
fn distance(place: &Point, path: &[Point]) -> f64 {
    path.iter().map(|point| (point - place).norm()).fold(f64::INFINITY, f64::min)
}

/// From a hold: the garment is withdrawn along the path that was travelled, slowly, back to where the pass began.
fn withdraws(mut room: Room, what: &str, mut alter: impl FnMut(Input) -> Option<Input>) {
    assert_eq!(room.phase(), TrialPhase::Holding, "{what}");
    room.beats(BRAKING_BEATS, &mut alter);
    let travelled = room.places(Side::Right, 0);
    let since = room.sent.len();
    let receipt = room.ask(Command::Withdraw);
    assert!(receipt.is_accepted(), "{what}: {receipt:?}");
    room.until_with(TrialPhase::Waiting, &mut alter);
    let back = room.places(Side::Right, since);
    let far = back.iter().map(|place| distance(place, &travelled)).fold(0.0, f64::max);
    assert!(far < 0.01, "{what}: {far} m off the travelled path");
    let fastest = back.windows(2).map(|pair| (pair[1] - pair[0]).norm() / 0.01).fold(0.0, f64::max);
    let limit = MotionLimits::default().speed;
    assert!(fastest < 0.55 * limit, "{what}: {fastest} m/s");
    let hand = room.supervisor.trial().unwrap().joints(Side::Right)[0];
    let end = back.last().unwrap();
    assert!((end - hand).norm() < 0.05, "{what}: it ends {end}, the pass began at {hand}");
}

#[test]
fn s_41_from_a_hold_of_the_operator_the_garment_is_withdrawn() {
    let mut room = Room::dressing();
    room.ask(Command::Hold);
    withdraws(room, "operator", unaltered);
}

#[test]
fn s_41_from_a_hold_for_force_that_stays_the_garment_is_withdrawn() {
    let mut room = Room::dressing();
    let pull = Vector::new(0.0, 0.0, -18.0);
    room.until_with(TrialPhase::Holding, pulled(pull));
    room.beats(BRAKING_BEATS, pulled(pull));
    assert!(!room.ask(Command::Continue).is_accepted(), "18 N stand: forward is refused");
    withdraws(room, "force", pulled(pull));
}

#[test]
fn s_41_a_withdrawal_that_pulls_more_than_its_beginning_is_held() {
    let mut room = Room::dressing();
    room.until_with(TrialPhase::Holding, pulled(Vector::new(0.0, 0.0, -17.0)));
    room.beats(BRAKING_BEATS, pulled(Vector::new(0.0, 0.0, -17.0)));
    assert!(room.ask(Command::Withdraw).is_accepted());
    room.beats(30, pulled(Vector::new(0.0, 0.0, -17.0)));
    assert_eq!(room.phase(), TrialPhase::Withdrawing);
    room.beats(30, pulled(Vector::new(0.0, 0.0, -22.0)));
    assert_eq!(room.phase(), TrialPhase::Holding);
    assert!(room.hold_cause().contains("force"), "{}", room.hold_cause());
}

#[test]
fn s_41_without_the_camera_the_garment_is_withdrawn() {
    let mut room = Room::dressing();
    let blind = |input: Input| (!matches!(input, Input::Body(_))).then_some(input);
    room.until_with(TrialPhase::Holding, blind);
    assert!(!room.ask(Command::Continue).is_accepted());
    withdraws(room, "camera", blind);
}

#[test]
fn s_41_after_the_motors_were_off_the_garment_is_withdrawn() {
    let mut room = Room::dressing();
    room.ask(Command::Disable);
    room.beats(100, unaltered);
    assert!(!room.ask(Command::Withdraw).is_accepted(), "nothing moves while the motors are off");
    room.ask(Command::Enable);
    room.beats(100, unaltered);
    withdraws(room, "motors", unaltered);
}

#[test]
fn s_41_after_a_stop_the_garment_is_withdrawn_once_the_three_acts_were_done() {
    let mut room = Room::dressing();
    room.ask(Command::Stop);
    room.beats(100, unaltered);
    for command in [Command::Reset, Command::Enable, Command::Start] {
        assert!(!room.ask(Command::Withdraw).is_accepted(), "before {command}");
        assert!(room.ask(command).is_accepted());
        room.beats(100, unaltered);
    }
    withdraws(room, "stop", unaltered);
}

#[test]
fn s_41_where_the_garment_is_on_no_arm_nothing_moves_on() {
    let mut room = Room::new();
    room.until(TrialPhase::Positioning);
    room.beats(50, unaltered);
    room.ask(Command::Hold);
    room.beats(BRAKING_BEATS, unaltered);
    let since = room.sent.len();
    assert!(!room.ask(Command::Withdraw).is_accepted());
    room.beats(100, unaltered);
    assert_eq!((room.phase(), room.largest_step(since)), (TrialPhase::Holding, 0.0));
}

#[test]
fn s_14_a_soft_catch_that_the_window_does_not_see_moves_the_path_before_10_newtons() {
    let mut setup = Setup::default();
    // The thesis' detector is as good as off.
    setup.settings.window.threshold_newtons = 15.0;
    let mut room = Room::with(setup);
    room.until(TrialPhase::Dressing);
    room.beats(100, unaltered);
    let (mut caught_at, mut most): (Option<Point>, f64) = (None, 0.0);
    let told = room.told.len();
    let spring = |input: Input| {
        let mut input = input;
        if let Input::Endpoint(sample) = &mut input
            && sample.side == Side::Right
        {
            let place: Point = sample.pose.translation.vector.into();
            let pull = (*caught_at.get_or_insert(place) - place) * 60.0;
            most = most.max(pull.norm());
            sample.wrench.force -= pull;
        }
        Some(input)
    };
    room.beats(250, spring);
    let moved = room.told[told..].iter().any(|effect| matches!(effect, Effect::Waypoint { .. }));
    assert!(moved, "the path gave way; the pull reached {most} N");
    assert!(most < 10.0, "{most} N");
}

/// Every file of tests: those of the rooms and those of the whole.
fn sources(folder: &Path, found: &mut String) {
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            sources(&path, found);
        } else if path.extension().is_some_and(|extension| extension == "rs" || extension == "py") {
            found.push_str(&std::fs::read_to_string(&path).unwrap());
        }
    }
}

#[test]
fn every_requirement_has_a_test_that_bears_its_number() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let document = std::fs::read_to_string(root.join("docs/safety.md")).unwrap();
    let ids: Vec<&str> = document.lines().filter_map(|line| line.strip_prefix("| S-")?.get(..2)).collect();
    assert!(ids.len() >= 41, "the table of requirements was read: {ids:?}");
    let mut tests = String::new();
    ["src", "tests"].iter().for_each(|folder| sources(&root.join(folder), &mut tests));
    let missing: Vec<&&str> = ids.iter().filter(|id| !tests.contains(&format!("fn s_{id}_"))).collect();
    assert!(missing.is_empty(), "requirements without a test of their own: {missing:?}");
    // And no test bears a number that the document does not have.
    let tested = tests.match_indices("fn s_").filter_map(|(at, _)| tests.get(at + 5..at + 7));
    let unknown: Vec<&str> = tested.filter(|id| id.parse::<u32>().is_ok() && !ids.contains(id)).collect();
    assert!(unknown.is_empty(), "tests of requirements that are not in docs/safety.md: {unknown:?}");
}
