//! The ROS 1 messages that stand beside the exact record: the same samples as Baxter sends them, in ROS 1's encoding.

use super::channels::{BODY, COMMANDS, DEPTH, ENDPOINTS, JOINTS, ROSOUT, STATE};
use crate::assembly::RobotState;
use crate::body::{BodyPose, Joint, Side};
use crate::geometry::{Point, Vector};
use crate::snapshot::Level;
use crate::supervisor::{Effect, EndpointSample, Input, JointSample};
use crate::time::Stamp;

/// The names of an arm's joints after `left_` or `right_`, from the shoulder outwards.
const JOINT_NAMES: [&str; 7] = ["s0", "s1", "e0", "e1", "w0", "w1", "w2"];

/// A ROS 1 message: on which channel, and its bytes.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct RosMessage {
    pub(super) channel: usize,
    pub(super) bytes: Vec<u8>,
}

/// ROS 1's little-endian encoding.
#[derive(Default)]
struct Encoder(Vec<u8>);

impl Encoder {
    fn word(&mut self, value: u32) -> &mut Self {
        self.0.extend(value.to_le_bytes());
        self
    }

    fn byte(&mut self, value: u8) -> &mut Self {
        self.0.push(value);
        self
    }

    fn number(&mut self, value: f64) -> &mut Self {
        self.0.extend(value.to_le_bytes());
        self
    }

    fn length(&mut self, length: usize) -> &mut Self {
        self.word(u32::try_from(length).unwrap_or(u32::MAX))
    }

    fn text(&mut self, text: &str) -> &mut Self {
        self.length(text.len());
        self.0.extend(text.as_bytes());
        self
    }

    fn header(&mut self, stamp: Stamp, frame: &str) -> &mut Self {
        let (seconds, nanoseconds) = stamp.to_ros();
        self.word(0).word(seconds).word(nanoseconds).text(frame)
    }

    fn vector(&mut self, vector: &Vector) -> &mut Self {
        self.number(vector.x).number(vector.y).number(vector.z)
    }
}

const fn of_side(first: usize, side: Side) -> usize {
    match side {
        Side::Left => first,
        Side::Right => first + 1,
    }
}

/// The message that an input stands for; `None` where it came from no topic of the robot.
pub(super) fn of_input(input: &Input) -> Option<RosMessage> {
    match input {
        Input::Endpoint(sample) => Some(endpoint(sample)),
        Input::Joints(sample) => Some(joints(sample)),
        Input::Robot(state) => Some(robot_state(state)),
        Input::Body(pose) => Some(body(pose)),
        _ => None,
    }
}

/// The message that a decision stands for; `None` where it is none.
pub(super) fn of_effect(now: Stamp, effect: &Effect) -> Option<RosMessage> {
    match effect {
        Effect::Setpoint { side, joints } => {
            let mut encoder = Encoder::default();
            encoder.word(1).length(joints.len());
            for value in joints.iter() {
                encoder.number(*value);
            }
            encoder.length(joints.len());
            for joint in JOINT_NAMES {
                encoder.text(&format!("{side}_{joint}"));
            }
            Some(RosMessage { channel: of_side(COMMANDS, *side), bytes: encoder.0 })
        }
        Effect::Log { level, text } => {
            let level = match level {
                Level::Debug => 1,
                Level::Information => 2,
                Level::Warning => 4,
                Level::Error => 8,
            };
            let mut encoder = Encoder::default();
            encoder.header(now, "").byte(level).text("/valet").text(text).text("").text("").word(0).length(0);
            Some(RosMessage { channel: ROSOUT, bytes: encoder.0 })
        }
        _ => None,
    }
}

/// A depth image that was already put into PNG, as `compressed_depth_image_transport` sends it.
pub(super) fn depth(stamp: Stamp, png: &[u8]) -> RosMessage {
    let mut encoder = Encoder::default();
    // The transport's own header: format (0) and two parameters that only inverse depth uses.
    encoder.header(stamp, "camera_depth_optical_frame").text("16UC1; compressedDepth png");
    encoder.length(png.len() + 12).word(0).word(0).word(0);
    encoder.0.extend(png);
    RosMessage { channel: DEPTH, bytes: encoder.0 }
}

fn endpoint(sample: &EndpointSample) -> RosMessage {
    let mut encoder = Encoder::default();
    encoder.header(sample.stamp, "base").vector(&sample.pose.translation.vector);
    let rotation = sample.pose.rotation.coords;
    encoder.number(rotation.x).number(rotation.y).number(rotation.z).number(rotation.w);
    // The twist is not part of what the core takes in.
    encoder.vector(&Vector::zeros()).vector(&Vector::zeros());
    encoder.vector(&sample.wrench.force).vector(&sample.wrench.torque);
    RosMessage { channel: of_side(ENDPOINTS, sample.side), bytes: encoder.0 }
}

fn joints(sample: &JointSample) -> RosMessage {
    let known: Vec<(String, f64)> = sample
        .positions
        .iter()
        .flat_map(|(side, positions)| {
            let named = JOINT_NAMES.iter().zip(positions);
            named.filter_map(move |(joint, position)| Some((format!("{side}_{joint}"), (*position)?)))
        })
        .collect();
    let mut encoder = Encoder::default();
    encoder.header(sample.stamp, "").length(known.len());
    for (name, _) in &known {
        encoder.text(name);
    }
    encoder.length(known.len());
    for (_, position) in &known {
        encoder.number(*position);
    }
    encoder.length(0).length(0);
    RosMessage { channel: JOINTS, bytes: encoder.0 }
}

fn robot_state(state: &RobotState) -> RosMessage {
    let mut encoder = Encoder::default();
    // Releases before 1.2.0 do not say whether the robot is ready; enabled is the nearest that they say.
    for flag in [state.ready.unwrap_or(state.enabled), state.enabled, state.stopped, state.error] {
        encoder.byte(u8::from(flag));
    }
    encoder.byte(state.button.to_wire()).byte(state.source.to_wire());
    RosMessage { channel: STATE, bytes: encoder.0 }
}

/// A person's pose as a skeleton tracker sends it: a transform from `base` for each joint that was seen.
fn body(pose: &BodyPose) -> RosMessage {
    let arms = pose.arms.iter().flat_map(|(side, arm)| {
        let seen = Joint::DRESSED.into_iter().filter_map(|joint| Some((joint, arm.position(joint)?)));
        seen.map(move |(joint, place)| (format!("{side}_{joint}_1"), place))
    });
    let neck = pose.neck.map(|neck| ("neck_1".to_owned(), neck.position));
    let frames: Vec<(String, Point)> = arms.chain(neck).collect();
    let mut encoder = Encoder::default();
    encoder.length(frames.len());
    for (name, place) in &frames {
        encoder.header(pose.stamp, "base").text(name).vector(&place.coords);
        encoder.number(0.0).number(0.0).number(0.0).number(1.0);
    }
    RosMessage { channel: BODY, bytes: encoder.0 }
}
