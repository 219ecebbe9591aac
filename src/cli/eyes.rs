//! The person's pose from depth images, on a thread of its own: the newest image wins, and the supervisor's beat never waits.
//!
//! What keeps it from seeing (no camera figures, no place of the camera, a blind image) is told once, and again when it changes.

use super::exit::Failure;
use super::images::read_depth;
use crate::body::{BodyPose, Evidence, JointEstimate};
use crate::config::{CameraSetup, LoadedProfile};
use crate::geometry::Pose;
use crate::ros::{DepthFrame, RobotLink};
use crate::supervisor::{Input, LinkEvent};
use crate::vision::{DepthImage, Forest, Intrinsics, PoseFinder, View, generic};
use nalgebra::Matrix3;
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread::{self, JoinHandle};
use std::time::Duration;

/// How often a new image is looked for: a small part of a frame's 33 ms.
const LOOK: Duration = Duration::from_millis(4);
/// So many images may come before the camera's figures do: the two are published beside each other, and one is first.
const IMAGES_BEFORE_FIGURES: u32 = 30;
/// An operator measures the neck this well, in metres.
const NECK_DEVIATION: f64 = 0.02;

/// The thread. Dropping it ends it.
pub(super) struct Eyes {
    ended: Arc<AtomicBool>,
    thread: Option<JoinHandle<()>>,
}

/// What finds a person in images.
pub(super) struct Sight {
    finder: PoseFinder,
    setup: CameraSetup,
    empty: Option<DepthImage>,
    trouble: String,
    /// Images in a row that came without the camera's figures.
    without_figures: u32,
}

impl Sight {
    /// As a profile says; `None` where it speaks of no camera.
    ///
    /// # Errors
    /// Where its forest or empty scene cannot be read.
    pub(super) fn of(person: &LoadedProfile) -> Result<Option<Self>, Failure> {
        let Some(setup) = person.profile.camera.clone() else { return Ok(None) };
        let beside = |file: &Path| person.path.parent().unwrap_or_else(|| Path::new(".")).join(file);
        let empty = setup.empty.as_deref().map(|file| read_depth(&beside(file))).transpose();
        let empty = empty.map_err(Failure::Configuration)?;
        let forest = match person.profile.tree.as_deref() {
            Some(file) => forest_in(&beside(file))?,
            None => generic::forest().map_err(Failure::fault)?,
        };
        Ok(Some(Self { finder: PoseFinder::new(forest), setup, empty, trouble: String::new(), without_figures: 0 }))
    }

    /// The person's pose in `base` from an image; `place` tells the camera's from its frame's name.
    ///
    /// # Errors
    /// Why there is none, in words.
    fn see(
        &mut self,
        frame: &DepthFrame,
        place: impl FnOnce(&str) -> Result<Pose, String>,
    ) -> Result<BodyPose, String> {
        let Some([fx, _, cx, _, fy, cy, ..]) = frame.camera_matrix else {
            self.without_figures += 1;
            return Err("depth images come without camera_info: start the camera's driver with its calibration".into());
        };
        self.without_figures = 0;
        let image = frame.image().map_err(|error| error.to_string())?;
        let mount = self.setup.place.map_or_else(|| place(&frame.frame), |place| Ok(place.pose()))?;
        let view = View {
            camera: Intrinsics { fx, fy, cx, cy },
            neck: mount.inverse() * self.setup.neck(),
            empty: self.empty.as_ref(),
            facing: self.setup.facing,
        };
        let joints = self.finder.find(&image, &view).map_err(|error| error.to_string())?;
        let neck = JointEstimate {
            position: self.setup.neck(),
            covariance: Matrix3::identity() * NECK_DEVIATION.powi(2),
            confidence: 1.0,
            evidence: Evidence::Inferred,
        };
        Ok(BodyPose { neck: Some(neck), ..joints.to_base(&mount, frame.stamp) })
    }

    /// What is to be told of an image: a pose, or what keeps from seeing where that is new.
    fn tell(&mut self, seen: Result<BodyPose, String>) -> Option<Input> {
        match seen {
            Ok(pose) => {
                self.trouble.clear();
                Some(Input::Body(pose))
            }
            Err(reason) if reason == self.trouble => None,
            Err(_) if (1..IMAGES_BEFORE_FIGURES).contains(&self.without_figures) => None,
            Err(reason) => {
                self.trouble.clone_from(&reason);
                Some(Input::Link(LinkEvent::CannotSee { reason }))
            }
        }
    }
}

impl Eyes {
    /// Starts to look at what `link` hears; its tracker is heard no more.
    ///
    /// # Errors
    /// Where the system has no thread to give.
    pub(super) fn open(
        mut sight: Sight,
        link: Arc<RobotLink>,
        tell: Arc<dyn Fn(Input) + Send + Sync>,
    ) -> std::io::Result<Self> {
        link.ignore_tracker();
        let ended = Arc::new(AtomicBool::new(false));
        let end = Arc::clone(&ended);
        let look = move || {
            while !end.load(Ordering::SeqCst) {
                let Some(frame) = link.newest_depth() else {
                    thread::sleep(LOOK);
                    continue;
                };
                let seen = sight.see(&frame, |name| link.place_of(name).map_err(|error| error.to_string()));
                if let Some(input) = sight.tell(seen) {
                    tell(input);
                }
            }
        };
        Ok(Self { ended, thread: Some(thread::Builder::new().name("eyes".into()).spawn(look)?) })
    }
}

impl Drop for Eyes {
    fn drop(&mut self) {
        self.ended.store(true, Ordering::SeqCst);
        if let Some(thread) = self.thread.take() {
            // A thread that panicked has nothing more to tell.
            let _ = thread.join();
        }
    }
}

fn forest_in(file: &Path) -> Result<Forest, Failure> {
    let named = |error: &dyn std::fmt::Display| Failure::Configuration(format!("{}: {error}", file.display()));
    let bytes = std::fs::read(file).map_err(|error| named(&error))?;
    Forest::from_bytes(&bytes).map_err(|error| named(&error))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::body::{Joint, Side};
    use crate::sim::camera;
    use crate::sim::person::SimulatedPerson;
    use crate::time::Stamp;
    use crate::vision::Facing;

    fn sight() -> Sight {
        let arms = SimulatedPerson::default().posture();
        let middle = nalgebra::center(&arms.left.shoulder, &arms.right.shoulder);
        let neck_metres = [middle.x, middle.y, middle.z + 0.11];
        let setup = CameraSetup { neck_metres, facing: Facing::UpperEdge, empty: None, place: None };
        Sight {
            finder: PoseFinder::new(generic::forest().unwrap()),
            setup,
            empty: None,
            trouble: String::new(),
            without_figures: 0,
        }
    }

    /// What the camera on the robot's head sends of the simulated person.
    fn frame() -> DepthFrame {
        let person = SimulatedPerson::default();
        let camera = Intrinsics::default();
        let view = camera::view(&person, &person.posture(), &camera, &camera::robot_mount(), 1);
        let depth = view.depth;
        DepthFrame {
            stamp: Stamp::from_nanoseconds(7),
            frame: "camera_depth_optical_frame".into(),
            width: depth.width(),
            height: depth.height(),
            encoding: "16UC1".into(),
            big_endian: false,
            step: depth.width() * 2,
            data: depth.millimetres().iter().flat_map(|reading| reading.to_le_bytes()).collect(),
            camera_matrix: Some([camera.fx, 0.0, camera.cx, 0.0, camera.fy, camera.cy, 0.0, 0.0, 1.0]),
        }
    }

    #[test]
    fn a_person_before_the_robots_camera_is_seen_in_base_with_the_images_own_stamp() {
        let pose = sight().see(&frame(), |_| Ok(camera::robot_mount())).unwrap();
        assert_eq!(pose.stamp, Stamp::from_nanoseconds(7));
        let arms = SimulatedPerson::default().posture();
        let mut seen = 0;
        for side in Side::BOTH {
            let Some(shoulder) = pose.arms.get(side).position(Joint::Shoulder) else { continue };
            let off = (shoulder - arms.get(side).shoulder).norm();
            assert!(off < 0.2, "{side}: {off}");
            seen += 1;
        }
        assert!(seen > 0);
        assert!(pose.neck.is_some());
    }

    #[test]
    fn what_keeps_from_seeing_is_told_once_with_a_remedy_and_a_pose_ends_it() {
        let mut sight = sight();
        let uncalibrated = DepthFrame { camera_matrix: None, ..frame() };
        // The camera's figures may come a little after its first images.
        for _ in 1..IMAGES_BEFORE_FIGURES {
            let unseen = sight.see(&uncalibrated, |_| Ok(Pose::identity()));
            assert_eq!(sight.tell(unseen), None);
        }
        let words = sight.see(&uncalibrated, |_| Ok(Pose::identity())).unwrap_err();
        assert!(words.contains("camera_info"), "{words}");
        assert!(sight.tell(Err(words)).is_some());
        let lost = sight.see(&frame(), |name| Err(format!("nobody says where {name} is")));
        assert_eq!(lost, Err("nobody says where camera_depth_optical_frame is".to_owned()));
        assert!(matches!(sight.tell(lost.clone()), Some(Input::Link(LinkEvent::CannotSee { .. }))));
        assert_eq!(sight.tell(lost.clone()), None);
        assert!(matches!(sight.tell(Ok(BodyPose::default())), Some(Input::Body(_))));
        assert!(sight.tell(lost).is_some());
    }

    #[test]
    fn a_blind_and_a_cut_image_are_refused_in_words() {
        let blind = DepthFrame { data: vec![0; 640 * 480 * 2], ..frame() };
        assert!(sight().see(&blind, |_| Ok(camera::robot_mount())).unwrap_err().contains("single reading"));
        let cut = DepthFrame { data: vec![0; 10], ..frame() };
        assert!(sight().see(&cut, |_| Ok(camera::robot_mount())).unwrap_err().contains("cut short"));
    }
}
