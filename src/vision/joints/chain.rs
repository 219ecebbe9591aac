//! Which of each joint's candidates make an arm: lengths between neighbours decide against a lone heap of wrong votes.
//!
//! A joint may also be left out, where no candidate fits. Lengths are those of adults unless a person's own are known.

use super::mode::{MOST_MODES, Mode, Modes};
use crate::body::{Joint, PerSide, Side};
use crate::geometry::Point;
use crate::vision::part::SHOULDER_SHARE;
use serde::{Deserialize, Serialize};

/// The order along the arm.
const ORDER: [Joint; 6] = [Joint::Shoulder, Joint::UpperArm, Joint::Elbow, Joint::Forearm, Joint::Wrist, Joint::Hand];
/// Leaving a joint out costs as much as this, in nats: less than a candidate three deviations off, more than a weak one in place.
const LEFT_OUT: f64 = 4.0;
/// Nothing costs more than this, in nats: a broken chain must not drown what else is known.
const MOST_COST: f64 = 25.0;
/// How well votes place a joint, in metres: added to the spread of lengths.
const VOTE_DEVIATION: f64 = 0.03;

/// Distances between joints of one person, in metres.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct SegmentLengths {
    /// From the neck to the shoulder's centre.
    pub neck_to_shoulder: f64,
    /// From shoulder to elbow.
    pub upper_arm: f64,
    /// From elbow to wrist.
    pub forearm: f64,
    /// From wrist to the middle finger's knuckle.
    pub palm: f64,
    /// Standard deviation of each, as a share of it.
    pub spread: f64,
}

impl Default for SegmentLengths {
    /// Adults: the means of women and men of ANSUR II (2012), which differ by about 8 %.
    fn default() -> Self {
        Self { neck_to_shoulder: 0.21, upper_arm: 0.31, forearm: 0.255, palm: 0.09, spread: 0.1 }
    }
}

impl SegmentLengths {
    /// The expected distance from a joint to the next one inwards.
    fn inwards(&self, joint: Joint) -> f64 {
        let middle = f64::midpoint(1.0, SHOULDER_SHARE);
        match joint {
            Joint::Shoulder => self.neck_to_shoulder,
            Joint::UpperArm => self.upper_arm * middle,
            Joint::Elbow => self.upper_arm * (1.0 - middle),
            Joint::Forearm | Joint::Wrist => self.forearm / 2.0,
            Joint::Hand => self.palm,
        }
    }

    /// What the way from one place along the arm to another costs, in nats. Neighbours have a distance to keep; where joints
    /// between them are left out, they must not be further apart than the stretched arm.
    fn cost(&self, from: Option<usize>, to: usize, distance: f64) -> f64 {
        let first = from.map_or(0, |from| from + 1);
        let stretched: f64 = ORDER.iter().skip(first).take(to + 1 - first).map(|joint| self.inwards(*joint)).sum();
        let deviation = (stretched * self.spread).hypot(VOTE_DEVIATION);
        let off = if first == to { distance - stretched } else { (distance - stretched).max(0.0) };
        ((off / deviation).powi(2) / 2.0).min(MOST_COST)
    }
}

/// The best candidate of each joint, in the order of [`Joint::ALL`]; `None` where none fits.
pub(super) fn choose(
    modes: &PerSide<[Modes; Joint::ALL.len()]>,
    neck: &Point,
    lengths: &SegmentLengths,
) -> PerSide<[Option<Mode>; Joint::ALL.len()]> {
    PerSide::from_fn(|side: Side| choose_arm(modes.get(side), neck, lengths))
}

/// The cheapest way to a candidate: what it costs, and the candidate before it (its place in the order, its number).
#[derive(Clone, Copy)]
struct Way {
    cost: f64,
    from: Option<(usize, usize)>,
}

/// The cheapest way from the neck to the end of the arm through candidates, any joint of which may be left out.
fn choose_arm(
    modes: &[Modes; Joint::ALL.len()],
    neck: &Point,
    lengths: &SegmentLengths,
) -> [Option<Mode>; Joint::ALL.len()] {
    let mut ways: [[Option<Way>; MOST_MODES]; ORDER.len()] = Default::default();
    let mut best = Way { cost: LEFT_OUT * ORDER.len() as f64, from: None };
    for to in 0..ORDER.len() {
        for number in 0..MOST_MODES {
            let Some(mode) = candidate(modes, (to, number)) else { continue };
            let way = cheapest(modes, &ways, neck, (to, &mode), lengths);
            let to_the_end = way.cost + LEFT_OUT * (ORDER.len() - 1 - to) as f64;
            if to_the_end < best.cost {
                best = Way { cost: to_the_end, from: Some((to, number)) };
            }
            if let Some(slot) = ways.get_mut(to).and_then(|ways| ways.get_mut(number)) {
                *slot = Some(way);
            }
        }
    }
    let mut chosen = [None; Joint::ALL.len()];
    let mut at = best.from;
    while let Some((place, number)) = at {
        if let Some(slot) = ORDER.get(place).and_then(|joint| chosen.get_mut(joint.index())) {
            *slot = candidate(modes, (place, number));
        }
        at = ways.get(place).and_then(|ways| ways.get(number).copied().flatten()).and_then(|way| way.from);
    }
    chosen
}

/// The cheapest way to a candidate, from the neck or from any candidate further in.
fn cheapest(
    modes: &[Modes; Joint::ALL.len()],
    ways: &[[Option<Way>; MOST_MODES]; ORDER.len()],
    neck: &Point,
    (to, mode): (usize, &Mode),
    lengths: &SegmentLengths,
) -> Way {
    let own = -mode.share.max(1e-6).ln();
    let step = |from: Option<usize>, place: &Point| {
        let left_out = from.map_or(to, |from| to - from - 1);
        own + LEFT_OUT * left_out as f64 + lengths.cost(from, to, (mode.place - place).norm())
    };
    let mut best = Way { cost: step(None, neck), from: None };
    for (from, ways) in ways.iter().enumerate().take(to) {
        for (number, way) in ways.iter().enumerate() {
            let (Some(way), Some(inner)) = (way, candidate(modes, (from, number))) else { continue };
            let cost = way.cost + step(Some(from), &inner.place);
            if cost < best.cost {
                best = Way { cost, from: Some((from, number)) };
            }
        }
    }
    best
}

fn candidate(modes: &[Modes; Joint::ALL.len()], (place, number): (usize, usize)) -> Option<Mode> {
    let joint = ORDER.get(place)?;
    modes.get(joint.index())?.get(number).copied().flatten()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[expect(clippy::unnecessary_wraps, reason = "a place in a list of modes may be empty")]
    fn heap(x: f64, share: f64) -> Option<Mode> {
        Some(Mode { place: Point::new(x, 0.0, 1.0), share })
    }

    /// A straight arm along x with all candidates in place.
    fn arm() -> [Modes; Joint::ALL.len()] {
        let mut modes = [Modes::default(); Joint::ALL.len()];
        for (joint, x) in ORDER.into_iter().zip([0.21, 0.40, 0.52, 0.6475, 0.775, 0.865]) {
            modes[joint.index()][0] = heap(x, 0.7);
        }
        modes
    }

    fn x_of(chosen: &[Option<Mode>; 6], joint: Joint) -> Option<f64> {
        chosen[joint.index()].map(|mode| mode.place.x)
    }

    fn chosen(modes: &[Modes; 6]) -> [Option<Mode>; 6] {
        choose_arm(modes, &Point::new(0.0, 0.0, 1.0), &SegmentLengths::default())
    }

    #[test]
    fn an_arm_whose_candidates_fit_is_taken_whole() {
        let found = chosen(&arm());
        assert!(Joint::ALL.iter().all(|joint| found[joint.index()].is_some()));
    }

    #[test]
    fn a_heavier_candidate_that_makes_no_arm_loses_against_a_lighter_one_in_place() {
        let mut modes = arm();
        modes[Joint::Wrist.index()] = [heap(-0.4, 0.6), heap(0.775, 0.2), None];
        assert_eq!(x_of(&chosen(&modes), Joint::Wrist), Some(0.775));
    }

    #[test]
    fn a_lone_candidate_far_from_its_neighbours_is_left_out_and_the_rest_stays() {
        let mut modes = arm();
        modes[Joint::Forearm.index()] = [heap(-0.4, 0.3), None, None];
        let found = chosen(&modes);
        assert_eq!(x_of(&found, Joint::Forearm), None);
        assert_eq!(found.iter().flatten().count(), 5);
        assert_eq!(chosen(&[Modes::default(); 6]).iter().flatten().count(), 0);
    }

    #[test]
    fn a_whole_end_of_the_other_arm_is_left_out_though_it_hangs_together() {
        let mut modes = arm();
        modes[Joint::Forearm.index()] = Modes::default();
        modes[Joint::Wrist.index()] = [heap(-0.775, 0.9), None, None];
        modes[Joint::Hand.index()] = [heap(-0.865, 0.9), None, None];
        let found = chosen(&modes);
        assert_eq!((x_of(&found, Joint::Wrist), x_of(&found, Joint::Hand)), (None, None));
        assert_eq!(x_of(&found, Joint::Elbow), Some(0.52));
    }

    #[test]
    fn a_person_s_own_lengths_decide_between_two_that_fit_adults() {
        let mut modes = arm();
        modes[Joint::Hand.index()] = [heap(0.865, 0.4), heap(0.845, 0.38), None];
        let lengths = SegmentLengths { palm: 0.06, spread: 0.02, ..SegmentLengths::default() };
        let found = choose_arm(&modes, &Point::new(0.0, 0.0, 1.0), &lengths);
        assert_eq!(x_of(&found, Joint::Hand), Some(0.845));
    }
}
