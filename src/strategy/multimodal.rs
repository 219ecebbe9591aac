//! Algorithm 3 (thesis section 5.1): the path gives way where it is resisted, and the goal moves to where the limb that
//! passes there most probably ends.
//!
//! Readings of the thesis that are fixed here: after a contact the old way-points of that limb are void; the goal of a
//! limb persists to the next iteration; near the goal the direction of the limb is noise, and a guard keeps the goal;
//! each limb gives way only so often, because the printed recursion has no bound.

use super::learner::{Learner, Pass, merge};
use super::{
    ArmContext, Contact, Ignored, IterationSummary, LearnedPath, LearningSettings, MultimodalSettings, Reaction, Rule,
    Strategy, StrategyError, StrategyKind, WaypointChange,
};
use crate::geometry::{Finite, Point};
use crate::modelling::stick::Limb;
use crate::modelling::{ArmSpace, Mixture, SplitMix64};
use crate::planning::GoalSearch;
use crate::planning::line;

/// Chapter 5's strategy.
#[derive(Clone, Debug)]
pub struct MultimodalStrategy {
    learner: Learner,
    settings: MultimodalSettings,
    space: ArmSpace,
    /// Both ends of each limb in one mixture, where that is asked for.
    together: Option<[Mixture<6>; 2]>,
    lengths: [f64; 2],
    initial_elbow: Point,
    random: SplitMix64,
    limbs: [Vec<Point>; 2],
    /// Both limbs in one line, the elbow once.
    path: Vec<Point>,
    under_way: Option<UnderWay>,
}

#[derive(Clone, Debug)]
struct UnderWay {
    pass: Pass,
    limb: usize,
    /// The number of the goal on the limb's old path; its length after a contact, when only the end is left.
    next: usize,
    /// The limb's end as it is by now.
    end: Point,
    goal: Point,
    made: Vec<Vec<Point>>,
    done: bool,
}

impl MultimodalStrategy {
    /// A strategy that starts from the straight lines between an arm's joints. The settings have been checked.
    #[must_use]
    pub fn new(
        context: &ArmContext,
        space: &ArmSpace,
        learning: &LearningSettings,
        settings: &MultimodalSettings,
    ) -> Self {
        let [hand, elbow, shoulder] = context.initial;
        Self {
            learner: Learner::new(learning),
            settings: settings.clone(),
            space: space.clone(),
            together: settings.whole_arm.then(|| space.limbs_together()).flatten(),
            lengths: [(elbow - hand).norm(), (shoulder - elbow).norm()],
            initial_elbow: elbow,
            random: SplitMix64::new(context.seed),
            limbs: [vec![hand, elbow], vec![elbow, shoulder]],
            path: vec![hand, elbow, shoulder],
            under_way: None,
        }
    }

    /// The path of each limb, hand to elbow and elbow to shoulder.
    #[must_use]
    pub const fn limbs(&self) -> &[Vec<Point>; 2] {
        &self.limbs
    }

    fn limb_path(&self, limb: usize) -> &[Point] {
        self.limbs.get(limb).map_or(&[], Vec::as_slice)
    }

    fn set_out(&self, mut pass: Pass, limb: usize, made: Vec<Vec<Point>>) -> UnderWay {
        let old = self.limb_path(limb);
        let end = old.last().copied().unwrap_or(pass.current);
        let goal = old.get(1).copied().unwrap_or(end);
        let longest = crate::geometry::polyline_length(old).max(self.lengths.get(limb).copied().unwrap_or(0.0));
        pass.budget = 2 * line::steps(longest, self.learner.settings.step) + 4;
        pass.travelled = vec![pass.current];
        UnderWay { pass, limb, next: 1, end, goal, made, done: false }
    }

    const fn is_pinned(&self, under_way: &UnderWay) -> bool {
        self.settings.pin_last && under_way.limb + 1 == self.limbs.len()
    }

    fn heads_for_the_end(&self, under_way: &UnderWay) -> bool {
        under_way.next + 1 >= self.limb_path(under_way.limb).len()
    }

    fn heard(&self, under_way: &UnderWay, position: &Point) -> Result<(), Ignored> {
        let settings = &self.learner.settings;
        let at_the_goal = (position - under_way.goal).norm() <= settings.end_tolerance;
        if under_way.done {
            Err(Ignored::NotUnderWay)
        } else if under_way.pass.overflow {
            Err(Ignored::Overflow)
        } else if self.is_pinned(under_way) && self.heads_for_the_end(under_way) && at_the_goal {
            Err(Ignored::PinnedEnd)
        } else if under_way.pass.cost(position, settings.step) > under_way.pass.budget {
            Err(Ignored::BudgetSpent)
        } else {
            Ok(())
        }
    }

    fn give_way(&mut self, under_way: &mut UnderWay, contact: &Contact) -> Reaction {
        let displacement = self.learner.displacement(&contact.resistance);
        under_way.pass.give_way(contact, &displacement, &self.learner.settings);
        let moved = under_way.pass.current;
        let rule = Rule::GiveWay { method: self.learner.settings.optimiser.method };
        let mut changes = vec![self.change(under_way, 0, (contact.position, moved), contact, rule)];
        if !self.is_pinned(under_way) {
            changes.extend(self.choose_end(under_way, contact));
        }
        // What is left of the limb's old way-points is void: straight on to its end.
        under_way.next = self.limb_path(under_way.limb).len();
        under_way.goal = under_way.end;
        Reaction { move_to: moved, changes, ignored: None }
    }

    fn choose_end(&mut self, under_way: &mut UnderWay, contact: &Contact) -> Option<WaypointChange> {
        let settings = &self.settings;
        let search = GoalSearch {
            draws: settings.draws,
            end_radius: settings.end_radius,
            middle_radius: settings.middle_radius,
            include_current: settings.include_current,
            guard_distance: settings.guard_radii * settings.middle_radius,
            space: settings.space,
        };
        let [hand, elbow, shoulder] = self.space.dressed();
        let (start, end) = if under_way.limb == 0 { (hand, elbow) } else { (elbow, shoulder) };
        let length = *self.lengths.get(under_way.limb)?;
        let together = self.together.as_ref().and_then(|limbs| limbs.get(under_way.limb));
        let limb = Limb { start, end, together, length };
        let before = under_way.end;
        let chosen = search.choose(&under_way.pass.current, &before, &limb, &mut self.random);
        chosen.draw?;
        under_way.end = chosen.position;
        let rule =
            Rule::GoalChosen { draws: search.draws, log_density: chosen.log_density.unwrap_or(f64::NEG_INFINITY) };
        Some(self.change(under_way, 1, (before, chosen.position), contact, rule))
    }

    fn change(
        &self,
        under_way: &UnderWay,
        beyond: usize,
        (from, to): (Point, Point),
        contact: &Contact,
        rule: Rule,
    ) -> WaypointChange {
        let before: usize = under_way.made.iter().map(|limb| limb.len().saturating_sub(1)).sum();
        WaypointChange {
            iteration: self.learner.optimiser.state().iteration,
            index: u32::try_from(before + under_way.pass.travelled.len() - 1 + beyond).unwrap_or(u32::MAX),
            from,
            to,
            resistance: contact.resistance,
            rule,
            reachability_before: None,
            reachability_after: None,
            expected_resistance: None,
        }
    }

    /// The path of the pass: what was travelled, and where it was cut short the rest of the old path.
    fn take_over(&mut self, under_way: UnderWay) {
        let UnderWay { mut pass, limb, next, end, made, done, .. } = under_way;
        let mut made = made;
        if !done {
            let rest = self.limb_path(limb).iter().skip(next).copied();
            pass.travelled.extend(rest);
            pass.reach(end);
            made.push(pass.travelled);
        }
        let distance = self.learner.settings.merge_distance;
        let overflow = pass.overflow;
        let mut start = None;
        for (old, new) in self.limbs.iter_mut().zip(made.into_iter().map(Some).chain(std::iter::repeat(None))) {
            match new {
                Some(new) => *old = merge(new, distance),
                // The limb was not reached in this pass; it now begins where the one before it ends.
                None if !overflow => {
                    if let (Some(first), Some(start)) = (old.first_mut(), start) {
                        *first = start;
                    }
                }
                None => {}
            }
            start = old.last().copied();
        }
        self.join();
    }

    fn join(&mut self) {
        let [first, second] = &self.limbs;
        self.path = first.iter().chain(second.iter().skip(1)).copied().collect();
    }

    /// Cuts a path of one line at the elbow: where it is known, or at the way-point closest to where it began.
    fn cut(&mut self, learned: &LearnedPath) {
        let path = &learned.path;
        let inner = 1..path.len().saturating_sub(1);
        let distance = |index: &usize| path.get(*index).map_or(f64::MAX, |point| (point - self.initial_elbow).norm());
        let closest = inner.clone().min_by(|left, right| distance(left).total_cmp(&distance(right)));
        let elbow = learned.elbow.filter(|index| inner.contains(index)).or(closest);
        self.limbs = match (elbow, path.first(), path.last()) {
            (Some(elbow), _, _) => {
                [path.iter().take(elbow + 1).copied().collect(), path.iter().skip(elbow).copied().collect()]
            }
            (None, Some(first), Some(last)) => [vec![*first, self.initial_elbow], vec![self.initial_elbow, *last]],
            _ => return,
        };
        self.join();
    }
}

impl Strategy for MultimodalStrategy {
    fn kind(&self) -> StrategyKind {
        StrategyKind::Multimodal
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
        self.under_way = Some(self.set_out(Pass::new(start), 0, Vec::new()));
        Ok(())
    }

    fn goal(&self) -> Option<Point> {
        let under_way = self.under_way.as_ref()?;
        (!under_way.done && !under_way.pass.overflow).then_some(under_way.goal)
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

    fn arrived(&mut self) {
        let (Some(goal), Some(mut under_way)) = (self.goal(), self.under_way.take()) else { return };
        let probed = line::steps((goal - under_way.pass.current).norm(), self.learner.settings.step);
        under_way.pass.budget = under_way.pass.budget.saturating_sub(probed);
        under_way.pass.reach(goal);
        if !self.heads_for_the_end(&under_way) {
            under_way.next += 1;
            under_way.goal = self.limb_path(under_way.limb).get(under_way.next).copied().unwrap_or(under_way.end);
            self.under_way = Some(under_way);
            return;
        }
        under_way.made.push(std::mem::take(&mut under_way.pass.travelled));
        let limb = under_way.limb + 1;
        self.under_way = Some(if limb < self.limbs.len() {
            self.set_out(under_way.pass, limb, under_way.made)
        } else {
            UnderWay { done: true, ..under_way }
        });
    }

    fn listens_at(&self, position: &Point) -> bool {
        self.under_way.as_ref().is_some_and(|under_way| self.heard(under_way, position).is_ok())
    }

    fn finish(&mut self) -> IterationSummary {
        let Some(under_way) = self.under_way.take() else {
            return IterationSummary::idle(self.learner.optimiser.state().iteration, &self.path, self.learner.finished);
        };
        self.learner.optimiser.end();
        let finished = self.learner.judge(&under_way.pass);
        let mut summary = under_way.pass.summary(self.learner.optimiser.state().iteration, finished);
        self.take_over(under_way);
        summary.path.clone_from(&self.path);
        summary
    }

    fn learned(&self) -> LearnedPath {
        LearnedPath {
            kind: self.kind(),
            path: self.path.clone(),
            iteration: self.learner.optimiser.state().iteration,
            elbow: self.limbs.first().map(|limb| limb.len() - 1),
            optimiser: Some(*self.learner.optimiser.state()),
            stiffness: None,
        }
    }

    fn adopt(&mut self, learned: &LearnedPath) -> Vec<String> {
        self.under_way = None;
        self.cut(learned);
        self.learner.adopt(learned)
    }
}
