//! From labelled skin to the twelve joints: a model of each arm is laid into its skin, and a joint counts as seen where enough
//! skin of its own parts lies on the model near it.
//!
//! Keeps its buffer from image to image.

use super::arm::{ArmModel, Expected, LIMBS, Skin};
use super::chain::SegmentLengths;
use super::mode::Mode;
use super::sampling::Sampling;
use super::trust;
use super::{Classified, LEAST_DEVIATION};
use crate::body::{Joint, Side};
use crate::geometry::{Point, Vector};
use crate::vision::camera::Intrinsics;
use crate::vision::part::{CLASSES, Part, SHOULDER_SHARE, parts_of};
use nalgebra::Matrix3;

/// Points of skin that a part is thinned to: more tell the same.
const MOST_SKIN: usize = 150;
/// A part of fewer pixels has no middle to begin at.
const LEAST_PIXELS: usize = 12;
/// The shoulder's centre from the neck's root, in metres: outwards, and away from a camera above.
const SHOULDER_PLACE: (f64, f64) = (0.19, 0.11);
/// From the skin that is seen to a limb's axis, in metres along the line of sight.
const SKIN_TO_AXIS: f64 = 0.035;
/// Skin counts for a joint within this distance of it, in metres.
const OWN_RADIUS: f64 = 0.12;
/// Skin further than this from the limb's surface is another limb's or none, in metres.
const OFF_THE_LIMB: f64 = 0.04;
/// A joint is seen where its own skin covers this area across the view, in square metres: a square of 16 mm.
const LEAST_AREA: f64 = 2.5e-4;
/// A joint whose place is known less well than this is not seen, in metres.
const MOST_DEVIATION: f64 = 0.06;
/// In [`Skin::limb`]: the shoulder's, which the fit leaves alone, for breast and back belong to it as well.
const TORSO: u8 = 3;
const _: () = assert!(TORSO as usize == LIMBS);

/// A joint in the camera frame of the probe image.
#[derive(Clone, Copy, Debug)]
pub(super) struct Found {
    pub(super) place: Point,
    /// Square metres.
    pub(super) covariance: Matrix3<f64>,
    /// The area of its own skin near it, in square metres.
    pub(super) area: f64,
}

impl Found {
    /// Whether enough of the joint is seen.
    pub(super) fn is_seen(&self) -> bool {
        self.area >= LEAST_AREA && self.covariance.trace() < MOST_DEVIATION.powi(2)
    }

    /// From 0 to 1: how much of the skin that could be seen is.
    pub(super) fn confidence(&self) -> f64 {
        self.area / (self.area + 4.0 * LEAST_AREA)
    }
}

/// Lays models of arms into labelled skin.
#[derive(Clone, Debug, Default)]
pub(super) struct Bones {
    skin: Vec<Skin>,
    /// The area that a point of skin stands for, in square metres, at one metre.
    unit_areas: Vec<f64>,
}

/// Pixels of each class, of those that were asked, and how many of the image each stands for.
#[derive(Clone, Copy, Debug)]
pub(super) struct Counts {
    of_class: [usize; CLASSES],
    each: usize,
}

impl Counts {
    pub(super) fn of(pixels: &[Classified], sampling: Sampling) -> Self {
        let mut of_class = [0; CLASSES];
        for found in pixels {
            if let Some(count) = of_class.get_mut(usize::from(found.label)) {
                *count += 1;
            }
        }
        Self { of_class, each: sampling.each() }
    }
}

impl Bones {
    /// The joints of an arm, in the order of [`Joint::ALL`]. `known` are places to begin at, where votes have found some.
    pub(super) fn lay(
        &mut self,
        side: Side,
        pixels: &[Classified],
        counts: &Counts,
        camera: &Intrinsics,
        (neck, lengths): (&Point, &SegmentLengths),
        known: &[Option<Mode>; Joint::ALL.len()],
    ) -> [Found; Joint::ALL.len()] {
        let middles = self.gather(side, pixels, counts, camera);
        let (across, down) = SHOULDER_PLACE;
        let outwards = if side == Side::Left { across } else { -across };
        let voted = [Joint::Shoulder, Joint::Elbow, Joint::Wrist, Joint::Hand]
            .map(|joint| known.get(joint.index()).copied().flatten().map(|mode| mode.place));
        let expected = Expected { shoulder: neck + Vector::new(outwards, 0.0, down), lengths, voted };
        let mut arm = ArmModel::begin(&middles, &expected);
        for (end, voted) in arm.ends.iter_mut().zip(voted) {
            *end = voted.unwrap_or(*end);
        }
        let covariances = arm.fit(&self.skin, &expected);
        let mut found = Joint::ALL.map(|joint| self.found(joint, &arm, &covariances));
        // Where a forest has labelled, a joint that its votes leave out is one that the labels make up.
        if voted.iter().any(Option::is_some) {
            for ((joint, found), known) in Joint::ALL.into_iter().zip(&mut found).zip(known) {
                match trust::agreed(joint, found, known.as_ref()) {
                    Some(place) => found.place = place,
                    None => found.area = 0.0,
                }
            }
        }
        found
    }

    /// Thins the skin of an arm's parts and gives each limb's middle below it.
    fn gather(
        &mut self,
        side: Side,
        pixels: &[Classified],
        counts: &Counts,
        camera: &Intrinsics,
    ) -> [Option<Point>; LIMBS] {
        self.skin.clear();
        self.unit_areas.clear();
        let first = usize::from(Part::Shoulder.label(side));
        let of_side = counts.of_class.get(first..=first + LIMBS).unwrap_or(&[]);
        let mut left_out = [0; LIMBS + 1];
        let mut sums = [(Vector::zeros(), 0_u32); LIMBS];
        for found in pixels {
            let Some(part) = usize::from(found.label).checked_sub(first).filter(|part| *part <= LIMBS) else {
                continue;
            };
            let (Some(left_out), Some(count)) = (left_out.get_mut(part), of_side.get(part)) else { continue };
            let every = (count / MOST_SKIN).max(1);
            *left_out += 1;
            if *left_out % every != 0 {
                continue;
            }
            let depth = f64::from(found.pixel.depth) / 1000.0;
            let place = camera.point(f64::from(found.pixel.column), f64::from(found.pixel.row), depth);
            let limb = part.checked_sub(1);
            if let Some(sum) = limb.and_then(|limb| sums.get_mut(limb)) {
                sum.0 += place.coords;
                sum.1 += 1;
            }
            self.skin.push(skin(&place, limb));
            self.unit_areas.push((every * counts.each) as f64 / (camera.fx * camera.fy));
        }
        let mut middles = [None; LIMBS];
        for ((middle, (sum, count)), pixels) in middles.iter_mut().zip(sums).zip(of_side.iter().skip(1)) {
            if *pixels * counts.each >= LEAST_PIXELS && count > 0 {
                let mean = sum / f64::from(count);
                *middle = Some(Point::from(mean + mean.normalize() * SKIN_TO_AXIS));
            }
        }
        middles
    }

    /// A joint of an arm that lies in its skin.
    fn found(&self, joint: Joint, arm: &ArmModel, covariances: &[Matrix3<f64>; LIMBS + 1]) -> Found {
        let [shoulder, elbow, wrist, knuckle] = arm.ends;
        let [at_shoulder, at_elbow, at_wrist, at_knuckle] = covariances;
        let middle = f64::midpoint(1.0, SHOULDER_SHARE);
        let (place, covariance) = match joint {
            Joint::Hand => (knuckle, *at_knuckle),
            Joint::Wrist => (wrist, *at_wrist),
            Joint::Forearm => (nalgebra::center(&wrist, &elbow), (at_wrist + at_elbow) / 4.0),
            Joint::Elbow => (elbow, *at_elbow),
            Joint::UpperArm => (shoulder + (elbow - shoulder) * middle, (at_shoulder + at_elbow) / 4.0),
            Joint::Shoulder => (shoulder, *at_shoulder),
        };
        let covariance = covariance + Matrix3::identity() * LEAST_DEVIATION.powi(2);
        Found { place, covariance, area: self.own_area(joint, arm, &place) }
    }

    /// How much area the skin of a joint's parts covers near a place, as far as it lies on the model.
    fn own_area(&self, joint: Joint, arm: &ArmModel, place: &Point) -> f64 {
        let own = |limb: u8| {
            parts_of(joint).iter().any(|part| match part {
                Part::Shoulder => limb == TORSO,
                Part::UpperArm => limb == 0,
                Part::Forearm => limb == 1,
                Part::Hand => limb == 2,
            })
        };
        let near = |skin: &Skin| {
            let at = Point::from(skin.place.map(f64::from));
            (at - place).norm_squared() < OWN_RADIUS * OWN_RADIUS
                && (skin.limb == TORSO || arm.off(skin).abs() < OFF_THE_LIMB)
        };
        let area = |(skin, unit): (&Skin, &f64)| f64::from(skin.place[2]).powi(2) * unit;
        self.skin.iter().zip(&self.unit_areas).filter(|(skin, _)| own(skin.limb) && near(skin)).map(area).sum()
    }
}

#[expect(clippy::cast_possible_truncation, reason = "single precision is plenty for metres, and limbs are three")]
fn skin(place: &Point, limb: Option<usize>) -> Skin {
    Skin {
        place: [place.x as f32, place.y as f32, place.z as f32],
        limb: limb.map_or(TORSO, |limb| limb as u8),
        share: 1.0,
    }
}

#[cfg(test)]
mod tests;
