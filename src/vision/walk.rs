//! Many pixels through one tree: the same leaves as [`Tree::leaf`] finds one by one, with the waiting for memory shared.
//!
//! Uses vector instructions where the machine has them (AVX2), else several pixels side by side. Both give the same leaves.

#[cfg(target_arch = "x86_64")]
mod vector;

use super::foreground::Pixel;
use super::probe::ProbeImage;
use super::tree::{LEAF, Tree};

/// Pixels that walk side by side without vector instructions.
const SIDE_BY_SIDE: usize = 8;

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
    for group in pixels.chunks(SIDE_BY_SIDE) {
        let mut next = [0_u32; SIDE_BY_SIDE];
        let mut walking = group.len();
        while walking > 0 {
            walking = 0;
            for (next, pixel) in next.iter_mut().zip(group).filter(|(next, _)| **next & LEAF == 0) {
                // Loading has checked every index; a leaf of number 0 stands in all the same.
                let Some(node) = tree.nodes.get(*next as usize).filter(|node| node.next & LEAF == 0) else {
                    *next = tree.nodes.get(*next as usize).map_or(LEAF, |node| node.next);
                    continue;
                };
                walking += 1;
                let place = (f32::from(pixel.column), f32::from(pixel.row));
                let right =
                    image.response(place, per_metre(*pixel, ratio), &node.feature()) >= i32::from(node.threshold);
                *next = node.next + u32::from(right);
            }
        }
        into.extend(next.iter().take(group.len()).map(|next| next & !LEAF));
    }
}

/// 1/z in 1/m, corrected for the focal length.
pub(super) fn per_metre(pixel: Pixel, ratio: f32) -> f32 {
    1000.0 / f32::from(pixel.depth.max(1)) * ratio
}

#[cfg(test)]
mod tests;
