//! An arm: three angles of the shoulder, one of the elbow, the wrist kept straight.

use super::{ArmPoints, Impairment, Movement, PersonError, Response};
use crate::body::Side;
use crate::geometry::{Point, Vector, polyline_length};
use nalgebra::{Rotation3, Unit};
use serde::{Deserialize, Serialize};

/// Points of a preferred path between hand and shoulder: fine enough that its corners turn by less than 20 degrees.
const PATH_PIECES: usize = 8;

/// Lengths and radii of an arm.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ArmSizes {
    /// Shoulder to elbow in metres (acromion to radiale).
    pub upper_arm_metres: f64,
    /// Elbow to wrist in metres (radiale to stylion).
    pub forearm_metres: f64,
    /// Length of the hand in metres.
    pub hand_metres: f64,
    /// Radius of the upper arm in metres.
    pub upper_arm_radius_metres: f64,
    /// Radius of the forearm in metres.
    pub forearm_radius_metres: f64,
    /// Radius of the wrist in metres.
    pub wrist_radius_metres: f64,
    /// Radius of the flat hand in metres, from its girth.
    pub hand_radius_metres: f64,
    /// Mass of the whole arm in kilograms (de Leva's shares of body mass).
    pub mass_kilograms: f64,
}

impl ArmSizes {
    /// Wrist to the middle finger's knuckle in metres: a little under half of the hand.
    #[must_use]
    pub fn knuckle_metres(&self) -> f64 {
        0.45 * self.hand_metres
    }
}

/// The posture of an arm in degrees.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct ArmAngles {
    /// The upper arm's angle from hanging down: 90 is level, 180 straight up.
    pub elevation_degrees: f64,
    /// The plane of that elevation: 0 to the side, 90 forward, -90 backward.
    pub plane_degrees: f64,
    /// Turn of the upper arm about itself: 0 bends the elbow forward, 90 upward and outward.
    pub rotation_degrees: f64,
    /// Elbow flexion: 0 is straight.
    pub elbow_degrees: f64,
}

impl Default for ArmAngles {
    /// Stretched to the side and a little back, low, so that the hand meets an armhole that comes from behind.
    fn default() -> Self {
        Self { elevation_degrees: 45.0, plane_degrees: -14.0, rotation_degrees: 90.0, elbow_degrees: 25.0 }
    }
}

impl ArmAngles {
    /// Where the joints are for a shoulder at a place, in metres in `base`; the person looks along +x.
    #[must_use]
    pub fn points(&self, side: Side, shoulder: &Point, sizes: &ArmSizes) -> ArmPoints {
        let outward = if side == Side::Left { 1.0 } else { -1.0 };
        let (elevation, plane) = (self.elevation_degrees.to_radians(), self.plane_degrees.to_radians());
        let upper =
            Vector::new(elevation.sin() * plane.sin(), outward * elevation.sin() * plane.cos(), -elevation.cos());
        let elbow = shoulder + upper * sizes.upper_arm_metres;
        let forearm = self.forearm_direction(outward, &upper);
        let wrist = elbow + forearm * sizes.forearm_metres;
        ArmPoints { hand: wrist + forearm * sizes.knuckle_metres(), wrist, elbow, shoulder: *shoulder }
    }

    fn forearm_direction(&self, outward: f64, upper: &Vector) -> Vector {
        let ahead = Vector::x() - upper * upper.x;
        // Straight forward or backward the arm has no "ahead" of its own: up stands in.
        let ahead = if ahead.norm() > 1e-6 { ahead.normalize() } else { Vector::z() };
        let turn =
            Rotation3::from_axis_angle(&Unit::new_normalize(*upper), -outward * self.rotation_degrees.to_radians());
        let bend = turn * ahead;
        let flexion = self.elbow_degrees.to_radians();
        upper * flexion.cos() + bend * flexion.sin()
    }

    /// Checks the angles against what people reach (active ranges of adults, AAOS and Boone).
    pub(super) fn check(&self, key: &str) -> Result<(), PersonError> {
        PersonError::range(format!("{key}.elevation_degrees"), self.elevation_degrees, (0.0, 180.0))?;
        PersonError::range(format!("{key}.plane_degrees"), self.plane_degrees, (-90.0, 135.0))?;
        PersonError::range(format!("{key}.rotation_degrees"), self.rotation_degrees, (-104.0, 104.0))?;
        PersonError::range(format!("{key}.elbow_degrees"), self.elbow_degrees, (0.0, 150.0))?;
        if self.plane_degrees < -45.0 && self.elevation_degrees > 62.0 {
            return Err(PersonError::Contradiction {
                key: format!("{key}.elevation_degrees"),
                reason: format!("nobody lifts the arm {} degrees backward", self.elevation_degrees),
            });
        }
        Ok(())
    }
}

/// One arm of a simulated person.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct SimulatedArm {
    /// The posture in which the person waits for the sleeve.
    pub posture: ArmAngles,
    /// How far the path that the person likes best lies from the straight one, in metres in the middle of the arm:
    /// forward, outward (away from the body's middle), up.
    pub preferred_offset_metres: [f64; 3],
    /// In which way the person moves the arm easily.
    pub movement: Movement,
    /// How the person reacts.
    pub response: Response,
    /// What is wrong with the arm.
    pub impairments: Vec<Impairment>,
}

impl Default for SimulatedArm {
    fn default() -> Self {
        Self {
            posture: ArmAngles::default(),
            preferred_offset_metres: [-0.055, 0.02, 0.04],
            movement: Movement::default(),
            response: Response::default(),
            impairments: Vec::new(),
        }
    }
}

impl SimulatedArm {
    /// The gripper's path that the person likes best: `straight` (hand, elbow, shoulder in `base`), bent by the offset
    /// with half a sine, so that both ends stay.
    #[must_use]
    pub fn preferred_path(&self, side: Side, straight: &[Point]) -> Vec<Point> {
        let [forward, outward, up] = self.preferred_offset_metres;
        let offset = Vector::new(forward, if side == Side::Left { outward } else { -outward }, up);
        let length = polyline_length(straight);
        let share = |piece: usize| piece as f64 / PATH_PIECES as f64;
        (0..=PATH_PIECES)
            .filter_map(|piece| {
                let along = point_along(straight, share(piece) * length)?;
                Some(along + offset * (std::f64::consts::PI * share(piece)).sin())
            })
            .collect()
    }

    pub(super) fn check(&self, key: &str) -> Result<(), PersonError> {
        self.posture.check(&format!("{key}.posture"))?;
        for (name, value) in ["forward", "outward", "up"].into_iter().zip(self.preferred_offset_metres) {
            PersonError::range(format!("{key}.preferred_offset_metres, {name}"), value, (-0.2, 0.2))?;
        }
        self.movement.check(&format!("{key}.movement"))?;
        for (index, impairment) in self.impairments.iter().enumerate() {
            impairment.check(&format!("{key}.impairments[{index}]"))?;
        }
        self.response.check(&format!("{key}.response"))
    }
}

/// The point of a polyline a length from its start, its last point beyond its end; `None` where it has no points.
pub(in crate::sim) fn point_along(polyline: &[Point], mut length: f64) -> Option<Point> {
    for (start, end) in polyline.iter().zip(polyline.iter().skip(1)) {
        let piece = (end - start).norm();
        if length <= piece && piece > 0.0 {
            return Some(start + (end - start) * (length / piece));
        }
        length -= piece;
    }
    polyline.last().copied()
}
