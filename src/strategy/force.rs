//! Algorithm 2 (thesis section 4.3.2): the path gives way where it is resisted, and remembers.
//!
//! Readings of the thesis that are fixed here: both loop conditions must hold; each way to a goal gives way at most as
//! often as it has steps (the printed recursion has no bound at the pinned end); the goal follows the way-point before
//! it, save the last, which is pinned; the next way starts where the gripper is.

use super::learner::{Learner, Pass, keep_path, merge};
use super::{
    Contact, Ignored, IterationSummary, LearnedPath, LearningSettings, Reaction, Rule, Strategy, StrategyError,
    StrategyKind, WaypointChange,
};
use crate::geometry::{Finite, Point};

/// Chapter 4's strategy.
#[derive(Clone, Debug)]
pub struct ForceStrategy {
    learner: Learner,
    path: Vec<Point>,
    under_way: Option<UnderWay>,
}

#[derive(Clone, Debug)]
struct UnderWay {
    pass: Pass,
    /// The number of the goal on the old path.
    next: usize,
    /// Where the goal is by now; `None` once the end was reached.
    goal: Option<Point>,
}

impl ForceStrategy {
    /// A strategy that starts from an initial path (start and end are pinned) and settings that have been checked.
    #[must_use]
    pub fn new(initial: &[Point], settings: &LearningSettings) -> Self {
        Self { learner: Learner::new(settings), path: initial.to_vec(), under_way: None }
    }

    /// The way from where the gripper is to way-point `next` of the old path.
    fn set_out(&self, mut pass: Pass, next: usize) -> UnderWay {
        let goal = self.path.get(next).copied();
        if let Some(goal) = goal {
            pass.budget = pass.cost(&goal, self.learner.settings.step);
        }
        UnderWay { pass, next, goal }
    }

    fn is_last(&self, next: usize) -> bool {
        next + 1 == self.path.len()
    }

    /// Why a contact at `position` would move nothing; otherwise the goal on the way to which it comes.
    fn heard(&self, under_way: &UnderWay, position: &Point) -> Result<Point, Ignored> {
        let settings = &self.learner.settings;
        let goal = under_way.goal.ok_or(Ignored::NotUnderWay)?;
        if under_way.pass.overflow {
            Err(Ignored::Overflow)
        } else if self.is_last(under_way.next) && (position - goal).norm() <= settings.end_tolerance {
            Err(Ignored::PinnedEnd)
        } else if under_way.pass.cost(position, settings.step) > under_way.pass.budget {
            Err(Ignored::BudgetSpent)
        } else {
            Ok(goal)
        }
    }

    fn give_way(&mut self, under_way: &mut UnderWay, goal: Point, contact: &Contact) -> Reaction {
        let displacement = self.learner.displacement(&contact.resistance);
        let method = self.learner.settings.optimiser.method;
        under_way.pass.give_way(contact, &displacement, &self.learner.settings);
        let moved = under_way.pass.current;
        let mut changes = vec![self.change(under_way, 0, (contact.position, moved), contact, Rule::GiveWay { method })];
        if !self.is_last(under_way.next) {
            let shifted = goal - displacement;
            under_way.goal = Some(shifted);
            changes.push(self.change(under_way, 1, (goal, shifted), contact, Rule::GoalFollows));
        }
        Reaction { move_to: moved, changes, ignored: None }
    }

    fn change(
        &self,
        under_way: &UnderWay,
        beyond: usize,
        (from, to): (Point, Point),
        contact: &Contact,
        rule: Rule,
    ) -> WaypointChange {
        WaypointChange {
            iteration: self.learner.optimiser.state().iteration,
            index: u32::try_from(under_way.pass.travelled.len() - 1 + beyond).unwrap_or(u32::MAX),
            from,
            to,
            resistance: contact.resistance,
            rule,
            reachability_before: None,
            reachability_after: None,
            expected_resistance: None,
        }
    }
}

impl Strategy for ForceStrategy {
    fn kind(&self) -> StrategyKind {
        StrategyKind::Force
    }

    fn path(&self) -> &[Point] {
        &self.path
    }

    fn begin(&mut self) -> Result<(), StrategyError> {
        if let Some(finish) = self.learner.finished {
            return Err(StrategyError::Finished { finish });
        }
        let start = *self.path.first().ok_or(StrategyError::ShortPath { points: 0 })?;
        self.learner.optimiser.begin();
        self.under_way = Some(self.set_out(Pass::new(start), 1));
        Ok(())
    }

    fn goal(&self) -> Option<Point> {
        self.under_way.as_ref().filter(|under_way| !under_way.pass.overflow).and_then(|under_way| under_way.goal)
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
            Ok(goal) => self.give_way(&mut under_way, goal, contact),
        };
        self.under_way = Some(under_way);
        reaction
    }

    fn arrived(&mut self) {
        let (Some(goal), Some(mut under_way)) = (self.goal(), self.under_way.take()) else { return };
        under_way.pass.reach(goal);
        self.under_way = Some(self.set_out(under_way.pass, under_way.next + 1));
    }

    fn listens_at(&self, position: &Point) -> bool {
        self.under_way.as_ref().is_some_and(|under_way| self.heard(under_way, position).is_ok())
    }

    fn finish(&mut self) -> IterationSummary {
        let Some(mut under_way) = self.under_way.take() else {
            return IterationSummary::idle(self.learner.optimiser.state().iteration, &self.path, self.learner.finished);
        };
        if under_way.goal.is_some() && !under_way.pass.overflow {
            // The pass was cut short: what lies ahead stays as it was.
            under_way.pass.travelled.extend(self.path.iter().skip(under_way.next));
        }
        self.learner.optimiser.end();
        let finished = self.learner.judge(&under_way.pass);
        let mut summary = under_way.pass.summary(self.learner.optimiser.state().iteration, finished);
        self.path = merge(under_way.pass.travelled, self.learner.settings.merge_distance);
        summary.path.clone_from(&self.path);
        summary
    }

    fn learned(&self) -> LearnedPath {
        LearnedPath {
            kind: self.kind(),
            path: self.path.clone(),
            iteration: self.learner.optimiser.state().iteration,
            elbow: None,
            optimiser: Some(*self.learner.optimiser.state()),
            stiffness: None,
        }
    }

    fn adopt(&mut self, learned: &LearnedPath) -> Vec<String> {
        self.under_way = None;
        self.path = keep_path(&self.path, learned);
        self.learner.adopt(learned)
    }
}
