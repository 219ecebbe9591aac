//! From a depth image to joints: each pixel's leaves vote for where the joints are, and the densest place of the votes wins.
//!
//! This finds centres of joints, not skin, and elbows and wrists besides the thesis' four parts; on the same tree it errs by less
//! than half of the thesis' mean of pixels. A joint without enough of its own pixels near the place found is not seen: `None`.
//! Buffers are kept from frame to frame, so a frame costs no allocation once the first has been seen.

mod arm;
mod bones;
mod chain;
mod mean;
mod mode;
mod sampling;
mod trust;

pub use chain::SegmentLengths;

use super::camera::Intrinsics;
use super::depth::DepthImage;
use super::foreground::{self, Facing, Pixel, View, ViewError};
use super::part::{CLASSES, NONE, OTHER, PARTS, Part, parts_of};
use super::probe::ProbeImage;
use super::tree::{Forest, Leaf, NO_VOTE, VOTED, Vote, vote_index};
use super::walk;
use crate::body::{ArmPose, BodyPose, Evidence, Joint, JointEstimate, PerSide, Side};
use crate::geometry::{Point, Pose, Vector};
use crate::time::Stamp;
use bones::Bones;
use mode::{Mode, ModeFinder, Modes, VotePoint};
use nalgebra::Matrix3;
use sampling::Sampling;

/// A pixel whose leaves give a joint's parts less than this share has no say about it.
const LEAST_SHARE: f32 = 0.15;
/// Added to a vote's variance in square metres, so that no single leaf outweighs all others.
const VARIANCE_FLOOR: f32 = 2e-4;
/// Deviation of a joint that is found with certainty, in metres: what remains is mostly a constant for each person.
const LEAST_DEVIATION: f64 = 0.012;

/// Joints in the camera frame, in metres.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct CameraJoints {
    /// Both arms; a joint that is not seen is `None`.
    pub arms: PerSide<ArmPose>,
}

impl CameraJoints {
    /// The same joints in the robot's `base` frame, from the camera's pose in it.
    #[must_use]
    pub fn to_base(&self, camera: &Pose, stamp: Stamp) -> BodyPose {
        let turn = camera.rotation.to_rotation_matrix();
        let arms = self.arms.map(|_, arm| {
            let mut moved = ArmPose::default();
            for joint in Joint::ALL {
                moved.set(
                    joint,
                    arm.joint(joint).map(|estimate| JointEstimate {
                        position: camera * estimate.position,
                        covariance: turn * estimate.covariance * turn.transpose(),
                        ..*estimate
                    }),
                );
            }
            moved
        });
        BodyPose { stamp, arms, neck: None }
    }
}

/// A foreground pixel of those that are asked, with what its leaves say.
#[derive(Clone, Copy, Debug)]
struct Classified {
    pixel: Pixel,
    label: u8,
}

/// Finds joints in depth images with a forest.
#[derive(Debug)]
pub struct PoseFinder {
    forest: Forest,
    probe: ProbeImage,
    pixels: Vec<Pixel>,
    /// Those of them that are asked.
    asked: Vec<Pixel>,
    sampling: Sampling,
    classified: Vec<Classified>,
    /// The leaf of each pixel that went through the trees last, for each tree.
    leaves: Vec<Vec<u32>>,
    votes: [Vec<VotePoint>; VOTED],
    modes: ModeFinder,
    bones: Bones,
    lengths: SegmentLengths,
    certainty: f64,
    facing: Facing,
    camera: Intrinsics,
}

impl PoseFinder {
    /// A pose finder with a forest.
    #[must_use]
    pub fn new(forest: Forest) -> Self {
        Self {
            forest,
            probe: ProbeImage::default(),
            pixels: Vec::new(),
            asked: Vec::new(),
            sampling: Sampling::default(),
            classified: Vec::new(),
            leaves: Vec::new(),
            votes: Default::default(),
            modes: ModeFinder::default(),
            bones: Bones::default(),
            lengths: SegmentLengths::default(),
            certainty: 0.0,
            facing: Facing::default(),
            camera: Intrinsics::default(),
        }
    }

    /// Takes a person's own lengths instead of an adult's.
    pub const fn know_lengths(&mut self, lengths: SegmentLengths) {
        self.lengths = lengths;
    }

    /// The forest.
    #[must_use]
    pub const fn forest(&self) -> &Forest {
        &self.forest
    }

    /// How sure the forest was of the last image: the mean share of each pixel's most probable class, from 0 to 1.
    #[must_use]
    pub const fn certainty(&self) -> f64 {
        self.certainty
    }

    /// Finds the joints in an image.
    ///
    /// # Errors
    /// Where the image or the view cannot be used; never for a joint that is not seen.
    pub fn find(&mut self, image: &DepthImage, view: &View<'_>) -> Result<CameraJoints, ViewError> {
        view.extract(image, &mut self.probe, &mut self.pixels)?;
        self.facing = view.facing;
        let camera = view.probe_camera(image.width(), image.height());
        let neck = view.probe_neck();
        self.camera = camera;
        self.classify(&camera);
        let candidates = PerSide::from_fn(|side| self.candidates(side, &neck));
        let chosen = chain::choose(&candidates, &neck, &self.lengths);
        Ok(self.lay_bones(&neck, &chosen))
    }

    /// Finds the joints from labels that are known (as in [`super::part`], a label a pixel of the image) instead of a forest's:
    /// what the rules for joints do by themselves.
    ///
    /// # Errors
    /// As [`PoseFinder::find`].
    pub fn find_in_labels(
        &mut self,
        image: &DepthImage,
        labels: &[u8],
        view: &View<'_>,
    ) -> Result<CameraJoints, ViewError> {
        view.check(image)?;
        self.facing = view.facing;
        let (width, height) = (image.width(), image.height());
        self.camera = view.probe_camera(width, height);
        self.classified.clear();
        self.pixels.clear();
        self.sampling = Sampling::Quarter;
        for (index, (label, depth)) in labels.iter().zip(image.millimetres()).enumerate() {
            if *depth > 0 && usize::from(*label) < PARTS {
                let place = if view.facing == Facing::UpperEdge { width * height - 1 - index } else { index };
                let pixel = foreground::pixel(place % width, place / width, *depth);
                if self.sampling.asks(pixel) {
                    self.classified.push(Classified { pixel, label: *label });
                }
            }
        }
        Ok(self.lay_bones(&view.probe_neck(), &PerSide::default()))
    }

    /// Lays an arm into the skin of each side.
    fn lay_bones(&mut self, neck: &Point, known: &PerSide<[Option<Mode>; Joint::ALL.len()]>) -> CameraJoints {
        let counts = bones::Counts::of(&self.classified, self.sampling);
        let mut joints = CameraJoints::default();
        for side in Side::BOTH {
            let found =
                self.bones.lay(side, &self.classified, &counts, &self.camera, (neck, &self.lengths), known.get(side));
            for (joint, found) in Joint::ALL.into_iter().zip(found) {
                let estimate = found.is_seen().then(|| JointEstimate {
                    position: found.place,
                    covariance: found.covariance,
                    confidence: found.confidence(),
                    evidence: Evidence::Seen,
                });
                joints.arms.get_mut(side).set(joint, estimate.map(|found| turned_back(found, self.facing)));
            }
        }
        joints
    }

    /// A joint in the last image by the thesis' rule, the middle of its part (of a quarter of its pixels, evenly spread); `None` where that is not seen, and for elbow and
    /// wrist, which the thesis leaves out.
    #[must_use]
    pub fn mean_of_part(&self, side: Side, joint: Joint) -> Option<Point> {
        let found = mean::mean_of_part((&self.classified, self.sampling), &self.camera, side, joint)?;
        Some(match self.facing {
            Facing::LowerEdge => found,
            Facing::UpperEdge => Point::new(-found.x, -found.y, found.z),
        })
    }

    /// The most probable part of each pixel of the last image as it came: labels as in [`super::part`], `NONE` elsewhere.
    ///
    /// Joints need a quarter of the pixels or less; the others go through the trees only here.
    pub fn labels(&mut self, into: &mut Vec<u8>) {
        let (width, height) = (self.probe.width(), self.probe.height());
        into.clear();
        into.resize(width * height, NONE);
        walk_all(&self.forest, (&self.probe, &self.camera), &self.pixels, &mut self.leaves);
        for (index, pixel) in self.pixels.iter().enumerate() {
            let (label, _) = most(&shares(ends(&self.forest, &self.leaves, index)));
            let index = usize::from(pixel.row) * width + usize::from(pixel.column);
            let index = if self.facing == Facing::UpperEdge { width * height - 1 - index } else { index };
            if let Some(slot) = into.get_mut(index).filter(|_| label != OTHER) {
                *slot = label;
            }
        }
    }

    /// Sends the pixels that are asked through every tree; all of them vote.
    fn classify(&mut self, camera: &Intrinsics) {
        self.classified.clear();
        self.votes.iter_mut().for_each(Vec::clear);
        self.asked.clear();
        self.sampling = Sampling::of(self.pixels.len());
        self.asked.extend(self.pixels.iter().filter(|pixel| self.sampling.asks(**pixel)));
        walk_all(&self.forest, (&self.probe, camera), &self.asked, &mut self.leaves);
        let mut certain = 0_u64;
        let full = 255 * self.forest.trees().len().max(1);
        for (index, pixel) in self.asked.iter().enumerate() {
            let summed = shares(ends(&self.forest, &self.leaves, index));
            let (label, share) = most(&summed);
            certain += u64::from(share);
            self.classified.push(Classified { pixel: *pixel, label });
            let depth = f64::from(pixel.depth) / 1000.0;
            let point = camera.point(f64::from(pixel.column), f64::from(pixel.row), depth);
            let shares = joint_shares(&summed.map(|share| share as f32 / full as f32));
            let known = self.votes.iter_mut().zip(shares).enumerate().filter(|(_, (_, share))| *share >= LEAST_SHARE);
            for (joint, (list, share)) in known {
                let votes = ends(&self.forest, &self.leaves, index).filter_map(|leaf| leaf.votes.get(joint));
                list.extend(votes.filter_map(|vote| cast_vote(*vote, share, &point)));
            }
        }
        self.certainty = certain as f64 / (full * self.asked.len().max(1)) as f64;
    }

    /// The places where each joint of an arm may be.
    fn candidates(&mut self, side: Side, neck: &Point) -> [Modes; Joint::ALL.len()] {
        let (votes, modes) = (&self.votes, &mut self.modes);
        Joint::ALL
            .map(|joint| votes.get(vote_index(side, joint)).map(|votes| modes.find(votes, neck)).unwrap_or_default())
    }
}

/// Sends pixels through every tree.
#[expect(clippy::cast_possible_truncation, reason = "a ratio of focal lengths")]
fn walk_all(
    forest: &Forest,
    (probe, camera): (&ProbeImage, &Intrinsics),
    pixels: &[Pixel],
    leaves: &mut Vec<Vec<u32>>,
) {
    let ratio = (camera.fx / forest.focal) as f32;
    leaves.resize_with(forest.trees().len(), Vec::new);
    for (tree, leaves) in forest.trees().iter().zip(leaves) {
        walk::leaves(tree, probe, pixels, ratio, leaves);
    }
}

/// The leaves that a pixel ends in, one a tree.
fn ends<'a>(forest: &'a Forest, leaves: &'a [Vec<u32>], index: usize) -> impl Iterator<Item = &'a Leaf> {
    let trees = forest.trees().iter().zip(leaves);
    trees.filter_map(move |(tree, leaves)| leaves.get(index).and_then(|number| tree.leaf_content(*number)))
}

/// The summed shares of each class in leaves, in 255ths.
fn shares<'a>(leaves: impl Iterator<Item = &'a Leaf>) -> [u32; CLASSES] {
    let mut shares = [0_u32; CLASSES];
    for leaf in leaves {
        shares.iter_mut().zip(leaf.shares).for_each(|(sum, share)| *sum += u32::from(share));
    }
    shares
}

/// The most probable class and its summed share; of equal ones the lowest.
fn most(shares: &[u32; CLASSES]) -> (u8, u32) {
    (0_u8..).zip(shares).fold((0, 0), |best, (class, share)| if *share > best.1 { (class, *share) } else { best })
}

/// What a pixel's shares say of each joint: the sum over the joint's parts.
fn joint_shares(shares: &[f32; CLASSES]) -> [f32; VOTED] {
    let mut of_joints = [0.0; VOTED];
    for side in Side::BOTH {
        for joint in Joint::ALL {
            let parts = parts_of(joint).iter();
            let share =
                parts.map(|part: &Part| shares.get(usize::from(part.label(side))).copied().unwrap_or(0.0)).sum();
            if let Some(slot) = of_joints.get_mut(vote_index(side, joint)) {
                *slot = share;
            }
        }
    }
    of_joints
}

/// A leaf's vote for a joint that its pixel's `share` knows about.
#[expect(clippy::cast_possible_truncation, reason = "single precision is plenty for metres")]
fn cast_vote(vote: Vote, share: f32, point: &Point) -> Option<VotePoint> {
    if vote.deviation == NO_VOTE {
        return None;
    }
    let deviation = f32::from(vote.deviation) / 1000.0;
    let [x, y, z] = vote.offset.map(|value| f32::from(value) / 1000.0);
    let depth = point.z as f32;
    Some(VotePoint {
        place: [point.x as f32 + x, point.y as f32 + y, depth + z],
        weight: share * depth * depth / (deviation * deviation + VARIANCE_FLOOR),
    })
}

/// An estimate in the camera frame of the image as it came.
fn turned_back(found: JointEstimate, facing: Facing) -> JointEstimate {
    if facing == Facing::LowerEdge {
        return found;
    }
    let half_turn = Matrix3::from_diagonal(&Vector::new(-1.0, -1.0, 1.0));
    JointEstimate {
        position: Point::from(half_turn * found.position.coords),
        covariance: half_turn * found.covariance * half_turn,
        ..found
    }
}
