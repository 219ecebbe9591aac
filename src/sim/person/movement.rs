//! In which way a person moves an arm easily: the thesis' movement limits, as classes of a profile.
//!
//! Chapters 3 and 5 ask people to pretend that they move well only from left to right, forward and backward or up and down,
//! only in vertical circles, or less with one arm than with the other. A class says where the hand goes; the shoulder's and
//! the elbow's angles follow with the least movement that brings it there.

use super::{ArmAngles, ArmSizes, PersonError};
use crate::body::Side;
use crate::geometry::{Point, Vector};
use nalgebra::{Matrix3, Matrix3x4};
use serde::{Deserialize, Serialize};

/// How far the hand goes to either side along a direction, in metres (ours: a comfortable movement of a seated person).
const STROKE_METRES: f64 = 0.20;
/// Radius of a vertical circle of the hand in metres, and the time for one turn in seconds (ours).
const CIRCLE_METRES: f64 = 0.125;
const CIRCLE_SECONDS: f64 = 4.5;
/// A stroke: rest in the middle, go, rest at one end, go back, and the same to the other end. Seconds of each rest and way.
const REST_SECONDS: f64 = 1.0;
const WAY_SECONDS: f64 = 1.0;
/// Half of each swing of a free arm in degrees: elevation, plane, rotation, elbow (ours: a movement that costs no effort).
const SWING_DEGREES: [f64; 4] = [8.0, 8.0, 10.0, 10.0];
/// Swings a second of each angle: their ratios are no fractions of small numbers, so no swing repeats another.
const PACE_HZ: [f64; 4] = [0.171, 0.233, 0.277, 0.361];
/// Steps of the search for the angles that bring the hand to a place, and its damping in metres.
const STEPS: usize = 6;
const DAMPING: f64 = 0.02;
/// Small turns (degrees) that show how each angle moves the hand.
const PROBES: [[f64; 4]; 4] = [[0.1, 0.0, 0.0, 0.0], [0.0, 0.1, 0.0, 0.0], [0.0, 0.0, -0.1, 0.0], [0.0, 0.0, 0.0, 0.1]];

/// In which directions an arm moves easily.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum MovementKind {
    /// In all, a little.
    #[default]
    Free,
    /// From left to right.
    LeftRight,
    /// Forward and backward.
    ForwardBackward,
    /// Up and down.
    UpDown,
    /// In vertical circles.
    Circles,
}

/// How an arm moves about when nobody dresses it.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Movement {
    /// The direction.
    pub kind: MovementKind,
    /// Share of the usual extent that this arm reaches: 1 for a flexible arm, 0.3 to 0.5 for the thesis' less flexible one.
    pub flexibility_share: f64,
}

impl Default for Movement {
    fn default() -> Self {
        Self { kind: MovementKind::Free, flexibility_share: 1.0 }
    }
}

impl Movement {
    /// The arm's angles at a moment of the exercise; `phases` (radians) let two people move differently.
    pub(super) fn angles(
        &self,
        posture: &ArmAngles,
        side: Side,
        sizes: &ArmSizes,
        phases: &[f64; 4],
        seconds: f64,
    ) -> ArmAngles {
        match self.hand_offset(phases, seconds) {
            None => self.swung(posture, phases, seconds),
            Some(offset) => {
                let origin = Point::origin();
                reaching(posture, side, sizes, &(posture.points(side, &origin, sizes).hand + offset))
            }
        }
    }

    /// Where the hand is in relation to its place in the posture, in metres; `None` where the class does not say.
    fn hand_offset(&self, phases: &[f64; 4], seconds: f64) -> Option<Vector> {
        let [phase, ..] = *phases;
        let stroke = STROKE_METRES * self.flexibility_share * stroke_at(seconds + phase);
        match self.kind {
            MovementKind::Free => None,
            MovementKind::LeftRight => Some(Vector::y() * stroke),
            MovementKind::ForwardBackward => Some(Vector::x() * stroke),
            MovementKind::UpDown => Some(Vector::z() * stroke),
            MovementKind::Circles => {
                let turn = std::f64::consts::TAU * seconds / CIRCLE_SECONDS + phase;
                Some(Vector::new(0.0, turn.cos(), turn.sin()) * (CIRCLE_METRES * self.flexibility_share))
            }
        }
    }

    /// The posture's angles with a swing about each, kept within what people reach.
    fn swung(&self, posture: &ArmAngles, phases: &[f64; 4], seconds: f64) -> ArmAngles {
        let swing =
            |degrees: f64, pace: f64, phase: f64| degrees * (std::f64::consts::TAU * pace * seconds + phase).sin();
        let mut swings = SWING_DEGREES.into_iter().zip(PACE_HZ).zip(phases);
        let swings =
            [(); 4].map(|()| swings.next().map_or(0.0, |((degrees, pace), phase)| swing(degrees, pace, *phase)));
        moved(posture, swings.map(|degrees| degrees * self.flexibility_share))
    }

    pub(super) fn check(&self, key: &str) -> Result<(), PersonError> {
        PersonError::range(format!("{key}.flexibility_share"), self.flexibility_share, (0.1, 1.5))
    }
}

/// Where on its stroke (-1 to 1) a hand is: three places to rest, the middle one met twice as often.
fn stroke_at(seconds: f64) -> f64 {
    let part = REST_SECONDS + WAY_SECONDS;
    let round = seconds.rem_euclid(4.0 * part);
    let [from, to] = match round / part {
        ..1.0 => [0.0, 1.0],
        ..2.0 => [1.0, 0.0],
        ..3.0 => [0.0, -1.0],
        _ => [-1.0, 0.0],
    };
    let way = ((round % part - REST_SECONDS) / WAY_SECONDS).clamp(0.0, 1.0);
    from + (to - from) * way * way * (3.0 - 2.0 * way)
}

/// A posture with changes in degrees (elevation, plane, rotation, elbow), within what people reach.
fn moved(posture: &ArmAngles, [elevation, plane, rotation, elbow]: [f64; 4]) -> ArmAngles {
    ArmAngles {
        elevation_degrees: (posture.elevation_degrees + elevation).clamp(0.0, 180.0),
        plane_degrees: (posture.plane_degrees + plane).clamp(-90.0, 135.0),
        rotation_degrees: (posture.rotation_degrees + rotation).clamp(-104.0, 104.0),
        elbow_degrees: (posture.elbow_degrees + elbow).clamp(0.0, 150.0),
    }
}

/// Angles near a posture that bring the hand to a place (metres, shoulder at the origin), or as near as they can: damped
/// least squares, so that no joint turns more than it must.
fn reaching(posture: &ArmAngles, side: Side, sizes: &ArmSizes, goal: &Point) -> ArmAngles {
    let hand = |angles: &ArmAngles| angles.points(side, &Point::origin(), sizes).hand;
    let mut angles = *posture;
    for _ in 0..STEPS {
        let here = hand(&angles);
        let columns = PROBES.map(|probe| (hand(&moved(&angles, probe)) - here) / probe.iter().sum::<f64>());
        let slope = Matrix3x4::from_columns(&columns);
        let damped = slope * slope.transpose() + Matrix3::identity() * (DAMPING * DAMPING / 1e3);
        let Some(inverse) = damped.try_inverse() else { return angles };
        angles = moved(&angles, (slope.transpose() * (inverse * (goal - here))).into());
    }
    angles
}

#[cfg(test)]
mod tests {
    use super::super::SimulatedPerson;
    use super::*;
    use crate::body::PerSide;

    /// The spread (standard deviation) of the right hand along x, y and z in metres while a person exercises.
    fn spread(kind: MovementKind, share: f64) -> [f64; 3] {
        let mut person = SimulatedPerson::default();
        person.right.movement = Movement { kind, flexibility_share: share };
        let PerSide { right: [hand, ..], .. } = person.exercise(4);
        let mean = hand.iter().sum::<Vector>() / hand.len() as f64;
        let variance = hand.iter().map(|place| (place - mean).component_mul(&(place - mean))).sum::<Vector>();
        (variance / hand.len() as f64).map(f64::sqrt).into()
    }

    #[test]
    fn each_limit_moves_the_hand_most_in_its_own_direction() {
        for (kind, axis) in
            [(MovementKind::ForwardBackward, 0), (MovementKind::LeftRight, 1), (MovementKind::UpDown, 2)]
        {
            let spread = spread(kind, 1.0);
            let others = (0..3).filter(|other| *other != axis).map(|other| spread[other]).fold(0.0, f64::max);
            assert!(spread[axis] > 0.07 && spread[axis] > 2.0 * others, "{kind:?}: {spread:?}");
        }
    }

    #[test]
    fn circles_are_upright_and_round() {
        let [x, y, z] = spread(MovementKind::Circles, 1.0);
        assert!(x < 0.04 && (y / z - 1.0).abs() < 0.3 && y > 0.06, "{x} {y} {z}");
    }

    #[test]
    fn a_less_flexible_arm_moves_less() {
        let (full, less) = (spread(MovementKind::UpDown, 1.0), spread(MovementKind::UpDown, 0.4));
        assert!(less[2] < 0.55 * full[2], "{less:?} {full:?}");
    }

    #[test]
    fn a_flexibility_that_nobody_has_is_refused_by_its_key() {
        let mut person = SimulatedPerson::default();
        person.right.movement.flexibility_share = 0.0;
        assert!(person.check().unwrap_err().to_string().contains("right.movement.flexibility_share"));
    }
}
