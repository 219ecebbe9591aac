//! The core's plain words into messages. Pure: values in, a message out.

pub(super) mod markers;

use super::decode::JOINTS;
use super::message::{
    baxter_core_msgs, diagnostic_msgs, geometry_msgs, nav_msgs, sensor_msgs, std_msgs, tf2_msgs, valet_msgs,
};
use super::monitor::TopicReport;
use crate::assembly::RobotState;
use crate::body::{BodyPose, Joint, Side};
use crate::geometry::{Point, Pose};
use crate::kinematics::JointVector;
use crate::snapshot::{ForceSample, SideView, Snapshot};
use crate::supervisor::{EndpointSample, JointSample};
use crate::time::Stamp;

/// The frame of every position that leaves.
pub(super) const BASE: &str = "base";
/// `torso_t0` and `head_nod` as a real robot reports them, radians.
const TORSO: f64 = -12.565_987;

pub(super) fn time(stamp: Stamp) -> rosrust::Time {
    let (sec, nsec) = stamp.to_ros();
    rosrust::Time { sec, nsec }
}

pub(super) fn header(stamp: Stamp, frame: &str) -> std_msgs::Header {
    std_msgs::Header { seq: 0, stamp: time(stamp), frame_id: frame.to_owned() }
}

/// Joint positions for an arm, in position mode: the mode in which the robot's own collision avoidance stays active.
pub(super) fn joint_command(side: Side, joints: &JointVector) -> baxter_core_msgs::JointCommand {
    baxter_core_msgs::JointCommand {
        mode: baxter_core_msgs::JointCommand::POSITION_MODE,
        command: joints.iter().copied().collect(),
        names: JOINTS.iter().map(|joint| format!("{side}_{joint}")).collect(),
    }
}

fn point(point: &Point) -> geometry_msgs::Point {
    geometry_msgs::Point { x: point.x, y: point.y, z: point.z }
}

fn vector(v: &crate::geometry::Vector) -> geometry_msgs::Vector3 {
    geometry_msgs::Vector3 { x: v.x, y: v.y, z: v.z }
}

fn pose(pose: &Pose) -> geometry_msgs::Pose {
    let q = &pose.rotation.coords;
    geometry_msgs::Pose {
        position: point(&pose.translation.vector.into()),
        orientation: geometry_msgs::Quaternion { x: q.x, y: q.y, z: q.z, w: q.w },
    }
}

/// Where a frame lies in another.
pub(super) fn transform(stamp: Stamp, parent: &str, child: &str, place: &Pose) -> geometry_msgs::TransformStamped {
    let q = &place.rotation.coords;
    geometry_msgs::TransformStamped {
        header: header(stamp, parent),
        child_frame_id: child.to_owned(),
        transform: geometry_msgs::Transform {
            translation: vector(&place.translation.vector),
            rotation: geometry_msgs::Quaternion { x: q.x, y: q.y, z: q.z, w: q.w },
        },
    }
}

/// A path of positions without orientation.
pub(super) fn path(stamp: Stamp, points: &[Point]) -> nav_msgs::Path {
    let upright = geometry_msgs::Quaternion { x: 0.0, y: 0.0, z: 0.0, w: 1.0 };
    let pose = |place: &Point| geometry_msgs::PoseStamped {
        header: header(stamp, BASE),
        pose: geometry_msgs::Pose { position: point(place), orientation: upright.clone() },
    };
    nav_msgs::Path { header: header(stamp, BASE), poses: points.iter().map(pose).collect() }
}

/// What the node is doing.
pub(super) fn state(snapshot: &Snapshot) -> valet_msgs::State {
    let trial = &snapshot.trial;
    let cause = [&snapshot.stop.cause, &trial.hold_cause, &trial.waiting_for];
    valet_msgs::State {
        header: header(snapshot.now, BASE),
        strategy: trial.strategy.map(|strategy| strategy.to_string()).unwrap_or_default(),
        phase: trial.phase.words().to_owned(),
        step: trial
            .step
            .iter()
            .map(|(side, step)| format!("{side} {}", step.unwrap_or(0)))
            .collect::<Vec<_>>()
            .join(", "),
        safety: if snapshot.stop.latched { "stopped" } else { "clear" }.to_owned(),
        cause: cause.into_iter().find(|words| !words.is_empty()).cloned().unwrap_or_default(),
        armed: snapshot.robot.fresh(snapshot.now).is_some_and(|robot| robot.enabled && !robot.stopped),
    }
}

/// Everything that may be seen, for a console that watches; `None` where it cannot be written, which serde allows for and
/// a snapshot never brings about.
pub(super) fn snapshot(snapshot: &Snapshot) -> Option<valet_msgs::Snapshot> {
    let mut cbor = Vec::new();
    ciborium::into_writer(snapshot, &mut cbor).ok()?;
    Some(valet_msgs::Snapshot { header: header(snapshot.now, BASE), cbor })
}

/// One arm's force window; NaN where a value is not fresh or the window still fills.
pub(super) fn force(snapshot: &Snapshot, side: Side, view: &SideView) -> valet_msgs::Force {
    let sample = view.force.fresh_sample(snapshot.now);
    let iteration = view.iterations.last();
    valet_msgs::Force {
        header: header(snapshot.now, BASE),
        arm: side.name().to_owned(),
        window: sample.and_then(|sample| sample.change).unwrap_or([f64::NAN; 3]),
        combined: sample.and_then(|sample| sample.statistic).unwrap_or(f64::NAN),
        magnitude: sample.map_or(f64::NAN, ForceSample::magnitude),
        threshold: view.force.window.threshold,
        energy: iteration.map_or(0.0, |iteration| iteration.energy),
        iteration: iteration.map_or(0, |iteration| iteration.number),
    }
}

/// The topics' health for `/diagnostics`.
pub(super) fn diagnostics(stamp: Stamp, node: &str, reports: &[TopicReport]) -> diagnostic_msgs::DiagnosticArray {
    use diagnostic_msgs::{DiagnosticStatus, KeyValue};
    let status = reports.iter().map(|report| {
        let (level, message) = match report.age_seconds {
            _ if !report.wrong.is_empty() => (DiagnosticStatus::ERROR, "published by another definition"),
            _ if report.is_good() => (DiagnosticStatus::OK, "as expected"),
            None if report.required => (DiagnosticStatus::ERROR, "never heard"),
            None => (DiagnosticStatus::OK, "not published"),
            Some(_) if report.required => (DiagnosticStatus::ERROR, "late or silent"),
            Some(_) => (DiagnosticStatus::WARN, "late or silent"),
        };
        let wrong: Vec<_> = report.wrong.iter().map(|(node, found)| format!("{node}: {found}")).collect();
        let value = |key: &str, value: String| KeyValue { key: key.to_owned(), value };
        DiagnosticStatus {
            level,
            name: format!("{}: {}", node.trim_start_matches('/'), report.topic),
            message: message.to_owned(),
            hardware_id: "baxter".to_owned(),
            values: vec![
                value("age_seconds", report.age_seconds.map_or_else(|| "never".into(), |age| format!("{age:.3}"))),
                value("hertz", format!("{:.1}", report.hertz)),
                value("unusable", report.unusable.to_string()),
                value("publishers", report.publishers.join(" ")),
                value("other_definitions", wrong.join(" ")),
            ],
        }
    });
    diagnostic_msgs::DiagnosticArray { header: header(stamp, ""), status: status.collect() }
}

/// An arm's end point, as the robot sends it.
pub(super) fn endpoint(sample: &EndpointSample) -> baxter_core_msgs::EndpointState {
    baxter_core_msgs::EndpointState {
        header: header(sample.stamp, ""),
        pose: pose(&sample.pose),
        twist: geometry_msgs::Twist::default(),
        wrench: geometry_msgs::Wrench { force: vector(&sample.wrench.force), torque: vector(&sample.wrench.torque) },
    }
}

/// `/robot/joint_states` as the robot sends it: 17 names in the order of the alphabet, those that are not known left out.
pub(super) fn joints(sample: &JointSample) -> sensor_msgs::JointState {
    let arms = Side::BOTH.into_iter().flat_map(|side| {
        let positions = sample.positions.get(side);
        JOINTS
            .iter()
            .zip(positions)
            .filter_map(move |(joint, position)| Some((format!("{side}_{joint}"), (*position)?)))
    });
    let mut all: Vec<(String, f64)> = arms
        .chain([("head_nod".to_owned(), 0.0), ("head_pan".to_owned(), 0.0), ("torso_t0".to_owned(), TORSO)])
        .collect();
    all.sort_by(|left, right| left.0.cmp(&right.0));
    let (name, position): (Vec<_>, Vec<_>) = all.into_iter().unzip();
    let still = vec![0.0; name.len()];
    sensor_msgs::JointState { header: header(sample.stamp, ""), name, position, velocity: still.clone(), effort: still }
}

/// A gripper's own message on the same topic: one name.
pub(super) fn finger(stamp: Stamp, side: Side) -> sensor_msgs::JointState {
    let letter = if side == Side::Left { 'l' } else { 'r' };
    sensor_msgs::JointState {
        header: header(stamp, ""),
        name: vec![format!("{letter}_gripper_l_finger_joint")],
        position: vec![0.0],
        velocity: vec![0.0],
        effort: vec![0.0],
    }
}

/// The robot's state as release 1.2.0 sends it.
pub(super) fn robot_state(state: &RobotState) -> baxter_core_msgs::AssemblyState {
    baxter_core_msgs::AssemblyState {
        ready: state.ready.unwrap_or(state.enabled),
        enabled: state.enabled,
        stopped: state.stopped,
        error: state.error,
        estop_button: state.button.to_wire(),
        estop_source: state.source.to_wire(),
    }
}

/// A person's pose as a skeleton tracker sends it, with the user's number, straight in the robot's base.
pub(super) fn skeleton(body: &BodyPose, user: u32) -> tf2_msgs::TFMessage {
    let arms = Side::BOTH.into_iter().flat_map(|side| {
        let tracked = [(Joint::Hand, "hand"), (Joint::Elbow, "elbow"), (Joint::Shoulder, "shoulder")];
        tracked.into_iter().filter_map(move |(joint, word)| {
            Some((format!("{side}_{word}_{user}"), body.arms.get(side).position(joint)?))
        })
    });
    let neck = body.neck.map(|neck| (format!("neck_{user}"), neck.position));
    let upright = |place: Point| Pose::from_parts(place.into(), nalgebra::UnitQuaternion::identity());
    let transforms = arms.chain(neck).map(|(name, place)| transform(body.stamp, BASE, &name, &upright(place)));
    tf2_msgs::TFMessage { transforms: transforms.collect() }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::body::PerSide;
    use crate::ros::decode;

    #[test]
    fn joint_states_have_the_robots_17_names_in_the_order_of_the_alphabet_and_return() {
        let positions = PerSide { left: [0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7].map(Some), right: [Some(-1.0); 7] };
        let sample = JointSample { stamp: Stamp::from_nanoseconds(1_500_000_000), positions };
        let message = joints(&sample);
        let expected = "head_nod head_pan left_e0 left_e1 left_s0 left_s1 left_w0 left_w1 left_w2 \
                        right_e0 right_e1 right_s0 right_s1 right_w0 right_w1 right_w2 torso_t0";
        assert_eq!(message.name.join(" "), expected);
        assert_eq!(decode::joints(&message), Some(sample));
        assert_eq!(decode::joints(&finger(Stamp::ZERO, Side::Left)), None);
    }

    #[test]
    fn an_endpoint_and_a_skeleton_return_as_they_were() {
        let pose = Pose::new(nalgebra::Vector3::new(0.5, -0.2, 0.3), nalgebra::Vector3::new(0.1, 0.2, 0.3));
        let sample = EndpointSample {
            side: Side::Right,
            stamp: Stamp::from_nanoseconds(9),
            pose,
            wrench: crate::geometry::Wrench { force: [1.0, -2.0, 3.0].into(), torque: [0.1, 0.2, 0.3].into() },
        };
        let back = decode::endpoint(Side::Right, &endpoint(&sample));
        assert!(
            (back.pose.translation.vector - pose.translation.vector).norm() < 1e-12
                && back.pose.rotation.angle_to(&pose.rotation) < 1e-7
        );
        assert_eq!((back.wrench, back.stamp), (sample.wrench, sample.stamp));
        assert!(skeleton(&BodyPose::default(), 1).transforms.is_empty());
    }

    #[test]
    fn a_command_is_in_position_mode_with_the_arms_own_names() {
        let message = joint_command(Side::Left, &JointVector::repeat(0.25));
        assert_eq!((message.mode, message.names[0].as_str(), message.names[6].as_str()), (1, "left_s0", "left_w2"));
        assert_eq!(message.command, [0.25; 7]);
    }

    #[test]
    fn a_force_that_is_not_fresh_leaves_as_not_a_number() {
        let message = force(&Snapshot::default(), Side::Left, &SideView::default());
        assert!(message.combined.is_nan() && message.magnitude.is_nan() && message.window[0].is_nan());
    }
}
