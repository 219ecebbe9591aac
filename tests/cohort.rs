//! The cohort through the whole node: what table 4.2 counts is what `valet demo --headless` shows of the same person and seed, and
//! every shipped person can be dressed on both arms.

#![allow(clippy::unwrap_used, reason = "a test may fail loudly anywhere")]

use std::time::Duration;
use valet::body::Side;
use valet::config::{LoadedProfile, Places, Settings};
use valet::experiments::table_4_2::{cohort, dress};
use valet::headless::{ScriptedOperator, TrialResult, VirtualTrial};
use valet::sim::world::WorldSetup;
use valet::snapshot::{Outcome, Watermark};
use valet::supervisor::Effect;

/// One trial of a shipped person as `valet demo --headless --profile NAME --seed SEED` runs it: how it ended, and the energies (newtons)
/// of the right arm's iterations.
fn demo(name: &str, seed: u64) -> (TrialResult, Vec<f64>) {
    let person = LoadedProfile::find(name, &Places::of_this_machine()).unwrap();
    let setup = Settings::default().setup_for(&person, seed, Watermark::Demo).unwrap();
    let profile = &person.profile;
    let world = WorldSetup {
        seed,
        person: profile.simulated.clone().unwrap(),
        garment: profile.garment(None).cloned().unwrap(),
        ..WorldSetup::default()
    };
    let mut trial = VirtualTrial::new(setup, &world).unwrap();
    let mut energies = Vec::new();
    let result = trial.run(&mut ScriptedOperator::new(10), Duration::from_secs(3600), |_, _, effects| {
        energies.extend(effects.iter().filter_map(|effect| match effect {
            Effect::Iteration { side: Side::Right, summary, .. } => Some(summary.energy),
            _ => None,
        }));
    });
    (result, energies)
}

#[test]
fn every_shipped_person_is_dressed_on_both_arms_and_the_table_counts_the_same_trial_to_the_last_bit() {
    for participant in cohort().unwrap() {
        let name = format!("participant-{:02}", participant.number);
        let (result, energies) = demo(&name, 1);
        assert_eq!(result.outcome, Outcome::Completed, "{name}: {}", result.reason);
        let record = dress(&participant.setup(1, 1), Side::Right).unwrap();
        let counted: Vec<f64> = record.passes.iter().map(|pass| pass.summary.energy).collect();
        assert!(record.is_free(), "{name}: {:?}", record.outcome);
        assert_eq!(counted, energies, "{name}");
    }
}
