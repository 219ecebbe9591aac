//! Everything measured, and what it means for whether the arms may move: sensing and safety in one hand.
//!
//! Keeps the newest of each input with its freshness, feeds force windows, guards and watchdogs, and owns the stop. It
//! judges; the supervisor obeys.

use super::drive::{Drive, Phase};
use super::input::{EndpointSample, JointSample};
use super::settings::{SettingsError, SupervisorSettings};
use crate::assembly::RobotState;
use crate::body::{BodyPose, Joint, PerSide, Side};
use crate::geometry::{Finite, Point, Vector};
use crate::kinematics::JointVector;
use crate::safety::{ForceGuard, GuardSample, Reaction, StopState, Verdict, Watch, Watchdogs, Zone};
use crate::sensing::{Detection, ForceWindow};
use crate::snapshot::{ForceTier, ForceView, Shared, TierMargin};
use crate::time::Stamp;
use std::time::Duration;

/// How much more force than at its beginning a retreat may bring before it is held, in newtons: what noise of 1.5 N does to
/// the smoothed force (ours).
const RETREAT_MARGIN_NEWTONS: f64 = 3.0;

/// One arm's senses.
#[derive(Debug)]
struct ArmSenses {
    window: ForceWindow,
    guard: ForceGuard,
    endpoint: Option<EndpointSample>,
    joints: [Option<f64>; 7],
}

/// What the screen is told of one force sample.
#[derive(Clone, Copy, Debug)]
pub(super) struct ForceReading {
    pub(super) force: Vector,
    pub(super) change: Option<Vector>,
    pub(super) statistic: Option<f64>,
}

/// Senses, guards and the stop.
#[derive(Debug)]
pub(super) struct Protection {
    settings: SupervisorSettings,
    arms: PerSide<ArmSenses>,
    watchdogs: Watchdogs,
    robot: Option<RobotState>,
    stop: StopState,
    keep_out: Vec<Point>,
    /// While the operator has the garment withdrawn from a hold: the most that may be felt, in newtons.
    retreat: Option<f64>,
}

impl Protection {
    pub(super) fn new(settings: &SupervisorSettings) -> Result<Self, SettingsError> {
        let refused = |key: &str, reason: String| SettingsError { key: key.to_owned(), reason };
        let arm = || -> Result<ArmSenses, SettingsError> {
            Ok(ArmSenses {
                window: ForceWindow::new(settings.window).map_err(|error| refused("window", error.to_string()))?,
                guard: ForceGuard::new(settings.guard.clone()).map_err(|error| refused("guard", error.to_string()))?,
                endpoint: None,
                joints: [None; 7],
            })
        };
        Ok(Self {
            arms: PerSide { left: arm()?, right: arm()? },
            watchdogs: Watchdogs::new(settings.watch_settings()),
            settings: settings.clone(),
            robot: None,
            stop: StopState::default(),
            keep_out: Vec::new(),
            retreat: None,
        })
    }

    /// What is said of motors that somebody else switched, where that is what holds.
    pub(super) fn others_switched(&self) -> Option<String> {
        self.watchdogs.latched().find_map(|(watch, cause)| (watch == Watch::Enable).then(|| cause.to_owned()))
    }

    pub(super) const fn stop(&self) -> &StopState {
        &self.stop
    }

    pub(super) const fn stop_mut(&mut self) -> &mut StopState {
        &mut self.stop
    }

    pub(super) const fn watchdogs_mut(&mut self) -> &mut Watchdogs {
        &mut self.watchdogs
    }

    /// Takes a force sample. `passed` is how far along the person's arm the gripper is in metres, where it dresses one.
    /// Returns a resistance where the window shows one and the arm's own motion does not explain it, or where force grows
    /// along the way as it does on a sleeve that is caught.
    pub(super) fn see_endpoint(
        &mut self,
        now: Stamp,
        sample: &EndpointSample,
        passed: Option<f64>,
        drive: &Drive,
    ) -> Option<Detection> {
        let external = self.settings.wrench.external_force(&sample.wrench, &sample.pose);
        self.watchdogs.force(now, sample.side, sample.stamp, external);
        let zone = Zone::of(&sample.pose.translation.vector.into(), self.keep_out.iter().copied());
        let arm = self.arms.get_mut(sample.side);
        arm.endpoint = sample.pose.is_finite().then_some(*sample);
        let guard_sample = GuardSample {
            stamp: sample.stamp,
            force: external,
            velocity: drive.velocity(sample.side),
            acceleration: drive.acceleration(sample.side),
            zone,
            expected_newtons: passed.map_or(0.0, |metres| arm.guard.expected(metres)),
        };
        arm.guard.observe(&guard_sample);
        // The algorithm's force points the other way than the world's pull: p - step(F) then yields to it.
        arm.window.push(sample.stamp, -external);
        let settled = drive.phase() == Phase::Moving && drive.elapsed().as_secs_f64() > self.settings.settling_seconds;
        if settled { arm.window.detect().or_else(|| arm.guard.catch().map(seen_by_the_robot)) } else { None }
    }

    pub(super) fn see_joints(&mut self, now: Stamp, sample: &JointSample) {
        for (side, positions) in sample.positions.iter() {
            self.watchdogs.joints(now, side, sample.stamp, positions);
            let known = &mut self.arms.get_mut(side).joints;
            for (slot, position) in known.iter_mut().zip(positions) {
                *slot = position.or(*slot);
            }
        }
    }

    /// Takes the robot's state. Returns the cause where the robot has stopped by itself.
    pub(super) fn see_robot(&mut self, now: Stamp, state: &RobotState) -> Option<String> {
        self.watchdogs.robot(now, state);
        self.robot = Some(*state);
        self.stop.observe(now, state)
    }

    pub(super) fn see_body(&mut self, now: Stamp, pose: &BodyPose) {
        self.watchdogs.pose(now, pose.stamp);
        let shoulders = Side::BOTH.into_iter().filter_map(|side| pose.arms.get(side).position(Joint::Shoulder));
        self.keep_out = shoulders.chain(pose.neck.map(|neck| neck.position)).collect();
    }

    /// Judges the inputs at this moment; without a trial nothing moves, and nothing is judged.
    pub(super) fn judge(&mut self, now: Stamp, in_trial: bool) -> Verdict {
        self.watchdogs.tick(now);
        if in_trial { self.watchdogs.judge(now) } else { Verdict::clear() }
    }

    /// What the force guards say now, the stricter of both arms. A retreat takes the pull off: force that would pause only
    /// slows it, as long as it does not grow.
    pub(super) fn judge_force(&self) -> Verdict {
        let verdict = Verdict::strictest(Side::BOTH.map(|side| {
            let verdict = self.arms.get(side).guard.verdict().clone();
            Verdict { cause: format!("{side} arm: {}", verdict.cause), ..verdict }
        }));
        let within = self.retreat.zip(self.highest_load()).is_some_and(|(most, load)| load <= most);
        if within && verdict.reaction == Reaction::Hold {
            return Verdict { reaction: Reaction::Slow, ..verdict };
        }
        verdict
    }

    /// The higher load of both arms in newtons; `None` where one is not known.
    fn highest_load(&self) -> Option<f64> {
        let load = |side| self.arms.get(side).guard.load().map(|load| load.norm());
        Some(load(Side::Left)?.max(load(Side::Right)?))
    }

    /// Whether the garment may be withdrawn: as motion in general, but from a hold for force too, and without the person
    /// being seen, since the way back is the way that was come.
    ///
    /// # Errors
    /// The first thing that is missing, in words.
    pub(super) fn may_retreat(&mut self, now: Stamp) -> Result<(), String> {
        self.require_for_dressing(false);
        let ready = self.inputs_ready(now).and_then(|()| self.robot_ready(now));
        self.require_for_dressing(self.retreat.is_none());
        ready?;
        self.highest_load().map(|_| ()).ok_or_else(|| "the force is not known".to_owned())
    }

    /// The garment is withdrawn from a hold: slowly, and with no more force than there is now.
    pub(super) fn begin_retreat(&mut self) {
        self.require_for_dressing(false);
        self.retreat = self.highest_load().map(|load| load + RETREAT_MARGIN_NEWTONS);
    }

    pub(super) fn end_retreat(&mut self) {
        self.require_for_dressing(true);
        self.retreat = None;
    }

    /// What dressing needs and the way back does not: the person in sight, and a master.
    fn require_for_dressing(&mut self, required: bool) {
        self.watchdogs.require(Watch::Pose, required);
        self.watchdogs.require(Watch::Master, required);
    }

    /// True while the garment is withdrawn from a hold.
    pub(super) const fn retreats(&self) -> bool {
        self.retreat.is_some()
    }

    /// What motion needs.
    ///
    /// # Errors
    /// The first thing that is missing, in words.
    pub(super) fn readiness(&self, now: Stamp) -> Result<(), String> {
        self.inputs_ready(now)?;
        for side in Side::BOTH {
            let verdict = self.arms.get(side).guard.verdict();
            if verdict.reaction >= Reaction::Hold {
                return Err(format!("{side} arm: {}", verdict.cause));
            }
        }
        self.robot_ready(now)
    }

    fn inputs_ready(&self, now: Stamp) -> Result<(), String> {
        if self.stop.is_latched() {
            return Err(format!("a stop is in force ({}): reset, enable, start", self.stop.cause()));
        }
        self.watchdogs.readiness(now)
    }

    fn robot_ready(&self, now: Stamp) -> Result<(), String> {
        match self.robot(now) {
            Some(robot) if robot.enabled && !robot.stopped && !robot.error => Ok(()),
            Some(_) => Err("the robot is not enabled: enable it first".into()),
            None => Err("the robot's state is not known".into()),
        }
    }

    /// True where setpoints may leave: no stop, the robot enabled and its state fresh.
    pub(super) fn may_command(&self, now: Stamp) -> bool {
        !self.stop.is_latched() && self.robot(now).is_some_and(|robot| robot.enabled && !robot.stopped)
    }

    /// The robot's state, as long as it is fresh.
    pub(super) fn robot(&self, now: Stamp) -> Option<&RobotState> {
        self.robot.as_ref().filter(|_| self.watchdogs.robot_stream().is_fresh(now))
    }

    /// Where a gripper is, as long as that is fresh.
    pub(super) fn gripper(&self, now: Stamp, side: Side) -> Option<Point> {
        let sample =
            self.arms.get(side).endpoint.as_ref().filter(|_| self.watchdogs.force_stream(side).is_fresh(now))?;
        Some(sample.pose.translation.vector.into())
    }

    /// Both arms' joints, as long as all of them are fresh.
    pub(super) fn joints(&self, now: Stamp) -> Option<PerSide<JointVector>> {
        Some(PerSide { left: self.arm_joints(now, Side::Left)?, right: self.arm_joints(now, Side::Right)? })
    }

    fn arm_joints(&self, now: Stamp, side: Side) -> Option<JointVector> {
        if !self.watchdogs.joint_stream(side).is_fresh(now) {
            return None;
        }
        let known: Vec<f64> = self.arms.get(side).joints.iter().copied().collect::<Option<_>>()?;
        let joints = JointVector::from_column_slice(&known);
        joints.iter().all(|joint| joint.is_finite()).then_some(joints)
    }

    /// A motion begins: what the arms' own motion changed before means nothing any more.
    pub(super) fn motion_begins(&mut self) {
        for side in Side::BOTH {
            let arm = self.arms.get_mut(side);
            arm.window.reset();
            arm.guard.motion_begins();
        }
    }

    /// Takes an arm's present force as zero.
    ///
    /// # Errors
    /// Where the arm was not still or its force not steady, in words.
    pub(super) fn tare(&mut self, now: Stamp, side: Side) -> Result<Vector, String> {
        self.arms.get_mut(side).guard.tare(now).map(|tare| tare.bias).map_err(|error| error.to_string())
    }

    /// Changes the detector's threshold.
    ///
    /// # Errors
    /// Where it is outside its range, in words.
    pub(super) fn set_threshold(&mut self, newtons: f64) -> Result<(), String> {
        let mut window = self.settings.window;
        window.threshold_newtons = newtons;
        for side in Side::BOTH {
            self.arms.get_mut(side).window = ForceWindow::new(window).map_err(|error| error.to_string())?;
        }
        self.settings.window = window;
        Ok(())
    }

    pub(super) const fn watch(&self) -> &crate::safety::WatchSettings {
        &self.settings.watch
    }

    pub(super) fn force_deadline(&self) -> Duration {
        self.settings.watch.force
    }

    /// The newest sample as the detector sees it.
    pub(super) fn reading(&self, side: Side) -> Option<ForceReading> {
        let arm = self.arms.get(side);
        let sample = arm.endpoint.as_ref()?;
        let external = self.settings.wrench.external_force(&sample.wrench, &sample.pose);
        let zero = arm.guard.zero().map_or_else(Vector::zeros, |tare| tare.bias);
        let reading = arm.window.reading();
        Some(ForceReading {
            force: zero - external,
            change: reading.map(|reading| reading.axes),
            statistic: reading.map(|reading| reading.combined),
        })
    }

    /// Fills in what the screen shows of an arm's detector and guard.
    pub(super) fn show(&self, side: Side, now: Stamp, view: &mut ForceView) {
        let arm = self.arms.get(side);
        let settings = arm.window.settings();
        view.window.detector = format!("window, {:?} form", settings.form).to_lowercase();
        view.window.filled = u32::try_from(arm.window.filled()).unwrap_or(u32::MAX);
        view.window.length = u32::try_from(settings.length).unwrap_or(u32::MAX);
        view.window.threshold = settings.threshold_newtons;
        view.window.broken = arm.window.last_break().map_or_else(String::new, |cause| cause.to_string());
        let fresh = self.watchdogs.force_stream(side).is_fresh(now);
        view.load = arm.guard.load().filter(|_| fresh).map(|load| load.norm());
        view.tier = tier(arm.guard.verdict().reaction);
        view.tier_cause.clone_from(&arm.guard.verdict().cause);
        view.tare = arm.guard.zero().map(|tare| tare.bias.into());
        let place = self.gripper(now, side);
        let zone = place.map_or(Zone::Arm, |place| Zone::of(&place, self.keep_out.iter().copied()));
        let tiers = arm.guard.tiers(zone);
        let margins = [Reaction::Advise, Reaction::Slow, Reaction::Hold, Reaction::Stop]
            .map(|reaction| TierMargin { tier: tier(reaction), limit: tiers.limit(reaction) });
        view.margins = Shared::new(margins.to_vec());
    }
}

/// A catch in the algorithm's axes, in which the window's resistances are too.
fn seen_by_the_robot(caught: Detection) -> Detection {
    Detection { resistance: -caught.resistance, ..caught }
}

/// The screen's word for a reaction.
const fn tier(reaction: Reaction) -> ForceTier {
    match reaction {
        Reaction::Clear => ForceTier::Normal,
        Reaction::Advise => ForceTier::Advise,
        Reaction::Slow => ForceTier::Slow,
        Reaction::Hold => ForceTier::Pause,
        Reaction::Stop => ForceTier::Stop,
    }
}
