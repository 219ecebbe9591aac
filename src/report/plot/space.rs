//! Views of space: how points in the robot's `base` frame fall on paper.

use super::{Axis, Plot};
use crate::geometry::Point;

/// From where space is looked at.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum View {
    /// From above: the robot's left is left, forward is up.
    Top,
    /// From the robot, which stands behind the person: the person's left is left, up is up.
    Front,
    /// From the robot's right: forward is right, up is up.
    Side,
}

impl View {
    /// The view in words.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Top => "top view",
            Self::Front => "front view",
            Self::Side => "side view",
        }
    }

    /// The axes of `base` that run across and up the paper: 0 for x, 1 for y, 2 for z.
    const fn axes(self) -> (usize, usize) {
        match self {
            Self::Top => (1, 0),
            Self::Front => (1, 2),
            Self::Side => (0, 2),
        }
    }

    /// An empty plot of this view with equal units.
    #[must_use]
    pub fn plot(self, title: impl Into<String>) -> Plot {
        let left_is_left = Axis::new("y (m), left of the robot").reversed();
        let (across, up) = match self {
            Self::Top => (left_is_left, Axis::new("x (m), forward")),
            Self::Front => (left_is_left, Axis::new("z (m), up")),
            Self::Side => (Axis::new("x (m), forward"), Axis::new("z (m), up")),
        };
        Plot::new(title, across, up).equal_units()
    }
}

/// A point in `base`, in metres, as it falls on the paper of a view.
#[must_use]
pub fn project(view: View, point: &Point) -> [f64; 2] {
    let (across, up) = view.axes();
    [point.coords.get(across).copied().unwrap_or(f64::NAN), point.coords.get(up).copied().unwrap_or(f64::NAN)]
}

/// A path in `base`, in metres, as it falls on the paper of a view.
#[must_use]
pub fn path_in(view: View, path: &[Point]) -> Vec<[f64; 2]> {
    path.iter().map(|point| project(view, point)).collect()
}

/// The part of a covariance (rows x, y, z, in square metres) that a view shows.
#[must_use]
pub fn covariance_in(view: View, covariance: &[[f64; 3]; 3]) -> [[f64; 2]; 2] {
    let (across, up) = view.axes();
    let entry =
        |row: usize, column: usize| covariance.get(row).and_then(|row| row.get(column)).copied().unwrap_or(f64::NAN);
    [[entry(across, across), entry(across, up)], [entry(up, across), entry(up, up)]]
}
