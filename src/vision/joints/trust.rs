//! How far a joint that a forest's labels and votes have found is trusted, and which of both places counts how much.
//!
//! The skin's labels err where parts meet, the votes of leaves where a person is unlike those of the training; where both agree and
//! enough of the joint's own skin is seen, the joint is. The numbers were chosen on simulated people of `valet reproduce joints`
//! with seeds 2 to 4 (published is seed 1): a joint that breaks one of these limits is further off than 55 mm in every second case.

use super::bones::Found;
use super::mode::Mode;
use crate::body::Joint;
use nalgebra::{Matrix3, Point3};

/// What a joint needs to count as seen.
#[derive(Clone, Copy, Debug)]
struct Trust {
    /// Its own skin near it, in square metres.
    least_area: f64,
    /// How well the arm's fit knows its place, in metres.
    most_deviation: f64,
    /// How far labels and votes may be apart, in metres.
    furthest_from_votes: f64,
    /// Share of the votes that agree.
    least_share: f64,
    /// What part of the place the votes give.
    votes: f64,
}

const fn trust(joint: Joint) -> Trust {
    let (least_area, most_deviation, furthest_from_votes, least_share, votes) = match joint {
        Joint::Hand => (1.5e-3, 0.03, 0.06, 0.5, 0.5),
        Joint::Wrist => (1.0e-3, 0.03, 0.06, 0.4, 0.25),
        Joint::Forearm => (6.5e-4, 0.03, 0.06, 0.4, 0.25),
        Joint::Elbow => (6.5e-4, 0.03, 0.08, 0.4, 0.0),
        Joint::UpperArm => (4.5e-4, 0.03, 0.07, 0.4, 0.0),
        Joint::Shoulder => (1.0e-3, 0.06, 0.06, 0.5, 0.5),
    };
    Trust { least_area, most_deviation, furthest_from_votes, least_share, votes }
}

/// The joint between the place that the labelled skin gives and the one of the votes; `None` where it is not to be trusted.
pub(super) fn agreed(joint: Joint, found: &Found, voted: Option<&Mode>) -> Option<Point3<f64>> {
    let trust = trust(joint);
    let voted = voted.filter(|voted| voted.share >= trust.least_share)?;
    let apart = voted.place - found.place;
    let is_seen = found.area >= trust.least_area && deviation(&found.covariance) <= trust.most_deviation;
    (is_seen && apart.norm() <= trust.furthest_from_votes).then(|| found.place + apart * trust.votes)
}

fn deviation(covariance: &Matrix3<f64>) -> f64 {
    covariance.trace().sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn found(area: f64, deviation: f64) -> Found {
        let place = Point3::new(0.3, 0.4, 1.2);
        Found { place, covariance: Matrix3::identity() * (deviation * deviation / 3.0), area }
    }

    fn voted(apart: f64, share: f64) -> Mode {
        Mode { place: Point3::new(0.3 + apart, 0.4, 1.2), share }
    }

    #[test]
    fn a_joint_that_skin_and_votes_agree_on_lies_between_both() {
        for joint in Joint::ALL {
            let place = agreed(joint, &found(4e-3, 0.02), Some(&voted(0.04, 0.9))).unwrap();
            assert!((0.3..=0.32).contains(&place.x), "{joint:?} {place}");
        }
        let hand = agreed(Joint::Hand, &found(4e-3, 0.02), Some(&voted(0.04, 0.9))).unwrap();
        assert!((hand.x - 0.32).abs() < 1e-12);
    }

    #[test]
    fn each_limit_alone_makes_a_joint_not_seen() {
        for joint in Joint::ALL {
            assert_eq!(agreed(joint, &found(1e-4, 0.02), Some(&voted(0.0, 0.9))), None, "{joint:?}: little skin");
            assert_eq!(agreed(joint, &found(4e-3, 0.07), Some(&voted(0.0, 0.9))), None, "{joint:?}: place not known");
            assert_eq!(agreed(joint, &found(4e-3, 0.02), Some(&voted(0.09, 0.9))), None, "{joint:?}: elsewhere");
            assert_eq!(agreed(joint, &found(4e-3, 0.02), Some(&voted(0.0, 0.3))), None, "{joint:?}: votes scatter");
            assert_eq!(agreed(joint, &found(4e-3, 0.02), None), None, "{joint:?}: no votes");
        }
    }
}
