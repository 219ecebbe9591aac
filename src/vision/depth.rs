//! Depth images: millimetres along the optical axis in 16 bits, 0 where there is no reading.
//!
//! Drivers differ in units and layout, so a raw image is decoded by its `encoding` (ROS REP 118), never by its topic.

use thiserror::Error;

/// The largest width or height that is accepted, in pixels.
pub(super) const LARGEST_SIDE: usize = 4096;
/// The value that saturated sensors report; it means no reading.
const SATURATED: u16 = u16::MAX;

/// A depth image: row-major millimetres, 0 = no reading.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct DepthImage {
    width: usize,
    height: usize,
    millimetres: Vec<u16>,
}

/// A raw image as it comes over ROS, borrowed.
#[derive(Clone, Copy, Debug)]
pub struct RawImage<'a> {
    /// Pixels in a row.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// Bytes from one row to the next; may exceed what the pixels need.
    pub step: u32,
    /// `16UC1` (or `mono16`) in millimetres, or `32FC1` in metres.
    pub encoding: &'a str,
    /// True where numbers have their most significant byte first.
    pub big_endian: bool,
    /// The bytes.
    pub data: &'a [u8],
}

/// Why a depth image cannot be used.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum DepthError {
    /// Another encoding than depth has.
    #[error("depth image with encoding \"{0}\": only 16UC1 (mm) and 32FC1 (m) are depth; remap the depth topic")]
    Encoding(String),
    /// No pixels, or more than any camera has.
    #[error("depth image of {width} x {height} pixels: check the driver's image mode")]
    Size {
        /// Pixels in a row.
        width: usize,
        /// Rows.
        height: usize,
    },
    /// Rows overlap.
    #[error("depth image with {step} bytes a row where {needed} are needed: the driver's step is wrong")]
    Step {
        /// Bytes a row as told.
        step: usize,
        /// Bytes that the pixels of a row need.
        needed: usize,
    },
    /// Bytes are missing.
    #[error("depth image of {bytes} bytes where {needed} are needed: it was cut short")]
    Short {
        /// Bytes that came.
        bytes: usize,
        /// Bytes that the size asks for.
        needed: usize,
    },
    /// Not one pixel has a reading.
    #[error("depth image without a single reading: is the lens covered, or the person closer than 0.5 m?")]
    Blind,
    /// Two images that belong together differ in size.
    #[error(
        "depth image of {width} x {height} pixels where {expected_width} x {expected_height} are expected: \
             use images of one camera mode"
    )]
    Mismatch {
        /// Pixels in a row.
        width: usize,
        /// Rows.
        height: usize,
        /// Pixels in a row that are expected.
        expected_width: usize,
        /// Rows that are expected.
        expected_height: usize,
    },
}

#[derive(Clone, Copy)]
enum Format {
    Millimetres,
    Metres,
}

impl Format {
    fn of(encoding: &str) -> Result<Self, DepthError> {
        match encoding {
            "16UC1" | "mono16" => Ok(Self::Millimetres),
            "32FC1" => Ok(Self::Metres),
            other => Err(DepthError::Encoding(other.into())),
        }
    }

    const fn bytes(self) -> usize {
        match self {
            Self::Millimetres => 2,
            Self::Metres => 4,
        }
    }
}

impl DepthImage {
    /// An image of given pixels.
    ///
    /// # Errors
    /// Where the size is not that of a camera or does not fit the number of pixels.
    pub fn new(width: usize, height: usize, millimetres: Vec<u16>) -> Result<Self, DepthError> {
        check_size(width, height)?;
        if millimetres.len() != width * height {
            return Err(DepthError::Short { bytes: millimetres.len() * 2, needed: width * height * 2 });
        }
        Ok(Self { width, height, millimetres })
    }

    /// Decodes a raw image.
    ///
    /// # Errors
    /// Where encoding, size, step or length are wrong.
    pub fn decode(raw: &RawImage<'_>) -> Result<Self, DepthError> {
        let mut image = Self::default();
        image.decode_from(raw)?;
        Ok(image)
    }

    /// Decodes a raw image into this one, without a new allocation where the size stays.
    ///
    /// # Errors
    /// As [`DepthImage::decode`]; this image is then unchanged.
    pub fn decode_from(&mut self, raw: &RawImage<'_>) -> Result<(), DepthError> {
        let format = Format::of(raw.encoding)?;
        let (width, height, step) = (raw.width as usize, raw.height as usize, raw.step as usize);
        check_size(width, height)?;
        let row_bytes = width * format.bytes();
        if step < row_bytes {
            return Err(DepthError::Step { step, needed: row_bytes });
        }
        // The padding of the last row may be missing.
        let needed = step * (height - 1) + row_bytes;
        if raw.data.len() < needed {
            return Err(DepthError::Short { bytes: raw.data.len(), needed });
        }
        (self.width, self.height) = (width, height);
        self.millimetres.clear();
        for row in raw.data.chunks(step).take(height) {
            self.decode_row(row.get(..row_bytes).unwrap_or(row), format, raw.big_endian);
        }
        Ok(())
    }

    fn decode_row(&mut self, row: &[u8], format: Format, big_endian: bool) {
        match format {
            Format::Millimetres => self.millimetres.extend(row.as_chunks::<2>().0.iter().map(|bytes| {
                let value = if big_endian { u16::from_be_bytes(*bytes) } else { u16::from_le_bytes(*bytes) };
                if value == SATURATED { 0 } else { value }
            })),
            Format::Metres => self.millimetres.extend(row.as_chunks::<4>().0.iter().map(|bytes| {
                metres_to_millimetres(if big_endian { f32::from_be_bytes(*bytes) } else { f32::from_le_bytes(*bytes) })
            })),
        }
    }

    /// Turns a mirrored image the right way round.
    pub fn unmirror(&mut self) {
        let width = self.width.max(1);
        self.millimetres.chunks_mut(width).for_each(<[u16]>::reverse);
    }

    /// Pixels in a row.
    #[must_use]
    pub const fn width(&self) -> usize {
        self.width
    }

    /// Rows.
    #[must_use]
    pub const fn height(&self) -> usize {
        self.height
    }

    /// Row-major millimetres.
    #[must_use]
    pub fn millimetres(&self) -> &[u16] {
        &self.millimetres
    }

    /// Row-major millimetres, to change them.
    pub fn millimetres_mut(&mut self) -> &mut [u16] {
        &mut self.millimetres
    }

    /// The reading at a pixel; 0 where there is none or no such pixel.
    #[must_use]
    pub fn at(&self, column: usize, row: usize) -> u16 {
        if column >= self.width {
            return 0;
        }
        self.millimetres.get(row * self.width + column).copied().unwrap_or(0)
    }

    /// Checks that there is at least one reading.
    ///
    /// # Errors
    /// [`DepthError::Blind`] where there is none.
    pub fn check_readings(&self) -> Result<(), DepthError> {
        if self.millimetres.iter().any(|reading| *reading > 0) { Ok(()) } else { Err(DepthError::Blind) }
    }

    /// Checks that another image has this one's size.
    ///
    /// # Errors
    /// [`DepthError::Mismatch`] where it has not.
    pub fn check_same_size(&self, other: &Self) -> Result<(), DepthError> {
        if (self.width, self.height) == (other.width, other.height) {
            return Ok(());
        }
        Err(DepthError::Mismatch {
            width: other.width,
            height: other.height,
            expected_width: self.width,
            expected_height: self.height,
        })
    }
}

fn check_size(width: usize, height: usize) -> Result<(), DepthError> {
    if (1..=LARGEST_SIDE).contains(&width) && (1..=LARGEST_SIDE).contains(&height) {
        Ok(())
    } else {
        Err(DepthError::Size { width, height })
    }
}

/// Rounds to millimetres; what is not a distance that 16 bits hold is no reading.
#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "the range is checked before the cast")]
fn metres_to_millimetres(metres: f32) -> u16 {
    let millimetres = (metres * 1000.0).round();
    if millimetres > 0.0 && millimetres < f32::from(SATURATED) { millimetres as u16 } else { 0 }
}

#[cfg(test)]
mod tests;
