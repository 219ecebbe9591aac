//! Whole trials in virtual time: every strategy dresses both arms of the demo's person, and what each brings is what it is for.

#![allow(clippy::unwrap_used, reason = "a test may fail loudly anywhere")]

use std::time::Duration;
use valet::body::Side;
use valet::config::{LoadedProfile, Places, Settings};
use valet::headless::{ScriptedOperator, VirtualTrial};
use valet::sim::world::WorldSetup;
use valet::snapshot::{Outcome, Watermark};
use valet::strategy::{IterationSummary, StrategyKind};
use valet::supervisor::Effect;

/// What a trial came to: its end, and the iterations of each arm.
struct Trial {
    outcome: Outcome,
    reason: String,
    iterations: Vec<(Side, IterationSummary)>,
}

impl Trial {
    fn energies(&self, side: Side) -> Vec<f64> {
        self.iterations.iter().filter(|(arm, _)| *arm == side).map(|(_, summary)| summary.energy).collect()
    }
}

fn dress(kind: StrategyKind, seed: u64) -> Trial {
    let person = LoadedProfile::find("default", &Places::of_this_machine()).unwrap();
    let mut setup = Settings::default().setup_for(&person, seed, Watermark::Demo).unwrap();
    setup.settings.strategy = kind;
    let world = WorldSetup { seed, person: person.profile.simulated.clone().unwrap(), ..WorldSetup::default() };
    let mut iterations = Vec::new();
    let mut trial = VirtualTrial::new(setup, &world).unwrap();
    let result = trial.run(&mut ScriptedOperator::new(6), Duration::from_secs(1_200), |_, _, effects| {
        iterations.extend(effects.iter().filter_map(|effect| match effect {
            Effect::Iteration { side, summary, .. } => Some((*side, summary.clone())),
            _ => None,
        }));
    });
    Trial { outcome: result.outcome, reason: result.reason, iterations }
}

fn assert_dressed(trial: &Trial) {
    assert_eq!(trial.outcome, Outcome::Completed, "{}", trial.reason);
    for side in Side::BOTH {
        let energies = trial.energies(side);
        assert!(energies.len() > 1, "{side}: {energies:?}");
        assert!(energies.first().is_some_and(|first| *first > 4.0), "{side}: {energies:?}");
        assert_eq!(energies.last(), Some(&0.0), "{side}: {energies:?}");
    }
}

#[test]
fn force_dresses_both_arms_of_ten_simulated_days() {
    for seed in 1..=10 {
        assert_dressed(&dress(StrategyKind::Force, seed));
    }
}

#[test]
fn every_strategy_that_learns_ends_at_no_resistance() {
    for kind in [StrategyKind::Multimodal, StrategyKind::Kernel, StrategyKind::OffsetField] {
        assert_dressed(&dress(kind, 1));
    }
}

#[test]
fn the_blend_finds_the_comfortable_path_first_and_then_shows_what_reach_costs() {
    let trial = dress(StrategyKind::Blend, 1);
    assert_eq!(trial.outcome, Outcome::Completed, "{}", trial.reason);
    for side in Side::BOTH {
        let energies = trial.energies(side);
        assert_eq!(energies.iter().rev().nth(1), Some(&0.0), "{side}: {energies:?}");
    }
}

#[test]
fn the_fixed_path_of_the_movement_space_is_passed_once_and_resistance_is_only_counted() {
    let trial = dress(StrategyKind::Gmm, 1);
    assert_eq!(trial.outcome, Outcome::Completed, "{}", trial.reason);
    for side in Side::BOTH {
        let energies = trial.energies(side);
        assert!(energies.len() == 1 && energies[0] > 10.0, "{side}: {energies:?}");
    }
}

#[test]
fn what_is_learned_on_the_first_pass_makes_later_passes_gentler() {
    let trial = dress(StrategyKind::Force, 2);
    for side in Side::BOTH {
        let energies = trial.energies(side);
        assert!(energies.last() < energies.first(), "{side}: {energies:?}");
    }
}
