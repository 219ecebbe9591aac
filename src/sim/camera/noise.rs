//! What an Xtion makes of true depth: shadow of the projector, coarse disparity, ragged edges, holes and a nearest distance.
//!
//! Source of the numbers: `OpenNI`'s driver (baseline about 75 mm, disparity in eighths of a pixel) and published
//! measurements of such sensors, whose depth error grows with the square of the distance.

use crate::vision::{DepthImage, Intrinsics};

/// How the sensor errs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SensorNoise {
    /// Distance between projector and camera in metres.
    pub baseline_metres: f64,
    /// Standard deviation of the disparity in pixels.
    pub disparity_deviation: f64,
    /// Share of pixels without a reading, anywhere.
    pub dropout: f64,
    /// Nearer than this there is no reading, in millimetres.
    pub nearest_millimetres: u16,
}

impl Default for SensorNoise {
    fn default() -> Self {
        Self { baseline_metres: 0.075, disparity_deviation: 0.06, dropout: 0.001, nearest_millimetres: 450 }
    }
}

/// `SplitMix64`: a number for each pixel, fast and repeatable.
#[derive(Clone, Copy, Debug)]
pub(super) struct PixelRandom(pub(super) u64);

impl PixelRandom {
    pub(super) fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut mixed = self.0;
        mixed = (mixed ^ (mixed >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        mixed ^ (mixed >> 31)
    }

    /// From 0 to 1.
    pub(super) fn uniform(&mut self) -> f64 {
        (self.next() >> 11) as f64 / (1_u64 << 53) as f64
    }

    pub(super) fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.uniform()
    }

    /// Nearly normal, mean 0 and deviation 1: four uniform numbers of 16 bits.
    pub(super) fn normal(&mut self) -> f64 {
        let bits = self.next();
        let sum: u64 = (0..4).map(|word| (bits >> (16 * word)) & 0xFFFF).sum();
        (sum as f64 / 65_535.0 - 2.0) * 3.0_f64.sqrt()
    }
}

/// Depths (mm) and disparities (eighths of a pixel) up to here are looked up: an Xtion's range, and more than its nearest.
const LOOKED_UP_MILLIMETRES: u16 = 10_000;
const LOOKED_UP_EIGHTHS: u32 = 1_024;

/// Depth to disparity and back, looked up where most readings are: divisions are what the noise of an image takes longest for.
struct Disparities {
    /// Focal length in pixels times the baseline in metres.
    strength: f64,
    by_millimetres: Vec<f64>,
    by_eighths: Vec<u16>,
}

impl Disparities {
    fn new(strength: f64) -> Self {
        let by_millimetres = (0..LOOKED_UP_MILLIMETRES).map(|depth| disparity(strength, depth)).collect();
        let by_eighths = (0..LOOKED_UP_EIGHTHS).map(|eighths| depth(strength, eighths)).collect();
        Self { strength, by_millimetres, by_eighths }
    }

    fn disparity(&self, millimetres: u16) -> f64 {
        let known = self.by_millimetres.get(usize::from(millimetres)).copied();
        known.unwrap_or_else(|| disparity(self.strength, millimetres))
    }

    fn depth(&self, eighths: u32) -> u16 {
        self.by_eighths.get(eighths as usize).copied().unwrap_or_else(|| depth(self.strength, eighths))
    }
}

/// The disparity in pixels of a depth in millimetres.
fn disparity(strength: f64, millimetres: u16) -> f64 {
    strength / (f64::from(millimetres) / 1000.0)
}

/// The depth in millimetres of a disparity in eighths of a pixel.
#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped to the range first")]
fn depth(strength: f64, eighths: u32) -> u16 {
    (strength / (f64::from(eighths) / 8.0).max(0.5) * 1000.0 + 0.5).clamp(0.0, 65_534.0) as u16
}

/// Turns true depth into what the sensor reports.
pub(super) fn apply(image: &mut DepthImage, camera: &Intrinsics, noise: &SensorNoise, random: &mut PixelRandom) {
    let width = image.width();
    let disparities = Disparities::new(camera.fx * noise.baseline_metres);
    let mut row_truth = vec![0_u16; width];
    for row in image.millimetres_mut().chunks_mut(width) {
        row_truth.copy_from_slice(row);
        // The projector sits to the camera's right: its rays reach a column only past everything to the right of it.
        let mut horizon = f64::INFINITY;
        for (column, reading) in row.iter_mut().enumerate().rev() {
            let jitter = column.wrapping_add_signed(neighbour(random.next()));
            if *reading == 0 {
                continue;
            }
            let beside = row_truth.get(jitter).copied().unwrap_or(0);
            let truth = if beside > 0 { beside } else { *reading };
            let disparity = disparities.disparity(truth);
            let seen_at = column as f64 - disparity;
            let shadowed = seen_at > horizon + 1.0;
            horizon = if seen_at < horizon { seen_at } else { horizon };
            *reading = if shadowed || random.uniform() < noise.dropout {
                0
            } else {
                measured(disparity, &disparities, noise, random)
            };
        }
    }
}

/// An edge pixel sometimes reports what its neighbour sees. Without branches, which nobody can foresee here.
fn neighbour(bits: u64) -> isize {
    let drawn = bits & 7;
    isize::from(drawn == 1) - isize::from(drawn == 0)
}

#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped to the range first")]
fn measured(disparity: f64, disparities: &Disparities, noise: &SensorNoise, random: &mut PixelRandom) -> u16 {
    // Cut after a half is added: rounding, which is slow where the processor has no instruction for it.
    let eighths = ((disparity + noise.disparity_deviation * random.normal()) * 8.0 + 0.5).max(0.0) as u32;
    let millimetres = disparities.depth(eighths);
    if millimetres < noise.nearest_millimetres { 0 } else { millimetres }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn flat(depth: u16) -> DepthImage {
        DepthImage::new(100, 20, vec![depth; 2000]).unwrap()
    }

    #[test]
    fn a_flat_wall_keeps_its_distance_and_has_no_shadow() {
        let mut image = flat(1500);
        apply(&mut image, &Intrinsics::default(), &SensorNoise::default(), &mut PixelRandom(1));
        let seen: Vec<f64> = image.millimetres().iter().filter(|d| **d > 0).map(|d| f64::from(*d)).collect();
        assert!(seen.len() > 1950);
        let mean = seen.iter().sum::<f64>() / seen.len() as f64;
        assert!((mean - 1500.0).abs() < 2.0, "{mean}");
    }

    #[test]
    fn something_near_throws_a_shadow_on_the_wall_beside_it() {
        let mut image = flat(2000);
        for row in image.millimetres_mut().chunks_mut(100) {
            row.iter_mut().skip(40).for_each(|reading| *reading = 700);
        }
        apply(&mut image, &Intrinsics::default(), &SensorNoise::default(), &mut PixelRandom(1));
        assert!((5..38).all(|column| image.at(column, 10) == 0), "left of the near thing the projector sees no wall");
        assert!(image.at(60, 10) > 600);
    }

    #[test]
    fn what_is_too_near_is_not_seen() {
        let mut image = flat(300);
        apply(&mut image, &Intrinsics::default(), &SensorNoise::default(), &mut PixelRandom(1));
        assert!(image.check_readings().is_err());
    }
}
