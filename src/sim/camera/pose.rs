//! People for training and tests: bodies, postures and cameras drawn at random, and the slow movements of a recording.
//!
//! The camera looks down on a person who faces the image's lower edge, so the person's left is at large x; a camera behind
//! the person sees the same turned by half a turn, which the pose finder undoes.

use super::super::person::{ArmAngles, ArmPoints, BodySizes, Sex};
use super::look::Look;
use super::noise::PixelRandom;
use super::{Scene, looking_at};
use crate::body::{PerSide, Side};
use crate::geometry::{Point, Pose, Vector};
use crate::vision::Intrinsics;
use nalgebra::Rotation3;

/// A simulated person of a training or test set.
#[derive(Clone, Copy, Debug)]
pub struct Subject {
    /// Lengths.
    pub body: BodySizes,
    /// Outside.
    pub look: Look,
    seed: u64,
}

/// A scene with the camera that sees it.
#[derive(Clone, Debug)]
pub struct Sampled {
    /// The person and the furniture.
    pub scene: Scene,
    /// The camera's numbers.
    pub camera: Intrinsics,
}

/// What a person moves mainly, as the thesis asked participants to (section 3.5.1).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Motion {
    /// Left and right.
    Sideways,
    /// Forward and backward.
    Forward,
    /// Up and down.
    Upward,
    /// Circles in a vertical plane.
    Circle,
}

impl Motion {
    /// All four.
    pub const ALL: [Self; 4] = [Self::Sideways, Self::Forward, Self::Upward, Self::Circle];

    /// An arm's posture at a moment of the cycle (radians), with a slow second wave so that no two cycles are alike.
    fn angles(self, phase: f64, slow: f64) -> ArmAngles {
        let (wave, turned, drift) = (phase.sin(), phase.cos(), slow.sin());
        let (elevation, plane, elbow) = match self {
            Self::Sideways => (55.0 + 10.0 * drift, 35.0 - 45.0 * wave, 40.0 + 20.0 * slow.cos()),
            Self::Forward => (40.0 + 20.0 * wave, 40.0 + 35.0 * wave + 8.0 * drift, 60.0 - 30.0 * wave),
            Self::Upward => (60.0 + 40.0 * wave, 25.0 + 10.0 * drift, 30.0 + 20.0 * slow.cos()),
            Self::Circle => (60.0 + 25.0 * wave, 30.0 + 25.0 * turned, 35.0 + 15.0 * drift),
        };
        ArmAngles {
            elevation_degrees: elevation,
            plane_degrees: plane,
            rotation_degrees: 30.0 * drift,
            elbow_degrees: elbow,
        }
    }
}

impl Subject {
    /// A person drawn at random: half women, half men, sizes as in ANSUR II, looks and clothes that vary.
    #[must_use]
    pub fn sampled(seed: u64) -> Self {
        let sex = if seed.is_multiple_of(2) { Sex::Female } else { Sex::Male };
        let body = BodySizes::sampled(sex, seed);
        Self { body, look: Look::sampled(&body, seed), seed }
    }

    /// The person in a posture drawn at random, seen by a camera drawn at random.
    #[must_use]
    pub fn at_random(&self, frame: u64) -> Sampled {
        let mut random = PixelRandom(self.seed.wrapping_mul(0x51_7CC1) ^ frame.wrapping_mul(0x9E37_79B9));
        let camera = random_camera(&mut random);
        let posture = PerSide::from_fn(|_| random_angles(&mut random));
        let mut look = self.look;
        look.hand_turn = random.between(-1.6, 1.6);
        look.finger_bend = random.between(0.0, 1.5);
        let arms = self.arms(&posture, &mut random);
        Sampled { scene: Scene::seated(&arms, &look, &camera.1), camera: camera.0 }
    }

    /// The person in the middle of a recording: a camera that stays, arms that go through `motion`, `cycle` a count of
    /// cycles since the start (the other arm goes its own way more calmly).
    #[must_use]
    pub fn in_motion(&self, motion: Motion, cycle: f64) -> Sampled {
        let mut random = PixelRandom(self.seed ^ 0x00CA_3E7A);
        let (camera, mount) = random_camera(&mut random);
        let phase = cycle * std::f64::consts::TAU;
        let posture = PerSide {
            left: motion.angles(0.83 * phase + 1.0, 0.29 * phase),
            right: motion.angles(phase, 0.37 * phase + 0.5),
        };
        let arms = self.arms(&posture, &mut random);
        Sampled { scene: Scene::seated(&arms, &self.look, &mount), camera }
    }

    fn arms(&self, posture: &PerSide<ArmAngles>, random: &mut PixelRandom) -> PerSide<ArmPoints> {
        let sizes = self.body.arm_sizes();
        let half = self.body.shoulder_breadth_metres() / 2.0;
        posture.map(|side, angles| {
            let outward = if side == Side::Left { half } else { -half };
            // Raising an arm lifts its shoulder.
            let lift = 0.0007 * (angles.elevation_degrees - 40.0).max(0.0) + random.between(-0.015, 0.02);
            let shoulder = Point::new(random.between(-0.02, 0.03), outward, lift);
            let mut points = angles.points(side, &shoulder, &sizes);
            let bend = Rotation3::from_euler_angles(
                random.between(-0.5, 0.5),
                random.between(-0.6, 0.6),
                random.between(-0.5, 0.5),
            );
            points.hand = points.wrist + bend * (points.hand - points.wrist);
            points
        })
    }
}

fn random_angles(random: &mut PixelRandom) -> ArmAngles {
    let elevation = if random.uniform() < 0.35 { random.between(2.0, 40.0) } else { random.between(30.0, 125.0) };
    let plane = if elevation > 60.0 { random.between(-30.0, 100.0) } else { random.between(-50.0, 110.0) };
    ArmAngles {
        elevation_degrees: elevation,
        plane_degrees: plane,
        rotation_degrees: random.between(-70.0, 90.0),
        elbow_degrees: if random.uniform() < 0.3 { random.between(0.0, 15.0) } else { random.between(5.0, 125.0) },
    }
}

/// A camera above the neck: up to 30 degrees ahead of it, up to 50 behind, a little to a side, turned a little.
fn random_camera(random: &mut PixelRandom) -> (Intrinsics, Pose) {
    let focal = random.between(515.0, 585.0);
    let camera = Intrinsics {
        fx: focal,
        fy: focal * random.between(0.99, 1.01),
        cx: 319.5 + random.between(-8.0, 8.0),
        cy: 239.5 + random.between(-8.0, 8.0),
    };
    let neck = Point::new(0.0, 0.0, 0.08);
    let behind = random.between(-0.52, 0.6) + random.between(-0.2, 0.25);
    let aside = random.between(-0.2, 0.2);
    let distance = random.between(0.8, 1.55);
    let direction = Vector::new(-behind.sin(), aside.sin(), behind.cos()).normalize();
    let target = neck + Vector::new(random.between(-0.1, 0.25), random.between(-0.12, 0.12), -0.1);
    // Ahead of the person is down in the image.
    let roll = random.between(-0.2, 0.2);
    let up_in_image = Vector::new(-roll.cos(), roll.sin(), 0.0);
    (camera, looking_at(&(neck + direction * distance), &target, &up_in_image))
}
