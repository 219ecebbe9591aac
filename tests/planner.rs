//! A planner outside the process, with the simulated robot and person in virtual time: what is asked, and what every kind of
//! answer comes to.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::panic,
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a test may fail loudly anywhere"
)]

use valet::body::{PerSide, Side};
use valet::command::Command;
use valet::headless::VirtualTrial;
use valet::kinematics::{JointVector, MotionLimits, RobotModel, Scene, Ways, plan_pair};
use valet::sim::world::WorldSetup;
use valet::snapshot::TrialPhase;
use valet::supervisor::{Effect, Input, PlanOrder, PlannerKind, Setup};

/// A trial that has asked its first question.
struct Asked {
    trial: VirtualTrial,
    model: RobotModel,
    order: PlanOrder,
}

fn pass(trial: &mut VirtualTrial, seconds: f64) -> Vec<Effect> {
    (0..(seconds * 100.0) as usize).flat_map(|_| trial.beat(&mut |_, _, _| ())).collect()
}

fn question(effects: &[Effect]) -> Option<PlanOrder> {
    effects.iter().find_map(|effect| if let Effect::Plan(order) = effect { Some(*order) } else { None })
}

fn asked() -> Asked {
    let mut setup = Setup { seed: 1, ..Setup::default() };
    setup.settings.planner = PlannerKind::MoveIt;
    let mut trial = VirtualTrial::new(setup, &WorldSetup { seed: 1, ..WorldSetup::default() }).unwrap();
    pass(&mut trial, 1.0);
    trial.ask(Command::Enable, &mut |_, _, _| ());
    pass(&mut trial, 0.5);
    trial.ask(Command::Start, &mut |_, _, _| ());
    for _ in 0..600 {
        if let Some(order) = question(&pass(&mut trial, 0.1)) {
            return Asked { trial, model: RobotModel::baxter().unwrap(), order };
        }
    }
    panic!("within a minute the first line was not asked for: {:?}", trial.snapshot().trial);
}

/// What a planner that knows what it does would answer.
fn good_ways(model: &RobotModel, order: &PlanOrder) -> Ways {
    let limits = MotionLimits::default();
    let motion = plan_pair(model, &Scene::default(), &order.start, &order.targets, &limits).unwrap();
    PerSide::from_fn(|side| {
        order.targets.get(side).as_ref()?;
        let sample = |index: u32| motion.sample(motion.duration() * index / 200).get(side).joints;
        Some((0..=200).map(sample).collect())
    })
}

fn answer(asked: &mut Asked, ways: Result<Ways, String>) {
    asked.trial.feed(&Input::Planned { number: asked.order.number, ways });
}

fn sent(effects: &[Effect], wanted: Side) -> Vec<JointVector> {
    let joints = effects.iter().filter_map(|effect| match effect {
        Effect::Setpoint { side, joints } if *side == wanted => Some(*joints),
        _ => None,
    });
    joints.collect()
}

fn moves(effects: &[Effect]) -> bool {
    Side::BOTH.into_iter().any(|side| {
        let joints = sent(effects, side);
        joints.first().is_some_and(|first| joints.iter().any(|next| (next - first).amax() > 1e-3))
    })
}

#[test]
fn the_arms_stand_still_until_the_planner_has_answered_and_then_follow_its_way() {
    let mut asked = asked();
    assert!(!moves(&pass(&mut asked.trial, 2.0)), "nothing moves while a question is open");
    let ways = good_ways(&asked.model, &asked.order);
    answer(&mut asked, Ok(ways));
    let effects = pass(&mut asked.trial, 2.0);
    assert!(moves(&effects));
    let next = (0..300).find_map(|_| question(&pass(&mut asked.trial, 0.1))).expect("the next line is asked for");
    assert_eq!(next.number, asked.order.number + 1);
}

#[test]
fn a_refusal_is_a_hold_with_its_words_and_going_on_asks_anew() {
    let mut asked = asked();
    answer(&mut asked, Err("MoveIt can follow only 43 % of the line".into()));
    assert!(!moves(&pass(&mut asked.trial, 1.0)));
    let snapshot = asked.trial.snapshot();
    assert_eq!(snapshot.trial.phase, TrialPhase::Holding);
    assert!(format!("{snapshot:?}").contains("only 43 %"));
    let effects = asked.trial.ask(Command::Continue, &mut |_, _, _| ());
    let again = question(&effects).or_else(|| question(&pass(&mut asked.trial, 1.0))).expect("asked again");
    assert_eq!(again.number, asked.order.number + 1);
}

#[test]
fn a_way_that_does_not_begin_at_the_arm_is_a_hold() {
    let mut asked = asked();
    let mut ways = good_ways(&asked.model, &asked.order);
    for way in [&mut ways.left, &mut ways.right].into_iter().flatten() {
        way.drain(..100);
    }
    answer(&mut asked, Ok(ways));
    assert!(!moves(&pass(&mut asked.trial, 1.0)));
    assert_eq!(asked.trial.snapshot().trial.phase, TrialPhase::Holding);
}

#[test]
fn s_25_a_silent_planner_is_a_hold_and_its_late_answer_moves_nothing() {
    let mut asked = asked();
    assert!(!moves(&pass(&mut asked.trial, 7.0)));
    assert_eq!(asked.trial.snapshot().trial.phase, TrialPhase::Holding);
    let ways = good_ways(&asked.model, &asked.order);
    answer(&mut asked, Ok(ways));
    assert!(!moves(&pass(&mut asked.trial, 1.0)));
}

#[test]
fn an_answer_after_a_stop_or_to_an_older_question_moves_nothing() {
    let mut stopped = asked();
    stopped.trial.ask(Command::Stop, &mut |_, _, _| ());
    let ways = good_ways(&stopped.model, &stopped.order);
    answer(&mut stopped, Ok(ways.clone()));
    assert!(sent(&pass(&mut stopped.trial, 1.0), Side::Right).is_empty());
    let mut other = asked();
    other.trial.feed(&Input::Planned { number: other.order.number + 7, ways: Ok(ways) });
    assert!(!moves(&pass(&mut other.trial, 1.0)));
}
