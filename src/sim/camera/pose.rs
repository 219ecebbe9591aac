//! People for training and tests: bodies, postures and cameras drawn at random, and the slow movements of a recording.
//!
//! The camera looks down on a person who faces the image's lower edge, so the person's left is at large x; a camera behind
//! the person sees the same turned by half a turn, which the pose finder undoes.

use super::super::person::{ArmAngles, ArmPoints, BodySizes, Sex};
use super::look::Look;
use super::noise::PixelRandom;
use super::{Scene, looking_at};
use crate::body::{PerSide, Side};
use crate::geometry::{Point, Pose, Vector, closest_on_segment};
use crate::vision::Intrinsics;
use nalgebra::Rotation3;

/// Half the thickness of a forearm or hand, in metres: arms keep so far from the body and from each other.
const LIMB: f64 = 0.035;
/// Postures that run through the body are drawn again, so often at most.
const MOST_TRIES: usize = 50;

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
        let mut look = self.look;
        look.hand_turn = random.between(-1.6, 1.6);
        look.finger_bend = random.between(0.0, 1.5);
        let mut arms = self.arms(&PerSide::from_fn(|_| random_angles(&mut random)), &mut random);
        for _ in 0..MOST_TRIES {
            if self.is_free(&arms) {
                break;
            }
            arms = self.arms(&PerSide::from_fn(|_| random_angles(&mut random)), &mut random);
        }
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

    /// Whether neither arm runs through the trunk, the thighs, the head or the other arm.
    fn is_free(&self, arms: &PerSide<ArmPoints>) -> bool {
        let half = self.body.shoulder_breadth_metres() / 2.0;
        let depth = self.look.chest_depth.max(self.look.belly);
        let in_trunk = |point: &Point| {
            let (ahead, aside) = (point.x / (depth + LIMB), point.y / (half * 0.95 + 0.5 * LIMB));
            point.z < 0.0 && point.z > -0.6 && ahead * ahead + aside * aside < 1.0
        };
        let in_lap = |point: &Point| point.z < -0.53 + self.look.thigh && point.x > -0.1 && point.y.abs() < 0.24;
        let in_head = |point: &Point| (point - Point::new(0.02, 0.0, 0.22)).norm() < 0.12 + LIMB;
        let arm_free = |points: &ArmPoints| {
            let middle = nalgebra::center(&points.elbow, &points.wrist);
            [points.elbow, middle, points.wrist, points.hand]
                .iter()
                .all(|point| !in_trunk(point) && !in_lap(point) && !in_head(point))
        };
        let between = [(arms.left.elbow, arms.left.wrist), (arms.left.wrist, arms.left.hand)];
        let crossed = between.iter().any(|(start, end)| {
            [arms.right.elbow, arms.right.wrist, arms.right.hand]
                .iter()
                .any(|point| (closest_on_segment(point, start, end) - point).norm() < 2.0 * LIMB)
        });
        arm_free(&arms.left) && arm_free(&arms.right) && !crossed
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

/// Postures of somebody who sits and waits, moves an arm when asked to, or is being dressed; some are beyond that.
fn random_angles(random: &mut PixelRandom) -> ArmAngles {
    let kind = random.uniform();
    if kind < 0.2 {
        return resting(random);
    }
    let wide = kind > 0.85;
    let elevation = if wide { random.between(30.0, 125.0) } else { random.between(8.0, 100.0) };
    let backward = if elevation > 60.0 { -15.0 } else { -40.0 };
    ArmAngles {
        elevation_degrees: elevation,
        plane_degrees: random.between(backward, if wide { 105.0 } else { 90.0 }),
        rotation_degrees: if wide { random.between(-70.0, 90.0) } else { random.between(-40.0, 60.0) },
        elbow_degrees: if random.uniform() < 0.25 { random.between(0.0, 15.0) } else { random.between(5.0, 115.0) },
    }
}

/// Arms that hang, or lie in the lap or on rests.
fn resting(random: &mut PixelRandom) -> ArmAngles {
    ArmAngles {
        elevation_degrees: random.between(3.0, 35.0),
        plane_degrees: random.between(-30.0, 80.0),
        rotation_degrees: random.between(-45.0, 25.0),
        elbow_degrees: random.between(5.0, 100.0),
    }
}

/// A camera above the neck: up to 26 degrees ahead of it, up to 49 behind, a little to a side, turned a little.
fn random_camera(random: &mut PixelRandom) -> (Intrinsics, Pose) {
    let focal = random.between(515.0, 585.0);
    let camera = Intrinsics {
        fx: focal,
        fy: focal * random.between(0.99, 1.01),
        cx: 319.5 + random.between(-8.0, 8.0),
        cy: 239.5 + random.between(-8.0, 8.0),
    };
    let neck = Point::new(0.0, 0.0, 0.08);
    let behind = random.between(-0.35, 0.7) + random.between(-0.1, 0.15);
    let aside = random.between(-0.2, 0.2);
    let distance = random.between(0.8, 1.55);
    let direction = Vector::new(-behind.sin(), aside.sin(), behind.cos()).normalize();
    let target = neck + Vector::new(random.between(-0.1, 0.25), random.between(-0.12, 0.12), -0.1);
    // Ahead of the person is down in the image.
    let roll = random.between(-0.2, 0.2);
    let up_in_image = Vector::new(-roll.cos(), roll.sin(), 0.0);
    (camera, looking_at(&(neck + direction * distance), &target, &up_in_image))
}
