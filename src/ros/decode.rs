//! Messages into the core's plain words. Pure: a message in, a value or nothing out.
//!
//! Numbers are passed on as they came, NaN included: judging them is the core's task. What cannot be understood at all (a
//! state of a length that no release has, an image whose size and data disagree) is nothing.

pub mod skeleton;

use super::message::{baxter_core_msgs, baxter_core_msgs_1_1, geometry_msgs, sensor_msgs};
use crate::assembly::{RedButton, RobotState, StopSource};
use crate::body::{PerSide, Side};
use crate::geometry::{Pose, Vector, Wrench};
use crate::supervisor::{EndpointSample, JointSample};
use crate::time::Stamp;
use crate::vision::{DepthError, DepthImage, RawImage};
use nalgebra::{Isometry3, Quaternion, Translation3, UnitQuaternion};
use std::io;

/// An arm's joints in the order of the robot's own lists, from the shoulder to the wrist.
pub const JOINTS: [&str; 7] = ["s0", "s1", "e0", "e1", "w0", "w1", "w2"];

/// `/robot/state` of any release: SDK 1.2.0 put a new first field before the others, so the length tells the form.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct AnyAssemblyState(Vec<u8>);

impl AnyAssemblyState {
    /// The digests of the forms that are read, the newer first.
    #[must_use]
    pub fn digests() -> Vec<String> {
        use rosrust::Message;
        vec![baxter_core_msgs::AssemblyState::md5sum(), baxter_core_msgs_1_1::AssemblyState::md5sum()]
    }
}

impl rosrust::RosMsg for AnyAssemblyState {
    fn encode<W: io::Write>(&self, mut writer: W) -> io::Result<()> {
        writer.write_all(&self.0)
    }

    fn decode<R: io::Read>(mut reader: R) -> io::Result<Self> {
        let mut bytes = Vec::new();
        reader.read_to_end(&mut bytes)?;
        Ok(Self(bytes))
    }
}

impl rosrust::Message for AnyAssemblyState {
    fn msg_definition() -> String {
        <baxter_core_msgs::AssemblyState as rosrust::Message>::msg_definition()
    }

    /// Any: each form has its own.
    fn md5sum() -> String {
        "*".into()
    }

    fn msg_type() -> String {
        <baxter_core_msgs::AssemblyState as rosrust::Message>::msg_type()
    }
}

/// The robot's state; `None` where the length fits no release.
#[must_use]
pub fn robot_state(message: &AnyAssemblyState, arrival: Stamp) -> Option<RobotState> {
    let (ready, rest) = match *message.0.as_slice() {
        [ready, enabled, stopped, error, button, source] => {
            (Some(ready != 0), [enabled, stopped, error, button, source])
        }
        [enabled, stopped, error, button, source] => (None, [enabled, stopped, error, button, source]),
        _ => return None,
    };
    let [enabled, stopped, error, button, source] = rest;
    Some(RobotState {
        stamp: arrival,
        ready,
        enabled: enabled != 0,
        stopped: stopped != 0,
        error: error != 0,
        button: RedButton::from_wire(button),
        source: StopSource::from_wire(source),
    })
}

/// An arm's end point.
#[must_use]
pub fn endpoint(side: Side, message: &baxter_core_msgs::EndpointState) -> EndpointSample {
    let (force, torque) = (&message.wrench.force, &message.wrench.torque);
    EndpointSample {
        side,
        stamp: stamp(message.header.stamp),
        pose: pose(&message.pose),
        wrench: Wrench {
            force: Vector::new(force.x, force.y, force.z),
            torque: Vector::new(torque.x, torque.y, torque.z),
        },
    }
}

/// Joint positions by name, in whatever order they come; `None` where none of them belongs to an arm, as in the fingers' messages.
#[must_use]
pub fn joints(message: &sensor_msgs::JointState) -> Option<JointSample> {
    let mut positions = PerSide::from_fn(|_| [None; 7]);
    for (name, position) in message.name.iter().zip(&message.position) {
        let place = Side::BOTH.into_iter().find_map(|side| {
            let joint = name.strip_prefix(side.name())?.strip_prefix('_')?;
            Some((side, JOINTS.iter().position(|known| *known == joint)?))
        });
        if let Some((side, index)) = place
            && let Some(slot) = positions.get_mut(side).get_mut(index)
        {
            *slot = Some(*position);
        }
    }
    let named = positions.left.iter().chain(&positions.right).any(Option::is_some);
    named.then(|| JointSample { stamp: stamp(message.header.stamp), positions })
}

/// A depth image as it came, with the figures of the camera that took it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct DepthFrame {
    /// When it was taken.
    pub stamp: Stamp,
    /// The camera's optical frame.
    pub frame: String,
    /// Pixels in a row.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// `16UC1` (millimetres, 0 is no reading) or `32FC1` (metres, NaN is no reading).
    pub encoding: String,
    /// Whether the bytes of a reading begin with the largest.
    pub big_endian: bool,
    /// Bytes in a row.
    pub step: usize,
    /// The bytes.
    pub data: Vec<u8>,
    /// The camera matrix, row by row, in pixels; `None` until one was heard.
    pub camera_matrix: Option<[f64; 9]>,
}

impl DepthFrame {
    /// The image in millimetres.
    ///
    /// # Errors
    /// [`DepthError`] where size, step or encoding are not those of a depth image.
    pub fn image(&self) -> Result<DepthImage, DepthError> {
        // A size that does not fit is larger than any camera's, and refused as such.
        let number = |value: usize| u32::try_from(value).unwrap_or(u32::MAX);
        DepthImage::decode(&RawImage {
            width: number(self.width),
            height: number(self.height),
            step: number(self.step),
            encoding: &self.encoding,
            big_endian: self.big_endian,
            data: &self.data,
        })
    }
}

/// A depth image; `None` where its size and its data disagree.
#[must_use]
pub fn depth(message: sensor_msgs::Image) -> Option<DepthFrame> {
    let (width, height) = (usize::try_from(message.width).ok()?, usize::try_from(message.height).ok()?);
    let step = usize::try_from(message.step).ok()?;
    let bytes = match message.encoding.as_str() {
        "16UC1" | "mono16" => 2,
        "32FC1" => 4,
        _ => return None,
    };
    let fits = width > 0
        && height > 0
        && step >= width.checked_mul(bytes)?
        && message.data.len() == step.checked_mul(height)?;
    fits.then(|| DepthFrame {
        stamp: stamp(message.header.stamp),
        frame: message.header.frame_id,
        width,
        height,
        encoding: message.encoding,
        big_endian: message.is_bigendian != 0,
        step,
        data: message.data,
        camera_matrix: None,
    })
}

/// A message's stamp. Negative numbers cannot come: the wire has none.
#[must_use]
pub fn stamp(time: rosrust::Time) -> Stamp {
    Stamp::from_ros(time.sec, time.nsec)
}

/// A message's pose. A quaternion without length stays without: the core refuses it as not finite.
#[must_use]
pub fn pose(message: &geometry_msgs::Pose) -> Pose {
    let (p, q) = (&message.position, &message.orientation);
    isometry([p.x, p.y, p.z], [q.x, q.y, q.z, q.w])
}

/// Metres, and a quaternion as messages order it: x, y, z, w.
pub(super) fn isometry(place: [f64; 3], quaternion: [f64; 4]) -> Isometry3<f64> {
    let rotation = UnitQuaternion::new_normalize(Quaternion::from(quaternion));
    Isometry3::from_parts(Translation3::from(place), rotation)
}

#[cfg(test)]
mod tests;
