//! Draws a scene row by row: each solid where it can be, the nearest one kept, labels last and once a pixel.
//!
//! A row's depths stay in the fastest memory, and what is drawn on it has been worked out once for the whole image.

use super::body::{Labeller, Solid};
use super::noise::PixelRandom;
use super::ray::Prepared;
use super::shape::Window;
use super::{Rendering, Scene, SensorNoise, noise};
use crate::geometry::{Point, Vector};
use crate::vision::part::NONE;
use crate::vision::{DepthImage, Intrinsics};

/// Whose pixel it is where nothing is met.
const NOBODY: u16 = u16::MAX;

impl Scene {
    /// Renders the scene; without `noise` the depth is true to the millimetre.
    #[must_use]
    pub fn render(
        &self,
        camera: &Intrinsics,
        (width, height): (usize, usize),
        noise: Option<&SensorNoise>,
        seed: u64,
    ) -> Rendering {
        let across: Vec<f64> = (0..width).map(|column| (column as f64 - camera.cx) / camera.fx).collect();
        let drawings = self.drawings(camera, (width, height));
        let mut line = Line::new(width);
        let mut millimetres = vec![0; width * height];
        let mut labels = vec![NONE; width * height];
        let rows = millimetres.chunks_exact_mut(width.max(1)).zip(labels.chunks_exact_mut(width.max(1)));
        for (row, (millimetres, labels)) in rows.enumerate() {
            let y = (row as f64 - camera.cy) / camera.fy;
            line.clear();
            for drawing in
                drawings.iter().filter(|drawing| (drawing.window.rows.0..drawing.window.rows.1).contains(&row))
            {
                drawing.draw(&across, y, camera, &mut line);
            }
            line.show(&across, y, &drawings, millimetres, labels);
        }
        let mut depth = DepthImage::new(width, height, millimetres).unwrap_or_default();
        if let Some(noise) = noise {
            noise::apply(&mut depth, camera, noise, &mut PixelRandom(seed));
        }
        Rendering { depth, labels }
    }

    /// The solids that can be in the image, nearest first: what they cover need not be folded.
    fn drawings(&self, camera: &Intrinsics, (width, height): (usize, usize)) -> Vec<Drawing<'_>> {
        let mut drawings: Vec<Drawing> = (0..)
            .zip(self.solids())
            .map(|(number, solid)| Drawing {
                number,
                solid,
                window: solid.shape.window(camera, width, height),
                shape: solid.shape.prepare(),
                labeller: self.labeller(solid),
            })
            .collect();
        drawings.sort_by(|one, other| one.solid.shape.nearest().total_cmp(&other.solid.shape.nearest()));
        drawings
    }
}

/// A solid that is ready to be drawn.
struct Drawing<'a> {
    /// Its place in the scene: of two that are equally near the first is seen.
    number: u16,
    solid: &'a Solid,
    window: Window,
    shape: Prepared,
    labeller: Labeller,
}

impl Drawing<'_> {
    /// Draws its part of a row.
    fn draw(&self, across: &[f64], y: f64, camera: &Intrinsics, line: &mut Line) {
        let Some((first, end)) = self.columns(across, y, camera) else { return };
        let (Some(across), Some(met)) = (across.get(first..end), line.met.get_mut(first..end)) else { return };
        self.shape.meet(across, y, met);
        let (Some(depths), Some(owners)) = (line.depths.get_mut(first..end), line.owners.get_mut(first..end)) else {
            return;
        };
        let highest = self.solid.fold_height();
        for (((x, met), depth), owner) in across.iter().zip(met).zip(depths).zip(owners) {
            // Misses are infinite, and no fold brings out what lies deeper than its height.
            if *met - highest > *depth || *met == f64::INFINITY {
                continue;
            }
            let hit = if highest > 0.0 { *met + self.solid.fold(x * *met, y * *met) } else { *met };
            if hit <= *depth && (hit < *depth || self.number < *owner) {
                (*depth, *owner) = (hit, self.number);
            }
        }
    }

    /// The columns of a row that it can cover, the end excluded.
    fn columns(&self, across: &[f64], y: f64, camera: &Intrinsics) -> Option<(usize, usize)> {
        let (first, end) = self.window.columns;
        let limits = (*across.get(first)?, *across.get(end.checked_sub(1)?)?);
        let (low, high) = self.shape.span(y, limits)?;
        let column = |x: f64| x * camera.fx + camera.cx;
        let first = first.max(whole(column(low) - 1.0));
        let end = end.min(whole(column(high) + 3.0));
        (first < end).then_some((first, end))
    }
}

/// A row while it is drawn.
struct Line {
    depths: Vec<f64>,
    owners: Vec<u16>,
    met: Vec<f64>,
}

impl Line {
    fn new(width: usize) -> Self {
        Self { depths: vec![f64::INFINITY; width], owners: vec![NOBODY; width], met: vec![f64::INFINITY; width] }
    }

    fn clear(&mut self) {
        self.depths.fill(f64::INFINITY);
        self.owners.fill(NOBODY);
    }

    /// Writes down depth and label of each pixel.
    fn show(&self, across: &[f64], y: f64, drawings: &[Drawing], millimetres: &mut [u16], labels: &mut [u8]) {
        for (shown, depth) in millimetres.iter_mut().zip(&self.depths) {
            *shown = to_millimetres(*depth);
        }
        let (mut start, mut labels) = (0, labels);
        // Neighbours mostly belong to the same solid, which is looked up once for all of them.
        for run in self.owners.chunk_by(|one, other| one == other) {
            let end = start + run.len();
            let (these, rest) = labels.split_at_mut(run.len().min(labels.len()));
            let owner = run.first().and_then(|owner| drawings.iter().find(|drawing| drawing.number == *owner));
            let (across, depths) = (across.get(start..end), self.depths.get(start..end));
            if let (Some(owner), Some(across), Some(depths)) = (owner, across, depths) {
                for ((label, x), depth) in these.iter_mut().zip(across).zip(depths) {
                    *label = owner.labeller.label(&Point::from(Vector::new(*x, y, 1.0) * *depth));
                }
            }
            (start, labels) = (end, rest);
        }
    }
}

#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "less than nothing is nothing")]
const fn whole(column: f64) -> usize {
    column.max(0.0) as usize
}

#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "the range is checked")]
fn to_millimetres(metres: f64) -> u16 {
    let millimetres = metres * 1000.0 + 0.5;
    if (1.0..10_000.0).contains(&millimetres) { millimetres as u16 } else { 0 }
}
