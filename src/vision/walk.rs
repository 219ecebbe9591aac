//! Many pixels through one tree: the same leaves as [`Tree::leaf`] finds one by one, with the waiting for memory shared.
//!
//! Uses vector instructions where the machine has them (AVX2), else several pixels side by side. Both give the same leaves.

#[cfg(target_arch = "x86_64")]
mod vector;

use super::foreground::Pixel;
use super::probe::{PLANES, Plane, ProbeImage};
use super::tree::{LEAF, Tree};

/// Pixels that walk side by side without vector instructions.
const SIDE_BY_SIDE: usize = 16;

/// The number of the leaf that each pixel ends in. `ratio` is the camera's focal length over the model's.
pub fn leaves(tree: &Tree, image: &ProbeImage, pixels: &[Pixel], ratio: f32, into: &mut Vec<u32>) {
    into.clear();
    #[cfg(target_arch = "x86_64")]
    let rest = pixels.get(vector::leaves(tree, image, pixels, ratio, into)..).unwrap_or(&[]);
    #[cfg(not(target_arch = "x86_64"))]
    let rest = pixels;
    plain_leaves(tree, image, rest, ratio, into);
}

/// Work that the compiler may turn into vector instructions. `run` and all that it is to profit for must be inlined always:
/// only then is it compiled for the instructions of the place that it is inlined into.
pub(super) trait Work {
    /// What comes out.
    type Outcome;
    /// Does it.
    fn run(self) -> Self::Outcome;
}

/// Runs work, compiled for vector instructions where the machine has them.
pub(super) fn with_vector_instructions<W: Work>(work: W) -> W::Outcome {
    #[cfg(target_arch = "x86_64")]
    return vector::run(work);
    #[cfg(not(target_arch = "x86_64"))]
    work.run()
}

/// [`leaves`] without vector instructions; adds to the list.
pub fn plain_leaves(tree: &Tree, image: &ProbeImage, pixels: &[Pixel], ratio: f32, into: &mut Vec<u32>) {
    let planes = image.planes();
    for group in pixels.chunks(SIDE_BY_SIDE) {
        let mut walkers = [Walker::default(); SIDE_BY_SIDE];
        for (walker, pixel) in walkers.iter_mut().zip(group) {
            *walker = Walker {
                place: (f32::from(pixel.column), f32::from(pixel.row)),
                per_metre: per_metre(*pixel, ratio),
                next: 0,
            };
        }
        while walkers.iter_mut().fold(false, |walking, walker| walker.step(tree, image, &planes) | walking) {}
        into.extend(walkers.iter().take(group.len()).map(|walker| walker.next & !LEAF));
    }
}

/// A pixel on its way through a tree; one that has ended in a leaf by default.
#[derive(Clone, Copy, Debug)]
struct Walker {
    place: (f32, f32),
    per_metre: f32,
    next: u32,
}

impl Default for Walker {
    fn default() -> Self {
        Self { place: (0.0, 0.0), per_metre: 0.0, next: LEAF }
    }
}

impl Walker {
    /// One level down; false in a leaf.
    #[inline]
    fn step(&mut self, tree: &Tree, image: &ProbeImage, planes: &[Plane; PLANES]) -> bool {
        if self.next & LEAF != 0 {
            return false;
        }
        // Loading has checked every index; a leaf of number 0 stands in all the same.
        let Some(node) = tree.nodes.get(self.next as usize) else {
            self.next = LEAF;
            return false;
        };
        if node.next & LEAF != 0 {
            self.next = node.next;
            return false;
        }
        // So are numbers of planes; by default all places are the upper border's, which is background.
        let stands = node.planes.map(|plane| planes.get(usize::from(plane)).copied().unwrap_or_default());
        let feature = image.difference(self.place, self.per_metre, &node.feature().offsets, stands);
        self.next = node.next + u32::from(feature >= i32::from(node.threshold));
        true
    }
}

/// 1/z in 1/m, corrected for the focal length.
pub(super) fn per_metre(pixel: Pixel, ratio: f32) -> f32 {
    1000.0 / f32::from(pixel.depth.max(1)) * ratio
}

#[cfg(test)]
mod tests;
