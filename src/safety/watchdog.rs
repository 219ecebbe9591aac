//! Watches every input: how old, how plausible, and whether somebody else acts on the robot.
//!
//! Each watch has a stated limit and a stated reaction. What reached a hold stays until the operator acknowledges it,
//! even where the input has come back by itself: nothing goes on unasked.

mod force;
mod settings;
mod watch;
mod words;

pub use settings::WatchSettings;
pub use watch::Watch;

use super::{Reaction, Verdict};
use crate::assembly::RobotState;
use crate::body::{PerSide, Side};
use crate::geometry::Vector;
use crate::sensing::{Freshness, FreshnessSettings};
use crate::time::Stamp;
use force::ForcePlausibility;
use std::collections::{BTreeMap, BTreeSet};
use std::time::Duration;
use words::{MASTER_LOST, collision_words, cuff_words, foreign_words, late};

/// An edge of `enabled` within this span of valet's own request is valet's own: the maker's tool waits 5 s for a disable.
const OWN_EDGE_WITHIN: Duration = Duration::from_secs(5);

/// Watches all inputs of a trial.
///
/// ```
/// use valet::geometry::Vector;
/// use valet::body::Side;
/// use valet::safety::{Reaction, Watch, WatchSettings, Watchdogs};
/// use valet::time::Stamp;
///
/// let at = |milliseconds: u64| Stamp::from_nanoseconds(milliseconds * 1_000_000);
/// let mut watchdogs = Watchdogs::new(WatchSettings::default());
/// watchdogs.require_only(&[Watch::Force(Side::Right)]);
/// watchdogs.force(at(0), Side::Right, at(0), Vector::zeros());
/// assert_eq!(watchdogs.judge(at(60)).reaction, Reaction::Clear);
/// assert_eq!(watchdogs.judge(at(61)).reaction, Reaction::Hold);
/// // It has come back, but only the operator ends the hold.
/// watchdogs.force(at(70), Side::Right, at(70), Vector::zeros());
/// assert_eq!(watchdogs.judge(at(71)).reaction, Reaction::Hold);
/// watchdogs.acknowledge();
/// assert_eq!(watchdogs.judge(at(72)).reaction, Reaction::Clear);
/// ```
#[derive(Clone, Debug)]
pub struct Watchdogs {
    settings: WatchSettings,
    required: BTreeMap<Watch, bool>,
    force: PerSide<Freshness>,
    plausibility: PerSide<ForcePlausibility>,
    joints: PerSide<[Option<Stamp>; 7]>,
    bad_joints: PerSide<bool>,
    joint_stream: PerSide<Freshness>,
    robot: Freshness,
    enabled: Option<bool>,
    own_switching: Option<Stamp>,
    pose: Freshness,
    planner_asked: Option<Stamp>,
    console: Freshness,
    last_tick: Option<Stamp>,
    collision: PerSide<bool>,
    cuff: PerSide<bool>,
    /// Topic and node of each publisher that ought not to be there.
    foreign: BTreeSet<(String, String)>,
    master_is_lost: bool,
    latched: BTreeMap<Watch, String>,
}

impl Watchdogs {
    /// Watchdogs that have seen nothing. Forces, joints, robot state and pose are required from the start; the console
    /// from its first heartbeat on, the planner while it is asked.
    #[must_use]
    pub fn new(settings: WatchSettings) -> Self {
        let stream = |least, most, deadline| Freshness::new(FreshnessSettings::new(least, most, deadline));
        let force = stream(80.0, 120.0, settings.force);
        let joints = stream(40.0, 250.0, settings.joints);
        Self {
            required: BTreeMap::new(),
            force: PerSide::from_fn(|_| force.clone()),
            plausibility: PerSide::from_fn(|_| ForcePlausibility::default()),
            joints: PerSide::default(),
            bad_joints: PerSide::default(),
            joint_stream: PerSide::from_fn(|_| joints.clone()),
            robot: stream(40.0, 250.0, settings.robot_state),
            enabled: None,
            own_switching: None,
            pose: stream(5.0, 60.0, settings.pose),
            planner_asked: None,
            console: stream(0.5, 100.0, settings.console),
            last_tick: None,
            collision: PerSide::default(),
            cuff: PerSide::default(),
            foreign: BTreeSet::new(),
            master_is_lost: false,
            latched: BTreeMap::new(),
            settings,
        }
    }

    /// Whether a watch counts. A watch that is not required neither holds nor slows.
    pub fn require(&mut self, watch: Watch, required: bool) {
        self.required.insert(watch, required);
    }

    /// Requires these streams and none of the others: for parts of valet that use only some of them.
    pub fn require_only(&mut self, watches: &[Watch]) {
        let streams = Side::BOTH.into_iter().flat_map(|side| [Watch::Force(side), Watch::Joints(side)]);
        for watch in streams.chain([Watch::RobotState, Watch::Pose]) {
            self.require(watch, watches.contains(&watch));
        }
    }

    fn is_required(&self, watch: Watch) -> bool {
        self.required.get(&watch).copied().unwrap_or(true)
    }

    /// A force arrived, in newtons as the robot gives it, with its header stamp.
    pub fn force(&mut self, now: Stamp, side: Side, header: Stamp, force: Vector) {
        self.force.get_mut(side).observe(now, Some(header));
        self.plausibility.get_mut(side).observe(force, &self.settings);
    }

    /// Joint positions arrived, in radians in the robot's order; `None` where the message did not name the joint.
    pub fn joints(&mut self, now: Stamp, side: Side, header: Stamp, positions: &[Option<f64>; 7]) {
        if positions.iter().all(Option::is_none) {
            return;
        }
        self.joint_stream.get_mut(side).observe(now, Some(header));
        *self.bad_joints.get_mut(side) = positions.iter().flatten().any(|position| !position.is_finite());
        for (seen, position) in self.joints.get_mut(side).iter_mut().zip(positions) {
            if position.is_some() {
                *seen = Some(now);
            }
        }
    }

    /// The robot's state arrived.
    pub fn robot(&mut self, now: Stamp, state: &RobotState) {
        self.robot.observe(now, None);
        let own = self.own_switching.is_some_and(|asked| now.since(asked) <= OWN_EDGE_WITHIN);
        match (self.enabled.replace(state.enabled), state.enabled) {
            (Some(false), true) if !own => {
                self.latch(Watch::Enable, "somebody else switched the robot's motors on".into());
            }
            (Some(true), false) if !own && !state.stopped => {
                self.latch(Watch::Enable, "somebody else switched the robot's motors off".into());
            }
            _ => {}
        }
    }

    /// Valet itself asks the robot's switch for something: the edge of `enabled` that follows is its own.
    pub const fn own_switching(&mut self, now: Stamp) {
        self.own_switching = Some(now);
    }

    /// The person's pose arrived, taken at `header`.
    pub fn pose(&mut self, now: Stamp, header: Stamp) {
        self.pose.observe(now, Some(header));
    }

    /// The planner was asked.
    pub const fn planner_asked(&mut self, now: Stamp) {
        self.planner_asked = Some(now);
    }

    /// The planner answered.
    pub const fn planner_answered(&mut self) {
        self.planner_asked = None;
    }

    /// The console showed that it lives. From its first heartbeat on it is watched.
    pub fn console(&mut self, now: Stamp) {
        self.console.observe(now, None);
    }

    /// The robot's own contact detection. What to hold with at its rising edge: the robot would go on by itself after two
    /// seconds, so the edge is latched.
    #[must_use]
    pub fn collision(&mut self, side: Side, active: bool) -> Option<String> {
        let before = std::mem::replace(self.collision.get_mut(side), active);
        (active && !before).then(|| self.latched_now(Watch::Collision(side), collision_words(side)))
    }

    /// The cuff at a wrist. What to hold with where it was squeezed just now: from then on the arm follows a hand and no command.
    #[must_use]
    pub fn cuff(&mut self, side: Side, squeezed: bool) -> Option<String> {
        let before = std::mem::replace(self.cuff.get_mut(side), squeezed);
        (squeezed && !before).then(|| self.latched_now(Watch::Cuff(side), cuff_words(side)))
    }

    /// Another node publishes where only valet may.
    pub fn foreign_publisher(&mut self, topic: &str, node: &str) {
        self.foreign.insert((topic.to_owned(), node.to_owned()));
        self.latch(Watch::ForeignPublisher, foreign_words(topic, node));
    }

    /// A node that ought not to publish a topic does so no more. What it held stays held until the operator acts.
    pub fn foreign_publisher_gone(&mut self, topic: &str, node: &str) {
        self.foreign.remove(&(topic.to_owned(), node.to_owned()));
    }

    /// The ROS master answers, or does not.
    pub const fn master(&mut self, answers: bool) {
        self.master_is_lost = !answers;
    }

    /// The supervisor's beat.
    pub fn tick(&mut self, now: Stamp) {
        let Some(last) = self.last_tick.replace(now) else { return };
        match now.checked_since(last) {
            None => {
                self.forget_what_lies_ahead(now);
                self.latch(Watch::Tick, "the clock went back: check the time service, then continue".into());
            }
            Some(gap) if gap > self.settings.clock_jump => {
                self.latch(
                    Watch::Tick,
                    format!("the clock went {:.1} s ahead at once: check the time service", gap.as_secs_f64()),
                );
            }
            Some(gap) if gap > self.settings.tick => {
                self.latch(
                    Watch::Tick,
                    format!("valet's own beat was {} ms late: this computer is overloaded", gap.as_millis()),
                );
            }
            Some(_) => {}
        }
    }

    /// What came in before the clock went back is old, and stays so when the clock comes to those moments again. Not so the
    /// console's beats: who was there once is missed.
    fn forget_what_lies_ahead(&mut self, now: Stamp) {
        for side in Side::BOTH {
            self.force.get_mut(side).forget_what_lies_ahead(now);
            self.joint_stream.get_mut(side).forget_what_lies_ahead(now);
            for joint in self.joints.get_mut(side) {
                *joint = joint.filter(|seen| *seen <= now);
            }
        }
        self.robot.forget_what_lies_ahead(now);
        self.pose.forget_what_lies_ahead(now);
    }

    /// The beat pauses on purpose, as while a motion is planned with both arms at rest: the next one is not late.
    pub const fn pause_beat(&mut self) {
        self.last_tick = None;
    }

    fn latch(&mut self, watch: Watch, cause: String) {
        self.latched.entry(watch).or_insert(cause);
    }

    /// Latches a cause and hands it back.
    fn latched_now(&mut self, watch: Watch, cause: String) -> String {
        self.latch(watch, cause.clone());
        cause
    }

    /// Judges all inputs now. What asks for a hold is latched.
    pub fn judge(&mut self, now: Stamp) -> Verdict {
        let present = self.present(now);
        for (watch, verdict) in &present {
            if verdict.reaction >= Reaction::Hold {
                self.latch(*watch, verdict.cause.clone());
            }
        }
        // A clock that jumped is why everything else is late: it is told first.
        let clock = self.latched.get(&Watch::Tick);
        let latched =
            clock.into_iter().chain(self.latched.values()).map(|cause| Verdict::new(Reaction::Hold, cause.clone()));
        Verdict::strictest(latched.chain(present.into_iter().map(|(_, verdict)| verdict)))
    }

    /// What stands now, latched things left out.
    fn present(&self, now: Stamp) -> Vec<(Watch, Verdict)> {
        let mut found = Vec::new();
        for side in Side::BOTH {
            found.push((Watch::Force(side), self.judge_force(now, side)));
            found.push((Watch::Joints(side), self.judge_joints(now, side)));
            if *self.collision.get(side) {
                found.push((Watch::Collision(side), Verdict::new(Reaction::Hold, collision_words(side))));
            }
            if *self.cuff.get(side) {
                found.push((Watch::Cuff(side), Verdict::new(Reaction::Hold, cuff_words(side))));
            }
        }
        if let Some((topic, node)) = self.foreign.first() {
            found.push((Watch::ForeignPublisher, Verdict::new(Reaction::Hold, foreign_words(topic, node))));
        }
        if self.master_is_lost {
            found.push((Watch::Master, Verdict::new(Reaction::Hold, MASTER_LOST)));
        }
        found.push((Watch::RobotState, late("the robot's state", &self.robot, now)));
        found.push((Watch::Pose, self.judge_pose(now)));
        if self.console.last().is_some() {
            found.push((Watch::Console, late("the console's heartbeat", &self.console, now)));
        }
        if self.planner_asked.is_some_and(|asked| now.since(asked) > self.settings.planner) {
            let cause = format!("the planner has not answered within {} ms", self.settings.planner.as_millis());
            found.push((Watch::Planner, Verdict::new(Reaction::Hold, cause)));
        }
        found.retain(|(watch, verdict)| verdict.reaction > Reaction::Clear && self.is_required(*watch));
        found
    }

    fn judge_force(&self, now: Stamp, side: Side) -> Verdict {
        let name = format!("the {side} force");
        let implausible = self.plausibility.get(side).fault(&self.settings);
        implausible.map_or_else(
            || late(&name, self.force.get(side), now),
            |fault| Verdict::new(Reaction::Hold, format!("{name} {fault}")),
        )
    }

    fn judge_joints(&self, now: Stamp, side: Side) -> Verdict {
        let name = format!("the {side} arm's joints");
        if *self.bad_joints.get(side) {
            return Verdict::new(Reaction::Hold, format!("{name} hold a number that is not finite"));
        }
        let deadline = self.settings.joints;
        let missing =
            |seen: &Option<Stamp>| seen.is_some_and(|seen| now.checked_since(seen).is_none_or(|age| age > deadline));
        let stream = late(&name, self.joint_stream.get(side), now);
        if stream.reaction > Reaction::Clear {
            return stream;
        }
        let seen = self.joints.get(side);
        if seen.iter().any(|seen| seen.is_none() || missing(seen)) {
            return Verdict::new(Reaction::Hold, format!("{name} are not all in the robot's messages"));
        }
        Verdict::clear()
    }

    fn judge_pose(&self, now: Stamp) -> Verdict {
        let lost = late("the person's pose", &self.pose, now);
        let long = self.pose.age(now).is_none_or(|age| age > self.settings.pose_hold);
        match lost.reaction {
            Reaction::Hold if !long => Verdict { reaction: Reaction::Slow, ..lost },
            _ => lost,
        }
    }

    /// Whether everything that motion needs is there now.
    ///
    /// # Errors
    /// The first thing that is missing, in words.
    pub fn readiness(&self, now: Stamp) -> Result<(), String> {
        let strictest = Verdict::strictest(self.present(now).into_iter().map(|(_, verdict)| verdict));
        if strictest.allows_motion() { Ok(()) } else { Err(strictest.cause) }
    }

    /// The operator has seen what was latched and goes on. What still stands is latched anew at the next judgement. The
    /// clocks of the streams are compared anew.
    pub fn acknowledge(&mut self) {
        self.latched.clear();
        for side in Side::BOTH {
            self.force.get_mut(side).rebase();
            self.joint_stream.get_mut(side).rebase();
        }
        self.pose.rebase();
    }

    /// What is latched, with its cause.
    pub fn latched(&self) -> impl Iterator<Item = (Watch, &str)> {
        self.latched.iter().map(|(watch, cause)| (*watch, cause.as_str()))
    }

    /// The life of an arm's force stream.
    #[must_use]
    pub const fn force_stream(&self, side: Side) -> &Freshness {
        self.force.get(side)
    }

    /// The life of an arm's joint stream.
    #[must_use]
    pub const fn joint_stream(&self, side: Side) -> &Freshness {
        self.joint_stream.get(side)
    }

    /// The life of the robot's state.
    #[must_use]
    pub const fn robot_stream(&self) -> &Freshness {
        &self.robot
    }

    /// The life of the person's pose.
    #[must_use]
    pub const fn pose_stream(&self) -> &Freshness {
        &self.pose
    }
}

#[cfg(test)]
mod tests;
