//! Folders of depth images: `NAME.png` (16-bit grey, millimetres, 0 = no reading) with `NAME.json` (camera and neck).
//!
//! Reads and writes files and says what is wrong with them; looks at no picture's content.

use super::exit::Failure;
use crate::config::write_whole;
use crate::geometry::Point;
use crate::vision::{DepthImage, Facing, Intrinsics};
use serde::{Deserialize, Serialize};
use std::fmt::Display;
use std::fs::File;
use std::io::BufReader;
use std::path::{Path, PathBuf};

/// What a depth sensor reports where it is saturated: no reading.
const SATURATED: u16 = u16::MAX;

/// What is known of an image besides its pixels: `NAME.json`. Other keys are left alone.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct ImageNotes {
    /// Focal length along x in pixels.
    pub(super) fx: f64,
    /// Focal length along y in pixels.
    pub(super) fy: f64,
    /// Column of the optical axis.
    pub(super) cx: f64,
    /// Row of the optical axis.
    pub(super) cy: f64,
    /// The neck's root in the camera frame, in metres.
    pub(super) neck_m: [f64; 3],
    /// Which way the person faces in the image, where it is noted.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(super) facing: Option<Facing>,
}

impl ImageNotes {
    /// The camera.
    pub(super) const fn camera(&self) -> Intrinsics {
        Intrinsics { fx: self.fx, fy: self.fy, cx: self.cx, cy: self.cy }
    }

    /// The neck in the camera frame.
    pub(super) fn neck(&self) -> Point {
        Point::from(self.neck_m)
    }

    /// Reads the notes that lie beside an image.
    ///
    /// # Errors
    /// Names the file, the key and what to do.
    pub(super) fn beside(image: &Path) -> Result<Self, String> {
        let path = image.with_extension("json");
        let text = std::fs::read_to_string(&path).map_err(|error| {
            format!("{}: {error}; put fx, fy, cx, cy (pixels) and neck_m ([x, y, z] in metres) there", path.display())
        })?;
        serde_json::from_str(&text).map_err(|error| {
            let needed = "it needs the numbers fx, fy, cx, cy (pixels) and neck_m ([x, y, z] in metres)";
            format!("{}: {error}; {needed}", path.display())
        })
    }
}

/// All `*.png` of a folder, in the order of their names.
pub(super) fn pictures_in(folder: &Path) -> Result<Vec<PathBuf>, Failure> {
    let refuse = |error: std::io::Error| {
        Failure::Configuration(format!("{}: {error}; give a folder with NAME.png and NAME.json", folder.display()))
    };
    let mut pictures = Vec::new();
    for entry in std::fs::read_dir(folder).map_err(refuse)? {
        let path = entry.map_err(refuse)?.path();
        if path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("png")) {
            pictures.push(path);
        }
    }
    pictures.sort();
    Ok(pictures)
}

/// Reads a depth image.
///
/// # Errors
/// Names the file, what is wrong and what to do.
pub(super) fn read_depth(path: &Path) -> Result<DepthImage, String> {
    let named = |error: &dyn Display, remedy: &str| format!("{}: {error}; {remedy}", path.display());
    let file = File::open(path).map_err(|error| named(&error, "check that it is there and may be read"))?;
    let broken =
        |error: png::DecodingError| named(&error, "the image is damaged or cut short: record or copy it again");
    let mut reader = png::Decoder::new(BufReader::new(file)).read_info().map_err(broken)?;
    let (kind, bits) = (reader.info().color_type, reader.info().bit_depth);
    if (kind, bits) != (png::ColorType::Grayscale, png::BitDepth::Sixteen) {
        let found = format!("{kind:?} of {} bits a channel", bits as u8);
        return Err(named(&found, "a depth image is grey with 16 bits (millimetres): write it so"));
    }
    let mut bytes = vec![0; reader.output_buffer_size().unwrap_or_default()];
    let frame = reader.next_frame(&mut bytes).map_err(broken)?;
    let pixels = bytes.as_chunks::<2>().0.iter().map(|pair| match u16::from_be_bytes(*pair) {
        SATURATED => 0,
        reading => reading,
    });
    DepthImage::new(frame.width as usize, frame.height as usize, pixels.collect())
        .map_err(|error| format!("{}: {error}", path.display()))
}

/// Reads a colour image: width, height, and three bytes a pixel (red, green, blue).
///
/// # Errors
/// Names the file, what is wrong and what to do.
pub(super) fn read_colour(path: &Path) -> Result<(usize, usize, Vec<u8>), String> {
    let named = |error: &dyn Display, remedy: &str| format!("{}: {error}; {remedy}", path.display());
    let file = File::open(path).map_err(|error| named(&error, "check that it is there and may be read"))?;
    let broken =
        |error: png::DecodingError| named(&error, "the image is damaged or cut short: record or copy it again");
    let mut reader = png::Decoder::new(BufReader::new(file)).read_info().map_err(broken)?;
    let (kind, bits) = (reader.info().color_type, reader.info().bit_depth);
    if (kind, bits) != (png::ColorType::Rgb, png::BitDepth::Eight) {
        let found = format!("{kind:?} of {} bits a channel", bits as u8);
        return Err(named(&found, "a colour image is red, green and blue with 8 bits each: write it so"));
    }
    let mut bytes = vec![0; reader.output_buffer_size().unwrap_or_default()];
    let frame = reader.next_frame(&mut bytes).map_err(broken)?;
    Ok((frame.width as usize, frame.height as usize, bytes))
}

/// Writes a depth image, whole or not at all.
pub(super) fn write_depth(path: &Path, image: &DepthImage) -> Result<(), Failure> {
    let bytes: Vec<u8> = image.millimetres().iter().flat_map(|reading| reading.to_be_bytes()).collect();
    write(path, (image.width(), image.height()), png::BitDepth::Sixteen, &bytes)
}

/// Writes a label image (8 bits a pixel), whole or not at all.
pub(super) fn write_labels(path: &Path, size: (usize, usize), labels: &[u8]) -> Result<(), Failure> {
    write(path, size, png::BitDepth::Eight, labels)
}

fn write(path: &Path, (width, height): (usize, usize), bits: png::BitDepth, bytes: &[u8]) -> Result<(), Failure> {
    let mut file = Vec::new();
    let (width, height) = (u32::try_from(width), u32::try_from(height));
    let mut encoder = png::Encoder::new(&mut file, width.map_err(Failure::fault)?, height.map_err(Failure::fault)?);
    encoder.set_color(png::ColorType::Grayscale);
    encoder.set_depth(bits);
    encoder.set_compression(png::Compression::Fast);
    let mut writer = encoder.write_header().map_err(Failure::fault)?;
    writer.write_image_data(bytes).map_err(Failure::fault)?;
    writer.finish().map_err(Failure::fault)?;
    write_whole(path, &file).map_err(Failure::configuration)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn image() -> DepthImage {
        DepthImage::new(3, 2, vec![0, 1, 1000, 2000, 65_534, 7]).unwrap()
    }

    #[test]
    fn a_depth_image_reads_back_as_it_was_written() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.png");
        write_depth(&path, &image()).unwrap();
        assert_eq!(read_depth(&path).unwrap(), image());
        assert_eq!(pictures_in(folder.path()).unwrap(), [path]);
    }

    #[test]
    fn a_cut_a_coloured_and_a_missing_image_are_named_with_what_to_do() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.png");
        write_depth(&path, &image()).unwrap();
        let whole = std::fs::read(&path).unwrap();
        for length in 0..whole.len() - 12 {
            std::fs::write(&path, &whole[..length]).unwrap();
            let error = read_depth(&path).unwrap_err();
            assert!(error.contains("a.png") && error.contains("again"), "{length}: {error}");
        }
        write_labels(&path, (3, 2), &[0; 6]).unwrap();
        assert!(read_depth(&path).unwrap_err().contains("16 bits"));
        assert!(read_depth(&folder.path().join("b.png")).unwrap_err().contains("b.png"));
    }

    #[test]
    fn notes_that_miss_a_key_or_hold_no_number_are_named() {
        let folder = tempfile::tempdir().unwrap();
        let picture = folder.path().join("a.png");
        let whole = r#"{"fx": 545.0, "fy": 545, "cx": 319.5, "cy": 239.5, "neck_m": [0.0, 0.1, 1.1], "more": 1}"#;
        std::fs::write(folder.path().join("a.json"), whole).unwrap();
        assert_eq!(ImageNotes::beside(&picture).unwrap().neck(), Point::new(0.0, 0.1, 1.1));
        for (broken, word) in [
            (whole.replace("neck_m", "neck"), "neck_m"),
            (whole.replace("319.5", "NaN"), "a.json"),
            (whole.replace("319.5", "\"wide\""), "wide"),
            (whole.replace(", 1.1]", "]"), "neck_m"),
        ] {
            std::fs::write(folder.path().join("a.json"), broken).unwrap();
            let error = ImageNotes::beside(&picture).unwrap_err();
            assert!(error.contains(word) && error.contains("a.json"), "{error}");
        }
        std::fs::remove_file(folder.path().join("a.json")).unwrap();
        assert!(ImageNotes::beside(&picture).unwrap_err().contains("put fx"));
    }
}
