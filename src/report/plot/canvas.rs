//! A sheet to draw on, in points, whichever backend is behind it.

use super::layer::{Colour, Dash, Marker};
use super::output::PlotError;
use plotters::coord::Shift;
use plotters::prelude::{
    Circle, DrawingArea, DrawingBackend, IntoFont, PathElement, Polygon, RGBAColor, ShapeStyle, Text,
};
use plotters::style::text_anchor::{HPos, Pos, VPos};
use plotters::style::{Color, FontStyle, FontTransform, TextStyle};

/// Where words stand relative to their place.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Anchor {
    /// Begin there, centred on its height.
    Start,
    /// Centred there, below it.
    Below,
    /// End there, centred on its height.
    End,
    /// Centred there, written upwards.
    Upwards,
}

/// How large and heavy words are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Weight {
    Small,
    Plain,
    Bold,
}

impl Weight {
    /// Height in points.
    const fn height(self) -> f64 {
        match self {
            Self::Small => 12.0,
            Self::Plain => 13.5,
            Self::Bold => 15.0,
        }
    }
}

/// A backend with a scale: places and widths are in points, `scale` pixels each.
pub(super) struct Canvas<'a, B: DrawingBackend> {
    area: &'a DrawingArea<B, Shift>,
    scale: f64,
    by_segment: bool,
}

/// A colour with an opacity.
pub(super) fn ink(colour: Colour, strength: f64) -> RGBAColor {
    let (red, green, blue) = colour.rgb();
    RGBAColor(red, green, blue, strength.clamp(0.0, 1.0))
}

impl<'a, B: DrawingBackend> Canvas<'a, B> {
    pub(super) const fn new(area: &'a DrawingArea<B, Shift>, scale: f64) -> Self {
        Self { area, scale, by_segment: false }
    }

    /// Draws each segment of a line by itself: the bitmap backend's joins shoot out of sharp corners.
    pub(super) const fn by_segment(mut self) -> Self {
        self.by_segment = true;
        self
    }

    #[expect(clippy::cast_possible_truncation, reason = "a place on a sheet of at most some ten thousand pixels")]
    fn pixel(&self, place: [f64; 2]) -> (i32, i32) {
        ((place[0] * self.scale).round() as i32, (place[1] * self.scale).round() as i32)
    }

    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a width of a few pixels")]
    fn stroke(&self, ink: RGBAColor, width: f64) -> ShapeStyle {
        ShapeStyle { color: ink, filled: false, stroke_width: (width * self.scale).round().max(1.0) as u32 }
    }

    pub(super) fn stroke_along(&self, places: &[[f64; 2]], ink: RGBAColor, width: f64) -> Result<(), PlotError> {
        let points: Vec<_> = places.iter().map(|place| self.pixel(*place)).collect();
        if points.len() < 2 {
            return Ok(());
        }
        let style = self.stroke(ink, width);
        if !self.by_segment {
            return self.area.draw(&PathElement::new(points, style)).map_err(PlotError::drawing);
        }
        points.iter().zip(points.iter().skip(1)).try_for_each(|(from, to)| {
            self.area.draw(&PathElement::new(vec![*from, *to], style)).map_err(PlotError::drawing)
        })
    }

    /// Draws a polyline with dashes; the pattern runs on over its corners.
    pub(super) fn dash_along(
        &self,
        places: &[[f64; 2]],
        ink: RGBAColor,
        width: f64,
        dash: Dash,
    ) -> Result<(), PlotError> {
        let (on, off) = match dash {
            Dash::Solid => return self.stroke_along(places, ink, width),
            Dash::Dashed => (8.0, 5.0),
            Dash::Dotted => (2.0, 4.0),
        };
        for stroke in dashes(places, on, off) {
            self.stroke_along(&stroke, ink, width)?;
        }
        Ok(())
    }

    pub(super) fn fill(&self, places: &[[f64; 2]], ink: RGBAColor) -> Result<(), PlotError> {
        let points: Vec<_> = places.iter().map(|place| self.pixel(*place)).collect();
        if points.len() < 3 {
            return Ok(());
        }
        self.area.draw(&Polygon::new(points, ink.filled())).map_err(PlotError::drawing)
    }

    #[expect(clippy::cast_possible_truncation, reason = "a radius of a few pixels")]
    fn circle(&self, place: [f64; 2], radius: f64, style: ShapeStyle) -> Result<(), PlotError> {
        self.area
            .draw(&Circle::new(self.pixel(place), (radius * self.scale).round() as i32, style))
            .map_err(PlotError::drawing)
    }

    pub(super) fn mark(&self, place: [f64; 2], marker: Marker, ink: RGBAColor) -> Result<(), PlotError> {
        const RADIUS: f64 = 3.8;
        let around = |degrees: f64, radius: f64| {
            let (sine, cosine) = degrees.to_radians().sin_cos();
            [place[0] + radius * cosine, place[1] - radius * sine]
        };
        let crossed = |degrees: &[f64]| {
            degrees.iter().try_for_each(|angle| {
                self.stroke_along(&[around(*angle, RADIUS * 1.3), around(angle + 180.0, RADIUS * 1.3)], ink, 1.6)
            })
        };
        match marker {
            Marker::Disc => self.circle(place, RADIUS, ink.filled()),
            Marker::Ring => self.circle(place, RADIUS, self.stroke(ink, 1.6)),
            Marker::Square => self.fill(&[45.0, 135.0, 225.0, 315.0].map(|angle| around(angle, RADIUS * 1.3)), ink),
            Marker::Triangle => self.fill(&[90.0, 210.0, 330.0].map(|angle| around(angle, RADIUS * 1.4)), ink),
            Marker::Cross => crossed(&[45.0, 135.0]),
            Marker::Star => crossed(&[90.0, 30.0, 150.0]),
        }
    }

    /// The width of words in points.
    pub(super) fn width_of(&self, text: &str, weight: Weight) -> Result<f64, PlotError> {
        let size =
            self.area.estimate_text_size(text, &self.style(weight, Anchor::Start)).map_err(PlotError::drawing)?;
        Ok(f64::from(size.0) / self.scale)
    }

    fn style(&self, weight: Weight, anchor: Anchor) -> TextStyle<'static> {
        let heavy = if weight == Weight::Bold { FontStyle::Bold } else { FontStyle::Normal };
        let font = ("sans-serif", weight.height() * self.scale * super::output::FONT_FACTOR).into_font().style(heavy);
        let (across, down) = match anchor {
            Anchor::Start => (HPos::Left, VPos::Center),
            Anchor::End => (HPos::Right, VPos::Center),
            Anchor::Below | Anchor::Upwards => (HPos::Center, VPos::Top),
        };
        let font = if anchor == Anchor::Upwards { font.transform(FontTransform::Rotate270) } else { font };
        TextStyle::from(font).pos(Pos::new(across, down))
    }

    pub(super) fn words(&self, place: [f64; 2], text: &str, weight: Weight, anchor: Anchor) -> Result<(), PlotError> {
        if text.is_empty() {
            return Ok(());
        }
        self.area
            .draw(&Text::new(text.to_owned(), self.pixel(place), self.style(weight, anchor)))
            .map_err(PlotError::drawing)
    }
}

/// The strokes of a broken polyline: `on` points drawn, `off` points left out.
fn dashes(places: &[[f64; 2]], on: f64, off: f64) -> Vec<Vec<[f64; 2]>> {
    let mut strokes = Vec::new();
    let (mut drawing, mut left) = (true, on);
    let mut stroke: Vec<[f64; 2]> = places.first().copied().into_iter().collect();
    for (from, to) in places.iter().zip(places.iter().skip(1)) {
        let length = (to[0] - from[0]).hypot(to[1] - from[1]);
        let mut done = 0.0;
        while length - done > left {
            done += left;
            let share = done / length;
            let turn = [from[0] + share * (to[0] - from[0]), from[1] + share * (to[1] - from[1])];
            if drawing {
                stroke.push(turn);
                strokes.push(std::mem::take(&mut stroke));
            } else {
                stroke = vec![turn];
            }
            drawing = !drawing;
            left = if drawing { on } else { off };
        }
        left -= length - done;
        if drawing {
            stroke.push(*to);
        }
    }
    if stroke.len() > 1 {
        strokes.push(stroke);
    }
    strokes
}
