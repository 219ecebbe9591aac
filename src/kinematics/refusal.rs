//! Why a motion is refused, in words for the operator: what, where, which value, and what would do.

use super::JointVector;
use super::collision::Proximity;
use super::cone::OrientationTolerance;
use super::inverse::InverseError;
use super::limits::Workspace;
use super::model::ArmModel;
use super::timing::TimingError;
use crate::body::Side;
use crate::geometry::{Point, Pose};
use thiserror::Error;

/// Why a motion was not planned. Nothing has moved.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum MotionRefusal {
    /// A number of a target is NaN or infinite.
    #[error("the {side} gripper's target is not a finite number; nothing was planned")]
    NotFinite {
        /// Which gripper.
        side: Side,
    },
    /// A joint is outside its range or not a number.
    #[error("{joint} is at {value:.4} rad, outside its range {:.4} to {:.4} rad; {}", range.0, range.1, back_inside(*value, *range))]
    Joint {
        /// The joint's name on the wire.
        joint: String,
        /// Its position in radians.
        value: f64,
        /// Its range in radians.
        range: (f64, f64),
    },
    /// A gripper would leave the workspace.
    #[error("the {side} gripper would be at {axis} = {value:.3} m, outside its workspace {:.3} to {:.3} m; {:.3} m would do", range.0, range.1, nearest(*value, *range))]
    Workspace {
        /// Which gripper.
        side: Side,
        /// x, y or z.
        axis: char,
        /// The coordinate in metres.
        value: f64,
        /// The range in metres.
        range: (f64, f64),
    },
    /// No joint positions bring the gripper there.
    #[error(
        "the {side} gripper cannot reach {place:.3} with this orientation; {} (metres in base)",
        what_would_do(nearest, *tilt)
    )]
    OutOfReach {
        /// Which gripper.
        side: Side,
        /// Where on the line.
        place: Point,
        /// The nearest place found at this orientation.
        nearest: Point,
        /// By how many radians the gripper's axis would have to be tilted to reach the place, where that would do.
        tilt: Option<f64>,
    },
    /// The place can be reached, but not in a straight line from this posture.
    #[error(
        "the {side} arm cannot follow the line beyond {place:.3} from its present posture; the first {:.0} % of the way would do, \
         or another posture to start from",
        share * 100.0
    )]
    NotTracked {
        /// Which arm.
        side: Side,
        /// Where the clear part of the way ends.
        place: Point,
        /// How far the way is clear, 0 to 1.
        share: f64,
    },
    /// The grippers would come too close to each other or too far apart.
    #[error(
        "the grippers would be {distance:.3} m apart; allowed are {:.3} to {:.3} m: {:.3} m would do",
        range.0, range.1, nearest(*distance, *range)
    )]
    GripperDistance {
        /// Their distance in metres.
        distance: f64,
        /// The range in metres.
        range: (f64, f64),
    },
    /// Two things would touch or come closer than allowed.
    #[error(
        "{} would come within {:.3} m of {}; at least {:.3} m is kept: a way that passes it {:.3} m further off would do",
        .0.first, .0.distance, .0.second, .0.least, .0.least - .0.distance
    )]
    Collision(Proximity),
    /// Another planner refused, did not answer, or answered something else than was asked for.
    #[error("the planner outside valet gave no way: {reason}")]
    Planner {
        /// Its words, or what is wrong with its way.
        reason: String,
    },
    /// No speed profile keeps the limits.
    #[error(transparent)]
    Timing(#[from] TimingError),
}

/// Tilts of the gripper that are tried for a place out of reach, radians: 10° to 60°.
const TILTS: [f64; 6] = [0.175, 0.349, 0.524, 0.698, 0.873, 1.047];

/// The first of [`TILTS`] with which a place is reached; the gripper may be turned about its axis as far.
fn least_tilt(arm: &ArmModel, target: &Pose, seed: &JointVector) -> Option<f64> {
    let reaches =
        |tilt: &f64| arm.inverse_within(target, &OrientationTolerance { cone: *tilt, turn: *tilt }, seed).is_ok();
    // Where not even the widest cone helps, the narrower ones need not be asked: a refusal must not take long.
    TILTS.last().filter(|widest| reaches(widest)).and_then(|_| TILTS.into_iter().find(reaches))
}

/// The end of a range that is nearer to a value outside it.
fn nearest(value: f64, (lower, upper): (f64, f64)) -> f64 {
    value.max(lower).min(upper)
}

/// What to do about a joint outside its range.
fn back_inside(value: f64, range: (f64, f64)) -> String {
    if value.is_nan() {
        return "it is not a number: check /robot/joint_states".into();
    }
    format!("{:.4} rad would do: where the arm stands there, move it back by hand first", nearest(value, range))
}

/// The nearest thing that would do instead.
fn what_would_do(nearest: &Point, tilt: Option<f64>) -> String {
    let place = format!("the nearest it can do is {nearest:.3}");
    tilt.map_or(place.clone(), |tilt| {
        format!("{place}, or there with the gripper tilted by {:.0} degrees", tilt.to_degrees())
    })
}

impl From<Proximity> for MotionRefusal {
    fn from(proximity: Proximity) -> Self {
        Self::Collision(proximity)
    }
}

impl MotionRefusal {
    /// Says where an arm cannot be brought, with the nearest place.
    pub(super) fn unreachable(arm: &ArmModel, target: &Pose, error: &InverseError) -> Self {
        let side = arm.side();
        match error {
            InverseError::NotFinite => Self::NotFinite { side },
            InverseError::NotReached { nearest, .. } => Self::OutOfReach {
                side,
                place: Point::from(target.translation.vector),
                nearest: Point::from(arm.forward(nearest).translation.vector),
                tilt: least_tilt(arm, target, nearest),
            },
        }
    }

    pub(super) fn workspace(side: Side, axis: usize, point: &Point, workspace: &Workspace) -> Self {
        let on_axis = |point: &Point| point.coords.get(axis).copied().unwrap_or(f64::NAN);
        Self::Workspace {
            side,
            axis: ['x', 'y', 'z'].get(axis).copied().unwrap_or('?'),
            value: on_axis(point),
            range: (on_axis(&workspace.lower), on_axis(&workspace.upper)),
        }
    }
}
