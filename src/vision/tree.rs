//! Decision trees over depth features and what their leaves know: the parts' shares, and where each joint lies from here.

use super::part::{CLASSES, PARTS};
use super::probe::{Feature, ProbeImage};
use crate::body::{Joint, Side};

/// Joints that a leaf votes for: six on each side, left first, in the order of [`Joint::ALL`].
pub const VOTED: usize = 2 * Joint::ALL.len();
/// One unit of a stored offset in pixel metres.
pub const OFFSET_UNIT: f32 = 0.01;
/// In [`Node::next`]: the rest is the number of a leaf.
pub const LEAF: u32 = 1 << 31;
/// The deviation of a vote that is none.
pub const NO_VOTE: u16 = u16::MAX;

/// A split, or the way to a leaf: 16 bytes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[repr(C)]
pub struct Node {
    /// u and v (column, row each) in units of [`OFFSET_UNIT`] at the model's focal length.
    pub offsets: [i16; 4],
    /// Left where the feature is below this, in millimetres.
    pub threshold: i16,
    /// What u and v read, below [`PLANES`](super::probe::PLANES).
    pub planes: [u8; 2],
    /// The left child (the right one follows it), or [`LEAF`] and the leaf's number.
    pub next: u32,
}

impl Node {
    /// The feature, with offsets in pixel metres.
    #[must_use]
    #[inline]
    pub fn feature(&self) -> Feature {
        Feature { offsets: self.offsets.map(|offset| f32::from(offset) * OFFSET_UNIT), planes: self.planes }
    }
}

/// Where a leaf's pixels expect a joint: the mean offset in millimetres in the camera frame, and its deviation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Vote {
    /// From the pixel's point to the joint's centre.
    pub offset: [i16; 3],
    /// Root of the summed variance of all three axes; [`NO_VOTE`] where the leaf does not know.
    pub deviation: u16,
}

/// What is known of pixels that end in a leaf.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Leaf {
    /// Each class' share in 255ths.
    pub shares: [u8; CLASSES],
    /// A vote for each joint.
    pub votes: [Vote; VOTED],
}

/// A decision tree: nodes with each split's children after it, and leaves.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Tree {
    pub(super) nodes: Vec<Node>,
    pub(super) leaves: Vec<Leaf>,
}

/// Several trees that share conventions.
#[derive(Clone, Debug, PartialEq)]
pub struct Forest {
    /// The focal length that offsets are made for, in pixels.
    pub focal: f64,
    /// What the forest was trained on, in words.
    pub description: String,
    pub(super) trees: Vec<Tree>,
}

/// Where a joint's vote stands in a leaf.
#[must_use]
pub const fn vote_index(side: Side, joint: Joint) -> usize {
    let first = match side {
        Side::Left => 0,
        Side::Right => Joint::ALL.len(),
    };
    first + joint.index()
}

impl Tree {
    /// The leaf that a pixel ends in.
    ///
    /// `per_metre` is 1/z in 1/m, times the camera's focal length over the model's.
    #[must_use]
    pub fn leaf(&self, image: &ProbeImage, place: (f32, f32), per_metre: f32) -> u32 {
        let mut next = 0;
        while next & LEAF == 0 {
            // Loading has checked every index; a leaf of number 0 stands in all the same.
            let Some(node) = self.nodes.get(next as usize) else { return 0 };
            if node.next & LEAF != 0 {
                return node.next & !LEAF;
            }
            let right = image.response(place, per_metre, &node.feature()) >= i32::from(node.threshold);
            next = node.next + u32::from(right);
        }
        next & !LEAF
    }

    /// Number of nodes.
    #[must_use]
    pub fn node_count(&self) -> usize {
        self.nodes.len()
    }

    /// A leaf by its number.
    #[must_use]
    pub fn leaf_content(&self, number: u32) -> Option<&Leaf> {
        self.leaves.get(number as usize)
    }
}

impl Forest {
    /// The trees.
    #[must_use]
    pub fn trees(&self) -> &[Tree] {
        &self.trees
    }

    /// The most probable class of a pixel whose leaves are given, one for each tree; of equal ones the lowest.
    #[must_use]
    pub fn class(&self, leaves: impl Iterator<Item = u32>) -> u8 {
        let shares = self.shares(leaves);
        let mut best = (0, 0);
        for (class, share) in (0_u8..).zip(shares) {
            if share > best.1 {
                best = (class, share);
            }
        }
        best.0
    }

    /// The summed shares of each class over the trees, in 255ths.
    #[must_use]
    pub fn shares(&self, leaves: impl Iterator<Item = u32>) -> [u32; CLASSES] {
        let mut sum = [0_u32; CLASSES];
        for (tree, number) in self.trees.iter().zip(leaves) {
            if let Some(leaf) = tree.leaf_content(number) {
                sum.iter_mut().zip(leaf.shares).for_each(|(sum, share)| *sum += u32::from(share));
            }
        }
        sum
    }
}

const _: () = assert!(PARTS < CLASSES && size_of::<Node>() == 16);

#[cfg(test)]
mod tests {
    use super::*;

    fn leaf(class: usize) -> Leaf {
        let mut shares = [0; CLASSES];
        shares[class] = 255;
        Leaf { shares, votes: [Vote { offset: [0; 3], deviation: NO_VOTE }; VOTED] }
    }

    /// Background at 30 pixels to the right at one metre: class 3, else class 5.
    fn stump() -> Tree {
        Tree {
            nodes: vec![
                Node { offsets: [3000, 0, 0, 0], threshold: 500, next: 1, ..Node::default() },
                Node { next: LEAF, ..Node::default() },
                Node { next: LEAF | 1, ..Node::default() },
            ],
            leaves: vec![leaf(5), leaf(3)],
        }
    }

    #[test]
    fn a_pixel_goes_left_below_the_threshold_and_offsets_shrink_with_depth() {
        let mut image = ProbeImage::new(100, 1);
        for column in 0..60 {
            image.set(column, 0, 1000);
        }
        let tree = stump();
        assert_eq!(tree.leaf(&image, (20.0, 0.0), 1.0), 0);
        assert_eq!(tree.leaf(&image, (40.0, 0.0), 1.0), 1);
        assert_eq!(tree.leaf(&image, (40.0, 0.0), 0.5), 0);
    }

    #[test]
    fn trees_are_averaged_and_ties_go_to_the_lowest_class() {
        let forest = Forest { focal: 545.0, description: String::new(), trees: vec![stump(), stump(), stump()] };
        assert_eq!(forest.class([0, 0, 1].into_iter()), 5);
        assert_eq!(forest.class([0, 1].into_iter()), 3);
    }
}
