//! How a person reacts to a garment that pulls: stiffens after a reaction time, gives way once the robot has stopped,
//! and keeps a share of that for the next iteration.

use super::super::random::Random;
use super::impairment::Impaired;
use super::{PersonError, SimulatedArm};
use crate::geometry::{Point, Vector};
use serde::{Deserialize, Serialize};

/// Force of a stiffening arm at the most, in newtons: what a startled, seated person adds before the robot has halted.
const REFLEX_CEILING: f64 = 7.0;
/// Time in which a stiffened arm softens again once nothing pulls, in seconds.
const SOFTENING: f64 = 0.15;
/// A person notices within this time that the robot has stopped, in seconds.
const NOTICE: f64 = 0.1;
/// Below this speed the gripper stands still for the person, in metres per second.
const STILL: f64 = 0.02;
/// Speed of a voluntary or startled movement of the arm in metres per second.
const WITHDRAWAL_SPEED: f64 = 0.4;

/// How an arm and its sleeve answer to a gripper that leaves the preferred path.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Response {
    /// How far the gripper may leave the preferred path before anything is taut, in metres.
    pub free_play_metres: f64,
    /// Stiffness of arm and fabric across the path beyond that, in newtons per metre.
    pub lateral_stiffness_newtons_per_metre: f64,
    /// How fast the sleeve jams along the path beyond that, in newtons per metre of travel.
    pub jam_stiffness_newtons_per_metre: f64,
    /// How fast the arm stiffens, in newtons per second.
    pub reflex_rate_newtons_per_second: f64,
    /// From the pull to the stiffening, in seconds.
    pub reaction_seconds: f64,
    /// Share of the pull that the person gives way to once the robot has stopped.
    pub yield_share: f64,
    /// Share of that which is still there in the next iteration.
    pub learn_share: f64,
    /// Factor on the preferred offset in a person's first experiment with the robot.
    pub unfamiliar_factor: f64,
    /// Standard deviation of the preferred path from iteration to iteration, in metres.
    pub path_jitter_metres: f64,
    /// Friction of a sleeve that runs freely, in newtons.
    pub drag_newtons: f64,
}

impl Default for Response {
    fn default() -> Self {
        Self {
            free_play_metres: 0.035,
            lateral_stiffness_newtons_per_metre: 350.0,
            jam_stiffness_newtons_per_metre: 50.0,
            reflex_rate_newtons_per_second: 170.0,
            reaction_seconds: 0.16,
            yield_share: 0.25,
            learn_share: 0.4,
            unfamiliar_factor: 1.3,
            path_jitter_metres: 0.003,
            drag_newtons: 0.8,
        }
    }
}

impl Response {
    pub(super) fn check(&self, key: &str) -> Result<(), PersonError> {
        for (name, value, range) in [
            ("free_play_metres", self.free_play_metres, (0.0, 0.12)),
            ("lateral_stiffness_newtons_per_metre", self.lateral_stiffness_newtons_per_metre, (1.0, 2000.0)),
            ("jam_stiffness_newtons_per_metre", self.jam_stiffness_newtons_per_metre, (0.0, 1000.0)),
            ("reflex_rate_newtons_per_second", self.reflex_rate_newtons_per_second, (0.0, 1000.0)),
            ("reaction_seconds", self.reaction_seconds, (0.08, 1.0)),
            ("yield_share", self.yield_share, (0.0, 1.0)),
            ("learn_share", self.learn_share, (0.0, 1.0)),
            ("unfamiliar_factor", self.unfamiliar_factor, (1.0, 2.5)),
            ("path_jitter_metres", self.path_jitter_metres, (0.0, 0.03)),
            ("drag_newtons", self.drag_newtons, (0.0, 5.0)),
        ] {
            PersonError::range(format!("{key}.{name}"), value, range)?;
        }
        Ok(())
    }
}

/// What a sleeve does to an arm at one moment.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(in crate::sim) struct Pull {
    /// How far the gripper is beyond the free play, in metres, as a vector from the gripper towards the preferred path.
    pub(in crate::sim) excess: Vector,
    /// The gripper's speed in metres per second.
    pub(in crate::sim) speed: f64,
    /// True where the sleeve goes on, false where it is still or comes off.
    pub(in crate::sim) advancing: bool,
}

/// An arm that reacts.
#[derive(Clone, Debug)]
pub(in crate::sim) struct Reaction {
    response: Response,
    random: Random,
    undisturbed: Vec<Point>,
    path: Vec<Point>,
    jitter: Vec<Vector>,
    kept: Vector,
    given: Vector,
    withdrawn: Vector,
    withdrawal_goal: Vector,
    pulled_for: f64,
    still_for: f64,
    noticed: bool,
    reflex: f64,
    impaired: Impaired,
}

impl Reaction {
    /// An arm of a person with its impairments, and its preferred path (metres in `base`), at the start of an experiment.
    pub(in crate::sim) fn of(arm: &SimulatedArm, undisturbed: Vec<Point>, random: Random) -> Self {
        let impaired = Impaired::new(&arm.impairments);
        let response = impaired.response(arm.response, &arm.posture);
        Self { impaired, ..Self::new(response, undisturbed, random) }
    }

    /// An arm with its preferred path (metres in `base`), at the start of an experiment.
    pub(in crate::sim) fn new(response: Response, undisturbed: Vec<Point>, random: Random) -> Self {
        let mut reaction = Self {
            response,
            random,
            path: undisturbed.clone(),
            undisturbed,
            jitter: Vec::new(),
            kept: Vector::zeros(),
            given: Vector::zeros(),
            withdrawn: Vector::zeros(),
            withdrawal_goal: Vector::zeros(),
            pulled_for: 0.0,
            still_for: 0.0,
            noticed: false,
            reflex: 0.0,
            impaired: Impaired::default(),
        };
        reaction.draw_jitter();
        reaction
    }

    pub(in crate::sim) const fn response(&self) -> &Response {
        &self.response
    }

    /// Where the gripper pulls least now, from hand to shoulder in metres in `base`.
    pub(in crate::sim) fn path(&self) -> &[Point] {
        &self.path
    }

    /// How far the middle of the arm has moved from its posture, in metres.
    pub(in crate::sim) fn displacement(&self) -> Vector {
        self.kept + self.given + self.withdrawn + self.impaired.displacement()
    }

    /// The iteration is over: a share of what was given stays, and the next one is not quite the same.
    pub(in crate::sim) fn end_pass(&mut self) {
        self.kept += self.given * self.response.learn_share;
        self.given = Vector::zeros();
        (self.pulled_for, self.still_for, self.reflex, self.noticed) = (0.0, 0.0, 0.0, false);
        self.impaired.end_pass(&mut self.random);
        self.draw_jitter();
    }

    /// Moves the arm away to an offset from its posture (metres), at the speed of a startled arm; zero brings it back.
    pub(in crate::sim) const fn pull_away(&mut self, offset: Vector) {
        self.withdrawal_goal = offset;
    }

    /// The force of the stiffening arm on the gripper in newtons, after `seconds` under a pull.
    pub(in crate::sim) fn react(&mut self, pull: &Pull, seconds: f64) -> Vector {
        self.withdraw(seconds);
        if self.impaired.moves() {
            self.impaired.advance(seconds);
            self.bend_path();
        }
        let excess = pull.excess.norm();
        self.still_for = if pull.speed < STILL { self.still_for + seconds } else { 0.0 };
        if self.still_for == 0.0 {
            self.noticed = false;
        }
        if excess > 0.0 && pull.advancing {
            self.pulled_for += seconds;
            if self.pulled_for > self.response.reaction_seconds {
                let risen = self.reflex + self.response.reflex_rate_newtons_per_second * seconds;
                self.reflex = risen.min(REFLEX_CEILING);
                self.impaired.feel();
            }
        } else {
            self.pulled_for = 0.0;
            self.reflex *= (-seconds / SOFTENING).exp();
        }
        if self.still_for > NOTICE && !self.noticed && excess > 0.0 {
            self.noticed = true;
            let given = self.given - pull.excess * self.response.yield_share;
            self.given = given.cap_magnitude(self.impaired.gives_way_metres());
            self.bend_path();
        }
        let resistance = self.reflex + self.impaired.tone(pull.speed);
        if excess > 0.0 { pull.excess * (resistance / excess) } else { Vector::zeros() }
    }

    fn withdraw(&mut self, seconds: f64) {
        let rest = self.withdrawal_goal - self.withdrawn;
        if rest.norm_squared() > 0.0 {
            let step = (WITHDRAWAL_SPEED * seconds).min(rest.norm());
            self.withdrawn += rest.normalize() * step;
            self.bend_path();
        }
    }

    fn draw_jitter(&mut self) {
        let deviation = self.response.path_jitter_metres;
        self.jitter = (0..self.undisturbed.len()).map(|_| self.random.normal_vector(deviation)).collect();
        self.bend_path();
    }

    /// Hand and shoulder stay; the middle of the arm moves by the whole displacement.
    fn bend_path(&mut self) {
        let displacement = self.displacement();
        let last = self.undisturbed.len().saturating_sub(1).max(1) as f64;
        let bent = self.undisturbed.iter().zip(&self.jitter).enumerate().map(|(index, (point, jitter))| {
            let weight = (std::f64::consts::PI * index as f64 / last).sin();
            point + (displacement + jitter) * weight
        });
        self.path = bent.collect();
    }
}
