//! Labelled images of simulated people: to train forests on, and to judge them by.

use super::{IMAGE_SIZE, Rendering, Sampled, SensorNoise, Subject};
use crate::body::{Joint, Side};
use crate::geometry::Point;
use crate::vision::foreground::Facing;
use crate::vision::part::{NONE, OTHER, PARTS};
use crate::vision::probe::ProbeImage;
use crate::vision::training::{Example, TrainingSet};
use crate::vision::tree::{VOTED, vote_index};
use crate::vision::{DepthImage, PoseFinder, View, ViewError};
use rayon::prelude::*;

/// An operator measures the distance to the neck this well, in metres to either side.
const NECK_ERROR: f64 = 0.02;
/// A joint is covered where fewer pixels of its own parts than this are in the image.
const COVERED_PIXELS: usize = 20;

/// An image with everything that is true of it.
#[derive(Clone, Debug)]
pub struct Labelled {
    /// Image and labels.
    pub rendering: Rendering,
    /// The empty scene, where one was taken.
    pub empty: Option<DepthImage>,
    /// The scene.
    pub sampled: Sampled,
    /// The neck as measured.
    pub neck: Point,
}

impl Labelled {
    /// Renders a scene with noise, and the empty scene where `with_empty`.
    #[must_use]
    pub fn render(sampled: Sampled, with_empty: bool, seed: u64) -> Self {
        let noise = Some(SensorNoise::default());
        let rendering = sampled.scene.render(&sampled.camera, IMAGE_SIZE, noise.as_ref(), seed);
        let empty = with_empty
            .then(|| sampled.scene.empty().render(&sampled.camera, IMAGE_SIZE, noise.as_ref(), seed ^ 0xE0).depth);
        let mut neck = sampled.scene.neck();
        neck.z += NECK_ERROR * ((seed.wrapping_mul(0x9E37_79B9) % 2001) as f64 / 1000.0 - 1.0);
        Self { rendering, empty, sampled, neck }
    }

    /// What a pose finder is told.
    #[must_use]
    pub const fn view(&self) -> View<'_> {
        View { camera: self.sampled.camera, neck: self.neck, empty: self.empty.as_ref(), facing: Facing::LowerEdge }
    }

    /// The joints' true centres, in the order of a leaf's votes.
    #[must_use]
    pub fn joints(&self) -> [Point; VOTED] {
        let mut joints = [Point::origin(); VOTED];
        for side in Side::BOTH {
            for joint in Joint::ALL {
                if let Some(slot) = joints.get_mut(vote_index(side, joint)) {
                    *slot = self.sampled.scene.joint(side, joint);
                }
            }
        }
        joints
    }

    /// Adds the image's samples to a training set.
    ///
    /// # Errors
    /// Where the foreground cannot be taken.
    pub fn add_to(&self, set: &mut TrainingSet, seed: u64) -> Result<(), ViewError> {
        let (mut image, mut pixels) = (ProbeImage::default(), Vec::new());
        self.view().extract(&self.rendering.depth, &mut image, &mut pixels)?;
        let labels = &self.rendering.labels;
        set.add(&Example { image: &image, labels, camera: self.sampled.camera, joints: self.joints() }, seed);
        Ok(())
    }
}

/// A person of a set and one of that person's frames.
#[derive(Clone, Copy, Debug)]
pub struct Frame {
    /// The person's seed.
    pub person: u64,
    /// The frame's number.
    pub number: u64,
}

impl Frame {
    /// The frames of a number of images, each person giving `per_person` of them, from a first person on.
    pub fn list(images: u64, per_person: u64, first_person: u64) -> impl Iterator<Item = Self> {
        let per_person = per_person.max(1);
        (0..images).map(move |number| Self { person: first_person + number / per_person, number })
    }

    /// A posture, camera and noise drawn at random; every second frame with an empty scene.
    #[must_use]
    pub fn render(self) -> Labelled {
        let sampled = Subject::sampled(self.person).at_random(self.number);
        Labelled::render(sampled, self.number.is_multiple_of(2), self.person ^ (self.number << 20))
    }
}

/// Renders frames on all cores and draws samples from them; the order of the frames decides the set, not the threads.
pub fn training_set(frames: &[Frame], focal: f64, per_part: usize, progress: &(dyn Fn() + Sync)) -> TrainingSet {
    let pieces: Vec<TrainingSet> = frames
        .par_iter()
        .map(|frame| {
            let mut piece = TrainingSet::new(focal, per_part);
            // A frame in which nobody is seen teaches nothing.
            let _ = frame.render().add_to(&mut piece, frame.number);
            progress();
            piece
        })
        .collect();
    let mut set = TrainingSet::new(focal, per_part);
    for piece in pieces {
        set.append(piece);
    }
    set
}

/// How well a forest does on images whose truth is known.
#[derive(Clone, Debug, Default)]
pub struct Score {
    /// Pixels of a part by truth and by foreground, and how many of them got their part.
    pub pixels: (u64, u64),
    /// The same for each part.
    pub parts: [(u64, u64); PARTS],
    /// Pixels that are a part's by truth, those said to be some part's, and those that are both.
    pub foreground: (u64, u64, u64),
    /// Distance from each seen joint to its true centre in metres.
    pub errors: [Vec<f64>; Joint::ALL.len()],
    /// The same for the thesis' mean of the part.
    pub mean_errors: [Vec<f64>; Joint::ALL.len()],
    /// Joints that are covered, and how many of them were said to be not seen.
    pub covered: (u64, u64),
    /// Joints that can be seen, and how many of them were said to be seen.
    pub visible: (u64, u64),
}

impl Score {
    /// Judges one image.
    ///
    /// # Errors
    /// Where the image cannot be used.
    pub fn judge(&mut self, finder: &mut PoseFinder, image: &Labelled) -> Result<(), ViewError> {
        let joints = finder.find(&image.rendering.depth, &image.view())?;
        let mut labels = Vec::new();
        finder.labels(&mut labels);
        let mut own = [0_usize; PARTS];
        let readings = image.rendering.depth.millimetres();
        for ((truth, found), reading) in image.rendering.labels.iter().zip(&labels).zip(readings) {
            let is_part = usize::from(*truth) < PARTS && *reading > 0;
            self.foreground.0 += u64::from(is_part);
            self.foreground.1 += u64::from(*found != NONE);
            self.foreground.2 += u64::from(is_part && *found != NONE);
            let Some(part) = self.parts.get_mut(usize::from(*truth)).filter(|_| is_part) else { continue };
            if let Some(count) = own.get_mut(usize::from(*truth)) {
                *count += 1;
            }
            part.0 += 1;
            part.1 += u64::from(truth == found);
            self.pixels.0 += 1;
            self.pixels.1 += u64::from(truth == found);
        }
        for (side, arm) in joints.arms.iter() {
            for joint in Joint::ALL {
                let pixels: usize = crate::vision::part::parts_of(joint)
                    .iter()
                    .map(|part| own.get(usize::from(part.label(side))).copied().unwrap_or(0))
                    .sum();
                let truth = image.sampled.scene.joint(side, joint);
                self.joint(arm.position(joint), joint, &truth, pixels);
                let mean = finder.mean_of_part(side, joint).filter(|_| pixels >= COVERED_PIXELS);
                if let (Some(mean), Some(errors)) = (mean, self.mean_errors.get_mut(joint.index())) {
                    errors.push((mean - truth).norm());
                }
            }
        }
        Ok(())
    }

    fn joint(&mut self, found: Option<Point>, joint: Joint, truth: &Point, pixels: usize) {
        if pixels < COVERED_PIXELS {
            self.covered.0 += 1;
            self.covered.1 += u64::from(found.is_none());
            return;
        }
        self.visible.0 += 1;
        let Some(found) = found else { return };
        self.visible.1 += 1;
        if let Some(errors) = self.errors.get_mut(joint.index()) {
            errors.push((found - truth).norm());
        }
    }

    /// Takes another score in.
    pub fn add(&mut self, other: &Self) {
        let sum = |into: &mut (u64, u64), from: &(u64, u64)| *into = (into.0 + from.0, into.1 + from.1);
        sum(&mut self.pixels, &other.pixels);
        sum(&mut self.covered, &other.covered);
        sum(&mut self.visible, &other.visible);
        self.parts.iter_mut().zip(&other.parts).for_each(|(into, from)| sum(into, from));
        self.foreground.0 += other.foreground.0;
        self.foreground.1 += other.foreground.1;
        self.foreground.2 += other.foreground.2;
        self.errors.iter_mut().zip(&other.errors).for_each(|(into, from)| into.extend(from));
        self.mean_errors.iter_mut().zip(&other.mean_errors).for_each(|(into, from)| into.extend(from));
    }

    /// Share of pixels that got their part, over all pixels.
    #[must_use]
    pub fn accuracy(&self) -> f64 {
        share(self.pixels.1, self.pixels.0)
    }

    /// The same, as the mean over parts.
    #[must_use]
    pub fn accuracy_over_parts(&self) -> f64 {
        let seen = self.parts.iter().filter(|part| part.0 > 0);
        let count = seen.clone().count().max(1);
        seen.map(|(all, right)| share(*right, *all)).sum::<f64>() / count as f64
    }

    /// Precision and recall of "belongs to some part".
    #[must_use]
    pub fn foreground_precision_recall(&self) -> (f64, f64) {
        (share(self.foreground.2, self.foreground.1), share(self.foreground.2, self.foreground.0))
    }

    /// Mean and 95th percentile of the errors of one joint, or of all, in metres.
    #[must_use]
    pub fn error(&self, joint: Option<Joint>) -> (f64, f64) {
        mean_and_most(&self.errors, joint)
    }

    /// The same for the thesis' mean of the part.
    #[must_use]
    pub fn mean_error(&self, joint: Option<Joint>) -> (f64, f64) {
        mean_and_most(&self.mean_errors, joint)
    }
}

fn mean_and_most(errors: &[Vec<f64>; Joint::ALL.len()], joint: Option<Joint>) -> (f64, f64) {
    let mut errors: Vec<f64> = match joint {
        Some(joint) => errors.get(joint.index()).cloned().unwrap_or_default(),
        None => errors.concat(),
    };
    if errors.is_empty() {
        return (f64::NAN, f64::NAN);
    }
    errors.sort_by(f64::total_cmp);
    let mean = errors.iter().sum::<f64>() / errors.len() as f64;
    (mean, errors.get(errors.len() * 95 / 100).copied().unwrap_or(f64::NAN))
}

fn share(part: u64, whole: u64) -> f64 {
    part as f64 / whole.max(1) as f64
}

const _: () = assert!(OTHER as usize >= PARTS);
