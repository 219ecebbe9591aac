//! Where a sleeve is on its way along an arm, and when an iteration ends: what every garment notices by itself.

use super::super::person::Reaction;
use super::{Holder, Wearing};
use crate::geometry::{Point, Vector, closest_on_segment};

/// An armhole that comes this near to the hand goes round it, in metres: about the radius of an armhole.
const CAPTURE: f64 = 0.08;
/// An armhole that passes the hand within this distance without going round it drags over the arm, in metres.
const NEAR_MISS: f64 = 0.20;
/// An armhole that is brought this far beyond the fingertips has come off, in metres.
const RELEASE: f64 = 0.15;
/// A sleeve that has gone this far is under way: its return to the hand ends the iteration. Metres along the arm.
const UNDER_WAY: f64 = 0.10;
/// A gripper that is back within this distance of the hand has ended its iteration, in metres.
const BACK_AT_HAND: f64 = 0.05;

/// Where a gripper is in relation to a path.
#[derive(Clone, Copy, Debug)]
pub(super) struct Place {
    /// From the gripper to the closest point of the path.
    pub(super) towards: Vector,
    /// Direction of the path there, from hand to shoulder.
    pub(super) tangent: Vector,
    /// Length of the path up to there in metres.
    pub(super) along: f64,
    /// Length of the whole path in metres.
    pub(super) length: f64,
}

impl Place {
    /// The closest point of a path; `None` where it has fewer than two points.
    pub(super) fn on(path: &[Point], tip: &Point) -> Option<Self> {
        let mut best: Option<Self> = None;
        let mut length = 0.0;
        for (start, end) in path.iter().zip(path.iter().skip(1)) {
            let closest = closest_on_segment(tip, start, end);
            let towards = closest - tip;
            if best.is_none_or(|best| towards.norm_squared() < best.towards.norm_squared()) {
                let tangent = (end - start).try_normalize(1e-9).unwrap_or_else(Vector::zeros);
                best = Some(Self { towards, tangent, along: length + (closest - start).norm(), length: 0.0 });
            }
            length += (end - start).norm();
        }
        best.filter(|_| length > 0.0).map(|best| Self { length, ..best })
    }
}

/// One sleeve on its way.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Passage {
    pub(super) wearing: Wearing,
    furthest: f64,
    near: bool,
}

/// What a sleeve has just done.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Event {
    /// Nothing new.
    None,
    /// Gone onto the hand.
    PutOn,
    /// Back at the hand: an iteration has ended.
    Returned,
    /// Come off the hand.
    TakenOff,
}

impl Passage {
    /// Follows the gripper; ends the person's iteration when the sleeve is back at the hand.
    pub(super) fn notice(&mut self, holder: &Holder, hand: &Point, place: &Place, reaction: &mut Reaction) -> Event {
        let to_hand = (holder.tip - hand).norm();
        match self.wearing {
            Wearing::Off if to_hand < CAPTURE => {
                *self = Self { wearing: Wearing::On { metres: place.along }, ..Self::default() };
                Event::PutOn
            }
            Wearing::Off | Wearing::Missed { .. } => {
                self.pass_by(to_hand, place);
                Event::None
            }
            Wearing::On { .. } if place.along <= 0.0 && to_hand > RELEASE => {
                self.end(reaction);
                self.wearing = Wearing::Off;
                Event::TakenOff
            }
            Wearing::On { .. } => {
                self.wearing = Wearing::On { metres: place.along };
                self.furthest = self.furthest.max(place.along);
                if to_hand < BACK_AT_HAND && self.end(reaction) { Event::Returned } else { Event::None }
            }
            Wearing::Slipped => Event::None,
        }
    }

    /// An armhole that went past the hand from near it drags over the arm until it is away again.
    fn pass_by(&mut self, to_hand: f64, place: &Place) {
        if place.along <= 0.0 {
            self.near = to_hand < NEAR_MISS;
        }
        let over_the_arm = self.near && place.along > 0.0 && place.towards.norm() < NEAR_MISS;
        self.near = self.near && (over_the_arm || place.along <= 0.0);
        self.wearing = if over_the_arm { Wearing::Missed { metres: place.along } } else { Wearing::Off };
    }

    fn end(&mut self, reaction: &mut Reaction) -> bool {
        let under_way = self.furthest > UNDER_WAY;
        if under_way {
            reaction.end_pass();
            self.furthest = 0.0;
        }
        under_way
    }
}
