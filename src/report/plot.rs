//! A small plotting kit: describe a figure once, write it as SVG and PNG.
//!
//! A [`Figure`] is a grid of [`Plot`]s with one legend beside them, never over the data. A plot is two [`Axis`] and a
//! list of [`Layer`]s. Layers of one name have one colour in the whole figure; colours are Okabe and Ito's, which people
//! with colour-blindness tell apart, and neighbours differ in dash or marker too. A number that is not finite is a gap.
//! Nothing here computes statistics beyond the quartiles of a box plot.

mod axis;
mod canvas;
mod draw;
mod layer;
mod layout;
mod output;
mod space;

pub use axis::Axis;
pub use layer::{Colour, Dash, Layer, Marker};
pub use output::PlotError;
pub use space::{View, covariance_in, path_in, project};

/// One pair of axes with what is drawn on them.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Plot {
    title: String,
    x: Axis,
    y: Axis,
    equal: bool,
    layers: Vec<Layer>,
}

impl Plot {
    /// An empty plot. The title may be empty.
    #[must_use]
    pub fn new(title: impl Into<String>, x: Axis, y: Axis) -> Self {
        Self { title: title.into(), x, y, ..Self::default() }
    }

    /// Makes a unit as long on one axis as on the other: for maps and views of paths.
    #[must_use]
    pub const fn equal_units(mut self) -> Self {
        self.equal = true;
        self
    }

    /// Adds a layer above those that are there.
    #[must_use]
    pub fn with(mut self, layer: Layer) -> Self {
        self.layers.push(layer);
        self
    }

    /// Adds layers above those that are there.
    #[must_use]
    pub fn with_all(mut self, layers: impl IntoIterator<Item = Layer>) -> Self {
        self.layers.extend(layers);
        self
    }

    /// Adds a line through `points` (x, y).
    #[must_use]
    pub fn line(self, label: impl Into<String>, points: impl IntoIterator<Item = [f64; 2]>) -> Self {
        self.with(Layer::line(label, points))
    }

    /// Adds a mark at each of `points` (x, y).
    #[must_use]
    pub fn scatter(self, label: impl Into<String>, points: impl IntoIterator<Item = [f64; 2]>) -> Self {
        self.with(Layer::scatter(label, points))
    }
}

/// A grid of plots with a title and one legend.
#[derive(Clone, Debug, PartialEq)]
pub struct Figure {
    title: String,
    columns: usize,
    panel: [u32; 2],
    plots: Vec<Plot>,
}

impl Figure {
    /// Width and height of one plot in points, unless [`Figure::panel_size`] says otherwise.
    pub const PANEL: [u32; 2] = [620, 380];

    /// A figure of one plot.
    #[must_use]
    pub fn single(plot: Plot) -> Self {
        Self { title: String::new(), columns: 1, panel: Self::PANEL, plots: vec![plot] }
    }

    /// A figure of several plots in rows of `columns`, with a title above them (may be empty).
    #[must_use]
    pub fn grid(title: impl Into<String>, columns: usize, plots: impl IntoIterator<Item = Plot>) -> Self {
        Self { title: title.into(), columns: columns.max(1), panel: Self::PANEL, plots: plots.into_iter().collect() }
    }

    /// Sets width and height of each plot in points (96 to the inch).
    #[must_use]
    pub fn panel_size(mut self, width: u32, height: u32) -> Self {
        self.panel = [width.clamp(160, 4000), height.clamp(120, 4000)];
        self
    }
}

#[cfg(test)]
mod tests;
