//! Labels from coloured clothes (thesis section 3.2.2): each part wears a colour, and a pixel belongs to the nearest one.
//!
//! Colours are compared in L*a*b*, where distances are as the eye sees them. Light makes single pixels wrong, so labels are
//! eroded and grown again; the thesis' two rules then take away what still lies in another part's place. The colour image must be
//! registered to the depth image; pixels without a colour stay unlabelled.

mod lab;

pub use lab::{Lab, lab};

use super::foreground::Facing;
use super::part::{NONE, PARTS, Part};
use super::probe::ProbeImage;
use crate::body::Side;
use serde::{Deserialize, Serialize};
use thiserror::Error;

/// Sample colours that are nearer to each other than this cannot be told apart in shade (CIE 1976 difference).
const LEAST_DIFFERENCE: f64 = 8.0;
/// How often labels are eroded, and grown again at most, by one pixel each time.
const EROSIONS: usize = 1;
const MOST_DILATIONS: usize = 6;

/// The colour of each part's cloth, in the order of the labels: sRGB from 0 to 255.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct SampleColours(pub [[u8; 3]; PARTS]);

/// Why an image cannot be labelled by colour.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum LabelError {
    /// Two parts wear nearly one colour.
    #[error(
        "the sample colours of parts {first} and {second} differ by {difference:.1} only, and {LEAST_DIFFERENCE} are \
             needed: pick them again or change the cloth"
    )]
    Alike {
        /// One part's label.
        first: usize,
        /// The other's.
        second: usize,
        /// How much they differ (CIE 1976).
        difference: f64,
    },
    /// Colour and depth differ in size.
    #[error("a colour image of {found} bytes where {needed} are needed: use colour that is registered to depth")]
    Size {
        /// Bytes that came.
        found: usize,
        /// Bytes that the depth image's size asks for.
        needed: usize,
    },
    /// There is nothing where a sample was to be picked.
    #[error("there is no pixel at column {column}, row {row} to pick a sample colour from: pick inside the image")]
    Outside {
        /// Column.
        column: usize,
        /// Row.
        row: usize,
    },
}

/// A colour image: three bytes a pixel (red, green, blue), row by row.
#[derive(Clone, Copy, Debug)]
pub struct ColourImage<'a> {
    /// Pixels in a row.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// The bytes.
    pub bytes: &'a [u8],
}

impl ColourImage<'_> {
    fn check(&self, (width, height): (usize, usize)) -> Result<(), LabelError> {
        let needed = width * height * 3;
        let fits = (self.width, self.height) == (width, height) && self.bytes.len() == needed;
        if fits { Ok(()) } else { Err(LabelError::Size { found: self.bytes.len(), needed }) }
    }

    fn at(&self, column: usize, row: usize) -> Option<[u8; 3]> {
        let inside = column < self.width && row < self.height;
        let (pixels, _) = self.bytes.as_chunks::<3>();
        pixels.get(row * self.width + column).copied().filter(|_| inside)
    }

    /// The sample colour at a place that the operator picked: the mean of the 5 x 5 pixels about it.
    ///
    /// # Errors
    /// [`LabelError::Outside`] where there is no such pixel.
    #[expect(clippy::cast_possible_truncation, reason = "a mean of bytes")]
    pub fn pick(&self, column: usize, row: usize) -> Result<[u8; 3], LabelError> {
        self.at(column, row).ok_or(LabelError::Outside { column, row })?;
        let (mut sum, mut count) = ([0_u32; 3], 0);
        for row in row.saturating_sub(2)..=row + 2 {
            for colour in (column.saturating_sub(2)..=column + 2).filter_map(|column| self.at(column, row)) {
                sum.iter_mut().zip(colour).for_each(|(sum, value)| *sum += u32::from(value));
                count += 1;
            }
        }
        Ok(sum.map(|sum| (sum / count) as u8))
    }
}

impl SampleColours {
    /// Checks that all parts can be told apart.
    ///
    /// # Errors
    /// [`LabelError::Alike`] with the first two that cannot.
    pub fn check(&self) -> Result<(), LabelError> {
        let colours = self.0.map(lab);
        for (second, colour) in colours.iter().enumerate() {
            for (first, other) in colours.iter().enumerate().take(second) {
                let difference = colour.difference(other);
                if difference < LEAST_DIFFERENCE {
                    return Err(LabelError::Alike { first, second, difference });
                }
            }
        }
        Ok(())
    }

    /// Labels the foreground of a depth image (as taken, unturned) by the colours of a registered image. Row-major; `NONE`
    /// outside the foreground, and where the colour image is black, which is how registration marks missing colour.
    ///
    /// # Errors
    /// Where the sizes differ or two sample colours are alike.
    pub fn label(
        &self,
        colour: &ColourImage<'_>,
        foreground: &ProbeImage,
        facing: Facing,
    ) -> Result<Vec<u8>, LabelError> {
        self.check()?;
        let size = (foreground.width(), foreground.height());
        colour.check(size)?;
        let samples = self.0.map(lab);
        let mut labels = vec![NONE; size.0 * size.1];
        for (index, (label, rgb)) in labels.iter_mut().zip(colour.bytes.as_chunks::<3>().0).enumerate() {
            if *rgb != [0; 3] && foreground.is_foreground(index % size.0, index / size.0) {
                *label = nearest(&samples, &lab(*rgb));
            }
        }
        let wanted: Vec<bool> = labels.iter().map(|label| *label != NONE).collect();
        for _ in 0..EROSIONS {
            labels = eroded(&labels, size.0);
        }
        for _ in 0..MOST_DILATIONS {
            labels = dilated(&labels, &wanted, size.0);
        }
        remove_outliers(&mut labels, size.0, facing);
        Ok(labels)
    }
}

/// The label whose sample is nearest.
fn nearest(samples: &[Lab; PARTS], colour: &Lab) -> u8 {
    let mut best = (f64::INFINITY, NONE);
    for (label, sample) in (0_u8..).zip(samples) {
        let difference = sample.difference(colour);
        if difference < best.0 {
            best = (difference, label);
        }
    }
    best.1
}

/// The labels of the eight pixels about one.
fn neighbours(labels: &[u8], width: usize, index: usize) -> impl Iterator<Item = u8> {
    let (column, row) = (index % width, index / width);
    let rows = row.saturating_sub(1)..=row + 1;
    rows.flat_map(move |other_row| {
        let columns = column.saturating_sub(1)..=(column + 1).min(width - 1);
        columns.filter(move |other| (*other, other_row) != (column, row)).map(move |column| (column, other_row))
    })
    .filter_map(move |(column, row)| labels.get(row * width + column).copied())
}

/// Only what has no neighbour of another part stays labelled. The edge of the foreground does not count as another part.
fn eroded(labels: &[u8], width: usize) -> Vec<u8> {
    let stays = |index: usize, label: u8| neighbours(labels, width, index).all(|other| other == label || other == NONE);
    labels.iter().enumerate().map(|(index, label)| if stays(index, *label) { *label } else { NONE }).collect()
}

/// What has lost its label gets the most frequent one of its neighbours; of equally frequent ones the lowest.
fn dilated(labels: &[u8], wanted: &[bool], width: usize) -> Vec<u8> {
    let grown = |(index, (label, wanted)): (usize, (&u8, &bool))| {
        if *label != NONE || !*wanted {
            return *label;
        }
        let mut counts = [0_u8; PARTS];
        for other in neighbours(labels, width, index) {
            if let Some(count) = counts.get_mut(usize::from(other)) {
                *count += 1;
            }
        }
        let most = (0_u8..)
            .zip(counts)
            .fold((NONE, 0), |best, (label, count)| if count > best.1 { (label, count) } else { best });
        most.0
    };
    labels.iter().zip(wanted).enumerate().map(grown).collect()
}

/// The thesis' two rules, in the body's own axes: no right upper arm beyond the left shoulder, and no right forearm further
/// back than the right upper arm.
fn remove_outliers(labels: &mut [u8], width: usize, facing: Facing) {
    let sign = match facing {
        Facing::LowerEdge => 1.0,
        Facing::UpperEdge => -1.0,
    };
    let leftward = |index: usize| sign * (index % width) as f64;
    let forward = |index: usize| sign * (index / width) as f64;
    let (upper_arm, forearm) = (Part::UpperArm.label(Side::Right), Part::Forearm.label(Side::Right));
    if let Some(shoulder) = mean(labels, Part::Shoulder.label(Side::Left), leftward) {
        remove(labels, upper_arm, |index| leftward(index) > shoulder);
    }
    if let Some(middle) = mean(labels, upper_arm, forward) {
        remove(labels, forearm, |index| forward(index) < middle);
    }
}

/// The mean of something over a part's pixels; `None` where there are none.
fn mean(labels: &[u8], label: u8, of: impl Fn(usize) -> f64) -> Option<f64> {
    let own = || labels.iter().enumerate().filter(|(_, found)| **found == label);
    let count = own().count();
    (count > 0).then(|| own().map(|(index, _)| of(index)).sum::<f64>() / count as f64)
}

fn remove(labels: &mut [u8], label: u8, is_outlier: impl Fn(usize) -> bool) {
    for (index, found) in labels.iter_mut().enumerate() {
        if *found == label && is_outlier(index) {
            *found = NONE;
        }
    }
}

#[cfg(test)]
mod tests;
