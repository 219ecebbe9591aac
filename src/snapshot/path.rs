//! Way-points, paths, the person's pose and the movement space, as the screen sees them. Metres in `base`.

use super::health::Freshness;
use super::history::Shared;
use crate::body::{ArmPose, BodyPose, Joint, PerSide, Side};
use crate::geometry::{Point, Vector};
use serde::{Deserialize, Serialize};

/// One row of the way-point table: what moved, from where to where, and why.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct WaypointRow {
    /// The way-point's number on the path, from 0.
    pub index: u32,
    /// In which iteration it was moved, from 1.
    pub iteration: u32,
    /// Where it was, in metres.
    pub old: Point,
    /// Where it is, in metres; the same as `old` where nothing moved it.
    pub new: Point,
    /// The resistance that moved it, in newtons along x, y, z of the force axes.
    pub force: Vector,
    /// Which reading and which rule of the strategy, in words.
    pub reason: String,
}

/// The paths of one side.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct PathView {
    /// The path that the present iteration began with.
    pub planned: Shared<Vec<Point>>,
    /// Where the gripper has been in this iteration.
    pub travelled: Shared<Vec<Point>>,
    /// The path as it has become.
    pub updated: Shared<Vec<Point>>,
    /// Way-points that moved in this trial, oldest first.
    pub changes: Shared<Vec<WaypointRow>>,
    /// The gripper; `None` where it is not known freshly.
    pub gripper: Option<Point>,
    /// Where the joints were seen while the person's movement was recorded last, thinned out to what a screen can show.
    #[serde(default)]
    pub seen: Shared<Vec<Point>>,
    /// Component ellipses of the movement space.
    pub ellipses: Shared<Vec<EllipseView>>,
}

/// One component of a movement space.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct EllipseView {
    /// Whose joint.
    pub joint: Joint,
    /// The component's weight, from 0 to 1.
    pub weight: f64,
    /// Its mean in metres.
    pub mean: Point,
    /// Its covariance in square metres, rows x, y, z.
    pub covariance: [[f64; 3]; 3],
}

/// The person's pose as it is known.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct BodyView {
    /// The last pose that came in.
    pub pose: Option<BodyPose>,
    /// Whether it still holds.
    pub freshness: Freshness,
    /// Where poses come from, as in "depth camera" or "skeleton tracker".
    pub source: String,
}

/// How well an arm's pose is known.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PoseQuality {
    /// Every joint that is known was measured.
    Seen,
    /// At least one joint was concluded from others.
    Inferred,
    /// Too old, or nothing is known.
    Lost,
}

impl BodyView {
    /// How well the pose of an arm is known at the moment `now`.
    #[must_use]
    pub fn quality(&self, side: Side, now: crate::time::Stamp) -> PoseQuality {
        let arm: Option<&ArmPose> = self.pose.as_ref().map(|pose| pose.arms.get(side));
        let Some(arm) = arm.filter(|_| self.freshness.is_fresh(now)) else { return PoseQuality::Lost };
        let known: Vec<_> = Joint::ALL.iter().filter_map(|joint| arm.joint(*joint)).collect();
        if known.is_empty() {
            PoseQuality::Lost
        } else if known.iter().all(|joint| joint.evidence == crate::body::Evidence::Seen) {
            PoseQuality::Seen
        } else {
            PoseQuality::Inferred
        }
    }

    /// How well both arms are known.
    #[must_use]
    pub fn qualities(&self, now: crate::time::Stamp) -> PerSide<PoseQuality> {
        PerSide::from_fn(|side| self.quality(side, now))
    }
}
