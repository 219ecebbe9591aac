//! Where a trial is, what it orders, and what it reports. Data alone: nothing here decides which comes next.

use crate::body::{PerSide, Side};
use crate::geometry::Point;
use crate::strategy::IterationSummary;
use serde::{Deserialize, Serialize};

/// What the operator's go-ahead starts.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Next {
    /// Another pass along the same arm.
    Iteration,
    /// The second arm.
    SecondArm,
}

/// Where a trial is.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Stage {
    /// Both arms take the posture from which they can follow all that comes, standing back from the person.
    StandBack,
    /// Both grippers go behind the shoulders (step 1).
    Approach,
    /// The dressing gripper goes to the hand, where the path starts (step 2, and the start of step 6).
    Receive,
    /// The garment passes along the arm (steps 3 to 5, and step 6).
    Pass,
    /// The gripper gives way to a resistance.
    Adjust {
        /// Where it gives way to.
        to: Point,
    },
    /// The garment is withdrawn along the path that was travelled.
    Withdraw {
        /// The places still to be passed, the next one last.
        remaining: Vec<Point>,
    },
    /// The operator is to say that it may go on.
    AwaitGoAhead(Next),
    /// Both arms are dressed.
    Done,
}

/// Where the grippers should go now.
#[derive(Clone, Debug, PartialEq)]
pub enum Order {
    /// Hold still: the operator is to act, or the trial is over.
    Wait,
    /// Go there in straight lines, both grippers in step.
    Move {
        /// Goals in `base`; `None` holds that gripper where it is.
        targets: PerSide<Option<Point>>,
        /// The move takes at least this long, in seconds.
        least_seconds: f64,
    },
}

/// What a trial reports.
#[derive(Clone, Debug, PartialEq)]
pub enum TrialEvent {
    /// A pass along an arm began.
    IterationBegan {
        /// Whose arm.
        side: Side,
        /// Which pass, from 1.
        iteration: u32,
    },
    /// A pass along an arm ended.
    IterationEnded {
        /// Whose arm.
        side: Side,
        /// What came of it.
        summary: IterationSummary,
    },
    /// An arm is dressed.
    ArmDressed {
        /// Whose arm.
        side: Side,
    },
    /// Both arms are dressed.
    Completed,
}
