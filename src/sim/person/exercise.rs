//! A person who moves the arms as far as they like while nobody dresses them: what a movement space is fitted to.
//!
//! Thesis section 3.3 records a person's movement before the first trial. Here the arm moves about the posture in which the
//! person waits for the sleeve, as the movement class of the profile says (`movement`).

use super::super::random::{Purpose, Random};
use super::impairment::range_share;
use super::{ArmAngles, ArmPoints, SimulatedPerson};
use crate::body::{PerSide, Side};
use crate::geometry::Vector;

/// Poses a second, as a depth camera brings them.
const RATE_HZ: f64 = 30.0;
/// How many poses: the person moves for half a minute (ours: each movement comes at least three times).
const BEATS: u32 = 900;
/// How far the trunk sways, as a standard deviation in metres (ours).
const SWAY_METRES: f64 = 0.006;
/// Error of a joint that a camera sees, as a standard deviation in metres along each axis (ours, from the joints found in
/// simulated depth images).
const SEEN_METRES: f64 = 0.008;

/// Places of hand, elbow and shoulder in metres in `base`, as a camera saw them.
pub type Seen = [Vec<Vector>; 3];

/// How long the arms take to come to rest at the end, in seconds (ours).
const COMING_TO_REST_SECONDS: f64 = 1.0;

/// How one person moves both arms about: the phases of the movements come from a seed.
#[derive(Clone, Copy, Debug)]
pub(in crate::sim) struct Exercise {
    phases: PerSide<[f64; 4]>,
    seconds: f64,
}

impl Exercise {
    /// An exercise that ends after `seconds`.
    pub(in crate::sim) fn new(seed: u64, seconds: f64) -> Self {
        let phases = PerSide::from_fn(|side| phases_of(&mut Random::new(seed, purpose_of(side))));
        Self { phases, seconds }
    }

    /// An arm at a moment, seconds from the start; at rest once the exercise is over.
    pub(in crate::sim) fn arm(&self, person: &SimulatedPerson, side: Side, seconds: f64) -> Option<ArmPoints> {
        let share = ((self.seconds - seconds) / COMING_TO_REST_SECONDS).min(1.0);
        (share > 0.0).then(|| {
            let angles = person.exercising(side, self.phases.get(side), seconds, share);
            angles.points(side, &person.shoulder(side), &person.body.arm_sizes())
        })
    }
}

const fn purpose_of(side: Side) -> Purpose {
    match side {
        Side::Left => Purpose::LeftArm,
        Side::Right => Purpose::RightArm,
    }
}

fn phases_of(random: &mut Random) -> [f64; 4] {
    [(); 4].map(|()| random.between(0.0, std::f64::consts::TAU))
}

impl SimulatedPerson {
    /// The angles of an arm at a moment of the exercise, with a share of its usual extent.
    fn exercising(&self, side: Side, phases: &[f64; 4], seconds: f64, share: f64) -> ArmAngles {
        let arm = self.arm(side);
        let mut movement = arm.movement;
        movement.flexibility_share *= range_share(&arm.impairments) * share;
        movement.angles(&arm.posture, side, &self.body.arm_sizes(), phases, seconds)
    }

    /// What a camera sees of both arms while the person moves them about; same seed, same places.
    #[must_use]
    pub fn exercise(&self, seed: u64) -> PerSide<Seen> {
        let sizes = self.body.arm_sizes();
        PerSide::from_fn(|side| {
            let mut random = Random::new(seed, purpose_of(side));
            let phases = phases_of(&mut random);
            let mut places_seen = Seen::default();
            for beat in 0..BEATS {
                let sway = random.normal_vector(SWAY_METRES);
                let seconds = f64::from(beat) / RATE_HZ;
                let angles = self.exercising(side, &phases, seconds, 1.0);
                let places = angles.points(side, &(self.shoulder(side) + sway), &sizes).dressed();
                for (list, place) in places_seen.iter_mut().zip(places) {
                    list.push(place.coords + random.normal_vector(SEEN_METRES));
                }
            }
            places_seen
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Point;

    #[test]
    fn the_middle_of_the_exercise_is_the_posture_of_the_profile() {
        let person = SimulatedPerson::default();
        let posture = person.posture();
        for (side, seen) in person.exercise(1).iter() {
            for (places, wanted) in seen.iter().zip(posture.get(side).dressed()) {
                assert_eq!(places.len(), 900);
                let mean = places.iter().sum::<Vector>() / places.len() as f64;
                assert!((Point::from(mean) - wanted).norm() < 0.02, "{mean} for {wanted}");
            }
        }
    }

    #[test]
    fn the_hand_moves_most_and_the_shoulder_least() {
        let [hand, elbow, shoulder] = SimulatedPerson::default().exercise(2).right.map(|places| {
            let mean = places.iter().sum::<Vector>() / places.len() as f64;
            (places.iter().map(|place| (place - mean).norm_squared()).sum::<f64>() / places.len() as f64).sqrt()
        });
        assert!(hand > elbow && elbow > shoulder, "{hand} {elbow} {shoulder}");
        assert!((0.03..0.15).contains(&hand), "{hand}");
    }

    #[test]
    fn the_same_seed_brings_the_same_places_and_another_seed_others() {
        let person = SimulatedPerson::default();
        assert_eq!(person.exercise(3).left, person.exercise(3).left);
        assert_ne!(person.exercise(3).left, person.exercise(4).left);
    }
}
