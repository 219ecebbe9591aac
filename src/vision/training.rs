//! Training of decision trees from labelled depth images (thesis section 3.2.1).
//!
//! The result depends on the images, the settings and the seed, not on the number of threads: each node draws its candidates
//! from a seed made of the tree's seed and the node's path. Rayon's threads are the only ones; time is the caller's matter.

mod batch;
mod candidate;
mod entropy;
mod set;

pub use set::{Example, TrainingSet};

use super::part::{CLASSES, OTHER, PARTS};
use super::tree::{LEAF, Leaf, NO_VOTE, Node, Tree, VOTED, Vote};
use candidate::{Split, best_split};
use serde::{Deserialize, Serialize};
use set::Sample;
use std::sync::atomic::{AtomicUsize, Ordering};
use thiserror::Error;

/// A vote of a summed variance beyond this (square metres) tells nothing and is dropped.
const WIDEST_VARIANCE: f64 = 0.03;

/// How a tree is trained.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Settings {
    /// Features that a node tries; the thesis has 500.
    pub features: usize,
    /// Thresholds for each feature, at most 15; the thesis has 10.
    pub thresholds: usize,
    /// Deepest level of a leaf; the thesis has 10 and 20.
    pub depth: usize,
    /// A node of fewer samples is not split.
    pub smallest: usize,
    /// Offsets reach this far to each side, in metres.
    pub reach_metres: f64,
    /// Share of a node's features that look at the maps of the neck, from 0 (the thesis' equation 3.1 alone) to 1.
    pub neck_share: f64,
    /// Everything random comes from it.
    pub seed: u64,
}

impl Default for Settings {
    fn default() -> Self {
        Self { features: 500, thresholds: 10, depth: 20, smallest: 2, reach_metres: 0.45, neck_share: 0.0, seed: 1 }
    }
}

/// Why a tree cannot be trained.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum TrainingError {
    /// A setting cannot be.
    #[error("training: {name} is {value}, but must be from {lowest} to {highest}")]
    Setting {
        /// Which.
        name: &'static str,
        /// Its value.
        value: f64,
        /// The lowest that is allowed.
        lowest: f64,
        /// The highest that is allowed.
        highest: f64,
    },
    /// No labelled foreground pixel at all.
    #[error("training: no image has a labelled foreground pixel; check labels, neck and background image")]
    NoSamples,
}

impl Settings {
    /// Checks every setting.
    ///
    /// # Errors
    /// The first that cannot be.
    pub fn check(&self) -> Result<(), TrainingError> {
        for (name, value, lowest, highest) in [
            ("features", self.features as f64, 1.0, 100_000.0),
            ("thresholds", self.thresholds as f64, 1.0, 15.0),
            ("depth", self.depth as f64, 1.0, 30.0),
            ("smallest", self.smallest as f64, 2.0, 1e9),
            ("reach_metres", self.reach_metres, 0.01, 0.55),
            ("neck_share", self.neck_share, 0.0, 1.0),
        ] {
            if !(lowest..=highest).contains(&value) {
                return Err(TrainingError::Setting { name, value, lowest, highest });
            }
        }
        Ok(())
    }
}

/// A subtree as it grows; a split knows its leaf where the tree is to be cut.
enum Grown {
    Leaf(Box<Leaf>),
    Split(Split, Option<Box<Leaf>>, Box<(Grown, Grown)>),
}

struct Grower<'a> {
    set: &'a TrainingSet,
    settings: &'a Settings,
    cut: Option<usize>,
    progress: &'a (dyn Fn(f64) + Sync),
    done: AtomicUsize,
}

/// Trains a tree. `progress` hears the share of samples that have reached their leaf, from any thread.
///
/// # Errors
/// Where a setting cannot be or there is nothing to learn from.
pub fn train(set: &TrainingSet, settings: &Settings, progress: &(dyn Fn(f64) + Sync)) -> Result<Tree, TrainingError> {
    Ok(flatten(&root(set, settings, None, progress)?, false))
}

/// Trains a tree and cuts a copy at a shallower depth: the tree that the same settings with that depth would have given.
///
/// # Errors
/// As [`train`].
pub fn train_with_cut(set: &TrainingSet, settings: &Settings, cut: usize) -> Result<(Tree, Tree), TrainingError> {
    let root = root(set, settings, Some(cut), &|_| ())?;
    Ok((flatten(&root, false), flatten(&root, true)))
}

fn root(
    set: &TrainingSet,
    settings: &Settings,
    cut: Option<usize>,
    progress: &(dyn Fn(f64) + Sync),
) -> Result<Grown, TrainingError> {
    settings.check()?;
    let mut samples = set.samples().to_vec();
    if samples.is_empty() {
        return Err(TrainingError::NoSamples);
    }
    let grower = Grower { set, settings, cut, progress, done: AtomicUsize::new(0) };
    Ok(grower.grow(&mut samples, 0, settings.seed))
}

impl Grower<'_> {
    fn grow(&self, samples: &mut [Sample], depth: usize, seed: u64) -> Grown {
        let split = if depth < self.settings.depth && samples.len() >= self.settings.smallest && !is_pure(samples) {
            best_split(self.set, self.settings, samples, seed)
        } else {
            None
        };
        let Some(split) = split else { return self.leaf(samples) };
        let middle = self.partition(samples, &split);
        if middle == 0 || middle == samples.len() {
            return self.leaf(samples);
        }
        let cut_leaf = (self.cut == Some(depth)).then(|| Box::new(self.content(samples)));
        let (left, right) = samples.split_at_mut(middle);
        let large = left.len().min(right.len()) > 200;
        let grow_left = |left: &mut [Sample]| self.grow(left, depth + 1, mix(seed, 1));
        let grow_right = |right: &mut [Sample]| self.grow(right, depth + 1, mix(seed, 2));
        let children = if large {
            rayon::join(|| grow_left(left), || grow_right(right))
        } else {
            (grow_left(left), grow_right(right))
        };
        Grown::Split(split, cut_leaf, Box::new(children))
    }

    /// Brings the left samples to the front, keeping the order on both sides, and counts them.
    fn partition(&self, samples: &mut [Sample], split: &Split) -> usize {
        let (feature, threshold) = (split.probes.feature(), i32::from(split.threshold));
        let (left, right): (Vec<Sample>, Vec<Sample>) =
            samples.iter().partition(|sample| self.set.response(sample, &feature) < threshold);
        let count = left.len();
        samples.iter_mut().zip(left.into_iter().chain(right)).for_each(|(slot, sample)| *slot = sample);
        count
    }

    fn leaf(&self, samples: &[Sample]) -> Grown {
        let before = self.done.fetch_add(samples.len(), Ordering::Relaxed);
        (self.progress)((before + samples.len()) as f64 / self.set.samples().len() as f64);
        Grown::Leaf(Box::new(self.content(samples)))
    }

    fn content(&self, samples: &[Sample]) -> Leaf {
        Leaf { shares: shares(samples), votes: self.votes(samples) }
    }

    fn votes(&self, samples: &[Sample]) -> [Vote; VOTED] {
        let mut sums = [[0.0_f64; 4]; VOTED];
        for sample in samples {
            for (sum, offset) in sums.iter_mut().zip(self.set.joint_offsets(sample)) {
                for (total, value) in sum.iter_mut().zip([offset.x, offset.y, offset.z, offset.norm_squared()]) {
                    *total += value;
                }
            }
        }
        sums.map(|sum| vote(&sum, samples.len() as f64))
    }
}

/// A vote from summed offsets and their summed squares.
#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "offsets inside a body, in millimetres")]
fn vote([x, y, z, squares]: &[f64; 4], count: f64) -> Vote {
    let mean = [x, y, z].map(|sum| sum / count);
    let variance = (squares / count - mean.iter().map(|value| value * value).sum::<f64>()).max(0.0);
    if !squares.is_finite() || variance > WIDEST_VARIANCE {
        return Vote { offset: [0; 3], deviation: NO_VOTE };
    }
    Vote {
        offset: mean.map(|value| (value * 1000.0).round() as i16),
        deviation: (variance.sqrt() * 1000.0).round() as u16,
    }
}

fn is_pure(samples: &[Sample]) -> bool {
    samples.first().is_none_or(|first| samples.iter().all(|sample| sample.label == first.label))
}

#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a share of 255")]
fn shares(samples: &[Sample]) -> [u8; CLASSES] {
    let mut counts = [0_u32; CLASSES];
    for sample in samples {
        if let Some(count) = counts.get_mut(usize::from(sample.label)) {
            *count += 1;
        }
    }
    let total = f64::from(counts.iter().sum::<u32>().max(1));
    counts.map(|count| (f64::from(count) / total * 255.0).round() as u8)
}

/// Puts a tree into one list: level by level, both children of a split side by side; with `cut`, no deeper than the splits
/// that know their leaf.
#[expect(clippy::cast_possible_truncation, reason = "fewer nodes than samples, and those are counted in 32 bits")]
fn flatten(root: &Grown, cut: bool) -> Tree {
    let mut tree = Tree::default();
    let mut level = vec![root];
    let mut first_of_next = 1_u32;
    while !level.is_empty() {
        let mut below = Vec::new();
        for grown in level {
            match grown {
                Grown::Leaf(leaf) => end(&mut tree, leaf),
                Grown::Split(_, Some(leaf), _) if cut => end(&mut tree, leaf),
                Grown::Split(split, _, children) => {
                    tree.nodes.push(Node {
                        offsets: split.probes.offsets,
                        threshold: split.threshold,
                        planes: split.probes.planes,
                        next: first_of_next + below.len() as u32,
                    });
                    below.push(&children.0);
                    below.push(&children.1);
                }
            }
        }
        first_of_next += below.len() as u32;
        level = below;
    }
    tree
}

#[expect(clippy::cast_possible_truncation, reason = "fewer leaves than samples, and those are counted in 32 bits")]
fn end(tree: &mut Tree, leaf: &Leaf) {
    tree.nodes.push(Node { next: LEAF | tree.leaves.len() as u32, ..Node::default() });
    tree.leaves.push(*leaf);
}

/// Mixes a word into a seed (`SplitMix64`'s finaliser).
const fn mix(seed: u64, word: u64) -> u64 {
    let mut mixed = seed.wrapping_add(word.wrapping_mul(0x9E37_79B9_7F4A_7C15));
    mixed = (mixed ^ (mixed >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
    mixed ^ (mixed >> 31)
}

const _: () = assert!(PARTS == OTHER as usize);

#[cfg(test)]
mod tests;
