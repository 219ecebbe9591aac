//! Chair and floor: what stays in the image when the person leaves.

use super::body::{Builder, Region};
use crate::geometry::{Point, Vector};

/// The floor lies this far below the shoulders of a seated person, in metres.
const FLOOR: f64 = 1.05;

impl Builder<'_> {
    /// The chair that the person sits on, upright whatever the person's lean, and the floor.
    pub(super) fn chair(&mut self) {
        let look = self.look;
        let ahead = self.left.cross(&Vector::z());
        let middle = self.middle;
        let at = |x: f64, y: f64, z: f64, left: &Vector| -> Point { middle + ahead * x + left * y + Vector::z() * z };
        let left = self.left;
        let seat = -0.66;
        self.block(at(0.12, 0.0, seat, &left), [0.24, look.chair_breadth, 0.025]);
        let behind = -(look.chest_depth + 0.09 + look.lean.max(0.0) * 0.5);
        let back = at(behind, 0.0, seat + look.back_height / 2.0, &left);
        self.block(back, [0.02, look.chair_breadth, look.back_height / 2.0]);
        if look.arm_rests {
            for side in [1.0, -1.0] {
                let place = side * (look.chair_breadth + 0.05);
                let ends = (at(-0.1, place, seat + 0.22, &left), at(0.25, place, seat + 0.22, &left));
                self.cone(Region::Furniture, ends, (0.025, 0.025), false);
            }
        }
        self.block(at(0.0, 0.0, -FLOOR - 0.05, &left), [3.0, 3.0, 0.05]);
    }
}
