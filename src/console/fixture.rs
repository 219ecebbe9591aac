//! Snapshots made up for looking at the screens: for practice, tests and benches, the same at every call.
//!
//! They come from no trial, and say so by their watermark.

mod sides;

use crate::assembly::{RedButton, RobotState, StopSource};
use crate::body::{BodyPose, Evidence, Joint, JointEstimate, PerSide, Side};
use crate::command::{Command, CommandReceipt, Origin};
use crate::geometry::Point;
use crate::snapshot::{
    BodyView, CheckLine, Choices, Freshness, Level, LogLine, MasterView, MotionNotice, ReceiptLine, RecorderView,
    RobotView, SettingView, Snapshot, StepRow, StopView, StrategyRow, StrategyView, TimelineEvent, TimelineKind,
    TopicHealth, TrialPhase, TrialView, Verdict, Watermark,
};
use crate::strategy::StrategyKind;
use crate::time::Stamp;
use std::time::Duration;

/// What a made-up snapshot shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Situation {
    /// A trial under way, everything fresh.
    Live,
    /// The same 1.2 s after everything fell silent.
    Stale,
    /// After an emergency stop that the robot confirmed.
    Stopped,
    /// Nothing has come in yet.
    Empty,
    /// The stop is not confirmed, the master is gone, the recorder cannot write, the force is beyond its tiers.
    Faulty,
}

impl Situation {
    /// All situations.
    pub const ALL: [Self; 5] = [Self::Live, Self::Stale, Self::Stopped, Self::Empty, Self::Faulty];
}

/// Half a minute past ten in the morning of some day.
const NOW: Stamp = Stamp::from_nanoseconds(1_000_000_000 * (1_800_000_000 / 86_400 * 86_400 + 36_030));

/// A made-up snapshot of a moment that is always the same.
#[must_use]
pub fn fixture(situation: Situation) -> Snapshot {
    fixture_at(situation, Moment(NOW))
}

/// The moment that a made-up snapshot shows.
#[derive(Clone, Copy, Debug)]
pub(super) struct Moment(pub(super) Stamp);

impl Moment {
    /// So many milliseconds before.
    pub(super) fn ago(self, milliseconds: u64) -> Stamp {
        Stamp::from_nanoseconds(self.0.nanoseconds().saturating_sub(milliseconds * 1_000_000))
    }

    fn fresh(self, milliseconds: u64, deadline: f64) -> Freshness {
        Freshness { last: Some(self.ago(milliseconds)), deadline }
    }
}

/// A made-up snapshot of any moment.
pub(super) fn fixture_at(situation: Situation, at: Moment) -> Snapshot {
    if situation == Situation::Empty {
        return empty(at);
    }
    let mut snapshot = live(at);
    match situation {
        Situation::Stale => snapshot.now = at.0 + Duration::from_millis(1200),
        Situation::Stopped => stop(&mut snapshot, at),
        Situation::Faulty => fail(&mut snapshot, at),
        Situation::Live | Situation::Empty => {}
    }
    snapshot
}

fn live(at: Moment) -> Snapshot {
    let state = RobotState { stamp: at.ago(8), ready: Some(true), enabled: true, ..RobotState::default() };
    Snapshot {
        now: at.0,
        watermark: Watermark::Demo,
        robot: RobotView { state: Some(state), deadline_seconds: 0.25 },
        master: MasterView { uri: "http://localhost:11311".into(), connected: true, text: "since 09:58:11".into() },
        trial: trial(at),
        sides: PerSide::from_fn(|side| sides::side(side, at)),
        body: body(at),
        strategies: vec![
            strategy(StrategyKind::Gmm, &[31.0], -0.55, 0.999, 14.2),
            strategy(StrategyKind::Force, &[22.2, 9.4, 3.1], -1.7, 0.92, 3.1),
            strategy(StrategyKind::Multimodal, &[24.0, 12.5], -1.26, 0.97, 6.0),
        ]
        .into(),
        choices: Choices {
            profiles: vec!["person-01".into(), "person-02".into()],
            garments: vec!["sleeveless jacket".into(), "gown".into()],
            strategies: StrategyKind::ALL.to_vec(),
        }
        .into(),
        topics: topics(at).into(),
        checks: checks(Verdict::Good).into(),
        recorder: RecorderView {
            on: true,
            file: "trial-0007.mcap".into(),
            bytes: 48_200_000,
            disk_free: Some(112_000_000_000),
            ..RecorderView::default()
        },
        settings: settings().into(),
        log: log(at),
        receipts: receipts(at),
        timeline: timeline(at),
        ..Snapshot::default()
    }
}

fn trial(at: Moment) -> TrialView {
    let goals = [
        ["behind left shoulder", "behind right shoulder"],
        ["behind right shoulder", "right hand"],
        ["towards left shoulder", "right forearm"],
        ["towards left shoulder", "right upper arm"],
        ["towards left shoulder", "right shoulder"],
        ["left shoulder", "no movement"],
    ];
    let step = |(number, [left, right]): (u32, [&str; 2])| StepRow {
        number,
        goals: PerSide { left: left.into(), right: right.into() },
    };
    TrialView {
        phase: TrialPhase::Dressing,
        since: Some(at.ago(9400)),
        steps: (1..).zip(goals).map(step).collect::<Vec<_>>().into(),
        step: PerSide { left: Some(3), right: Some(4) },
        arm: Some(Side::Right),
        strategy: Some(StrategyKind::Force),
        strategy_pending: Some((StrategyKind::Multimodal, "at the next way-point".into())),
        next: Some(MotionNotice {
            arms: vec![Side::Right],
            what: "moves to way-point 5 at the upper arm".into(),
            why: "way-point 4 was reached without resistance".into(),
        }),
        profile: "person-01 v3".into(),
        profile_hash: "9f3a61c2".into(),
        garment: "sleeveless jacket".into(),
        seed: 1,
        speed_share: Some(0.5),
        ..TrialView::default()
    }
}

fn body(at: Moment) -> BodyView {
    let mut pose = BodyPose { stamp: at.ago(30), ..BodyPose::default() };
    for side in Side::BOTH {
        let y = if side == Side::Right { -0.25 } else { 0.25 };
        let joints = [(Joint::Hand, 0.95, 0.1), (Joint::Elbow, 0.8, 0.05), (Joint::Shoulder, 0.6, 0.2)];
        for (joint, x, z) in joints {
            let evidence =
                if side == Side::Left && joint == Joint::Elbow { Evidence::Inferred } else { Evidence::Seen };
            let estimate = JointEstimate {
                position: Point::new(x, y, z),
                covariance: nalgebra::Matrix3::identity() * 1e-4,
                confidence: 0.9,
                evidence,
            };
            pose.arms.get_mut(side).set(joint, Some(estimate));
        }
    }
    BodyView { pose: Some(pose), freshness: at.fresh(30, 0.2), source: "depth camera".into() }
}

fn strategy(kind: StrategyKind, energies: &[f64], reachability: f64, inside: f64, comfort: f64) -> StrategyView {
    let row = StrategyRow {
        side: Side::Right,
        energies: energies.to_vec(),
        reaches: energies.iter().map(|energy| Some(reachability - energy / 20.0)).collect(),
        reachability: Some(reachability),
        inside: Some(inside),
        comfort: Some(comfort),
    };
    StrategyView {
        kind,
        rows: vec![row],
        measured: kind == StrategyKind::Force,
        switch: "keeps the path, drops the optimiser's moments, from the next way-point on".into(),
        refusal: (kind == StrategyKind::Gmm).then(|| "the movement space of the left arm is not fitted".into()),
    }
}

fn topic(at: Moment, name: &str, kind: &str, rate: f64, deadline: f64) -> TopicHealth {
    TopicHealth {
        name: name.into(),
        kind: kind.into(),
        freshness: at.fresh(6, deadline),
        rate,
        expected: (rate * 0.9, rate * 1.1),
        gap: 1.3 / rate,
        jitter: 0.05 / rate,
        stamp_lag: Some(0.002),
        drops: 0,
        publishers: vec!["/robot".into()],
        required: true,
    }
}

fn topics(at: Moment) -> Vec<TopicHealth> {
    let mut depth = topic(at, "/camera/depth/image_raw", "sensor_msgs/Image", 30.0, 0.2);
    (depth.rate, depth.drops) = (18.2, 12);
    let mut colour = topic(at, "/camera/rgb/image_raw", "sensor_msgs/Image", 30.0, 0.2);
    (colour.freshness.last, colour.required) = (None, false);
    colour.publishers.clear();
    vec![
        topic(at, "/robot/limb/left/endpoint_state", "baxter_core_msgs/EndpointState", 100.0, 0.05),
        topic(at, "/robot/limb/right/endpoint_state", "baxter_core_msgs/EndpointState", 100.0, 0.05),
        topic(at, "/robot/joint_states", "sensor_msgs/JointState", 100.0, 0.05),
        topic(at, "/robot/state", "baxter_core_msgs/AssemblyState", 100.0, 0.25),
        depth,
        colour,
    ]
}

fn checks(verdict: Verdict) -> Vec<CheckLine> {
    let line = |name: &str, value: &str, hint: &str| CheckLine {
        name: name.into(),
        verdict,
        value: value.into(),
        hint: hint.into(),
        age: (verdict == Verdict::Good).then_some(0.01),
    };
    let value = |good: &'static str| if verdict == Verdict::Good { good } else { "nothing heard" };
    vec![
        line("ROS master", value("answers"), "start roscore, check ROS_MASTER_URI"),
        line("robot state", value("enabled"), "switch the robot on"),
        line("left force", value("100 Hz"), "check /robot/limb/left/endpoint_state"),
        line("right force", value("100 Hz"), "check /robot/limb/right/endpoint_state"),
        line("person's pose", value("30 Hz"), "start the camera"),
    ]
}

fn settings() -> Vec<SettingView> {
    let setting = |key: &str, name: &str, value: f64, limits: (f64, f64), step: f64, unit: &str| SettingView {
        key: key.into(),
        name: name.into(),
        value,
        previous: (key == "force.threshold_newtons").then_some(4.5),
        limits,
        step,
        unit: unit.into(),
    };
    vec![
        setting("force.threshold_newtons", "resistance threshold", 5.0, (1.0, 10.0), 0.5, "N"),
        setting("strategy.step_metres", "step size", 0.02, (0.005, 0.05), 0.005, "m"),
    ]
}

fn log(at: Moment) -> crate::snapshot::History<LogLine> {
    let mut log = crate::snapshot::History::new(1000);
    let texts = [
        (Level::Information, "trial", "iteration 1 of the right arm: 22.2 N in 3 resistances"),
        (Level::Debug, "ros", "subscribed to /robot/state"),
        (Level::Warning, "sensing", "left force window broken by a late sample"),
        (Level::Information, "strategy", "way-point 3 moved 21 mm away from 6.4 N"),
        (Level::Error, "recorder", "the disk is nearly full"),
    ];
    for id in 0..60_u64 {
        let index = usize::try_from(id).unwrap_or(0) % texts.len();
        if let Some((level, source, text)) = texts.get(index) {
            log.push(LogLine {
                id,
                stamp: at.ago((60 - id) * 500),
                level: *level,
                source: (*source).into(),
                text: (*text).into(),
            });
        }
    }
    log
}

fn receipts(at: Moment) -> crate::snapshot::History<ReceiptLine> {
    let mut receipts = crate::snapshot::History::new(100);
    let line =
        |milliseconds, receipt| ReceiptLine { stamp: at.ago(milliseconds), origin: Origin::OperatorKey, receipt };
    receipts.push(line(9000, CommandReceipt::refused(Command::Tare(Side::Right), "the arm moves: hold first")));
    let command = Command::SelectStrategy(StrategyKind::Multimodal);
    receipts.push(line(2100, CommandReceipt::accepted(command, "at the next way-point")));
    receipts
}

fn timeline(at: Moment) -> crate::snapshot::History<TimelineEvent> {
    let mut timeline = crate::snapshot::History::new(500);
    let events = [
        (55_000, None, TimelineKind::Step(2)),
        (41_000, Some(Side::Right), TimelineKind::Iteration(2)),
        (30_000, Some(Side::Right), TimelineKind::Resistance),
        (22_000, None, TimelineKind::Hold),
        (20_000, None, TimelineKind::Continue),
        (9_000, Some(Side::Right), TimelineKind::Iteration(3)),
        (4_000, Some(Side::Right), TimelineKind::Resistance),
    ];
    timeline.extend(events.map(|(milliseconds, side, kind)| TimelineEvent { stamp: at.ago(milliseconds), side, kind }));
    timeline
}

fn stop(snapshot: &mut Snapshot, at: Moment) {
    snapshot.stop = StopView {
        latched: true,
        requested_at: Some(at.ago(3000)),
        sent_at: Some(at.ago(2999)),
        is_reset: false,
        confirmed_at: Some(at.ago(2988)),
        cause: "the operator's key".into(),
    };
    if let Some(state) = &mut snapshot.robot.state {
        (state.enabled, state.stopped) = (false, true);
        (state.button, state.source) = (RedButton::Unknown, StopSource::Unknown);
    }
    snapshot.trial.phase = TrialPhase::Stopped;
    snapshot.trial.next = None;
    snapshot.trial.hold_cause = "emergency stop by the operator".into();
    snapshot.timeline.push(TimelineEvent { stamp: at.ago(3000), side: None, kind: TimelineKind::Stop });
}

fn fail(snapshot: &mut Snapshot, at: Moment) {
    snapshot.stop = StopView {
        latched: true,
        requested_at: Some(at.ago(700)),
        sent_at: Some(at.ago(699)),
        is_reset: false,
        confirmed_at: None,
        cause: "safety: right force 38.2 N is beyond 35 N".into(),
    };
    snapshot.trial.phase = TrialPhase::Holding;
    snapshot.trial.hold_cause = "the ROS master does not answer".into();
    (snapshot.master.connected, snapshot.master.text) = (false, "gone since 10:00:21".into());
    snapshot.recorder.fault = "no space left on the disk".into();
    snapshot.dropped_samples = 37;
    snapshot.checks = checks(Verdict::Fault).into();
    sides::overload(&mut snapshot.sides.right.force);
    if let Some(state) = &mut snapshot.robot.state {
        (state.error, state.button) = (true, RedButton::Pressed);
    }
}

fn empty(at: Moment) -> Snapshot {
    Snapshot {
        now: at.0,
        master: MasterView { uri: "http://localhost:11311".into(), connected: false, text: "never answered".into() },
        checks: checks(Verdict::Fault).into(),
        ..Snapshot::default()
    }
}
