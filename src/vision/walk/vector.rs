//! Eight pixels in one vector (AVX2), two vectors at a time. The only unsafe code of valet.
//!
//! Each level of a tree is eight loads of nodes and two gathers instead of 48 loads that wait for each other. It reaches the same
//! leaves as the plain walk, which a test shows.
#![expect(unsafe_code, reason = "gathers read through pointers; each is bounded where it is made")]

use super::{Work, per_metre};
use crate::vision::foreground::Pixel;
use crate::vision::probe::{PLANES, Plane, ProbeImage};
use crate::vision::tree::{LEAF, Node, OFFSET_UNIT, Tree};
use std::arch::x86_64::{
    __m128i, __m256, __m256i, _MM_HINT_T0, _mm_loadu_si128, _mm_prefetch, _mm256_add_epi32, _mm256_add_ps,
    _mm256_and_si256, _mm256_blendv_epi8, _mm256_castsi256_ps, _mm256_cmpgt_epi32, _mm256_cvtepi32_ps,
    _mm256_cvttps_epi32, _mm256_i32gather_epi32, _mm256_loadu_ps, _mm256_loadu_si256, _mm256_max_ps, _mm256_min_epu32,
    _mm256_min_ps, _mm256_movemask_ps, _mm256_mul_ps, _mm256_mullo_epi32, _mm256_permutevar8x32_epi32,
    _mm256_set_m128i, _mm256_set1_epi32, _mm256_set1_ps, _mm256_setzero_ps, _mm256_setzero_si256, _mm256_slli_epi32,
    _mm256_srai_epi32, _mm256_srli_epi32, _mm256_srlv_epi32, _mm256_storeu_si256, _mm256_sub_epi32,
    _mm256_unpackhi_epi32, _mm256_unpackhi_epi64, _mm256_unpacklo_epi32, _mm256_unpacklo_epi64,
};

/// Lanes of a vector, and vectors that walk side by side.
const LANES: usize = 8;
const VECTORS: usize = 4;
/// Pixels of one go.
const GROUP: usize = LANES * VECTORS;
const _: () = assert!(PLANES == LANES);

/// Adds the leaves of as many pixels as make whole groups; tells how many that were. None without AVX2.
pub(super) fn leaves(tree: &Tree, image: &ProbeImage, pixels: &[Pixel], ratio: f32, into: &mut Vec<u32>) -> usize {
    // Indices are signed 32-bit numbers of words.
    let fits = i32::try_from(tree.nodes.len()).is_ok() && i32::try_from(image.values().len()).is_ok();
    // All planes and one value more: what the clamped coordinates reach.
    let whole = image.values().len() == image.value_count();
    if tree.nodes.is_empty() || !fits || !whole || !std::arch::is_x86_feature_detected!("avx2") {
        return 0;
    }
    let (groups, _) = pixels.as_chunks::<GROUP>();
    for group in groups {
        // SAFETY: AVX2 is there, the tree has nodes, and the image has all values that its width and height promise.
        into.extend(unsafe { walk(&tree.nodes, image, group, ratio) });
    }
    groups.len() * GROUP
}

/// Runs work compiled for AVX2 where the machine has it.
pub(super) fn run<W: Work>(work: W) -> W::Outcome {
    if std::arch::is_x86_feature_detected!("avx2") {
        // SAFETY: AVX2 is there.
        unsafe { run_with_avx2(work) }
    } else {
        work.run()
    }
}

#[target_feature(enable = "avx2")]
fn run_with_avx2<W: Work>(work: W) -> W::Outcome {
    work.run()
}

/// Places, scales and nodes of eight pixels.
#[derive(Clone, Copy)]
struct Walkers {
    column: __m256,
    row: __m256,
    per_metre: __m256,
    node: __m256i,
    next: __m256i,
}

/// What is the same for all pixels of an image.
#[derive(Clone, Copy)]
struct Ground {
    nodes: *const __m128i,
    last_node: __m256i,
    values: *const i32,
    last_column: __m256,
    last_row: __m256,
    /// For each plane, how its values stand ([`Plane`](crate::vision::probe::Plane)).
    shifts: __m256i,
    strides: __m256i,
    firsts: __m256i,
}

/// # Safety
/// The machine must have AVX2; `nodes` must not be empty; `image` must hold `value_count()` values.
#[target_feature(enable = "avx2")]
#[expect(clippy::cast_possible_truncation, clippy::cast_possible_wrap, reason = "sizes are checked by the caller")]
unsafe fn walk(nodes: &[Node], image: &ProbeImage, group: &[Pixel; GROUP], ratio: f32) -> [u32; GROUP] {
    let table = |of: &dyn Fn(Plane) -> i32| {
        let mut lanes = [0_i32; LANES];
        lanes.iter_mut().zip(0_u8..).for_each(|(lane, plane)| *lane = of(image.plane(plane)));
        // SAFETY: `lanes` is eight words, which need no alignment.
        unsafe { _mm256_loadu_si256(lanes.as_ptr().cast()) }
    };
    let ground = Ground {
        nodes: nodes.as_ptr().cast(),
        last_node: _mm256_set1_epi32((nodes.len() - 1) as i32),
        values: image.values().as_ptr().cast(),
        last_column: _mm256_set1_ps((image.width() + 1) as f32),
        last_row: _mm256_set1_ps((image.height() + 1) as f32),
        shifts: table(&|plane| plane.shift as i32),
        strides: table(&|plane| plane.stride as i32),
        firsts: table(&|plane| plane.first as i32),
    };
    let (vectors, _) = group.as_chunks::<LANES>();
    let mut walkers = [start(&[Pixel::default(); LANES], ratio); VECTORS];
    for (walkers, pixels) in walkers.iter_mut().zip(vectors) {
        *walkers = start(pixels, ratio);
    }
    loop {
        let mut all_ended = true;
        for walkers in &mut walkers {
            // SAFETY: as for this function.
            all_ended &= unsafe { step(walkers, &ground) };
        }
        if all_ended {
            break;
        }
    }
    let mut found = [0_u32; GROUP];
    for (found, walkers) in found.as_chunks_mut::<LANES>().0.iter_mut().zip(&walkers) {
        // SAFETY: `found` is eight words, which need no alignment.
        unsafe { _mm256_storeu_si256(found.as_mut_ptr().cast(), walkers.next) };
        for next in found {
            *next &= !LEAF;
        }
    }
    found
}

#[target_feature(enable = "avx2")]
fn start(pixels: &[Pixel; LANES], ratio: f32) -> Walkers {
    let load = |of: &dyn Fn(&Pixel) -> f32| {
        let mut lanes = [0.0_f32; LANES];
        lanes.iter_mut().zip(pixels).for_each(|(lane, pixel)| *lane = of(pixel));
        // SAFETY: `lanes` is eight numbers, which need no alignment.
        unsafe { _mm256_loadu_ps(lanes.as_ptr()) }
    };
    Walkers {
        column: load(&|pixel| f32::from(pixel.column)),
        row: load(&|pixel| f32::from(pixel.row)),
        per_metre: load(&|pixel| per_metre(*pixel, ratio)),
        node: _mm256_setzero_si256(),
        next: _mm256_setzero_si256(),
    }
}

/// One level down for all that have not reached a leaf; true where all have.
///
/// # Safety
/// As [`walk`].
#[target_feature(enable = "avx2")]
#[inline]
unsafe fn step(walkers: &mut Walkers, ground: &Ground) -> bool {
    // No index leaves the tree, whatever a node says.
    let at = _mm256_min_epu32(walkers.node, ground.last_node);
    // SAFETY: `at` lies inside the tree.
    let [u, v, test, next] = unsafe { nodes(ground.nodes, at) };
    fetch(ground.nodes, _mm256_min_epu32(next, ground.last_node));
    // SAFETY: as for this function.
    let response = unsafe {
        let first = probe(walkers, ground, u, _mm256_srli_epi32::<16>(test));
        _mm256_sub_epi32(first, probe(walkers, ground, v, _mm256_srli_epi32::<24>(test)))
    };
    let threshold = _mm256_srai_epi32::<16>(_mm256_slli_epi32::<16>(test));
    // Minus one where the feature is below the threshold: the way goes left.
    let left = _mm256_cmpgt_epi32(threshold, response);
    let ended = _mm256_srai_epi32::<31>(next);
    let child = _mm256_add_epi32(_mm256_add_epi32(next, _mm256_set1_epi32(1)), left);
    walkers.node = _mm256_blendv_epi8(child, walkers.node, ended);
    walkers.next = next;
    _mm256_movemask_ps(_mm256_castsi256_ps(ended)) == 0xFF
}

/// The four words of eight nodes: eight loads of whole nodes, turned, which processors do in less than half of the time of four
/// gathers.
///
/// # Safety
/// The machine must have AVX2; every number in `at` must be a node's.
#[target_feature(enable = "avx2")]
#[inline]
unsafe fn nodes(first: *const __m128i, at: __m256i) -> [__m256i; 4] {
    let mut numbers = [0_u32; LANES];
    // SAFETY: `numbers` is eight words, which need no alignment.
    unsafe { _mm256_storeu_si256(numbers.as_mut_ptr().cast(), at) };
    let [a, b, c, d, e, f, g, h] = numbers;
    // SAFETY: a node is as long as a vector of four words (checked beside its definition), and each number is a node's.
    let pair = |low: u32, high: u32| unsafe {
        _mm256_set_m128i(_mm_loadu_si128(first.add(high as usize)), _mm_loadu_si128(first.add(low as usize)))
    };
    let (one, two, three, four) = (pair(a, e), pair(b, f), pair(c, g), pair(d, h));
    let (low, high) = (_mm256_unpacklo_epi32(one, two), _mm256_unpackhi_epi32(one, two));
    let (lower, higher) = (_mm256_unpacklo_epi32(three, four), _mm256_unpackhi_epi32(three, four));
    [
        _mm256_unpacklo_epi64(low, lower),
        _mm256_unpackhi_epi64(low, lower),
        _mm256_unpacklo_epi64(high, higher),
        _mm256_unpackhi_epi64(high, higher),
    ]
}

/// Asks for eight nodes ahead of their time: both children stand side by side, so what a level needs next is on its way while
/// probes decide which.
#[target_feature(enable = "avx2")]
#[inline]
fn fetch(first: *const __m128i, at: __m256i) {
    let mut numbers = [0_u32; LANES];
    // SAFETY: `numbers` is eight words, which need no alignment.
    unsafe { _mm256_storeu_si256(numbers.as_mut_ptr().cast(), at) };
    for number in numbers {
        _mm_prefetch::<_MM_HINT_T0>(first.wrapping_add(number as usize).cast());
    }
}

/// What planes (the lowest three bits of a word) read at offsets that stand in the halves of a word: column low, row high.
///
/// # Safety
/// As [`walk`].
#[target_feature(enable = "avx2")]
#[inline]
unsafe fn probe(walkers: &Walkers, ground: &Ground, offsets: __m256i, plane: __m256i) -> __m256i {
    let along = |from: __m256, offset: __m256i, last: __m256| {
        let metres = _mm256_mul_ps(_mm256_cvtepi32_ps(offset), _mm256_set1_ps(OFFSET_UNIT));
        let at = _mm256_add_ps(from, _mm256_mul_ps(metres, walkers.per_metre));
        let shifted = _mm256_add_ps(_mm256_add_ps(at, _mm256_set1_ps(0.5)), _mm256_set1_ps(1.0));
        // What is no number becomes the second operand: the border.
        _mm256_cvttps_epi32(_mm256_min_ps(_mm256_max_ps(shifted, _mm256_setzero_ps()), last))
    };
    let low = _mm256_srai_epi32::<16>(_mm256_slli_epi32::<16>(offsets));
    let column = along(walkers.column, low, ground.last_column);
    let row = along(walkers.row, _mm256_srai_epi32::<16>(offsets), ground.last_row);
    let shift = _mm256_permutevar8x32_epi32(ground.shifts, plane);
    let first = _mm256_add_epi32(_mm256_srlv_epi32(column, shift), _mm256_permutevar8x32_epi32(ground.firsts, plane));
    let stride = _mm256_permutevar8x32_epi32(ground.strides, plane);
    let index = _mm256_add_epi32(_mm256_mullo_epi32(_mm256_srlv_epi32(row, shift), stride), first);
    // SAFETY: column and row lie inside the image with its border, so inside each plane; one more value follows the last.
    let two = unsafe { _mm256_i32gather_epi32::<2>(ground.values, index) };
    _mm256_and_si256(two, _mm256_set1_epi32(0xFFFF))
}
