//! The two criteria by which a dressing path is judged (thesis chapter 5): reachability and comfort.
//!
//! Reachability: for each place, the best limb through it. Comfort: how far the path is from one without resistance,
//! where such a path is known (synthetic problems), and the resistance itself on the robot.

use crate::geometry::{Curve, Point, polyline_length};
use crate::modelling::ArmSpace;
use crate::modelling::stick::{Limb, Reachability, StickFit};
use crate::planning::line;

/// Scores below this say no more than "out of reach", and one of them should not drown a mean.
const FLOOR: f64 = -30.0;

/// Judges how reachable places are for one arm.
#[derive(Clone, Debug)]
pub struct Reach {
    space: ArmSpace,
    lengths: [f64; 2],
    /// For each limb the sum of the log densities at the modes of its two ends.
    best: [f64; 2],
    fit: StickFit,
}

/// A path judged.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PathReach {
    /// Mean over the path's length of the best limb's log density less the best possible; 0 is best.
    pub score: f64,
    /// Share of the path's length where some limb has both ends inside a 95 % region.
    pub inside_share: f64,
}

impl Reach {
    /// A judge for an arm whose joints start at `initial` (hand, elbow, shoulder): its limbs have those lengths.
    #[must_use]
    pub fn new(space: ArmSpace, initial: &[Point; 3], fit: StickFit) -> Self {
        let [hand, elbow, shoulder] = initial;
        let [h, e, s] = space.dressed().map(|mixture| mixture.log_density(&mixture.mode()));
        let lengths = [(elbow - hand).norm(), (shoulder - elbow).norm()];
        Self { space, lengths, best: [h + e, e + s], fit }
    }

    /// How reachable a place is: the better of the two limbs.
    #[must_use]
    pub fn at(&self, point: &Point) -> Reachability {
        let [hand, elbow, shoulder] = self.space.dressed();
        let limbs = [(hand, elbow), (elbow, shoulder)].into_iter().zip(self.lengths).zip(self.best);
        let judged = limbs.map(|(((start, end), length), best)| {
            self.fit.reachability(point, &Limb { start, end, together: None, length }, best)
        });
        let none = Reachability { score: FLOOR, inside: false };
        judged.fold(none, |best, next| Reachability {
            score: best.score.max(next.score),
            inside: best.inside || next.inside,
        })
    }

    /// How reachable a whole path is, judged every `spacing` metres.
    #[must_use]
    pub fn along(&self, path: &[Point], spacing: f64) -> PathReach {
        let mut sum = PathReach { score: 0.0, inside_share: 0.0 };
        let mut total = 0.0;
        for (point, weight) in stations(path, spacing) {
            let reached = self.at(&point);
            sum.score += weight * reached.score;
            sum.inside_share += if reached.inside { weight } else { 0.0 };
            total += weight;
        }
        let total = if total > 0.0 { total } else { 1.0 };
        PathReach { score: sum.score / total, inside_share: sum.inside_share / total }
    }
}

/// Comfort on a problem whose path without resistance is known.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Comfort {
    /// Mean distance to the path without resistance, in metres.
    pub mean_distance: f64,
    /// Largest distance.
    pub maximum_distance: f64,
    /// Share of the length that is farther away than the threshold of a contact.
    pub share_beyond: f64,
}

/// How far a path is from `reference`, judged every `spacing` metres.
#[must_use]
pub fn comfort(path: &[Point], reference: &Curve, threshold: f64, spacing: f64) -> Comfort {
    let mut result = Comfort { mean_distance: 0.0, maximum_distance: 0.0, share_beyond: 0.0 };
    let mut total = 0.0;
    for (point, weight) in stations(path, spacing) {
        let distance = reference.displacement(&point).norm();
        result.mean_distance += weight * distance;
        result.maximum_distance = result.maximum_distance.max(distance);
        result.share_beyond += if distance > threshold { weight } else { 0.0 };
        total += weight;
    }
    if total > 0.0 {
        result.mean_distance /= total;
        result.share_beyond /= total;
    }
    result
}

/// The middles of the pieces of a path, each piece at most `spacing` long, with the pieces' lengths.
fn stations(path: &[Point], spacing: f64) -> impl Iterator<Item = (Point, f64)> {
    // A path that has run away would take for ever to judge at that spacing, and no one needs it that finely.
    let spacing = spacing.max(polyline_length(path) / 2_000.0);
    path.iter().zip(path.iter().skip(1)).flat_map(move |(start, end)| {
        let along = end - start;
        let count = line::steps(along.norm(), spacing);
        let piece = 1.0 / f64::from(count.max(1));
        let weight = along.norm() * piece;
        (0..count).map(move |index| (start + along * ((f64::from(index) + 0.5) * piece), weight))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_path_on_its_reference_is_as_comfortable_as_can_be() {
        let path = [Point::origin(), Point::new(1.0, 0.0, 0.0), Point::new(1.0, 1.0, 0.0)];
        let judged = comfort(&path, &Curve::new(path.to_vec()), 0.1, 0.1);
        assert!(judged.mean_distance < 1e-12 && judged.share_beyond < 1e-12);
    }

    #[test]
    fn distance_is_weighted_by_length() {
        let reference = Curve::new(vec![Point::origin(), Point::new(4.0, 0.0, 0.0)]);
        let beside = [Point::new(0.0, 0.5, 0.0), Point::new(3.0, 0.5, 0.0), Point::new(3.0, -0.5, 0.0)];
        let judged = comfort(&beside, &reference, 0.4, 0.1);
        assert!((judged.mean_distance - (3.0 * 0.5 + 0.25) / 4.0).abs() < 1e-9);
        assert!((judged.share_beyond - 3.2 / 4.0).abs() < 1e-9);
        assert!((judged.maximum_distance - 0.5).abs() < 1e-9);
    }

    #[test]
    fn a_path_without_length_is_judged_without_a_division_by_nothing() {
        let judged = comfort(&[Point::origin(), Point::origin()], &Curve::new(vec![Point::origin()]), 0.1, 0.1);
        assert!(judged.mean_distance < 1e-12);
    }
}
