//! A trial with strategies that are told what to answer.

use super::*;
use crate::kinematics::waiting_place;
use crate::strategy::IterationSummary;
use crate::strategy::{Finish, LearnedPath, Reaction, StrategyKind};
use proptest::prelude::{prop_assert, prop_assert_eq, proptest};

/// A strategy with a fixed path that asks for `passes` passes and gives way by `step` on each contact.
#[derive(Debug)]
struct Scripted {
    path: Vec<Point>,
    next: usize,
    passes: u32,
    iteration: u32,
    contacts: u32,
    step: Vector,
}

impl Strategy for Scripted {
    fn kind(&self) -> StrategyKind {
        StrategyKind::Force
    }
    fn path(&self) -> &[Point] {
        &self.path
    }
    fn begin(&mut self) -> Result<(), StrategyError> {
        self.iteration += 1;
        self.next = 1;
        self.contacts = 0;
        Ok(())
    }
    fn goal(&self) -> Option<Point> {
        self.path.get(self.next).copied()
    }
    fn resisted(&mut self, contact: &Contact) -> Reaction {
        self.contacts += 1;
        Reaction { move_to: contact.position - self.step, changes: Vec::new(), ignored: None }
    }
    fn listens_at(&self, _position: &Point) -> bool {
        true
    }
    fn learned(&self) -> LearnedPath {
        LearnedPath {
            kind: self.kind(),
            path: self.path.clone(),
            iteration: self.iteration,
            elbow: None,
            optimiser: None,
            stiffness: None,
        }
    }
    fn arrived(&mut self) {
        self.next += 1;
    }
    fn finish(&mut self) -> IterationSummary {
        let finished = (self.iteration >= self.passes).then_some(Finish::Converged);
        IterationSummary {
            energy: f64::from(self.contacts),
            contacts: self.contacts,
            ..IterationSummary::idle(self.iteration, &self.path, finished)
        }
    }
    fn adopt(&mut self, _learned: &LearnedPath) -> Vec<String> {
        Vec::new()
    }
}

fn plan() -> PersonPlan {
    let right = [Point::new(0.74, -0.56, -0.09), Point::new(0.80, -0.43, -0.06), Point::new(0.81, -0.25, 0.20)];
    PersonPlan { arms: PerSide { left: right.map(|p| Point::new(p.x, -p.y, p.z)), right } }
}

fn trial(passes: u32) -> Trial {
    let strategies = plan().arms.map(|_, joints| {
        let step = Vector::new(0.0, 0.0, 0.03);
        Box::new(Scripted { path: joints.to_vec(), next: 0, passes, iteration: 0, contacts: 0, step })
            as Box<dyn Strategy>
    });
    Trial::new(TrialSettings::default(), plan(), strategies)
}

/// Where the dressing gripper is sent.
fn leading_target(trial: &Trial) -> Option<Point> {
    match trial.order() {
        Order::Move { targets, .. } => *targets.get(trial.arm()),
        Order::Wait => None,
    }
}

/// Follows one order to its end.
fn follow(trial: &mut Trial) -> Vec<TrialEvent> {
    let target = leading_target(trial).unwrap();
    trial.arrived(target).unwrap()
}

/// A trial whose first pass has begun.
fn in_first_pass(passes: u32) -> Trial {
    let mut trial = trial(passes);
    while !trial.listens() {
        follow(&mut trial);
    }
    trial
}

/// Follows orders until the trial waits.
fn follow_until_it_waits(trial: &mut Trial) -> Vec<TrialEvent> {
    let mut events = Vec::new();
    while leading_target(trial).is_some() {
        events.extend(follow(trial));
    }
    events
}

#[test]
fn both_arms_are_dressed_in_the_order_of_the_table() {
    let mut trial = trial(1);
    assert_eq!(trial.step(), Step::BehindShoulders);
    let events = follow_until_it_waits(&mut trial);
    assert!(events.contains(&TrialEvent::ArmDressed { side: Side::Right }));
    assert_eq!(trial.stage(), &Stage::AwaitGoAhead(Next::SecondArm));
    trial.go_ahead().unwrap();
    assert_eq!((trial.arm(), trial.step()), (Side::Left, Step::SecondArm));
    let events = follow_until_it_waits(&mut trial);
    assert_eq!(events.last(), Some(&TrialEvent::Completed));
    assert_eq!(trial.stage(), &Stage::Done);
    assert_eq!(trial.order(), Order::Wait);
}

#[test]
fn each_pass_but_the_last_ends_with_a_withdrawal_along_the_travelled_path_and_a_go_ahead() {
    let mut trial = in_first_pass(2);
    let forward: Vec<_> = (0..2)
        .map(|_| {
            let target = leading_target(&trial).unwrap();
            trial.arrived(target).unwrap();
            target
        })
        .collect();
    assert!(matches!(trial.stage(), Stage::Withdraw { .. }));
    let mut backward = Vec::new();
    while let Some(target) = leading_target(&trial) {
        backward.push(target);
        trial.arrived(target).unwrap();
    }
    assert_eq!(backward, [forward[0], plan().arms.right[0]]);
    assert_eq!(trial.stage(), &Stage::AwaitGoAhead(Next::Iteration));
    assert_eq!(trial.order(), Order::Wait, "nothing moves before the operator's go-ahead");
    let events = trial.go_ahead().unwrap();
    assert_eq!(events, [TrialEvent::IterationBegan { side: Side::Right, iteration: 2 }]);
}

#[test]
fn a_resistance_sends_the_gripper_where_the_strategy_says_and_the_pass_goes_on() {
    let mut trial = in_first_pass(1);
    let position = Point::new(0.76, -0.5, -0.08);
    trial.resisted(&Contact { position, resistance: Vector::new(0.0, 0.0, 6.0) });
    assert_eq!(leading_target(&trial), Some(position - Vector::new(0.0, 0.0, 0.03)));
    assert!(!trial.listens(), "while it gives way it does not listen");
    follow(&mut trial);
    assert_eq!(leading_target(&trial), Some(plan().arms.right[1]));
    assert!(trial.listens());
}

#[test]
fn resistance_outside_a_pass_means_nothing() {
    let mut trial = trial(1);
    let contact = Contact { position: Point::origin(), resistance: Vector::x() };
    assert!(trial.resisted(&contact).is_empty());
    assert_eq!(trial.stage(), &Stage::StandBack);
}

#[test]
fn withdrawing_from_the_middle_of_a_pass_goes_back_over_the_contacts() {
    let mut trial = in_first_pass(3);
    let position = Point::new(0.76, -0.5, -0.08);
    trial.resisted(&Contact { position, resistance: Vector::z() });
    follow(&mut trial);
    let adjusted = position - Vector::new(0.0, 0.0, 0.03);
    assert!(trial.withdraw(Point::new(0.77, -0.48, -0.10)));
    let mut backward = Vec::new();
    while let Some(target) = leading_target(&trial) {
        backward.push(target);
        trial.arrived(target).unwrap();
    }
    assert_eq!(backward, [adjusted, position, plan().arms.right[0]]);
}

#[test]
fn before_the_first_pass_there_is_nothing_to_withdraw_from() {
    let mut trial = trial(1);
    assert!(!trial.withdraw(Point::origin()));
    assert_eq!(trial.stage(), &Stage::StandBack);
}

#[test]
fn finishing_after_this_pass_ends_the_arm_although_the_strategy_wants_more() {
    let mut trial = in_first_pass(8);
    trial.finish_after_this();
    let events = follow_until_it_waits(&mut trial);
    assert!(events.contains(&TrialEvent::ArmDressed { side: Side::Right }));
    assert_eq!(trial.iteration(), 1);
}

#[test]
fn the_trailing_gripper_goes_from_shoulder_to_shoulder_as_the_leading_one_goes_along_the_arm() {
    let mut trial = trial(1);
    follow(&mut trial);
    follow(&mut trial);
    let Order::Move { targets, .. } = trial.order() else { panic!("it moves") };
    let behind = |side: Side| waiting_place(&plan().arms.get(side)[2]);
    assert!((targets.left.unwrap() - behind(Side::Right)).norm() < 1e-9, "step 2: behind the right shoulder");
    follow(&mut trial);
    follow(&mut trial);
    let Order::Move { targets, .. } = trial.order() else { panic!("it moves") };
    assert_eq!(trial.step(), Step::UpperArm);
    let (left, right) = (targets.left.unwrap(), targets.right.unwrap());
    assert!(
        ((left - right).norm() - 0.45).abs() < 1e-9,
        "step 5: as far towards the left shoulder as the garment reaches"
    );
    let way = behind(Side::Left) - behind(Side::Right);
    assert!((left - behind(Side::Right)).cross(&way).norm() < 1e-9, "on the way to the left shoulder");
}

#[test]
fn in_step_6_the_first_gripper_stays() {
    let mut trial = trial(1);
    follow_until_it_waits(&mut trial);
    trial.go_ahead().unwrap();
    let Order::Move { targets, .. } = trial.order() else { panic!("it moves") };
    assert_eq!(targets.right, None);
    assert_eq!(targets.left, Some(plan().arms.left[0]));
}

#[test]
fn goals_keep_the_thesis_interval_and_small_moves_do_not() {
    let mut trial = in_first_pass(1);
    assert!(matches!(trial.order(), Order::Move { least_seconds, .. } if (least_seconds - 3.0).abs() < 1e-12));
    trial.resisted(&Contact { position: Point::new(0.76, -0.5, -0.08), resistance: Vector::z() });
    assert!(matches!(trial.order(), Order::Move { least_seconds, .. } if least_seconds == 0.0));
}

proptest! {
    #[test]
    fn a_trial_ends_after_the_passes_that_the_strategies_ask_for(passes in 1_u32..8, contacts in 0_usize..5) {
        let mut trial = trial(passes);
        let mut ended = 0;
        for _ in 0..10_000 {
            if trial.stage() == &Stage::Done {
                break;
            }
            if trial.order() == Order::Wait {
                trial.go_ahead().unwrap();
                continue;
            }
            if trial.listens() && trial.travelled().len() <= contacts {
                let position = *trial.travelled().last().unwrap();
                trial.resisted(&Contact { position, resistance: Vector::z() });
            }
            let events = follow(&mut trial);
            ended += events.iter().filter(|event| matches!(event, TrialEvent::IterationEnded { .. })).count();
        }
        prop_assert_eq!(trial.stage(), &Stage::Done);
        prop_assert_eq!(ended, 2 * passes as usize);
    }

    #[test]
    fn progress_grows_along_the_path(shares in [0.0..1.0_f64, 0.0..1.0_f64]) {
        let trial = trial(1);
        let [hand, elbow, _] = plan().arms.right;
        let at = |share: f64| trial.progress_at(&(hand + (elbow - hand) * share));
        let (low, high) = (shares[0].min(shares[1]), shares[0].max(shares[1]));
        prop_assert!(at(low) <= at(high) + 1e-12);
        prop_assert!((0.0..=1.0).contains(&at(low)));
    }
}
