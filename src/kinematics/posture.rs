//! Postures from which the dressing is done: the grippers' fixed orientation, and start postures found by looking ahead.
//!
//! A posture that reaches the first point of a way need not be able to follow it: a first solution fails on one way in six.
//! So several are tried, and the whole way is followed from each before one is chosen.

use super::JointVector;
use super::check::room_at;
use super::limits::MotionLimits;
use super::line::{Line, shares};
use super::model::{ArmModel, RobotModel};
use super::refusal::MotionRefusal;
use super::scene::Scene;
use crate::body::{PerSide, Side};
use crate::geometry::{Finite, Point, Pose};
use nalgebra::{Isometry3, Translation3, UnitQuaternion, Vector3};

/// How far the grippers point below the horizontal: of the lines in front of the robot that are possible at all, the largest
/// share is so at 30° (99 %; 95 % at 0°, 91 % at 60°, 58 % at 90°).
const PITCH: f64 = std::f64::consts::FRAC_PI_6;
/// How far both grippers may be turned inwards, about the vertical, in degrees: a wrist that comes from further out passes the
/// person's trunk with more room, as long as the arm still reaches and the grippers stay apart. What leaves the most room depends
/// on the person, so each is tried.
const INWARD_TURNS: [f64; 3] = [5.0, 10.0, 15.0];
/// From a person's shoulder to where the other gripper waits behind it, in `base`, metres: behind and below, because the robot's
/// forearms (radius 0.06 m) lie behind their grippers and have to pass each other when the leading gripper is at the shoulder.
const WAITING_OFFSET: Vector3<f64> = Vector3::new(-0.20, 0.0, -0.28);
/// Postures that are tried for the start of each arm's way.
const CANDIDATES: usize = 16;
/// Where fewer candidates than this can follow an arm's way, more are looked for.
const FEW: usize = 4;
/// Pairs of postures that are compared, those with the most room in their joints first.
const PAIRS: usize = 24;
/// Metres between the arms that are worth as much as a joint in the middle of its range.
const COMFORTABLE: f64 = 0.10;
/// Of a way's knots (2 mm apart) every so-manieth is checked while pairs are compared; a plan checks all of them.
const STRIDE: usize = 4;

/// The grippers' orientation in `base` while a person is dressed: they point forward (x) and 30° down, and their own x axis
/// (the camera's side of the hand) points down. Of four quarter turns about the gripper's own axis this one leaves the most room to
/// the joint limits on dressing paths.
#[must_use]
pub fn dressing_orientation() -> UnitQuaternion<f64> {
    UnitQuaternion::from_axis_angle(&Vector3::y_axis(), std::f64::consts::FRAC_PI_2 + PITCH)
}

/// [`dressing_orientation`] for both grippers, each turned inwards about the vertical by so many radians.
fn turned_inwards(angle: f64) -> PerSide<UnitQuaternion<f64>> {
    let turn = PerSide { left: -angle, right: angle };
    turn.map(|_, angle| UnitQuaternion::from_axis_angle(&Vector3::z_axis(), *angle) * dressing_orientation())
}

/// Where the gripper that does not lead waits, for a person's shoulder in `base`, metres.
#[must_use]
pub fn waiting_place(shoulder: &Point) -> Point {
    shoulder + WAITING_OFFSET
}

/// A part of the arms' way with what they keep clear of on it.
#[derive(Clone, Copy, Debug)]
pub struct Leg<'a> {
    /// What surrounds the arms on this part of the way.
    pub scene: &'a Scene,
    /// Where the grippers go in turn (`base`, metres), from where the part before has left them.
    pub stages: &'a [PerSide<Point>],
}

/// Start postures (radians) of both arms from which they can go through all stages: straight lines in step from one pair of
/// points (`base`, metres) to the next, each gripper at one orientation. A gripper whose point stays the same rests.
///
/// # Errors
/// See [`start_postures_for`].
pub fn start_postures(
    model: &RobotModel,
    scene: &Scene,
    stages: &[PerSide<Point>],
    orientations: &PerSide<UnitQuaternion<f64>>,
    limits: &MotionLimits,
) -> Result<PerSide<JointVector>, MotionRefusal> {
    start_postures_for(model, &[Leg { scene, stages }], orientations, limits)
}

/// [`start_postures`] for a way whose surroundings change: the arm of the person that is dressed next is no obstacle any more.
///
/// Each arm's candidates are followed through all legs and ranked by the room they leave to the joint limits and to the joint
/// speeds; of the best pairs that keep clear of everything and keep the grippers' distance throughout, the one is taken that leaves
/// the most room of either kind.
///
/// # Errors
/// A [`MotionRefusal`]: of a candidate's way where no posture of an arm can follow it, or of the best pair where none is clear.
pub fn start_postures_for(
    model: &RobotModel,
    legs: &[Leg],
    orientations: &PerSide<UnitQuaternion<f64>>,
    limits: &MotionLimits,
) -> Result<PerSide<JointVector>, MotionRefusal> {
    found(roomiest_start(model, legs, orientations, limits, f64::NEG_INFINITY))
}

/// The joints of a start; a search that had nothing to beat and found nothing had no places to go to.
fn found(start: Result<Option<Start>, MotionRefusal>) -> Result<PerSide<JointVector>, MotionRefusal> {
    start?.map(|start| start.joints).ok_or(MotionRefusal::NotFinite { side: Side::Left })
}

/// [`start_postures_for`] with the grippers in the orientation for dressing, turned inwards as far as leaves the most room.
///
/// # Errors
/// As [`start_postures_for`], with the grippers not turned.
pub fn dressing_postures(
    model: &RobotModel,
    legs: &[Leg],
    limits: &MotionLimits,
) -> Result<PerSide<JointVector>, MotionRefusal> {
    let start =
        |degrees: f64, to_beat| roomiest_start(model, legs, &turned_inwards(degrees.to_radians()), limits, to_beat);
    let straight = start(0.0, f64::NEG_INFINITY);
    let mut best = straight.as_ref().ok().copied().flatten();
    for degrees in INWARD_TURNS {
        let to_beat = best.map_or(f64::NEG_INFINITY, |best| best.room);
        best = start(degrees, to_beat).ok().flatten().or(best);
    }
    found(if best.is_some() { Ok(best) } else { straight })
}

/// Start postures of both arms and the room that they leave.
#[derive(Clone, Copy)]
struct Start {
    joints: PerSide<JointVector>,
    /// The least along the way of the room in the joints and of the room between the arms and what surrounds them.
    room: f64,
}

/// The roomiest start of all that leave more room than `to_beat`; `None` where they leave less.
fn roomiest_start(
    model: &RobotModel,
    legs: &[Leg],
    orientations: &PerSide<UnitQuaternion<f64>>,
    limits: &MotionLimits,
    to_beat: f64,
) -> Result<Option<Start>, MotionRefusal> {
    let stages: Vec<_> = legs.iter().flat_map(|leg| leg.stages.iter().copied()).collect();
    let ways = PerSide::from_fn(|side| way(&stages, side, orientations.get(side)));
    let spans: Vec<f64> =
        ways.left.lines().zip(ways.right.lines()).map(|(left, right)| left.spans().max(right.spans())).collect();
    let ranked = |side: Side| ranked_candidates(model.arm(side), ways.get(side), &spans, limits, to_beat);
    let candidates = PerSide { left: ranked(Side::Left)?, right: ranked(Side::Right)? };
    let mut pairs: Vec<_> = candidates
        .left
        .iter()
        .flat_map(|left| candidates.right.iter().map(move |right| PerSide { left, right }))
        .collect();
    pairs.sort_by(|one, other| room_of(other).total_cmp(&room_of(one)));
    clearest_pair(model, &scenes_of_knots(legs, &spans), &pairs, limits, to_beat)
}

/// Of pairs with falling room in their joints, the one with the most room of either kind that leaves more than `to_beat`.
fn clearest_pair(
    model: &RobotModel,
    scenes: &[&Scene],
    pairs: &[Pair],
    limits: &MotionLimits,
    to_beat: f64,
) -> Result<Option<Start>, MotionRefusal> {
    let mut best: Option<Start> = None;
    let (mut clear, mut refusal) = (0, None);
    for pair in pairs {
        let to_beat = best.map_or(to_beat, |best| best.room);
        // No later pair can be better than this.
        if clear >= PAIRS || room_of(pair) < to_beat {
            break;
        }
        match clearance(model, scenes, pair, limits, to_beat * COMFORTABLE) {
            Ok(Some(metres)) => {
                clear += 1;
                let joints = pair.map(|_, candidate| candidate.start);
                best = Some(Start { joints, room: room_of(pair).min(metres / COMFORTABLE) });
            }
            Ok(None) => {}
            Err(reason) => refusal = refusal.or(Some(reason)),
        }
    }
    match (best, refusal) {
        (None, Some(reason)) => Err(reason),
        (best, _) => Ok(best),
    }
}

/// The scene of every knot of the way: a line belongs to the leg that it leads into.
fn scenes_of_knots<'a>(legs: &[Leg<'a>], spans: &[f64]) -> Vec<&'a Scene> {
    let mut into = legs.iter().flat_map(|leg| leg.stages.iter().map(|_| leg.scene));
    let mut scenes: Vec<&Scene> = into.next().into_iter().collect();
    for (scene, spans) in into.zip(spans) {
        scenes.extend(std::iter::repeat_n(scene, shares(*spans).count() - 1));
    }
    scenes
}

/// One gripper's poses at all stages.
struct Way(Vec<Pose>);

fn way(stages: &[PerSide<Point>], side: Side, orientation: &UnitQuaternion<f64>) -> Way {
    let pose = |stage: &PerSide<Point>| Isometry3::from_parts(Translation3::from(stage.get(side).coords), *orientation);
    Way(stages.iter().map(pose).collect())
}

impl Way {
    fn lines(&self) -> impl Iterator<Item = Line> {
        self.0.iter().zip(self.0.iter().skip(1)).map(|(from, to)| Line::new(*from, *to))
    }
}

/// A posture and the way that it can follow.
struct Candidate {
    start: JointVector,
    knots: Vec<JointVector>,
    /// Least room to a joint limit or joint speed along the way, as a share.
    room: f64,
}

/// A candidate for each arm.
type Pair<'a> = PerSide<&'a Candidate>;

fn room_of(pair: &Pair) -> f64 {
    pair.left.room.min(pair.right.room)
}

/// The least distance in metres that a pair keeps beyond what it has to keep; `None` as soon as it is less than `at_least`.
fn clearance(
    model: &RobotModel,
    scenes: &[&Scene],
    pair: &Pair,
    limits: &MotionLimits,
    at_least: f64,
) -> Result<Option<f64>, MotionRefusal> {
    let at = |index: usize| pair.map(|_, candidate| candidate.knots.get(index).copied().unwrap_or(candidate.start));
    let last = scenes.len().saturating_sub(1);
    let mut least = f64::INFINITY;
    for (index, scene) in scenes.iter().enumerate().filter(|(index, _)| index % STRIDE == 0 || *index == last) {
        least = room_at(model, scene, &at(index), limits, least)?;
        if least < at_least {
            return Ok(None);
        }
    }
    Ok(Some(least))
}

fn ranked_candidates(
    arm: &ArmModel,
    way: &Way,
    spans: &[f64],
    limits: &MotionLimits,
    to_beat: f64,
) -> Result<Vec<Candidate>, MotionRefusal> {
    let first = way.0.first().filter(|_| way.0.iter().all(Finite::is_finite));
    let first = first.ok_or(MotionRefusal::NotFinite { side: arm.side() })?;
    let starts = arm.solutions(first, CANDIDATES).map_err(|error| MotionRefusal::unreachable(arm, first, &error))?;
    let (mut stuck, mut candidates, mut narrow) = (None, Vec::new(), 0);
    let mut follow = |starts: Vec<JointVector>| {
        for start in starts {
            match follow_way(arm, way, spans, &start, limits, to_beat) {
                Ok(Some(candidate)) => candidates.push(candidate),
                Ok(None) => narrow += 1,
                Err(next) => stuck = furthest(stuck.take(), next),
            }
        }
        candidates.len() + narrow
    };
    if follow(starts) < FEW {
        follow(postures_from_further_on(arm, way, spans));
    }
    match stuck {
        Some(Stuck { reason, .. }) if candidates.is_empty() && narrow == 0 => Err(reason),
        _ => Ok(candidates),
    }
}

/// Start postures that are found by going back from further on: a place that few postures can pass may lie on the way.
fn postures_from_further_on(arm: &ArmModel, way: &Way, spans: &[f64]) -> Vec<JointVector> {
    let lines: Vec<_> = way.lines().zip(spans.iter().copied()).collect();
    let mut found = Vec::new();
    for (index, (line, _)) in lines.iter().enumerate().filter(|(_, (line, _))| !line.is_still()) {
        for share in [0.5, 1.0] {
            let before = lines.iter().take(index).copied();
            let back: Vec<_> = before.chain([(line.until(share), line.until(share).spans())]).rev().collect();
            for there in arm.solutions(&line.at(share), CANDIDATES).unwrap_or_default() {
                let here = back.iter().try_fold(there, |joints, (line, spans)| {
                    let knots = arm.follow_line(&line.reversed(), &joints, *spans).ok()?;
                    knots.last().copied()
                });
                found.extend(here);
            }
        }
    }
    found
}

/// Where a candidate could not go on.
struct Stuck {
    /// Knots that it had followed before that line.
    knots: usize,
    reason: MotionRefusal,
}

/// The refusal that says most of a way that nobody can follow: the one of whoever came furthest, and of those one that no posture mends.
fn furthest(before: Option<Stuck>, next: Stuck) -> Option<Stuck> {
    let rank = |stuck: &Stuck| (stuck.knots, matches!(stuck.reason, MotionRefusal::OutOfReach { .. }));
    before.filter(|before| rank(before) >= rank(&next)).or(Some(next))
}

/// The way from a start; `None` as soon as it leaves no more room than `to_beat`.
fn follow_way(
    arm: &ArmModel,
    way: &Way,
    spans: &[f64],
    start: &JointVector,
    limits: &MotionLimits,
    to_beat: f64,
) -> Result<Option<Candidate>, Stuck> {
    let mut knots = vec![*start];
    let mut room = arm.limits().margin(start);
    for (line, spans) in way.lines().zip(spans) {
        if room <= to_beat {
            return Ok(None);
        }
        let here = knots.last().copied().unwrap_or(*start);
        if line.is_still() {
            knots.extend(std::iter::repeat_n(here, shares(*spans).count() - 1));
            continue;
        }
        let next = arm.follow_line(&line, &here, *spans).map_err(|reason| Stuck { knots: knots.len(), reason })?;
        let pace = limits.speed * spans / line.length.max(f64::EPSILON);
        for (before, after) in next.iter().zip(next.iter().skip(1)) {
            let rate = ((after - before) * pace).abs().component_div(&limits.joint_speed).max();
            room = room.min(arm.limits().margin(after)).min(1.0 - rate);
        }
        knots.extend(next.into_iter().skip(1));
    }
    Ok((room > to_beat).then_some(Candidate { start: *start, knots, room }))
}

#[cfg(test)]
mod tests;
