//! The cohort that valet ships: twelve simulated people with the rows of the thesis' table 4.2 that they mirror.

use crate::sim::WorldSetup;
use crate::sim::person::SimulatedPerson;
use serde::Deserialize;
use thiserror::Error;

/// Experiments of each person (thesis section 4.5.2).
pub const EXPERIMENTS: u32 = 5;

/// One row of the thesis' table 4.2: means over five experiments.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ThesisRow {
    /// Iterations until no resistance was left.
    pub iterations: f64,
    /// Execution time in seconds.
    pub seconds: f64,
    /// Sum of detected resistance in newtons (the thesis' energy).
    pub energy_newtons: f64,
}

const fn row(iterations: f64, seconds: f64, energy_newtons: f64) -> ThesisRow {
    ThesisRow { iterations, seconds, energy_newtons }
}

/// A person of the cohort.
#[derive(Clone, Debug, PartialEq)]
pub struct Participant {
    /// From 1 to 12, as in the thesis.
    pub number: u32,
    /// What the thesis reports of the person that this one mirrors.
    pub thesis: ThesisRow,
    /// The simulated person.
    pub person: SimulatedPerson,
}

impl Participant {
    /// The world of one experiment, from 0; experiments of a person differ by seed and by how well the person knows the robot.
    #[must_use]
    pub fn setup(&self, experiment: u32, seed: u64) -> WorldSetup {
        WorldSetup { person: self.person.clone(), experiment, seed, ..WorldSetup::default() }
    }
}

/// The cohort cannot be read.
#[derive(Clone, Debug, PartialEq, Error)]
#[error("the profile participant-{number:02} that valet carries is unusable: {reason}")]
pub struct CohortError {
    /// Whose profile.
    pub number: u32,
    /// Why.
    pub reason: String,
}

/// The part of a profile that matters here; the rest is the concern of the settings' room.
#[derive(Deserialize)]
struct ProfileFile {
    simulated: SimulatedPerson,
}

macro_rules! profile {
    ($number:literal) => {
        include_str!(concat!("../../../profiles/participant-", $number, ".toml"))
    };
}

const COHORT: [(ThesisRow, &str); 12] = [
    (row(2.6, 57.32, 25.15), profile!("01")),
    (row(2.4, 57.79, 25.94), profile!("02")),
    (row(2.4, 143.04, 56.24), profile!("03")),
    (row(2.4, 60.31, 20.79), profile!("04")),
    (row(2.4, 47.78, 18.43), profile!("05")),
    (row(2.6, 48.35, 21.31), profile!("06")),
    (row(3.2, 172.64, 65.37), profile!("07")),
    (row(3.6, 190.74, 73.25), profile!("08")),
    (row(2.6, 55.87, 24.46), profile!("09")),
    (row(3.0, 61.93, 27.66), profile!("10")),
    (row(2.2, 46.97, 19.56), profile!("11")),
    (row(3.8, 195.26, 70.43), profile!("12")),
];

/// The twelve people in the thesis' order.
///
/// # Errors
/// Where a shipped profile cannot be read or describes nobody.
pub fn cohort() -> Result<Vec<Participant>, CohortError> {
    (1..)
        .zip(COHORT)
        .map(|(number, (thesis, text))| {
            let refused = |reason: String| CohortError { number, reason };
            let file: ProfileFile = toml::from_str(text).map_err(|error| refused(error.to_string()))?;
            file.simulated.check().map_err(|error| refused(error.to_string()))?;
            Ok(Participant { number, thesis, person: file.simulated })
        })
        .collect()
}
