//! Where a limb most probably ends, given a point it passes through (`ChooseNextGoal` of algorithm 3).

use crate::geometry::Point;
use crate::modelling::SplitMix64;
use crate::modelling::stick::{Limb, Space, other_end};

/// How the search draws.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GoalSearch {
    /// How many places are tried.
    pub draws: u32,
    /// Within what distance of the present goal, in metres.
    pub end_radius: f64,
    /// Within what distance of the way-point, in metres.
    pub middle_radius: f64,
    /// Whether the present goal competes.
    pub include_current: bool,
    /// Closer to the goal than this, in metres, the goal is kept without a draw.
    pub guard_distance: f64,
    /// In a plane or in space.
    pub space: Space,
}

/// The goal that was chosen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ChosenGoal {
    /// Where it is, in metres.
    pub position: Point,
    /// The logarithm of the joint density of the limb's two ends; `None` where nothing was weighed.
    pub log_density: Option<f64>,
    /// The number of the winning draw from 0; `None` where the goal stayed.
    pub draw: Option<u32>,
}

impl GoalSearch {
    /// Chooses the end of `limb`, which passes near `middle` and now ends at `end`.
    pub fn choose(&self, middle: &Point, end: &Point, limb: &Limb<'_>, random: &mut SplitMix64) -> ChosenGoal {
        let mut chosen = ChosenGoal { position: *end, log_density: None, draw: None };
        if (middle - end).norm() < self.guard_distance {
            return chosen;
        }
        let weigh = |end: &Point, middle: &Point| {
            let start = other_end(end, middle, limb.length)?;
            Some(limb.log_density(&start, end))
        };
        if self.include_current {
            chosen.log_density = weigh(end, middle);
        }
        for draw in 0..self.draws {
            let candidate = end + self.offset(self.end_radius, random);
            let relaxed = middle + self.offset(self.middle_radius, random);
            let Some(weight) = weigh(&candidate, &relaxed) else { continue };
            if chosen.log_density.is_none_or(|best| weight > best) {
                chosen = ChosenGoal { position: candidate, log_density: Some(weight), draw: Some(draw) };
            }
        }
        chosen
    }

    fn offset(&self, radius: f64, random: &mut SplitMix64) -> crate::geometry::Vector {
        match self.space {
            Space::Planar => random.in_disc(radius),
            Space::Spatial => random.in_ball(radius),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::modelling::mixture::tests::{mixture, point};
    use crate::modelling::stick::StickFit;
    use serde_json::Value;

    fn vectors() -> Value {
        serde_json::from_str(include_str!("../../tests/vectors/algorithms/stick.json")).unwrap()
    }

    #[test]
    fn other_ends_are_those_of_the_vectors() {
        for case in vectors()["eq_5_1"].as_array().unwrap() {
            let made = other_end(&point(&case["p1"]), &point(&case["p2"]), case["length"].as_f64().unwrap());
            match (made, case["p3"].is_null()) {
                (None, true) => {}
                (Some(made), false) => assert!((made - point(&case["p3"])).norm() < 1e-9),
                other => panic!("{other:?}"),
            }
        }
    }

    #[test]
    fn goals_and_the_number_of_draws_are_those_of_the_vectors() {
        let file = vectors();
        let (start, end) = (mixture(&file["gmm_start"]), mixture(&file["gmm_end"]));
        for case in file["choose_next_goal"].as_array().unwrap() {
            let parameters = &case["params"];
            let search = GoalSearch {
                draws: parameters["j_max"].as_u64().map_or(20, |draws| u32::try_from(draws).unwrap()),
                end_radius: 0.5,
                middle_radius: 0.2,
                include_current: parameters["include_current"].as_bool().unwrap_or(true),
                guard_distance: parameters["min_dist"].as_f64().unwrap_or(0.4),
                space: Space::Planar,
            };
            let limb = Limb { start: &start, end: &end, together: None, length: case["length"].as_f64().unwrap() };
            let mut random = SplitMix64::new(case["seed"].as_u64().unwrap());
            let chosen = search.choose(&point(&case["mid"]), &point(&case["end"]), &limb, &mut random);
            assert!((chosen.position - point(&case["result"])).norm() < 1e-9);
            assert_eq!(chosen.draw.map_or(-1, i64::from), case["accepted"].as_i64().unwrap());
            assert_eq!(random.next_u64().to_string(), case["next_u64_after"].as_str().unwrap());
            if let Some(expected) = case["log_joint"].as_f64() {
                assert!((chosen.log_density.unwrap() - expected).abs() < 1e-9);
            }
        }
    }

    #[test]
    fn reachability_is_that_of_the_vectors() {
        let file = vectors();
        let (start, end) = (mixture(&file["gmm_start"]), mixture(&file["gmm_end"]));
        let best = start.log_density(&start.mode()) + end.log_density(&end.mode());
        let fit = StickFit::new(Space::Planar);
        for case in file["reachability"].as_array().unwrap() {
            let limb = Limb { start: &start, end: &end, together: None, length: case["lengths"][0].as_f64().unwrap() };
            let reached = fit.reachability(&point(&case["x"]), &limb, best);
            assert!((reached.score - case["score"].as_f64().unwrap()).abs() < 1e-6, "{reached:?} {case}");
            assert_eq!(reached.inside, case["inside"].as_bool().unwrap());
        }
    }
}
