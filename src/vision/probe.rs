//! The image that depth features look at, and the features themselves (thesis equation 3.1).
//!
//! Everything that is not foreground, and everything outside the image, reads [`BACKGROUND`]: a border of one pixel holds it,
//! and coordinates are clamped to that border. This constant is part of every trained tree: with another one a tree that
//! labels 97 of 100 pixels rightly falls to 3 to 75.

/// What background reads, in millimetres.
pub const BACKGROUND: u16 = 10_000;

/// A foreground image with a border of background.
#[derive(Clone, Debug, Default)]
pub struct ProbeImage {
    width: usize,
    height: usize,
    values: Vec<u16>,
}

/// Two probes about a pixel: columns and rows of u and v in pixel metres.
pub type Offsets = [f32; 4];

impl ProbeImage {
    /// An image of background.
    #[must_use]
    pub fn new(width: usize, height: usize) -> Self {
        let mut image = Self::default();
        image.reset(width, height);
        image
    }

    /// Fills the image with background, without a new allocation where the size stays.
    pub fn reset(&mut self, width: usize, height: usize) {
        (self.width, self.height) = (width, height);
        self.values.clear();
        // One more value than pixels: vector instructions read two at a time.
        self.values.resize((width + 2) * (height + 2) + 1, BACKGROUND);
    }

    /// Width without the border.
    #[must_use]
    pub const fn width(&self) -> usize {
        self.width
    }

    /// Height without the border.
    #[must_use]
    pub const fn height(&self) -> usize {
        self.height
    }

    /// Values from one row to the next.
    #[must_use]
    pub const fn stride(&self) -> usize {
        self.width + 2
    }

    /// All values with the border, and one more.
    #[must_use]
    pub fn values(&self) -> &[u16] {
        &self.values
    }

    /// Makes a pixel foreground with a depth in millimetres; does nothing outside the image.
    pub fn set(&mut self, column: usize, row: usize, depth: u16) {
        if column < self.width {
            let index = (row + 1) * self.stride() + column + 1;
            if let Some(value) = self.values.get_mut(index) {
                *value = depth.min(BACKGROUND);
            }
        }
    }

    /// Whether a pixel of the image is foreground.
    #[must_use]
    pub fn is_foreground(&self, column: usize, row: usize) -> bool {
        column < self.width
            && self.values.get((row + 1) * self.stride() + column + 1).is_some_and(|value| *value < BACKGROUND)
    }

    /// The depth of a foreground pixel; `None` for background and outside.
    #[must_use]
    pub fn foreground_at(&self, column: usize, row: usize) -> Option<u16> {
        let index = row.checked_add(1)?.checked_mul(self.stride())?.checked_add(column)? + 1;
        let value = self.values.get(index).copied().filter(|_| column < self.width && row < self.height)?;
        (value < BACKGROUND).then_some(value)
    }

    /// The part of the image from one corner to another (excluded). Probes outside it read background, as they do here
    /// where all foreground lies inside.
    #[must_use]
    pub fn cropped(&self, from: (usize, usize), to: (usize, usize)) -> Self {
        let width = to.0.saturating_sub(from.0);
        let mut cropped = Self::new(width, to.1.saturating_sub(from.1));
        let (stride, inner) = (self.stride(), cropped.stride());
        for (row, target) in (from.1..to.1).zip(cropped.values.chunks_mut(inner).skip(1)) {
            let start = (row + 1) * stride + from.0 + 1;
            if let (Some(target), Some(source)) = (target.get_mut(1..=width), self.values.get(start..start + width)) {
                target.copy_from_slice(source);
            }
        }
        cropped
    }

    /// The value at a place; background outside.
    #[must_use]
    #[inline]
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped to the image and its border")]
    pub fn at(&self, column: f32, row: f32) -> u16 {
        // Shifted by the border first: what is not negative is cut to a whole number by the cast alone, and cheaply.
        let column = (column + 1.0).clamp(0.0, (self.width + 1) as f32);
        let row = (row + 1.0).clamp(0.0, (self.height + 1) as f32);
        self.values.get(row as usize * self.stride() + column as usize).copied().unwrap_or(BACKGROUND)
    }

    /// The feature: depth at n + u/z less depth at n + v/z, in millimetres. `per_metre` is 1/z, with a correction of the
    /// focal length where the camera is not the one that the offsets were made for.
    #[must_use]
    #[inline]
    pub fn response(&self, (column, row): (f32, f32), per_metre: f32, offsets: &Offsets) -> i32 {
        let [u_x, u_y, v_x, v_y] = *offsets;
        let first = self.at(column + u_x * per_metre + 0.5, row + u_y * per_metre + 0.5);
        let second = self.at(column + v_x * per_metre + 0.5, row + v_y * per_metre + 0.5);
        i32::from(first) - i32::from(second)
    }
}

/// The information that a split gains, in bits (thesis equation 3.3), from counts of each class on both sides.
#[must_use]
pub fn gain(left: &[u32], right: &[u32]) -> f64 {
    let (left_total, right_total) = (total(left), total(right));
    let all = left_total + right_total;
    if all <= 0.0 {
        return 0.0;
    }
    let together = left.iter().zip(right).map(|(left, right)| f64::from(*left) + f64::from(*right));
    (scatter(together, all)
        - scatter(left.iter().map(|count| f64::from(*count)), left_total)
        - scatter(right.iter().map(|count| f64::from(*count)), right_total))
        / all
}

fn total(counts: &[u32]) -> f64 {
    counts.iter().map(|count| f64::from(*count)).sum()
}

/// Entropy in bits times the number of samples.
fn scatter(counts: impl Iterator<Item = f64>, total: f64) -> f64 {
    counts.filter(|count| *count > 0.0).map(|count| -count * (count / total).log2()).sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde::Deserialize;

    #[derive(Deserialize)]
    struct Golden {
        width: usize,
        height: usize,
        depth_mm: Vec<Vec<u16>>,
        features: Vec<Feature>,
        gain: Vec<Gain>,
    }

    #[derive(Deserialize)]
    struct Feature {
        x: f32,
        y: f32,
        u: [f32; 2],
        v: [f32; 2],
        f: i32,
    }

    #[derive(Deserialize)]
    struct Gain {
        left: Vec<u32>,
        right: Vec<u32>,
        #[serde(rename = "gain_bits")]
        bits: f64,
    }

    fn golden() -> (Golden, ProbeImage) {
        let golden: Golden =
            serde_json::from_str(include_str!("../../tests/vectors/vision/rdf_conventions.json")).unwrap();
        let mut image = ProbeImage::new(golden.width, golden.height);
        for (row, depths) in golden.depth_mm.iter().enumerate() {
            for (column, depth) in depths.iter().enumerate().filter(|(_, depth)| **depth > 0) {
                image.set(column, row, *depth);
            }
        }
        (golden, image)
    }

    #[test]
    fn features_are_those_of_the_convention() {
        let (golden, image) = golden();
        assert!(golden.features.len() > 100);
        for feature in &golden.features {
            let own = f32::from(image.at(feature.x, feature.y)) / 1000.0;
            let offsets = [feature.u[0], feature.u[1], feature.v[0], feature.v[1]];
            assert_eq!(image.response((feature.x, feature.y), 1.0 / own, &offsets), feature.f);
        }
    }

    #[test]
    fn gains_are_those_of_the_convention() {
        let (golden, _) = golden();
        assert!(golden.gain.len() > 5);
        for case in &golden.gain {
            assert!((gain(&case.left, &case.right) - case.bits).abs() < 1e-9);
        }
        assert!(gain(&[0, 0], &[0, 0]).abs() < 1e-12);
    }

    #[test]
    fn outside_reads_background() {
        let image = golden().1;
        for (column, row) in [(-5.0, 3.0), (64.0, 3.0), (3.0, -0.5), (3.0, 1e9), (f32::INFINITY, 0.0)] {
            assert_eq!(image.at(column, row), BACKGROUND);
        }
    }
}
