//! The simulated depth camera's side of the wire: images, figures and place, as the driver of an Xtion publishes them.
//!
//! Knows no person and no renderer: it asks for a picture 30 times a second, and only while somebody looks.

use crate::geometry::Pose;
use crate::ros::encode;
use crate::ros::error::RosError;
use crate::ros::link::advertise;
use crate::ros::message::{sensor_msgs, tf2_msgs};
use crate::ros::monitor::now;
use crate::time::Stamp;
use nalgebra::{Translation3, UnitQuaternion};
use rosrust::Publisher;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread;
use std::time::{Duration, Instant};

/// Time between two pictures: an Xtion's 30 Hz.
const PERIOD: Duration = Duration::from_nanos(1_000_000_000 / 30);
/// The frames of a driver's camera, from its body to its lens.
const FRAMES: [&str; 3] = ["camera_link", "camera_depth_frame", "camera_depth_optical_frame"];

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
    /// The pose of its optical frame (x right, y down, z forward) in `base`; it stays.
    fn mount(&self) -> Pose;
    /// The picture at this moment.
    fn picture(&mut self) -> Option<DepthPicture>;
}

struct Topics {
    image: Publisher<sensor_msgs::Image>,
    information: Publisher<sensor_msgs::CameraInfo>,
}

/// Starts the camera's thread, which ends soon after `ended` is set. The publisher that comes back keeps the place latched.
pub(super) fn start(
    camera: Box<dyn SimulatedCamera>,
    ended: &Arc<AtomicBool>,
) -> Result<Publisher<tf2_msgs::TFMessage>, RosError> {
    let topics = Topics {
        image: advertise("/camera/depth/image_raw", 1)?,
        information: advertise("/camera/depth/camera_info", 1)?,
    };
    let mut place = advertise("/tf_static", 1)?;
    place.set_latching(true);
    place.send(mounting(now(), &camera.mount())).map_err(|error| RosError::registration("/tf_static", error))?;
    let ended = Arc::clone(ended);
    thread::Builder::new()
        .name("depth-camera".into())
        .spawn(move || take_pictures(camera, &topics, &ended))
        .map_err(|error| RosError::thread("the depth camera", error))?;
    Ok(place)
}

fn take_pictures(mut camera: Box<dyn SimulatedCamera>, topics: &Topics, ended: &AtomicBool) {
    let mut next = Instant::now();
    while !ended.load(Ordering::SeqCst) {
        // As a real camera's driver: streams start only while someone subscribes.
        if topics.image.subscriber_count() > 0 || topics.information.subscriber_count() > 0 {
            let stamp = now();
            if let Some(picture) = camera.picture() {
                let (picture, figures) = messages(stamp, &picture);
                // A picture that a listener does not take is lost; the next one comes.
                let _ = topics.information.send(figures);
                let _ = topics.image.send(picture);
            }
        }
        next += PERIOD;
        match next.checked_duration_since(Instant::now()) {
            Some(rest) => thread::sleep(rest),
            None => next = Instant::now(),
        }
    }
}

/// The camera's place as three static transforms: `base` to the body, the body to the lens, and the lens' turn from x
/// forward to z forward (ROS REP 103).
fn mounting(stamp: Stamp, mount: &Pose) -> tf2_msgs::TFMessage {
    let [link, depth, optical] = FRAMES;
    let quarter = std::f64::consts::FRAC_PI_2;
    let turn = Pose::from_parts(Translation3::identity(), UnitQuaternion::from_euler_angles(-quarter, 0.0, -quarter));
    let transforms = vec![
        encode::transform(stamp, encode::BASE, link, &(mount * turn.inverse())),
        encode::transform(stamp, link, depth, &Pose::identity()),
        encode::transform(stamp, depth, optical, &turn),
    ];
    tf2_msgs::TFMessage { transforms }
}

#[expect(non_snake_case, reason = "the message's own field names")]
fn messages(stamp: Stamp, picture: &DepthPicture) -> (sensor_msgs::Image, sensor_msgs::CameraInfo) {
    let [_, _, frame] = FRAMES;
    let header = encode::header(stamp, frame);
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
    use crate::geometry::{Point, Vector};
    use crate::ros::decode;

    #[test]
    fn a_picture_goes_out_as_a_camera_driver_sends_it_and_is_read_again() {
        let picture = DepthPicture { size: (4, 2), millimetres: vec![1000; 8], intrinsics: [570.0, 571.0, 1.5, 0.5] };
        let (image, figures) = messages(Stamp::from_nanoseconds(3), &picture);
        assert_eq!((image.data.len(), figures.K[4]), (16, 571.0));
        let read = decode::depth(image).unwrap();
        assert_eq!((read.encoding.as_str(), read.frame.as_str()), ("16UC1", "camera_depth_optical_frame"));
    }

    #[test]
    fn the_static_transforms_lead_from_the_base_to_the_lens() {
        let mount = Pose::new(Vector::new(0.25, 0.1, 0.95), Vector::new(0.3, -2.0, 0.4));
        let message = mounting(Stamp::ZERO, &mount);
        let chain: Vec<_> = message
            .transforms
            .iter()
            .map(|step| (step.header.frame_id.as_str(), step.child_frame_id.as_str()))
            .collect();
        assert_eq!(
            chain,
            [
                ("base", "camera_link"),
                ("camera_link", "camera_depth_frame"),
                ("camera_depth_frame", "camera_depth_optical_frame")
            ]
        );
        let total = message.transforms.iter().fold(Pose::identity(), |all, step| {
            let (p, q) = (&step.transform.translation, &step.transform.rotation);
            let turn = UnitQuaternion::new_normalize(nalgebra::Quaternion::new(q.w, q.x, q.y, q.z));
            all * Pose::from_parts(Translation3::new(p.x, p.y, p.z), turn)
        });
        let ahead = Point::new(0.1, 0.2, 1.0);
        assert!((total * ahead - mount * ahead).norm() < 1e-12);
    }
}
