//! What the learning strategies share: a step that is guarded and clipped, and the books of one pass.

use super::{Contact, Finish, IterationSummary, LearnedPath, LearningSettings, StrategyKind};
use crate::geometry::{Point, Vector};
use crate::planning::Optimiser;
use crate::planning::line;

/// A goal closer than this to the way-point before it is not added again.
const SAME_POINT: f64 = 1e-9;

/// An optimiser behind its guards.
#[derive(Clone, Debug)]
pub(super) struct Learner {
    pub(super) settings: LearningSettings,
    pub(super) optimiser: Optimiser,
    pub(super) finished: Option<Finish>,
}

impl Learner {
    pub(super) fn new(settings: &LearningSettings) -> Self {
        Self { optimiser: Optimiser::new(settings.optimiser), settings: settings.clone(), finished: None }
    }

    /// The displacement to subtract for a resistance.
    pub(super) fn displacement(&mut self, resistance: &Vector) -> Vector {
        let guards = self.settings.guards;
        let strength = resistance.norm();
        let shortened = if strength > 0.0 { (strength - guards.bias).max(0.0) / strength } else { 0.0 };
        let heard = resistance.map(|value| if value.abs() <= guards.quiet_axis { 0.0 } else { value * shortened });
        let step = self.optimiser.step(&heard);
        let mut longest = self.settings.maximum_step;
        if guards.maximum_gain > 0.0 {
            longest = longest.min(guards.maximum_gain * strength);
        }
        clip(&step, longest)
    }

    /// Goes on from what another strategy learned. Moments fit only the method that made them.
    pub(super) fn adopt(&mut self, learned: &LearnedPath) -> Vec<String> {
        self.finished = None;
        let mut dropped = Vec::new();
        match (learned.kind, learned.optimiser) {
            (StrategyKind::Force | StrategyKind::Multimodal, Some(state)) => {
                self.optimiser = Optimiser::resume(self.settings.optimiser, state);
            }
            _ => self.optimiser = Optimiser::new(self.settings.optimiser),
        }
        if learned.stiffness.is_some() {
            dropped.push("the learned stiffness: this strategy has no use for it".to_owned());
        }
        dropped
    }

    /// Judges a pass that has ended and remembers whether it was the last.
    pub(super) fn judge(&mut self, pass: &Pass) -> Option<Finish> {
        self.finished = finish_of(&self.settings, self.optimiser.state().iteration, pass);
        self.finished
    }
}

/// Whether a pass that has ended was the last one, and why.
pub(super) fn finish_of(settings: &LearningSettings, iteration: u32, pass: &Pass) -> Option<Finish> {
    if pass.overflow {
        Some(Finish::Overflow)
    } else if pass.energy <= settings.energy_threshold {
        Some(Finish::Converged)
    } else if iteration >= settings.maximum_iterations {
        Some(Finish::MaximumReached)
    } else {
        None
    }
}

/// A vector, no longer than `longest`.
pub(super) fn clip(step: &Vector, longest: f64) -> Vector {
    let length = step.norm();
    if length > longest { step * (longest / length) } else { *step }
}

/// The books of one pass along the path.
#[derive(Clone, Debug)]
pub(super) struct Pass {
    /// Where the gripper is, after the last reaction or arrival.
    pub(super) current: Point,
    /// The path that is being made.
    pub(super) travelled: Vec<Point>,
    pub(super) energy: f64,
    pub(super) contacts: u32,
    pub(super) ignored: u32,
    pub(super) overflow: bool,
    /// How many steps may still be probed on the way to the present goal.
    pub(super) budget: u32,
}

impl Pass {
    pub(super) fn new(start: Point) -> Self {
        Self {
            current: start,
            travelled: vec![start],
            energy: 0.0,
            contacts: 0,
            ignored: 0,
            overflow: false,
            budget: 0,
        }
    }

    /// How many steps a contact at `position` uses up: at least one.
    pub(super) fn cost(&self, position: &Point, step: f64) -> u32 {
        line::steps((position - self.current).norm(), step).max(1)
    }

    /// Takes a contact into the books and puts the moved way-point on the path.
    pub(super) fn give_way(&mut self, contact: &Contact, displacement: &Vector, settings: &LearningSettings) {
        self.budget = self.budget.saturating_sub(self.cost(&contact.position, settings.step));
        self.current = contact.position - displacement;
        self.energy += contact.resistance.norm();
        self.contacts += 1;
        if self.travelled.len() < settings.maximum_waypoints {
            self.travelled.push(self.current);
        } else {
            self.overflow = true;
        }
    }

    /// Puts a goal that was reached on the path, unless it is there already.
    pub(super) fn reach(&mut self, goal: Point) {
        if self.travelled.last().is_none_or(|last| (last - goal).norm() > SAME_POINT) {
            self.travelled.push(goal);
        }
        self.current = goal;
    }

    pub(super) fn summary(&self, iteration: u32, finished: Option<Finish>) -> IterationSummary {
        IterationSummary {
            iteration,
            energy: self.energy,
            contacts: self.contacts,
            ignored: self.ignored,
            path: Vec::new(),
            mean_resistance: (self.contacts > 0).then(|| self.energy / f64::from(self.contacts)),
            reachability: None,
            inside_share: None,
            finished,
        }
    }
}

/// Legs of the thesis' path along an arm: five way-points (section 4.4.3).
const THESIS_LEGS: f64 = 4.0;

/// The share of the interval between goals for a path of dense nodes: the whole path takes as long as the thesis' four legs.
pub(super) fn share_of_dense(path: &[Point]) -> f64 {
    (THESIS_LEGS / path.len().saturating_sub(1).max(1) as f64).min(1.0)
}

/// The path that another strategy learned, or the present one where it learned none.
pub(super) fn keep_path(present: &[Point], learned: &LearnedPath) -> Vec<Point> {
    if learned.path.len() > 1 { learned.path.clone() } else { present.to_vec() }
}

/// The path without inner way-points that are closer than `distance` to the one kept before them.
pub(super) fn merge(path: Vec<Point>, distance: f64) -> Vec<Point> {
    if distance <= 0.0 || path.len() < 3 {
        return path;
    }
    let last = path.len() - 1;
    let mut kept: Vec<Point> = Vec::with_capacity(path.len());
    for (index, point) in path.into_iter().enumerate() {
        let near = kept.last().is_some_and(|before| (before - point).norm() < distance);
        if index == 0 || index == last || !near {
            kept.push(point);
        }
    }
    kept
}
