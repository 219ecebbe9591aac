//! Training samples: pixels drawn evenly from each part of each image, with their images cropped to the foreground.

use super::super::camera::Intrinsics;
use super::super::part::CLASSES;
use super::super::probe::{Feature, ProbeImage};
use super::super::tree::VOTED;
use super::mix;
use crate::geometry::{Point, Vector};
use rand::seq::IndexedRandom;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

/// A labelled image to learn from.
#[derive(Clone, Copy, Debug)]
pub struct Example<'a> {
    /// Foreground only.
    pub image: &'a ProbeImage,
    /// Row-major labels of the image's pixels: parts and `OTHER`; others are not learnt from.
    pub labels: &'a [u8],
    /// The camera.
    pub camera: Intrinsics,
    /// Joint centres in the camera frame; NaN where a joint's place is not known.
    pub joints: [Point; VOTED],
}

/// A pixel to learn from.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sample {
    pub(super) image: u32,
    column: u16,
    row: u16,
    depth: u16,
    pub(super) label: u8,
}

#[derive(Clone, Debug)]
struct Cropped {
    image: ProbeImage,
    corner: (usize, usize),
    camera: Intrinsics,
    joints: [Point; VOTED],
}

/// Samples with the images they come from.
#[derive(Clone, Debug)]
pub struct TrainingSet {
    focal: f64,
    per_part: usize,
    images: Vec<Cropped>,
    samples: Vec<Sample>,
}

impl TrainingSet {
    /// An empty set for a model of the given focal length, `per_part` pixels of each part of an image (the thesis: 63).
    #[must_use]
    pub const fn new(focal: f64, per_part: usize) -> Self {
        Self { focal, per_part, images: Vec::new(), samples: Vec::new() }
    }

    /// Number of images.
    #[must_use]
    pub fn image_count(&self) -> usize {
        self.images.len()
    }

    /// The focal length of the model.
    #[must_use]
    pub const fn focal(&self) -> f64 {
        self.focal
    }

    pub(super) fn samples(&self) -> &[Sample] {
        &self.samples
    }

    /// Joins another set's images to this one's.
    pub fn append(&mut self, other: Self) {
        let first = to_u32(self.images.len());
        self.images.extend(other.images);
        self.samples.extend(other.samples.into_iter().map(|sample| Sample { image: sample.image + first, ..sample }));
    }

    /// Draws an image's samples: the same number from each part that it shows, again and again where a part is small.
    pub fn add(&mut self, example: &Example<'_>, seed: u64) {
        let mut pixels: [Vec<(u16, u16)>; CLASSES] = Default::default();
        let width = example.image.width();
        let mut window = (usize::MAX, usize::MAX, 0, 0);
        for (index, label) in example.labels.iter().enumerate() {
            let (column, row) = (index % width, index / width);
            if !example.image.is_foreground(column, row) {
                continue;
            }
            window = (window.0.min(column), window.1.min(row), window.2.max(column), window.3.max(row));
            if let Some(pixels) = pixels.get_mut(usize::from(*label)) {
                pixels.push((to_u16(column), to_u16(row)));
            }
        }
        if window.0 > window.2 {
            return;
        }
        let mut random = ChaCha8Rng::seed_from_u64(mix(seed, self.images.len() as u64));
        let (image, corner) = example.image.cropped((window.0, window.1), (window.2 + 1, window.3 + 1));
        for (label, pixels) in (0_u8..).zip(&pixels) {
            self.draw(example, label, pixels, corner, &mut random);
        }
        self.images.push(Cropped { image, corner, camera: example.camera, joints: example.joints });
    }

    fn draw(
        &mut self,
        example: &Example<'_>,
        label: u8,
        pixels: &[(u16, u16)],
        corner: (usize, usize),
        random: &mut ChaCha8Rng,
    ) {
        let image = to_u32(self.images.len());
        let sample = |&(column, row): &(u16, u16)| Sample {
            image,
            column: column - to_u16(corner.0),
            row: row - to_u16(corner.1),
            depth: example.image.at(f32::from(column), f32::from(row)),
            label,
        };
        if pixels.len() >= self.per_part {
            let drawn = pixels.sample(random, self.per_part);
            self.samples.extend(drawn.map(sample));
        } else if !pixels.is_empty() {
            let drawn = (0..self.per_part).filter_map(|_| pixels.get(random.random_range(0..pixels.len())));
            self.samples.extend(drawn.map(sample));
        }
    }

    /// A sample's response to a feature.
    #[inline]
    pub(super) fn response(&self, sample: &Sample, feature: &Feature) -> i32 {
        self.images
            .get(sample.image as usize)
            .map_or(0, |image| image.image.response(sample.place(), sample.per_metre(image, self.focal), feature))
    }

    /// What [`TrainingSet::response`] needs of a sample, once for many features: image, place, 1/z.
    pub(super) fn view(&self, sample: &Sample) -> Option<(&ProbeImage, (f32, f32), f32)> {
        let image = self.images.get(sample.image as usize)?;
        Some((&image.image, sample.place(), sample.per_metre(image, self.focal)))
    }

    /// From a sample's point to each joint, in metres.
    pub(super) fn joint_offsets(&self, sample: &Sample) -> [Vector; VOTED] {
        let Some(image) = self.images.get(sample.image as usize) else { return [Vector::repeat(f64::NAN); VOTED] };
        let (column, row) = (usize::from(sample.column) + image.corner.0, usize::from(sample.row) + image.corner.1);
        let point = image.camera.point(column as f64, row as f64, f64::from(sample.depth) / 1000.0);
        image.joints.map(|joint| joint - point)
    }
}

impl Sample {
    const fn place(&self) -> (f32, f32) {
        (self.column as f32, self.row as f32)
    }

    #[expect(clippy::cast_possible_truncation, reason = "a ratio near one")]
    fn per_metre(&self, image: &Cropped, focal: f64) -> f32 {
        1000.0 / f32::from(self.depth.max(1)) * (image.camera.fx / focal) as f32
    }
}

#[expect(clippy::cast_possible_truncation, reason = "images have at most 4096 pixels a side")]
const fn to_u16(value: usize) -> u16 {
    value as u16
}

#[expect(clippy::cast_possible_truncation, reason = "far fewer images than that")]
const fn to_u32(value: usize) -> u32 {
    value as u32
}
