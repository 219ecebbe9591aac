//! A recorded trial on paper: gathered by running the journal through the core, drawn as figures, told as a page.
//!
//! Every number comes from the journal or from the core that replays it; what the journal does not hold is said to be
//! missing, never filled in.

mod answers;
mod compare;
mod figures;
mod page;

pub use answers::{Answers, AnswersError};
pub use compare::compare;
pub use page::write;

use crate::body::{Joint, PerSide, Side};
use crate::command::Command;
use crate::geometry::Point;
use crate::modelling::MovementSpace;
use crate::record::{Header, JournalError, JournalFile, Reading, Replay, Step};
use crate::snapshot::{Detection, EllipseView, ForceSample, Level, Outcome};
use crate::strategy::{IterationSummary, StrategyKind, WaypointChange};
use crate::supervisor::{Effect, EndpointSample, Input};
use crate::time::Stamp;
use std::path::PathBuf;

/// One pass along an arm.
#[derive(Clone, Debug)]
pub struct Iteration {
    /// Which arm.
    pub side: Side,
    /// Which strategy.
    pub strategy: StrategyKind,
    /// What came of it.
    pub summary: IterationSummary,
    /// Seconds it took.
    pub duration_seconds: f64,
    /// The path that it began with, in `base`.
    pub planned: Vec<Point>,
    /// Where the gripper went.
    pub travelled: Vec<Point>,
    /// Components of the movement space that were shown.
    pub ellipses: Vec<EllipseView>,
}

/// How often a joint was where the person can move it to.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Compliance {
    /// Poses inside the 95 % region of the joint's movement space.
    pub inside: u64,
    /// Poses in all.
    pub poses: u64,
}

/// What a journal tells of a trial.
#[derive(Clone, Debug)]
pub struct TrialRecord {
    /// The journal's file.
    pub path: PathBuf,
    /// What its page and plots are called: the journal's name, numbered where several trials bear the same.
    pub name: String,
    /// What the trial was run with.
    pub header: Header,
    /// How the journal was read.
    pub reading: Reading,
    /// When the first step was, by the core's time.
    pub began: Stamp,
    /// Seconds from the first step to the last.
    pub seconds: f64,
    /// Forces by side.
    pub forces: PerSide<Vec<ForceSample>>,
    /// Resistances by side.
    pub detections: PerSide<Vec<Detection>>,
    /// The detector's threshold in newtons, by side.
    pub thresholds: PerSide<f64>,
    /// All passes.
    pub iterations: Vec<Iteration>,
    /// Way-points that moved: seconds, arm, what and why.
    pub waypoints: Vec<(f64, Side, WaypointChange)>,
    /// Stops, holds and faults: seconds and words.
    pub stops: Vec<(f64, String)>,
    /// Notes of the operator.
    pub notes: Vec<(f64, String)>,
    /// How it ended, and why.
    pub end: Option<(Outcome, String)>,
    /// Compliance of each joint with the movement space; empty without one.
    pub compliance: Vec<(Side, Joint, Compliance)>,
    /// Steps that the core now decides otherwise.
    pub differences: u64,
    /// The short questionnaires, as far as they were answered.
    pub answers: Answers,
}

/// The 95 % quantile of the chi-squared distribution with three degrees of freedom.
const REGION_95: f64 = 7.815;
/// Steps between two looks at the force history, which keeps a minute.
const LOOK_EVERY: u64 = 4000;

impl TrialRecord {
    /// Reads a journal and runs it through the core.
    ///
    /// # Errors
    /// [`JournalError`] where the journal cannot be read at all.
    pub fn gather(journal: impl Into<JournalFile>) -> Result<Self, JournalError> {
        let journal = journal.into();
        let mut gathering = Gathering::default();
        let reading = Replay::run(&journal, Ok, |replay, now, step, effects, difference| {
            gathering.differences += u64::from(difference.is_some());
            gathering.step(replay, now, step, effects);
        })?;
        Ok(gathering.finish(&journal, reading))
    }

    /// The strategy of the first pass, or `None` where there was none.
    #[must_use]
    pub fn strategy(&self) -> Option<StrategyKind> {
        self.iterations.first().map(|iteration| iteration.strategy)
    }

    /// The passes of an arm.
    pub fn passes(&self, side: Side) -> impl Iterator<Item = &Iteration> {
        self.iterations.iter().filter(move |iteration| iteration.side == side)
    }
}

#[derive(Default)]
struct Gathering {
    began: Option<Stamp>,
    last: Stamp,
    steps: u64,
    forces: PerSide<Vec<ForceSample>>,
    detections: PerSide<Vec<Detection>>,
    thresholds: PerSide<f64>,
    iterations: Vec<Iteration>,
    waypoints: Vec<(f64, Side, WaypointChange)>,
    stops: Vec<(f64, String)>,
    notes: Vec<(f64, String)>,
    end: Option<(Outcome, String)>,
    compliance: PerSide<[Compliance; 3]>,
    differences: u64,
    /// Arm and number of the iteration that is under way, and where its gripper went.
    under_way: Option<(Side, u32)>,
    travelled: Vec<Point>,
}

/// The least distance between two places of a travelled path, in metres: finer cannot be told apart on paper.
const TRAVELLED_APART: f64 = 0.003;

impl Gathering {
    fn step(&mut self, replay: &Replay, now: Stamp, step: &Step, effects: &[Effect]) {
        let seconds = now.since(*self.began.get_or_insert(now)).as_secs_f64();
        self.last = now;
        self.steps += 1;
        self.input(replay, seconds, &step.input);
        let looked = self.steps.is_multiple_of(LOOK_EVERY) || effects.iter().any(ends_something);
        if looked {
            self.look(replay, now);
        }
        for effect in effects {
            self.effect(replay, now, seconds, effect);
        }
    }

    fn input(&mut self, replay: &Replay, seconds: f64, input: &Input) {
        match input {
            Input::Operator { command: Command::Note(text), .. } => self.notes.push((seconds, text.clone())),
            Input::Endpoint(sample) => self.travel(replay, sample),
            Input::Body(pose) => {
                let Some(space) = replay.space() else { return };
                for side in Side::BOTH {
                    count(self.compliance.get_mut(side), space, side, |joint| pose.arms.get(side).position(joint));
                }
            }
            _ => {}
        }
    }

    /// Follows the gripper that dresses through its iteration, by where the robot says it is.
    fn travel(&mut self, replay: &Replay, sample: &EndpointSample) {
        let Some(trial) = replay.supervisor().trial().filter(|trial| trial.arm() == sample.side) else { return };
        let under_way = Some((trial.arm(), trial.iteration()));
        if self.under_way != under_way {
            self.under_way = under_way;
            self.travelled.clear();
        }
        let place = Point::from(sample.pose.translation.vector);
        let is_apart = self.travelled.last().is_none_or(|last| (place - last).norm() > TRAVELLED_APART);
        if trial.listens() && is_apart && place.coords.iter().all(|value| value.is_finite()) {
            self.travelled.push(place);
        }
    }

    fn effect(&mut self, replay: &Replay, now: Stamp, seconds: f64, effect: &Effect) {
        match effect {
            Effect::Iteration { side, strategy, summary, duration_seconds } => {
                let path = replay.supervisor().snapshot(now).sides.get(*side).path.clone();
                self.iterations.push(Iteration {
                    side: *side,
                    strategy: *strategy,
                    summary: summary.clone(),
                    duration_seconds: *duration_seconds,
                    planned: path.planned.to_vec(),
                    travelled: std::mem::take(&mut self.travelled),
                    ellipses: path.ellipses.to_vec(),
                });
            }
            Effect::Waypoint { side, change } => self.waypoints.push((seconds, *side, *change)),
            Effect::Stopped { cause, .. } => self.stops.push((seconds, format!("emergency stop: {cause}"))),
            Effect::Log { level: Level::Warning | Level::Error, text } => self.stops.push((seconds, text.clone())),
            Effect::TrialEnded { outcome, reason } => self.end = Some((*outcome, reason.clone())),
            _ => {}
        }
    }

    /// Takes over what the core's histories hold since the last look.
    fn look(&mut self, replay: &Replay, now: Stamp) {
        let snapshot = replay.supervisor().snapshot(now);
        for (side, view) in snapshot.sides.iter() {
            let forces = self.forces.get_mut(side);
            let last = forces.last().map_or(Stamp::ZERO, |sample| sample.stamp);
            forces.extend(view.force.samples.iter().filter(|sample| sample.stamp > last));
            let detections = self.detections.get_mut(side);
            let last = detections.last().map_or(Stamp::ZERO, |detection| detection.stamp);
            detections.extend(view.force.detections.iter().filter(|found| found.stamp > last).cloned());
            *self.thresholds.get_mut(side) = view.force.window.threshold;
        }
    }

    fn finish(self, journal: &JournalFile, reading: Reading) -> TrialRecord {
        let began = self.began.unwrap_or_default();
        let counted = Side::BOTH.into_iter().flat_map(|side| {
            let counts = *self.compliance.get(side);
            Joint::DRESSED.into_iter().zip(counts).map(move |(joint, count)| (side, joint, count))
        });
        TrialRecord {
            path: journal.path().to_path_buf(),
            name: journal.name(),
            header: reading.header.clone(),
            reading,
            began,
            seconds: self.last.since(began).as_secs_f64(),
            forces: self.forces,
            detections: self.detections,
            thresholds: self.thresholds,
            iterations: self.iterations,
            waypoints: self.waypoints,
            stops: self.stops,
            notes: self.notes,
            end: self.end,
            compliance: counted.filter(|(_, _, count)| count.poses > 0).collect(),
            differences: self.differences,
            answers: Answers::default(),
        }
    }
}

fn count(counts: &mut [Compliance; 3], space: &MovementSpace, side: Side, position: impl Fn(Joint) -> Option<Point>) {
    for (joint, count) in Joint::DRESSED.into_iter().zip(counts) {
        let Some((mixture, place)) = space.arms.get(side).joint(joint).zip(position(joint)) else { continue };
        count.poses += 1;
        count.inside += u64::from(mixture.contains(&place.coords, REGION_95));
    }
}

const fn ends_something(effect: &Effect) -> bool {
    matches!(effect, Effect::Iteration { .. } | Effect::TrialEnded { .. } | Effect::Stopped { .. })
}
