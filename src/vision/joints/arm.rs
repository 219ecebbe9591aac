//! An arm of round limbs laid into the labelled skin: centres of joints from surfaces that are only seen from one side.
//!
//! Shoulder, elbow, wrist and knuckle with the radii between them are moved until the skin lies where the labels say it
//! should: at a limb's radius from its axis, and between the limb's ends. Lengths and radii are held near those of people, so
//! a limb of which little is seen stays believable. Steps are Gauss and Newton's, damped; outliers lose their say by the rule
//! of `Geman` and `McClure` (1985). It never decides whether a joint is seen.

use super::chain::SegmentLengths;
use crate::geometry::{Point, Vector};
use crate::vision::part::SHOULDER_SHARE;
use nalgebra::{Matrix3, SMatrix, SVector};

/// Most steps; two to six do.
const MOST_STEPS: usize = 12;
/// A step that moves no joint further than this ends the fit, in metres.
const STANDSTILL: f64 = 4e-4;
/// Deviation of the skin from a round limb in metres: cloth, muscles, noise.
const SKIN_DEVIATION: f64 = 0.008;
/// Deviation of a border between two parts along a limb, in metres.
const BORDER_DEVIATION: f64 = 0.012;
/// Skin within this of a limb's end pushes the end outwards, in metres: so both neighbours hold their border from two sides.
const BORDER_MARGIN: f64 = 0.015;
/// The skin of one limb counts as this many measurements, however many pixels show it: neighbours err alike.
const MOST_MEASUREMENTS: f64 = 60.0;
/// Where an outlier loses half of its say: at first, and once the arm lies in place, in metres.
const OUTLIER: (f64, f64) = (0.10, 0.03);
/// The same at first, where votes tell already where the arm lies.
const OUTLIER_NEAR_VOTES: f64 = 0.05;
/// Deviation of the border between two parts as a forest draws it, in metres.
const BORDER_DEVIATION_OF_FORESTS: f64 = 0.05;
/// Deviation of an end that votes have found, in metres.
const VOTE_DEVIATION: f64 = 0.03;
/// Radii of upper arm, elbow and wrist with sleeves, and of the palm, in metres: ANSUR II's girths (2012) and a light cloth.
const RADII: [f64; 4] = [0.060, 0.049, 0.032, 0.026];
/// Deviation of a radius between people and sleeves, as a share of it.
const RADIUS_SPREAD: f64 = 0.2;
/// Skin beyond this share of the way from wrist to knuckle is the fingers'.
const FINGERS_BEGIN: f64 = 1.1;
/// Deviations of the shoulder from the place beside and below the neck, in metres: across, ahead, down.
const SHOULDER_DEVIATIONS: [f64; 3] = [0.035, 0.09, 0.06];
/// A damping that keeps the step of a direction of which nothing is known at nought.
const DAMPING: f64 = 1.0;

/// Numbers of the model: four joints, four radii.
const NUMBERS: usize = 16;
const FIRST_RADIUS: usize = 12;
type Normal = SMatrix<f64, NUMBERS, NUMBERS>;
type Numbers = SVector<f64, NUMBERS>;

/// The limbs that skin can belong to, from the shoulder outwards.
pub(super) const LIMBS: usize = 3;
/// The joints at the limbs' ends.
pub(super) const ENDS: usize = LIMBS + 1;

/// Skin that belongs to a limb.
#[derive(Clone, Copy, Debug)]
pub(super) struct Skin {
    pub(super) place: [f32; 3],
    pub(super) limb: u8,
    /// How sure that is, from 0 to 1.
    pub(super) share: f32,
}

/// Shoulder, elbow, wrist and knuckle, and the radii there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct ArmModel {
    pub(super) ends: [Point; ENDS],
    pub(super) radii: [f64; ENDS],
}

/// What an arm is held near.
#[derive(Clone, Copy, Debug)]
pub(super) struct Expected<'a> {
    /// Where the shoulder is, roughly.
    pub(super) shoulder: Point,
    pub(super) lengths: &'a SegmentLengths,
    /// Where votes have found the ends, in metres. Where they have, labels are a forest's: some are wrong, and an arm that
    /// left the votes would follow them.
    pub(super) voted: [Option<Point>; ENDS],
}

impl ArmModel {
    /// An arm to begin with, from the middles of its limbs' skin; a limb that is not seen goes on as the one before.
    pub(super) fn begin(middles: &[Option<Point>; LIMBS], expected: &Expected<'_>) -> Self {
        let Expected { shoulder, lengths, .. } = *expected;
        let [upper, fore, palm] = *middles;
        let ahead = Vector::new(0.0, 1.0, 0.0);
        let towards = |from: &Point, to: &Point| (to - from).try_normalize(1e-3).unwrap_or(ahead);
        let elbow = match (upper, fore) {
            (Some(upper), _) => shoulder + towards(&shoulder, &upper) * lengths.upper_arm,
            (None, Some(fore)) => fore + towards(&fore, &shoulder) * (lengths.forearm / 2.0),
            (None, None) => shoulder + palm.map_or(ahead, |palm| towards(&shoulder, &palm)) * lengths.upper_arm,
        };
        let next = fore.or(palm).map_or_else(|| towards(&shoulder, &elbow), |next| towards(&elbow, &next));
        let wrist = elbow + next * lengths.forearm;
        let last = palm.map_or(next, |palm| towards(&wrist, &palm));
        Self { ends: [shoulder, elbow, wrist, wrist + last * lengths.palm], radii: RADII }
    }

    /// Moves the arm to where the skin says; the covariance of each end in square metres, of the last step's equations.
    pub(super) fn fit(&mut self, skin: &[Skin], expected: &Expected<'_>) -> [Matrix3<f64>; ENDS] {
        let mut known = [Matrix3::identity(); ENDS];
        let mut weights = [0.0; LIMBS];
        for point in skin {
            if let Some(weight) = weights.get_mut(usize::from(point.limb)) {
                *weight += f64::from(point.share);
            }
        }
        let weights = weights.map(|sum: f64| sum.min(MOST_MEASUREMENTS) / sum.max(1e-9));
        let is_voted = expected.voted.iter().any(Option::is_some);
        let widest = if is_voted { OUTLIER_NEAR_VOTES } else { OUTLIER.0 };
        let border = if is_voted { BORDER_DEVIATION_OF_FORESTS } else { BORDER_DEVIATION };
        for step in 0..MOST_STEPS {
            let ease = step as f64 / 4.0;
            let outlier = OUTLIER.1.max(widest * 0.5_f64.powf(ease));
            let mut sums = Sums::default();
            for point in skin {
                let Some(weight) = weights.get(usize::from(point.limb)) else { continue };
                self.hear(&mut sums, point, weight * f64::from(point.share), (outlier, border));
            }
            self.hold(&mut sums, expected);
            let Some((moved, inverse)) = sums.solve() else { break };
            self.take(&moved);
            for (number, known) in known.iter_mut().enumerate() {
                *known = inverse.fixed_view::<3, 3>(3 * number, 3 * number).into();
            }
            if outlier <= OUTLIER.1 && moved.rows(0, FIRST_RADIUS).amax() < STANDSTILL {
                break;
            }
        }
        known
    }

    /// How far skin lies off its limb's surface, in metres: positive outside; endlessly far where it belongs to no limb.
    pub(super) fn off(&self, skin: &Skin) -> f64 {
        let limb = usize::from(skin.limb);
        let (Some(start), Some(end)) = (self.ends.get(limb), self.ends.get(limb + 1)) else { return f64::INFINITY };
        let (Some(thick), Some(thin)) = (self.radii.get(limb), self.radii.get(limb + 1)) else { return f64::INFINITY };
        let place = Point::from(skin.place.map(f64::from));
        let axis = end - start;
        let foot = ((place - start).dot(&axis) / axis.norm_squared().max(1e-6)).clamp(0.0, 1.0);
        (place - (start + axis * foot)).norm() - (thick * (1.0 - foot) + thin * foot)
    }

    /// Adds what a point of skin says.
    fn hear(&self, sums: &mut Sums, skin: &Skin, weight: f64, (outlier, border): (f64, f64)) {
        let limb = usize::from(skin.limb);
        let (Some(start), Some(end)) = (self.ends.get(limb), self.ends.get(limb + 1)) else { return };
        let (Some(thick), Some(thin)) = (self.radii.get(limb), self.radii.get(limb + 1)) else { return };
        let place = Point::from(skin.place.map(f64::from));
        let axis = end - start;
        let length = axis.norm().max(1e-3);
        let share = (place - start).dot(&axis) / (length * length);
        let foot = share.clamp(0.0, 1.0);
        let away = place - (start + axis * foot);
        let distance = away.norm().max(1e-4);
        let off = distance - (thick * (1.0 - foot) + thin * foot);
        let say = (1.0 + (off / outlier).powi(2)).powi(-2) * weight;
        // Fingers reach beyond the knuckle, and how they bend is not modelled.
        let is_hand = limb + 1 == LIMBS;
        if is_hand && share > FINGERS_BEGIN {
            return;
        }
        sums.add_skin(limb, &(away / distance), foot, off, say / SKIN_DEVIATION.powi(2));
        let direction = axis / length;
        let border = say / border.powi(2);
        let least = if limb == 0 { SHOULDER_SHARE } else { 0.0 };
        let before = (share - least) * length;
        if before < BORDER_MARGIN {
            sums.add_border(limb, &direction, least, before - BORDER_MARGIN, border);
        }
        let after = (share - 1.0) * length;
        if after > -BORDER_MARGIN && !is_hand {
            sums.add_border(limb, &direction, 1.0, after + BORDER_MARGIN, border);
        }
    }

    /// Adds what is known of people.
    fn hold(&self, sums: &mut Sums, expected: &Expected<'_>) {
        let lengths = expected.lengths;
        let wanted = [lengths.upper_arm, lengths.forearm, lengths.palm];
        for (limb, wanted) in wanted.into_iter().enumerate() {
            let (Some(start), Some(end)) = (self.ends.get(limb), self.ends.get(limb + 1)) else { continue };
            let axis = end - start;
            let length = axis.norm().max(1e-3);
            sums.add_length(limb, &(axis / length), length - wanted, (wanted * lengths.spread).powi(-2));
        }
        for (number, (end, voted)) in self.ends.iter().zip(expected.voted).enumerate() {
            let Some(voted) = voted else { continue };
            for (axis, off) in (end - voted).iter().enumerate() {
                sums.add_one(3 * number + axis, *off, VOTE_DEVIATION.powi(-2));
            }
        }
        let [shoulder, ..] = &self.ends;
        for (axis, (off, deviation)) in (shoulder - expected.shoulder).iter().zip(SHOULDER_DEVIATIONS).enumerate() {
            sums.add_one(axis, *off, deviation.powi(-2));
        }
        for (number, (radius, wanted)) in self.radii.iter().zip(RADII).enumerate() {
            sums.add_one(FIRST_RADIUS + number, radius - wanted, (wanted * RADIUS_SPREAD).powi(-2));
        }
    }

    fn take(&mut self, moved: &Numbers) {
        for (number, end) in self.ends.iter_mut().enumerate() {
            let step = Vector::new(at(moved, 3 * number), at(moved, 3 * number + 1), at(moved, 3 * number + 2));
            // A step longer than a limb's half goes beyond where the straight lines of the method hold.
            *end += step * (0.12 / step.norm().max(0.12));
        }
        for (number, (radius, wanted)) in self.radii.iter_mut().zip(RADII).enumerate() {
            *radius = (*radius + at(moved, FIRST_RADIUS + number)).clamp(0.5 * wanted, 2.0 * wanted);
        }
    }
}

fn at(numbers: &Numbers, index: usize) -> f64 {
    numbers.get(index).copied().unwrap_or(0.0)
}

/// The gradient at both ends of a limb along a direction, each end with its factor.
fn of_ends(limb: usize, direction: &Vector, [start, end]: [f64; 2]) -> [(usize, f64); 6] {
    let first = 3 * limb;
    [
        (first, start * direction.x),
        (first + 1, start * direction.y),
        (first + 2, start * direction.z),
        (first + 3, end * direction.x),
        (first + 4, end * direction.y),
        (first + 5, end * direction.z),
    ]
}

/// The normal equations: sums of weighted gradients' products, and of gradients times what is off.
#[derive(Debug)]
struct Sums {
    normal: Normal,
    right: Numbers,
}

impl Default for Sums {
    fn default() -> Self {
        Self { normal: Normal::identity() * DAMPING, right: Numbers::zeros() }
    }
}

impl Sums {
    /// What is off, with its gradient at a few numbers in ascending order. Only the lower half of the products is summed:
    /// nothing else is read.
    fn add<const COUNT: usize>(&mut self, gradient: [(usize, f64); COUNT], off: f64, weight: f64) {
        for (count, (row, first)) in (1..).zip(gradient) {
            for (column, second) in gradient.into_iter().take(count) {
                if let Some(sum) = self.normal.get_mut((row, column)) {
                    *sum += weight * first * second;
                }
            }
            if let Some(sum) = self.right.get_mut(row) {
                *sum -= weight * first * off;
            }
        }
    }

    fn add_one(&mut self, number: usize, off: f64, weight: f64) {
        self.add([(number, 1.0)], off, weight);
    }

    /// Skin `off` its limb's radius, `normal` pointing from the axis to it, beside a `foot` between both ends.
    fn add_skin(&mut self, limb: usize, normal: &Vector, foot: f64, off: f64, weight: f64) {
        let [a, b, c, d, e, f] = of_ends(limb, normal, [foot - 1.0, -foot]);
        let radius = FIRST_RADIUS + limb;
        self.add([a, b, c, d, e, f, (radius, foot - 1.0), (radius + 1, -foot)], off, weight);
    }

    /// Skin `off` along a limb's direction from the border at a share between both ends.
    fn add_border(&mut self, limb: usize, direction: &Vector, share: f64, off: f64, weight: f64) {
        self.add(of_ends(limb, direction, [share - 1.0, -share]), off, weight);
    }

    /// A limb that is too long by `off`.
    fn add_length(&mut self, limb: usize, direction: &Vector, off: f64, weight: f64) {
        self.add(of_ends(limb, direction, [-1.0, 1.0]), off, weight);
    }

    fn solve(self) -> Option<(Numbers, Normal)> {
        let inverse = self.normal.cholesky()?.inverse();
        let moved = inverse * self.right;
        moved.iter().all(|value| value.is_finite()).then_some((moved, inverse))
    }
}
