//! The person's skeleton out of transforms: what `openni_tracker` and its relatives publish on `/tf`.
//!
//! Frames are named `left_hand_1` and so on, with the user's number; a lost user's frames simply end, and a new user gets a
//! new number. Only the newest user is followed. Transforms are chained to `base`; a chain that does not reach it gives nothing.

use super::{geometry_msgs, isometry, stamp};
use crate::body::{ArmPose, BodyPose, Evidence, Joint, JointEstimate, PerSide, Side};
use crate::geometry::{Finite, Pose};
use crate::time::Stamp;
use nalgebra::Matrix3;
use std::collections::HashMap;

/// The robot's frame that everything else is expressed in.
const BASE: &str = "base";
/// Frames between a joint and `base`, at most: a longer chain is a circle.
const LONGEST_CHAIN: usize = 16;
/// Frames that are remembered: a Baxter has about 60, each tracked user 15.
const MOST_FRAMES: usize = 1000;
/// Standard deviation of a tracked joint in metres: trackers do not say how much they err. A seated person's joints scatter by
/// about this much from frame to frame; a constant offset is for the calibration of the camera to take out (ours, to be measured).
const DEVIATION: f64 = 0.015;
/// The tracked joints that a sleeve passes.
const TRACKED: [(Joint, &str); 3] = [(Joint::Hand, "hand"), (Joint::Elbow, "elbow"), (Joint::Shoulder, "shoulder")];

#[derive(Clone, Debug)]
struct Frame {
    parent: String,
    transform: Pose,
    stamp: Stamp,
}

/// Collects transforms and gives a pose each time the skeleton is complete.
#[derive(Clone, Debug, Default)]
pub struct Skeleton {
    frames: HashMap<String, Frame>,
    last: Stamp,
}

impl Skeleton {
    /// Takes a message's transforms; gives a pose where they complete one that is newer than the last.
    pub fn take(&mut self, transforms: &[geometry_msgs::TransformStamped]) -> Option<BodyPose> {
        let mut user = None;
        for transform in transforms {
            let child = transform.child_frame_id.trim_start_matches('/').to_owned();
            let (t, r) = (&transform.transform.translation, &transform.transform.rotation);
            let frame = Frame {
                parent: transform.header.frame_id.trim_start_matches('/').to_owned(),
                transform: isometry([t.x, t.y, t.z], [r.x, r.y, r.z, r.w]),
                stamp: stamp(transform.header.stamp),
            };
            user = user_of(&child).map(str::to_owned).or(user);
            if frame.transform.is_finite() && (self.frames.len() < MOST_FRAMES || self.frames.contains_key(&child)) {
                self.frames.insert(child, frame);
            }
        }
        self.pose(&user?)
    }

    /// The pose of a user, where all tracked joints have one stamp that is newer than the last pose's.
    fn pose(&mut self, user: &str) -> Option<BodyPose> {
        let newest = self.frames.get(&format!("left_hand_{user}"))?.stamp;
        if newest <= self.last {
            return None;
        }
        let mut pose = BodyPose { stamp: newest, arms: PerSide::from_fn(|_| ArmPose::default()), neck: None };
        for side in Side::BOTH {
            for (joint, word) in TRACKED {
                let name = format!("{side}_{word}_{user}");
                // A frame of an older image would put together a person who never was.
                self.frames.get(&name).filter(|frame| is_same_image(frame.stamp, newest))?;
                let place = self.place(&name)?;
                pose.arms.get_mut(side).set(joint, Some(place));
            }
        }
        pose.neck = self.place(&format!("neck_{user}"));
        self.last = newest;
        Some(pose)
    }

    fn place(&self, name: &str) -> Option<JointEstimate> {
        let mut position = nalgebra::Point3::origin();
        let mut name = name;
        for _ in 0..LONGEST_CHAIN {
            if name == BASE {
                let covariance = Matrix3::identity() * DEVIATION * DEVIATION;
                return Some(JointEstimate { position, covariance, confidence: 1.0, evidence: Evidence::Seen });
            }
            let frame = self.frames.get(name)?;
            position = frame.transform * position;
            name = &frame.parent;
        }
        None
    }
}

/// Trackers stamp each frame when it is sent: those of one image lie within a few milliseconds.
fn is_same_image(stamp: Stamp, newest: Stamp) -> bool {
    stamp.nanoseconds().abs_diff(newest.nanoseconds()) < 15_000_000
}

/// The user's number in a tracked joint's frame.
fn user_of(child: &str) -> Option<&str> {
    let (joint, user) = child.rsplit_once('_')?;
    let known =
        TRACKED.iter().any(|(_, word)| joint.strip_suffix(word).is_some_and(|side| matches!(side, "left_" | "right_")));
    (known && !user.is_empty() && user.bytes().all(|byte| byte.is_ascii_digit())).then_some(user)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ros::message::{geometry_msgs, std_msgs};

    fn frame(parent: &str, child: &str, [x, y, z]: [f64; 3], nanoseconds: u32) -> geometry_msgs::TransformStamped {
        geometry_msgs::TransformStamped {
            header: std_msgs::Header {
                seq: 0,
                stamp: rosrust::Time { sec: 5, nsec: nanoseconds },
                frame_id: parent.into(),
            },
            child_frame_id: child.into(),
            transform: geometry_msgs::Transform {
                translation: geometry_msgs::Vector3 { x, y, z },
                rotation: geometry_msgs::Quaternion { x: 0.0, y: 0.0, z: 0.0, w: 1.0 },
            },
        }
    }

    fn person(user: &str, nanoseconds: u32) -> Vec<geometry_msgs::TransformStamped> {
        let names = ["left_hand", "left_elbow", "left_shoulder", "right_hand", "right_elbow", "right_shoulder", "neck"];
        let place = |name: &&str| frame("camera_depth_frame", &format!("{name}_{user}"), [1.0, 0.0, 0.0], nanoseconds);
        names.iter().map(place).collect()
    }

    #[test]
    fn a_skeleton_is_carried_over_to_the_robots_base() {
        let mut skeleton = Skeleton::default();
        assert_eq!(skeleton.take(&person("2", 0)), None, "nobody says where the camera is");
        let mut skeleton = Skeleton::default();
        assert_eq!(skeleton.take(&[frame("/base", "camera_depth_frame", [0.0, 0.5, 1.0], 0)]), None);
        let pose = skeleton.take(&person("2", 1)).unwrap();
        let hand = pose.arms.left.position(Joint::Hand).unwrap();
        assert!((hand - nalgebra::Point3::new(1.0, 0.5, 1.0)).norm() < 1e-12);
        assert!(pose.neck.is_some() && pose.arms.right.joint(Joint::Wrist).is_none());
    }

    #[test]
    fn frames_that_come_one_by_one_make_one_pose() {
        let mut skeleton = Skeleton::default();
        skeleton.take(&[frame("base", "camera_depth_frame", [0.0; 3], 0)]);
        let poses: Vec<_> = person("1", 10).into_iter().filter_map(|frame| skeleton.take(&[frame])).collect();
        assert_eq!(poses.len(), 1);
    }

    #[test]
    fn an_old_arm_is_not_put_on_a_new_body_and_a_circle_ends() {
        let mut skeleton = Skeleton::default();
        skeleton.take(&[frame("base", "camera_depth_frame", [0.0; 3], 0)]);
        assert!(skeleton.take(&person("1", 0)).is_some());
        assert_eq!(skeleton.take(&person("1", 0)), None, "the same image again");
        assert_eq!(skeleton.take(&[frame("camera_depth_frame", "left_hand_1", [0.0; 3], 500_000_000)]), None);
        let mut circle = Skeleton::default();
        circle.take(&[frame("a", "b", [0.0; 3], 0), frame("b", "a", [0.0; 3], 0)]);
        assert_eq!(circle.place("a"), None);
    }

    #[test]
    fn only_tracked_joints_with_a_number_name_a_user() {
        assert_eq!(user_of("left_hand_12"), Some("12"));
        for name in ["left_hand", "torso_1", "left_gripper_1", "left_hand_x", "hand_1", "_1", ""] {
            assert_eq!(user_of(name), None, "{name}");
        }
    }
}
