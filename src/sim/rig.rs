//! A gripper on a rig instead of a robot's arm: the same person, garment and wrench estimate, without joints.
//!
//! Forces of the garments are compared and timed here, where nothing else can change them: the gripper is exactly where it is
//! told to be. It never plans; whoever uses it moves it along a path at a speed that the robot could reach.

use super::garment::{Garment, Holder};
use super::person::{ArmPoints, Reaction};
use super::random::{Purpose, Random};
use super::world::{SimError, WorldSetup};
use super::wrench::WrenchSense;
use crate::body::{PerSide, Side};
use crate::geometry::{Point, Vector, Wrench};
use crate::kinematics::waiting_place;

/// The rig's beat in seconds: the robot's wrench comes at 100 Hz.
pub const BEAT_SECONDS: f64 = 0.01;

/// One gripper, one sleeve, one arm.
#[derive(Debug)]
pub struct Rig {
    side: Side,
    garment: Box<dyn Garment>,
    arms: PerSide<ArmPoints>,
    reactions: PerSide<Reaction>,
    sense: WrenchSense,
    tip: Point,
    velocity: Vector,
    other: Holder,
}

impl Rig {
    /// A rig whose gripper begins at the hand of the person's arm of a side.
    ///
    /// # Errors
    /// A person, garment or sense that cannot be.
    pub fn new(setup: &WorldSetup, side: Side) -> Result<Self, SimError> {
        setup.check()?;
        let arms = setup.person.posture();
        let purpose = |side| if side == Side::Left { Purpose::LeftArm } else { Purpose::RightArm };
        let reactions = PerSide::from_fn(|side| {
            let random = Random::new(setup.seed, purpose(side));
            Reaction::of(&setup.person.arm(side), setup.preferred_path(side), random)
        });
        let waiting = waiting_place(&arms.get(side).shoulder);
        Ok(Self {
            side,
            garment: setup.garment_model(),
            tip: arms.get(side).hand,
            arms,
            reactions,
            sense: WrenchSense::new(setup.wrench, Random::new(setup.seed, Purpose::RightWrench)),
            velocity: Vector::zeros(),
            other: Holder { tip: waiting, velocity: Vector::zeros() },
        })
    }

    /// Where hand, elbow and shoulder are in the posture in which the person waits, in metres in `base`.
    #[must_use]
    pub const fn dressed(&self) -> [Point; 3] {
        self.arms.get(self.side).dressed()
    }

    /// Puts the gripper at a place one beat later and returns the wrench as the robot would give it.
    pub fn place(&mut self, tip: Point) -> Wrench {
        let velocity = (tip - self.tip) / BEAT_SECONDS;
        let acceleration = (velocity - self.velocity) / BEAT_SECONDS;
        (self.tip, self.velocity) = (tip, velocity);
        let own = Holder { tip, velocity };
        let holders = PerSide::from_fn(|side| if side == self.side { own } else { self.other });
        let arms = PerSide::from_fn(|side| {
            let mut arm = *self.arms.get(side);
            arm.elbow += self.reactions.get(side).displacement();
            arm
        });
        let forces = self.garment.step(BEAT_SECONDS, &holders, &arms, &mut self.reactions);
        self.sense.report(forces.get(self.side), &tip, &acceleration, BEAT_SECONDS)
    }
}
