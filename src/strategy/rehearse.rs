//! Runs a strategy over a problem that can be probed anywhere, as the thesis' synthetic problems can.
//!
//! Straight lines are probed every `step`, their start left out; what is felt above the threshold is a contact.

use super::{Contact, IterationSummary, Strategy, StrategyError};
use crate::geometry::{Point, Vector};
use crate::planning::line;

/// How a problem is probed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Probing {
    /// Between two probes, in metres.
    pub step: f64,
    /// What is felt counts as a contact above this many newtons.
    pub threshold: f64,
}

/// Runs one iteration. `sense` gives the resistance at a point.
///
/// # Errors
/// [`StrategyError`] where the strategy has ended.
pub fn iteration(
    strategy: &mut dyn Strategy,
    probing: &Probing,
    sense: &mut dyn FnMut(&Point) -> Vector,
) -> Result<IterationSummary, StrategyError> {
    strategy.begin()?;
    let mut current = strategy.path().first().copied().unwrap_or_default();
    while let Some(goal) = strategy.goal() {
        let Some(contact) = first_contact(strategy, probing, sense, current, goal) else {
            strategy.arrived();
            current = goal;
            continue;
        };
        let reaction = strategy.resisted(&contact);
        current = reaction.move_to;
        if reaction.ignored.is_none() && strategy.learns_from_residuals() {
            strategy.settled(&sense(&current));
        }
    }
    Ok(strategy.finish())
}

fn first_contact(
    strategy: &dyn Strategy,
    probing: &Probing,
    sense: &mut dyn FnMut(&Point) -> Vector,
    current: Point,
    goal: Point,
) -> Option<Contact> {
    let heard = line::points(current, goal, probing.step).filter(|position| strategy.listens_at(position));
    let felt = heard.map(|position| Contact { position, resistance: sense(&position) });
    let mut felt = felt.filter(|contact| contact.resistance.norm() > probing.threshold);
    felt.next()
}

/// Runs iterations until the strategy has finished.
///
/// # Errors
/// [`StrategyError`] where the strategy has ended already.
pub fn run(
    strategy: &mut dyn Strategy,
    probing: &Probing,
    mut sense: impl FnMut(&Point) -> Vector,
) -> Result<Vec<IterationSummary>, StrategyError> {
    let mut summaries = Vec::new();
    loop {
        let summary = iteration(strategy, probing, &mut sense)?;
        let finished = summary.finished.is_some();
        summaries.push(summary);
        if finished {
            return Ok(summaries);
        }
    }
}
