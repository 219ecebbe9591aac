//! Where both grippers are in a trial: waiting behind the shoulders, leading and trailing along an arm, and what is known
//! beforehand of all that. Nothing here changes a trial.

use super::Trial;
use crate::body::{PerSide, Side};
use crate::geometry::{Point, Vector};
use crate::kinematics::waiting_place;

/// How far behind the waiting places the arms take their posture, in metres: on the way there the joints do not lead the
/// grippers along straight lines, and they must not come near the person (ours).
const STAND_BACK_METRES: f64 = 0.12;

/// How much further apart than the waiting places, on each side, in metres, for the same reason (ours).
const STAND_APART_METRES: f64 = 0.08;

impl Trial {
    fn behind(&self, side: Side) -> Point {
        waiting_place(&self.plan.shoulder(side))
    }

    /// Step 1: each gripper behind its shoulder, the trailing one only as far from the leading one as the garment reaches.
    pub(super) fn waiting_places(&self) -> PerSide<Point> {
        let first = self.settings.first_arm;
        let leading = self.behind(first);
        let way = self.behind(first.other()) - leading;
        let trailing = leading + way * share_within(&Vector::zeros(), &way, self.settings.garment_reach_metres);
        PerSide::from_fn(|side| if side == first { leading } else { trailing })
    }

    /// Where both grippers are in turn while the first arm is dressed, as far as it is known before the first pass: for a
    /// start posture that can follow all of it. A gripper that does not move keeps its place.
    #[must_use]
    pub fn first_arm_stages(&self) -> Vec<PerSide<Point>> {
        let first = self.settings.first_arm;
        let waiting = self.waiting_places();
        let mut stages = vec![waiting.map(stand_back), waiting];
        for leading in self.strategy(first).path() {
            let trailing = self.trailing_goal(leading).unwrap_or(*leading);
            stages.push(PerSide::from_fn(|side| if side == first { *leading } else { trailing }));
        }
        stages
    }

    /// Where both grippers are in turn while the second arm is dressed: one stays at the shoulder that it has dressed.
    #[must_use]
    pub fn second_arm_stages(&self) -> Vec<PerSide<Point>> {
        let first = self.settings.first_arm;
        let shoulder = self.strategy(first).path().last().copied().unwrap_or_else(|| self.plan.shoulder(first));
        let place = |leading: &Point| PerSide::from_fn(|side| if side == first { shoulder } else { *leading });
        self.strategy(first.other()).path().iter().map(place).collect()
    }

    /// Steps 2 to 5: the trailing gripper goes from behind the first arm's shoulder towards behind its own, as far as the
    /// leading one has come along the arm. Step 6: it stays at the shoulder that it has dressed.
    pub(super) fn trailing_goal(&self, leading: &Point) -> Option<Point> {
        let first = self.settings.first_arm;
        if self.arm != first {
            return None;
        }
        let reach = self.settings.garment_reach_metres;
        let behind = self.behind(first);
        // Where the arm is longer than the garment reaches, the trailing gripper follows to the hand.
        let offset = (behind - leading).cap_magnitude(reach);
        let way = (self.behind(first.other()) - behind) * self.progress_at(leading);
        Some(leading + offset + way * share_within(&offset, &way, reach))
    }
}

/// A place further from the person, towards the robot and outwards: person and robot look along +x, left is +y.
pub(super) fn stand_back(side: Side, place: &Point) -> Point {
    let outwards = if side == Side::Left { STAND_APART_METRES } else { -STAND_APART_METRES };
    place + Vector::new(-STAND_BACK_METRES, outwards, 0.0)
}

/// The largest share of `way`, at most 1, for which `offset` and that share together are no longer than `reach`; 0 where
/// `offset` alone is too long.
fn share_within(offset: &Vector, way: &Vector, reach: f64) -> f64 {
    let length_squared = way.norm_squared();
    let room = reach * reach - offset.norm_squared();
    if length_squared <= f64::EPSILON || room <= 0.0 {
        return 0.0;
    }
    let along = offset.dot(way);
    let discriminant = (along * along + length_squared * room).sqrt();
    ((discriminant - along) / length_squared).clamp(0.0, 1.0)
}
