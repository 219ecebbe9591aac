//! Strategies on evenly spaced nodes: a contact corrects not only the node it came at, but the path around it.
//!
//! The path is drawn anew with nodes at most `step` apart at the start of each iteration, so it never grows. What a
//! correction does to the other nodes is the [`Correction`]'s business: the kernel step and the Gaussian process differ
//! in nothing else. The stiffness that turns newtons into metres is learned from what is still felt after a move.

use super::learner::{Pass, clip, finish_of, keep_path, share_of_dense};
use super::{
    Contact, Finish, Ignored, IterationSummary, LearnedPath, LearningSettings, Reaction, Rule, Strategy, StrategyError,
    StrategyKind, WaypointChange,
};
use crate::geometry::{Finite, Point, Vector, polyline_length};
use crate::planning::line;
use std::collections::VecDeque;
use std::fmt::Debug;

/// What a contact at one node does to the path.
pub(super) trait Correction: Debug + Send {
    /// Takes a freshly drawn path as the base of the corrections to come.
    fn rebase(&mut self, nodes: &[Point], step: f64);

    /// Answers a contact at an inner node. `towards_optimum` is the displacement from the node to where the resistance
    /// is expected to vanish. Moves this node and others, never the first and the last.
    fn correct(&mut self, nodes: &mut [Point], index: usize, towards_optimum: &Vector);

    /// The rule's name for explanations.
    fn rule(&self, stiffness: f64) -> Rule;
}

/// How many readings of the stiffness are averaged.
const STIFFNESS_MEMORY: usize = 8;
/// Readings of the stiffness at or below this say nothing (newtons a metre).
const LEAST_STIFFNESS: f64 = 1e-6;
/// Moves shorter than this say nothing about the stiffness, in metres.
const LEAST_MOVE: f64 = 1e-9;
/// A reading below this share of the present stiffness is noise: it would make the next step absurdly long.
const LEAST_SHARE: f64 = 0.05;
/// A path never has more nodes than this: a field of offsets costs their square at each contact.
const MOST_NODES: f64 = 400.0;
/// A probe this close to a node is at the node.
const AT_NODE: f64 = 1e-9;

/// A strategy on evenly spaced nodes.
#[derive(Debug)]
pub struct NodeStrategy {
    kind: StrategyKind,
    settings: LearningSettings,
    correction: Box<dyn Correction>,
    learn_stiffness: bool,
    stiffness: f64,
    readings: VecDeque<f64>,
    path: Vec<Point>,
    iteration: u32,
    finished: Option<Finish>,
    under_way: Option<UnderWay>,
}

#[derive(Debug)]
struct UnderWay {
    pass: Pass,
    nodes: Vec<Point>,
    next: usize,
    /// The last move and what was felt before it, until what is felt after it is known.
    unsettled: Option<(Vector, Vector)>,
    /// Whether a node was added before the end already.
    added: bool,
}

impl NodeStrategy {
    pub(super) fn new(
        kind: StrategyKind,
        initial: &[Point],
        settings: &LearningSettings,
        correction: Box<dyn Correction>,
        stiffness: f64,
        learn_stiffness: bool,
    ) -> Self {
        Self {
            kind,
            settings: settings.clone(),
            correction,
            learn_stiffness,
            stiffness,
            readings: VecDeque::with_capacity(STIFFNESS_MEMORY),
            path: initial.to_vec(),
            iteration: 0,
            finished: None,
            under_way: None,
        }
    }

    /// The stiffness that is used now, in newtons a metre.
    #[must_use]
    pub const fn stiffness(&self) -> f64 {
        self.stiffness
    }

    /// Why a contact at `position` would move nothing.
    fn heard(&self, under_way: &UnderWay, position: &Point) -> Result<(), Ignored> {
        let goal = under_way.nodes.get(under_way.next).ok_or(Ignored::NotUnderWay)?;
        let last = under_way.next + 1 == under_way.nodes.len();
        if last && (position - goal).norm() <= self.settings.end_tolerance {
            Err(Ignored::PinnedEnd)
        } else if last && under_way.added {
            Err(Ignored::BudgetSpent)
        } else {
            Ok(())
        }
    }

    fn give_way(&mut self, under_way: &mut UnderWay, contact: &Contact) -> Reaction {
        let index = under_way.next;
        if index + 1 == under_way.nodes.len() {
            // Nothing lies between here and the pinned end: the contact gets a node of its own.
            under_way.nodes.insert(index, contact.position);
            under_way.added = true;
            self.correction.rebase(&under_way.nodes, self.settings.step);
        } else if let Some(node) = under_way.nodes.get_mut(index) {
            *node = contact.position;
        }
        let wanted = clip(&(-contact.resistance / self.stiffness), self.settings.maximum_step);
        self.correction.correct(&mut under_way.nodes, index, &wanted);
        let moved = under_way.nodes.get(index).copied().unwrap_or(contact.position);
        let displacement = contact.position - moved;
        under_way.pass.energy += contact.resistance.norm();
        under_way.pass.contacts += 1;
        under_way.pass.current = moved;
        under_way.unsettled = Some((displacement, contact.resistance));
        under_way.next = index + 1;
        let change = WaypointChange {
            iteration: self.iteration,
            index: u32::try_from(index).unwrap_or(u32::MAX),
            from: contact.position,
            to: moved,
            resistance: contact.resistance,
            rule: self.correction.rule(self.stiffness),
            reachability_before: None,
            reachability_after: None,
            expected_resistance: Some((contact.resistance - displacement * self.stiffness).norm()),
        };
        Reaction { move_to: moved, changes: vec![change], ignored: None }
    }
}

impl Strategy for NodeStrategy {
    fn kind(&self) -> StrategyKind {
        self.kind
    }

    fn path(&self) -> &[Point] {
        self.under_way.as_ref().map_or(&self.path, |under_way| &under_way.nodes)
    }

    fn begin(&mut self) -> Result<(), StrategyError> {
        if let Some(finish) = self.finished {
            return Err(StrategyError::Finished { finish });
        }
        let start = *self.path.first().ok_or(StrategyError::ShortPath { points: 0 })?;
        self.iteration = self.iteration.saturating_add(1);
        let step = self.settings.step.max(polyline_length(&self.path) / MOST_NODES);
        let nodes = line::resample(&self.path, step);
        self.correction.rebase(&nodes, step);
        self.under_way = Some(UnderWay { pass: Pass::new(start), nodes, next: 1, unsettled: None, added: false });
        Ok(())
    }

    fn goal(&self) -> Option<Point> {
        self.under_way.as_ref().and_then(|under_way| under_way.nodes.get(under_way.next).copied())
    }

    fn resisted(&mut self, contact: &Contact) -> Reaction {
        if !(contact.position.is_finite() && contact.resistance.is_finite()) {
            return Reaction::ignoring(contact, Ignored::NotFinite);
        }
        let Some(mut under_way) = self.under_way.take() else {
            return Reaction::ignoring(contact, Ignored::NotUnderWay);
        };
        let reaction = match self.heard(&under_way, &contact.position) {
            Err(reason) => {
                under_way.pass.ignored += 1;
                Reaction::ignoring(contact, reason)
            }
            Ok(()) => self.give_way(&mut under_way, contact),
        };
        self.under_way = Some(under_way);
        reaction
    }

    fn settled(&mut self, residual: &Vector) {
        let Some((moved, felt)) = self.under_way.as_mut().and_then(|under_way| under_way.unsettled.take()) else {
            return;
        };
        if !self.learn_stiffness || !residual.is_finite() || moved.norm() <= LEAST_MOVE {
            return;
        }
        let reading = (felt - residual).dot(&moved) / moved.norm_squared();
        if reading > LEAST_STIFFNESS.max(LEAST_SHARE * self.stiffness) {
            self.readings.push_back(reading);
            if self.readings.len() > STIFFNESS_MEMORY {
                self.readings.pop_front();
            }
            self.stiffness = self.readings.iter().sum::<f64>() / self.readings.len() as f64;
        }
    }

    fn learns_from_residuals(&self) -> bool {
        self.learn_stiffness
    }

    fn arrived(&mut self) {
        let (Some(goal), Some(under_way)) = (self.goal(), self.under_way.as_mut()) else { return };
        under_way.pass.current = goal;
        under_way.next += 1;
    }

    fn listens_at(&self, position: &Point) -> bool {
        self.under_way.as_ref().is_some_and(|under_way| {
            let at_node = self.goal().is_some_and(|goal| (position - goal).norm() <= AT_NODE);
            at_node && under_way.next + 1 < under_way.nodes.len()
        })
    }

    fn heeds(&self, position: &Point) -> bool {
        self.under_way.as_ref().is_some_and(|under_way| self.heard(under_way, position).is_ok())
    }

    fn interval_share(&self) -> f64 {
        share_of_dense(self.path())
    }

    fn finish(&mut self) -> IterationSummary {
        let Some(under_way) = self.under_way.take() else {
            return IterationSummary::idle(self.iteration, &self.path, self.finished);
        };
        self.finished = finish_of(&self.settings, self.iteration, &under_way.pass);
        self.path = under_way.nodes;
        let mut summary = under_way.pass.summary(self.iteration, self.finished);
        summary.path.clone_from(&self.path);
        summary
    }

    fn learned(&self) -> LearnedPath {
        LearnedPath {
            kind: self.kind,
            path: self.path.clone(),
            iteration: self.iteration,
            elbow: None,
            optimiser: None,
            stiffness: Some(self.stiffness),
        }
    }

    fn adopt(&mut self, learned: &LearnedPath) -> Vec<String> {
        self.under_way = None;
        self.finished = None;
        self.path = keep_path(&self.path, learned);
        if let Some(stiffness) = learned.stiffness.filter(|stiffness| *stiffness > LEAST_STIFFNESS) {
            self.stiffness = stiffness;
            self.readings.clear();
        }
        match learned.optimiser {
            Some(_) => vec!["the optimiser's moments: this strategy has none".to_owned()],
            None => Vec::new(),
        }
    }
}
