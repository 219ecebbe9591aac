//! Draws a figure: titles, axes, layers, legend.

use super::canvas::{Anchor, Canvas, Weight, ink};
use super::layer::{Bar, Colour, Dash, Layer, Marker, Shape};
use super::layout::{Frame, Layout, Map};
use super::output::PlotError;
use super::{Figure, Plot};
use plotters::prelude::DrawingBackend;

/// One name of the legend, with the looks that go with it.
struct Entry<'a> {
    label: &'a str,
    layer: &'a Layer,
    looks: Looks,
}

#[derive(Clone, Copy)]
struct Looks {
    colour: Colour,
    marker: Marker,
}

/// Width of the sample beside a name of the legend, and height of its row, in points.
const SAMPLE: f64 = 34.0;
const ROW: f64 = 22.0;

/// The size of a figure's sheet in points.
pub(super) fn size_of(figure: &Figure, legend_width: f64) -> [f64; 2] {
    Layout::of(figure, legend_width).size
}

/// The width in points that the figure's legend needs; 0 where it has none.
pub(super) fn legend_width<B: DrawingBackend>(figure: &Figure, canvas: &Canvas<'_, B>) -> Result<f64, PlotError> {
    let mut widest: f64 = 0.0;
    for entry in entries(figure) {
        widest = widest.max(canvas.width_of(entry.label, Weight::Small)?);
    }
    Ok(if widest > 0.0 { widest + SAMPLE + 30.0 } else { 0.0 })
}

/// Draws the whole figure.
pub(super) fn figure<B: DrawingBackend>(
    figure: &Figure,
    legend_width: f64,
    canvas: &Canvas<'_, B>,
) -> Result<(), PlotError> {
    let layout = Layout::of(figure, legend_width);
    let entries = entries(figure);
    canvas.words([layout.size[0] / 2.0, 10.0], &figure.title, Weight::Bold, Anchor::Below)?;
    for (plot, panel) in figure.plots.iter().zip(&layout.panels) {
        draw_plot(plot, *panel, &entries, canvas)?;
    }
    for (row, entry) in entries.iter().enumerate() {
        let place = [layout.legend_left + 4.0, layout.top + 44.0 + row as f64 * ROW];
        sample(entry, place, canvas)?;
        canvas.words([place[0] + SAMPLE, place[1]], entry.label, Weight::Small, Anchor::Start)?;
    }
    Ok(())
}

/// The names of a figure in order of appearance. A name has the looks of the first layer that bears it.
fn entries(figure: &Figure) -> Vec<Entry<'_>> {
    let mut found: Vec<Entry<'_>> = Vec::new();
    for layer in figure.plots.iter().flat_map(|plot| &plot.layers) {
        if layer.label.is_empty() || found.iter().any(|entry| entry.label == layer.label) {
            continue;
        }
        let looks = Looks {
            colour: layer.colour.unwrap_or_else(|| nth(&Colour::ORDER, found.len(), Colour::Black)),
            marker: layer.marker.unwrap_or_else(|| nth(&Marker::ORDER, found.len(), Marker::Disc)),
        };
        found.push(Entry { label: &layer.label, layer, looks });
    }
    found
}

fn nth<T: Copy>(list: &[T], index: usize, otherwise: T) -> T {
    list.get(index % list.len().max(1)).copied().unwrap_or(otherwise)
}

fn looks_of(layer: &Layer, entries: &[Entry<'_>]) -> Looks {
    let named = entries.iter().find(|entry| entry.label == layer.label).map(|entry| entry.looks);
    let fallback = named.unwrap_or(Looks { colour: Colour::Black, marker: Marker::Disc });
    Looks { colour: layer.colour.unwrap_or(fallback.colour), marker: layer.marker.unwrap_or(fallback.marker) }
}

fn draw_plot<B: DrawingBackend>(
    plot: &Plot,
    panel: Frame,
    entries: &[Entry<'_>],
    canvas: &Canvas<'_, B>,
) -> Result<(), PlotError> {
    let map = Map::of(plot, panel);
    axes(plot, &map, panel, canvas)?;
    for layer in &plot.layers {
        Brush { canvas, map: &map, layer, looks: looks_of(layer, entries) }.draw()?;
    }
    outline(&map.frame, canvas)
}

fn outline<B: DrawingBackend>(frame: &Frame, canvas: &Canvas<'_, B>) -> Result<(), PlotError> {
    let corners = [
        [frame.left, frame.top],
        [frame.right, frame.top],
        [frame.right, frame.bottom],
        [frame.left, frame.bottom],
        [frame.left, frame.top],
    ];
    canvas.stroke_along(&corners, ink(Colour::Black, 0.7), 1.0)
}

fn axes<B: DrawingBackend>(plot: &Plot, map: &Map, panel: Frame, canvas: &Canvas<'_, B>) -> Result<(), PlotError> {
    let frame = map.frame;
    let grid = ink(Colour::Black, 0.13);
    let middle = f64::midpoint(frame.left, frame.right);
    canvas.words([middle, panel.top + 7.0], &plot.title, Weight::Bold, Anchor::Below)?;
    canvas.words([middle, frame.bottom + 24.0], &plot.x.label, Weight::Plain, Anchor::Below)?;
    let height = f64::midpoint(frame.top, frame.bottom);
    canvas.words([panel.left + 12.0, height], &plot.y.label, Weight::Plain, Anchor::Upwards)?;
    // Marks as dense as their words allow: some 70 points apart across, 45 down.
    let (across, down) = (marks_for(frame.width(), 70.0), marks_for(frame.height(), 45.0));
    for (value, text) in plot.x.marks(map.x, across) {
        let x = map.across(value);
        canvas.stroke_along(&[[x, frame.top], [x, frame.bottom]], grid, 1.0)?;
        canvas.words([x, frame.bottom + 6.0], &text, Weight::Small, Anchor::Below)?;
    }
    for (value, text) in plot.y.marks(map.y, down) {
        let y = map.down(value);
        canvas.stroke_along(&[[frame.left, y], [frame.right, y]], grid, 1.0)?;
        canvas.words([frame.left - 7.0, y], &text, Weight::Small, Anchor::End)?;
    }
    Ok(())
}

#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a small positive count")]
fn marks_for(length: f64, apart: f64) -> usize {
    (length / apart).max(2.0) as usize
}

fn sample<B: DrawingBackend>(entry: &Entry<'_>, place: [f64; 2], canvas: &Canvas<'_, B>) -> Result<(), PlotError> {
    let full = ink(entry.looks.colour, 1.0);
    let (from, to) = ([place[0], place[1]], [place[0] + 26.0, place[1]]);
    let block = |height: f64| {
        [[from[0], from[1] - height], [to[0], from[1] - height], [to[0], from[1] + height], [from[0], from[1] + height]]
    };
    match &entry.layer.shape {
        Shape::Line { marked, .. } => {
            canvas.dash_along(&[from, to], full, entry.layer.width, entry.layer.dash)?;
            if *marked { canvas.mark([place[0] + 13.0, place[1]], entry.looks.marker, full) } else { Ok(()) }
        }
        Shape::Across { .. } | Shape::Upright { .. } => {
            canvas.dash_along(&[from, to], full, entry.layer.width, entry.layer.dash)
        }
        Shape::Scatter { .. } => canvas.mark([place[0] + 13.0, place[1]], entry.looks.marker, full),
        Shape::Band { .. } | Shape::Stretch { .. } => {
            canvas.fill(&block(6.0), ink(entry.looks.colour, entry.layer.strength))
        }
        Shape::Ellipse { .. } | Shape::Boxes { .. } => {
            canvas.fill(&block(6.0), ink(entry.looks.colour, 0.35))?;
            canvas.stroke_along(&closed(&block(6.0)), full, 1.2)
        }
        Shape::Bars { .. } => canvas.fill(&block(6.0), full),
        Shape::Words { .. } => Ok(()),
    }
}

fn closed(corners: &[[f64; 2]]) -> Vec<[f64; 2]> {
    corners.iter().chain(corners.first()).copied().collect()
}

/// Draws one layer into one frame.
struct Brush<'a, B: DrawingBackend> {
    canvas: &'a Canvas<'a, B>,
    map: &'a Map,
    layer: &'a Layer,
    looks: Looks,
}

impl<B: DrawingBackend> Brush<'_, B> {
    fn draw(&self) -> Result<(), PlotError> {
        let full = ink(self.looks.colour, self.layer.strength);
        match &self.layer.shape {
            Shape::Line { points, marked } => {
                self.polyline(points, self.layer.dash)?;
                if *marked { self.marks(points) } else { Ok(()) }
            }
            Shape::Scatter { points } => self.marks(points),
            Shape::Band { rows } => self.band(rows),
            Shape::Ellipse { outline } => self.ellipse(outline),
            Shape::Bars { bars, width } => bars.iter().try_for_each(|bar| self.bar(bar, *width)),
            Shape::Boxes { boxes, width } => {
                boxes.iter().try_for_each(|(at, values)| self.quartile_box(*at, values, *width))
            }
            Shape::Across { y } => self.polyline(&[[self.map.x[0], *y], [self.map.x[1], *y]], self.layer.dash),
            Shape::Upright { x } => self.polyline(&[[*x, self.map.y[0]], [*x, self.map.y[1]]], self.layer.dash),
            Shape::Stretch { from, to } => {
                let [low, high] = self.map.y;
                self.area(&[[*from, low], [*to, low], [*to, high], [*from, high]], full)
            }
            Shape::Words { at, text } => self
                .map
                .place(*at)
                .map_or(Ok(()), |[x, y]| self.canvas.words([x + 7.0, y - 8.0], text, Weight::Small, Anchor::Start)),
        }
    }

    /// A line that is cut at the frame and interrupted where a point is not finite.
    fn polyline(&self, points: &[[f64; 2]], dash: Dash) -> Result<(), PlotError> {
        let full = ink(self.looks.colour, self.layer.strength);
        let mut run: Vec<[f64; 2]> = Vec::new();
        for (from, to) in points.iter().zip(points.iter().skip(1)) {
            let stroke = self.map.place(*from).zip(self.map.place(*to));
            let Some((from, to)) = stroke.and_then(|(from, to)| self.map.frame.cut(from, to)) else {
                self.canvas.dash_along(&std::mem::take(&mut run), full, self.layer.width, dash)?;
                continue;
            };
            if run.last() != Some(&from) {
                self.canvas.dash_along(&std::mem::take(&mut run), full, self.layer.width, dash)?;
                run.push(from);
            }
            run.push(to);
        }
        self.canvas.dash_along(&run, full, self.layer.width, dash)
    }

    fn marks(&self, points: &[[f64; 2]]) -> Result<(), PlotError> {
        let full = ink(self.looks.colour, self.layer.strength);
        let places = points.iter().filter_map(|point| self.map.place(*point));
        places
            .filter(|place| self.map.frame.contains(*place))
            .try_for_each(|place| self.canvas.mark(place, self.looks.marker, full))
    }

    fn area(&self, corners: &[[f64; 2]], ink: plotters::style::RGBAColor) -> Result<(), PlotError> {
        let places: Vec<_> = corners.iter().filter_map(|corner| self.map.held(*corner)).collect();
        self.canvas.fill(&places, ink)
    }

    fn band(&self, rows: &[[f64; 3]]) -> Result<(), PlotError> {
        let full = ink(self.looks.colour, self.layer.strength);
        for run in rows.split(|row| row.iter().any(|value| !value.is_finite())) {
            let lower = run.iter().map(|[x, low, _]| [*x, *low]);
            let upper = run.iter().rev().map(|[x, _, high]| [*x, *high]);
            self.area(&lower.chain(upper).collect::<Vec<_>>(), full)?;
        }
        Ok(())
    }

    fn ellipse(&self, outline: &[[f64; 2]]) -> Result<(), PlotError> {
        self.area(outline, ink(self.looks.colour, 0.06 + 0.3 * self.layer.strength))?;
        let places: Vec<_> = outline.iter().filter_map(|point| self.map.held(*point)).collect();
        self.canvas.stroke_along(&places, ink(self.looks.colour, 0.8), self.layer.width)
    }

    fn bar(&self, bar: &Bar, width: f64) -> Result<(), PlotError> {
        let full = ink(self.looks.colour, self.layer.strength);
        let (left, right) = (bar.at - width / 2.0, bar.at + width / 2.0);
        self.area(&[[left, 0.0], [right, 0.0], [right, bar.height], [left, bar.height]], full)?;
        if bar.error > 0.0 {
            self.whisker(bar.at, bar.height - bar.error, bar.height + bar.error, width / 4.0, Colour::Black)?;
        }
        Ok(())
    }

    /// An upright stroke from `low` to `high` with a short bar at each end.
    fn whisker(&self, at: f64, low: f64, high: f64, half: f64, colour: Colour) -> Result<(), PlotError> {
        let strokes =
            [[[at, low], [at, high]], [[at - half, low], [at + half, low]], [[at - half, high], [at + half, high]]];
        for [from, to] in strokes {
            if let Some((from, to)) = self.map.held(from).zip(self.map.held(to)) {
                self.canvas.stroke_along(&[from, to], ink(colour, 1.0), 1.3)?;
            }
        }
        Ok(())
    }

    fn quartile_box(&self, at: f64, values: &[f64], width: f64) -> Result<(), PlotError> {
        let Some(summary) = Quartiles::of(values) else { return Ok(()) };
        let (left, right) = (at - width / 2.0, at + width / 2.0);
        self.whisker(at, summary.lowest, summary.first, width / 5.0, self.looks.colour)?;
        self.whisker(at, summary.third, summary.highest, width / 5.0, self.looks.colour)?;
        let corners = [[left, summary.first], [right, summary.first], [right, summary.third], [left, summary.third]];
        self.area(&corners, ink(self.looks.colour, 0.35))?;
        self.polyline(&closed(&corners), Dash::Solid)?;
        self.polyline(&[[left, summary.median], [right, summary.median]], Dash::Solid)?;
        for value in summary.beyond {
            if let Some(place) = self.map.place([at, value]) {
                self.canvas.mark(place, Marker::Ring, ink(self.looks.colour, 1.0))?;
            }
        }
        Ok(())
    }
}

/// What a box plot shows of some values.
#[derive(Debug, PartialEq)]
pub(super) struct Quartiles {
    pub(super) lowest: f64,
    pub(super) first: f64,
    pub(super) median: f64,
    pub(super) third: f64,
    pub(super) highest: f64,
    pub(super) beyond: Vec<f64>,
}

impl Quartiles {
    /// Quartiles by linear interpolation between the ordered values (Hyndman and Fan 1996, type 7); values that are not
    /// finite are left out. `None` where none remains.
    pub(super) fn of(values: &[f64]) -> Option<Self> {
        let mut ordered: Vec<f64> = values.iter().copied().filter(|value| value.is_finite()).collect();
        ordered.sort_by(f64::total_cmp);
        let quartile = |share: f64| quantile(&ordered, share);
        let (first, median, third) = (quartile(0.25)?, quartile(0.5)?, quartile(0.75)?);
        let reach = 1.5 * (third - first);
        let near = |value: &&f64| (first - reach..=third + reach).contains(*value);
        let lowest = ordered.iter().find(near).copied()?;
        let highest = ordered.iter().rev().find(near).copied()?;
        let beyond = ordered.iter().copied().filter(|value| !near(&value)).collect();
        Some(Self { lowest, first, median, third, highest, beyond })
    }
}

#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "an index into the values")]
fn quantile(ordered: &[f64], share: f64) -> Option<f64> {
    let place = share * ordered.len().checked_sub(1)? as f64;
    let below = ordered.get(place.floor() as usize)?;
    let above = ordered.get(place.ceil() as usize)?;
    Some(below + (above - below) * place.fract())
}
