//! Planners outside this process: a question goes out as an effect, the answer comes back as an input, and what it brings is
//! checked and timed like a plan of our own.
//!
//! While a question is open both arms stand still. An answer that nobody waits for any more is dropped.

use super::effect::PlanOrder;
use super::start::OpenStart;
use super::{Effect, Mode, PlannerKind, Supervisor};
use crate::body::PerSide;
use crate::kinematics::{JointVector, MotionLimits, MotionRefusal, Target, Ways, plan_through};
use crate::time::Stamp;

/// What was asked and not answered yet, and how often.
#[derive(Debug, Default)]
pub(super) struct Questions {
    asked: u64,
    open: Option<(PlanOrder, MotionLimits)>,
    /// The posture to begin from, while it is searched.
    pub(super) start: Option<OpenStart>,
}

impl Questions {
    /// True while an answer is waited for.
    pub(super) const fn is_open(&self) -> bool {
        self.open.is_some() || self.start.is_some()
    }

    /// The number of the next question.
    pub(super) const fn next_number(&mut self) -> u64 {
        self.asked += 1;
        self.asked
    }
}

impl Supervisor {
    /// True where lines are planned by somebody else.
    pub(super) fn plans_outside(&self) -> bool {
        self.setup.settings.planner != PlannerKind::BuiltIn
    }

    /// Asks the planner outside.
    pub(super) fn ask_planner(
        &mut self,
        now: Stamp,
        start: PerSide<JointVector>,
        targets: PerSide<Option<Target>>,
        limits: MotionLimits,
    ) {
        let order = PlanOrder { number: self.questions.next_number(), start, targets };
        self.questions.open = Some((order, limits));
        self.protection.watchdogs_mut().planner_asked(now);
        self.effects.push(Effect::Plan(order));
    }

    /// Nobody waits for an answer any more.
    pub(super) fn forget_question(&mut self) {
        self.questions.open = None;
        self.questions.start = None;
        self.protection.watchdogs_mut().planner_answered();
    }

    /// Takes an answer: starts the motion, or holds with the reason.
    pub(super) fn see_planned(&mut self, now: Stamp, number: u64, ways: &Result<Ways, String>) {
        let Some((order, limits)) = self.questions.open.take_if(|(order, _)| order.number == number) else { return };
        self.forget_question();
        if self.mode != Mode::Running {
            return;
        }
        let scene = self.surroundings();
        let planned = ways
            .as_ref()
            .map_err(|reason| MotionRefusal::Planner { reason: reason.clone() })
            .and_then(|ways| plan_through(&self.model, &scene, &order.start, &order.targets, ways, &limits));
        self.begin(now, planned);
    }
}
