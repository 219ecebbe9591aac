//! The cohort on the rig and through the supervisor: table 4.2 is run on a rig, and the real trial has to say the same.

#![allow(clippy::unwrap_used, reason = "a test may fail loudly anywhere")]

use std::time::Duration;
use valet::body::Side;
use valet::config::{LoadedProfile, Places, Settings};
use valet::experiments::table_4_2::{cohort, dress};
use valet::headless::{ScriptedOperator, VirtualTrial};
use valet::sim::world::WorldSetup;
use valet::snapshot::Watermark;
use valet::supervisor::Effect;

/// Iterations and energy (newtons) of one person's right arm, dressed by the whole node in virtual time.
fn through_the_supervisor(name: &str, seed: u64) -> (f64, f64) {
    let person = LoadedProfile::find(name, &Places::of_this_machine()).unwrap();
    let setup = Settings::default().setup_for(&person, seed, Watermark::Demo).unwrap();
    let simulated = person.profile.simulated.clone().unwrap();
    let world = WorldSetup { seed, person: simulated, ..WorldSetup::default() };
    let mut trial = VirtualTrial::new(setup, &world).unwrap();
    let (mut iterations, mut energy) = (0.0, 0.0);
    trial.run(&mut ScriptedOperator::new(10), Duration::from_secs(900), |_, _, effects| {
        for effect in effects {
            if let Effect::Iteration { side: Side::Right, summary, .. } = effect {
                iterations += 1.0;
                energy += summary.energy;
            }
        }
    });
    (iterations, energy)
}

#[test]
fn the_rig_and_the_whole_node_agree_on_how_people_of_the_cohort_are_dressed() {
    for participant in cohort().unwrap().iter().filter(|participant| matches!(participant.number, 1 | 10)) {
        let name = format!("participant-{:02}", participant.number);
        let (mut node, mut rig) = ((0.0, 0.0), (0.0, 0.0));
        for seed in 1..=4 {
            let (iterations, energy) = through_the_supervisor(&name, seed);
            node = (node.0 + iterations / 4.0, node.1 + energy / 4.0);
            let record = dress(&participant.setup(1, seed), Side::Right).unwrap();
            rig = (rig.0 + record.iterations() as f64 / 4.0, rig.1 + record.energy_newtons() / 4.0);
        }
        assert!((node.0 - rig.0).abs() <= 1.0, "{name}: {} iterations through the node, {} on the rig", node.0, rig.0);
        assert!((node.1 / rig.1 - 1.0).abs() < 0.5, "{name}: {} N through the node, {} N on the rig", node.1, rig.1);
    }
}
