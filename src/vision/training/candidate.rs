//! The best of a node's random splits.

use super::super::neck::MAPS;
use super::super::part::CLASSES;
use super::super::probe::{DEPTH, Feature, NOTHING};
use super::super::tree::OFFSET_UNIT;
use super::super::walk::{Work, with_vector_instructions};
use super::batch::{BLOCK, Features, Room};
use super::entropy::n_log_n;
use super::set::Sample;
use super::{Settings, TrainingSet, mix};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rayon::prelude::*;

/// Share of candidates whose second probe is the pixel itself.
const SINGLE_PROBE: f64 = 0.3;
/// Share of a map's single probes that look at the pixel itself.
const OWN_PLACE: f64 = 0.5;
/// Buckets between thresholds: one more than thresholds at most.
const BUCKETS: usize = 16;
/// A node of more samples is counted by several threads.
const SHARED: usize = 8192;
/// A split has to gain more than this, in bits.
const LEAST_GAIN: f64 = 1e-6;

/// A node's split, as it will be stored.
#[derive(Clone, Copy, Debug)]
pub(super) struct Split {
    pub(super) probes: Probes,
    pub(super) threshold: i16,
}

/// A feature as it will be stored.
#[derive(Clone, Copy, Debug)]
pub(super) struct Probes {
    pub(super) offsets: [i16; 4],
    pub(super) planes: [u8; 2],
}

impl Probes {
    pub(super) fn feature(&self) -> Feature {
        Feature { offsets: self.offsets.map(|offset| f32::from(offset) * OFFSET_UNIT), planes: self.planes }
    }
}

/// A node's candidates: features, and each one's sorted thresholds.
struct Candidates {
    stored: Vec<Probes>,
    features: Features,
    /// For each block of features: the lowest threshold of each, the second one of each, and so on.
    thresholds: Vec<Vec<[i16; BLOCK]>>,
}

/// The classes that a node's samples have, with the number of each.
struct Present {
    slots: [usize; CLASSES],
    counts: Vec<u32>,
}

/// How many samples of each class that is present fall between which thresholds: for each class, for each candidate. The
/// samples of a node come in runs of one class, so that a run works on few and neighbouring counters.
type Histogram = Vec<[u32; BUCKETS]>;

/// The split that gains most information; the first of equally good ones. `None` where none gains.
pub(super) fn best_split(set: &TrainingSet, settings: &Settings, samples: &[Sample], seed: u64) -> Option<Split> {
    let candidates = Candidates::draw(set, settings, samples, seed);
    let present = Present::of(samples);
    let count =
        |samples| with_vector_instructions(Counting { candidates: &candidates, set, present: &present, samples });
    let histogram = if samples.len() > SHARED {
        let pieces = samples.len().div_ceil(4 * rayon::current_num_threads()).max(SHARED / 4);
        samples.par_chunks(pieces).map(count).reduce_with(merge)?
    } else {
        count(samples)
    };
    let mut best: Option<(f64, Split)> = None;
    for (index, stored) in candidates.stored.iter().enumerate() {
        let found = best_threshold(&histogram, candidates.padded(), index, &present.counts, settings.thresholds);
        let Some((found, place)) = found else { continue };
        if best.as_ref().is_none_or(|(most, _)| found > *most) {
            best = Some((found, Split { probes: *stored, threshold: candidates.threshold(index, place) }));
        }
    }
    best.filter(|(most, _)| *most > LEAST_GAIN).map(|(_, split)| split)
}

impl Candidates {
    /// Draws features, and as thresholds their responses on a few of the node's samples.
    fn draw(set: &TrainingSet, settings: &Settings, samples: &[Sample], seed: u64) -> Self {
        let mut random = ChaCha8Rng::seed_from_u64(mix(seed, 3));
        let reach = reach(settings.reach_metres * set.focal());
        let stored = draw_probes(settings, &mut random, reach);
        let drawn: Vec<Feature> = stored.iter().map(Probes::feature).collect();
        let features = Features::new(&drawn);
        let mut room = Room::default();
        let mut thresholds = vec![Vec::new(); drawn.len().div_ceil(BLOCK)];
        for _ in 0..settings.thresholds {
            let drawn = samples.get(random.random_range(0..samples.len())).and_then(|sample| set.view(sample));
            let Some((image, place, per_metre)) = drawn else { continue };
            features.respond(image, place, per_metre, &mut room);
            let (blocks, _) = room.responses.as_chunks::<BLOCK>();
            thresholds.iter_mut().zip(blocks).for_each(|(rows, block)| rows.push(*block));
        }
        thresholds.iter_mut().for_each(|rows| sort_columns(rows));
        Self { stored, features, thresholds }
    }

    /// Number of candidates with the padding of the last block.
    const fn padded(&self) -> usize {
        self.thresholds.len() * BLOCK
    }

    fn threshold(&self, index: usize, place: usize) -> i16 {
        let row = self.thresholds.get(index / BLOCK).and_then(|rows| rows.get(place));
        row.and_then(|row| row.get(index % BLOCK)).copied().unwrap_or(0)
    }
}

/// The counting of a node's samples between the thresholds of its candidates.
struct Counting<'a> {
    candidates: &'a Candidates,
    set: &'a TrainingSet,
    present: &'a Present,
    samples: &'a [Sample],
}

impl Work for Counting<'_> {
    type Outcome = Histogram;

    #[inline(always)]
    #[expect(clippy::inline_always, reason = "to become vector instructions where the caller is compiled for them")]
    fn run(self) -> Histogram {
        let padded = self.candidates.padded();
        let mut histogram = vec![[0; BUCKETS]; self.present.counts.len() * padded];
        let mut room = Room::default();
        for sample in self.samples {
            let Some((image, place, per_metre)) = self.set.view(sample) else { continue };
            self.candidates.features.respond(image, place, per_metre, &mut room);
            let first = self.present.slots.get(usize::from(sample.label)).copied().unwrap_or(0) * padded;
            let Some(counts) = histogram.get_mut(first..first + padded) else { continue };
            let (counts, _) = counts.as_chunks_mut::<BLOCK>();
            let (responses, _) = room.responses.as_chunks::<BLOCK>();
            for ((rows, responses), counts) in self.candidates.thresholds.iter().zip(responses).zip(counts) {
                // Thresholds up to the response: those splits put the sample to the right.
                let mut passed = [0_i16; BLOCK];
                for row in rows {
                    for ((passed, threshold), response) in passed.iter_mut().zip(row).zip(responses) {
                        *passed += i16::from(threshold <= response);
                    }
                }
                for (passed, buckets) in passed.iter().zip(counts) {
                    if let Some(count) = buckets.get_mut(usize::from(passed.cast_unsigned()) % BUCKETS) {
                        *count += 1;
                    }
                }
            }
        }
        histogram
    }
}

impl Present {
    fn of(samples: &[Sample]) -> Self {
        let mut all = [0_u32; CLASSES];
        for sample in samples {
            if let Some(count) = all.get_mut(usize::from(sample.label)) {
                *count += 1;
            }
        }
        let mut present = Self { slots: [0; CLASSES], counts: Vec::with_capacity(CLASSES) };
        for (slot, count) in present.slots.iter_mut().zip(all).filter(|(_, count)| *count > 0) {
            *slot = present.counts.len();
            present.counts.push(count);
        }
        present
    }
}

/// Features of depth first, then of each map in turn: those that read the same stand side by side.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a share of a count, and a handful of maps"
)]
fn draw_probes(settings: &Settings, random: &mut ChaCha8Rng, reach: i16) -> Vec<Probes> {
    let of_maps = (settings.features as f64 * settings.neck_share) as usize;
    let mut drawn: Vec<Probes> = (of_maps..settings.features)
        .map(|_| Probes { offsets: draw_offsets(random, reach), planes: [DEPTH; 2] })
        .collect();
    for number in 0..of_maps {
        let kind = number * 2 * MAPS.len() / of_maps;
        let map = (kind / 2 + 1) as u8;
        let [u_x, u_y, v_x, v_y] = draw_offsets(random, reach);
        drawn.push(if kind.is_multiple_of(2) {
            let offsets = if random.random_bool(OWN_PLACE) { [0; 4] } else { [u_x, u_y, 0, 0] };
            Probes { offsets, planes: [map, NOTHING] }
        } else {
            Probes { offsets: [u_x, u_y, v_x, v_y], planes: [map; 2] }
        });
    }
    drawn
}

fn draw_offsets(random: &mut ChaCha8Rng, reach: i16) -> [i16; 4] {
    let mut offset = || random.random_range(-reach..=reach);
    let [u_x, u_y, v_x, v_y] = [offset(), offset(), offset(), offset()];
    if random.random_bool(SINGLE_PROBE) { [u_x, u_y, 0, 0] } else { [u_x, u_y, v_x, v_y] }
}

/// Sorts each column of a block of thresholds.
fn sort_columns(rows: &mut [[i16; BLOCK]]) {
    for column in 0..BLOCK {
        let mut sorted: Vec<i16> = rows.iter().filter_map(|row| row.get(column)).copied().collect();
        sorted.sort_unstable();
        for (row, value) in rows.iter_mut().zip(sorted) {
            if let Some(slot) = row.get_mut(column) {
                *slot = value;
            }
        }
    }
}

#[expect(clippy::cast_possible_truncation, reason = "clamped to the range first")]
fn reach(pixel_metres: f64) -> i16 {
    (pixel_metres / f64::from(OFFSET_UNIT)).clamp(1.0, f64::from(i16::MAX)) as i16
}

fn merge(mut into: Histogram, from: Histogram) -> Histogram {
    for (into, from) in into.iter_mut().flatten().zip(from.into_iter().flatten()) {
        *into += from;
    }
    into
}

/// A candidate's best threshold (its place among the sorted ones) and what it gains, in bits.
fn best_threshold(
    histogram: &[[u32; BUCKETS]],
    padded: usize,
    index: usize,
    totals: &[u32],
    thresholds: usize,
) -> Option<(f64, usize)> {
    let all: u32 = totals.iter().sum();
    let together = n_log_n(all) - totals.iter().map(|count| n_log_n(*count)).sum::<f64>();
    let mut left = [0_u32; CLASSES];
    let mut best: Option<(f64, usize)> = None;
    for place in 0..thresholds {
        let mut more = 0;
        for (left, of_class) in left.iter_mut().zip(histogram.chunks(padded)) {
            let count = of_class.get(index).and_then(|buckets| buckets.get(place)).copied().unwrap_or(0);
            *left += count;
            more += count;
        }
        if more == 0 {
            // The same split as with the threshold before.
            continue;
        }
        let (mut scatter, mut left_all) = (0.0, 0);
        for (left, total) in left.iter().zip(totals) {
            scatter -= n_log_n(*left) + n_log_n(total - left);
            left_all += left;
        }
        scatter += n_log_n(left_all) + n_log_n(all - left_all);
        let found = (together - scatter) / f64::from(all.max(1));
        if best.is_none_or(|(most, _)| found > most) {
            best = Some((found, place));
        }
    }
    best
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::vision::probe::gain;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn the_best_threshold_gains_what_the_definition_says(
            buckets in proptest::array::uniform3(proptest::array::uniform4(0_u32..5000)),
        ) {
            // Two candidates, of which the second is looked at; three classes, three thresholds.
            let mut histogram = vec![[0_u32; BUCKETS]; 6];
            for (class, counts) in buckets.iter().enumerate() {
                histogram[2 * class + 1][..4].copy_from_slice(counts);
            }
            let totals: Vec<u32> = buckets.iter().map(|counts| counts.iter().sum()).collect();
            prop_assume!(totals.iter().sum::<u32>() > 0);
            let by_definition = (0..3).map(|place| {
                let left: Vec<u32> = buckets.iter().map(|counts| counts[..=place].iter().sum()).collect();
                let right: Vec<u32> = left.iter().zip(&totals).map(|(left, total)| total - left).collect();
                gain(&left, &right)
            });
            let most = by_definition.fold(0.0_f64, f64::max);
            let found = best_threshold(&histogram, 2, 1, &totals, 3).map_or(0.0, |(found, _)| found);
            prop_assert!((found - most).abs() < 1e-9, "{found} {most}");
        }
    }

    #[test]
    fn thresholds_are_sorted_feature_by_feature() {
        let mut rows = vec![[3; BLOCK], [1; BLOCK], [2; BLOCK]];
        rows[0][5] = -7;
        sort_columns(&mut rows);
        assert_eq!(rows.iter().map(|row| row[0]).collect::<Vec<_>>(), [1, 2, 3]);
        assert_eq!(rows.iter().map(|row| row[5]).collect::<Vec<_>>(), [-7, 1, 2]);
    }
}
