//! Chapter 3's strategy: the path comes from the movement space alone and never changes. Resistance is only counted.

use super::learner::{Pass, keep_path};
use super::{Contact, Finish, Ignored, IterationSummary, LearnedPath, Reaction, Strategy, StrategyError, StrategyKind};
use crate::geometry::{Finite, Point};
use crate::modelling::ArmSpace;

/// A path that is followed as it is.
#[derive(Clone, Debug)]
pub struct FixedPath {
    path: Vec<Point>,
    iteration: u32,
    under_way: Option<(Pass, usize)>,
    /// True once a strategy that learns has handed over its path.
    adopted: bool,
}

impl FixedPath {
    /// The path through the mean of each joint's mixture that is closest to where the joint is (equation 3.5).
    #[must_use]
    pub fn from_space(space: &ArmSpace, joints: &[Point; 3]) -> Self {
        let goals = space.dressed().into_iter().zip(joints);
        let path = goals.map(|(mixture, joint)| Point::from(mixture.nearest_mean(&joint.coords).1)).collect();
        Self { path, iteration: 0, under_way: None, adopted: false }
    }

    /// A path that is given.
    #[must_use]
    pub const fn along(path: Vec<Point>) -> Self {
        Self { path, iteration: 0, under_way: None, adopted: true }
    }
}

impl Strategy for FixedPath {
    fn kind(&self) -> StrategyKind {
        StrategyKind::Gmm
    }

    fn path(&self) -> &[Point] {
        &self.path
    }

    fn begin(&mut self) -> Result<(), StrategyError> {
        let start = *self.path.first().ok_or(StrategyError::ShortPath { points: 0 })?;
        self.iteration = self.iteration.saturating_add(1);
        self.under_way = Some((Pass::new(start), 1));
        Ok(())
    }

    fn goal(&self) -> Option<Point> {
        self.under_way.as_ref().and_then(|(_, next)| self.path.get(*next).copied())
    }

    fn resisted(&mut self, contact: &Contact) -> Reaction {
        if !(contact.position.is_finite() && contact.resistance.is_finite()) {
            return Reaction::ignoring(contact, Ignored::NotFinite);
        }
        let Some((pass, _)) = self.under_way.as_mut() else {
            return Reaction::ignoring(contact, Ignored::NotUnderWay);
        };
        pass.energy += contact.resistance.norm();
        pass.contacts += 1;
        Reaction::ignoring(contact, Ignored::FixedPath)
    }

    fn arrived(&mut self) {
        if let (Some(goal), Some((pass, next))) = (self.goal(), self.under_way.as_mut()) {
            pass.reach(goal);
            *next += 1;
        }
    }

    fn listens_at(&self, _position: &Point) -> bool {
        self.goal().is_some()
    }

    fn finish(&mut self) -> IterationSummary {
        let Some((pass, _)) = self.under_way.take() else {
            return IterationSummary::idle(self.iteration, &self.path, None);
        };
        let mut summary = pass.summary(self.iteration, Some(Finish::Fixed));
        summary.path.clone_from(&self.path);
        summary
    }

    fn learned(&self) -> LearnedPath {
        LearnedPath {
            kind: self.kind(),
            path: self.path.clone(),
            iteration: self.iteration,
            elbow: (!self.adopted).then_some(1),
            optimiser: None,
            stiffness: None,
        }
    }

    fn adopt(&mut self, learned: &LearnedPath) -> Vec<String> {
        self.under_way = None;
        self.path = keep_path(&self.path, learned);
        self.adopted = true;
        let mut dropped = vec!["learning: this strategy follows the path as it is".to_owned()];
        if learned.optimiser.is_some() {
            dropped.push("the optimiser's moments".to_owned());
        }
        if learned.stiffness.is_some() {
            dropped.push("the learned stiffness".to_owned());
        }
        dropped
    }
}
