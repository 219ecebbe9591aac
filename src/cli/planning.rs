//! The planner outside this process, on a thread of its own: the supervisor's beat never waits for it.

use super::exit::Failure;
use crate::kinematics::RobotModel;
use crate::ros::{MoveItPlanner, Node};
use crate::supervisor::{Input, PlanOrder, PlannerKind, Setup};
use crossbeam_channel::{Sender, TrySendError, bounded};
use std::sync::Arc;
use std::thread;

/// Questions that may wait: only the newest is ever waited for.
const QUESTIONS: usize = 1;

/// Puts the planner that was asked for into a setup.
pub(super) fn choose_planner(setup: &mut Setup, name: Option<&str>) -> Result<(), Failure> {
    if name.is_some() {
        setup.settings.planner = planner_named(name)?;
    }
    Ok(())
}

/// The planner of a name; the built-in one without a name.
pub(super) fn planner_named(name: Option<&str>) -> Result<PlannerKind, Failure> {
    let Some(name) = name else { return Ok(PlannerKind::BuiltIn) };
    let names = PlannerKind::ALL.map(|(known, _)| known).join(", ");
    let found = PlannerKind::ALL.into_iter().find(|(known, _)| *known == name);
    let unknown = || Failure::Configuration(format!("--planner {name} is none of {names}"));
    Ok(found.ok_or_else(unknown)?.1)
}

/// Where questions go.
pub(super) struct PlannerThread {
    questions: Sender<PlanOrder>,
    answer: Arc<dyn Fn(Input) + Send + Sync>,
}

impl PlannerThread {
    /// A thread that asks MoveIt and gives each answer to `answer`. It ends when this is dropped and its last call is over.
    ///
    /// # Errors
    /// Where the system has no thread to give.
    pub(super) fn start(
        node: &Node,
        model: RobotModel,
        answer: Arc<dyn Fn(Input) + Send + Sync>,
    ) -> std::io::Result<Self> {
        let planner = MoveItPlanner::new(node, model);
        let (questions, asked) = bounded::<PlanOrder>(QUESTIONS);
        let tell = Arc::clone(&answer);
        thread::Builder::new().name("planner".into()).spawn(move || {
            for order in asked {
                let ways = planner.ways(&order.start, &order.targets).map_err(|error| error.to_string());
                tell(Input::Planned { number: order.number, ways });
            }
        })?;
        Ok(Self { questions, answer })
    }

    /// Passes a question on; where the thread is still at an old one, the answer is a refusal.
    pub(super) fn ask(&self, order: PlanOrder) {
        if let Err(TrySendError::Full(order) | TrySendError::Disconnected(order)) = self.questions.try_send(order) {
            let ways = Err("it is still busy with an earlier question; continue in a few seconds".into());
            (self.answer)(Input::Planned { number: order.number, ways });
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_planner_is_chosen_by_name_and_an_unknown_one_is_refused_with_the_names() {
        let mut setup = Setup::default();
        choose_planner(&mut setup, None).unwrap();
        assert_eq!(setup.settings.planner, PlannerKind::BuiltIn);
        choose_planner(&mut setup, Some("moveit")).unwrap();
        assert_eq!(setup.settings.planner, PlannerKind::MoveIt);
        let words = choose_planner(&mut setup, Some("ompl")).unwrap_err().to_string();
        assert!(words.contains("built_in, moveit"), "{words}");
    }
}
