//! Turns a figure into SVG and PNG.

use super::canvas::Canvas;
use super::{Figure, draw};
use plotters::prelude::{BitMapBackend, DrawingBackend, IntoDrawingArea, SVGBackend, WHITE};
use plotters::style::{FontStyle, register_font};
use std::fmt::Display;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::OnceLock;
use thiserror::Error;

/// Why a figure could not be drawn or written.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum PlotError {
    /// The drawing itself failed.
    #[error("a plot could not be drawn: {0}")]
    Drawing(String),
    /// The picture could not be put into its format.
    #[error("a plot could not be put into PNG: {0}")]
    Encoding(#[from] png::EncodingError),
    /// A file could not be written.
    #[error("the plot {path} could not be written: {source}. Check the folder and the space on its disk")]
    Writing {
        /// Which file.
        path: PathBuf,
        /// Why.
        source: std::io::Error,
    },
}

impl PlotError {
    pub(super) fn drawing(error: impl Display) -> Self {
        Self::Drawing(error.to_string())
    }
}

/// The drawing library writes a font's size divided by this into SVG; the same factor keeps both formats alike.
pub(super) const FONT_FACTOR: f64 = 1.24;

/// Sub-units of a point in SVG: the drawing library places everything on whole units.
const SVG_UNITS: f64 = 8.0;
/// Pixels a point in a PNG that is drawn, and how many of them make one pixel that is kept (across and down).
const PNG_DRAWN: u32 = 4;
const PNG_KEPT: u32 = 2;

static FONTS: OnceLock<bool> = OnceLock::new();

/// Registers the shipped fonts once, so that words look the same on every machine.
fn fonts() -> Result<(), PlotError> {
    let registered = FONTS.get_or_init(|| {
        let plain = include_bytes!("../../../assets/DejaVuSans-subset.ttf");
        let bold = include_bytes!("../../../assets/DejaVuSans-Bold-subset.ttf");
        register_font("sans-serif", FontStyle::Normal, plain).is_ok()
            && register_font("sans-serif", FontStyle::Bold, bold).is_ok()
    });
    if *registered { Ok(()) } else { Err(PlotError::Drawing("the shipped font is not readable".into())) }
}

impl Figure {
    /// The figure as an SVG document.
    ///
    /// # Errors
    /// [`PlotError::Drawing`] where the drawing library refuses.
    pub fn svg(&self) -> Result<String, PlotError> {
        let (legend_width, size) = self.measure()?;
        let mut text = String::new();
        let units = size.map(|length| pixels(length * SVG_UNITS));
        {
            let backend = SVGBackend::with_string(&mut text, (units[0], units[1]));
            self.draw_on(backend, SVG_UNITS, legend_width, false)?;
        }
        // The sheet is drawn in sub-units; its size on a page is in points.
        let drawn = format!("width=\"{}\" height=\"{}\" viewBox", units[0], units[1]);
        let shown = format!("width=\"{}\" height=\"{}\" role=\"img\" viewBox", pixels(size[0]), pixels(size[1]));
        Ok(text.replacen(&drawn, &shown, 1))
    }

    /// The figure as a PNG file's bytes, two pixels a point.
    ///
    /// # Errors
    /// [`PlotError::Drawing`] or [`PlotError::Encoding`].
    pub fn png(&self) -> Result<Vec<u8>, PlotError> {
        let (legend_width, size) = self.measure()?;
        let drawn = size.map(|length| pixels(length) * PNG_DRAWN);
        let mut buffer = vec![255; drawn[0] as usize * drawn[1] as usize * 3];
        {
            let backend = BitMapBackend::with_buffer(&mut buffer, (drawn[0], drawn[1]));
            self.draw_on(backend, f64::from(PNG_DRAWN), legend_width, true)?;
        }
        encoded(&smoothed(&buffer, drawn[0] as usize), drawn.map(|length| length / PNG_KEPT))
    }

    /// Writes `STEM.svg` and `STEM.png` into a folder, which is made where it does not exist. Returns the SVG document.
    ///
    /// # Errors
    /// [`PlotError`] names the file that could not be written, or says why the figure could not be drawn.
    pub fn save(&self, folder: &Path, stem: &str) -> Result<String, PlotError> {
        let failed = |path: &Path| {
            let path = path.to_path_buf();
            move |source| PlotError::Writing { path, source }
        };
        fs::create_dir_all(folder).map_err(failed(folder))?;
        let vector = folder.join(format!("{stem}.svg"));
        let document = self.svg()?;
        fs::write(&vector, &document).map_err(failed(&vector))?;
        let picture = folder.join(format!("{stem}.png"));
        fs::write(&picture, self.png()?).map_err(failed(&picture))?;
        Ok(document)
    }

    /// The legend's width and the size of the sheet, in points.
    fn measure(&self) -> Result<(f64, [f64; 2]), PlotError> {
        fonts()?;
        let mut nothing = String::new();
        let area = SVGBackend::with_string(&mut nothing, (8, 8)).into_drawing_area();
        let legend_width = draw::legend_width(self, &Canvas::new(&area, 1.0))?;
        Ok((legend_width, draw::size_of(self, legend_width)))
    }

    fn draw_on<B: DrawingBackend>(
        &self,
        backend: B,
        scale: f64,
        legend_width: f64,
        bitmap: bool,
    ) -> Result<(), PlotError> {
        let area = backend.into_drawing_area();
        area.fill(&WHITE).map_err(PlotError::drawing)?;
        let canvas = Canvas::new(&area, scale);
        draw::figure(self, legend_width, &if bitmap { canvas.by_segment() } else { canvas })?;
        area.present().map_err(PlotError::drawing)
    }
}

#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "the size of a sheet, at most some 100 000"
)]
fn pixels(length: f64) -> u32 {
    length.clamp(1.0, 100_000.0).round() as u32
}

/// Each square of [`PNG_KEPT`] by [`PNG_KEPT`] drawn pixels becomes their mean: strokes get smooth edges.
fn smoothed(drawn: &[u8], width: usize) -> Vec<u8> {
    let kept = PNG_KEPT as usize;
    let mut picture = Vec::with_capacity(drawn.len() / (kept * kept));
    let mut sums = vec![0_u32; width / kept * 3];
    for rows in drawn.chunks_exact(width * 3 * kept) {
        sums.fill(0);
        for row in rows.chunks_exact(width * 3) {
            for (sum, square) in sums.chunks_exact_mut(3).zip(row.chunks_exact(3 * kept)) {
                let values = square.chunks_exact(3).flat_map(|pixel| pixel.iter().enumerate());
                values.for_each(|(channel, value)| {
                    if let Some(sum) = sum.get_mut(channel) {
                        *sum += u32::from(*value);
                    }
                });
            }
        }
        let means = sums.iter().map(|sum| u8::try_from(sum / (PNG_KEPT * PNG_KEPT)).unwrap_or(u8::MAX));
        picture.extend(means);
    }
    picture
}

fn encoded(picture: &[u8], size: [u32; 2]) -> Result<Vec<u8>, PlotError> {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, size[0], size[1]);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_compression(png::Compression::Fast);
    encoder.write_header()?.write_image_data(picture)?;
    Ok(bytes)
}
