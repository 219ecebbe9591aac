//! The link to a Baxter: its topics in, commands out.
//!
//! Nothing here decides what is sent. Sending never blocks; everything that waits for the network (registering, mending) is
//! done at the start or by the watch. Dropping the link does not unregister from the calling thread's point of view: hand it
//! to [`super::node::leave`], which gives it a second.

mod diagnoses;
mod diagnostics;
mod senses;
mod services;
mod show;

pub use senses::DepthWatcher;
pub use show::Showing;

use super::decode::DepthFrame;
use super::encode;
use super::error::RosError;
use super::frames::FrameError;
use super::message::{baxter_core_msgs, std_msgs};
use super::monitor::{Monitor, TopicReport, now};
use super::node::Node;
use super::subscription::Sink;
use super::watch::Watch;
use crate::assembly::SwitchRequest;
use crate::body::{PerSide, Side};
use crate::geometry::Pose;
use crate::kinematics::JointVector;
use crate::robot::PortError;
use crate::snapshot::DiagnosisView;
use diagnoses::Diagnoses;
use rosrust::{Message, Publisher, Service};
use senses::{NewestDepth, subscribe};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, PoisonError};

/// The share of their top speeds that the arms are given: the motion limits ask for 0.75 rad/s of a shoulder's 2 rad/s, and
/// with a third more an arm catches up after a pause without lunging.
const SPEED_RATIO: f64 = 0.5;
/// The robot's own time-out, told again because another program may have changed it: the hold after silence rests on it.
const COMMAND_TIMEOUT_SECONDS: f64 = 0.2;

/// How the link is made.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct LinkSettings {
    /// True where everything is decided and nothing is commanded: no command topic is even advertised.
    pub is_dry_run: bool,
}

/// What commands the robot: absent in a dry run.
#[derive(Clone)]
struct CommandTopics {
    joints: PerSide<Publisher<baxter_core_msgs::JointCommand>>,
    speed_ratio: PerSide<Publisher<std_msgs::Float64>>,
    timeout: PerSide<Publisher<std_msgs::Float64>>,
    stop: Publisher<std_msgs::Empty>,
    reset: Publisher<std_msgs::Empty>,
    enable: Publisher<std_msgs::Bool>,
}

/// The link. One a process.
pub struct RobotLink {
    node: Node,
    commands: Option<CommandTopics>,
    showing: Showing,
    monitors: Vec<Monitor>,
    diagnoses: Diagnoses,
    depth: NewestDepth,
    ended: Arc<AtomicBool>,
    _services: Vec<Service>,
}

impl std::fmt::Debug for RobotLink {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        formatter.debug_struct("RobotLink").field("node", &self.node).finish_non_exhaustive()
    }
}

impl RobotLink {
    /// Subscribes to the robot, advertises what commands it, and starts the watch. Inputs go to `sink`, which must not block.
    ///
    /// # Errors
    /// Where the master does not register something, or the system has no thread to give.
    pub fn connect(node: &Node, settings: LinkSettings, sink: Sink) -> Result<Self, RosError> {
        let commands = if settings.is_dry_run { None } else { Some(CommandTopics::advertise()?) };
        if let Some(commands) = &commands {
            commands.prepare_arms()?;
        }
        let showing = Showing::advertise()?;
        let depth = NewestDepth::default();
        let mut subscriptions = subscribe(&sink, &depth)?;
        let monitors: Vec<Monitor> = subscriptions.iter().map(|subscription| subscription.monitor.clone()).collect();
        // No row among the topics: it is kept apart, and a trial needs nothing of it.
        let diagnoses = Diagnoses::default();
        subscriptions.push(senses::subscribe_diagnoses(&sink, &diagnoses, node.name())?);
        let services = services::serve(&sink)?;
        let ended = Arc::new(AtomicBool::new(false));
        Watch::new(node.master(), &node.name(), sink, subscriptions)
            .guarding(&commanding_topics())
            .start(Arc::clone(&ended))
            .map_err(|error| RosError::thread("the watch over the ROS master", error))?;
        diagnostics::start(node.name(), showing.clone(), monitors.clone(), Arc::clone(&ended))
            .map_err(|error| RosError::thread("diagnostics", error))?;
        Ok(Self { node: node.clone(), commands, showing, monitors, diagnoses, depth, ended, _services: services })
    }

    /// What the arms and the switch are commanded through, for the thread that carries effects out. `None` in a dry run.
    #[must_use]
    pub fn commander(&self) -> Option<Commander> {
        self.commands.clone().map(Commander)
    }

    /// The stop's own way out, for the thread that does nothing else. `None` in a dry run.
    #[must_use]
    pub fn stop_publisher(&self) -> Option<StopPublisher> {
        self.commands.as_ref().map(|commands| StopPublisher(commands.stop.clone()))
    }

    /// What shows the node's doings to other nodes.
    #[must_use]
    pub fn showing(&self) -> Showing {
        self.showing.clone()
    }

    /// The newest depth image that nobody has taken yet. Older ones are gone.
    #[must_use]
    pub fn newest_depth(&self) -> Option<DepthFrame> {
        self.depth.take()
    }

    /// Hears no tracker from now on: the pose comes from depth images.
    pub fn ignore_tracker(&self) {
        self.depth.is_source.store(true, Ordering::SeqCst);
    }

    /// The pose of a frame in `base`, as `/tf` and `/tf_static` tell.
    ///
    /// # Errors
    /// [`FrameError`] where the chain of frames is broken, old or a circle.
    pub fn place_of(&self, frame: &str) -> Result<Pose, FrameError> {
        self.depth.frames.lock().unwrap_or_else(PoisonError::into_inner).in_base(frame, now())
    }

    /// Shows every depth image to `watcher` from now on. The first watcher stays.
    pub fn watch_depth(&self, watcher: DepthWatcher) {
        let _ = self.depth.watcher.0.set(watcher);
    }

    /// What other nodes said of themselves on `/diagnostics` within the last minute, by name.
    #[must_use]
    pub fn diagnoses(&self) -> Vec<DiagnosisView> {
        self.diagnoses.all()
    }

    /// How the subscribed topics do.
    #[must_use]
    pub fn topics(&self) -> Vec<TopicReport> {
        let now = now();
        self.monitors.iter().map(|monitor| monitor.report(now)).collect()
    }
}

impl Drop for RobotLink {
    fn drop(&mut self) {
        self.ended.store(true, Ordering::SeqCst);
    }
}

/// Commands arms and switch. Sending never blocks.
#[derive(Clone)]
pub struct Commander(CommandTopics);

impl std::fmt::Debug for Commander {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        formatter.write_str("Commander")
    }
}

impl Commander {
    /// Sends joint positions (radians, s0 to w2) to an arm. To be repeated at 100 Hz: after 0.2 s without, the arm holds.
    ///
    /// # Errors
    /// Where the transport does not take it.
    pub fn joints(&self, side: Side, joints: &JointVector) -> Result<(), PortError> {
        send(self.0.joints.get(side), encode::joint_command(side, joints), "joint_command")
    }

    /// Asks something of the robot's switch, once. Whether it happened, `/robot/state` tells.
    ///
    /// # Errors
    /// Where the transport does not take it.
    pub fn switch(&self, request: SwitchRequest) -> Result<(), PortError> {
        match request {
            SwitchRequest::Stop => send(&self.0.stop, std_msgs::Empty {}, "set_super_stop"),
            SwitchRequest::Reset => send(&self.0.reset, std_msgs::Empty {}, "set_super_reset"),
            SwitchRequest::Enable => send(&self.0.enable, std_msgs::Bool { data: true }, "set_super_enable"),
            SwitchRequest::Disable => send(&self.0.enable, std_msgs::Bool { data: false }, "set_super_enable"),
        }
    }

    /// Sets the share of an arm's top speed, from 0 to 1 (the robot's own default is 0.3). Latched.
    ///
    /// # Errors
    /// Where the transport does not take it.
    pub fn speed_ratio(&self, side: Side, share: f64) -> Result<(), PortError> {
        send(self.0.speed_ratio.get(side), std_msgs::Float64 { data: share }, "set_speed_ratio")
    }

    /// Sets for how long a command holds, in seconds (the robot's own default is 0.2). Latched.
    ///
    /// # Errors
    /// Where the transport does not take it.
    pub fn command_timeout(&self, side: Side, seconds: f64) -> Result<(), PortError> {
        send(self.0.timeout.get(side), std_msgs::Float64 { data: seconds }, "joint_command_timeout")
    }
}

/// One arm as a port.
#[derive(Clone, Debug)]
pub struct RosLimb {
    /// Through which it is commanded.
    pub commander: Commander,
    /// Which arm.
    pub side: Side,
}

impl crate::robot::Limb for RosLimb {
    fn command(&mut self, _now: crate::time::Stamp, joints: &JointVector) -> Result<(), crate::robot::CommandError> {
        Ok(self.commander.joints(self.side, joints)?)
    }

    /// Sends nothing more: the arm holds by the robot's own time-out.
    fn hold(&mut self, _now: crate::time::Stamp) {}
}

impl crate::robot::RobotSwitch for Commander {
    fn request(&mut self, _now: crate::time::Stamp, request: SwitchRequest) -> Result<(), PortError> {
        self.switch(request)
    }
}

/// Sends the software stop, and nothing else. Its handle is made at the start, so that a stop waits for nothing.
#[derive(Clone)]
pub struct StopPublisher(Publisher<std_msgs::Empty>);

impl std::fmt::Debug for StopPublisher {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        formatter.write_str("StopPublisher")
    }
}

impl StopPublisher {
    /// The stop over a publisher that is there already.
    pub(super) const fn new(publisher: Publisher<std_msgs::Empty>) -> Self {
        Self(publisher)
    }

    /// Sends one stop. To be repeated until the robot's state confirms it.
    pub fn send(&self) {
        // A stop that the transport does not take is repeated by its thread; there is no other way to send it.
        let _ = self.0.send(std_msgs::Empty {});
    }

    /// How many listen: where nobody does, a stop by software reaches nobody.
    #[must_use]
    pub fn listeners(&self) -> usize {
        self.0.subscriber_count()
    }
}

impl CommandTopics {
    fn advertise() -> Result<Self, RosError> {
        let mut speed_ratio = both("set_speed_ratio")?;
        let mut timeout = both("joint_command_timeout")?;
        for side in Side::BOTH {
            let latched: [&mut Publisher<std_msgs::Float64>; 2] = [speed_ratio.get_mut(side), timeout.get_mut(side)];
            for publisher in latched {
                publisher.set_latching(true);
            }
        }
        Ok(Self {
            joints: both("joint_command")?,
            speed_ratio,
            timeout,
            stop: advertise("/robot/set_super_stop", 1)?,
            reset: advertise("/robot/set_super_reset", 1)?,
            enable: advertise("/robot/set_super_enable", 1)?,
        })
    }
}

impl CommandTopics {
    /// Tells the robot how fast its arms may go and how long a command holds, whatever another program told it before.
    fn prepare_arms(&self) -> Result<(), RosError> {
        for side in Side::BOTH {
            let told = [
                (self.speed_ratio.get(side), SPEED_RATIO, "set_speed_ratio"),
                (self.timeout.get(side), COMMAND_TIMEOUT_SECONDS, "joint_command_timeout"),
            ];
            for (publisher, data, what) in told {
                send(publisher, std_msgs::Float64 { data }, what)
                    .map_err(|error| RosError::registration(what, error))?;
            }
        }
        Ok(())
    }
}

/// The topics that command the robot, before remappings: a foreign node on one of them is named. The stop is not among them:
/// whoever sees the robot may stop it.
fn commanding_topics() -> Vec<String> {
    let limbs = Side::BOTH.into_iter().flat_map(|side| {
        ["joint_command", "set_speed_ratio", "joint_command_timeout"].map(|word| format!("/robot/limb/{side}/{word}"))
    });
    let switch = ["reset", "enable"].map(|word| format!("/robot/set_super_{word}"));
    limbs.chain(switch).collect()
}

fn both<T: Message>(word: &str) -> Result<PerSide<Publisher<T>>, RosError> {
    let topic = |side: Side| advertise(&format!("/robot/limb/{side}/{word}"), 1);
    Ok(PerSide { left: topic(Side::Left)?, right: topic(Side::Right)? })
}

pub(super) fn advertise<T: Message>(topic: &str, queue: usize) -> Result<Publisher<T>, RosError> {
    rosrust::publish(topic, queue).map_err(|error| RosError::registration(topic, error))
}

fn send<T: Message>(publisher: &Publisher<T>, message: T, what: &str) -> Result<(), PortError> {
    publisher.send(message).map_err(|error| PortError { what: what.to_owned(), reason: error.to_string() })
}
