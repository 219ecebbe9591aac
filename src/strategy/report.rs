//! What strategies are told and what they answer, as plain data with the reasons in words.

use super::StrategyKind;
use crate::geometry::{Point, Vector};
use crate::planning::{Method, OptimiserState};
use serde::{Deserialize, Serialize};
use std::fmt;

/// The garment was held up.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Contact {
    /// Where the gripper was, in metres.
    pub position: Point,
    /// What was felt, in newtons (in metres in the synthetic problem), along the gripper-force axes: x of the force
    /// axes is minus x of the robot (thesis section 4.2), so that `position - step(resistance)` gives way.
    pub resistance: Vector,
}

/// Which rule moved a way-point.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Rule {
    /// The way-point gives way to the resistance by an optimiser's step.
    GiveWay {
        /// Whose step.
        method: Method,
    },
    /// The goal moves by the same displacement as the way-point before it.
    GoalFollows,
    /// The goal moves to where the person's limb most probably is.
    GoalChosen {
        /// How many places were tried.
        draws: u32,
        /// The winning logarithm of the joint density of both ends of the limb.
        log_density: f64,
    },
    /// The correction is carried along the path, fading with distance.
    Carried {
        /// The stiffness in newtons a metre that turned the resistance into a displacement.
        stiffness: f64,
    },
    /// A Gaussian process over the path turned all contacts so far into one smooth offset.
    OffsetField {
        /// The stiffness in newtons a metre.
        stiffness: f64,
    },
    /// The comfort path was blended towards the movement space.
    Blended {
        /// The weight of comfort.
        weight: f64,
    },
}

impl fmt::Display for Rule {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::GiveWay { method } => write!(formatter, "gives way to the force ({method} step)"),
            Self::GoalFollows => formatter.write_str("goal follows the way-point before it"),
            Self::GoalChosen { draws, log_density } => {
                write!(formatter, "most probable limb of {draws} draws (log density {log_density:.1})")
            }
            Self::Carried { stiffness } => {
                write!(formatter, "correction carried along the path (stiffness {stiffness:.0} N/m)")
            }
            Self::OffsetField { stiffness } => {
                write!(formatter, "smooth offset through all contacts (stiffness {stiffness:.0} N/m)")
            }
            Self::Blended { weight } => write!(formatter, "comfort blended with reach (weight {weight:.1})"),
        }
    }
}

/// A way-point moved: what, why, and what came of it.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct WaypointChange {
    /// In which iteration, from 1.
    pub iteration: u32,
    /// The way-point's number on the path that is being made, from 0.
    pub index: u32,
    /// Where it was, in metres.
    pub from: Point,
    /// Where it is, in metres.
    pub to: Point,
    /// The reading that moved it, in newtons along the gripper-force axes.
    pub resistance: Vector,
    /// Which rule moved it.
    pub rule: Rule,
    /// How reachable the place was (log density less the best possible, 0 is best); `None` without a movement space.
    pub reachability_before: Option<f64>,
    /// How reachable it is now.
    pub reachability_after: Option<f64>,
    /// What resistance, in newtons, is expected there next time; `None` where the strategy does not know the stiffness.
    pub expected_resistance: Option<f64>,
}

impl fmt::Display for WaypointChange {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let millimetres = (self.to - self.from).norm() * 1e3;
        write!(formatter, "{:.1} N: {}, moved {millimetres:.0} mm", self.resistance.norm(), self.rule)?;
        if let (Some(before), Some(after)) = (self.reachability_before, self.reachability_after) {
            write!(formatter, ", reach {before:.1} to {after:.1}")?;
        }
        if let Some(expected) = self.expected_resistance {
            write!(formatter, ", {expected:.1} N expected")?;
        }
        Ok(())
    }
}

/// Why a contact moved nothing.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Ignored {
    /// The path is fixed: the strategy only counts.
    FixedPath,
    /// The last way-point is pinned, and the contact came there.
    PinnedEnd,
    /// The way to this goal has given way as often as it has steps; what remains is passed as it is.
    BudgetSpent,
    /// The path has as many way-points as it may have.
    Overflow,
    /// A number was not finite.
    NotFinite,
    /// No iteration is under way.
    NotUnderWay,
}

impl fmt::Display for Ignored {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(match self {
            Self::FixedPath => "this strategy's path is fixed: the resistance is counted only",
            Self::PinnedEnd => "the last way-point is pinned",
            Self::BudgetSpent => "the way to this goal has given way as often as it may",
            Self::Overflow => "the path has as many way-points as it may have",
            Self::NotFinite => "the reading is not a finite number",
            Self::NotUnderWay => "no iteration is under way",
        })
    }
}

/// The answer to a contact.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Reaction {
    /// Where the gripper goes first, in metres; from there on to the strategy's goal.
    pub move_to: Point,
    /// What moved, and why.
    pub changes: Vec<WaypointChange>,
    /// Why nothing moved, where nothing did.
    pub ignored: Option<Ignored>,
}

impl Reaction {
    /// The contact moves nothing.
    #[must_use]
    pub const fn ignoring(contact: &Contact, reason: Ignored) -> Self {
        Self { move_to: contact.position, changes: Vec::new(), ignored: Some(reason) }
    }
}

/// How learning ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Finish {
    /// An iteration's energy is at or below its threshold.
    Converged,
    /// As many iterations as allowed have run.
    MaximumReached,
    /// The path has as many way-points as it may have.
    Overflow,
    /// The path is fixed: one pass is all there is.
    Fixed,
}

impl fmt::Display for Finish {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(match self {
            Self::Converged => "converged",
            Self::MaximumReached => "maximum of iterations reached",
            Self::Overflow => "too many way-points",
            Self::Fixed => "fixed path",
        })
    }
}

/// What came of one iteration.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct IterationSummary {
    /// Which one, from 1.
    pub iteration: u32,
    /// The sum of the detected resistances in newtons (metres in the synthetic problem).
    pub energy: f64,
    /// How many contacts there were.
    pub contacts: u32,
    /// How many of them moved nothing, because of the pinned end, the budget or a reading that was no number.
    pub ignored: u32,
    /// The path as it is now: what the next iteration will follow.
    pub path: Vec<Point>,
    /// Comfort: the mean resistance a contact in newtons; `None` where there was no contact.
    pub mean_resistance: Option<f64>,
    /// Reachability: mean over the path of the log density of the best limb, less the best possible; 0 is best. `None`
    /// without a movement space.
    pub reachability: Option<f64>,
    /// The share of the path's length where some limb has both joints inside a 95 % region.
    pub inside_share: Option<f64>,
    /// How learning ended; `None` where another iteration is due.
    pub finished: Option<Finish>,
}

impl IterationSummary {
    /// The summary where no iteration was under way.
    #[must_use]
    pub fn idle(iteration: u32, path: &[Point], finished: Option<Finish>) -> Self {
        Self {
            iteration,
            energy: 0.0,
            contacts: 0,
            ignored: 0,
            path: path.to_vec(),
            mean_resistance: None,
            reachability: None,
            inside_share: None,
            finished,
        }
    }
}

/// What a strategy has learned, to be saved or adopted.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct LearnedPath {
    /// Which strategy learned it.
    pub kind: StrategyKind,
    /// The path in metres.
    pub path: Vec<Point>,
    /// Iterations that have been run.
    pub iteration: u32,
    /// The number of the way-point at the elbow, where the strategy keeps the two limbs apart.
    pub elbow: Option<usize>,
    /// The optimiser's moments, where it has one.
    pub optimiser: Option<OptimiserState>,
    /// The learned stiffness in newtons a metre, where the strategy learns one.
    pub stiffness: Option<f64>,
}
