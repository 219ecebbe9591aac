//! The search for start postures: candidates of each arm are followed along the whole way, and their pairs compared.
//!
//! A posture that reaches the first point of a way need not be able to follow it: a first solution fails on one way in six.
//! So several are tried, and the whole way is followed from each before one is chosen. Candidates are compared at knots far
//! apart, and what is chosen is followed and checked again at those of a plan: nothing is answered that was only looked at coarsely.

use super::Leg;
use crate::body::{PerSide, Side};
use crate::geometry::{Finite, Point, Pose};
use crate::kinematics::JointVector;
use crate::kinematics::check::room_at;
use crate::kinematics::limits::MotionLimits;
use crate::kinematics::line::{Line, shares};
use crate::kinematics::model::{ArmModel, RobotModel};
use crate::kinematics::refusal::MotionRefusal;
use crate::kinematics::scene::Scene;
use nalgebra::{Isometry3, Translation3, UnitQuaternion};

/// Postures that are tried for the start of each arm's way.
const CANDIDATES: usize = 16;
/// Where fewer candidates than this can follow an arm's way, more are looked for.
const FEW: usize = 4;
/// Pairs of postures that are compared, those with the most room in their joints first.
const PAIRS: usize = 24;
/// Metres between the arms that are worth as much as a joint in the middle of its range.
const COMFORTABLE: f64 = 0.10;
/// Candidates are compared at knots so many times further apart than a plan's (2 mm): on 72 ways of twelve people this chose the
/// same postures as a plan's knots did.
const COARSENESS: f64 = 8.0;

/// Start postures of both arms and the room that they leave.
#[derive(Clone, Copy)]
pub(super) struct Start {
    pub(super) joints: PerSide<JointVector>,
    /// The least along the way of the room in the joints and of the room between the arms and what surrounds them.
    pub(super) room: f64,
}

/// The roomiest start of all that leave more room than `to_beat`; `None` where they leave less.
pub(super) fn roomiest_start(
    model: &RobotModel,
    legs: &[Leg],
    orientations: &PerSide<UnitQuaternion<f64>>,
    limits: &MotionLimits,
    to_beat: f64,
) -> Result<Option<Start>, MotionRefusal> {
    let course = Course::new(legs, orientations, COARSENESS);
    let ranked = |side: Side| ranked_candidates(model.arm(side), &course, limits, to_beat);
    let candidates = PerSide { left: ranked(Side::Left)?, right: ranked(Side::Right)? };
    let mut pairs: Vec<_> = candidates
        .left
        .iter()
        .flat_map(|left| candidates.right.iter().map(move |right| PerSide { left, right }))
        .collect();
    pairs.sort_by(|one, other| room_of(other).total_cmp(&room_of(one)));
    let planned = Course::new(legs, orientations, 1.0);
    let mut refusal = None;
    while let Some(best) = clearest_pair(model, &course, &pairs, limits, to_beat)? {
        let Err(reason) = confirm(model, &planned, &best.joints, limits) else { return Ok(Some(best)) };
        refusal.get_or_insert(reason);
        pairs.retain(|pair| pair.map(|_, candidate| candidate.start) != best.joints);
    }
    refusal.map_or(Ok(None), Err)
}

/// Goes the whole way again, at a plan's knots, and returns the room that is left there.
pub(super) fn confirm(
    model: &RobotModel,
    planned: &Course,
    start: &PerSide<JointVector>,
    limits: &MotionLimits,
) -> Result<f64, MotionRefusal> {
    let follow = |side: Side| {
        let followed = follow_way(model.arm(side), planned, start.get(side), limits, f64::NEG_INFINITY);
        followed.map_err(|stuck| stuck.reason)
    };
    let (Some(left), Some(right)) = (follow(Side::Left)?, follow(Side::Right)?) else { return Ok(f64::NEG_INFINITY) };
    let pair = PerSide { left: &left, right: &right };
    let metres = clearance(model, planned, &pair, limits, 0.0)?.unwrap_or(0.0);
    Ok(room_of(&pair).min(metres / COMFORTABLE))
}

/// Of pairs with falling room in their joints, the one with the most room of either kind that leaves more than `to_beat`.
fn clearest_pair(
    model: &RobotModel,
    course: &Course,
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
        match clearance(model, course, pair, limits, to_beat * COMFORTABLE) {
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

/// The way of both arms, cut into knots.
pub(super) struct Course<'a> {
    /// Each gripper's poses at all stages.
    poses: PerSide<Vec<Pose>>,
    /// Into how many parts each line from stage to stage is cut.
    spans: Vec<f64>,
    /// The scene of every knot: a line belongs to the leg that it leads into.
    scenes: Vec<&'a Scene>,
}

impl<'a> Course<'a> {
    /// Knots are `coarseness` times as far apart as a plan's.
    pub(super) fn new(legs: &[Leg<'a>], orientations: &PerSide<UnitQuaternion<f64>>, coarseness: f64) -> Self {
        let stages = || legs.iter().flat_map(|leg| leg.stages.iter());
        let poses = orientations.map(|side, orientation| {
            let place = |stage: &PerSide<Point>| Translation3::from(stage.get(side).coords);
            stages().map(|stage| Isometry3::from_parts(place(stage), *orientation)).collect::<Vec<_>>()
        });
        let longer = lines(&poses.left).zip(lines(&poses.right)).map(|(left, right)| left.spans().max(right.spans()));
        let spans: Vec<f64> = longer.map(|spans| (spans / coarseness).ceil().max(2.0)).collect();
        let mut into = legs.iter().flat_map(|leg| leg.stages.iter().map(|_| leg.scene));
        let mut scenes: Vec<&Scene> = into.next().into_iter().collect();
        for (scene, spans) in into.zip(&spans) {
            scenes.extend(std::iter::repeat_n(scene, shares(*spans).count() - 1));
        }
        Self { poses, spans, scenes }
    }

    /// One gripper's lines, each with its number of parts.
    fn lines(&self, side: Side) -> impl Iterator<Item = (Line, f64)> {
        lines(self.poses.get(side)).zip(self.spans.iter().copied())
    }
}

fn lines(poses: &[Pose]) -> impl Iterator<Item = Line> {
    poses.iter().zip(poses.iter().skip(1)).map(|(from, to)| Line::new(*from, *to))
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
    course: &Course,
    pair: &Pair,
    limits: &MotionLimits,
    at_least: f64,
) -> Result<Option<f64>, MotionRefusal> {
    let at = |index: usize| pair.map(|_, candidate| candidate.knots.get(index).copied().unwrap_or(candidate.start));
    let mut least = f64::INFINITY;
    for (index, scene) in course.scenes.iter().enumerate() {
        least = room_at(model, scene, &at(index), limits, least)?;
        if least < at_least {
            return Ok(None);
        }
    }
    Ok(Some(least))
}

fn ranked_candidates(
    arm: &ArmModel,
    course: &Course,
    limits: &MotionLimits,
    to_beat: f64,
) -> Result<Vec<Candidate>, MotionRefusal> {
    let poses = course.poses.get(arm.side());
    let first = poses.first().filter(|_| poses.iter().all(Finite::is_finite));
    let first = first.ok_or(MotionRefusal::NotFinite { side: arm.side() })?;
    let starts = arm.solutions(first, CANDIDATES).map_err(|error| MotionRefusal::unreachable(arm, first, &error))?;
    let (mut stuck, mut candidates, mut narrow) = (None, Vec::new(), 0);
    let mut follow = |starts: Vec<JointVector>| {
        for start in starts {
            match follow_way(arm, course, &start, limits, to_beat) {
                Ok(Some(candidate)) => candidates.push(candidate),
                Ok(None) => narrow += 1,
                Err(next) => stuck = furthest(stuck.take(), next),
            }
        }
        candidates.len() + narrow
    };
    if follow(starts) < FEW {
        follow(postures_from_further_on(arm, course));
    }
    match stuck {
        Some(Stuck { reason, .. }) if candidates.is_empty() && narrow == 0 => Err(reason),
        _ => Ok(candidates),
    }
}

/// Start postures that are found by going back from further on: a place that few postures can pass may lie on the way.
fn postures_from_further_on(arm: &ArmModel, course: &Course) -> Vec<JointVector> {
    let lines: Vec<_> = course.lines(arm.side()).collect();
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
    course: &Course,
    start: &JointVector,
    limits: &MotionLimits,
    to_beat: f64,
) -> Result<Option<Candidate>, Stuck> {
    let mut knots = vec![*start];
    let mut room = arm.limits().margin(start);
    for (line, spans) in course.lines(arm.side()) {
        if room <= to_beat {
            return Ok(None);
        }
        let here = knots.last().copied().unwrap_or(*start);
        if line.is_still() {
            knots.extend(std::iter::repeat_n(here, shares(spans).count() - 1));
            continue;
        }
        let next = arm.follow_line(&line, &here, spans).map_err(|reason| Stuck { knots: knots.len(), reason })?;
        let pace = limits.speed * spans / line.length.max(f64::EPSILON);
        for (before, after) in next.iter().zip(next.iter().skip(1)) {
            let rate = ((after - before) * pace).abs().component_div(&limits.joint_speed).max();
            room = room.min(arm.limits().margin(after)).min(1.0 - rate);
        }
        knots.extend(next.into_iter().skip(1));
    }
    Ok((room > to_beat).then_some(Candidate { start: *start, knots, room }))
}
