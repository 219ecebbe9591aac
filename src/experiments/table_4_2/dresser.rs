//! One arm dressed by the node itself in virtual time: what `valet demo --headless` does, up to the end of the first arm.
//!
//! Nothing is decided here. Supervisor, planner, guards, strategy and simulated world are those of every other trial; this
//! only watches one and writes down, pass by pass, what was planned, travelled, felt and changed.

use crate::body::Side;
use crate::geometry::Point;
use crate::headless::{ScriptedOperator, TrialResult, VirtualError, VirtualTrial};
use crate::modelling::MovementSpace;
use crate::sequencing::Trial;
use crate::sim::WorldSetup;
use crate::snapshot::{Outcome, Watermark};
use crate::strategy::{IterationSummary, StrategyKind, WaypointChange};
use crate::supervisor::{Effect, Input, Setup};
use crate::time::Stamp;
use std::time::Duration;

/// What the thesis' robot took to plan and start a new motion after a resistance, in seconds. Its table 4.2 grows by
/// about 11 s a resistance; the rest of that is the halt, the correction and the slower way after it.
pub const PLANNING_SECONDS: f64 = 5.0;
/// How often the scripted operator goes on after a hold, as in `valet demo --headless`.
const CONTINUES: u32 = 10;
/// No experiment of the thesis took longer than 195 s (table 4.2); eight passes with all their resistances stay below this.
const LONGEST_EXPERIMENT: Duration = Duration::from_secs(1_800);

/// One resistance and the strategy's answer.
#[derive(Clone, Debug, PartialEq)]
pub struct ContactRecord {
    /// Where the gripper stood, in metres in `base`.
    pub position: Point,
    /// Which way-points moved.
    pub changes: Vec<WaypointChange>,
}

/// One pass of the garment along the arm.
#[derive(Clone, Debug, PartialEq)]
pub struct PassRecord {
    /// What the strategy says of it.
    pub summary: IterationSummary,
    /// The path that was planned at its beginning, in metres in `base`.
    pub planned: Vec<Point>,
    /// Its resistances that moved a way-point, in order.
    pub contacts: Vec<ContactRecord>,
    /// Seconds from the first motion of the pass to its end.
    pub motion_seconds: f64,
    /// The gripper's places by beat, in metres in `base`.
    pub travelled: Vec<Point>,
}

impl PassRecord {
    /// Seconds that the pass took, with the planning time of the thesis' robot for each resistance.
    #[must_use]
    pub fn duration_seconds(&self) -> f64 {
        self.motion_seconds + PLANNING_SECONDS * f64::from(self.summary.contacts)
    }
}

/// One experiment: all passes along one arm.
#[derive(Clone, Debug, PartialEq)]
pub struct DressingRecord {
    /// The passes in order.
    pub passes: Vec<PassRecord>,
    /// How it ended: [`Outcome::Completed`] where the arm is dressed.
    pub outcome: Outcome,
}

impl DressingRecord {
    /// Passes until no resistance was left.
    #[must_use]
    pub fn iterations(&self) -> usize {
        self.passes.len()
    }

    /// True where the arm is dressed and the last pass met no resistance.
    #[must_use]
    pub fn is_free(&self) -> bool {
        self.outcome == Outcome::Completed && self.passes.last().is_some_and(|pass| pass.summary.contacts == 0)
    }

    /// Sum of detected resistance over all passes in newtons (the thesis' energy).
    #[must_use]
    pub fn energy_newtons(&self) -> f64 {
        self.passes.iter().map(|pass| pass.summary.energy).sum()
    }

    /// Resistances of all passes.
    #[must_use]
    pub fn resistances(&self) -> u32 {
        self.passes.iter().map(|pass| pass.summary.contacts).sum()
    }

    /// Seconds that the passes took, with the planning time of the thesis' robot for each resistance.
    #[must_use]
    pub fn duration_seconds(&self) -> f64 {
        self.passes.iter().map(PassRecord::duration_seconds).sum()
    }
}

/// Dresses one arm with chapter 4's strategy and returns what came of it.
///
/// # Errors
/// Where the person, the garment or the settings cannot be.
pub fn dress(world: &WorldSetup, side: Side) -> Result<DressingRecord, VirtualError> {
    dress_with(world, side, StrategyKind::Force, None)
}

/// Dresses one arm with a strategy, some of which need the person's movement space.
///
/// # Errors
/// Where the person, the garment or the settings cannot be.
pub fn dress_with(
    world: &WorldSetup,
    side: Side,
    kind: StrategyKind,
    space: Option<&MovementSpace>,
) -> Result<DressingRecord, VirtualError> {
    let mut setup = Setup { space: space.cloned(), seed: world.seed, watermark: Watermark::Demo, ..Setup::default() };
    setup.settings.strategy = kind;
    setup.settings.trial.first_arm = side;
    let mut trial = VirtualTrial::new(setup, world)?;
    let mut watcher = Watcher::new(side);
    let result = trial.run_until(
        &mut ScriptedOperator::new(CONTINUES),
        LONGEST_EXPERIMENT,
        |now, input, effects| watcher.see(now, input, effects),
        |effect| dressed(effect, side).or_else(|| TrialResult::of(effect)),
    );
    let outcome = result.map_or(Outcome::Fault, |result| result.outcome);
    Ok(DressingRecord { passes: watcher.passes_from(trial.trial()), outcome })
}

/// The end of the last pass along the arm of a side.
fn dressed(effect: &Effect, wanted: Side) -> Option<TrialResult> {
    match effect {
        Effect::Iteration { side, summary, .. } if *side == wanted && summary.finished.is_some() => {
            Some(TrialResult { outcome: Outcome::Completed, reason: format!("the {side} arm is dressed") })
        }
        _ => None,
    }
}

/// Writes down what happens to one arm.
struct Watcher {
    side: Side,
    passes: Vec<PassRecord>,
    contacts: Vec<ContactRecord>,
    travelled: Vec<(Stamp, Point)>,
}

impl Watcher {
    const fn new(side: Side) -> Self {
        Self { side, passes: Vec::new(), contacts: Vec::new(), travelled: Vec::new() }
    }

    fn see(&mut self, now: Stamp, input: &Input, effects: &[Effect]) {
        if let Input::Endpoint(sample) = input
            && sample.side == self.side
        {
            self.travelled.push((now, sample.pose.translation.vector.into()));
        }
        let changes = effects.iter().filter_map(|effect| match effect {
            Effect::Waypoint { side, change } if *side == self.side => Some(*change),
            _ => None,
        });
        let changes: Vec<_> = changes.collect();
        if let (false, Some((_, position))) = (changes.is_empty(), self.travelled.last()) {
            self.contacts.push(ContactRecord { position: *position, changes });
        }
        for effect in effects {
            if let Effect::Iteration { side, summary, duration_seconds, .. } = effect
                && *side == self.side
            {
                self.end_pass(now, summary.clone(), *duration_seconds);
            }
        }
    }

    fn end_pass(&mut self, now: Stamp, summary: IterationSummary, motion_seconds: f64) {
        let travelled = std::mem::take(&mut self.travelled).into_iter();
        let of_the_pass = travelled.filter(|(stamp, _)| now.since(*stamp).as_secs_f64() <= motion_seconds);
        self.passes.push(PassRecord {
            planned: self.passes.last().map(|before| before.summary.path.clone()).unwrap_or_default(),
            contacts: std::mem::take(&mut self.contacts),
            travelled: of_the_pass.map(|(_, place)| place).collect(),
            motion_seconds,
            summary,
        });
    }

    /// The passes; the first was planned through hand, elbow and shoulder as they were seen.
    fn passes_from(mut self, trial: Option<&Trial>) -> Vec<PassRecord> {
        if let (Some(first), Some(trial)) = (self.passes.first_mut(), trial) {
            first.planned = trial.joints(self.side).to_vec();
        }
        self.passes
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_experiment_is_watched_pass_by_pass() {
        let record = dress(&WorldSetup::default(), Side::Right).unwrap();
        assert!(record.is_free() && record.iterations() >= 2, "{:?}", record.outcome);
        for pass in &record.passes {
            assert!(pass.planned.len() >= 3 && pass.travelled.len() > 300);
            assert!((pass.travelled.len() as f64 / 100.0 - pass.motion_seconds).abs() < 0.1);
            assert!(pass.contacts.len() <= pass.summary.contacts as usize);
        }
        let [first, second, ..] = record.passes.as_slice() else { panic!("{}", record.iterations()) };
        assert_eq!(first.summary.path, second.planned);
        let start = first.travelled.first().unwrap();
        assert!((start - first.planned[0]).norm() < 0.02, "{start}");
        assert!(!first.contacts.is_empty() && !first.contacts[0].changes.is_empty());
    }

    #[test]
    fn the_left_arm_can_be_the_first() {
        let record = dress(&WorldSetup::default(), Side::Left).unwrap();
        assert!(record.is_free());
        assert!(record.passes.iter().all(|pass| pass.planned.iter().all(|place| place.y > 0.0)));
    }
}
