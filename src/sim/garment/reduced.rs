//! The fast garment: a tube round the person's preferred path that is slack, then taut, and jams.
//!
//! Force on a gripper = stiffness across the path beyond the free play + jamming along it + friction + weight + the back
//! between both grippers + what the person's arm adds ([`Reaction`]). Smooth, exact and cheap; its figures are those
//! that were found by fitting the thesis' table 4.2 (`docs/results.md`, "Simulated people").

use super::super::person::{ArmPoints, Pull, Reaction};
use super::passage::{Event, Passage, Place};
use super::{GRAVITY, Garment, GarmentSizes, Holder, Wearing};
use crate::body::{PerSide, Side};
use crate::geometry::Vector;

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

/// The reduced garment.
#[derive(Clone, Debug)]
pub struct ReducedGarment {
    sizes: GarmentSizes,
    sleeves: PerSide<Sleeve>,
}

#[derive(Clone, Copy, Debug, Default)]
struct Sleeve {
    passage: Passage,
    /// How far along the arm the rim is caught, where it is.
    caught_at: Option<f64>,
    jammed: f64,
    direction: f64,
}

impl ReducedGarment {
    /// A garment held by both grippers, on nobody.
    #[must_use]
    pub fn new(sizes: GarmentSizes) -> Self {
        Self { sizes, sleeves: PerSide::default() }
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
        let back = self.sizes.back_forces(holders, &self.wearing());
        PerSide::from_fn(|side| {
            let sleeve = self.sleeves.get_mut(side);
            let reaction = reactions.get_mut(side);
            let holder = holders.get(side);
            let Some(place) = Place::on(reaction.path(), &holder.tip) else { return Vector::zeros() };
            if sleeve.passage.notice(holder, &arms.get(side).hand, &place, reaction) != Event::None {
                (sleeve.jammed, sleeve.direction) = (0.0, 0.0);
            }
            let carried = match sleeve.passage.wearing {
                Wearing::Slipped => {
                    reaction.react(&Pull::default(), seconds);
                    return Vector::zeros();
                }
                Wearing::Missed { metres } => {
                    let drape = place.tangent * self.sizes.drape_pull(metres);
                    weight - drape * sleeve.going(&place, holder) + reaction.react(&Pull::default(), seconds)
                }
                Wearing::Off => weight + reaction.react(&Pull::default(), seconds),
                Wearing::On { metres } => {
                    let along = sleeve.along(&self.sizes, metres) * sleeve.going(&place, holder);
                    let pull = sleeve.pull(holder, &place, reaction, seconds);
                    weight * (1.0 - metres / place.length) + pull - place.tangent * along
                }
            };
            let force = carried + back.get(side);
            if force.norm() > self.sizes.slip_newtons {
                sleeve.passage.wearing = Wearing::Slipped;
                return Vector::zeros();
            }
            force
        })
    }

    fn wearing(&self) -> PerSide<Wearing> {
        self.sleeves.map(|_, sleeve| sleeve.passage.wearing)
    }

    fn snag(&mut self, side: Side, caught: bool) {
        let sleeve = self.sleeves.get_mut(side);
        sleeve.caught_at = match (caught, sleeve.caught_at, sleeve.passage.wearing) {
            (true, None, Wearing::On { metres }) => Some(metres),
            (true, before, _) => before,
            (false, ..) => None,
        };
    }

    fn slip(&mut self, side: Side) {
        self.sleeves.get_mut(side).passage.wearing = Wearing::Slipped;
    }
}

impl Sleeve {
    /// The force of a long sleeve or a catch along the arm, in newtons, with the rim at `metres`.
    fn along(&self, sizes: &GarmentSizes, metres: f64) -> f64 {
        self.caught_at.map_or_else(|| sizes.sleeve_pull(metres), |caught| sizes.snag_pull(metres - caught))
    }

    /// 1 where the gripper goes on along the arm, less where it is still or comes back: fabric then lies loose.
    fn going(&self, place: &Place, holder: &Holder) -> f64 {
        (holder.velocity.dot(&place.tangent) / FRICTION_SPEED)
            .clamp(0.0, 1.0)
            .max(f64::from(u8::from(self.caught_at.is_some())))
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

#[cfg(test)]
mod tests;
