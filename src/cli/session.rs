//! A node at work: link to the robot, supervisor, stop thread and recorder, put together for a screen or for lines.
//!
//! Only glue: each part knows none of the others.

use super::exit::Failure;
use super::eyes::{Eyes, Sight};
use super::log::{self, ProgramLog};
use super::planning::PlannerThread;
use super::recorded_pose::{RecordedPose, Telling};
use super::recording::Recording;
use super::sim::ros_failure;
use crate::assembly::SwitchRequest;
use crate::body::{PerSide, Side};
use crate::command::{Command, CommandOutcome, CommandReceipt, Origin};
use crate::config::{LoadedProfile, Places, profile_names};
use crate::engine::stop::StopThread;
use crate::engine::{Engine, Inbox, Outlet, SharedSnapshot};
use crate::kinematics::{JointVector, RobotModel, Scene};
use crate::record::{Recorder, RecorderNotice};
use crate::robot::{GuardSettings, GuardedLimb, GuardedPair};
use crate::ros::{Commander, DepthWatcher, LinkSettings, Node, RobotLink, RosLimb, Showing, TopicReport, leave};
use crate::snapshot::{Choices, Freshness, RecorderView, Shared, Snapshot, TopicHealth};
use crate::supervisor::{Effect, Input, LinkEvent, PlanOrder, PlannerKind, Setup, Supervisor};
use crate::time::Stamp;
use std::path::PathBuf;
use std::sync::{Arc, OnceLock, Weak};
use std::time::{Duration, Instant};

/// A topic that has been silent for longer is shown as stale; what moves the robot has limits of its own.
const TOPIC_DEADLINE_SECONDS: f64 = 0.5;
/// How long that holds which is said once for all, in seconds: longer than any node runs.
const FOR_GOOD_SECONDS: f64 = 1e9;

/// How often whoever looks at the snapshots shows that it lives: four times within the watchdog's limit of a second.
const CONSOLE_BEAT: Duration = Duration::from_millis(250);

/// What a session is opened with.
pub(super) struct Opening<'a> {
    pub(super) node: Node,
    pub(super) setup: Setup,
    pub(super) person: &'a LoadedProfile,
    /// Where the journal goes; `None` where the operator refused one.
    pub(super) recording: Option<Recording>,
    pub(super) is_dry_run: bool,
    /// A recording that the person's pose comes from instead of a camera or a tracker.
    pub(super) pose: Option<RecordedPose>,
}

/// A node at work. Dropping it stops the supervisor and leaves the graph.
pub(super) struct Session {
    engine: Option<Engine>,
    stop: Option<StopThread>,
    shell: ShellView,
    recorder: Option<Arc<Recorder>>,
    eyes: Option<Eyes>,
    recorded_pose: Option<Telling>,
    node: Node,
    log: ProgramLog,
}

/// Carries effects to the robot through guards, shows snapshots to other nodes, records every step.
struct RobotOutlet {
    limbs: Option<GuardedPair<RosLimb>>,
    commander: Option<Commander>,
    showing: Showing,
    recorder: Option<Arc<Recorder>>,
    planner: Option<PlannerThread>,
    shell: ShellView,
}

/// What only the shell knows of what may be seen: topics, master, recorder, and what can be chosen.
#[derive(Clone)]
struct ShellView {
    link: Arc<RobotLink>,
    recorder: Option<Arc<Recorder>>,
    master: String,
    pose_source: String,
    choices: Choices,
}

impl ShellView {
    fn fill_in(&self, snapshot: &mut Snapshot) {
        let topics = self.link.topics();
        snapshot.topics = Shared::new(topics.iter().map(topic_health).collect());
        snapshot.diagnoses = Shared::new(self.link.diagnoses());
        snapshot.master.uri.clone_from(&self.master);
        self.pose_source.clone_into(&mut snapshot.body.source);
        snapshot.recorder = self.recorder.as_deref().map(recorder_view).unwrap_or_default();
        let strategies = snapshot.choices.strategies.clone();
        snapshot.choices = Shared::new(Choices { strategies, ..self.choices.clone() });
        snapshot.checks = Shared::new(snapshot.check_list());
    }
}

impl Outlet for RobotOutlet {
    fn setpoint(&mut self, now: Stamp, side: Side, joints: &JointVector) -> Result<(), String> {
        // A dry run decides everything and commands nothing.
        let Some(limbs) = self.limbs.as_mut() else { return Ok(()) };
        limbs.command(now, side, joints).map_err(|error| error.to_string())
    }

    fn release(&mut self, _side: Side) {
        // Sending nothing more is all: the robot holds by its own time-out.
    }

    fn plan(&mut self, order: PlanOrder) {
        if let Some(planner) = &self.planner {
            planner.ask(order);
        }
    }

    fn surround(&mut self, scene: Scene) {
        if let Some(limbs) = self.limbs.as_mut() {
            limbs.surround(scene);
        }
    }

    fn switch(&mut self, request: SwitchRequest) {
        if let Some(commander) = &self.commander {
            // What the transport does not take shows in the robot's state, which the supervisor waits for.
            let _ = commander.switch(request);
        }
    }

    fn show(&mut self, snapshot: &Snapshot) {
        self.showing.show(snapshot, |whole| self.shell.fill_in(whole));
    }

    fn record(&mut self, now: Stamp, input: &Input, effects: &[Effect]) {
        effects.iter().for_each(log::tell);
        if let (Input::Joints(sample), Some(limbs)) = (input, self.limbs.as_mut()) {
            for (side, positions) in sample.positions.iter() {
                limbs.observe(now, side, positions);
            }
        }
        if let Some(recorder) = &self.recorder {
            recorder.offer(now, input, effects);
            if let Some(on) = effects.iter().find_map(recording_asked) {
                recorder.set_on(on);
            }
        }
    }
}

impl Session {
    /// Links the node to the robot and starts to supervise. Nothing moves before Enable and Start.
    ///
    /// # Errors
    /// Where the master does not register something, a setting is not usable, or the recorder cannot write.
    pub(super) fn open(opening: Opening<'_>) -> Result<Self, Failure> {
        let log = ProgramLog::start(&Places::of_this_machine().logs);
        let model = RobotModel::baxter().map_err(Failure::configuration)?;
        let limits = opening.setup.settings.motion.clone();
        let inbox: Arc<OnceLock<Inbox>> = Arc::default();
        let late = Arc::clone(&inbox);
        let sink = Arc::new(move |input: Input| {
            if let Some(inbox) = late.get() {
                inbox.offer(input);
            }
        });
        let heard = Arc::clone(&sink);
        let told = Box::new(move |notice| heard(Input::Link(link_event(notice))));
        let recorder = opening.recording.as_ref();
        let recorder = recorder.map(|place| place.start(&opening.setup, opening.person, told)).transpose()?;
        let recorder = recorder.map(Arc::new);
        let sight = if opening.pose.is_some() { None } else { Sight::of(opening.person)? };
        let is_planned_outside = opening.setup.settings.planner == PlannerKind::MoveIt;
        let supervisor = Supervisor::new(opening.setup, model.clone()).map_err(Failure::configuration)?;
        let node = opening.node;
        let answers = sink.clone();
        let seen = sink.clone();
        let planner = is_planned_outside.then(|| PlannerThread::start(&node, model.clone(), answers));
        let planner = planner.transpose().map_err(Failure::fault)?;
        let link =
            RobotLink::connect(&node, LinkSettings { is_dry_run: opening.is_dry_run }, sink).map_err(ros_failure)?;
        let publisher = link.stop_publisher();
        let stop = StopThread::start(move || {
            if let Some(publisher) = &publisher {
                publisher.send();
            }
        })
        .map_err(Failure::fault)?;
        let latch = stop.latch();
        let limbs = link.commander().map(|commander| {
            let guarded = PerSide::from_fn(|side| {
                let limb = RosLimb { commander: commander.clone(), side };
                GuardedLimb::new(limb, model.arm(side).clone(), limits.clone(), GuardSettings::default(), latch.flag())
            });
            GuardedPair::new(guarded, model.clone(), limits.clone())
        });
        if let Some(recorder) = recorder.as_ref().filter(|_| opening.recording.is_some_and(|place| place.has_depth())) {
            link.watch_depth(depth_recorder(Arc::downgrade(recorder)));
        }
        let link = Arc::new(link);
        let pose_source = match (&opening.pose, &sight) {
            (Some(recorded), _) => recorded.source(),
            (None, Some(_)) => "depth camera".to_owned(),
            (None, None) => "skeleton tracker".to_owned(),
        };
        let eyes = sight.map(|sight| Eyes::open(sight, Arc::clone(&link), seen.clone())).transpose();
        let eyes = eyes.map_err(Failure::fault)?;
        let garments = opening.person.profile.garments.iter().map(|garment| garment.name.clone()).collect();
        let profiles = profile_names(&Places::of_this_machine());
        let choices = Choices { profiles, garments, ..Choices::default() };
        let master = node.master().to_owned();
        let shell = ShellView { link: Arc::clone(&link), recorder: recorder.clone(), master, pose_source, choices };
        let outlet = RobotOutlet {
            limbs,
            commander: link.commander(),
            showing: link.showing(),
            recorder: recorder.clone(),
            planner,
            shell: shell.clone(),
        };
        let engine = Engine::start(supervisor, Box::new(outlet), latch).map_err(Failure::fault)?;
        // Nobody else sets it: this cannot fail.
        let _ = inbox.set(engine.inbox());
        engine.inbox().offer(Input::Link(LinkEvent::MasterBack));
        let recorded_pose = opening.pose.map(|recorded| {
            shell.link.ignore_tracker();
            recorded.tell(seen)
        });
        let recorded_pose = recorded_pose.transpose().map_err(Failure::fault)?;
        Ok(Self { engine: Some(engine), stop: Some(stop), shell, recorder, eyes, recorded_pose, node, log })
    }

    /// The stop, for keys and panics: sets the latch, never blocks.
    pub(super) fn stopper(&self) -> Arc<dyn crate::console::StopHandle> {
        let latch = self.stop.as_ref().map(StopThread::latch);
        Arc::new(move || {
            if let Some(latch) = &latch {
                latch.stop();
            }
        })
    }

    /// Where the commands of `origin` go.
    pub(super) fn asker(&self, origin: Origin) -> impl FnMut(Command) -> Result<(), String> + use<> {
        let inbox = self.engine.as_ref().map(Engine::inbox);
        move |command| {
            let inbox = inbox.as_ref().ok_or("the supervisor has ended")?;
            inbox.offer(Input::Operator { command, origin });
            Ok(())
        }
    }

    /// Nobody watches any more: the trial holds.
    pub(super) fn lose_console(&self) {
        if let Some(engine) = &self.engine {
            engine.inbox().offer(Input::Link(LinkEvent::ConsoleLost));
        }
    }

    /// True while a stop is latched.
    pub(super) fn is_stopped(&self) -> bool {
        self.stop.as_ref().is_some_and(|stop| stop.latch().is_stopped())
    }

    /// The engine, as long as the session is open.
    pub(super) const fn engine(&self) -> Option<&Engine> {
        self.engine.as_ref()
    }

    /// True until the node is told to end.
    pub(super) fn is_running(&self) -> bool {
        self.node.is_running()
    }

    /// Snapshots with what only the shell knows filled in: topics, recorder, master.
    pub(super) fn viewer(&self) -> impl FnMut() -> Option<Snapshot> + use<> {
        let shared = self.engine.as_ref().map(Engine::snapshots);
        let shell = self.shell.clone();
        let (inbox, mut last, mut beat) = (self.engine.as_ref().map(Engine::inbox), None, None);
        move || {
            if let Some(inbox) = inbox.as_ref().filter(|_| beat.is_none_or(|at: Instant| at.elapsed() > CONSOLE_BEAT)) {
                inbox.offer(Input::Link(LinkEvent::ConsoleBeat));
                beat = Some(Instant::now());
            }
            let newest = shared.as_ref().map(SharedSnapshot::newest)?;
            if last == Some(newest.now) {
                return None;
            }
            last = Some(newest.now);
            let mut snapshot = Snapshot::clone(&newest);
            shell.fill_in(&mut snapshot);
            Some(snapshot)
        }
    }

    /// Ends the session in order: the arms are no longer commanded, the record is closed, the graph is left.
    pub(super) fn close(mut self) -> Option<PathBuf> {
        drop(self.engine.take());
        drop(self.stop.take());
        drop(self.eyes.take());
        drop(self.recorded_pose.take());
        let Self { shell: ShellView { link, recorder: shared, .. }, recorder, node, log, .. } = self;
        // The recorder is finished by its last owner.
        drop(shared);
        let path = recorder.map(|recorder| {
            let path = recorder.status().path;
            drop(Arc::into_inner(recorder));
            path
        });
        leave((link, node));
        drop(log);
        path
    }
}

/// Records every depth image. Does not keep the recorder alive: it ends with the session.
fn depth_recorder(recorder: Weak<Recorder>) -> DepthWatcher {
    Box::new(move |frame| {
        let Some(recorder) = recorder.upgrade() else { return };
        // What is no depth image is told by the topic's own health.
        let Ok(image) = frame.image() else { return };
        let [width, height] = [frame.width, frame.height].map(|pixels| u32::try_from(pixels).unwrap_or(u32::MAX));
        recorder.offer_depth(frame.stamp, width, height, &Arc::from(image.millimetres()));
    })
}

/// Whether the operator has just switched recording on or off.
const fn recording_asked(effect: &Effect) -> Option<bool> {
    match effect {
        Effect::Receipt(CommandReceipt {
            command: Command::SetRecording(on),
            outcome: CommandOutcome::Accepted { .. },
        }) => Some(*on),
        _ => None,
    }
}

/// What the recorder says by itself, as the supervisor hears it.
fn link_event(notice: RecorderNotice) -> LinkEvent {
    match notice {
        RecorderNotice::Failed { reason } => LinkEvent::RecorderFailed { reason },
        RecorderNotice::Overflowed { lost } => LinkEvent::RecorderOverflow { lost },
    }
}

/// A topic as the console shows it. What is said once for all holds for good.
fn topic_health(report: &TopicReport) -> TopicHealth {
    let deadline = if report.topic.ends_with("/tf_static") { FOR_GOOD_SECONDS } else { TOPIC_DEADLINE_SECONDS };
    TopicHealth {
        name: report.topic.clone(),
        kind: report.kind.clone(),
        freshness: Freshness { last: report.newest, deadline },
        rate: report.hertz,
        expected: report.expected_hertz,
        gap: report.gap_seconds,
        jitter: report.jitter_seconds,
        stamp_lag: report.stamp_lag_seconds,
        drops: report.unusable,
        publishers: report.publishers.clone(),
        required: report.required,
    }
}

fn recorder_view(recorder: &Recorder) -> RecorderView {
    let status = recorder.status();
    RecorderView {
        on: status.on,
        file: status.path.display().to_string(),
        bytes: status.bytes,
        drops: status.lost,
        disk_free: status.free_bytes,
        fault: status.failed.clone().unwrap_or_default(),
    }
}
