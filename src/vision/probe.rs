//! The image that depth features look at, and the features themselves (thesis equation 3.1).
//!
//! Everything that is not foreground, and everything outside the image, reads [`BACKGROUND`]: a border of one pixel holds it,
//! and coordinates are clamped to that border. This constant is part of every trained tree: with another one a tree that
//! labels 97 of 100 pixels rightly falls to 3 to 75.

use super::neck::{CELL_SHIFT, MAPS};

/// What background reads, in millimetres.
pub const BACKGROUND: u16 = 10_000;
/// Planes that a probe can read: depth, each map of the neck, and none.
pub const PLANES: usize = MAPS.len() + 2;
/// The plane of depth, which equation 3.1 reads.
pub const DEPTH: u8 = 0;
/// The plane that reads background everywhere: a feature with it is the other probe's value alone.
pub const NOTHING: u8 = 7;

/// A foreground image with a border of background, and the maps of where it lies from the neck.
#[derive(Clone, Debug, Default)]
pub struct ProbeImage {
    width: usize,
    height: usize,
    /// Depth row by row with its border and one value more, then each map, then one value more.
    values: Vec<u16>,
    pub(super) room: super::neck::Room,
}

/// Two probes about a pixel: columns and rows of u and v in pixel metres.
pub type Offsets = [f32; 4];

/// Two probes with the planes that they read.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Feature {
    /// Where they look.
    pub offsets: Offsets,
    /// What they read there, below [`PLANES`].
    pub planes: [u8; 2],
}

/// Where a plane's values stand: `(row >> shift) * stride + (column >> shift) + first`, rows and columns counted with the
/// border.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Plane {
    pub(super) shift: u32,
    pub(super) stride: usize,
    pub(super) first: usize,
}

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
        self.values.resize(self.value_count(), BACKGROUND);
    }

    /// All values: one more than pixels, since vector instructions read two at a time, and as many for the maps.
    pub(super) const fn value_count(&self) -> usize {
        let (columns, rows) = self.cells();
        self.first_map() + MAPS.len() * columns * rows + 1
    }

    const fn first_map(&self) -> usize {
        (self.width + 2) * (self.height + 2) + 1
    }

    /// Columns and rows of a map's cells.
    pub(super) const fn cells(&self) -> (usize, usize) {
        (((self.width + 1) >> CELL_SHIFT) + 1, ((self.height + 1) >> CELL_SHIFT) + 1)
    }

    /// Where each plane's values stand.
    #[must_use]
    pub(super) const fn plane(&self, plane: u8) -> Plane {
        let (columns, rows) = self.cells();
        match plane {
            DEPTH => Plane { shift: 0, stride: self.stride(), first: 0 },
            // Every place becomes the border's corner.
            NOTHING.. => Plane { shift: 31, stride: 0, first: 0 },
            map => {
                let first = self.first_map() + (map as usize - 1) * columns * rows;
                Plane { shift: CELL_SHIFT, stride: columns, first }
            }
        }
    }

    /// A map's values, cell by cell.
    pub(super) fn map_mut(&mut self, map: usize) -> &mut [u16] {
        let (columns, rows) = self.cells();
        let first = self.first_map() + map * columns * rows;
        self.values.get_mut(first..first + columns * rows).unwrap_or(&mut [])
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

    /// Depth with the border and one value more, then the maps.
    #[must_use]
    pub fn values(&self) -> &[u16] {
        &self.values
    }

    /// A row's depths without the border.
    pub(super) fn row_mut(&mut self, row: usize) -> &mut [u16] {
        let start = (row + 1) * self.stride() + 1;
        self.values.get_mut(start..start + self.width).unwrap_or(&mut [])
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

    /// The part of the image from one corner to another (excluded), grown to whole cells with one cell of background about
    /// it, and its corner. Probes outside it read background, as they do here where all foreground lies inside.
    #[must_use]
    pub fn cropped(&self, from: (usize, usize), to: (usize, usize)) -> (Self, (usize, usize)) {
        let cell = 1_usize << CELL_SHIFT;
        let lower = |at: usize| (at / cell).saturating_sub(1) * cell;
        let (left, top) = (lower(from.0), lower(from.1));
        let (right, bottom) = ((to.0 + 2 * cell).min(self.width), (to.1 + 2 * cell).min(self.height));
        let mut cropped = Self::new(right.saturating_sub(left), bottom.saturating_sub(top));
        cropped.copy(0, &self.values, (self.plane(DEPTH), (left, top)), cropped.plane(DEPTH), cropped.height + 2);
        for map in 1..=MAPS.len() {
            #[expect(clippy::cast_possible_truncation, reason = "a handful of maps")]
            let (source, target) = (self.plane(map as u8), cropped.plane(map as u8));
            let corner = (left >> CELL_SHIFT, top >> CELL_SHIFT);
            cropped.copy(target.first, &self.values, (source, corner), target, cropped.cells().1);
        }
        (cropped, (left, top))
    }

    /// Copies a plane's rows from a corner of another image's plane on.
    fn copy(
        &mut self,
        first: usize,
        from: &[u16],
        (source, corner): (Plane, (usize, usize)),
        plane: Plane,
        rows: usize,
    ) {
        for row in 0..rows {
            let start = source.first + (row + corner.1) * source.stride + corner.0;
            let target = first + row * plane.stride;
            let copied = from.get(start..start + plane.stride);
            if let (Some(target), Some(copied)) = (self.values.get_mut(target..target + plane.stride), copied) {
                target.copy_from_slice(copied);
            }
        }
    }

    /// The image turned by half a turn.
    #[must_use]
    pub fn turned(&self) -> Self {
        let mut turned = Self::new(self.width, self.height);
        for row in 0..self.height {
            for column in 0..self.width {
                if let Some(depth) = self.foreground_at(column, row) {
                    turned.set(self.width - 1 - column, self.height - 1 - row, depth);
                }
            }
        }
        turned
    }

    /// The value at a place; background outside.
    #[must_use]
    #[inline]
    pub fn at(&self, column: f32, row: f32) -> u16 {
        self.read(self.plane(DEPTH), column, row)
    }

    #[inline]
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped to the image and its border")]
    fn read(&self, plane: Plane, column: f32, row: f32) -> u16 {
        // Shifted by the border first: what is not negative is cut to a whole number by the cast alone. A cast to 16 bits saturates
        // at no cost, and no side of an image needs more.
        let column = usize::from((column + 1.0) as u16).min(self.width + 1) >> plane.shift;
        let row = usize::from((row + 1.0) as u16).min(self.height + 1) >> plane.shift;
        self.values.get(row * plane.stride + column + plane.first).copied().unwrap_or(BACKGROUND)
    }

    /// The feature: what the first plane reads at n + u/z less what the second one reads at n + v/z, in millimetres; with
    /// both planes depth, equation 3.1. `per_metre` is 1/z, with a correction of the focal length where the camera is not the
    /// one that the offsets were made for.
    #[must_use]
    #[inline]
    pub fn response(&self, (column, row): (f32, f32), per_metre: f32, feature: &Feature) -> i32 {
        let planes = feature.planes.map(|plane| self.plane(plane));
        self.difference((column, row), per_metre, &feature.offsets, planes)
    }

    /// [`ProbeImage::response`] where it is known already how planes stand.
    #[inline]
    pub(super) fn difference(
        &self,
        (column, row): (f32, f32),
        per_metre: f32,
        [u_x, u_y, v_x, v_y]: &Offsets,
        [first, second]: [Plane; 2],
    ) -> i32 {
        let first = self.read(first, column + u_x * per_metre + 0.5, row + u_y * per_metre + 0.5);
        let second = self.read(second, column + v_x * per_metre + 0.5, row + v_y * per_metre + 0.5);
        i32::from(first) - i32::from(second)
    }

    /// How all planes stand.
    pub(super) fn planes(&self) -> [Plane; PLANES] {
        let mut planes = [Plane::default(); PLANES];
        planes.iter_mut().zip(DEPTH..).for_each(|(slot, plane)| *slot = self.plane(plane));
        planes
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
            let of_depth = super::Feature { offsets, planes: [DEPTH; 2] };
            assert_eq!(image.response((feature.x, feature.y), 1.0 / own, &of_depth), feature.f);
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
    fn half_a_turn_twice_is_none() {
        let image = golden().1;
        let turned = image.turned();
        assert_eq!(turned.at(0.0, 0.0), image.at((image.width() - 1) as f32, (image.height() - 1) as f32));
        assert_eq!(turned.turned().values(), image.values());
    }

    #[test]
    fn outside_reads_background() {
        let image = golden().1;
        for (column, row) in [(-5.0, 3.0), (64.0, 3.0), (3.0, -0.5), (3.0, 1e9), (f32::INFINITY, 0.0)] {
            assert_eq!(image.at(column, row), BACKGROUND);
        }
    }
}
