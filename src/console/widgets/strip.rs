//! One series of force over time: its name, its live number and its scale outside the plot at the left; the plot with
//! threshold lines, marks and gaps.

use super::dots::DotGrid;
use super::envelope::{Envelope, SERIES};
use super::text::{fill, line, span};
use crate::console::theme::{Look, Role};
use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::text::Line;

/// Columns of the label at the left: name, sign, three digits, two decimals and the unit.
pub(in crate::console) const LABEL_WIDTH: u16 = 13;

/// What one strip shows.
#[derive(Debug)]
pub(in crate::console) struct Strip<'a> {
    /// The series' name, at most four letters.
    pub(in crate::console) name: &'a str,
    /// Its live value in newtons, or what stands in its place.
    pub(in crate::console) value: Result<f64, String>,
    /// Its columns, and which of the series it is.
    pub(in crate::console) envelope: &'a Envelope,
    /// Which of the envelope's series.
    pub(in crate::console) series: usize,
    /// Thresholds in newtons, drawn as lines above and below zero.
    pub(in crate::console) threshold: Option<f64>,
    /// Newtons at the upper edge.
    pub(in crate::console) scale: f64,
    /// Newtons at the lower edge.
    pub(in crate::console) floor: f64,
    /// Columns with a mark, and whether it is selected.
    pub(in crate::console) marks: &'a [(i64, bool)],
}

/// The smallest of 1, 2, 5, 10, 20, ... that holds a value and every threshold: labels do not jump with each sample.
pub(in crate::console) fn round_scale(largest: f64) -> f64 {
    let mut scale = 1.0;
    for factor in [2.0, 2.5, 2.0].into_iter().cycle().take(12) {
        if largest <= scale {
            break;
        }
        scale *= factor;
    }
    scale
}

impl Strip<'_> {
    /// Draws the strip into an area.
    pub(in crate::console) fn draw(&self, look: Look, area: Rect, buffer: &mut Buffer) {
        let label = Rect { width: LABEL_WIDTH.min(area.width), ..area };
        fill(buffer, label, self.label(look));
        let plot =
            Rect { x: area.x.saturating_add(LABEL_WIDTH), width: area.width.saturating_sub(LABEL_WIDTH), ..area };
        let mut grid = DotGrid::new(plot);
        if self.series < SERIES {
            self.plot(look, &mut grid);
        }
        grid.draw(look, plot, buffer);
    }

    fn label(&self, look: Look) -> Vec<Line<'static>> {
        let name = span(look, Role::Title, format!("{:<4}", self.name));
        let value = match &self.value {
            Ok(value) => span(look, Role::Text, format!("{value:>7.2}")),
            Err(text) => span(look, Role::Stale, text.chars().take(8).collect::<String>()),
        };
        let scale = line(look, Role::Muted, format!(" to {:>4} N", self.scale));
        let mut lines = vec![Line::from(vec![name, value]), scale];
        if let Some(threshold) = self.threshold {
            lines.push(line(look, Role::Threshold, format!("thr {threshold:>4.1} N")));
        }
        if let Err(text) = &self.value {
            lines.insert(1, line(look, Role::Stale, text.chars().skip(8).collect::<String>()));
        }
        lines
    }

    fn plot(&self, look: Look, grid: &mut DotGrid) {
        let glyphs = look.glyphs();
        let height = grid.height();
        // First, so that a cell which the curve shares with a line has the curve's colour.
        let both = self.threshold.into_iter().flat_map(|threshold| [threshold, -threshold]);
        for threshold in both.filter(|threshold| *threshold >= self.floor) {
            grid.rule(self.row(threshold, height), Role::Threshold);
        }
        for (column, extents) in self.envelope.columns.iter().enumerate() {
            if self.envelope.gaps.get(column).copied().unwrap_or(false) {
                grid.column(column, glyphs.gap, Role::Stale);
            }
            if let Some((least, most)) = extents.get(self.series).copied().flatten() {
                for y in self.row(most, height)..=self.row(least, height) {
                    grid.dot(column, y, Role::Curve);
                }
            }
        }
        for (column, selected) in self.marks {
            let role = if *selected { Role::Focus } else { Role::Resistance };
            grid.glyph((*column as f64, 0.0), glyphs.mark, role);
        }
    }

    /// The dot row of a value; values beyond the scale stick to its edge.
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped to the plot's height")]
    fn row(&self, value: f64, height: usize) -> usize {
        let share = ((self.scale - value) / (self.scale - self.floor)).clamp(0.0, 1.0);
        (share * height.saturating_sub(1) as f64).round() as usize
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::console::ThemeName;
    use crate::console::widgets::envelope::Window;
    use crate::snapshot::ForceSample;
    use crate::time::Stamp;

    fn drawn(values: &[f64], threshold: f64) -> String {
        let stamp = |index: usize| Stamp::from_nanoseconds(index as u64 * 10_000_000);
        let samples: Vec<_> = values
            .iter()
            .enumerate()
            .map(|(index, value)| ForceSample { stamp: stamp(index), force: [*value, 0.0, 0.0], ..Default::default() })
            .collect();
        let window = Window { now: stamp(values.len() - 1), span: 0.1, columns: 20, gap: 0.05 };
        let envelope = Envelope::new(samples.iter().rev(), window, |sample| [Some(sample.force[0]), None, None, None]);
        let strip = Strip {
            name: "x",
            value: Ok(values[values.len() - 1]),
            envelope: &envelope,
            series: 0,
            threshold: Some(threshold),
            scale: round_scale(threshold.max(envelope.largest())),
            floor: -round_scale(threshold.max(envelope.largest())),
            marks: &[(18, false)],
        };
        let area = Rect::new(0, 0, LABEL_WIDTH + 10, 4);
        let mut buffer = Buffer::empty(area);
        strip.draw(Look { theme: ThemeName::Mono, ascii: true }, area, &mut buffer);
        let row = |y| (0..area.width).map(|x| buffer[(x, y)].symbol()).collect::<String>();
        (0..area.height).map(row).collect::<Vec<_>>().join("\n")
    }

    #[test]
    fn the_number_is_live_and_the_threshold_is_drawn_on_both_sides() {
        let text = drawn(&[0.0, 0.0, 8.0, 0.0, 0.0], 5.0);
        let rows: Vec<&str> = text.lines().collect();
        assert!(rows[0].starts_with("x      0.00"), "{text}");
        assert!(rows[1].contains("10 N") && rows[2].contains("thr  5.0 N"), "{text}");
        assert!(rows[0].ends_with('v'), "{text}");
        assert!(rows[1][13..].starts_with("''") && rows[2][13..].starts_with(".."), "{text}");
        assert!(rows[1].contains('|'), "the spike is one piece: {text}");
    }

    #[test]
    fn scales_are_round_and_hold_what_they_must() {
        for (largest, scale) in
            [(0.0, 1.0), (1.5, 2.0), (5.0, 5.0), (6.0, 10.0), (18.0, 20.0), (33.0, 50.0), (51.0, 100.0)]
        {
            assert!((round_scale(largest) - scale).abs() < 1e-9, "{largest} {}", round_scale(largest));
        }
    }
}
