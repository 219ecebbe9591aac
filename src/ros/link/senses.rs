//! What is listened to: the robot's topics, the camera's and the tracker's, each decoded in the thread that receives it.

use super::RosError;
use super::diagnoses::{self, Diagnoses};
use crate::body::Side;
use crate::ros::decode::{self, AnyAssemblyState, DepthFrame, skeleton::Skeleton};
use crate::ros::frames::Frames;
use crate::ros::message::{baxter_core_msgs, diagnostic_msgs, sensor_msgs, tf2_msgs};
use crate::ros::monitor::now;
use crate::ros::subscription::{Decoded, Sink, Subscription, TopicNeed};
use crate::supervisor::Input;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, OnceLock, PoisonError};

/// Messages that may wait for their callback at 100 Hz: 80 ms, beyond which they are stale anyway.
const QUEUE: usize = 8;
/// The robot's beat and what is tolerated round it, in messages a second.
const HUNDRED_HERTZ: (f64, f64) = (80.0, 125.0);
/// Both publishers of joint states together: 100 Hz of the robot, and the grippers' own messages.
const JOINT_HERTZ: (f64, f64) = (40.0, 400.0);
/// A depth camera's beat.
const THIRTY_HERTZ: (f64, f64) = (20.0, 35.0);
/// `state` of a `DigitalIOState` whose button is pressed.
const PRESSED: i8 = 1;
/// Anything goes.
const ANY_RATE: (f64, f64) = (0.0, f64::INFINITY);

/// The newest depth image, and the camera's figures that go with it.
#[derive(Clone, Debug, Default)]
pub(super) struct NewestDepth {
    frame: Arc<Mutex<Option<DepthFrame>>>,
    matrix: Arc<Mutex<Option<[f64; 9]>>>,
    pub(super) watcher: Arc<Watcher>,
    /// Where the camera's frame is, among all others.
    pub(super) frames: Arc<Mutex<Frames>>,
    /// Whether the pose comes from these images, and not from a tracker.
    pub(super) is_source: Arc<AtomicBool>,
}

/// Sees every depth image as it comes, in the thread that receives it: must be quick.
pub type DepthWatcher = Box<dyn Fn(&DepthFrame) + Send + Sync>;

/// Who sees every depth image; nobody at first.
#[derive(Default)]
pub(super) struct Watcher(pub(super) OnceLock<DepthWatcher>);

impl std::fmt::Debug for Watcher {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        formatter.debug_tuple("Watcher").field(&self.0.get().is_some()).finish()
    }
}

impl NewestDepth {
    fn put(&self, mut frame: DepthFrame) {
        frame.camera_matrix = *self.matrix.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(watcher) = self.watcher.0.get() {
            watcher(&frame);
        }
        *self.frame.lock().unwrap_or_else(PoisonError::into_inner) = Some(frame);
    }

    pub(super) fn take(&self) -> Option<DepthFrame> {
        self.frame.lock().unwrap_or_else(PoisonError::into_inner).take()
    }

    fn calibrate(&self, matrix: [f64; 9]) {
        *self.matrix.lock().unwrap_or_else(PoisonError::into_inner) = Some(matrix);
    }
}

fn need(topic: &'static str, queue: usize, expected_hertz: (f64, f64), required: bool) -> TopicNeed {
    TopicNeed { topic, queue, expected_hertz, required }
}

pub(super) fn subscribe(sink: &Sink, depth: &NewestDepth) -> Result<Vec<Subscription>, RosError> {
    let mut all = Vec::new();
    for (side, endpoint, collision, cuff) in [
        (
            Side::Left,
            "/robot/limb/left/endpoint_state",
            "/robot/limb/left/collision_detection_state",
            "/robot/digital_io/left_lower_cuff/state",
        ),
        (
            Side::Right,
            "/robot/limb/right/endpoint_state",
            "/robot/limb/right/collision_detection_state",
            "/robot/digital_io/right_lower_cuff/state",
        ),
    ] {
        let decode = move |message| Decoded::Input(Input::Endpoint(decode::endpoint(side, &message)));
        all.push(Subscription::new::<baxter_core_msgs::EndpointState>(
            need(endpoint, QUEUE, HUNDRED_HERTZ, true),
            sink,
            decode,
        )?);
        let decode = move |message: baxter_core_msgs::CollisionDetectionState| {
            Decoded::Input(Input::Collision { side, active: message.collision_state })
        };
        all.push(Subscription::new(need(collision, QUEUE, ANY_RATE, false), sink, decode)?);
        // The robot repeats the state at 100 Hz: only what changes is news.
        let squeezed = AtomicBool::new(false);
        let decode = move |message: baxter_core_msgs::DigitalIOState| {
            let now = message.state == PRESSED;
            let changed = squeezed.swap(now, Ordering::Relaxed) != now;
            if changed { Decoded::Input(Input::Cuff { side, squeezed: now }) } else { Decoded::Kept }
        };
        all.push(Subscription::new(need(cuff, QUEUE, ANY_RATE, false), sink, decode)?);
    }
    let decode = |message: sensor_msgs::JointState| {
        decode::joints(&message).map_or(Decoded::Kept, |sample| Decoded::Input(Input::Joints(sample)))
    };
    all.push(Subscription::new(need("/robot/joint_states", QUEUE, JOINT_HERTZ, true), sink, decode)?);
    let decode = |message: AnyAssemblyState| {
        decode::robot_state(&message, now()).map_or(Decoded::Unusable, |state| Decoded::Input(Input::Robot(state)))
    };
    let state = Subscription::new(need("/robot/state", QUEUE, (5.0, 125.0), true), sink, decode)?;
    all.push(state.reading(AnyAssemblyState::digests()));
    all.extend(subscribe_camera(sink, depth)?);
    Ok(all)
}

/// Listens to what other nodes say of themselves.
pub(super) fn subscribe_diagnoses(sink: &Sink, known: &Diagnoses, own: String) -> Result<Subscription, RosError> {
    let known = known.clone();
    let decode = move |message: diagnostic_msgs::DiagnosticArray| {
        known.take(now(), &own, message);
        Decoded::Kept
    };
    Subscription::new(need(diagnoses::TOPIC, QUEUE, ANY_RATE, false), sink, decode)
}

fn subscribe_camera(sink: &Sink, depth: &NewestDepth) -> Result<Vec<Subscription>, RosError> {
    let newest = depth.clone();
    let image = move |message: sensor_msgs::Image| match decode::depth(message) {
        Some(frame) => {
            newest.put(frame);
            Decoded::Kept
        }
        None => Decoded::Unusable,
    };
    let newest = depth.clone();
    let information = move |message: sensor_msgs::CameraInfo| {
        newest.calibrate(message.K);
        Decoded::Kept
    };
    let skeletons = Arc::new(Mutex::new(Skeleton::default()));
    let transforms = |is_static: bool| {
        let (skeletons, depth) = (Arc::clone(&skeletons), depth.clone());
        move |message: tf2_msgs::TFMessage| {
            depth.frames.lock().unwrap_or_else(PoisonError::into_inner).take(&message.transforms, is_static);
            let pose = skeletons.lock().unwrap_or_else(PoisonError::into_inner).take(&message.transforms);
            let pose = pose.filter(|_| !depth.is_source.load(Ordering::SeqCst));
            pose.map_or(Decoded::Kept, |pose| Decoded::Input(Input::Body(pose)))
        }
    };
    Ok(vec![
        Subscription::new(need("/camera/depth/image_raw", 1, THIRTY_HERTZ, false), sink, image)?,
        Subscription::new(need("/camera/depth/camera_info", 1, THIRTY_HERTZ, false), sink, information)?,
        Subscription::new(need("/tf", 64, ANY_RATE, false), sink, transforms(false))?,
        Subscription::new(need("/tf_static", 64, ANY_RATE, false), sink, transforms(true))?.said_once(),
    ])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_newest_image_wins_and_is_taken_once() {
        let depth = NewestDepth::default();
        for width in [1, 2, 3] {
            depth.put(DepthFrame { width, ..DepthFrame::default() });
        }
        assert_eq!(depth.take().map(|frame| frame.width), Some(3));
        assert_eq!(depth.take(), None);
    }
}
