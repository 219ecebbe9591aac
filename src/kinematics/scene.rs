//! What surrounds the robot: the person's body as capsules, and how far the arms keep away from it.
//!
//! A part that is not known is not there: whether enough of the person is known to move at all is the safety room's question.

use crate::body::{BodyPose, Joint, JointEstimate, PerSide, Side};
use crate::geometry::{Point, Vector};
use serde::{Deserialize, Serialize};

/// All points within `radius` of the segment from `start` to `end`; a sphere where both are the same. Metres.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Capsule {
    /// One end of the axis.
    pub start: Point,
    /// The other end of the axis.
    pub end: Point,
    /// Radius in metres.
    pub radius: f64,
}

impl Capsule {
    /// A sphere.
    #[must_use]
    pub const fn sphere(centre: Point, radius: f64) -> Self {
        Self { start: centre, end: centre, radius }
    }

    /// Distance of the surfaces in metres; negative where the capsules overlap, then by how deep their axes are too close.
    #[must_use]
    pub fn distance(&self, other: &Self) -> f64 {
        segment_distance(&self.start, &self.end, &other.start, &other.end) - self.radius - other.radius
    }
}

/// Distance of two segments, in closed form (Ericson, Real-Time Collision Detection, 2005, section 5.1.9).
fn segment_distance(start: &Point, end: &Point, other_start: &Point, other_end: &Point) -> f64 {
    // Shorter than a nanometre: a point.
    const POINT: f64 = 1e-18;
    let (along, other_along, between) = (end - start, other_end - other_start, start - other_start);
    let (length, other_length) = (along.norm_squared(), other_along.norm_squared());
    let (toward, other_toward) = (along.dot(&between), other_along.dot(&between));
    let (share, other_share) = if length <= POINT && other_length <= POINT {
        (0.0, 0.0)
    } else if length <= POINT {
        (0.0, (other_toward / other_length).clamp(0.0, 1.0))
    } else if other_length <= POINT {
        ((-toward / length).clamp(0.0, 1.0), 0.0)
    } else {
        let mixed = along.dot(&other_along);
        let denominator = length * other_length - mixed * mixed;
        // Parallel segments: any point of the first is as good as another.
        let free = if denominator > 1e-12 * length * other_length {
            ((mixed * other_toward - toward * other_length) / denominator).clamp(0.0, 1.0)
        } else {
            0.0
        };
        let opposite = (mixed * free + other_toward) / other_length;
        if (0.0..=1.0).contains(&opposite) {
            (free, opposite)
        } else {
            let end = opposite.clamp(0.0, 1.0);
            (((mixed * end - toward) / length).clamp(0.0, 1.0), end)
        }
    };
    (between + along * share - other_along * other_share).norm()
}

/// A part of the person's body that the arms keep away from.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct BodyPart {
    /// What it is, in the operator's words.
    pub name: String,
    /// Its shape in `base`, uncertainty included.
    pub shape: Capsule,
}

/// The thickness of a person, metres.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct BodyBuild {
    /// Radius of forearm and hand.
    pub forearm: f64,
    /// Radius of the upper arm.
    pub upper_arm: f64,
    /// Radius of the trunk.
    pub trunk: f64,
    /// Length of the trunk below the neck.
    pub trunk_length: f64,
    /// Radius of the head.
    pub head: f64,
    /// Height of the head's centre above the neck.
    pub head_height: f64,
}

impl Default for BodyBuild {
    /// Arm radii as in limb tables (PMC2784227: 0.041 to 0.048 m); the trunk is as thick as half a median chest is
    /// deep (ANSUR II: 211 mm for slim to 253 mm for median men, 240 mm for median women), because a gripper comes to the shoulder from behind; head of a middle-sized adult.
    fn default() -> Self {
        Self { forearm: 0.045, upper_arm: 0.048, trunk: 0.11, trunk_length: 0.55, head: 0.12, head_height: 0.17 }
    }
}

/// What surrounds the robot.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Scene {
    /// The person; empty where nobody is there.
    pub person: Vec<BodyPart>,
    /// Least distance between an arm and the person in metres.
    pub margin: f64,
}

impl Default for Scene {
    fn default() -> Self {
        Self { person: Vec::new(), margin: 0.02 }
    }
}

impl Scene {
    /// The surroundings with a person of this pose (in `base`) and build. The arms in `dressed` are left out: the gripper leads
    /// the garment along them. Each part is thicker by twice the standard deviation of its less certain end.
    #[must_use]
    pub fn around(body: &BodyPose, build: &BodyBuild, dressed: &PerSide<bool>) -> Self {
        let mut person = Vec::new();
        for side in Side::BOTH.into_iter().filter(|side| !dressed.get(*side)) {
            let arm = body.arms.get(side);
            let mut part = |name: &str, from: Joint, to: Joint, radius: f64| {
                if let (Some(from), Some(to)) = (arm.joint(from), arm.joint(to)) {
                    person.push(limb(&format!("the person's {side} {name}"), from, to, radius));
                }
            };
            part("forearm", Joint::Elbow, Joint::Hand, build.forearm);
            part("upper arm", Joint::Shoulder, Joint::Elbow, build.upper_arm);
        }
        if let Some(neck) = &body.neck {
            person.extend(trunk_and_head(neck, build));
        }
        Self { person, ..Self::default() }
    }
}

fn limb(name: &str, from: &JointEstimate, to: &JointEstimate, radius: f64) -> BodyPart {
    let radius = radius + uncertainty(from).max(uncertainty(to));
    BodyPart { name: name.into(), shape: Capsule { start: from.position, end: to.position, radius } }
}

/// The most that doubt about the neck's place thickens the trunk, in metres (ours).
const MOST_TRUNK_DOUBT: f64 = 0.015;

/// The trunk is as deep as a chest from the armpits down, in metres below the neck: armpits lie 0.10 m below the shoulder
/// (ANSUR II, acromion above armpit, 96 to 111 mm in the middle), and the shoulders 0.09 m below the neck. Above it narrows
/// to the neck, and a gripper that brings the garment onto a shoulder must come by.
const ARMPIT_BELOW_NECK: f64 = 0.19;

/// The person sits or stands upright: trunk and head are vertical below and above the neck.
fn trunk_and_head(neck: &JointEstimate, build: &BodyBuild) -> [BodyPart; 2] {
    let extra = uncertainty(neck);
    let top = neck.position - Vector::z() * ARMPIT_BELOW_NECK;
    // Whoever brings a garment onto a shoulder comes close to the trunk: full doubt would forbid the task. The force guard's
    // tiers are halved there instead.
    let trunk_extra = extra.min(MOST_TRUNK_DOUBT);
    let trunk = Capsule { start: top, end: top - Vector::z() * build.trunk_length, radius: build.trunk + trunk_extra };
    let head = Capsule::sphere(neck.position + Vector::z() * build.head_height, build.head + extra);
    [
        BodyPart { name: "the person's trunk".into(), shape: trunk },
        BodyPart { name: "the person's head".into(), shape: head },
    ]
}

/// Twice the standard deviation in the worst direction, metres.
fn uncertainty(joint: &JointEstimate) -> f64 {
    2.0 * joint.covariance.symmetric_eigenvalues().max().max(0.0).sqrt()
}

#[cfg(test)]
mod tests;
