//! The simulated depth camera: a fast renderer of a seated person with the true label of each pixel, and sensor noise.
//!
//! Bodies are made of cones, ellipsoids and boxes with more shape than capsules: sloping shoulders, chest, back, hands with
//! fingers, cloth with folds, lap and chair. Camera frame: x right, y down, z forward, metres. Same seed, same image.

mod body;
pub mod dataset;
mod furniture;
mod look;
mod noise;
mod pose;
mod ray;
mod render;
mod shape;

pub use body::Scene;
pub use look::Look;
pub use noise::SensorNoise;
pub use pose::{Motion, Sampled, Subject};

use super::person::{ArmPoints, SimulatedPerson};
use crate::body::PerSide;
use crate::geometry::{Point, Pose, Vector};
use crate::vision::{DepthImage, Intrinsics};

/// Size of an Xtion's images in pixels.
pub const IMAGE_SIZE: (usize, usize) = (640, 480);

/// A rendered view.
#[derive(Clone, Debug)]
pub struct Rendering {
    /// What the sensor reports.
    pub depth: DepthImage,
    /// The true label of each pixel, also where the sensor reports nothing: parts, `OTHER` for lap, chair and head, `NONE`.
    pub labels: Vec<u8>,
}

/// Where the simulated robot's camera is: on its head, looking down at the person's shoulders. Pose of the optical frame
/// in `base`.
#[must_use]
pub fn robot_mount() -> Pose {
    // The top of Baxter's screen is some 0.2 m ahead of and 0.9 m above `base`.
    looking_at(&Point::new(0.25, 0.0, 0.95), &Point::new(0.84, 0.0, 0.15), &Vector::x())
}

/// The pose of a camera at `eye` that looks at `target` with `up_in_image` pointing up in its image, as far as it can.
#[must_use]
pub fn looking_at(eye: &Point, target: &Point, up_in_image: &Vector) -> Pose {
    // nalgebra's faces z towards the target with y up; the optical frame has y down.
    let rotation = nalgebra::UnitQuaternion::face_towards(&(target - eye), &-up_in_image);
    Pose::from_parts((*eye).into(), rotation)
}

/// What the robot's camera sees of a person whose arms are at the given places (metres in `base`).
#[must_use]
pub fn view(
    person: &SimulatedPerson,
    arms: &PerSide<ArmPoints>,
    camera: &Intrinsics,
    mount: &Pose,
    seed: u64,
) -> Rendering {
    let scene = Scene::seated(arms, &Look::of(&person.body), mount);
    scene.render(camera, IMAGE_SIZE, Some(&SensorNoise::default()), seed)
}

#[cfg(test)]
mod tests;
