//! The densest places of weighted points in space: points are gathered in the cells of a grid, then mean shift over cells.
//!
//! Each cell keeps its points' weight and centre, so a search costs the same however many points there are.

use crate::geometry::Point;

/// Cells along each side of the grid, and a cell's side in metres: 2.56 m about the neck.
const CELLS: usize = 64;
const CELL: f32 = 0.04;
/// Radius of the mean shift's window in metres: about twice the width of 60 mm that served best.
const RADIUS: f32 = 0.12;
/// The window in cells to each side.
const REACH: usize = 3;
const MOST_STEPS: usize = 20;
/// A shift below this ends the search, in metres.
const STANDSTILL: f32 = 2e-4;
/// Another mode is at least this far from those before, in metres.
const APART: f64 = 0.15;
/// A mode with less of the weight than this share is none.
const LEAST_SHARE: f64 = 0.03;

/// Most modes that are looked for.
pub(super) const MOST_MODES: usize = 3;

/// A weighted point.
#[derive(Clone, Copy, Debug)]
pub(super) struct VotePoint {
    pub(super) place: [f32; 3],
    pub(super) weight: f32,
}

/// A dense place.
#[derive(Clone, Copy, Debug)]
pub(super) struct Mode {
    pub(super) place: Point,
    /// Share of all weight that lies in the window.
    pub(super) share: f64,
}

/// Modes, the densest first.
pub(super) type Modes = [Option<Mode>; MOST_MODES];

/// Summed weight, and weight times place.
#[derive(Clone, Copy, Debug, Default)]
struct Cell {
    weight: f32,
    moment: [f32; 3],
}

/// Finds modes; keeps its grid between calls.
#[derive(Clone, Debug)]
pub(super) struct ModeFinder {
    cells: Vec<Cell>,
    /// Cells with weight.
    touched: Vec<u32>,
    corner: [f32; 3],
    total: f64,
}

impl Default for ModeFinder {
    fn default() -> Self {
        let empty = Cell::default();
        Self { cells: vec![empty; CELLS * CELLS * CELLS], touched: Vec::new(), corner: [0.0; 3], total: 0.0 }
    }
}

impl ModeFinder {
    /// The densest places near `middle`; none without any weight there.
    pub(super) fn find(&mut self, points: &[VotePoint], middle: &Point) -> Modes {
        self.gather(points, middle);
        let mut modes = Modes::default();
        for count in 0..MOST_MODES {
            let (found, rest) = modes.split_at_mut(count);
            let mode = self.densest_cell(found).and_then(|start| self.climb(start));
            let Some(mode) = mode.filter(|mode| mode.share >= LEAST_SHARE) else { break };
            // From a cell beside an earlier mode the climb may end on it.
            let known = found.iter().flatten().any(|known| (known.place - mode.place).norm() < APART / 2.0);
            if known {
                break;
            }
            if let Some(slot) = rest.first_mut() {
                *slot = Some(mode);
            }
        }
        self.clear();
        modes
    }

    #[expect(clippy::cast_possible_truncation, reason = "64 cubed cells")]
    fn gather(&mut self, points: &[VotePoint], middle: &Point) {
        self.corner = corner(middle);
        self.total = 0.0;
        for point in points {
            self.total += f64::from(point.weight);
            let Some(index) = self.index(&point.place) else { continue };
            let Some(cell) = self.cells.get_mut(index) else { continue };
            if cell.weight == 0.0 {
                self.touched.push(index as u32);
            }
            cell.weight += point.weight;
            cell.moment.iter_mut().zip(point.place).for_each(|(sum, value)| *sum += point.weight * value);
        }
    }

    fn clear(&mut self) {
        for index in self.touched.drain(..) {
            if let Some(cell) = self.cells.get_mut(index as usize) {
                *cell = Cell::default();
            }
        }
    }

    fn index(&self, place: &[f32; 3]) -> Option<usize> {
        let [x, y, z] = cell_numbers(place, &self.corner)?;
        Some((x * CELLS + y) * CELLS + z)
    }

    /// The centre of the heaviest cell that is not near a mode that is known.
    fn densest_cell(&self, known: &[Option<Mode>]) -> Option<[f32; 3]> {
        let mut best = (0.0, None);
        for cell in self.touched.iter().filter_map(|index| self.cells.get(*index as usize)) {
            if cell.weight > best.0 {
                let centre = cell.centre();
                let place = Point::from(centre.map(f64::from));
                if known.iter().flatten().all(|mode| (mode.place - place).norm() >= APART) {
                    best = (cell.weight, Some(centre));
                }
            }
        }
        best.1
    }

    /// Mean shift from a place to its mode.
    fn climb(&self, mut place: [f32; 3]) -> Option<Mode> {
        for _ in 0..MOST_STEPS {
            let (mut moment, mut total) = ([0.0_f32; 3], 0.0);
            self.visit(&place, |cell, share| {
                total += share * cell.weight;
                moment.iter_mut().zip(cell.moment).for_each(|(sum, value)| *sum += share * value);
            });
            if total <= 0.0 {
                return None;
            }
            let moved = moment.map(|value| value / total);
            let step: f32 = moved.iter().zip(place).map(|(to, from)| (to - from).powi(2)).sum();
            place = moved;
            if step < STANDSTILL * STANDSTILL {
                break;
            }
        }
        Some(self.describe(&place))
    }

    fn describe(&self, place: &[f32; 3]) -> Mode {
        let mut inside = 0.0_f64;
        self.visit(place, |cell, _| inside += f64::from(cell.weight));
        Mode { place: Point::from(place.map(f64::from)), share: inside / self.total.max(1e-30) }
    }

    /// Shows each cell in the window about a place with its share in it, which falls to nothing at the radius.
    #[inline]
    fn visit(&self, place: &[f32; 3], mut see: impl FnMut(&Cell, f32)) {
        let Some([x, y, z]) = cell_numbers(place, &self.corner) else { return };
        let span = |middle: usize| middle.saturating_sub(REACH)..(middle + REACH + 1).min(CELLS);
        for x in span(x) {
            for y in span(y) {
                let row = (x * CELLS + y) * CELLS;
                let Some(cells) = self.cells.get(row + span(z).start..row + span(z).end) else { continue };
                for cell in cells.iter().filter(|cell| cell.weight > 0.0) {
                    let square: f32 = cell.centre().iter().zip(place).map(|(at, from)| (at - from).powi(2)).sum();
                    let share = 1.0 - square / (RADIUS * RADIUS);
                    if share > 0.0 {
                        see(cell, share);
                    }
                }
            }
        }
    }
}

impl Cell {
    #[inline]
    fn centre(&self) -> [f32; 3] {
        self.moment.map(|value| value / self.weight)
    }
}

#[expect(clippy::cast_possible_truncation, reason = "single precision is plenty for metres")]
fn corner(middle: &Point) -> [f32; 3] {
    let half = CELLS as f32 * CELL / 2.0;
    [middle.x as f32 - half, middle.y as f32 - half, middle.z as f32 - half]
}

#[inline]
#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "the range is checked first")]
fn cell_numbers(place: &[f32; 3], corner: &[f32; 3]) -> Option<[usize; 3]> {
    let mut numbers = [0; 3];
    for ((number, value), low) in numbers.iter_mut().zip(place).zip(corner) {
        let along = (value - low) / CELL;
        if !(0.0..CELLS as f32).contains(&along) {
            return None;
        }
        *number = along as usize;
    }
    Some(numbers)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cloud(centre: [f32; 3], count: usize, weight: f32) -> Vec<VotePoint> {
        (0..count)
            .map(|index| {
                let turn = index as f32 * 2.4;
                let reach = 0.03 * (index as f32 / count as f32).sqrt();
                let place = [centre[0] + reach * turn.cos(), centre[1] + reach * turn.sin(), centre[2]];
                VotePoint { place, weight }
            })
            .collect()
    }

    #[test]
    fn the_heavier_of_two_clouds_wins_and_the_other_does_not_pull() {
        let mut points = cloud([0.3, 0.1, 1.0], 300, 1.0);
        points.extend(cloud([-0.3, 0.1, 1.2], 100, 1.0));
        let modes = ModeFinder::default().find(&points, &Point::new(0.0, 0.0, 1.0));
        let first = modes[0].unwrap();
        assert!((first.place - Point::new(0.3, 0.1, 1.0)).norm() < 0.003, "{}", first.place);
        assert!((first.share - 0.75).abs() < 1e-6);
        let second = modes[1].unwrap();
        assert!((second.place - Point::new(-0.3, 0.1, 1.2)).norm() < 0.003, "{}", second.place);
        assert!((second.share - 0.25).abs() < 1e-6);
        assert!(modes[2].is_none());
    }

    #[test]
    fn without_points_or_far_from_the_neck_there_is_no_mode_and_the_grid_stays_clean() {
        let mut finder = ModeFinder::default();
        assert!(finder.find(&[], &Point::origin())[0].is_none());
        assert!(finder.find(&cloud([5.0, 0.0, 0.0], 10, 1.0), &Point::origin())[0].is_none());
        assert!(finder.find(&cloud([0.1, 0.0, 0.0], 10, 1.0), &Point::origin())[0].is_some());
        assert!(finder.cells.iter().all(|cell| cell.weight == 0.0) && finder.touched.is_empty());
    }
}
