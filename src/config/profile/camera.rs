//! What a profile says about the depth camera: with it, the person's pose comes from depth images instead of a tracker.

use crate::geometry::{Point, Pose};
use crate::vision::Facing;
use nalgebra::{Quaternion, Translation3, UnitQuaternion};
use serde::{Deserialize, Serialize};
use std::path::PathBuf;

/// The depth camera at this person's place.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CameraSetup {
    /// The root of the person's neck in `base`, in metres, measured before the trial.
    pub neck_metres: [f64; 3],
    /// Which way the person faces in the image; towards the upper edge for a camera on the robot's head.
    #[serde(default = "behind")]
    pub facing: Facing,
    /// The scene without the person: a 16-bit PNG in millimetres, relative to the profile. It makes the foreground surer.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub empty: Option<PathBuf>,
    /// The camera's calibrated place; without it `/tf` and `/tf_static` tell.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub place: Option<CameraPlace>,
}

/// The pose of the camera's optical frame (x right, y down, z forward) in `base`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CameraPlace {
    /// The lens, in metres.
    pub position_metres: [f64; 3],
    /// The turn as a quaternion: x, y, z, w.
    pub quaternion_xyzw: [f64; 4],
}

const fn behind() -> Facing {
    Facing::UpperEdge
}

impl CameraSetup {
    /// The neck in `base`.
    #[must_use]
    pub fn neck(&self) -> Point {
        Point::from(self.neck_metres)
    }

    /// The first value that cannot be used: its key and why.
    pub(super) fn check(&self) -> Result<(), (String, String)> {
        let refuse = |key: &str, reason: &str| Err((format!("camera.{key}"), reason.to_owned()));
        if !self.neck_metres.iter().all(|value| value.is_finite() && value.abs() < 3.0) {
            return refuse("neck_metres", "needs three numbers within 3 m of the robot's base");
        }
        let Some(place) = self.place else { return Ok(()) };
        if !place.position_metres.iter().all(|value| value.is_finite() && value.abs() < 10.0) {
            return refuse("place.position_metres", "needs three numbers within 10 m of the robot's base");
        }
        let length = place.quaternion_xyzw.iter().map(|value| value * value).sum::<f64>().sqrt();
        if (length - 1.0).abs() < 0.01 { Ok(()) } else { refuse("place.quaternion_xyzw", "needs length 1") }
    }
}

impl CameraPlace {
    /// As a pose.
    #[must_use]
    pub fn pose(&self) -> Pose {
        let turn = UnitQuaternion::new_normalize(Quaternion::from(self.quaternion_xyzw));
        Pose::from_parts(Translation3::from(self.position_metres), turn)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn setup() -> CameraSetup {
        let place = CameraPlace { position_metres: [0.2, 0.0, 0.9], quaternion_xyzw: [0.0, 0.0, 0.0, 1.0] };
        CameraSetup { neck_metres: [0.8, 0.0, 0.25], facing: behind(), empty: None, place: Some(place) }
    }

    #[test]
    fn a_neck_far_away_and_a_turn_without_length_are_refused_by_key() {
        assert_eq!(setup().check(), Ok(()));
        let far = CameraSetup { neck_metres: [f64::NAN, 0.0, 0.0], ..setup() };
        assert_eq!(far.check().unwrap_err().0, "camera.neck_metres");
        let mut flat = setup();
        flat.place.as_mut().unwrap().quaternion_xyzw = [0.0; 4];
        assert_eq!(flat.check().unwrap_err().0, "camera.place.quaternion_xyzw");
        let mut lost = setup();
        lost.place.as_mut().unwrap().position_metres = [0.0, 1e9, 0.0];
        assert_eq!(lost.check().unwrap_err().0, "camera.place.position_metres");
    }

    #[test]
    fn what_is_left_out_means_a_camera_behind_the_person_whose_place_tf_tells() {
        let setup: CameraSetup = toml::from_str("neck_metres = [0.8, 0.0, 0.25]").unwrap();
        assert_eq!((setup.facing, setup.place), (Facing::UpperEdge, None));
        assert!(toml::from_str::<CameraSetup>("neck = [0.8, 0.0, 0.25]").is_err());
    }
}
