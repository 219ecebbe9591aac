//! The search for a posture to begin from: no beat waits for it, and nothing moves before it has ended.

#![allow(
    clippy::unwrap_used,
    clippy::panic,
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a test may fail loudly anywhere"
)]

use std::time::Duration;
use valet::body::PerSide;
use valet::command::{Command, Origin};
use valet::kinematics::{JointVector, RobotModel};
use valet::sim::{World, WorldSetup};
use valet::snapshot::TrialPhase;
use valet::supervisor::{Effect, Input, LinkEvent, Setup, StartOrder, Supervisor};
use valet::time::Stamp;

const BEAT: Duration = Duration::from_millis(10);

/// A supervisor and a simulated world; whoever searches for postures is the test itself.
struct Room {
    supervisor: Supervisor,
    world: World,
    now: Stamp,
    orders: Vec<StartOrder>,
    setpoints: usize,
}

impl Room {
    /// A trial that was started a moment ago.
    fn started() -> Self {
        let mut room = Self {
            supervisor: Supervisor::new(Setup::default(), RobotModel::baxter().unwrap()).unwrap(),
            world: World::new(&WorldSetup::default()).unwrap(),
            now: Stamp::from_nanoseconds(1_000_000_000),
            orders: Vec::new(),
            setpoints: 0,
        };
        room.pass(1.0);
        room.ask(Command::Enable);
        room.pass(1.0);
        room.ask(Command::Start);
        room.pass(0.1);
        room
    }

    fn step(&mut self, input: &Input) {
        for effect in self.supervisor.step(self.now, input) {
            match effect {
                Effect::Setpoint { side, joints } => {
                    self.setpoints += 1;
                    self.world.command_joints(side, &joints, self.now);
                }
                Effect::Switch(request) => self.world.switch(request, self.now),
                Effect::FindStart(order) => self.orders.push(*order),
                _ => {}
            }
        }
    }

    fn ask(&mut self, command: Command) {
        self.step(&Input::Operator { command, origin: Origin::OperatorKey });
    }

    fn pass(&mut self, seconds: f64) {
        for _ in 0..(seconds * 100.0).round() as usize {
            self.now = self.now + BEAT;
            for input in self.world.step(self.now).into_inputs().collect::<Vec<_>>() {
                self.step(&input);
            }
            self.step(&Input::Tick);
        }
    }

    fn answer(&mut self, number: u64, joints: Result<PerSide<JointVector>, String>) {
        self.step(&Input::StartFound { number, joints });
    }

    fn phase(&self) -> TrialPhase {
        self.supervisor.snapshot(self.now).trial.phase
    }

    fn last_log(&self) -> String {
        self.supervisor.snapshot(self.now).log.iter().map(|line| line.text.as_str()).collect::<Vec<_>>().join("\n")
    }
}

fn found(order: &StartOrder) -> PerSide<JointVector> {
    match order.answer(&RobotModel::baxter().unwrap()) {
        Input::StartFound { joints: Ok(joints), .. } => joints,
        other => panic!("{other:?}"),
    }
}

#[test]
fn nothing_moves_before_the_posture_is_found() {
    let mut room = Room::started();
    assert_eq!(room.orders.len(), 1, "asked once, not at every beat");
    room.pass(5.0);
    assert_eq!((room.orders.len(), room.setpoints), (1, 0));
    assert_ne!(room.phase(), TrialPhase::Holding, "waiting is no fault");
    let order = room.orders[0].clone();
    room.answer(order.number, Ok(found(&order)));
    room.pass(1.0);
    assert!(room.setpoints > 100, "{}", room.setpoints);
}

#[test]
fn an_answer_to_another_question_moves_nothing() {
    let mut room = Room::started();
    let order = room.orders[0].clone();
    room.answer(order.number + 1, Ok(found(&order)));
    room.pass(1.0);
    assert_eq!(room.setpoints, 0);
}

#[test]
fn an_answer_that_comes_after_a_hold_moves_nothing_and_going_on_asks_again() {
    let mut room = Room::started();
    let order = room.orders[0].clone();
    room.ask(Command::Hold);
    room.answer(order.number, Ok(found(&order)));
    room.pass(1.0);
    assert_eq!((room.orders.len(), room.setpoints), (1, 0));
    room.ask(Command::Continue);
    room.pass(0.1);
    assert_eq!(room.orders.len(), 2);
    let again = room.orders[1].clone();
    assert_ne!(again.number, order.number);
    room.answer(order.number, Ok(found(&order)));
    room.pass(0.1);
    assert_eq!(room.setpoints, 0, "the first question was given up");
    room.answer(again.number, Ok(found(&again)));
    room.pass(0.1);
    assert!(room.setpoints > 0);
}

#[test]
fn where_there_is_no_posture_the_trial_holds_with_the_reason() {
    let mut room = Room::started();
    room.answer(room.orders[0].number, Err("the right gripper cannot reach it".into()));
    room.pass(0.1);
    assert_eq!((room.phase(), room.setpoints), (TrialPhase::Holding, 0));
    assert!(room.last_log().contains("the next move is not possible: the right gripper cannot reach it"));
}

#[test]
fn a_search_that_never_ends_is_told() {
    let mut room = Room::started();
    room.pass(31.0);
    assert_eq!((room.phase(), room.setpoints), (TrialPhase::Holding, 0));
    assert!(room.last_log().contains("no posture to begin from was found within 30 s"), "{}", room.last_log());
}

#[test]
fn a_posture_that_no_arm_has_is_refused() {
    let mut room = Room::started();
    let order = room.orders[0].clone();
    let mut joints = found(&order);
    joints.left[1] = 9.0;
    room.answer(order.number, Ok(joints));
    room.pass(1.0);
    assert_eq!((room.phase(), room.setpoints), (TrialPhase::Holding, 0));
}

#[test]
fn a_stop_while_it_is_searched_leaves_nothing_to_move() {
    let mut room = Room::started();
    let order = room.orders[0].clone();
    room.ask(Command::Stop);
    room.answer(order.number, Ok(found(&order)));
    room.step(&Input::Link(LinkEvent::MasterBack));
    room.pass(1.0);
    assert_eq!(room.setpoints, 0);
}
