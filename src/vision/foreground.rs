//! What of a depth image is the person below the head: more depends on this than on the trees.
//!
//! Three rules: nearer than the empty scene, not deeper than the neck by more than an arm's reach, and no head: what is
//! nearer than the neck inside a cylinder about it. The thesis cut everything nearer than the neck, which loses raised hands.
//! Lap and chair that remain are for the trees' class `other`.

use super::camera::{CameraError, Intrinsics};
use super::depth::{DepthError, DepthImage, LARGEST_SIDE};
use super::probe::{BACKGROUND, ProbeImage};
use crate::geometry::{Finite, Point};
use serde::{Deserialize, Serialize};
use thiserror::Error;

/// The person is nearer than the empty scene by at least this, in millimetres.
const EMPTY_MARGIN: u16 = 30;
/// Nothing of the person is deeper than the neck by more, in metres: a hanging arm's hand is about 0.75 m below it, further
/// where the camera looks aslant. This far only where the empty scene takes chair and floor away.
const BELOW_NECK: f64 = 0.85;
/// The same without an image of the empty scene: seat and floor begin there.
const BELOW_NECK_ALONE: f64 = 0.60;
/// The head begins this far above the neck, in metres: the shoulder that is nearer to a camera that looks aslant stays.
const ABOVE_NECK: f64 = 0.05;
/// Radius of the cylinder about the neck in which everything above is head, in metres.
const HEAD_RADIUS: f64 = 0.16;
/// How far from the neck's line a leaning head reaches, in metres.
const HEAD_REACH: f64 = 0.28;
/// Neighbouring pixels of a head differ by no more, in millimetres; a hand before it is further away.
const HEAD_STEP: u16 = 25;
/// Nearest reading that counts, in millimetres: nearer ones are noise in an Xtion.
const NEAREST: u16 = 400;

/// Which way a person faces in the image.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Facing {
    /// Towards the lower edge: the camera is ahead of the person or above. The person's left is at large x.
    #[default]
    LowerEdge,
    /// Towards the upper edge: the camera is behind the person, as on the robot's head. The person's left is at small x.
    UpperEdge,
}

impl Facing {
    /// Both ways.
    pub const BOTH: [Self; 2] = [Self::LowerEdge, Self::UpperEdge];
}

/// What is known about a view besides its pixels.
#[derive(Clone, Copy, Debug)]
pub struct View<'a> {
    /// The camera.
    pub camera: Intrinsics,
    /// The neck's root in the camera frame, in metres.
    pub neck: Point,
    /// The scene without the person, of the same size.
    pub empty: Option<&'a DepthImage>,
    /// Which way the person faces.
    pub facing: Facing,
}

/// Why a view cannot be used.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum ViewError {
    /// The image.
    #[error(transparent)]
    Depth(#[from] DepthError),
    /// The camera.
    #[error(transparent)]
    Camera(#[from] CameraError),
    /// The neck is nowhere a camera could see it.
    #[error(
        "the neck at ({x}, {y}, {z}) m in the camera frame: measure the distance from the camera to the neck again"
    )]
    Neck {
        /// Right.
        x: f64,
        /// Down.
        y: f64,
        /// Forward.
        z: f64,
    },
}

/// A foreground pixel in the probe image's own columns and rows.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Pixel {
    /// Column.
    pub column: u16,
    /// Row.
    pub row: u16,
    /// Depth in millimetres.
    pub depth: u16,
}

impl View<'_> {
    /// Checks that everything fits an image.
    ///
    /// # Errors
    /// The first thing that does not.
    pub fn check(&self, image: &DepthImage) -> Result<(), ViewError> {
        self.camera.check()?;
        image.check_readings()?;
        if let Some(empty) = self.empty {
            image.check_same_size(empty)?;
        }
        let neck = self.neck;
        if !neck.is_finite() || !(0.2..8.0).contains(&neck.z) {
            return Err(ViewError::Neck { x: neck.x, y: neck.y, z: neck.z });
        }
        Ok(())
    }

    /// The camera of the probe image: turned by half a turn where the person faces the upper edge.
    #[must_use]
    pub fn probe_camera(&self, width: usize, height: usize) -> Intrinsics {
        match self.facing {
            Facing::LowerEdge => self.camera,
            Facing::UpperEdge => Intrinsics {
                cx: width as f64 - 1.0 - self.camera.cx,
                cy: height as f64 - 1.0 - self.camera.cy,
                ..self.camera
            },
        }
    }

    /// The neck in the probe image's camera frame, turned as its pixels are.
    #[must_use]
    pub fn probe_neck(&self) -> Point {
        match self.facing {
            Facing::LowerEdge => self.neck,
            Facing::UpperEdge => Point::new(-self.neck.x, -self.neck.y, self.neck.z),
        }
    }

    /// Fills the probe image with the foreground, turned so that the person faces the lower edge, and lists its pixels row by row.
    ///
    /// # Errors
    /// As [`View::check`].
    pub fn extract(
        &self,
        image: &DepthImage,
        probe: &mut ProbeImage,
        pixels: &mut Vec<Pixel>,
    ) -> Result<(), ViewError> {
        self.check(image)?;
        let (width, height) = (image.width(), image.height());
        probe.reset(width, height);
        pixels.clear();
        let turned = self.facing == Facing::UpperEdge;
        let rules = Rules::of(self, width, height);
        for row in 0..height {
            let source = if turned { height - 1 - row } else { row };
            let start = source * width;
            let readings = image.millimetres().get(start..start + width).unwrap_or(&[]);
            let behind = self.empty.and_then(|empty| empty.millimetres().get(start..start + width));
            let behind = behind.unwrap_or(&NOTHING_BEHIND);
            let pairs = readings.iter().zip(behind);
            let target = probe.row_mut(row);
            let nearest = if turned { rules.sift(pairs.rev(), target) } else { rules.sift(pairs, target) };
            if nearest < rules.head_bottom {
                rules.take_head(row, target, pixels);
            }
        }
        rules.remove_head(probe, pixels);
        list(probe, pixels);
        probe.measure_from_neck(pixels, &rules.camera, &rules.neck);
        Ok(())
    }
}

/// Lists the foreground's pixels row by row.
fn list(probe: &ProbeImage, pixels: &mut Vec<Pixel>) {
    pixels.clear();
    let (width, stride) = (probe.width(), probe.stride());
    for (row, values) in probe.values().chunks(stride).skip(1).take(probe.height()).enumerate() {
        let values = values.get(1..=width).unwrap_or(&[]);
        for (block, values) in values.chunks(BLOCK).enumerate() {
            // Most of an image is background: whole blocks are passed over.
            if values.iter().fold(BACKGROUND, |least, depth| least.min(*depth)) == BACKGROUND {
                continue;
            }
            for (column, depth) in values.iter().enumerate().filter(|(_, depth)| **depth < BACKGROUND) {
                pixels.push(pixel(block * BLOCK + column, row, *depth));
            }
        }
    }
}

#[expect(clippy::cast_possible_truncation, reason = "images have at most 4096 pixels a side")]
pub(super) const fn pixel(column: usize, row: usize, depth: u16) -> Pixel {
    Pixel { column: column as u16, row: row as u16, depth }
}

/// Pixels of a row that are looked at together.
const BLOCK: usize = 16;
/// The row of a scene that has not been seen empty: no reading.
static NOTHING_BEHIND: [u16; LARGEST_SIDE] = [0; LARGEST_SIDE];

/// The rules in millimetres, once for all pixels of an image.
struct Rules {
    /// Camera and neck of the probe image.
    camera: Intrinsics,
    neck: Point,
    deepest: u16,
    head_bottom: u16,
}

impl Rules {
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "the neck's depth has been checked")]
    fn of(view: &View<'_>, width: usize, height: usize) -> Self {
        let below = if view.empty.is_some() { BELOW_NECK } else { BELOW_NECK_ALONE };
        Self {
            camera: view.probe_camera(width, height),
            neck: view.probe_neck(),
            deepest: ((view.neck.z + below) * 1000.0) as u16,
            head_bottom: ((view.neck.z - ABOVE_NECK) * 1000.0) as u16,
        }
    }

    /// Fills a row with what is kept of its readings (with what is read there without the person), the rest with background;
    /// gives the nearest depth. Nothing here leaves the loop early, so that the compiler may make vector instructions of it.
    #[inline]
    fn sift<'a>(&self, readings: impl Iterator<Item = (&'a u16, &'a u16)>, into: &mut [u16]) -> u16 {
        let mut nearest = BACKGROUND;
        for (kept, (depth, empty)) in into.iter_mut().zip(readings) {
            // Where nothing was read without the person, everything stands before it.
            let limit = empty.wrapping_sub(1);
            let stays = *depth >= NEAREST && *depth <= self.deepest && depth.saturating_add(EMPTY_MARGIN) <= limit;
            *kept = if stays { (*depth).min(BACKGROUND) } else { BACKGROUND };
            nearest = nearest.min(*kept);
        }
        nearest
    }

    /// Moves a row's pixels that lie above the neck's end and about its line to the head's.
    fn take_head(&self, row: usize, values: &mut [u16], head: &mut Vec<Pixel>) {
        for (column, value) in values.iter_mut().enumerate().filter(|(_, value)| **value < self.head_bottom) {
            if self.neck_distance(column, row, *value) <= HEAD_RADIUS {
                head.push(pixel(column, row, *value));
                *value = BACKGROUND;
            }
        }
    }

    /// Distance from the line through the neck along the optical axis, in metres.
    fn neck_distance(&self, column: usize, row: usize, depth: u16) -> f64 {
        let point = self.camera.point(column as f64, row as f64, f64::from(depth) / 1000.0);
        (point.x - self.neck.x).hypot(point.y - self.neck.y)
    }

    /// Removes what hangs together with the pixels in `head`: the head leans, and the camera may look aslant.
    fn remove_head(&self, probe: &mut ProbeImage, head: &mut Vec<Pixel>) {
        while let Some(at) = head.pop() {
            let (column, row) = (usize::from(at.column), usize::from(at.row));
            for (column, row) in
                [(column + 1, row), (column.wrapping_sub(1), row), (column, row + 1), (column, row.wrapping_sub(1))]
            {
                let Some(depth) = probe.foreground_at(column, row) else { continue };
                let joined = depth.abs_diff(at.depth) <= HEAD_STEP && depth < self.head_bottom;
                if joined && self.neck_distance(column, row, depth) <= HEAD_REACH {
                    probe.set(column, row, BACKGROUND);
                    head.push(pixel(column, row, depth));
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn view() -> View<'static> {
        View {
            camera: Intrinsics { fx: 100.0, fy: 100.0, cx: 20.0, cy: 10.0 },
            neck: Point::new(0.0, 0.0, 1.0),
            empty: None,
            facing: Facing::LowerEdge,
        }
    }

    fn extract(view: &View<'_>, image: &DepthImage) -> Result<Vec<Pixel>, ViewError> {
        let (mut probe, mut pixels) = (ProbeImage::default(), Vec::new());
        view.extract(image, &mut probe, &mut pixels).map(|()| pixels)
    }

    fn image(set: &[(usize, usize, u16)]) -> DepthImage {
        let mut image = DepthImage::new(41, 21, vec![0; 41 * 21]).unwrap();
        for (column, row, depth) in set {
            image.millimetres_mut()[row * 41 + column] = *depth;
        }
        image
    }

    #[test]
    fn the_head_goes_and_a_raised_hand_stays() {
        let found = extract(&view(), &image(&[(20, 10, 800), (40, 10, 900), (20, 12, 1050), (3, 3, 1700)])).unwrap();
        assert_eq!(found, [Pixel { column: 40, row: 10, depth: 900 }, Pixel { column: 20, row: 12, depth: 1050 }]);
    }

    #[test]
    fn a_head_that_leans_out_of_its_cylinder_goes_whole_and_a_hand_before_it_stays() {
        let view = View { camera: Intrinsics { fx: 50.0, fy: 50.0, cx: 20.0, cy: 10.0 }, ..view() };
        let mut set: Vec<(usize, usize, u16)> = (20..35).map(|column| (column, 10, 850)).collect();
        set.extend([(34, 11, 700), (20, 14, 1100)]);
        let hand = Pixel { column: 34, row: 11, depth: 700 };
        let chest = Pixel { column: 20, row: 14, depth: 1100 };
        assert_eq!(extract(&view, &image(&set)).unwrap(), [hand, chest]);
        // With a gap outside the cylinder, what lies beyond does not hang together with the head.
        set.retain(|(column, ..)| *column != 31);
        let found = extract(&view, &image(&set)).unwrap();
        assert_eq!(found.iter().map(|pixel| pixel.column).collect::<Vec<_>>(), [32, 33, 34, 34, 20]);
    }

    #[test]
    fn without_an_empty_scene_seat_and_floor_are_cut_off_and_with_one_a_hanging_hand_stays() {
        let seen = image(&[(3, 3, 1750)]);
        assert!(extract(&view(), &seen).unwrap().is_empty());
        let empty = image(&[(3, 3, 2000)]);
        assert_eq!(extract(&View { empty: Some(&empty), ..view() }, &seen).unwrap().len(), 1);
    }

    #[test]
    fn what_was_there_without_the_person_goes() {
        let empty = image(&[(5, 5, 1200), (6, 5, 1200)]);
        let seen = image(&[(5, 5, 1195), (6, 5, 1100), (7, 5, 1100)]);
        let found = extract(&View { empty: Some(&empty), ..view() }, &seen).unwrap();
        assert_eq!(found.iter().map(|pixel| pixel.column).collect::<Vec<_>>(), [6, 7]);
    }

    #[test]
    fn a_person_who_faces_the_upper_edge_is_turned_and_a_point_keeps_its_place_but_for_signs() {
        let view = View { facing: Facing::UpperEdge, ..view() };
        let found = extract(&view, &image(&[(5, 4, 1200)])).unwrap();
        assert_eq!(found, [Pixel { column: 35, row: 16, depth: 1200 }]);
        let turned = view.probe_camera(41, 21).point(35.0, 16.0, 1.2);
        let straight = view.camera.point(5.0, 4.0, 1.2);
        assert!((turned.x + straight.x).abs() < 1e-12 && (turned.y + straight.y).abs() < 1e-12);
    }

    #[test]
    fn a_blind_image_a_wrong_empty_scene_and_a_neck_out_of_sight_are_refused() {
        assert_eq!(extract(&view(), &image(&[])), Err(ViewError::Depth(DepthError::Blind)));
        let small = DepthImage::new(2, 2, vec![1; 4]).unwrap();
        let seen = image(&[(1, 1, 1000)]);
        assert!(matches!(
            extract(&View { empty: Some(&small), ..view() }, &seen),
            Err(ViewError::Depth(DepthError::Mismatch { .. }))
        ));
        for depth in [f64::NAN, -1.0, 0.0, 20.0] {
            let view = View { neck: Point::new(0.0, 0.0, depth), ..view() };
            assert!(matches!(extract(&view, &seen), Err(ViewError::Neck { .. })));
        }
    }
}
