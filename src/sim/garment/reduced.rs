//! The fast garment: a tube round the person's preferred path that is slack, then taut, and jams.
//!
//! Force on a gripper = stiffness across the path beyond the free play + jamming along it + friction + weight + the back
//! between both grippers + what the person's arm adds ([`Reaction`]). Smooth, exact and cheap; its figures are those
//! that were found by fitting the thesis' table 4.2 (`docs/results.md`, "Simulated people").

use super::super::person::{ArmPoints, Pull, Reaction};
use super::{Garment, GarmentSizes, Holder, Wearing};
use crate::body::{PerSide, Side};
use crate::geometry::{Point, Vector, closest_on_segment};

/// An armhole that comes this near to the hand goes round it, in metres: about the radius of an armhole.
const CAPTURE: f64 = 0.08;
/// An armhole that is brought this far beyond the fingertips has come off, in metres.
const RELEASE: f64 = 0.15;
/// A sleeve that has gone this far is under way: its return to the hand ends the iteration. Metres along the arm.
const UNDER_WAY: f64 = 0.10;
/// A gripper that is back within this distance of the hand has ended its iteration, in metres.
const BACK_AT_HAND: f64 = 0.05;
/// Round the fingers the armhole still has room; metres of additional play at the hand, gone after as many metres.
const PLAY_AT_HAND: f64 = 0.08;
/// Below this speed along the path a sleeve neither goes on nor comes off, in metres per second.
const STILL: f64 = 0.01;
/// A jam's force at the most, in newtons.
const JAM_CEILING: f64 = 20.0;
/// Time in which a jam loosens when nothing pushes, in seconds.
const JAM_LOOSENING: f64 = 0.5;
/// A relaxed arm that lets the sleeve come off has this share of its stiffness.
const RELAXED: f64 = 0.3;
/// All that a sleeve can do to a gripper, in newtons.
const CEILING: f64 = 30.0;
/// The speed at which friction is half of its full value, in metres per second.
const FRICTION_SPEED: f64 = 0.02;
/// Gravity in metres per second squared.
const GRAVITY: f64 = 9.81;

/// The reduced garment.
#[derive(Clone, Debug)]
pub struct ReducedGarment {
    sizes: GarmentSizes,
    sleeves: PerSide<Sleeve>,
}

#[derive(Clone, Copy, Debug, Default)]
struct Sleeve {
    wearing: Wearing,
    furthest: f64,
    jammed: f64,
    direction: f64,
}

/// Where a gripper is in relation to a path.
#[derive(Clone, Copy, Debug)]
struct Place {
    /// From the gripper to the closest point of the path.
    towards: Vector,
    /// Direction of the path there, from hand to shoulder.
    tangent: Vector,
    /// Length of the path up to there in metres.
    along: f64,
    /// Length of the whole path in metres.
    length: f64,
}

impl ReducedGarment {
    /// A garment held by both grippers, on nobody.
    #[must_use]
    pub fn new(sizes: GarmentSizes) -> Self {
        Self { sizes, sleeves: PerSide::default() }
    }

    /// The force of the back on the gripper of a side: none before it is taut.
    fn back(&self, side: Side, holders: &PerSide<Holder>) -> Vector {
        let across = holders.get(side.other()).tip - holders.get(side).tip;
        let distance = across.norm();
        let stretch = distance - self.sizes.back_reach_metres;
        let slipped = Side::BOTH.into_iter().any(|side| self.sleeves.get(side).wearing == Wearing::Slipped);
        if slipped || stretch <= 0.0 {
            return Vector::zeros();
        }
        across * (self.sizes.back_stiffness_newtons_per_metre * stretch / distance)
    }
}

impl Garment for ReducedGarment {
    fn step(
        &mut self,
        seconds: f64,
        holders: &PerSide<Holder>,
        arms: &PerSide<ArmPoints>,
        reactions: &mut PerSide<Reaction>,
    ) -> PerSide<Vector> {
        let weight = -Vector::z() * (self.sizes.mass_kilograms * GRAVITY / 2.0);
        let back = PerSide::from_fn(|side| self.back(side, holders));
        PerSide::from_fn(|side| {
            let sleeve = self.sleeves.get_mut(side);
            let reaction = reactions.get_mut(side);
            let holder = holders.get(side);
            let Some(place) = place(&holder.tip, reaction.path()) else { return Vector::zeros() };
            sleeve.notice(holder, &arms.get(side).hand, &place, reaction);
            let carried = match sleeve.wearing {
                Wearing::Slipped => {
                    reaction.react(&Pull::default(), seconds);
                    return Vector::zeros();
                }
                Wearing::Off => weight + reaction.react(&Pull::default(), seconds),
                Wearing::On { metres } => {
                    weight * (1.0 - metres / place.length) + sleeve.pull(holder, &place, reaction, seconds)
                }
            };
            let force = carried + back.get(side);
            if force.norm() > self.sizes.slip_newtons {
                sleeve.wearing = Wearing::Slipped;
                return Vector::zeros();
            }
            force
        })
    }

    fn wearing(&self) -> PerSide<Wearing> {
        self.sleeves.map(|_, sleeve| sleeve.wearing)
    }

    fn slip(&mut self, side: Side) {
        self.sleeves.get_mut(side).wearing = Wearing::Slipped;
    }
}

impl Sleeve {
    /// Goes onto the hand, comes off it, and ends an iteration when it is back at the hand.
    fn notice(&mut self, holder: &Holder, hand: &Point, place: &Place, reaction: &mut Reaction) {
        let to_hand = (holder.tip - hand).norm();
        match self.wearing {
            Wearing::Off if to_hand < CAPTURE => {
                *self = Self { wearing: Wearing::On { metres: place.along }, ..Self::default() };
            }
            Wearing::On { .. } if place.along <= 0.0 && to_hand > RELEASE => {
                self.end_pass(reaction);
                self.wearing = Wearing::Off;
            }
            Wearing::On { .. } => {
                self.wearing = Wearing::On { metres: place.along };
                self.furthest = self.furthest.max(place.along);
                if to_hand < BACK_AT_HAND {
                    self.end_pass(reaction);
                }
            }
            Wearing::Off | Wearing::Slipped => {}
        }
    }

    fn end_pass(&mut self, reaction: &mut Reaction) {
        if self.furthest > UNDER_WAY {
            reaction.end_pass();
            (self.furthest, self.jammed) = (0.0, 0.0);
        }
    }

    /// The force of sleeve and arm on the gripper.
    fn pull(&mut self, holder: &Holder, place: &Place, reaction: &mut Reaction, seconds: f64) -> Vector {
        let response = *reaction.response();
        let play = response.free_play_metres + (PLAY_AT_HAND - place.along).max(0.0);
        let distance = place.towards.norm();
        let excess = if distance > play { place.towards * ((distance - play) / distance) } else { Vector::zeros() };
        let forward = holder.velocity.dot(&place.tangent);
        self.turn(forward, seconds);
        self.jam(forward, excess != Vector::zeros(), seconds);
        let stiffness = response.lateral_stiffness_newtons_per_metre * (RELAXED + (1.0 - RELAXED) * self.direction);
        let speed = holder.velocity.norm();
        let friction = response.drag_newtons * (0.4 + 0.6 * place.along / place.length) / (speed + FRICTION_SPEED);
        let jam = (response.jam_stiffness_newtons_per_metre * self.jammed).min(JAM_CEILING);
        let reflex = reaction.react(&Pull { excess, speed, advancing: forward > STILL }, seconds);
        let force = excess * stiffness - place.tangent * jam - holder.velocity * friction + reflex;
        force.cap_magnitude(CEILING)
    }

    /// Follows whether the sleeve goes on (1) or comes off (0), without a jump that would feel like a contact.
    fn turn(&mut self, forward: f64, seconds: f64) {
        let goal = if forward < -STILL { 0.0 } else { 1.0 };
        let share = 1.0 - (-seconds / 0.2_f64).exp();
        self.direction += (goal - self.direction) * share;
    }

    fn jam(&mut self, forward: f64, taut: bool, seconds: f64) {
        if taut && forward > STILL {
            self.jammed += forward * seconds;
        } else {
            self.jammed *= (-seconds / JAM_LOOSENING).exp();
        }
    }
}

/// The closest point of a path; `None` where it has fewer than two points.
fn place(tip: &Point, path: &[Point]) -> Option<Place> {
    let mut best: Option<Place> = None;
    let mut length = 0.0;
    for (start, end) in path.iter().zip(path.iter().skip(1)) {
        let closest = closest_on_segment(tip, start, end);
        let towards = closest - tip;
        if best.is_none_or(|best| towards.norm_squared() < best.towards.norm_squared()) {
            let tangent = (end - start).try_normalize(1e-9).unwrap_or_else(Vector::zeros);
            best = Some(Place { towards, tangent, along: length + (closest - start).norm(), length: 0.0 });
        }
        length += (end - start).norm();
    }
    best.filter(|_| length > 0.0).map(|best| Place { length, ..best })
}

#[cfg(test)]
mod tests;
