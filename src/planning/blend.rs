//! Comfort first, then reach: a path that is comfortable is moved towards one that is reachable, place by place.
//!
//! Each station of the comfort path may move towards the same share of the reachable path. How far is decided for all
//! stations together: the sum of reachability (nats) less the weight times the distance from comfort, with neighbours
//! held together so that the path stays smooth. It is exact on its grid (dynamic programming), and draws nothing.

use super::criteria::Reach;
use super::line;
use crate::geometry::{Point, polyline_length};

/// Shares of the way to the reachable path that are tried: 0 to 1.2 in steps of 0.1. Beyond 1 because the best place can
/// lie on the far side.
const SHARES: usize = 13;
const SHARE_STEP: f64 = 0.1;
/// What it costs, in nats, if neighbouring stations move by shares that differ by the whole way.
const ROUGHNESS: f64 = 4.0;

/// How comfort and reach are weighed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BlendWeights {
    /// The price in nats of one `distance_scale` away from comfort.
    pub weight: f64,
    /// Metres.
    pub distance_scale: f64,
    /// How many stations the path has.
    pub stations: u32,
}

/// The comfort path moved towards `reachable`. Both ends of the comfort path stay.
#[must_use]
pub fn blend(comfort: &[Point], reachable: &[Point], reach: &Reach, weights: &BlendWeights) -> Vec<Point> {
    let pieces = f64::from(weights.stations.max(2));
    let from = line::resample(comfort, polyline_length(comfort) / pieces);
    let to = line::resample(reachable, polyline_length(reachable) / pieces);
    if from.len() < 3 || from.len() != to.len() {
        return comfort.to_vec();
    }
    let last = from.len() - 1;
    let inner = || from.iter().zip(&to).skip(1).take(last - 1);
    let values: Vec<Vec<f64>> = inner().map(|(from, to)| station(from, to, reach, weights)).collect();
    let shares = best_shares(&values);
    let moved = inner().zip(shares).map(|((from, to), share)| from + (to - from) * (share as f64 * SHARE_STEP));
    from.iter().take(1).copied().chain(moved).chain(from.last().copied()).collect()
}

fn station(from: &Point, to: &Point, reach: &Reach, weights: &BlendWeights) -> Vec<f64> {
    let value = |share: usize| {
        let offset = (to - from) * (share as f64 * SHARE_STEP);
        reach.at(&(from + offset)).score - weights.weight * offset.norm() / weights.distance_scale
    };
    (0..SHARES).map(value).collect()
}

/// The best share for each station: the highest total of the values less what differences between neighbours cost.
fn best_shares(values: &[Vec<f64>]) -> Vec<usize> {
    let price = |one: usize, other: usize| ROUGHNESS * (one.abs_diff(other) as f64 * SHARE_STEP).powi(2);
    let mut total = vec![0.0; SHARES];
    let mut choices: Vec<Vec<usize>> = Vec::with_capacity(values.len());
    for station in values {
        let reached = station.iter().enumerate().map(|(share, value)| {
            let (before, best) = highest(total.iter().enumerate().map(|(other, sum)| sum - price(share, other)));
            (before, best + value)
        });
        let (choice, sums): (Vec<usize>, Vec<f64>) = reached.unzip();
        choices.push(choice);
        total = sums;
    }
    let mut share = highest(total.iter().copied()).0;
    let mut shares = Vec::with_capacity(values.len());
    for choice in choices.iter().rev() {
        shares.push(share);
        share = choice.get(share).copied().unwrap_or(0);
    }
    shares.reverse();
    shares
}

fn highest(values: impl Iterator<Item = f64>) -> (usize, f64) {
    let first = (0, f64::NEG_INFINITY);
    values.enumerate().fold(first, |best, next| if next.1 > best.1 { next } else { best })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::modelling::stick::{Space, StickFit};
    use crate::modelling::{ArmSpace, Mixture};
    use nalgebra::{Matrix2, Vector2};

    fn scene() -> (Reach, [Point; 3], Vec<Point>) {
        let at = |x: f64| Mixture::planar([(1.0, Vector2::new(x, 0.0), Matrix2::identity() * 0.05)]).unwrap();
        let joints = [Point::origin(), Point::new(3.0, 0.0, 0.0), Point::new(6.0, 0.0, 0.0)];
        let space = ArmSpace { hand: at(0.0), elbow: at(3.0), shoulder: at(6.0), whole: None };
        let arch = [0.0, 0.9, 1.2, 0.9, 0.0].iter().enumerate();
        let comfort = arch.map(|(index, y)| Point::new(1.5 * index as f64, *y, 0.0)).collect();
        (Reach::new(space, &joints, StickFit::new(Space::Planar)), joints, comfort)
    }

    fn mean_height(path: &[Point]) -> f64 {
        path.iter().map(|point| point.y).sum::<f64>() / path.len() as f64
    }

    #[test]
    fn more_weight_on_comfort_stays_closer_to_it_and_the_ends_stay_anyway() {
        let (reach, joints, comfort) = scene();
        let with =
            |weight| blend(&comfort, &joints, &reach, &BlendWeights { weight, distance_scale: 1.0, stations: 20 });
        let (reachable, between, comfortable) = (with(0.0), with(4.0), with(1_000.0));
        assert!(mean_height(&reachable) < mean_height(&between) - 0.05);
        assert!(mean_height(&between) <= mean_height(&comfortable));
        assert!((mean_height(&comfortable) - mean_height(&line::resample(&comfort, 0.3))).abs() < 0.05);
        for path in [&reachable, &between, &comfortable] {
            assert_eq!((path[0], path[path.len() - 1]), (comfort[0], comfort[4]));
        }
        assert!(reach.along(&between, 0.1).score > reach.along(&comfort, 0.1).score);
    }

    #[test]
    fn a_path_without_length_is_left_as_it_is() {
        let (reach, joints, _) = scene();
        let point = [Point::origin(), Point::origin()];
        let made = blend(&point, &joints, &reach, &BlendWeights { weight: 1.0, distance_scale: 1.0, stations: 5 });
        assert!(
            made.iter()
                .all(|place| (place - Point::origin()).norm() < 6.1 && place.coords.iter().all(|x| x.is_finite()))
        );
    }
}
