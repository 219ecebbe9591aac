//! Points side by side, so that one vector instruction works on the same axis of several, and what is summed over them.
//!
//! Plain arithmetic on short arrays, which the compiler turns into vector instructions; it knows nothing of a fit's rules.

use nalgebra::{Cholesky, SMatrix, SVector};
use std::array;
use std::f64::consts::{FRAC_1_SQRT_2, LN_2, LOG2_E, TAU};
use wide::f64x4;

/// Points that stand side by side.
pub(super) const LANES: usize = 4;
/// One number of each.
pub(super) type Lanes = f64x4;

/// All points about their mean, axis by axis. The last block is filled up with copies of the last point.
#[derive(Clone, Debug)]
pub(super) struct Cloud<const D: usize> {
    blocks: Vec<[Lanes; D]>,
    count: usize,
    mean: SVector<f64, D>,
}

impl<const D: usize> Cloud<D> {
    pub(super) fn new(points: &[SVector<f64, D>], mean: SVector<f64, D>) -> Self {
        let block = |group: &[SVector<f64, D>]| {
            let offset =
                |lane: usize| group.get(lane).or(group.last()).map_or_else(SVector::zeros, |point| point - mean);
            let offsets: [SVector<f64, D>; LANES] = array::from_fn(offset);
            array::from_fn(|axis| Lanes::new(offsets.map(|offset| offset.get(axis).copied().unwrap_or_default())))
        };
        Self { blocks: points.chunks(LANES).map(block).collect(), count: points.len(), mean }
    }

    pub(super) const fn count(&self) -> usize {
        self.count
    }

    /// What the points are counted from.
    pub(super) const fn mean(&self) -> &SVector<f64, D> {
        &self.mean
    }

    pub(super) const fn blocks(&self) -> &[[Lanes; D]] {
        self.blocks.as_slice()
    }

    /// Endlessly large numbers in place of those of copies: a share of them is none.
    pub(super) fn make_copies_endless(&self, totals: &mut [Lanes]) {
        let in_last = self.count - self.count.saturating_sub(1) / LANES * LANES;
        if let Some(last) = totals.last_mut() {
            let mut lanes = last.to_array();
            lanes.iter_mut().skip(in_last).for_each(|total| *total = f64::INFINITY);
            *last = Lanes::new(lanes);
        }
    }

    /// The sum of numbers, one a point.
    pub(super) fn sum_of(&self, values: &[Lanes]) -> f64 {
        values.iter().flat_map(|value| value.to_array()).take(self.count).sum()
    }

    /// The sum of the logarithms of positive normal numbers, one a point.
    ///
    /// A logarithm a number is dear: exponents are added and the rest is multiplied, 256 numbers to a logarithm.
    pub(super) fn sum_of_logarithms(&self, values: &[Lanes]) -> f64 {
        const MANTISSA: u64 = (1 << 52) - 1;
        const ONE: u64 = 1023 << 52;
        let (full, last) = values.split_at(values.len().saturating_sub(1));
        let mut sum = 0.0;
        for piece in full.chunks(256) {
            let (mut product, mut exponents) = (Lanes::ONE, [0_u64; LANES]);
            for value in piece {
                let bits = value.to_array().map(f64::to_bits);
                product *= Lanes::new(bits.map(|bits| f64::from_bits(bits & MANTISSA | ONE)));
                exponents.iter_mut().zip(bits).for_each(|(sum, bits)| *sum += bits >> 52);
            }
            sum += product.to_array().iter().map(|product| product.ln()).sum::<f64>();
            // Each exponent is stored with 1023 added.
            let stored: u64 = exponents.iter().sum();
            sum += (stored as f64 - (1023 * LANES * piece.len()) as f64) * LN_2;
        }
        let rest = self.count - full.len() * LANES;
        sum + last.iter().flat_map(|last| last.to_array()).take(rest).map(f64::ln).sum::<f64>()
    }
}

/// A Gaussian in the form that its logarithm is worked out from.
#[derive(Clone, Debug)]
pub(super) struct Density<const D: usize> {
    /// The rows of the inverse of the covariance's lower Cholesky factor over the root of 2, and what they make of the mean.
    rows: [([Lanes; D], Lanes); D],
    scale: Lanes,
}

impl<const D: usize> Density<D> {
    /// `mean` counts from the cloud's mean.
    pub(super) fn new(mean: &SVector<f64, D>, covariance: SMatrix<f64, D, D>) -> Self {
        // The floor keeps every covariance positive definite; should rounding say otherwise, the component explains nothing.
        let Some(factor) = Cholesky::new(covariance) else {
            return Self { rows: [([Lanes::ZERO; D], Lanes::ZERO); D], scale: Lanes::splat(f64::MIN) };
        };
        let lower = factor.l();
        let inverse: SMatrix<f64, D, D> =
            lower.solve_lower_triangular(&SMatrix::identity()).unwrap_or_else(SMatrix::identity);
        let whitening = inverse * FRAC_1_SQRT_2;
        let whitened = whitening * mean;
        let entry = |row, column| Lanes::splat(whitening.get((row, column)).map_or(0.0, |value: &f64| *value));
        let of_mean = |row: usize| Lanes::splat(whitened.get(row).map_or(0.0, |value: &f64| *value));
        let logarithm: f64 = lower.diagonal().iter().map(|value| value.ln()).sum();
        Self {
            rows: array::from_fn(|row| (array::from_fn(|column| entry(row, column)), of_mean(row))),
            scale: Lanes::splat(-0.5 * D as f64 * TAU.ln() - logarithm),
        }
    }

    /// The log density at the points of a block.
    #[inline]
    pub(super) fn logarithm(&self, block: &[Lanes; D]) -> Lanes {
        let mut sum = self.scale;
        for (number, (weights, of_mean)) in self.rows.iter().enumerate() {
            let weighted = weights.iter().zip(block).take(number + 1).map(|(weight, place)| *weight * *place);
            let off = weighted.fold(-*of_mean, |sum, part| sum + part);
            sum -= off * off;
        }
        sum
    }
}

/// What a component takes of the points: mass, and first and second moment about the cloud's mean.
#[derive(Clone, Debug)]
pub(super) struct Moments<const D: usize> {
    mass: Lanes,
    first: [Lanes; D],
    /// Below the diagonal and on it.
    second: [[Lanes; D]; D],
}

impl<const D: usize> Default for Moments<D> {
    fn default() -> Self {
        Self { mass: Lanes::ZERO, first: [Lanes::ZERO; D], second: [[Lanes::ZERO; D]; D] }
    }
}

impl<const D: usize> Moments<D> {
    /// Adds shares of the points of a block.
    #[inline]
    pub(super) fn add(&mut self, block: &[Lanes; D], shares: Lanes) {
        self.mass += shares;
        let rows = self.first.iter_mut().zip(&mut self.second).zip(block).enumerate();
        for (row, ((first, second), place)) in rows {
            let weighted = *place * shares;
            *first += weighted;
            for (second, other) in second.iter_mut().zip(block).take(row + 1) {
                *second += weighted * *other;
            }
        }
    }

    /// Mass, mean and covariance of what is taken, where each share counts as `weight`.
    pub(super) fn sums(&self, weight: f64) -> (f64, SVector<f64, D>, SMatrix<f64, D, D>) {
        let entry = |row: usize, column: usize| {
            let (row, column) = (row.max(column), row.min(column));
            self.second.get(row).and_then(|row| row.get(column)).map_or(0.0, |lanes| lanes.reduce_add())
        };
        let mass = self.mass.reduce_add();
        let mean = SVector::from_iterator(self.first.iter().map(|lanes| lanes.reduce_add())) / mass;
        let second: SMatrix<f64, D, D> = SMatrix::from_fn(entry);
        (mass * weight, mean, second / mass - mean * mean.transpose())
    }
}

/// The exponential function to within 5e-13 of it, held at e^-700 below and at e^700 above.
///
/// The standard library's is a call a number. Range reduction by ln 2 in two parts (Cody and Waite, 1980) and the Taylor series.
#[inline]
pub(super) fn exponential(value: Lanes) -> Lanes {
    /// Adding and taking away this rounds to a whole number and leaves it in the lowest bits.
    const ROUNDER: f64 = 6_755_399_441_055_744.0;
    /// 1/0! to 1/10!: enough for a rest of up to half of ln 2 and far more exact than the points.
    const INVERSE_FACTORIALS: [f64; 11] = [
        1.0,
        1.0,
        0.5,
        1.0 / 6.0,
        1.0 / 24.0,
        1.0 / 120.0,
        1.0 / 720.0,
        1.0 / 5_040.0,
        1.0 / 40_320.0,
        1.0 / 362_880.0,
        1.0 / 3_628_800.0,
    ];
    const LN_2_HIGH: f64 = 0.693_147_180_369_123_8;
    const LN_2_LOW: f64 = 1.908_214_929_270_587_7e-10;
    const MOST: f64 = 700.0;
    let clamped = value.fast_max(Lanes::splat(-MOST)).fast_min(Lanes::splat(MOST));
    let rounded = clamped * Lanes::splat(LOG2_E) + Lanes::splat(ROUNDER);
    let whole = rounded - Lanes::splat(ROUNDER);
    let rest = (clamped - whole * Lanes::splat(LN_2_HIGH)) - whole * Lanes::splat(LN_2_LOW);
    // Terms in pairs, pairs of pairs and so on (Estrin's scheme): in a row, each would wait for the one before.
    let [c0, c1, c2, c3, c4, c5, c6, c7, c8, c9, c10] = INVERSE_FACTORIALS.map(Lanes::splat);
    let square = rest * rest;
    let fourth = square * square;
    let low = (c0 + c1 * rest) + (c2 + c3 * rest) * square;
    let middle = (c4 + c5 * rest) + (c6 + c7 * rest) * square;
    let high = (c8 + c9 * rest) + c10 * square;
    let series = low + (middle + high * fourth) * fourth;
    let scale = rounded.to_array().map(|rounded| f64::from_bits(rounded.to_bits().wrapping_add(1023) << 52));
    series * Lanes::new(scale)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Vector;

    #[test]
    fn the_exponential_agrees_with_the_standard_library() {
        for index in -70_000..=70_000 {
            let value = f64::from(index) * 0.01 + 1e-4;
            let [ours, ..] = exponential(Lanes::splat(value)).to_array();
            let exact = value.min(700.0).exp();
            assert!((ours - exact).abs() <= 5e-13 * exact, "{value}: {ours} is not {exact}");
        }
        let vanishing = exponential(Lanes::new([-1e6, f64::NEG_INFINITY, -701.0, f64::MIN]));
        assert!(vanishing.to_array().iter().all(|value| *value > 0.0 && *value < 1e-303));
    }

    #[test]
    fn logarithms_are_summed_over_the_points_alone_however_many_there_are() {
        for count in [1, 3, 4, 5, 1023, 1024, 1025, 3000] {
            let values: Vec<f64> = (0..count).map(|index| 1.7_f64.powi(index % 900 - 450)).collect();
            let cloud = Cloud::new(&vec![Vector::zeros(); values.len()], Vector::zeros());
            let lanes: Vec<Lanes> = values
                .chunks(LANES)
                .map(|group| Lanes::new(array::from_fn(|lane| group.get(lane).copied().unwrap_or(7.0))))
                .collect();
            let exact: f64 = values.iter().map(|value| value.ln()).sum();
            assert!((cloud.sum_of_logarithms(&lanes) - exact).abs() < 1e-9 * (1.0 + exact.abs()), "{count}");
        }
    }

    #[test]
    fn moments_and_densities_are_those_of_the_points_one_by_one() {
        let points: Vec<Vector> =
            (0..7_u8).map(|index| Vector::new(f64::from(index).sin(), f64::from(index), 0.3)).collect();
        let middle = Vector::new(0.4, 2.0, 0.1);
        let cloud = Cloud::new(&points, middle);
        let mean = Vector::new(0.1, 0.2, 0.3);
        let covariance = nalgebra::Matrix3::new(0.5, 0.1, 0.0, 0.1, 0.7, -0.2, 0.0, -0.2, 0.9);
        let mixture = crate::modelling::Mixture::new([(1.0, mean, covariance)]).unwrap();
        let density = Density::new(&(mean - middle), covariance);
        let mut totals = vec![Lanes::HALF; cloud.blocks().len()];
        cloud.make_copies_endless(&mut totals);
        let mut moments = Moments::default();
        for (number, block) in cloud.blocks().iter().enumerate() {
            moments.add(block, Lanes::ONE / totals[number]);
            for (lane, logarithm) in density.logarithm(block).to_array().into_iter().enumerate() {
                let Some(point) = points.get(number * LANES + lane) else { continue };
                assert!((logarithm - mixture.log_density_at(point)).abs() < 1e-11);
            }
        }
        let (mass, first, second) = moments.sums(0.25);
        assert!((mass - 3.5).abs() < 1e-12);
        let (mean, exact) = crate::modelling::fit::moments(&points);
        assert!((first + middle - mean).norm() < 1e-12);
        assert!((second - exact).norm() < 1e-12);
    }
}
