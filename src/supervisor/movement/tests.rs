//! Recordings of a person who moves, is hidden, or is started upon.

use super::*;
use crate::body::JointEstimate;
use crate::command::{Command, Origin};
use crate::kinematics::RobotModel;
use crate::supervisor::Setup;
use nalgebra::Matrix3;

const FRAME: Duration = Duration::from_millis(33);

/// A supervisor and a person whose hand goes round while elbow and shoulder nearly rest.
struct Room {
    supervisor: Supervisor,
    now: Stamp,
    phase: f64,
    evidence: Evidence,
    told: Vec<Effect>,
}

impl Room {
    fn new() -> Self {
        let supervisor = Supervisor::new(Setup::default(), RobotModel::baxter().unwrap()).unwrap();
        let now = Stamp::ZERO + Duration::from_secs(10);
        let mut room = Self { supervisor, now, phase: 0.0, evidence: Evidence::Seen, told: Vec::new() };
        room.frames(1);
        room
    }

    fn pose(&self) -> BodyPose {
        let swing = Vector::new(self.phase.cos(), self.phase.sin(), (0.7 * self.phase).sin()) * 0.2;
        let mut pose = BodyPose { stamp: self.now, ..BodyPose::default() };
        for (joint, place, share) in [
            (Joint::Hand, Point::new(0.8, -0.3, 0.1), 1.0),
            (Joint::Elbow, Point::new(0.95, -0.35, 0.2), 0.4),
            (Joint::Shoulder, Point::new(1.0, -0.2, 0.45), 0.05),
        ] {
            let estimate = JointEstimate {
                position: place + swing * share,
                covariance: Matrix3::identity() * 1e-4,
                confidence: 1.0,
                evidence: self.evidence,
            };
            pose.arms.right.set(joint, Some(estimate));
        }
        pose
    }

    fn step(&mut self, input: &Input) {
        let effects = self.supervisor.step(self.now, input);
        for effect in &effects {
            if let Effect::Fit(order) = effect {
                let answer = order.answer();
                self.step(&answer);
            }
        }
        self.told.extend(effects);
    }

    fn frames(&mut self, count: u32) {
        for _ in 0..count {
            (self.now, self.phase) = (self.now + FRAME, self.phase + 0.13);
            self.step(&Input::Body(self.pose()));
            self.step(&Input::Tick);
        }
    }

    fn ask(&mut self, side: Side, seconds: f64) -> bool {
        let command = Command::RecordMovement { side, seconds };
        self.step(&Input::Operator { command, origin: Origin::OperatorKey });
        self.told.iter().rev().find_map(|effect| match effect {
            Effect::Receipt(receipt) => Some(receipt.is_accepted()),
            _ => None,
        }) == Some(true)
    }

    fn recorded(&self) -> Option<&ArmSpace> {
        self.told.iter().find_map(|effect| match effect {
            Effect::Recorded { side: Side::Right, space } => Some(space.as_ref()),
            _ => None,
        })
    }

    fn said(&self, words: &str) -> bool {
        self.told.iter().any(|effect| matches!(effect, Effect::Log { text, .. } if text.contains(words)))
    }
}

#[test]
fn a_movement_is_counted_fitted_on_the_way_and_used_afterwards() {
    let mut room = Room::new();
    assert!(room.supervisor.space_of(Side::Right).is_none());
    assert!(room.ask(Side::Right, 5.0));
    room.frames(60);
    let view = room.supervisor.snapshot(room.now);
    let movement = view.trial.movement.unwrap();
    assert_eq!((movement.side, movement.poses), (Side::Right, 60));
    assert!((movement.seconds_left - 3.0).abs() < 0.1, "{movement:?}");
    assert_eq!(view.sides.right.path.seen.len(), 180);
    assert!(!view.sides.right.path.ellipses.is_empty(), "the mixtures appear while the person moves");
    assert!(room.recorded().is_none());
    room.frames(100);
    let space = room.recorded().unwrap();
    assert!((space.hand.mode() - Point::new(0.8, -0.3, 0.1)).norm() < 0.35);
    assert!(space.whole.is_some(), "joints that were seen together know of each other");
    assert_eq!(room.supervisor.space_of(Side::Right), Some(space));
    assert!(room.supervisor.snapshot(room.now).trial.movement.is_none());
}

#[test]
fn what_was_only_inferred_or_comes_twice_does_not_count() {
    let mut room = Room::new();
    assert!(room.ask(Side::Right, 3.0));
    room.frames(20);
    let again = Input::Body(room.pose());
    room.step(&again);
    room.evidence = Evidence::Inferred;
    room.frames(20);
    assert_eq!(room.supervisor.snapshot(room.now).trial.movement.unwrap().poses, 20);
    room.frames(60);
    assert!(room.recorded().is_none() && room.said("20 times"));
    assert!(room.supervisor.snapshot(room.now).trial.movement.is_none());
}

#[test]
fn what_cannot_be_recorded_is_refused() {
    let mut room = Room::new();
    assert!(!room.ask(Side::Left, 10.0), "nobody sees the left arm");
    for seconds in [0.0, -1.0, 1e9, f64::NAN] {
        assert!(!room.ask(Side::Right, seconds), "{seconds}");
    }
    assert!(room.ask(Side::Right, 10.0));
    assert!(!room.ask(Side::Right, 10.0), "one recording at a time");
}

#[test]
fn a_fit_that_fails_or_comes_late_leaves_what_was_there() {
    let mut room = Room::new();
    assert!(room.ask(Side::Right, 2.0));
    room.frames(40);
    room.step(&Input::Fitted { number: 77, space: Err("nobody asked".into()) });
    assert!(room.supervisor.movement.is_some());
    room.supervisor.follow_movement(room.now + Duration::from_secs(3));
    let number = room.supervisor.fits_asked;
    room.step(&Input::Fitted { number, space: Err("the points coincide".into()) });
    assert!(room.said("the points coincide") && room.recorded().is_none());
    assert!(room.supervisor.space_of(Side::Right).is_none() && room.supervisor.movement.is_none());
}

#[test]
fn places_to_draw_are_thinned_out_and_keep_whole_postures() {
    let mut room = Room::new();
    assert!(room.ask(Side::Right, 60.0));
    room.frames(900);
    let view = room.supervisor.snapshot(room.now);
    let drawn = &view.sides.right.path.seen;
    assert!(drawn.len() <= MOST_DRAWN && drawn.len().is_multiple_of(3), "{}", drawn.len());
    assert_eq!(view.trial.movement.unwrap().poses, 900);
}
