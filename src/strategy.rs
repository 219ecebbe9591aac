//! How a path learns from one iteration to the next.
//!
//! A [`Strategy`] is a small machine that is told what happened (the goal was reached, the garment was held up) and answers
//! where to go next. It is pure: no clock, no thread, no random source but its seed. One and the same machine serves the
//! robot, where a contact may come anywhere on the way, and the thesis' synthetic problem, where [`rehearse`] probes the
//! path step by step. It never moves anything and never judges safety.

mod blend;
mod error;
mod explained;
mod fixed;
mod force;
mod kernel;
mod learner;
mod multimodal;
mod nodes;
mod offset_field;
pub mod rehearse;
mod report;
mod settings;

pub use blend::BlendStrategy;
pub use error::StrategyError;
pub use fixed::FixedPath;
pub use force::ForceStrategy;
pub use multimodal::MultimodalStrategy;
pub use nodes::NodeStrategy;
pub use report::{Contact, Finish, Ignored, IterationSummary, LearnedPath, Reaction, Rule, WaypointChange};
pub use settings::{
    BlendSettings, Guards, KernelSettings, LearningSettings, MultimodalSettings, OffsetFieldSettings, StrategySettings,
};

use crate::geometry::{Finite, Point, Vector};
use crate::modelling::ArmSpace;
use crate::modelling::stick::{Space, StickFit};
use crate::planning::Reach;
use serde::{Deserialize, Serialize};
use std::fmt;

/// A strategy that an operator can choose.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum StrategyKind {
    /// A fixed path from the person's movement space (thesis chapter 3).
    Gmm,
    /// A path that gives way to the force, iteration by iteration (chapter 4, algorithm 2).
    Force,
    /// Force and movement space together (chapter 5, algorithm 3).
    Multimodal,
    /// A contact's correction is carried along the path.
    Kernel,
    /// A Gaussian-process field of offsets.
    OffsetField,
    /// The comfort path blended towards the movement space.
    Blend,
}

impl StrategyKind {
    /// All strategies, the thesis' three first.
    pub const ALL: [Self; 6] = [Self::Gmm, Self::Force, Self::Multimodal, Self::Kernel, Self::OffsetField, Self::Blend];

    /// The name that files, arguments and screens share.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Gmm => "gmm",
            Self::Force => "force",
            Self::Multimodal => "multimodal",
            Self::Kernel => "kernel",
            Self::OffsetField => "offset_field",
            Self::Blend => "blend",
        }
    }
}

impl fmt::Display for StrategyKind {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.pad(self.name())
    }
}

/// How a path learns.
///
/// The order of calls in an iteration is [`begin`](Self::begin), then for each [`goal`](Self::goal) either
/// [`arrived`](Self::arrived) or one or more [`resisted`](Self::resisted), and [`finish`](Self::finish) once `goal` is
/// `None`. Calls out of order are harmless: they change nothing. Positions are metres in one fixed frame.
pub trait Strategy: Send + fmt::Debug {
    /// Which strategy this is.
    fn kind(&self) -> StrategyKind;

    /// The path that the present iteration follows, or the next one where none is under way.
    fn path(&self) -> &[Point];

    /// Starts an iteration at the path's first point, which never moves.
    ///
    /// # Errors
    /// [`StrategyError::Finished`] where the strategy has ended.
    fn begin(&mut self) -> Result<(), StrategyError>;

    /// Where to go now in a straight line; `None` at the iteration's end, or where none is under way.
    fn goal(&self) -> Option<Point>;

    /// The garment was held up on the way to the goal. Go to [`Reaction::move_to`], then on to the new goal.
    fn resisted(&mut self, contact: &Contact) -> Reaction;

    /// What is still felt after the move that the last reaction asked for. Strategies that learn how stiff the garment
    /// is use it; for others it changes nothing.
    fn settled(&mut self, _residual: &Vector) {}

    /// Whether [`settled`](Self::settled) teaches this strategy anything: a reading costs a probe.
    fn learns_from_residuals(&self) -> bool {
        false
    }

    /// The goal was reached.
    fn arrived(&mut self);

    /// Whether a resistance at `position` would be listened to. Problems that can be probed anywhere ask before they
    /// probe.
    fn listens_at(&self, position: &Point) -> bool;

    /// Whether a contact that came unasked at `position`, anywhere on the way, would move anything.
    fn heeds(&self, position: &Point) -> bool {
        self.listens_at(position)
    }

    /// Which share of the thesis' interval between two goals (section 4.4.3: 3 s) a goal takes: 1 where goals are
    /// way-points, less where a path is drawn with nodes so dense that a pass would take minutes.
    fn interval_share(&self) -> f64 {
        1.0
    }

    /// Ends the iteration: moments are averaged, and what was travelled becomes the next path.
    fn finish(&mut self) -> IterationSummary;

    /// What has been learned so far, for another strategy to go on from or for a file.
    fn learned(&self) -> LearnedPath;

    /// Goes on from what another strategy learned: its path is kept. Says, in words, what is dropped. Only between
    /// iterations; an iteration under way is given up.
    fn adopt(&mut self, learned: &LearnedPath) -> Vec<String>;
}

/// What a strategy is built for: one arm of one person.
#[derive(Clone, Debug, PartialEq)]
pub struct ArmContext {
    /// Where hand, elbow and shoulder are at the start, in metres: the initial dressing path (thesis section 4.4.3).
    pub initial: [Point; 3],
    /// Where they can be; `None` where no movement space has been recorded.
    pub space: Option<ArmSpace>,
    /// Seed of all random draws.
    pub seed: u64,
}

/// Builds a strategy.
///
/// # Errors
/// [`StrategyError`] where a setting is not usable (with its key), where the initial path has points that coincide or
/// are not finite, or where the strategy needs a movement space and there is none.
pub fn build(
    kind: StrategyKind,
    settings: &StrategySettings,
    context: &ArmContext,
) -> Result<Box<dyn Strategy>, StrategyError> {
    settings.validate()?;
    check_path(&context.initial)?;
    let space = || context.space.as_ref().ok_or(StrategyError::NoMovementSpace { strategy: kind });
    let initial = &context.initial;
    let learning = &settings.learning;
    let strategy: Box<dyn Strategy> = match kind {
        StrategyKind::Gmm => Box::new(FixedPath::from_space(space()?, initial)),
        StrategyKind::Force => Box::new(ForceStrategy::new(initial, learning)),
        StrategyKind::Multimodal => {
            if settings.multimodal.whole_arm && space()?.whole.is_none() {
                return Err(StrategyError::NoWholeArm);
            }
            Box::new(MultimodalStrategy::new(context, space()?, learning, &settings.multimodal))
        }
        StrategyKind::Kernel => Box::new(kernel_step(initial, learning, &settings.kernel)),
        StrategyKind::OffsetField => Box::new(offset_field(initial, learning, &settings.offset_field)),
        StrategyKind::Blend => Box::new(blended(settings, initial, space()?)),
    };
    Ok(match &context.space {
        Some(space) => Box::new(explained::Explained::new(strategy, coarse_reach(space, initial))),
        None => strategy,
    })
}

/// A judge that is quick enough to answer between two control steps.
fn coarse_reach(space: &ArmSpace, initial: &[Point; 3]) -> Reach {
    Reach::new(space.clone(), initial, StickFit::coarse(Space::Spatial))
}

fn blended(settings: &StrategySettings, initial: &[Point; 3], space: &ArmSpace) -> BlendStrategy {
    // One iteration is kept for the pass that shows what the blend costs in force.
    let iterations = settings.learning.maximum_iterations.saturating_sub(1).max(1);
    let learning = LearningSettings { maximum_iterations: iterations, ..settings.learning.clone() };
    let comfort = kernel_step(initial, &learning, &settings.kernel);
    let [hand, elbow, shoulder] = initial;
    let reachable = [*hand, Point::from(space.elbow.nearest_mean(&elbow.coords).1), *shoulder];
    BlendStrategy::new(comfort, coarse_reach(space, initial), &reachable, &settings.blend)
}

/// The kernel step on any initial path. The settings have been checked.
#[must_use]
pub fn kernel_step(initial: &[Point], learning: &LearningSettings, settings: &KernelSettings) -> NodeStrategy {
    let correction = Box::new(kernel::KernelStep::new(settings));
    let learn = settings.learn_stiffness;
    NodeStrategy::new(StrategyKind::Kernel, initial, learning, correction, settings.stiffness, learn)
}

/// The Gaussian-process field of offsets on any initial path. The settings have been checked.
#[must_use]
pub fn offset_field(initial: &[Point], learning: &LearningSettings, settings: &OffsetFieldSettings) -> NodeStrategy {
    let correction = Box::new(offset_field::OffsetField::new(settings));
    let learn = settings.learn_stiffness;
    NodeStrategy::new(StrategyKind::OffsetField, initial, learning, correction, settings.stiffness, learn)
}

/// Two way-points closer than this are the same point, and the line between them has no direction.
const SAME_POINT_METRES: f64 = 1e-9;

fn check_path(path: &[Point]) -> Result<(), StrategyError> {
    if path.len() < 2 {
        return Err(StrategyError::ShortPath { points: path.len() });
    }
    for (index, point) in path.iter().enumerate() {
        if !point.is_finite() {
            return Err(StrategyError::NotFinite { index });
        }
    }
    for (index, (start, end)) in path.iter().zip(path.iter().skip(1)).enumerate() {
        if (end - start).norm() <= SAME_POINT_METRES {
            return Err(StrategyError::NoLength { index });
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests;
