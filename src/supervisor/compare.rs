//! The strategies side by side for this person: what each has brought in force and reach, and what a switch would do now.
//!
//! What was measured is kept from trial to trial as long as valet runs, and marked as older. What was never run is judged
//! by its path alone, where a movement space is known. Nothing here decides.

use super::{Mode, Supervisor};
use crate::body::Side;
use crate::geometry::polyline_length;
use crate::modelling::stick::{Space, StickFit};
use crate::planning::Reach;
use crate::sequencing::{Stage, Trial};
use crate::snapshot::{StrategyRow, StrategyView};
use crate::strategy::{IterationSummary, StrategyKind};
use std::collections::BTreeMap;

/// Into how many pieces a path that was never run is cut to be judged: coarser than one that was, because all are judged
/// while the robot rests.
const PIECES: f64 = 16.0;

/// What one strategy has brought on one arm in its latest run.
#[derive(Clone, Debug, Default)]
pub(super) struct Run {
    energies: Vec<f64>,
    reaches: Vec<Option<f64>>,
    inside: Option<f64>,
    /// The trial it belongs to, counted from 1.
    trial: u32,
}

/// Every run so far, and what is expected of strategies that were not run.
#[derive(Clone, Debug, Default)]
pub(super) struct Comparison {
    runs: BTreeMap<(StrategyKind, Side), Run>,
    trials: u32,
    /// What is still to be compared anew.
    due: Vec<StrategyKind>,
}

impl Comparison {
    pub(super) fn trial_begins(&mut self) {
        self.trials += 1;
        self.is_due();
    }

    /// Something has happened that may change what is compared.
    pub(super) fn is_due(&mut self) {
        self.due = StrategyKind::ALL.into_iter().rev().collect();
    }

    pub(super) fn iteration_ended(&mut self, side: Side, kind: StrategyKind, summary: &IterationSummary) {
        let run = self.runs.entry((kind, side)).or_default();
        if run.trial != self.trials {
            *run = Run { trial: self.trials, ..Run::default() };
        }
        run.energies.push(summary.energy);
        run.reaches.push(summary.reachability);
        run.inside = summary.inside_share;
        self.is_due();
    }

    fn row(&self, kind: StrategyKind, side: Side) -> StrategyRow {
        let run = self.runs.get(&(kind, side)).cloned().unwrap_or_default();
        StrategyRow {
            side,
            reachability: run.reaches.last().copied().flatten(),
            inside: run.inside,
            comfort: run.energies.last().copied(),
            energies: run.energies,
            reaches: run.reaches,
        }
    }

    /// True where the strategy was run in the present trial.
    fn is_measured(&self, kind: StrategyKind) -> bool {
        Side::BOTH.iter().any(|side| self.runs.get(&(kind, *side)).is_some_and(|run| run.trial == self.trials))
    }
}

impl Supervisor {
    /// Compares one strategy anew where something has changed and the arms rest: building and judging a path takes longer
    /// than may be spent while they move. To be called between steps; it changes what is seen and decides nothing.
    pub fn refresh_comparison(&mut self) {
        if !self.rests() {
            return;
        }
        let Some(kind) = self.comparison.due.pop() else { return };
        let compared = self.compared(kind);
        let shown = self.view.strategies.make_mut();
        match shown.iter_mut().find(|strategy| strategy.kind == kind) {
            Some(old) => *old = compared,
            None => shown.push(compared),
        }
    }

    /// True where nothing moves or is about to.
    fn rests(&self) -> bool {
        let waits = |trial: &Trial| matches!(trial.stage(), Stage::AwaitGoAhead(_) | Stage::Done);
        self.mode != Mode::Running || self.trial.as_ref().is_none_or(waits)
    }

    fn compared(&self, kind: StrategyKind) -> StrategyView {
        let (switch, refusal) = match self.switch_words(kind) {
            Ok(words) => (words, None),
            Err(reason) => (String::new(), Some(reason)),
        };
        let rows = Side::BOTH.map(|side| self.expected(kind, self.comparison.row(kind, side)));
        StrategyView { kind, rows: rows.to_vec(), measured: self.comparison.is_measured(kind), switch, refusal }
    }

    /// What a switch to a strategy would do now, or why it is refused.
    fn switch_words(&self, kind: StrategyKind) -> Result<String, String> {
        let side = self.trial.as_ref().map_or(self.setup.settings.trial.first_arm, Trial::arm);
        let joints = match self.trial.as_ref() {
            Some(trial) => trial.joints(side),
            None => self.arm_joints(side)?,
        };
        let mut strategy = self.build_strategy(side, kind, joints)?;
        let Some(trial) = self.trial.as_ref() else { return Ok("the next trial begins with it".into()) };
        if trial.strategy(side).kind() == kind {
            return Ok("it is at work".into());
        }
        let dropped = strategy.adopt(&trial.strategy(side).learned());
        let dropped = if dropped.is_empty() { "nothing is dropped".to_owned() } else { dropped.join("; ") };
        let when = if trial.is_between_passes() { "at once" } else { "when this pass of the garment has ended" };
        Ok(format!("{when}: the {side} arm's path is kept, {dropped}"))
    }

    /// The row of a strategy that was never run, with how reachable the path is that it would begin with.
    fn expected(&self, kind: StrategyKind, row: StrategyRow) -> StrategyRow {
        if !row.energies.is_empty() {
            return row;
        }
        let judged = self.arm_joints(row.side).ok().and_then(|joints| {
            let space = self.space_of(row.side)?.clone();
            let strategy = self.build_strategy(row.side, kind, joints).ok()?;
            let reach = Reach::new(space, &joints, StickFit::coarse(Space::Spatial));
            Some(reach.along(strategy.path(), polyline_length(strategy.path()) / PIECES))
        });
        StrategyRow {
            reachability: judged.map(|judged| judged.score),
            inside: judged.map(|judged| judged.inside_share),
            ..row
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn summary(iteration: u32, energy: f64) -> IterationSummary {
        let reachability = Some(-f64::from(iteration));
        IterationSummary { energy, reachability, ..IterationSummary::idle(iteration, &[], None) }
    }

    #[test]
    fn the_latest_run_of_a_strategy_is_kept_and_an_older_one_is_no_longer_of_this_trial() {
        let mut comparison = Comparison::default();
        comparison.trial_begins();
        for (iteration, energy) in [(1, 22.0), (2, 5.0)] {
            comparison.iteration_ended(Side::Right, StrategyKind::Force, &summary(iteration, energy));
        }
        let row = comparison.row(StrategyKind::Force, Side::Right);
        assert_eq!(
            (row.energies.as_slice(), row.comfort, row.reachability),
            ([22.0, 5.0].as_slice(), Some(5.0), Some(-2.0))
        );
        assert!(comparison.is_measured(StrategyKind::Force) && !comparison.is_measured(StrategyKind::Gmm));
        comparison.trial_begins();
        assert!(!comparison.is_measured(StrategyKind::Force), "measured in an earlier trial");
        assert_eq!(comparison.row(StrategyKind::Force, Side::Right).energies.len(), 2);
        comparison.iteration_ended(Side::Right, StrategyKind::Force, &summary(1, 9.0));
        assert_eq!(comparison.row(StrategyKind::Force, Side::Right).energies, [9.0]);
    }
}
