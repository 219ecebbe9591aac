//! The pinhole camera: where a pixel with a depth lies in space, and where a point appears in the image.
//!
//! Camera frame: x right, y down, z forward along the optical axis, metres; pixel centres have whole-number coordinates
//! (ROS REP 104). Lens distortion is not modelled: the Xtion's driver publishes none.

use crate::geometry::Point;
use serde::{Deserialize, Serialize};
use thiserror::Error;

/// A pinhole camera's numbers, all in pixels.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Intrinsics {
    /// Focal length along x.
    pub fx: f64,
    /// Focal length along y.
    pub fy: f64,
    /// Column of the optical axis.
    pub cx: f64,
    /// Row of the optical axis.
    pub cy: f64,
}

/// Why a camera's numbers cannot be used.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum CameraError {
    /// A number is not finite or not plausible.
    #[error("the camera's {name} is {value}: check camera_info or the calibration in the profile")]
    Number {
        /// Which.
        name: &'static str,
        /// Its value.
        value: f64,
    },
}

impl Default for Intrinsics {
    /// An Xtion at 640 x 480 without calibration, in the colour frame (openni2's defaults with the common focal length).
    fn default() -> Self {
        Self { fx: 545.0, fy: 545.0, cx: 319.5, cy: 239.5 }
    }
}

impl Intrinsics {
    /// Checks the numbers.
    ///
    /// # Errors
    /// [`CameraError::Number`] with the first that no camera has.
    pub fn check(&self) -> Result<(), CameraError> {
        for (name, value, lowest, highest) in [
            ("fx", self.fx, 10.0, 20_000.0),
            ("fy", self.fy, 10.0, 20_000.0),
            ("cx", self.cx, -10_000.0, 10_000.0),
            ("cy", self.cy, -10_000.0, 10_000.0),
        ] {
            if !(lowest..=highest).contains(&value) {
                return Err(CameraError::Number { name, value });
            }
        }
        Ok(())
    }

    /// The numbers of a ROS `camera_info`, from its row-major matrix `K`.
    ///
    /// # Errors
    /// As [`Intrinsics::check`].
    pub fn from_matrix(matrix: &[f64; 9]) -> Result<Self, CameraError> {
        let [fx, _, cx, _, fy, cy, ..] = *matrix;
        let camera = Self { fx, fy, cx, cy };
        camera.check()?;
        Ok(camera)
    }

    /// The camera that sees a mirrored image of the given width the right way round.
    #[must_use]
    pub fn mirrored(self, width: usize) -> Self {
        Self { cx: width as f64 - 1.0 - self.cx, ..self }
    }

    /// The point at a pixel and a depth in metres along the optical axis.
    #[must_use]
    pub fn point(&self, column: f64, row: f64, depth: f64) -> Point {
        Point::new((column - self.cx) / self.fx * depth, (row - self.cy) / self.fy * depth, depth)
    }

    /// Column and row at which a point appears; `None` where it is not in front of the camera.
    #[must_use]
    pub fn pixel(&self, point: &Point) -> Option<(f64, f64)> {
        (point.z > 1e-6).then(|| (point.x / point.z * self.fx + self.cx, point.y / point.z * self.fy + self.cy))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn numbers_that_no_camera_has_are_refused_by_name() {
        let error = Intrinsics { fy: f64::NAN, ..Intrinsics::default() }.check().unwrap_err();
        assert!(matches!(error, CameraError::Number { name: "fy", .. }));
        assert!(Intrinsics::from_matrix(&[0.0; 9]).is_err());
        assert!(Intrinsics::default().check().is_ok());
    }

    #[test]
    fn a_point_behind_the_camera_appears_nowhere() {
        assert_eq!(Intrinsics::default().pixel(&Point::new(0.1, 0.1, -1.0)), None);
    }

    proptest! {
        #[test]
        fn a_pixel_s_point_appears_at_that_pixel(column in 0.0..640.0_f64, row in 0.0..480.0_f64, depth in 0.3..5.0_f64) {
            let camera = Intrinsics::default();
            let (x, y) = camera.pixel(&camera.point(column, row, depth)).unwrap();
            prop_assert!((x - column).abs() < 1e-9 && (y - row).abs() < 1e-9);
        }
    }
}
