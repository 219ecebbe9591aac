//! The simulated robot's side of the wire: a Baxter's topics, from whatever world is behind [`SimulatedRobot`].
//!
//! Knows no physics and no node under test: it carries commands in and senses out, in real time, at the rates of the real
//! robot, with its habits (17 joint names in the order of the alphabet, the grippers' own messages between them).

mod camera;

pub use camera::{DepthPicture, SimulatedCamera};

use super::checked::{Checked, Measured};
use super::encode;
use super::error::RosError;
use super::link::advertise;
use super::message::{baxter_core_msgs, sensor_msgs, std_msgs, tf2_msgs};
use super::monitor::now;
use super::node::Node;
use super::watch::Watch;
use crate::assembly::{RobotState, SwitchRequest};
use crate::body::{BodyPose, PerSide, Side};
use crate::kinematics::JointVector;
use crate::supervisor::{EndpointSample, JointSample};
use crate::time::Stamp;
use crossbeam_channel::{Receiver, Sender, bounded};
use rosrust::{Message, Publisher, Subscriber};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread;
use std::time::{Duration, Instant};

/// The robot's beat.
const BEAT: Duration = Duration::from_millis(10);
/// Commands that may wait for the next beat.
const COMMANDS: usize = 256;
/// Messages that may wait for a slow listener.
const QUEUE: usize = 8;
/// Each gripper says where its finger is at a fifth of the robot's beat.
const FINGER_BEATS: u64 = 5;
/// The share of its top speeds at which a real robot moves until it is told otherwise (SDK 1.2.0).
const SPEED_RATIO: f64 = 0.3;
/// A person who was out of sight for so long is a new one to the tracker.
const LOST_AFTER: Duration = Duration::from_secs(1);
/// Contact states are repeated at a tenth of the robot's beat.
const COLLISION_BEATS: u64 = 10;

/// What a world says of one beat or several, oldest first.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Senses {
    /// End points, both arms.
    pub endpoints: Vec<EndpointSample>,
    /// Joint positions.
    pub joints: Vec<JointSample>,
    /// The robot's state.
    pub robot: Vec<RobotState>,
    /// Contact states that changed.
    pub collisions: Vec<(Side, bool)>,
    /// The person's pose.
    pub bodies: Vec<BodyPose>,
}

/// Something that behaves as a Baxter with a person before it.
pub trait SimulatedRobot: Send {
    /// Joint positions for an arm in position mode (radians, s0 to w2).
    fn command_joints(&mut self, side: Side, joints: &JointVector, now: Stamp);
    /// Something is asked of the switch.
    fn switch(&mut self, request: SwitchRequest, now: Stamp);
    /// The share of an arm's top speed.
    fn set_speed_ratio(&mut self, side: Side, ratio: f64);
    /// How long a joint command holds.
    fn set_command_timeout(&mut self, side: Side, timeout: Duration);
    /// Advances to `now` and tells what is sensed.
    fn step(&mut self, now: Stamp) -> Senses;
}

enum Command {
    Joints(Side, JointVector),
    Switch(SwitchRequest),
    SpeedRatio(Side, f64),
    Timeout(Side, Duration),
}

struct Topics {
    endpoints: PerSide<Publisher<baxter_core_msgs::EndpointState>>,
    collisions: PerSide<Publisher<baxter_core_msgs::CollisionDetectionState>>,
    joints: Publisher<sensor_msgs::JointState>,
    robot: Publisher<baxter_core_msgs::AssemblyState>,
    transforms: Publisher<tf2_msgs::TFMessage>,
}

/// The simulated robot on the wire.
pub struct SimNode {
    topics: Topics,
    commands: Receiver<Command>,
    robot: Box<dyn SimulatedRobot>,
    colliding: PerSide<bool>,
    tracked: Tracked,
    beats: u64,
    /// Keeps the camera's place latched.
    mount: Option<Publisher<tf2_msgs::TFMessage>>,
    ended: Arc<AtomicBool>,
    _subscribers: Vec<Subscriber>,
}

impl std::fmt::Debug for SimNode {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        formatter.debug_struct("SimNode").field("beats", &self.beats).finish_non_exhaustive()
    }
}

impl SimNode {
    /// Advertises a Baxter's topics and listens to its commands.
    ///
    /// # Errors
    /// Where the master does not register something, or the system has no thread to give.
    pub fn new(node: &Node, mut robot: Box<dyn SimulatedRobot>) -> Result<Self, RosError> {
        Side::BOTH.into_iter().for_each(|side| robot.set_speed_ratio(side, SPEED_RATIO));
        let (sender, commands) = bounded(COMMANDS);
        let this = Self {
            topics: Topics::advertise()?,
            commands,
            robot,
            colliding: PerSide::default(),
            tracked: Tracked::default(),
            beats: 0,
            mount: None,
            ended: Arc::default(),
            _subscribers: listen(&sender)?,
        };
        // Only registers again with a master that came back: what happens to the graph is nothing to the robot.
        Watch::new(node.master(), &node.name(), Arc::new(|_| ()), Vec::new())
            .start(Arc::clone(&this.ended))
            .map_err(|error| RosError::thread("the watch over the ROS master", error))?;
        Ok(this)
    }

    /// Adds a depth camera, in a thread of its own, at 30 pictures a second.
    ///
    /// # Errors
    /// Where the master does not register it, or the system has no thread to give.
    pub fn add_camera(&mut self, camera: Box<dyn SimulatedCamera>) -> Result<(), RosError> {
        self.mount = Some(camera::start(camera, &self.ended)?);
        Ok(())
    }

    /// Runs in real time until `go_on` says no.
    pub fn run(&mut self, go_on: impl Fn() -> bool) {
        let mut next = Instant::now();
        while go_on() {
            self.beat();
            next += BEAT;
            match next.checked_duration_since(Instant::now()) {
                Some(rest) => thread::sleep(rest),
                // After a long pause the missed beats are not made up for: a real robot does not hurry either.
                None => next = Instant::now(),
            }
        }
    }

    fn beat(&mut self) {
        let now = now();
        for command in self.commands.try_iter() {
            match command {
                Command::Joints(side, joints) => self.robot.command_joints(side, &joints, now),
                Command::Switch(request) => self.robot.switch(request, now),
                Command::SpeedRatio(side, ratio) => self.robot.set_speed_ratio(side, ratio),
                Command::Timeout(side, timeout) => self.robot.set_command_timeout(side, timeout),
            }
        }
        let senses = self.robot.step(now);
        self.publish(now, &senses);
        self.beats += 1;
    }

    /// A message that a listener does not take is lost, as on the real robot.
    fn publish(&mut self, now: Stamp, senses: &Senses) {
        senses.robot.iter().for_each(|state| drop(self.topics.robot.send(encode::robot_state(state))));
        senses.joints.iter().for_each(|sample| drop(self.topics.joints.send(encode::joints(sample))));
        for sample in &senses.endpoints {
            drop(self.topics.endpoints.get(sample.side).send(encode::endpoint(sample)));
        }
        for (side, active) in &senses.collisions {
            *self.colliding.get_mut(*side) = *active;
        }
        if self.beats.is_multiple_of(COLLISION_BEATS) || !senses.collisions.is_empty() {
            for (side, active) in self.colliding.iter() {
                let message = baxter_core_msgs::CollisionDetectionState {
                    header: encode::header(now, ""),
                    collision_state: *active,
                };
                drop(self.topics.collisions.get(side).send(message));
            }
        }
        if self.beats.is_multiple_of(FINGER_BEATS) {
            Side::BOTH.into_iter().for_each(|side| drop(self.topics.joints.send(encode::finger(now, side))));
        }
        for body in &senses.bodies {
            let user = self.tracked.user(body.stamp);
            drop(self.topics.transforms.send(encode::skeleton(body, user)));
        }
    }
}

/// Whom the skeleton tracker follows: one who was lost gets a new number, as `openni_tracker` gives it.
#[derive(Clone, Copy, Debug, Default)]
struct Tracked {
    user: u32,
    last: Option<Stamp>,
}

impl Tracked {
    fn user(&mut self, seen: Stamp) -> u32 {
        let is_lost = self.last.replace(seen).is_none_or(|last| seen.since(last) > LOST_AFTER);
        self.user += u32::from(is_lost);
        self.user
    }
}

impl Drop for SimNode {
    fn drop(&mut self) {
        self.ended.store(true, Ordering::SeqCst);
    }
}

impl Topics {
    fn advertise() -> Result<Self, RosError> {
        Ok(Self {
            endpoints: both("endpoint_state")?,
            collisions: both("collision_detection_state")?,
            joints: advertise("/robot/joint_states", QUEUE)?,
            robot: advertise("/robot/state", QUEUE)?,
            transforms: advertise("/tf", QUEUE)?,
        })
    }
}

fn both<T: Message>(word: &str) -> Result<PerSide<Publisher<T>>, RosError> {
    let topic = |side: Side| advertise(&format!("/robot/limb/{side}/{word}"), QUEUE);
    Ok(PerSide { left: topic(Side::Left)?, right: topic(Side::Right)? })
}

/// The joint positions that a command holds for an arm; `None` where it is in another mode or names too few of them.
fn commanded(side: Side, message: &baxter_core_msgs::JointCommand) -> Option<JointVector> {
    if message.mode != baxter_core_msgs::JointCommand::POSITION_MODE {
        return None;
    }
    let state = sensor_msgs::JointState {
        name: message.names.clone(),
        position: message.command.clone(),
        ..Default::default()
    };
    let sample = super::decode::joints(&state)?;
    let mut joints = JointVector::zeros();
    for (slot, position) in joints.iter_mut().zip(sample.positions.get(side)) {
        *slot = (*position).filter(|position| position.is_finite())?;
    }
    Some(joints)
}

fn listen(commands: &Sender<Command>) -> Result<Vec<Subscriber>, RosError> {
    let mut all = Vec::new();
    for side in Side::BOTH {
        all.push(on(&format!("/robot/limb/{side}/joint_command"), commands, move |message| {
            commanded(side, &message).map(|joints| Command::Joints(side, joints))
        })?);
        all.push(on(&format!("/robot/limb/{side}/set_speed_ratio"), commands, move |ratio: std_msgs::Float64| {
            (0.0..=1.0).contains(&ratio.data).then_some(Command::SpeedRatio(side, ratio.data))
        })?);
        all.push(on(
            &format!("/robot/limb/{side}/joint_command_timeout"),
            commands,
            move |timeout: std_msgs::Float64| {
                Duration::try_from_secs_f64(timeout.data).ok().map(|timeout| Command::Timeout(side, timeout))
            },
        )?);
    }
    all.push(on("/robot/set_super_stop", commands, |_: std_msgs::Empty| Some(Command::Switch(SwitchRequest::Stop)))?);
    all.push(on("/robot/set_super_reset", commands, |_: std_msgs::Empty| Some(Command::Switch(SwitchRequest::Reset)))?);
    all.push(on("/robot/set_super_enable", commands, |enable: std_msgs::Bool| {
        Some(Command::Switch(if enable.data { SwitchRequest::Enable } else { SwitchRequest::Disable }))
    })?);
    Ok(all)
}

fn on<T: Measured>(
    topic: &str,
    commands: &Sender<Command>,
    read: impl Fn(T) -> Option<Command> + Send + 'static,
) -> Result<Subscriber, RosError> {
    let commands = commands.clone();
    let callback = move |Checked(message): Checked<T>| {
        if let Some(command) = read(message) {
            // Where more commands wait than a beat can take, the newest is as good as the one after it.
            let _ = commands.try_send(command);
        }
    };
    rosrust::subscribe(topic, QUEUE, callback).map_err(|error| RosError::registration(topic, error))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_command_is_taken_by_name_and_only_whole_finite_and_in_position_mode() {
        let whole = encode::joint_command(Side::Left, &JointVector::repeat(0.5));
        assert_eq!(commanded(Side::Left, &whole), Some(JointVector::repeat(0.5)));
        assert_eq!(commanded(Side::Right, &whole), None, "another arm's names");
        let mut reversed = whole.clone();
        reversed.names.reverse();
        assert!(commanded(Side::Left, &reversed).is_some());
        let spoiled = [
            baxter_core_msgs::JointCommand { mode: 4, ..whole.clone() },
            baxter_core_msgs::JointCommand { command: vec![f64::NAN; 7], ..whole.clone() },
            baxter_core_msgs::JointCommand { names: whole.names[..6].to_vec(), ..whole.clone() },
            baxter_core_msgs::JointCommand { command: Vec::new(), ..whole },
        ];
        assert!(spoiled.iter().all(|message| commanded(Side::Left, message).is_none()));
    }

    #[test]
    fn a_user_who_was_lost_comes_back_under_a_new_number() {
        let at = |milliseconds: u64| Stamp::from_nanoseconds(milliseconds * 1_000_000);
        let mut tracked = Tracked::default();
        assert_eq!([10_000, 10_033, 10_900].map(|moment| tracked.user(at(moment))), [1, 1, 1]);
        assert_eq!([12_000, 12_033].map(|moment| tracked.user(at(moment))), [2, 2]);
    }
}
