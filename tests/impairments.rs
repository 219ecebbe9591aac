//! Every impairment that a profile can give an arm, in whole trials of the node: what it does shows in what the node sees and
//! feels. The same people and seeds with and without it; nothing tells the node that it is there.

#![allow(clippy::unwrap_used, reason = "a test may fail loudly anywhere")]

use std::time::Duration;
use valet::body::{Joint, Side};
use valet::geometry::{Point, Vector};
use valet::headless::{ScriptedOperator, VirtualTrial};
use valet::sim::person::{Impairment, SimulatedPerson};
use valet::sim::world::WorldSetup;
use valet::supervisor::{Effect, Input, Setup};

/// What came of the right arm of a trial, or of some in the mean.
#[derive(Clone, Copy, Debug, Default)]
struct Seen {
    iterations: f64,
    /// Sum of all resistances that the strategy found, in newtons.
    energy: f64,
    /// The largest force while the arm was dressed, in newtons.
    peak: f64,
    /// How much the force changes within 50 ms, root of the mean square, in newtons.
    unrest: f64,
    /// How far the elbow is from where it was seen before, root of the mean square, in metres.
    elbow_unrest: f64,
    /// How far the elbow is lower at the end than at the beginning, in metres.
    sunk: f64,
}

impl Seen {
    fn figures(&self) -> [f64; 6] {
        [self.iterations, self.energy, self.peak, self.unrest, self.elbow_unrest, self.sunk]
    }
}

fn root_mean_square(steps: impl Iterator<Item = Vector>) -> f64 {
    let (count, sum) = steps.fold((0.0, 0.0), |(count, sum), step| (count + 1.0, sum + step.norm_squared()));
    (sum / f64::max(count, 1.0)).sqrt()
}

fn trial(person: &SimulatedPerson, seed: u64) -> Seen {
    let world = WorldSetup { seed, person: person.clone(), ..WorldSetup::default() };
    let mut trial = VirtualTrial::new(Setup { seed, ..Setup::default() }, &world).unwrap();
    let (mut seen, mut is_dressed) = (Seen::default(), false);
    let (mut forces, mut elbows): (Vec<Vector>, Vec<Point>) = (Vec::new(), Vec::new());
    let _ = trial.run(&mut ScriptedOperator::new(10), Duration::from_secs(900), |_, input, effects| {
        match input {
            Input::Endpoint(sample) if sample.side == Side::Right && is_dressed => forces.push(sample.wrench.force),
            Input::Body(pose) => elbows.extend(pose.arms.right.position(Joint::Elbow)),
            _ => {}
        }
        for effect in effects {
            match effect {
                Effect::Iteration { side: Side::Right, summary, .. } => {
                    seen.iterations += 1.0;
                    seen.energy += summary.energy;
                }
                Effect::Log { text, .. } if text.starts_with("right arm: iteration") => {
                    is_dressed = text.ends_with("begins");
                }
                _ => {}
            }
        }
    });
    seen.peak = forces.iter().map(Vector::norm).fold(0.0, f64::max);
    seen.unrest = root_mean_square(forces.iter().zip(forces.iter().skip(5)).map(|(before, after)| after - before));
    seen.elbow_unrest =
        root_mean_square(elbows.iter().zip(elbows.iter().skip(1)).map(|(before, after)| after - before));
    seen.sunk = elbows.first().map_or(0.0, |first| first.z) - elbows.last().map_or(0.0, |last| last.z);
    seen
}

/// The mean of twenty trials of the demo's person whose liked path lies so many times as far off, with an impairment.
fn trials(off: f64, impairment: Option<Impairment>) -> Seen {
    let mut person = SimulatedPerson::default();
    person.right.preferred_offset_metres = person.right.preferred_offset_metres.map(|metres| metres * off);
    person.right.impairments = impairment.into_iter().collect();
    let mut sum = [0.0; 6];
    for seed in 1..21 {
        sum.iter_mut().zip(trial(&person, seed).figures()).for_each(|(sum, figure)| *sum += figure / 20.0);
    }
    let [iterations, energy, peak, unrest, elbow_unrest, sunk] = sum;
    Seen { iterations, energy, peak, unrest, elbow_unrest, sunk }
}

fn without() -> Seen {
    static SEEN: std::sync::OnceLock<Seen> = std::sync::OnceLock::new();
    *SEEN.get_or_init(|| trials(1.0, None))
}

#[test]
fn a_weak_arm_pulls_less() {
    let (weak, healthy) = (trials(1.0, Some(Impairment::Weakness { share: 0.3 })), without());
    assert!(weak.peak < 0.9 * healthy.peak, "{weak:?} {healthy:?}");
}

#[test]
fn a_tremor_shows_in_the_force_and_in_the_pose() {
    let tremor = Impairment::Tremor { amplitude_metres: 0.005, frequency_hz: 6.0 };
    let (trembling, healthy) = (trials(1.0, Some(tremor)), without());
    assert!(trembling.unrest > 1.1 * healthy.unrest, "{trembling:?} {healthy:?}");
    assert!(trembling.elbow_unrest > 1.1 * healthy.elbow_unrest, "{trembling:?} {healthy:?}");
}

#[test]
fn an_arm_that_is_passive_on_one_side_lacks_the_answer_to_a_pull() {
    let passive = Impairment::OneSided { tone_newton_seconds_per_metre: 40.0 };
    let (passive, healthy) = (trials(1.0, Some(passive)), without());
    assert!(passive.unrest < 0.95 * healthy.unrest, "{passive:?} {healthy:?}");
}

#[test]
fn an_arm_in_its_painful_arc_stiffens_suddenly() {
    let pain = Impairment::PainfulArc { from_degrees: 10.0, to_degrees: 120.0 };
    let (pained, healthy) = (trials(2.2, Some(pain)), trials(2.2, None));
    assert!(pained.unrest > 1.08 * healthy.unrest, "{pained:?} {healthy:?}");
}

#[test]
fn an_arm_that_tires_sinks_as_the_camera_sees() {
    let (tired, healthy) = (trials(1.0, Some(Impairment::Fatigue { degrees_per_minute: 6.0 })), without());
    assert!(tired.sunk > 0.03 && healthy.sunk.abs() < 0.01, "{tired:?} {healthy:?}");
}

#[test]
fn a_person_who_is_startled_pulls_and_makes_the_strategy_answer_more() {
    let (startled, healthy) = (trials(1.0, Some(Impairment::Startle { metres: 0.1 })), without());
    assert!(startled.peak > 1.2 * healthy.peak && startled.energy > 1.3 * healthy.energy, "{startled:?} {healthy:?}");
}

#[test]
fn who_likes_another_movement_each_time_takes_more_iterations() {
    let (other, healthy) = (trials(1.0, Some(Impairment::NonCompliance { share: 1.0 })), without());
    assert!(other.iterations > healthy.iterations + 0.6, "{other:?} {healthy:?}");
    assert!(other.energy > 3.0 * healthy.energy, "{other:?} {healthy:?}");
}

#[test]
fn a_limited_range_shows_in_the_movement_before_the_trial() {
    let spread = |impairment: Option<Impairment>| {
        let mut world = WorldSetup { exercise_seconds: 20.0, ..WorldSetup::default() };
        world.person.right.impairments = impairment.into_iter().collect();
        let mut trial = VirtualTrial::new(Setup::default(), &world).unwrap();
        let mut hands: Vec<Point> = Vec::new();
        for _ in 0..2000 {
            trial.beat(&mut |_, input, _| {
                if let Input::Body(pose) = input {
                    hands.extend(pose.arms.right.position(Joint::Hand));
                }
            });
        }
        let middle = hands.iter().fold(Vector::zeros(), |sum, hand| sum + hand.coords) / hands.len() as f64;
        root_mean_square(hands.iter().map(|hand| hand.coords - middle))
    };
    let (limited, healthy) = (spread(Some(Impairment::LimitedRange { share: 0.4 })), spread(None));
    assert!(limited < 0.6 * healthy, "{limited} m, {healthy} m");
}
