//! Every fault that can be switched on, in a whole trial in virtual time: what the node makes of each, and that a trial goes on
//! where a fault passes.

#![allow(clippy::unwrap_used, reason = "a test may fail loudly anywhere")]

use std::time::Duration;
use valet::headless::{ScriptedOperator, TrialResult, VirtualTrial};
use valet::sim::faults::{Fault, FaultKind, FaultPlan};
use valet::sim::world::WorldSetup;
use valet::snapshot::Outcome;
use valet::supervisor::{Effect, Setup};

/// A trial with one fault, typed as on the command line: how it ends, and the warnings and errors meanwhile.
fn trial_with(fault: &str) -> (TrialResult, String) {
    let faults = FaultPlan { faults: vec![fault.parse::<Fault>().unwrap()] };
    let world = WorldSetup { seed: 1, faults, ..WorldSetup::default() };
    let mut trial = VirtualTrial::new(Setup { seed: 1, ..Setup::default() }, &world).unwrap();
    let mut told = Vec::new();
    let result = trial.run(&mut ScriptedOperator::new(20), Duration::from_secs(900), |_, _, effects| {
        told.extend(effects.iter().filter_map(|effect| match effect {
            Effect::Log { level, text } if level.name() != "information" => Some(text.clone()),
            _ => None,
        }));
    });
    (result, told.join("\n"))
}

/// Faults as they are typed, what the operator must read of them, and how the trial must end where that is certain.
const FAULTS: [(&str, &str, Option<Outcome>); 14] = [
    ("stale_force@22+1:right", "the right force", Some(Outcome::Completed)),
    ("frozen_force@22+1:right", "frozen", Some(Outcome::Completed)),
    ("biased_force=0,20,0@22+4:right", "right arm: force", None),
    ("not_a_number_force@22+1:right", "not finite", Some(Outcome::Completed)),
    ("lost_camera@22+2", "the person's pose", Some(Outcome::Completed)),
    ("lost_pose@22+2", "the person's pose", Some(Outcome::Completed)),
    ("stale_joints@22+1:right", "the right arm's joints", Some(Outcome::Completed)),
    ("joint_fault@22", "joint", Some(Outcome::Fault)),
    ("red_button@22", "button", Some(Outcome::OperatorStop)),
    ("late_commands=0.3@22+2:right", "", Some(Outcome::Completed)),
    ("dropped_commands=0.3@22+2:right", "", Some(Outcome::Completed)),
    ("snag@24+1:right", "", None),
    ("garment_slip@24:right", "", None),
    ("pull_away=0.12@22+1:right", "", None),
];

#[test]
fn every_fault_is_shown_by_a_trial_and_named_to_the_operator_where_it_keeps_the_robot_from_going_on() {
    let mut failures = Vec::new();
    let undisturbed = trial_with("snag@100000").0;
    assert_eq!(undisturbed.outcome, Outcome::Completed);
    for (typed, words, outcome) in FAULTS {
        let (result, told) = trial_with(typed);
        if !told.contains(words) || outcome.is_some_and(|outcome| outcome != result.outcome) {
            failures.push(format!("{typed}: {:?}, {}\n{told}", result.outcome, result.reason));
        }
    }
    assert!(failures.is_empty(), "{}", failures.join("\n\n"));
}

#[test]
fn the_list_holds_every_kind() {
    let mut kinds: Vec<&str> = FAULTS.iter().map(|(typed, ..)| typed.parse::<Fault>().unwrap().kind.name()).collect();
    let mut all = FaultKind::NAMES;
    kinds.sort_unstable();
    all.sort_unstable();
    assert_eq!(kinds, all);
}
