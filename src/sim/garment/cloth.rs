//! The believable garment: an armhole of cloth round a moving arm, on rapier's soft bodies.
//!
//! Each sleeve has a physical world of its own, which begins when the armhole goes onto the hand: a free-hanging loop would
//! collapse and miss it. Forces on the grippers are the reactions of the cloth's attachments. Single precision, as rapier's;
//! the same build on the same machine repeats to the last bit.

mod sleeve;

use super::super::person::{ArmPoints, ArmSizes, Pull, Reaction};
use super::passage::{Event, Passage, Place};
use super::{GRAVITY, Garment, GarmentSizes, Holder, Wearing};
use crate::body::{PerSide, Side};
use crate::geometry::Vector;
use sleeve::ClothSleeve;

/// Steps of the cloth in one step of the world: 5 ms each at 100 Hz.
const SUBSTEPS: u32 = 2;
/// A person feels a pull beyond this, in newtons: a light touch of cloth is not answered.
const FELT: f64 = 3.0;
/// All that a sleeve can do to a gripper before the fabric gives, in newtons.
const CEILING: f64 = 60.0;

/// The garment of cloth.
#[derive(Debug)]
pub struct ClothGarment {
    sizes: GarmentSizes,
    arm: ArmSizes,
    sleeves: PerSide<Worn>,
}

#[derive(Debug, Default)]
struct Worn {
    passage: Passage,
    cloth: Option<ClothSleeve>,
}

impl ClothGarment {
    /// A garment held by both grippers, on nobody, for arms of the given sizes.
    #[must_use]
    pub fn new(sizes: GarmentSizes, arm: ArmSizes) -> Self {
        Self { sizes, arm, sleeves: PerSide::default() }
    }
}

impl Garment for ClothGarment {
    fn step(
        &mut self,
        seconds: f64,
        holders: &PerSide<Holder>,
        arms: &PerSide<ArmPoints>,
        reactions: &mut PerSide<Reaction>,
    ) -> PerSide<Vector> {
        let back = self.sizes.back_forces(holders, &self.wearing());
        let weight = -Vector::z() * (self.sizes.mass_kilograms * GRAVITY / 2.0);
        let (sizes, arm_sizes) = (&self.sizes, &self.arm);
        PerSide::from_fn(|side| {
            let worn = self.sleeves.get_mut(side);
            let (holder, reaction, arm) = (holders.get(side), reactions.get_mut(side), arms.get(side));
            let Some(place) = Place::on(reaction.path(), &holder.tip) else { return Vector::zeros() };
            match worn.passage.notice(holder, &arm.hand, &place, reaction) {
                Event::PutOn => worn.cloth = Some(ClothSleeve::new(sizes, arm_sizes, arm, &holder.tip)),
                Event::TakenOff => worn.cloth = None,
                Event::None | Event::Returned => {}
            }
            let pull = match (worn.passage.wearing, &mut worn.cloth) {
                (Wearing::On { .. }, Some(cloth)) => worn_force(cloth, seconds, holder, arm, &place, reaction),
                (Wearing::Slipped, _) => {
                    reaction.react(&Pull::default(), seconds);
                    return Vector::zeros();
                }
                _ => weight + reaction.react(&Pull::default(), seconds),
            };
            let force = pull + back.get(side);
            if force.norm() > sizes.slip_newtons {
                worn.passage.wearing = Wearing::Slipped;
                worn.cloth = None;
                return Vector::zeros();
            }
            force
        })
    }

    fn wearing(&self) -> PerSide<Wearing> {
        self.sleeves.map(|_, worn| worn.passage.wearing)
    }

    fn snag(&mut self, side: Side, caught: bool) {
        if let Some(cloth) = &mut self.sleeves.get_mut(side).cloth {
            cloth.snag(caught);
        }
    }

    fn slip(&mut self, side: Side) {
        let worn = self.sleeves.get_mut(side);
        (worn.passage.wearing, worn.cloth) = (Wearing::Slipped, None);
    }
}

/// Moves sleeve and arm on, and returns the force on the gripper in newtons.
fn worn_force(
    cloth: &mut ClothSleeve,
    seconds: f64,
    holder: &Holder,
    arm: &ArmPoints,
    place: &Place,
    reaction: &mut Reaction,
) -> Vector {
    let middle = reaction.path().get(reaction.path().len() / 2).copied().unwrap_or(arm.elbow);
    // The person moves towards the preferred movement while the sleeve passes the forearm.
    let share = (place.along / 0.15).clamp(0.0, 1.0);
    let elbow = arm.elbow + (middle - arm.elbow) * share;
    let force = cloth.advance(seconds, SUBSTEPS, holder, &elbow, &arm.hand).cap_magnitude(CEILING);
    let across = force - place.tangent * force.dot(&place.tangent);
    let felt = (across.norm() - FELT).max(0.0) / reaction.response().lateral_stiffness_newtons_per_metre;
    let excess = across.try_normalize(1e-9).map_or_else(Vector::zeros, |direction| direction * felt);
    let forward = holder.velocity.dot(&place.tangent);
    let reflex = reaction.react(&Pull { excess, speed: holder.velocity.norm(), advancing: forward > 0.01 }, seconds);
    cloth.stiffen(reflex);
    force
}

#[cfg(test)]
mod tests;
