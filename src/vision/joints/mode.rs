//! The densest place of weighted points in space: a coarse grid to begin with, then mean shift.

use crate::geometry::{Point, Vector};
use nalgebra::Matrix3;

/// Cells along each side of the grid, and a cell's side in metres: 2.6 m about the neck.
const CELLS: usize = 64;
const CELL: f32 = 0.04;
/// Radius of the mean shift's window in metres: about twice the width of 60 mm that served best.
const RADIUS: f32 = 0.12;
const MOST_STEPS: usize = 15;
/// A shift below this ends the search, in metres.
const STANDSTILL: f32 = 2e-4;

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
    /// Weighted covariance of the points in the window, square metres.
    pub(super) scatter: Matrix3<f64>,
    /// Share of all weight that lies in the window.
    pub(super) share: f64,
}

/// Finds modes; keeps its grid between calls.
#[derive(Clone, Debug)]
pub(super) struct ModeFinder {
    grid: Vec<f32>,
}

impl Default for ModeFinder {
    fn default() -> Self {
        Self { grid: vec![0.0; CELLS * CELLS * CELLS] }
    }
}

impl ModeFinder {
    /// The densest place near `middle`; `None` without any weight there.
    pub(super) fn find(&mut self, points: &[VotePoint], middle: &Point) -> Option<Mode> {
        let mut place = self.densest_cell(points, middle)?;
        for _ in 0..MOST_STEPS {
            let moved = shifted(points, &place)?;
            let step: f32 = moved.iter().zip(place).map(|(to, from)| (to - from).powi(2)).sum();
            place = moved;
            if step < STANDSTILL * STANDSTILL {
                break;
            }
        }
        Some(describe(points, &place))
    }

    fn densest_cell(&mut self, points: &[VotePoint], middle: &Point) -> Option<[f32; 3]> {
        let corner = corner(middle);
        let mut best = (0.0, None);
        for point in points {
            let Some(cell) = cell(&point.place, &corner).and_then(|index| self.grid.get_mut(index)) else { continue };
            *cell += point.weight;
            if *cell > best.0 {
                best = (*cell, Some(point.place));
            }
        }
        for point in points {
            if let Some(cell) = cell(&point.place, &corner).and_then(|index| self.grid.get_mut(index)) {
                *cell = 0.0;
            }
        }
        best.1
    }
}

#[expect(clippy::cast_possible_truncation, reason = "single precision is plenty for metres")]
fn corner(middle: &Point) -> [f32; 3] {
    let half = CELLS as f32 * CELL / 2.0;
    [middle.x as f32 - half, middle.y as f32 - half, middle.z as f32 - half]
}

#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "the range is checked first")]
fn cell(place: &[f32; 3], corner: &[f32; 3]) -> Option<usize> {
    let mut index = 0;
    for (value, low) in place.iter().zip(corner) {
        let along = (value - low) / CELL;
        if !(0.0..CELLS as f32).contains(&along) {
            return None;
        }
        index = index * CELLS + along as usize;
    }
    Some(index)
}

/// A point's weight in the window about a place: falls to nothing at the radius.
#[inline]
fn window(point: &VotePoint, place: &[f32; 3]) -> f32 {
    let [x, y, z] = place;
    let [px, py, pz] = point.place;
    let square = (px - x).powi(2) + (py - y).powi(2) + (pz - z).powi(2);
    point.weight * (1.0 - square / (RADIUS * RADIUS)).max(0.0)
}

fn shifted(points: &[VotePoint], place: &[f32; 3]) -> Option<[f32; 3]> {
    let (mut sum, mut total) = ([0.0_f32; 3], 0.0);
    for point in points {
        let weight = window(point, place);
        total += weight;
        sum.iter_mut().zip(point.place).for_each(|(sum, value)| *sum += weight * value);
    }
    (total > 0.0).then(|| sum.map(|value| value / total))
}

fn describe(points: &[VotePoint], place: &[f32; 3]) -> Mode {
    let centre = Vector::from(place.map(f64::from));
    let (mut inside, mut scatter, mut all) = (0.0_f64, Matrix3::zeros(), 0.0_f64);
    for point in points {
        all += f64::from(point.weight);
        let weight = f64::from(window(point, place));
        if weight > 0.0 {
            inside += f64::from(point.weight);
            let offset = Vector::from(point.place.map(f64::from)) - centre;
            scatter += offset * offset.transpose() * f64::from(point.weight);
        }
    }
    Mode { place: Point::from(centre), scatter: scatter / inside.max(1e-30), share: inside / all.max(1e-30) }
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
        let mode = ModeFinder::default().find(&points, &Point::new(0.0, 0.0, 1.0)).unwrap();
        assert!((mode.place - Point::new(0.3, 0.1, 1.0)).norm() < 0.003, "{}", mode.place);
        assert!((mode.share - 0.75).abs() < 1e-6);
        assert!(mode.scatter.trace() < 0.001);
    }

    #[test]
    fn without_points_or_far_from_the_neck_there_is_no_mode_and_the_grid_stays_clean() {
        let mut finder = ModeFinder::default();
        assert!(finder.find(&[], &Point::origin()).is_none());
        assert!(finder.find(&cloud([5.0, 0.0, 0.0], 10, 1.0), &Point::origin()).is_none());
        finder.find(&cloud([0.1, 0.0, 0.0], 10, 1.0), &Point::origin()).unwrap();
        assert!(finder.grid.iter().all(|weight| *weight == 0.0));
    }
}
