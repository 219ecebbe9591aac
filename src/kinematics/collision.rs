//! What must not touch: the arms as capsules, against themselves, each other, the robot's body and the person.
//!
//! The shapes come from the collision elements of the robot's description (a cylinder is taken as the capsule round it), the
//! distances are closed forms. Pairs of neighbouring links touch by construction and are left out.

use super::JointVector;
use super::chain::{ArmFrames, Chain, Frame, JOINTS};
use super::description::Description;
use super::model::ModelError;
use super::scene::{Capsule, Scene};
use crate::body::{PerSide, Side};
use crate::geometry::{Point, Pose, Vector};
use urdf_rs::Geometry;

/// Least distance between two parts of the robot in metres: control error and the play of the cloth between them.
pub(super) const SELF_MARGIN: f64 = 0.01;
/// Links so many moving joints apart may meet; closer ones are bounded by their joints' ranges.
const APART: usize = 3;
/// Radius of a tool in metres: the electric gripper's body (0.029 m) and its finger plates.
const TOOL_RADIUS: f64 = 0.035;
/// A tool shorter than this is a plate inside the hand's own shape.
const SHORTEST_TOOL: f64 = 0.05;

/// Postures of the maker's programs for the right arm, radians: `move_to_neutral`, `tuck_arms` (untucked),
/// `joint_trajectory_client`. The left arm's s0, e0, w0 and w2 have the other sign.
const MAKERS_POSTURES: [[f64; JOINTS]; 3] = [
    [0.0, -0.55, 0.0, 0.75, 0.0, 1.26, 0.0],
    [0.08, -1.0, 1.19, 1.94, -0.67, 1.03, 0.50],
    [0.11, -0.62, 1.15, 1.32, -0.80, 1.27, -2.39],
];

/// One shape, fixed to a link.
#[derive(Clone, Debug)]
struct Shape {
    name: String,
    start: Point,
    end: Point,
    radius: f64,
}

/// A shape that moves with an arm.
#[derive(Clone, Debug)]
struct ArmShape {
    /// Which moving link, 0 to 6.
    link: usize,
    shape: Shape,
}

/// A capsule with the ball round it: two capsules are no closer than their balls, and balls are compared in a few
/// multiplications.
#[derive(Clone, Copy, Debug)]
struct Bounded {
    capsule: Capsule,
    centre: Point,
    reach: f64,
}

impl Bounded {
    fn new(capsule: Capsule) -> Self {
        let centre = nalgebra::center(&capsule.start, &capsule.end);
        Self { capsule, centre, reach: (capsule.end - centre).norm() + capsule.radius }
    }

    /// True where the surfaces are certainly at least `distance` apart. A number that is none makes nothing certain.
    fn is_beyond(&self, other: &Self, distance: f64) -> bool {
        let least = distance + self.reach + other.reach;
        least <= 0.0 || (self.centre - other.centre).norm_squared() >= least * least
    }
}

/// All shapes of the robot.
#[derive(Clone, Debug)]
pub(super) struct CollisionModel {
    body: Vec<(Shape, Bounded)>,
    arms: PerSide<Vec<ArmShape>>,
    /// Pairs of one arm's shapes that may meet.
    within: PerSide<Vec<(usize, usize)>>,
}

/// Two things and how close they are.
#[derive(Clone, Debug, PartialEq)]
pub struct Proximity {
    /// One of them, in the operator's words.
    pub first: String,
    /// The other.
    pub second: String,
    /// Distance of their surfaces in metres; negative where they overlap.
    pub distance: f64,
    /// The distance that is to be kept, in metres.
    pub least: f64,
}

/// The pair with the least room to spare, by index: names are looked up only when they are needed.
#[derive(Clone, Copy, Debug)]
pub(super) struct Tightest {
    /// Distance less the distance to keep, metres.
    pub(super) room: f64,
    pair: Pair,
}

#[derive(Clone, Copy, Debug)]
enum Pair {
    None,
    Arms(usize, usize),
    Same(Side, usize, usize),
    Body(Side, usize, usize),
    Person(Side, usize, usize),
}

impl Tightest {
    /// Offers a pair with the distance that it is to keep. Most pairs are too far apart to be the tightest: their balls say so.
    fn compare(&mut self, one: &Bounded, other: &Bounded, least: f64, pair: Pair) {
        if !one.is_beyond(other, self.room + least) {
            self.offer(one.capsule.distance(&other.capsule) - least, pair);
        }
    }

    fn offer(&mut self, room: f64, pair: Pair) {
        // A distance that is no number counts as contact: nothing may pass because of it.
        if room < self.room || room.is_nan() {
            *self = Self { room: if room.is_nan() { f64::NEG_INFINITY } else { room }, pair };
        }
    }
}

impl CollisionModel {
    /// The shapes that a description gives, and one for each tool. `hands` holds each hand and tip in the
    /// frame of the arm's last link.
    pub(super) fn new(
        description: &Description,
        hands: &PerSide<(Pose, Pose)>,
        chains: &PerSide<&Chain>,
    ) -> Result<Self, ModelError> {
        let mut model = Self { body: Vec::new(), arms: PerSide::default(), within: PerSide::default() };
        for link in &description.robot().links {
            let Some((holder, offset)) = description.holder(&link.name)? else { continue };
            let shapes = link.collision.iter().filter_map(|collision| {
                shape(&link.name, &(offset * super::description::pose_of(&collision.origin)), &collision.geometry)
            });
            match holder {
                None => model.body.extend(shapes.map(|shape| {
                    let capsule = Capsule { start: shape.start, end: shape.end, radius: shape.radius };
                    (shape, Bounded::new(capsule))
                })),
                Some((side, link)) => {
                    model.arms.get_mut(side).extend(shapes.map(|shape| ArmShape { link, shape }));
                }
            }
        }
        for (side, (hand, tip)) in hands.iter() {
            let (start, end) = (Point::from(hand.translation.vector), Point::from(tip.translation.vector));
            if (end - start).norm() >= SHORTEST_TOOL {
                // The capsule's cap ends at the tip, not beyond it.
                let end = end - (end - start).normalize() * TOOL_RADIUS;
                let shape = Shape { name: format!("the robot's {side} tool"), start, end, radius: TOOL_RADIUS };
                model.arms.get_mut(side).push(ArmShape { link: JOINTS - 1, shape });
            }
        }
        model.within = PerSide::from_fn(|side| pairs_within(side, model.arms.get(side), chains.get(side)));
        Ok(model)
    }

    /// The pair with the least room, of those with less than `below`; where there is none, `below` itself and no pair.
    /// The smaller `below`, the more pairs are known to be further apart by the balls round them.
    pub(super) fn tightest(&self, frames: &PerSide<ArmFrames>, scene: &Scene, below: f64) -> Tightest {
        let mut tightest = Tightest { room: below, pair: Pair::None };
        let placed = frames.map(|side, frames| placed(self.arms.get(side), frames));
        let person: Vec<Bounded> = scene.person.iter().map(|part| Bounded::new(part.shape)).collect();
        for (left_index, left) in placed.left.iter().enumerate() {
            for (right_index, right) in placed.right.iter().enumerate() {
                tightest.compare(&left.shape, &right.shape, SELF_MARGIN, Pair::Arms(left_index, right_index));
            }
        }
        for (side, arm) in placed.iter() {
            for &(index, other_index) in self.within.get(side) {
                if let (Some(part), Some(other)) = (arm.get(index), arm.get(other_index)) {
                    tightest.compare(&part.shape, &other.shape, SELF_MARGIN, Pair::Same(side, index, other_index));
                }
            }
            for (index, part) in arm.iter().enumerate() {
                // The body holds link 0, so link 2 is three moving joints away.
                if part.link + 1 >= APART {
                    for (body_index, (_, body)) in self.body.iter().enumerate() {
                        tightest.compare(&part.shape, body, SELF_MARGIN, Pair::Body(side, index, body_index));
                    }
                }
                for (person_index, person) in person.iter().enumerate() {
                    tightest.compare(&part.shape, person, scene.margin, Pair::Person(side, index, person_index));
                }
            }
        }
        tightest
    }

    /// The pair's names and its distance.
    pub(super) fn describe(&self, tightest: &Tightest, scene: &Scene) -> Proximity {
        let arm = |side: Side, index: usize| {
            self.arms.get(side).get(index).map(|part| part.shape.name.clone()).unwrap_or_default()
        };
        let (first, second, least) = match tightest.pair {
            Pair::None => (String::new(), String::new(), SELF_MARGIN),
            Pair::Arms(left, right) => (arm(Side::Left, left), arm(Side::Right, right), SELF_MARGIN),
            Pair::Same(side, one, other) => (arm(side, one), arm(side, other), SELF_MARGIN),
            Pair::Body(side, index, body) => {
                let name = self.body.get(body).map(|(shape, _)| shape.name.clone()).unwrap_or_default();
                (arm(side, index), name, SELF_MARGIN)
            }
            Pair::Person(side, index, person) => {
                let name = scene.person.get(person).map(|part| part.name.clone()).unwrap_or_default();
                (arm(side, index), name, scene.margin)
            }
        };
        Proximity { first, second, distance: tightest.room + least, least }
    }
}

/// The pairs of one arm's shapes that may meet: links far enough apart that do not overlap in the maker's own postures.
///
/// A capsule is rounder than the link it stands for: where two of them overlap in a posture in which the maker's programs hold
/// the arm, they do so by their caps (forearm and wrist, upper arm and forearm at the elbow), not because links touch.
fn pairs_within(side: Side, shapes: &[ArmShape], chain: &Chain) -> Vec<(usize, usize)> {
    let sign = if side == Side::Left { -1.0 } else { 1.0 };
    let mirror = JointVector::from([sign, 1.0, sign, 1.0, sign, 1.0, sign]);
    let postures = MAKERS_POSTURES.map(|right| JointVector::from(right).component_mul(&mirror));
    let held = postures.map(|joints| placed(shapes, &chain.frames(&joints)));
    let overlap = |index: usize, other: usize| {
        held.iter().any(|parts| match (parts.get(index), parts.get(other)) {
            (Some(part), Some(other)) => part.shape.capsule.distance(&other.shape.capsule) < SELF_MARGIN,
            _ => false,
        })
    };
    let count = shapes.len();
    (0..count)
        .flat_map(|index| (index + 1..count).map(move |other| (index, other)))
        .filter(|&(index, other)| match (shapes.get(index), shapes.get(other)) {
            (Some(part), Some(next)) => part.link.abs_diff(next.link) >= APART && !overlap(index, other),
            _ => false,
        })
        .collect()
}

struct Placed {
    link: usize,
    shape: Bounded,
}

fn placed(shapes: &[ArmShape], frames: &ArmFrames) -> Vec<Placed> {
    let place = |frame: &Frame, point: &Point| Point::from(frame.rotation * point.coords + frame.translation);
    shapes
        .iter()
        .filter_map(|part| {
            let frame = frames.links.get(part.link)?;
            let (start, end) = (place(frame, &part.shape.start), place(frame, &part.shape.end));
            let shape = Bounded::new(Capsule { start, end, radius: part.shape.radius });
            Some(Placed { link: part.link, shape })
        })
        .collect()
}

/// A cylinder as the capsule with the same axis and radius, a sphere as itself; boxes and meshes are not checked.
fn shape(link: &str, pose: &Pose, geometry: &Geometry) -> Option<Shape> {
    let (half, radius) = match geometry {
        Geometry::Cylinder { radius, length } | Geometry::Capsule { radius, length } => (0.5 * length, *radius),
        Geometry::Sphere { radius } => (0.0, *radius),
        Geometry::Box { .. } | Geometry::Mesh { .. } => return None,
    };
    let end = |height: f64| pose * Point::from(Vector::z() * height);
    Some(Shape { name: spoken(link), start: end(-half), end: end(half), radius })
}

/// A link's name in the operator's words.
fn spoken(link: &str) -> String {
    if link.starts_with("collision_head") {
        return "the robot's head".into();
    }
    format!("the robot's {}", link.trim_end_matches("_visual").replace('_', " "))
}

#[cfg(test)]
mod tests;
