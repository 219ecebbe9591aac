//! Finds the responses of the shipped cohort again: `cargo run --release --example calibrate_cohort -- [PARTICIPANT] [ROUNDS]`.
//!
//! Random search round the present profile, at times with figures of another person of the cohort, judged on trials of the node in virtual time with seeds of their own; prints the best
//! as TOML. Needed whenever the simulated garment, the detector, the guard or the strategy changes. Takes about 0.3 s of
//! processor time a trial, so an hour a person; with 0 ROUNDS it says how well the profile on disk does. Never writes a file.

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rayon::prelude::*;
use std::io::Write;
use valet::body::Side;
use valet::experiments::table_4_2::{Participant, cohort, dress};
use valet::sim::person::SimulatedPerson;

/// Seeds of the search begin here, so that those of a later check are fresh.
const FIRST_SEED: u64 = 1_000_000;

/// Trials of a close look. The mean of 60 varies by 0.1 iterations, and the best of many such means is better than its person.
const CLOSE_SEEDS: u32 = 120;

/// Trials of each cheaper look before, and by how much the cost may be above the best one after so few.
const LOOKS: [(u32, f64); 4] = [(5, 6.0), (15, 1.5), (40, 0.3), (80, 0.0)];

/// What a trial that did not end with a free pass weighs.
const UNFINISHED: f64 = 40.0;

struct Means {
    iterations: f64,
    energy: f64,
    seconds: f64,
    resistances: f64,
    /// Share of the trials that did not end with a free pass.
    unfinished: f64,
    /// How far all of this is from the thesis' row, each figure by the tolerance that is wanted of it.
    cost: f64,
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut arguments = std::env::args().skip(1);
    let only: u32 = arguments.next().map_or(Ok(0), |text| text.parse())?;
    let rounds: u64 = arguments.next().map_or(Ok(200), |text| text.parse())?;
    let people = cohort()?;
    people
        .into_par_iter()
        .filter(|participant| only == 0 || participant.number == only)
        .map(|participant| search(participant, rounds))
        .try_for_each(|found| {
            found.and_then(|text| writeln!(std::io::stdout().lock(), "{text}").map_err(|error| error.to_string()))
        })?;
    Ok(())
}

/// The part of a profile that is searched.
#[derive(serde::Deserialize)]
struct ProfileFile {
    simulated: SimulatedPerson,
}

/// The person of the profile as it is on disk now, so that a search can go on without a new build.
fn on_disk(number: u32) -> Result<SimulatedPerson, String> {
    let path = format!("profiles/participant-{number:02}.toml");
    let text = std::fs::read_to_string(&path).map_err(|error| format!("{path}: {error}"))?;
    toml::from_str::<ProfileFile>(&text).map(|file| file.simulated).map_err(|error| format!("{path}: {error}"))
}

fn search(mut participant: Participant, rounds: u64) -> Result<String, String> {
    participant.person = on_disk(participant.number)?;
    let others = cohort().map_err(|error| error.to_string())?;
    let mut random = ChaCha8Rng::seed_from_u64(u64::from(participant.number));
    let mut best = (judge(&participant, CLOSE_SEEDS)?, participant.person.clone());
    for round in 0..rounds {
        let spread = if round % 3 == 1 { 0.35 } else { 0.1 };
        let mut start = best.1.clone();
        if round % 2 == 0 {
            // Other people of the cohort have other ratios of passes to force: what makes them may be taken over.
            let other = others.get(random.random_range(0..others.len())).ok_or("the cohort is empty")?;
            cross(&mut start, &other.person, &mut random);
        }
        participant.person = varied(&start, &mut random, spread);
        if participant.person.check().is_err() || !promising(&participant, best.0.cost)? {
            continue;
        }
        let closely = judge(&participant, CLOSE_SEEDS)?;
        if closely.cost < best.0.cost {
            best = (closely, participant.person.clone());
            // A search takes long and may be ended at any time.
            writeln!(std::io::stdout().lock(), "{}", told(&participant, &best.0)?)
                .map_err(|error| error.to_string())?;
        }
    }
    participant.person = best.1;
    told(&participant, &best.0)
}

/// Cheap looks first; only who does well enough for so few trials is looked at closely.
fn promising(participant: &Participant, best: f64) -> Result<bool, String> {
    for (seeds, allowance) in LOOKS {
        if judge(participant, seeds)?.cost > best + allowance {
            return Ok(false);
        }
    }
    Ok(true)
}

/// Goes a part of the way to another person, or takes over some of that one's figures.
fn cross(person: &mut SimulatedPerson, other: &SimulatedPerson, random: &mut ChaCha8Rng) {
    let way = random.random_bool(0.7).then(|| random.random_range(0.1..0.9));
    let mut take = |value: &mut f64, their: f64| match way {
        Some(way) => *value += (their - *value) * way,
        None if random.random_bool(0.4) => *value = their,
        None => {}
    };
    let (own, theirs) = (&mut person.right.response, &other.right.response);
    take(&mut own.free_play_metres, theirs.free_play_metres);
    take(&mut own.lateral_stiffness_newtons_per_metre, theirs.lateral_stiffness_newtons_per_metre);
    take(&mut own.jam_stiffness_newtons_per_metre, theirs.jam_stiffness_newtons_per_metre);
    take(&mut own.reflex_rate_newtons_per_second, theirs.reflex_rate_newtons_per_second);
    take(&mut own.reaction_seconds, theirs.reaction_seconds);
    take(&mut own.yield_share, theirs.yield_share);
    take(&mut own.learn_share, theirs.learn_share);
    take(&mut own.unfamiliar_factor, theirs.unfamiliar_factor);
    take(&mut own.path_jitter_metres, theirs.path_jitter_metres);
    for (value, their) in person.right.preferred_offset_metres.iter_mut().zip(other.right.preferred_offset_metres) {
        take(value, their);
    }
}

/// A person as TOML, under what came of the trials.
fn told(participant: &Participant, means: &Means) -> Result<String, String> {
    let text = toml::to_string(&participant.person.right).map_err(|error| error.to_string())?;
    Ok(format!(
        "## {} cost {:.3}: iterations {:.2} ({:.1}), energy {:.1} ({:.1}), seconds {:.0} ({:.0}), resistances {:.1}\n{text}",
        participant.number,
        means.cost,
        means.iterations,
        participant.thesis.iterations,
        means.energy,
        participant.thesis.energy_newtons,
        means.seconds,
        participant.thesis.seconds,
        means.resistances,
    ))
}

fn varied(person: &SimulatedPerson, random: &mut ChaCha8Rng, spread: f64) -> SimulatedPerson {
    let mut person = person.clone();
    let mut vary = |value: &mut f64, low: f64, high: f64| {
        if random.random_bool(0.5) {
            *value = (*value * (spread * random.random_range(-1.0..1.0_f64)).exp()).clamp(low, high);
        }
    };
    let response = &mut person.right.response;
    vary(&mut response.free_play_metres, 0.01, 0.08);
    vary(&mut response.lateral_stiffness_newtons_per_metre, 150.0, 900.0);
    vary(&mut response.jam_stiffness_newtons_per_metre, 3.0, 500.0);
    vary(&mut response.reflex_rate_newtons_per_second, 40.0, 250.0);
    vary(&mut response.reaction_seconds, 0.09, 0.28);
    vary(&mut response.yield_share, 0.005, 0.6);
    vary(&mut response.learn_share, 0.05, 0.9);
    vary(&mut response.unfamiliar_factor, 1.0, 2.5);
    vary(&mut response.path_jitter_metres, 0.0005, 0.012);
    let mut scale = 1.0;
    vary(&mut scale, 0.5, 2.0);
    for value in &mut person.right.preferred_offset_metres {
        let mut factor = 1.0;
        vary(&mut factor, 0.7, 1.4);
        *value = (*value * scale * factor).clamp(-0.12, 0.12);
    }
    person
}

fn means(participant: &Participant, seeds: u32) -> Result<Means, String> {
    let mut sums = Means { iterations: 0.0, energy: 0.0, seconds: 0.0, resistances: 0.0, unfinished: 0.0, cost: 0.0 };
    for index in 0..seeds {
        let setup = participant.setup(index % 5, FIRST_SEED + u64::from(index));
        let record = dress(&setup, Side::Right).map_err(|error| error.to_string())?;
        sums.iterations += record.iterations() as f64;
        sums.energy += record.energy_newtons();
        sums.seconds += record.duration_seconds();
        sums.resistances += f64::from(record.resistances());
        sums.unfinished += f64::from(u8::from(!record.is_free()));
    }
    let count = f64::from(seeds);
    Ok(Means {
        iterations: sums.iterations / count,
        energy: sums.energy / count,
        seconds: sums.seconds / count,
        resistances: sums.resistances / count,
        unfinished: sums.unfinished / count,
        cost: 0.0,
    })
}

/// The means over so many seeds, with their cost.
fn judge(participant: &Participant, seeds: u32) -> Result<Means, String> {
    let (mut means, thesis) = (means(participant, seeds)?, participant.thesis);
    let iterations = (means.iterations - thesis.iterations) / 0.3;
    let energy = (means.energy / thesis.energy_newtons - 1.0) / 0.15;
    let seconds = (means.seconds / thesis.seconds - 1.0) / 0.20;
    means.cost = iterations.powi(2) + energy.powi(2) + seconds.powi(2) + UNFINISHED * means.unfinished;
    Ok(means)
}
