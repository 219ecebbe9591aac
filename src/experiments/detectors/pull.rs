//! One pull of a sleeve: what the gripper does, what the sleeve does, and what the sensor makes of it.

use crate::geometry::Vector;
use crate::time::Stamp;
use rand::{Rng, RngExt};
use std::f64::consts::PI;
use std::time::Duration;

/// The sensor's period.
const PERIOD_SECONDS: f64 = 0.01;
/// Time for which the arm stands still before the pull, in which its zero is taken.
const STILL_SECONDS: f64 = 1.0;
/// How long the arm takes to its speed.
const START_SECONDS: f64 = 0.3;
/// Beyond this force a find comes too late, and a careful operator has let go.
const TOO_LATE_NEWTONS: f64 = 10.0;
/// How well it is known where along the arm the gripper is: standard deviation in metres of the pose finder's hand, by which
/// the guard's expectation is misplaced for a whole pull.
const PLACE_DEVIATION: f64 = 0.02;
/// How much one person's arm differs from another's: standard deviation of a factor on the measured profile, from the
/// measured band of half a newton at seven.
const PERSON_DEVIATION: f64 = 0.07;

/// Travel in metres and force in newtons of a gown that is pulled well along the forearm (Kapusta, horizontal pull).
const GOOD: [(f64, f64); 8] =
    [(0.20, 0.25), (0.25, 0.3), (0.30, 0.4), (0.35, 1.1), (0.40, 2.1), (0.50, 4.5), (0.60, 7.3), (0.67, 9.7)];
/// The same where the gown is caught on the fist.
const CAUGHT: [(f64, f64); 6] = [(0.20, 0.3), (0.25, 1.4), (0.30, 5.0), (0.35, 7.7), (0.40, 9.0), (0.44, 10.1)];

/// What is pulled.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Sleeve {
    /// Slides well.
    Good,
    /// Is caught on the fist, as measured.
    Caught,
    /// Catches softly: a spring of 60 N/m.
    Soft,
    /// Catches hard: a spring of 400 N/m.
    Hard,
}

impl Sleeve {
    pub(super) const ALL: [Self; 4] = [Self::Good, Self::Caught, Self::Soft, Self::Hard];

    pub(super) const fn name(self) -> &'static str {
        match self {
            Self::Good => "good",
            Self::Caught => "caught",
            Self::Soft => "soft_catch_60_newtons_per_metre",
            Self::Hard => "hard_catch_400_newtons_per_metre",
        }
    }

    pub(super) const fn catches(self) -> bool {
        !matches!(self, Self::Good)
    }

    /// Where the sleeve meets the hand, or catches, in metres of travel.
    const CATCH: f64 = 0.20;

    /// The pull in newtons after some metres of travel.
    fn pull(self, metres: f64) -> f64 {
        let beyond = (metres - Self::CATCH).max(0.0);
        match self {
            Self::Good => along(&GOOD, metres),
            Self::Caught => along(&CAUGHT, metres),
            Self::Soft => 60.0 * beyond,
            Self::Hard => 400.0 * beyond,
        }
    }

    const fn end(self) -> f64 {
        match self {
            Self::Good => 0.67,
            _ => 0.44,
        }
    }
}

/// The value of a profile between its points; its first before them, its last after.
fn along(profile: &[(f64, f64)], metres: f64) -> f64 {
    let mut before: Option<(f64, f64)> = None;
    for &(place, force) in profile {
        if metres <= place {
            return before.map_or(force, |(start, least)| least + (force - least) * (metres - start) / (place - start));
        }
        before = Some((place, force));
    }
    before.map_or(0.0, |(_, force)| force)
}

/// One kind of pull.
#[derive(Clone, Copy, Debug)]
pub(super) struct Pull {
    pub(super) sleeve: Sleeve,
    /// m/s.
    pub(super) speed: f64,
    /// Standard deviation along each axis, in newtons.
    pub(super) noise: f64,
    /// How far the bias drifts, in newtons.
    pub(super) drift: f64,
    /// The way over which it does, in metres.
    pub(super) drift_metres: f64,
}

/// One sample of a pull.
#[derive(Clone, Copy, Debug)]
pub(super) struct Step {
    pub(super) stamp: Stamp,
    /// Measured force from outside on the gripper, in newtons.
    pub(super) force: Vector,
    /// Commanded velocity in m/s.
    pub(super) velocity: Vector,
    /// Commanded acceleration in m/s².
    pub(super) acceleration: Vector,
    /// How far along the arm the gripper is taken to be, in metres from the hand.
    pub(super) passed: f64,
    /// The true pull in newtons.
    pub(super) pull_newtons: f64,
    /// Time since the sleeve caught; `None` before, and where it does not catch.
    pub(super) since_catch: Option<f64>,
    /// True in the last moment before the pull, when the zero is taken.
    pub(super) take_zero: bool,
}

impl Pull {
    /// The samples of one pull, up to 10 N or to the end of the way.
    pub(super) fn steps(&self, generator: &mut impl Rng) -> Vec<Step> {
        let person = 1.0 + PERSON_DEVIATION * normal(generator);
        // A caught gown hangs down: its vertical pull is half the horizontal one.
        let dip = if self.sleeve == Sleeve::Caught { -0.5 } else { 0.0 };
        let way = Vector::new(-1.0, 0.0, dip).normalize();
        let start_bias = direction(generator) * 5.0;
        let drift = direction(generator) * self.drift;
        let duration = self.drift_metres / self.speed + START_SECONDS / 2.0;
        let misplaced = PLACE_DEVIATION * normal(generator);
        let mut steps = Vec::new();
        let (mut metres, mut seconds, mut caught_at) = (0.0, -STILL_SECONDS, None);
        while metres < self.sleeve.end() {
            let (speed, acceleration) = self.motion(seconds);
            metres += speed * PERIOD_SECONDS;
            let pull = self.sleeve.pull(metres) * person;
            if pull > TOO_LATE_NEWTONS {
                break;
            }
            if self.sleeve.catches() && metres > Sleeve::CATCH {
                caught_at.get_or_insert(seconds);
            }
            let drifted = (seconds / duration).clamp(0.0, 1.0);
            let bias = start_bias + drift * ((1.0 - (PI * drifted).cos()) / 2.0);
            let noise = Vector::new(normal(generator), normal(generator), normal(generator)) * self.noise;
            steps.push(Step {
                stamp: Stamp::ZERO + Duration::from_secs_f64(seconds + STILL_SECONDS),
                force: way * pull + bias + noise,
                velocity: Vector::new(speed, 0.0, 0.0),
                acceleration: Vector::new(acceleration, 0.0, 0.0),
                passed: (metres - Sleeve::CATCH + misplaced).max(0.0),
                pull_newtons: pull,
                since_catch: caught_at.map(|caught| seconds - caught),
                take_zero: seconds < 0.0 && seconds + PERIOD_SECONDS >= 0.0,
            });
            seconds += PERIOD_SECONDS;
        }
        steps
    }

    /// Speed and acceleration at a time: still, then an even start, then the set speed.
    fn motion(&self, seconds: f64) -> (f64, f64) {
        match seconds / START_SECONDS {
            share if share < 0.0 => (0.0, 0.0),
            share if share < 1.0 => (self.speed * share, self.speed / START_SECONDS),
            _ => (self.speed, 0.0),
        }
    }
}

/// A standard normal number (Box and Muller).
fn normal(generator: &mut impl Rng) -> f64 {
    let (radius, angle): (f64, f64) = (generator.random(), generator.random());
    (-2.0 * (1.0 - radius).ln()).sqrt() * (2.0 * PI * angle).cos()
}

/// A direction, evenly spread.
fn direction(generator: &mut impl Rng) -> Vector {
    Vector::new(normal(generator), normal(generator), normal(generator)).try_normalize(1e-9).unwrap_or_else(Vector::z)
}
