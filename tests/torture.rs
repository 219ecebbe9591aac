//! About a minute of one processor's time under torture: trials with faults in virtual time, from seeds that are always the same.
//!
//! `valet torture` runs others, and as many as one likes.

#![allow(clippy::panic, reason = "a test may fail loudly anywhere")]

use rayon::prelude::*;
use valet::experiments::torture::torture;

/// Seeds that no other run of ours begins with.
const FIRST_SEED: u64 = 800_000;
/// Some 0.2 s of processor time each in a build for tests.
const TRIALS: u64 = 280;

#[test]
fn two_hundred_and_eighty_trials_with_faults_break_no_invariant() {
    let results: Vec<_> = (FIRST_SEED..FIRST_SEED + TRIALS).into_par_iter().map(torture).collect();
    let broken: Vec<String> = results
        .iter()
        .filter_map(|result| Some((result.seed, result.violation.as_ref()?)))
        .map(|(seed, violation)| format!("{violation:?} (repeat: valet torture --seed {seed} --trials 1)"))
        .collect();
    assert!(broken.is_empty(), "{broken:#?}");
    // Trials in which nothing happens show nothing.
    let sum = |count: fn(&valet::experiments::torture::TortureResult) -> u64| results.iter().map(count).sum::<u64>();
    assert!(sum(|result| u64::from(result.stops)) > TRIALS / 2, "emergency stops");
    assert!(sum(|result| u64::from(result.iterations)) > TRIALS / 4, "passes of the garment");
    assert!(sum(|result| result.setpoints) > 1_000 * TRIALS, "setpoints");
}
