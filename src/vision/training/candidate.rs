//! The best of a node's random splits.

use super::super::part::CLASSES;
use super::super::probe::{Offsets, gain};
use super::super::tree::OFFSET_UNIT;
use super::batch::{Features, Room};
use super::set::Sample;
use super::{Settings, TrainingSet, mix};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rayon::prelude::*;

/// Share of candidates whose second probe is the pixel itself.
const SINGLE_PROBE: f64 = 0.3;
/// Room for thresholds: a whole number of vector registers.
const LANES: usize = 16;
/// A node of more samples is counted by several threads.
const SHARED: usize = 8192;
/// A split has to gain more than this, in bits.
const LEAST_GAIN: f64 = 1e-6;

/// A node's split, as it will be stored.
#[derive(Clone, Copy, Debug)]
pub(super) struct Split {
    pub(super) offsets: [i16; 4],
    pub(super) threshold: i32,
}

impl Split {
    pub(super) fn offsets(&self) -> Offsets {
        self.offsets.map(|offset| f32::from(offset) * OFFSET_UNIT)
    }
}

/// A feature with its sorted thresholds; unused ones lie beyond every response.
struct Candidate {
    stored: [i16; 4],
    offsets: Offsets,
    thresholds: [i16; LANES],
}

/// How many samples of each class fall between which thresholds: for each class, for each candidate. The samples of a node
/// come in runs of one class, so that a run works on few and neighbouring counters.
type Histogram = Vec<[u32; LANES]>;

/// The split that gains most information; the first of equally good ones. `None` where none gains.
pub(super) fn best_split(set: &TrainingSet, settings: &Settings, samples: &[Sample], seed: u64) -> Option<Split> {
    let candidates = draw(set, settings, samples, seed);
    let histogram = if samples.len() > SHARED {
        let pieces = samples.len().div_ceil(4 * rayon::current_num_threads()).max(SHARED / 4);
        samples.par_chunks(pieces).map(|piece| count(set, &candidates, piece)).reduce_with(merge)?
    } else {
        count(set, &candidates, samples)
    };
    let mut best: Option<(f64, Split)> = None;
    for (index, candidate) in candidates.iter().enumerate() {
        let counts = counts_of(&histogram, candidates.len(), index);
        let Some((found, threshold)) = best_threshold(candidate, &counts, settings.thresholds) else { continue };
        if best.as_ref().is_none_or(|(most, _)| found > *most) {
            best = Some((found, Split { offsets: candidate.stored, threshold: i32::from(threshold) }));
        }
    }
    best.filter(|(most, _)| *most > LEAST_GAIN).map(|(_, split)| split)
}

fn draw(set: &TrainingSet, settings: &Settings, samples: &[Sample], seed: u64) -> Vec<Candidate> {
    let mut random = ChaCha8Rng::seed_from_u64(mix(seed, 3));
    let reach = reach(settings.reach_metres * set.focal());
    (0..settings.features)
        .map(|_| {
            let mut offset = || random.random_range(-reach..=reach);
            let mut stored = [offset(), offset(), offset(), offset()];
            if random.random_bool(SINGLE_PROBE) {
                [_, _, stored[2], stored[3]] = [0; 4];
            }
            let offsets = stored.map(|offset| f32::from(offset) * OFFSET_UNIT);
            let mut thresholds = [i16::MAX; LANES];
            for threshold in thresholds.iter_mut().take(settings.thresholds) {
                let sample = samples.get(random.random_range(0..samples.len()));
                *threshold = sample.map_or(0, |sample| narrow(set.response(sample, &offsets)));
            }
            thresholds.sort_unstable();
            Candidate { stored, offsets, thresholds }
        })
        .collect()
}

#[expect(clippy::cast_possible_truncation, reason = "clamped to the range first")]
fn reach(pixel_metres: f64) -> i16 {
    (pixel_metres / f64::from(OFFSET_UNIT)).clamp(1.0, f64::from(i16::MAX)) as i16
}

/// Responses lie between minus and plus the background's depth.
#[expect(clippy::cast_possible_truncation, reason = "10,000 fits into 16 bits")]
const fn narrow(response: i32) -> i16 {
    response as i16
}

fn count(set: &TrainingSet, candidates: &[Candidate], samples: &[Sample]) -> Histogram {
    let mut histogram = vec![[0; LANES]; CLASSES * candidates.len()];
    let mut features = Features::default();
    candidates.iter().for_each(|candidate| features.push(&candidate.offsets));
    let mut room = Room::default();
    for sample in samples {
        let Some((image, place, per_metre)) = set.view(sample) else { continue };
        features.respond(image, place, per_metre, &mut room);
        let first = usize::from(sample.label) * candidates.len();
        let Some(counts) = histogram.get_mut(first..first + candidates.len()) else { continue };
        for ((candidate, response), counts) in candidates.iter().zip(&room.responses).zip(counts) {
            // Thresholds up to the response: those splits put the sample to the right.
            let passed: i16 = candidate.thresholds.iter().map(|threshold| i16::from(threshold <= response)).sum();
            if let Some(count) = counts.get_mut(usize::from(passed.cast_unsigned())) {
                *count += 1;
            }
        }
    }
    histogram
}

fn merge(mut into: Histogram, from: Histogram) -> Histogram {
    for (into, from) in into.iter_mut().flatten().zip(from.into_iter().flatten()) {
        *into += from;
    }
    into
}

/// One candidate's counts, by threshold and class.
fn counts_of(histogram: &[[u32; LANES]], candidates: usize, index: usize) -> [[u32; CLASSES]; LANES] {
    let mut counts = [[0; CLASSES]; LANES];
    for (class, of_class) in histogram.chunks(candidates).enumerate() {
        let Some(buckets) = of_class.get(index) else { continue };
        for (counts, count) in counts.iter_mut().zip(buckets) {
            if let Some(slot) = counts.get_mut(class) {
                *slot = *count;
            }
        }
    }
    counts
}

fn best_threshold(candidate: &Candidate, buckets: &[[u32; CLASSES]; LANES], thresholds: usize) -> Option<(f64, i16)> {
    let mut left = [0_u32; CLASSES];
    let mut right = [0_u32; CLASSES];
    for bucket in buckets {
        right.iter_mut().zip(bucket).for_each(|(sum, count)| *sum += count);
    }
    let mut best: Option<(f64, i16)> = None;
    for (threshold, bucket) in candidate.thresholds.iter().zip(buckets).take(thresholds) {
        for ((left, right), count) in left.iter_mut().zip(&mut right).zip(bucket) {
            *left += count;
            *right -= count;
        }
        let found = gain(&left, &right);
        if best.is_none_or(|(most, _)| found > most) {
            best = Some((found, *threshold));
        }
    }
    best
}
