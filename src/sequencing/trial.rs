//! One trial: both arms, each in up to `t_max` passes of the garment, each pass ended by a withdrawal and the operator's
//! go-ahead (thesis sections 3.4 and 4.4.3).
//!
//! A [`Trial`] answers [`Trial::order`] with where the grippers should go, and is told what came of it. It holds the
//! strategies of both arms but never moves, waits or measures anything itself.

mod places;
mod stage;

pub use stage::{Next, Order, Stage, TrialEvent};

use super::steps::Step;
use crate::body::{PerSide, Side};
use crate::geometry::{Point, Vector, closest_on_polyline, polyline_length};
use crate::strategy::{Contact, Strategy, StrategyError, WaypointChange};
use serde::{Deserialize, Serialize};

/// How a trial is run.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct TrialSettings {
    /// The arm that is dressed first; the thesis dresses the right one (section 3.4).
    pub first_arm: Side,
    /// The furthest that the grippers may be apart in metres: the garment's back panel hangs between them. The trailing
    /// gripper goes towards its shoulder only as far as this allows.
    pub garment_reach_metres: f64,
    /// The least time between two goals, in seconds (thesis section 3.5: 3 s).
    pub goal_interval_seconds: f64,
    /// Whether the arms move only as long as the operator holds a key down, as in the first trial with a person.
    pub hold_to_run: bool,
}

impl Default for TrialSettings {
    fn default() -> Self {
        Self { first_arm: Side::Right, garment_reach_metres: 0.45, goal_interval_seconds: 3.0, hold_to_run: false }
    }
}

/// Where the person's joints were when the trial began: hand, elbow and shoulder of each arm, in `base`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct PersonPlan {
    /// Hand, elbow, shoulder.
    pub arms: PerSide<[Point; 3]>,
}

impl PersonPlan {
    fn shoulder(&self, side: Side) -> Point {
        self.arms.get(side)[2]
    }
}

/// One trial.
#[derive(Debug)]
pub struct Trial {
    settings: TrialSettings,
    plan: PersonPlan,
    strategies: PerSide<Box<dyn Strategy>>,
    arm: Side,
    stage: Stage,
    iteration: u32,
    travelled: Vec<Point>,
    finish_after_this: bool,
}

impl Trial {
    /// A trial that is about to begin with step 1.
    #[must_use]
    pub fn new(settings: TrialSettings, plan: PersonPlan, strategies: PerSide<Box<dyn Strategy>>) -> Self {
        let arm = settings.first_arm;
        Self {
            settings,
            plan,
            strategies,
            arm,
            stage: Stage::StandBack,
            iteration: 0,
            travelled: Vec::new(),
            finish_after_this: false,
        }
    }

    /// Where the trial is.
    #[must_use]
    pub const fn stage(&self) -> &Stage {
        &self.stage
    }

    /// The arm that is being dressed.
    #[must_use]
    pub const fn arm(&self) -> Side {
        self.arm
    }

    /// The pass along the present arm, from 1; 0 before the first.
    #[must_use]
    pub const fn iteration(&self) -> u32 {
        self.iteration
    }

    /// The places that the dressing gripper has passed in this iteration, in order.
    #[must_use]
    pub fn travelled(&self) -> &[Point] {
        &self.travelled
    }

    /// The strategy of an arm.
    #[must_use]
    pub fn strategy(&self, side: Side) -> &dyn Strategy {
        self.strategies.get(side).as_ref()
    }

    /// Puts another strategy in the place of an arm's present one.
    pub fn replace_strategy(&mut self, side: Side, strategy: Box<dyn Strategy>) {
        *self.strategies.get_mut(side) = strategy;
    }

    /// Hand, elbow and shoulder of an arm as its path was laid out from them.
    #[must_use]
    pub const fn joints(&self, side: Side) -> [Point; 3] {
        *self.plan.arms.get(side)
    }

    /// Lays an arm's path out anew, from where its joints are now.
    pub fn lay_out(&mut self, side: Side, joints: [Point; 3], strategy: Box<dyn Strategy>) {
        *self.plan.arms.get_mut(side) = joints;
        self.replace_strategy(side, strategy);
    }

    /// Ends the present arm after this pass, whatever resistance it finds.
    pub const fn finish_after_this(&mut self) {
        self.finish_after_this = true;
    }

    /// True while resistance on the dressing gripper means something to the strategy.
    #[must_use]
    pub const fn listens(&self) -> bool {
        matches!(self.stage, Stage::Pass)
    }

    /// True where resistance at this place of the dressing gripper means something to the strategy.
    #[must_use]
    pub fn listens_at(&self, position: &Point) -> bool {
        self.listens() && self.strategy(self.arm).heeds(position)
    }

    /// True between passes, where another strategy may take over without a half-finished pass.
    #[must_use]
    pub const fn is_between_passes(&self) -> bool {
        matches!(
            self.stage,
            Stage::StandBack | Stage::Approach | Stage::Receive | Stage::AwaitGoAhead(_) | Stage::Withdraw { .. }
        )
    }

    /// The row of table 3.1 that the trial is in.
    #[must_use]
    pub fn step(&self) -> Step {
        if self.arm != self.settings.first_arm {
            return Step::SecondArm;
        }
        match self.stage {
            Stage::StandBack | Stage::Approach => Step::BehindShoulders,
            Stage::Receive | Stage::AwaitGoAhead(Next::Iteration) | Stage::Withdraw { .. } => Step::Hand,
            Stage::AwaitGoAhead(Next::SecondArm) | Stage::Done => Step::Shoulder,
            Stage::Pass | Stage::Adjust { .. } => self.step_of_pass(),
        }
    }

    fn step_of_pass(&self) -> Step {
        let progress = self.travelled.last().map_or(0.0, |place| self.progress_at(place));
        let [hand, elbow, shoulder] = *self.plan.arms.get(self.arm);
        let to_elbow = (elbow - hand).norm();
        let share = to_elbow / (to_elbow + (shoulder - elbow).norm()).max(f64::EPSILON);
        match progress {
            progress if progress >= 1.0 - 1e-6 => Step::Shoulder,
            progress if progress >= share => Step::UpperArm,
            _ => Step::Forearm,
        }
    }

    /// How far along the arm a place is, from 0 at the hand to 1 at the shoulder.
    #[must_use]
    pub fn progress_at(&self, place: &Point) -> f64 {
        let length = polyline_length(self.strategy(self.arm).path());
        if length <= f64::EPSILON { 0.0 } else { self.metres_at(place) / length }
    }

    /// How far along the arm's path a place is, in metres from the hand.
    #[must_use]
    pub fn metres_at(&self, place: &Point) -> f64 {
        let path = self.strategy(self.arm).path();
        let Some(closest) = closest_on_polyline(place, path) else { return 0.0 };
        let mut passed = 0.0;
        for (start, end) in path.iter().zip(path.iter().skip(1)) {
            let leg = (end - start).norm();
            let into = (closest - start).norm();
            if into + (end - closest).norm() <= leg + 1e-9 {
                return passed + into;
            }
            passed += leg;
        }
        passed
    }

    /// Where the grippers should go now.
    #[must_use]
    pub fn order(&self) -> Order {
        let interval = self.settings.goal_interval_seconds;
        match &self.stage {
            Stage::StandBack => {
                let targets = self.waiting_places().map(|side, place| Some(places::stand_back(side, place)));
                Order::Move { targets, least_seconds: interval }
            }
            Stage::Approach => {
                Order::Move { targets: self.waiting_places().map(|_, place| Some(*place)), least_seconds: interval }
            }
            Stage::Receive => {
                self.strategy(self.arm).path().first().map_or(Order::Wait, |start| self.move_to(*start, interval))
            }
            Stage::Pass => {
                let strategy = self.strategy(self.arm);
                let seconds = interval * strategy.interval_share();
                strategy.goal().map_or(Order::Wait, |goal| self.move_to(goal, seconds))
            }
            Stage::Adjust { to } => self.move_to(*to, 0.0),
            Stage::Withdraw { remaining } => remaining.last().map_or(Order::Wait, |place| self.move_to(*place, 0.0)),
            Stage::AwaitGoAhead(_) | Stage::Done => Order::Wait,
        }
    }

    /// The present goal was reached by the dressing gripper, which is now at `place`.
    ///
    /// # Errors
    /// Where the strategy cannot begin its pass.
    pub fn arrived(&mut self, place: Point) -> Result<Vec<TrialEvent>, StrategyError> {
        match &mut self.stage {
            Stage::StandBack => {
                self.stage = Stage::Approach;
                Ok(Vec::new())
            }
            Stage::Approach => {
                self.stage = Stage::Receive;
                Ok(Vec::new())
            }
            Stage::Receive => self.begin_pass(place),
            Stage::Pass => {
                self.travelled.push(place);
                self.strategies.get_mut(self.arm).arrived();
                Ok(self.end_pass_at_its_end())
            }
            Stage::Adjust { .. } => {
                self.travelled.push(place);
                self.stage = Stage::Pass;
                Ok(self.end_pass_at_its_end())
            }
            Stage::Withdraw { remaining } => {
                remaining.pop();
                if remaining.is_empty() {
                    self.stage = Stage::AwaitGoAhead(Next::Iteration);
                }
                Ok(Vec::new())
            }
            Stage::AwaitGoAhead(_) | Stage::Done => Ok(Vec::new()),
        }
    }

    /// The garment was held up. The strategy says where to give way to; the next order goes there.
    pub fn resisted(&mut self, contact: &Contact) -> Vec<WaypointChange> {
        if !self.listens() {
            return Vec::new();
        }
        let reaction = self.strategies.get_mut(self.arm).resisted(contact);
        self.travelled.push(contact.position);
        self.stage = Stage::Adjust { to: reaction.move_to };
        reaction.changes
    }

    /// What is still felt where the gripper has given way to: newtons in `base`, in the direction of [`Contact::resistance`].
    pub fn settled(&mut self, residual: &Vector) {
        if matches!(self.stage, Stage::Adjust { .. }) {
            self.strategies.get_mut(self.arm).settled(residual);
        }
    }

    /// The operator says that it may go on.
    ///
    /// # Errors
    /// Where the strategy cannot begin its pass.
    pub fn go_ahead(&mut self) -> Result<Vec<TrialEvent>, StrategyError> {
        match self.stage {
            Stage::AwaitGoAhead(Next::Iteration) => {
                let start = self.strategy(self.arm).path().first().copied();
                start.map_or_else(|| Ok(Vec::new()), |start| self.begin_pass(start))
            }
            Stage::AwaitGoAhead(Next::SecondArm) => {
                self.arm = self.arm.other();
                self.iteration = 0;
                self.travelled.clear();
                self.stage = Stage::Receive;
                Ok(Vec::new())
            }
            _ => Ok(Vec::new()),
        }
    }

    /// Gives the pass up and withdraws the garment from `place` along the path that was travelled; a withdrawal under way
    /// goes on. False where the garment is on no arm: then there is nothing to withdraw, and nothing changes.
    pub fn withdraw(&mut self, place: Point) -> bool {
        match self.stage {
            Stage::Withdraw { .. } => true,
            Stage::Pass | Stage::Adjust { .. } | Stage::AwaitGoAhead(Next::SecondArm) => {
                self.travelled.push(place);
                self.start_withdrawal();
                true
            }
            _ => false,
        }
    }

    fn begin_pass(&mut self, place: Point) -> Result<Vec<TrialEvent>, StrategyError> {
        self.strategies.get_mut(self.arm).begin()?;
        self.iteration += 1;
        self.travelled = vec![place];
        self.stage = Stage::Pass;
        Ok(vec![TrialEvent::IterationBegan { side: self.arm, iteration: self.iteration }])
    }

    fn end_pass_at_its_end(&mut self) -> Vec<TrialEvent> {
        if self.strategy(self.arm).goal().is_some() {
            return Vec::new();
        }
        let side = self.arm;
        let summary = self.strategies.get_mut(side).finish();
        let dressed = summary.finished.is_some() || std::mem::take(&mut self.finish_after_this);
        let mut events = vec![TrialEvent::IterationEnded { side, summary }];
        if !dressed {
            self.start_withdrawal();
            return events;
        }
        events.push(TrialEvent::ArmDressed { side });
        if side == self.settings.first_arm {
            self.stage = Stage::AwaitGoAhead(Next::SecondArm);
        } else {
            self.stage = Stage::Done;
            events.push(TrialEvent::Completed);
        }
        events
    }

    fn start_withdrawal(&mut self) {
        // The gripper stands at the last place: the way back begins with the one before it.
        let mut remaining = self.travelled.clone();
        remaining.pop();
        remaining.dedup_by(|next, previous| (*next - *previous).norm() < 1e-6);
        self.stage =
            if remaining.is_empty() { Stage::AwaitGoAhead(Next::Iteration) } else { Stage::Withdraw { remaining } };
    }

    fn move_to(&self, leading: Point, least_seconds: f64) -> Order {
        let trailing = self.trailing_goal(&leading);
        let targets = PerSide::from_fn(|side| if side == self.arm { Some(leading) } else { trailing });
        Order::Move { targets, least_seconds }
    }
}

#[cfg(test)]
mod tests;
