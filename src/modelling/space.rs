//! The movement space of a person: for each arm, where hand, elbow and shoulder can be (thesis section 3.3).

use super::fit::{FitError, FitSettings, fit};
use super::mixture::Mixture;
use crate::body::{Joint, PerSide};
use crate::geometry::{Point, Vector};
use nalgebra::SVector;
use serde::{Deserialize, Serialize};

/// Where the joints of one arm can be, each joint a mixture of its own as in the thesis.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ArmSpace {
    /// The hand.
    pub hand: Mixture,
    /// The elbow.
    pub elbow: Mixture,
    /// The shoulder.
    pub shoulder: Mixture,
    /// Hand, elbow and shoulder in one mixture, where they were recorded together: unlike the thesis' three, it knows which
    /// hand goes with which elbow, and so the limbs' lengths.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub whole: Option<Mixture<9>>,
}

impl ArmSpace {
    /// Fits each joint's mixture to the places where it was seen (hand, elbow, shoulder; metres in `base`).
    ///
    /// # Errors
    /// A [`FitError`] where a joint was never seen or a place is not finite.
    pub fn fit(places: &[Vec<Vector>; 3], settings: &FitSettings, seed: u64) -> Result<Self, FitError> {
        let [hand, elbow, shoulder] = places;
        let mixture = |joint: &[Vector]| fit(joint, settings, seed).map(|fitted| fitted.mixture);
        let (hand, elbow, shoulder) = (mixture(hand)?, mixture(elbow)?, mixture(shoulder)?);
        Ok(Self { hand, elbow, shoulder, whole: fit_together(places, settings, seed)? })
    }

    /// The two ends of each limb in one mixture: hand and elbow, elbow and shoulder. `None` where the joints were not
    /// recorded together.
    #[must_use]
    pub fn limbs_together(&self) -> Option<[Mixture<6>; 2]> {
        let whole = self.whole.as_ref()?;
        Some([whole.marginal([0, 1, 2, 3, 4, 5]).ok()?, whole.marginal([3, 4, 5, 6, 7, 8]).ok()?])
    }

    /// The mixture of a joint; `None` where the thesis models none (wrist, forearm, upper arm).
    #[must_use]
    pub const fn joint(&self, joint: Joint) -> Option<&Mixture> {
        match joint {
            Joint::Hand => Some(&self.hand),
            Joint::Elbow => Some(&self.elbow),
            Joint::Shoulder => Some(&self.shoulder),
            Joint::Wrist | Joint::Forearm | Joint::UpperArm => None,
        }
    }

    /// The three mixtures in the order in which a garment passes the joints.
    #[must_use]
    pub const fn dressed(&self) -> [&Mixture; 3] {
        [&self.hand, &self.elbow, &self.shoulder]
    }

    /// The initial dressing path of thesis section 5.2.2: the most probable place of each joint, with the elbow moved to
    /// the most probable place that keeps the arm's lengths where it misses them by more than 1.5 cm.
    ///
    /// `lengths` are the forearm's (hand to elbow) and the upper arm's in metres.
    #[must_use]
    pub fn initial_path(&self, lengths: [f64; 2]) -> [Point; 3] {
        let (hand, elbow, shoulder) = (self.hand.mode(), self.elbow.mode(), self.shoulder.mode());
        [hand, elbow_on_the_arm(&self.elbow, &hand, &elbow, &shoulder, lengths), shoulder]
    }
}

/// One mixture over all three joints; `None` where they were not seen equally often, so not together.
fn fit_together(places: &[Vec<Vector>; 3], settings: &FitSettings, seed: u64) -> Result<Option<Mixture<9>>, FitError> {
    let [hand, elbow, shoulder] = places;
    if hand.len() != elbow.len() || elbow.len() != shoulder.len() {
        return Ok(None);
    }
    let joints = hand.iter().zip(elbow).zip(shoulder);
    let postures: Vec<SVector<f64, 9>> = joints
        .map(|((hand, elbow), shoulder)| {
            SVector::from_iterator(hand.iter().chain(elbow.iter()).chain(shoulder.iter()).copied())
        })
        .collect();
    fit(&postures, settings, seed).map(|fitted| Some(fitted.mixture))
}

/// By how much the elbow may miss the arm's lengths before it is moved (thesis section 5.2.2).
const LENGTH_TOLERANCE_METRES: f64 = 0.015;

/// The elbow itself where it fits the lengths; otherwise the most probable point of the circle on which an elbow with
/// these lengths can lie. Where no such circle exists (hand too far or too close) the nearest point on the line.
fn elbow_on_the_arm(mixture: &Mixture, hand: &Point, elbow: &Point, shoulder: &Point, lengths: [f64; 2]) -> Point {
    /// Steps of the search round the circle: 1 degree, below 6 mm on any arm.
    const STEPS: u32 = 360;
    let [forearm, upper_arm] = lengths;
    let fits = |actual: f64, wanted: f64| (actual - wanted).abs() <= LENGTH_TOLERANCE_METRES;
    if fits((elbow - hand).norm(), forearm) && fits((shoulder - elbow).norm(), upper_arm) {
        return *elbow;
    }
    let line = shoulder - hand;
    let distance = line.norm();
    if distance < 1e-9 {
        return *elbow;
    }
    let along = line / distance;
    let reach = (distance * distance + forearm * forearm - upper_arm * upper_arm) / (2.0 * distance);
    let radius_squared = forearm * forearm - reach * reach;
    let centre = hand + along * reach.clamp(-forearm, forearm);
    if radius_squared <= 0.0 {
        return centre;
    }
    let any = if along.z.abs() < 0.9 { nalgebra::Vector3::z() } else { nalgebra::Vector3::x() };
    let first = along.cross(&any).normalize() * radius_squared.sqrt();
    let second = along.cross(&first);
    let on_circle = (0..STEPS).map(|step| {
        let (sine, cosine) = f64::from(step).to_radians().sin_cos();
        centre + first * cosine + second * sine
    });
    let density = |point: &Point| mixture.log_density(point);
    on_circle.max_by(|left, right| density(left).total_cmp(&density(right))).unwrap_or(centre)
}

/// The movement space of a person.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(transparent)]
pub struct MovementSpace {
    /// Both arms.
    pub arms: PerSide<ArmSpace>,
}
