//! Where everything stands: the panels of a figure, the frame of each plot, and how data fall into a frame.

use super::{Figure, Plot};

/// A rectangle in points: left, top, right, bottom.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Frame {
    pub(super) left: f64,
    pub(super) top: f64,
    pub(super) right: f64,
    pub(super) bottom: f64,
}

/// Height of a figure's title, in points.
const TITLE: f64 = 34.0;
/// Room for a plot's title, its lower and its left words, in points.
const ABOVE: f64 = 30.0;
const BELOW: f64 = 50.0;
const BESIDE: f64 = 72.0;
const MARGIN: f64 = 16.0;

/// The places of a figure's parts.
#[derive(Debug)]
pub(super) struct Layout {
    pub(super) size: [f64; 2],
    pub(super) legend_left: f64,
    pub(super) top: f64,
    pub(super) panels: Vec<Frame>,
}

impl Layout {
    /// Lays a figure out with a legend `legend_width` points wide (0 for none).
    pub(super) fn of(figure: &Figure, legend_width: f64) -> Self {
        let [width, height] = figure.panel.map(f64::from);
        let columns = figure.columns.min(figure.plots.len()).max(1);
        let rows = figure.plots.len().div_ceil(columns).max(1);
        let top = if figure.title.is_empty() { 0.0 } else { TITLE };
        let panels = (0..figure.plots.len())
            .map(|index| {
                let left = (index % columns) as f64 * width;
                let above = top + (index / columns) as f64 * height;
                Frame { left, top: above, right: left + width, bottom: above + height }
            })
            .collect();
        let legend_left = columns as f64 * width;
        Self { size: [legend_left + legend_width, top + rows as f64 * height], legend_left, top, panels }
    }
}

/// A plot's frame with the ranges that it shows.
#[derive(Clone, Copy, Debug)]
pub(super) struct Map {
    pub(super) frame: Frame,
    pub(super) x: [f64; 2],
    pub(super) y: [f64; 2],
    reversed: [bool; 2],
}

impl Map {
    /// Finds the ranges of a plot's axes and its frame inside a panel.
    pub(super) fn of(plot: &Plot, panel: Frame) -> Self {
        let frame = Frame {
            left: panel.left + BESIDE,
            top: panel.top + if plot.title.is_empty() { MARGIN } else { ABOVE },
            right: panel.right - MARGIN,
            bottom: panel.bottom - BELOW,
        };
        let points: Vec<_> = plot.layers.iter().flat_map(super::Layer::extent).collect();
        let mut x = plot.x.span(extremes(points.iter().map(|point| point[0])));
        let mut y = plot.y.span(extremes(points.iter().map(|point| point[1])));
        if plot.equal {
            let unit = ((x[1] - x[0]) / frame.width()).max((y[1] - y[0]) / frame.height());
            x = widened(x, unit * frame.width());
            y = widened(y, unit * frame.height());
        }
        Self { frame, x, y, reversed: [plot.x.reversed, plot.y.reversed] }
    }

    /// The place of a value of x, in points from the left.
    pub(super) fn across(&self, x: f64) -> f64 {
        let share = share_of(x, self.x, self.reversed[0]);
        self.frame.left + share * self.frame.width()
    }

    /// The place of a value of y, in points from the top.
    pub(super) fn down(&self, y: f64) -> f64 {
        let share = share_of(y, self.y, self.reversed[1]);
        self.frame.bottom - share * self.frame.height()
    }

    /// The place of a point; `None` where a number is not finite.
    pub(super) fn place(&self, point: [f64; 2]) -> Option<[f64; 2]> {
        let place = [self.across(point[0]), self.down(point[1])];
        place.iter().all(|value| value.is_finite()).then_some(place)
    }

    /// The place of a point, moved to the edge where it lies outside.
    pub(super) fn held(&self, point: [f64; 2]) -> Option<[f64; 2]> {
        let [across, down] = self.place(point)?;
        Some([across.clamp(self.frame.left, self.frame.right), down.clamp(self.frame.top, self.frame.bottom)])
    }
}

fn share_of(value: f64, range: [f64; 2], reversed: bool) -> f64 {
    let share = (value - range[0]) / (range[1] - range[0]);
    if reversed { 1.0 - share } else { share }
}

fn widened(range: [f64; 2], length: f64) -> [f64; 2] {
    let middle = f64::midpoint(range[0], range[1]);
    [middle - length / 2.0, middle + length / 2.0]
}

/// The lowest and highest finite value.
fn extremes(values: impl Iterator<Item = f64>) -> Option<[f64; 2]> {
    values.filter(|value| value.is_finite()).fold(None, |found, value| match found {
        None => Some([value, value]),
        Some([low, high]) => Some([low.min(value), high.max(value)]),
    })
}

impl Frame {
    pub(super) fn width(&self) -> f64 {
        self.right - self.left
    }

    pub(super) fn height(&self) -> f64 {
        self.bottom - self.top
    }

    pub(super) fn contains(&self, place: [f64; 2]) -> bool {
        // A point on the edge counts as inside, rounding included.
        (self.left - 0.5..=self.right + 0.5).contains(&place[0])
            && (self.top - 0.5..=self.bottom + 0.5).contains(&place[1])
    }

    /// The part of a stroke that lies inside (Liang and Barsky 1984); `None` where none does.
    pub(super) fn cut(&self, from: [f64; 2], to: [f64; 2]) -> Option<([f64; 2], [f64; 2])> {
        let along = [to[0] - from[0], to[1] - from[1]];
        let (mut enter, mut leave) = (0.0_f64, 1.0_f64);
        let edges = [
            (-along[0], from[0] - self.left),
            (along[0], self.right - from[0]),
            (-along[1], from[1] - self.top),
            (along[1], self.bottom - from[1]),
        ];
        for (direction, distance) in edges {
            if direction == 0.0 {
                if distance < 0.0 {
                    return None;
                }
            } else if direction < 0.0 {
                enter = enter.max(distance / direction);
            } else {
                leave = leave.min(distance / direction);
            }
        }
        let at = |share: f64| [from[0] + share * along[0], from[1] + share * along[1]];
        (enter <= leave).then(|| (at(enter), at(leave)))
    }
}
