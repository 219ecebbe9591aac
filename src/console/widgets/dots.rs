//! A grid of dots, two by four in a cell, with glyphs on top: braille where Unicode may be written, else ASCII.

use crate::console::theme::{Look, Role};
use ratatui::buffer::Buffer;
use ratatui::layout::Rect;

/// Dots of a braille cell by row and column (Unicode block U+2800).
const BITS: [[u8; 2]; 4] = [[0x01, 0x08], [0x02, 0x10], [0x04, 0x20], [0x40, 0x80]];

/// A grid of dots over an area of cells. Dots outside it are left out.
#[derive(Clone, Debug)]
pub(in crate::console) struct DotGrid {
    columns: usize,
    rows: usize,
    cells: Vec<(u8, Role)>,
    glyphs: Vec<Option<(char, Role)>>,
}

impl DotGrid {
    /// An empty grid for an area.
    pub(in crate::console) fn new(area: Rect) -> Self {
        let (columns, rows) = (usize::from(area.width), usize::from(area.height));
        let count = columns * rows;
        Self { columns, rows, cells: vec![(0, Role::Text); count], glyphs: vec![None; count] }
    }

    /// Dots from left to right.
    pub(in crate::console) const fn width(&self) -> usize {
        self.columns * 2
    }

    /// Dots from top to bottom.
    pub(in crate::console) const fn height(&self) -> usize {
        self.rows * 4
    }

    /// Sets a dot; `x` from the left, `y` from the top.
    pub(in crate::console) fn dot(&mut self, x: usize, y: usize, role: Role) {
        if x >= self.width() || y >= self.height() {
            return;
        }
        let bit = BITS.get(y % 4).and_then(|row| row.get(x % 2)).copied().unwrap_or(0);
        if let Some(cell) = self.cells.get_mut(y / 4 * self.columns + x / 2) {
            *cell = (cell.0 | bit, role);
        }
    }

    /// Sets a dot at a place that is not rounded yet.
    pub(in crate::console) fn point(&mut self, place: (f64, f64), role: Role) {
        if let Some((x, y)) = self.rounded(place) {
            self.dot(x, y, role);
        }
    }

    /// Draws a straight line of dots.
    pub(in crate::console) fn line(&mut self, start: (f64, f64), end: (f64, f64), role: Role) {
        self.dashes(start, end, 1, role);
    }

    /// Draws every `step`-th dot of a straight line.
    pub(in crate::console) fn dashes(&mut self, start: (f64, f64), end: (f64, f64), step: usize, role: Role) {
        let (run, rise) = (end.0 - start.0, end.1 - start.1);
        let longest = run.abs().max(rise.abs());
        if !longest.is_finite() || !start.0.is_finite() || !start.1.is_finite() {
            return;
        }
        // A line that leaves the grid by far is not walked dot by dot.
        let most = (self.width() + self.height()) * 4;
        let count = count_of(longest).min(most).max(1);
        for index in (0..=count).step_by(step.max(1)) {
            let share = index as f64 / count as f64;
            self.point((start.0 + run * share, start.1 + rise * share), role);
        }
    }

    /// Puts a glyph on the cell of a dot.
    pub(in crate::console) fn glyph(&mut self, place: (f64, f64), glyph: char, role: Role) {
        if let Some((x, y)) = self.rounded(place)
            && let Some(cell) = self.glyphs.get_mut(y / 4 * self.columns + x / 2)
        {
            *cell = Some((glyph, role));
        }
    }

    /// Draws a horizontal line of every second dot, at the exact height: it stays in sight beside a curve in the same cell.
    pub(in crate::console) fn rule(&mut self, y: usize, role: Role) {
        for x in (0..self.width()).step_by(2) {
            self.dot(x, y, role);
        }
    }

    /// Fills a column of cells with a glyph.
    pub(in crate::console) fn column(&mut self, x: usize, glyph: char, role: Role) {
        for row in 0..self.rows {
            if let Some(cell) = self.glyphs.get_mut(row * self.columns + x / 2).filter(|_| x < self.columns * 2) {
                *cell = Some((glyph, role));
            }
        }
    }

    /// Draws the grid into an area.
    pub(in crate::console) fn draw(&self, look: Look, area: Rect, buffer: &mut Buffer) {
        let cells = self.cells.iter().zip(&self.glyphs).enumerate();
        for (index, ((dots, role), glyph)) in cells {
            let (letter, role) = match glyph {
                Some((glyph, role)) => (*glyph, *role),
                None if *dots == 0 => continue,
                None if look.ascii => (ascii(*dots), *role),
                None => (char::from_u32(0x2800 + u32::from(*dots)).unwrap_or(' '), *role),
            };
            let column = u16::try_from(index % self.columns).unwrap_or(u16::MAX);
            let row = u16::try_from(index / self.columns).unwrap_or(u16::MAX);
            let place = (area.x.saturating_add(column), area.y.saturating_add(row));
            if let Some(cell) = buffer.cell_mut(place).filter(|_| column < area.width && row < area.height) {
                cell.set_char(letter).set_style(look.style(role));
            }
        }
    }

    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "checked against the grid's own size")]
    fn rounded(&self, (x, y): (f64, f64)) -> Option<(usize, usize)> {
        let inside = |value: f64, size: usize| value >= -0.5 && value < size as f64 - 0.5;
        (inside(x, self.width()) && inside(y, self.height())).then(|| (x.round() as usize, y.round() as usize))
    }
}

#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a length in dots, not negative")]
fn count_of(length: f64) -> usize {
    length.min(1e6).ceil() as usize
}

/// The letter that looks most like a braille cell.
const fn ascii(dots: u8) -> char {
    let top = dots & 0x09 != 0;
    let middle = dots & 0x36 != 0;
    let bottom = dots & 0xC0 != 0;
    match (top, middle, bottom) {
        (true, true, true) => '|',
        (true, true, false) => '"',
        (true, false, false) => '\'',
        (false, true, true) | (true, false, true) => ':',
        (false, true, false) => '-',
        (false, false, true) => '.',
        (false, false, false) => ' ',
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::console::ThemeName;
    use proptest::prelude::*;

    fn drawn(grid: &DotGrid, area: Rect, ascii: bool) -> Vec<String> {
        let mut buffer = Buffer::empty(area);
        grid.draw(Look { theme: ThemeName::Mono, ascii }, area, &mut buffer);
        let row = |y| (0..area.width).map(|x| buffer[(x, y)].symbol().to_owned()).collect::<String>();
        (0..area.height).map(row).collect()
    }

    #[test]
    fn a_diagonal_is_a_diagonal() {
        let area = Rect::new(0, 0, 2, 1);
        let mut grid = DotGrid::new(area);
        grid.line((0.0, 0.0), (3.0, 3.0), Role::Curve);
        assert_eq!(drawn(&grid, area, false), ["⠑⢄"]);
        assert_eq!(drawn(&grid, area, true), ["\":"]);
    }

    #[test]
    fn glyphs_lie_on_top_and_a_rule_stays_in_sight_beside_a_curve() {
        let area = Rect::new(0, 0, 3, 1);
        let mut grid = DotGrid::new(area);
        grid.rule(0, Role::Threshold);
        grid.dot(0, 3, Role::Curve);
        grid.glyph((4.0, 1.0), '*', Role::Resistance);
        assert_eq!(drawn(&grid, area, true), [":'*"]);
        assert_eq!(drawn(&grid, area, false), ["⡁⠁*"]);
    }

    proptest! {
        #[test]
        fn nothing_leaves_the_grid(
            width in 0_u16..20, height in 0_u16..8,
            start in (proptest::num::f64::ANY, proptest::num::f64::ANY),
            end in (proptest::num::f64::ANY, proptest::num::f64::ANY),
        ) {
            let area = Rect::new(3, 1, width, height);
            let mut grid = DotGrid::new(area);
            grid.line(start, end, Role::Curve);
            grid.glyph(end, '*', Role::Resistance);
            grid.column(usize::from(width), '/', Role::Stale);
            grid.rule(usize::from(height), Role::Threshold);
            let mut buffer = Buffer::empty(Rect::new(0, 0, 10, 4));
            grid.draw(Look { theme: ThemeName::Mono, ascii: false }, area, &mut buffer);
            prop_assert_eq!(buffer[(0, 0)].symbol(), " ");
        }
    }
}
