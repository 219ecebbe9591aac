//! The simulated robot's side of the wire: a Baxter's topics, from whatever world is behind [`SimulatedRobot`].
//!
//! Knows no physics and no node under test: it carries commands in and senses out, in real time, at the rates of the real
//! robot, with its habits (17 joint names in the order of the alphabet, the grippers' own messages between them).

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
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
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
    /// Advances to `now` and tells what is sensed.
    fn step(&mut self, now: Stamp) -> Senses;
}

/// A depth camera's picture.
#[derive(Clone, Debug, PartialEq)]
pub struct DepthPicture {
    /// Pixels in a row, and rows.
    pub size: (u32, u32),
    /// Millimetres row by row; 0 is no reading.
    pub millimetres: Vec<u16>,
    /// Focal lengths and centre in pixels: fx, fy, cx, cy.
    pub intrinsics: [f64; 4],
}

/// Something that takes depth pictures.
pub trait SimulatedCamera: Send {
    /// The picture at a moment, of the person in the newest pose.
    fn picture(&mut self, stamp: Stamp, body: Option<&BodyPose>) -> DepthPicture;
}

enum Command {
    Joints(Side, JointVector),
    Switch(SwitchRequest),
    SpeedRatio(Side, f64),
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
    beats: u64,
    seen: Arc<Mutex<Option<BodyPose>>>,
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
    pub fn new(node: &Node, robot: Box<dyn SimulatedRobot>) -> Result<Self, RosError> {
        let (sender, commands) = bounded(COMMANDS);
        let this = Self {
            topics: Topics::advertise()?,
            commands,
            robot,
            colliding: PerSide::default(),
            beats: 0,
            seen: Arc::default(),
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
        let image = advertise("/camera/depth/image_raw", 1)?;
        let information = advertise("/camera/depth/camera_info", 1)?;
        let (seen, ended) = (Arc::clone(&self.seen), Arc::clone(&self.ended));
        thread::Builder::new()
            .name("depth-camera".into())
            .spawn(move || take_pictures(camera, &image, &information, &seen, &ended))
            .map_err(|error| RosError::thread("the depth camera", error))?;
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
            drop(self.topics.transforms.send(encode::skeleton(body)));
        }
        if let Some(body) = senses.bodies.last() {
            *self.seen.lock().unwrap_or_else(PoisonError::into_inner) = Some(*body);
        }
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
    }
    all.push(on("/robot/set_super_stop", commands, |_: std_msgs::Empty| Some(Command::Switch(SwitchRequest::Stop)))?);
    all.push(on("/robot/set_super_reset", commands, |_: std_msgs::Empty| Some(Command::Switch(SwitchRequest::Reset)))?);
    all.push(on("/robot/set_super_enable", commands, |enable: std_msgs::Bool| {
        Some(Command::Switch(if enable.data { SwitchRequest::Enable } else { SwitchRequest::Disable }))
    })?);
    Ok(all)
}

fn on<T: Message>(
    topic: &str,
    commands: &Sender<Command>,
    read: impl Fn(T) -> Option<Command> + Send + 'static,
) -> Result<Subscriber, RosError> {
    let commands = commands.clone();
    let callback = move |message| {
        if let Some(command) = read(message) {
            // Where more commands wait than a beat can take, the newest is as good as the one after it.
            let _ = commands.try_send(command);
        }
    };
    rosrust::subscribe(topic, QUEUE, callback).map_err(|error| RosError::registration(topic, error))
}

fn take_pictures(
    mut camera: Box<dyn SimulatedCamera>,
    image: &Publisher<sensor_msgs::Image>,
    information: &Publisher<sensor_msgs::CameraInfo>,
    seen: &Mutex<Option<BodyPose>>,
    ended: &AtomicBool,
) {
    let period = Duration::from_secs(1) / 30;
    let mut next = Instant::now();
    while !ended.load(Ordering::SeqCst) {
        // As a real camera's driver: streams start only while someone subscribes.
        if image.subscriber_count() > 0 || information.subscriber_count() > 0 {
            let stamp = now();
            let body = *seen.lock().unwrap_or_else(PoisonError::into_inner);
            let (picture, figures) = messages(stamp, camera.picture(stamp, body.as_ref()));
            let _ = information.send(figures);
            let _ = image.send(picture);
        }
        next += period;
        match next.checked_duration_since(Instant::now()) {
            Some(rest) => thread::sleep(rest),
            None => next = Instant::now(),
        }
    }
}

#[expect(non_snake_case, reason = "the message's own field names")]
fn messages(stamp: Stamp, picture: DepthPicture) -> (sensor_msgs::Image, sensor_msgs::CameraInfo) {
    let header = encode::header(stamp, "camera_depth_optical_frame");
    let (width, height) = picture.size;
    let [fx, fy, cx, cy] = picture.intrinsics;
    let K = [fx, 0.0, cx, 0.0, fy, cy, 0.0, 0.0, 1.0];
    let image = sensor_msgs::Image {
        header: header.clone(),
        height,
        width,
        encoding: "16UC1".to_owned(),
        is_bigendian: 0,
        step: width * 2,
        data: picture.millimetres.iter().flat_map(|reading| reading.to_le_bytes()).collect(),
    };
    let figures = sensor_msgs::CameraInfo {
        header,
        height,
        width,
        distortion_model: "plumb_bob".to_owned(),
        D: vec![0.0; 5],
        K,
        R: [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0],
        P: [fx, 0.0, cx, 0.0, 0.0, fy, cy, 0.0, 0.0, 0.0, 1.0, 0.0],
        ..Default::default()
    };
    (image, figures)
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
    fn a_picture_goes_out_as_a_camera_driver_sends_it_and_is_read_again() {
        let picture = DepthPicture { size: (4, 2), millimetres: vec![1000; 8], intrinsics: [570.0, 571.0, 1.5, 0.5] };
        let (image, figures) = messages(Stamp::from_nanoseconds(3), picture);
        assert_eq!((image.data.len(), figures.K[4]), (16, 571.0));
        assert_eq!(super::super::decode::depth(image).unwrap().encoding, "16UC1");
    }
}
