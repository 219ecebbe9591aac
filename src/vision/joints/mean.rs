//! The thesis' own rule for a joint (section 3.2.2): the middle of its part's pixels and the depth there.
//!
//! It finds the middle of the skin that is seen, not the joint's centre, and knows neither elbow nor wrist. Kept to compare with.

use super::Classified;
use super::sampling::Sampling;
use crate::body::{Joint, Side};
use crate::geometry::Point;
use crate::vision::camera::Intrinsics;
use crate::vision::part::Part;

/// Pixels further from the part's middle than this many median distances are outliers.
const OUTLIER_MEDIANS: f64 = 2.5;
/// The depth is that of the part's own pixels this near the mean, in pixels: at the mean itself something else may lie.
const DEPTH_WINDOW: f64 = 6.0;
/// A part of fewer pixels is not seen.
const LEAST_PIXELS: usize = 20;

/// The part that stands for a joint in the thesis; `None` for elbow and wrist.
const fn part_of(joint: Joint) -> Option<Part> {
    match joint {
        Joint::Hand => Some(Part::Hand),
        Joint::Forearm => Some(Part::Forearm),
        Joint::UpperArm => Some(Part::UpperArm),
        Joint::Shoulder => Some(Part::Shoulder),
        Joint::Elbow | Joint::Wrist => None,
    }
}

/// The middle of a part in the camera frame; `None` where it is not seen or the thesis has no such part.
pub(super) fn mean_of_part(
    (pixels, sampling): (&[Classified], Sampling),
    camera: &Intrinsics,
    side: Side,
    joint: Joint,
) -> Option<Point> {
    let label = part_of(joint)?.label(side);
    let own: Vec<[f64; 3]> = pixels
        .iter()
        .filter(|found| found.label == label)
        .map(|found| [f64::from(found.pixel.column), f64::from(found.pixel.row), f64::from(found.pixel.depth) / 1e3])
        .collect();
    if own.len() * sampling.each() < LEAST_PIXELS {
        return None;
    }
    let middle = [median(own.iter().map(|[x, ..]| *x))?, median(own.iter().map(|[_, y, _]| *y))?];
    let distance = |[x, y, _]: &[f64; 3], [to_x, to_y]: [f64; 2]| (x - to_x).hypot(y - to_y);
    let most = OUTLIER_MEDIANS * median(own.iter().map(|pixel| distance(pixel, middle)))?.max(1.0);
    let kept: Vec<[f64; 3]> = own.into_iter().filter(|pixel| distance(pixel, middle) <= most).collect();
    let count = kept.len() as f64;
    let mean = [0, 1].map(|axis| kept.iter().filter_map(|pixel| pixel.get(axis)).sum::<f64>() / count);
    let near = kept.iter().filter(|pixel| distance(pixel, mean) <= DEPTH_WINDOW).map(|[.., depth]| *depth);
    let depth = median(near).or_else(|| median(kept.iter().map(|[.., depth]| *depth)))?;
    let [column, row] = mean;
    Some(camera.point(column, row, depth))
}

fn median(values: impl Iterator<Item = f64>) -> Option<f64> {
    let mut values: Vec<f64> = values.collect();
    let middle = values.len() / 2;
    (!values.is_empty()).then(|| *values.select_nth_unstable_by(middle, f64::total_cmp).1)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::vision::foreground::Pixel;

    const CAMERA: Intrinsics = Intrinsics { fx: 500.0, fy: 500.0, cx: 50.0, cy: 50.0 };

    fn square(label: u8, corner: (u16, u16), side: u16, depth: u16) -> Vec<Classified> {
        (0..side * side)
            .map(|index| Classified {
                pixel: Pixel { column: corner.0 + index % side, row: corner.1 + index / side, depth },
                label,
            })
            .collect()
    }

    #[test]
    fn the_middle_of_a_part_is_found_and_a_few_pixels_far_away_do_not_pull() {
        let label = Part::Hand.label(Side::Left);
        let mut pixels = square(label, (40, 40), 21, 1000);
        pixels.extend(square(label, (300, 300), 5, 2000));
        let found = mean_of_part((&pixels, Sampling::Quarter), &CAMERA, Side::Left, Joint::Hand).unwrap();
        assert!((found - Point::new(0.0, 0.0, 1.0)).norm() < 1e-9, "{found}");
    }

    #[test]
    fn a_part_of_few_pixels_and_a_joint_without_a_part_are_not_seen() {
        let pixels = square(Part::Hand.label(Side::Right), (40, 40), 2, 1000);
        assert_eq!(mean_of_part((&pixels, Sampling::Quarter), &CAMERA, Side::Right, Joint::Hand), None);
        assert_eq!(mean_of_part((&pixels, Sampling::Quarter), &CAMERA, Side::Right, Joint::Elbow), None);
        assert_eq!(mean_of_part((&[], Sampling::Quarter), &CAMERA, Side::Left, Joint::Shoulder), None);
    }
}
