//! Maps of where the foreground lies from the neck, which is given with every frame: what equation 3.1 cannot see.
//!
//! Differences of depth within an arm's length do not tell how far along a limb a pixel is, nor where the trunk's middle lies.
//! The way from the neck over the body's surface does, and so does what remains of that way to where it ends: it stays the
//! same however an arm is bent. Maps have coarse cells, cost a fraction of a millisecond, and are read like depth.

use super::camera::Intrinsics;
use super::foreground::Pixel;
use super::probe::{BACKGROUND, ProbeImage};
use crate::geometry::Point;
use std::cmp::Reverse;
use std::collections::BinaryHeap;

/// Binary logarithm of a cell's side in pixels.
pub(super) const CELL_SHIFT: u32 = 2;
/// The maps, in the order of a probe's planes from 1 on.
pub(super) const MAPS: [&str; 6] = ["way", "rest", "root", "across", "down", "deep"];
/// Added to what may be negative, in millimetres.
const ZERO: f32 = 5000.0;
/// Neighbouring cells whose places differ by more along any axis are not the same surface, in millimetres.
const STEP: f32 = 60.0;
/// A way that jumps from one surface to another is longer by this, in millimetres: only what cannot be reached otherwise is
/// reached so.
const JUMP: f32 = 400.0;
/// The trunk begins this near to the neck, in millimetres: ways begin there, since the head is not foreground.
const TRUNK: f32 = 220.0;
/// What hangs together with the neck no other way begins at its own place with this much added, in millimetres.
const ISLAND: f32 = 600.0;
/// A way's root is where it is so long, in millimetres: about at a shoulder.
const ROOT: f32 = 250.0;

/// A cell of the foreground.
#[derive(Clone, Copy, Debug)]
struct Cell {
    /// From the neck, in millimetres.
    place: [f32; 3],
    way: f32,
    /// The longest way to where the surface leads from here, ever further from the neck.
    end: f32,
    root: f32,
    done: bool,
}

/// What is kept from frame to frame, so that a frame costs no allocation.
#[derive(Clone, Debug, Default)]
pub(super) struct Room {
    cells: Vec<Cell>,
    ahead: BinaryHeap<Reverse<(u32, u32)>>,
    /// The cells with foreground; once ways are known, the shorter first.
    order: Vec<u32>,
}

const EMPTY: Cell = Cell { place: [0.0, 0.0, f32::INFINITY], way: f32::INFINITY, end: 0.0, root: 0.0, done: false };

impl ProbeImage {
    /// Fills the maps from the image's foreground pixels; `camera` and `neck` are the image's own.
    pub(super) fn measure_from_neck(&mut self, pixels: &[Pixel], camera: &Intrinsics, neck: &Point) {
        let mut room = std::mem::take(&mut self.room);
        let (columns, rows) = self.cells();
        room.place(pixels, columns, rows, camera, neck);
        room.walk(columns);
        room.end(columns);
        for (map, of) in MAPPED.iter().enumerate() {
            let values = self.map_mut(map);
            values.fill(BACKGROUND);
            for index in &room.order {
                let at = *index as usize;
                if let (Some(value), Some(cell)) = (values.get_mut(at), room.cells.get(at)) {
                    *value = to_millimetres(of(cell));
                }
            }
        }
        self.room = room;
    }
}

/// What each of [`MAPS`] shows.
const MAPPED: [fn(&Cell) -> f32; MAPS.len()] = [
    |cell| cell.way,
    |cell| cell.end - cell.way,
    |cell| cell.root + ZERO,
    |cell| cell.place[0] + ZERO,
    |cell| cell.place[1] + ZERO,
    |cell| cell.place[2] + ZERO,
];

#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped first")]
fn to_millimetres(value: f32) -> u16 {
    value.clamp(0.0, f32::from(BACKGROUND - 1)) as u16
}

impl Room {
    /// Each cell's nearest point from the neck, and the ways that begin there.
    #[expect(clippy::cast_possible_truncation, reason = "single precision is plenty for millimetres")]
    fn place(&mut self, pixels: &[Pixel], columns: usize, rows: usize, camera: &Intrinsics, neck: &Point) {
        self.empty(columns * rows);
        let neck = neck.map(|metres| metres * 1000.0);
        let deep = |pixel: &Pixel| f32::from(pixel.depth) - neck.z as f32;
        for pixel in pixels {
            let index = cell_of(*pixel, columns);
            let Some(cell) = self.cells.get_mut(index).filter(|cell| cell.place[2] > deep(pixel)) else { continue };
            if cell.place[2].is_infinite() {
                self.order.push(index as u32);
            }
            let point = camera.point(f64::from(pixel.column), f64::from(pixel.row), f64::from(pixel.depth));
            cell.place = [(point.x - neck.x) as f32, (point.y - neck.y) as f32, (point.z - neck.z) as f32];
        }
        for index in &self.order {
            let Some(cell) = self.cells.get_mut(*index as usize) else { continue };
            let straight = cell.place.iter().map(|value| value * value).sum::<f32>().sqrt();
            cell.way = if straight < TRUNK { straight } else { straight + ISLAND };
            cell.root = cell.place[0];
        }
        let cells = &self.cells;
        let way = |index: &u32| cells.get(*index as usize).map(|cell| u32::from(to_millimetres(cell.way)));
        self.ahead.extend(self.order.iter().filter_map(|index| Some(Reverse((way(index)?, *index)))));
    }

    /// Empties the cells: only those that the last image filled, where there are as many.
    fn empty(&mut self, count: usize) {
        self.ahead.clear();
        if self.cells.len() == count {
            for index in &self.order {
                if let Some(cell) = self.cells.get_mut(*index as usize) {
                    *cell = EMPTY;
                }
            }
        } else {
            self.cells.clear();
            self.cells.resize(count, EMPTY);
        }
        self.order.clear();
    }

    /// The shortest ways (Dijkstra) from cell to neighbouring cell.
    fn walk(&mut self, columns: usize) {
        self.order.clear();
        while let Some(Reverse((_, index))) = self.ahead.pop() {
            let at = index as usize;
            let Some(cell) = self.cells.get_mut(at).filter(|cell| !cell.done) else { continue };
            cell.done = true;
            let cell = *cell;
            self.order.push(index);
            for next in neighbours(at, columns) {
                self.reach(next, &cell);
            }
        }
    }

    /// Takes the way over `from` to a cell where it is shorter.
    fn reach(&mut self, next: usize, from: &Cell) {
        let Some(cell) = self.cells.get_mut(next).filter(|cell| cell.way.is_finite() && !cell.done) else { return };
        let square: f32 = cell.place.iter().zip(from.place).map(|(to, from)| (to - from) * (to - from)).sum();
        let way = from.way + square.sqrt() + if joined(cell, from) { 0.0 } else { JUMP };
        if way >= cell.way {
            return;
        }
        cell.way = way;
        cell.root = if way < ROOT { cell.place[0] } else { from.root };
        #[expect(clippy::cast_possible_truncation, reason = "counted in 32 bits from the start")]
        self.ahead.push(Reverse((u32::from(to_millimetres(way)), next as u32)));
    }

    /// How far the surface leads on from each cell, from its ends backwards. Every cell across a limb knows it, not only those
    /// that a shortest way runs through.
    fn end(&mut self, columns: usize) {
        for index in self.order.iter().rev() {
            let at = *index as usize;
            let Some(cell) = self.cells.get(at).copied() else { continue };
            let further = neighbours(at, columns).filter_map(|next| self.cells.get(next));
            let further = further.filter(|next| next.way.is_finite() && next.way > cell.way && joined(next, &cell));
            let end = further.map(|next| next.end).fold(cell.way, f32::max);
            if let Some(cell) = self.cells.get_mut(at) {
                cell.end = end;
            }
        }
    }
}

/// The cells about a cell; at an edge also the other edge's of the row before or after, which are too far off to be joined.
fn neighbours(at: usize, columns: usize) -> impl Iterator<Item = usize> {
    [at.wrapping_sub(columns), at, at.wrapping_add(columns)]
        .into_iter()
        .flat_map(|row| [row.wrapping_sub(1), row, row.wrapping_add(1)])
}

/// Whether neighbouring cells are the same surface.
fn joined(one: &Cell, other: &Cell) -> bool {
    one.place.iter().zip(other.place).all(|(one, other)| (one - other).abs() <= STEP)
}

/// The cell of a pixel, counted as probes count: with the image's border.
fn cell_of(pixel: Pixel, columns: usize) -> usize {
    let cell = |at: u16| (usize::from(at) + 1) >> CELL_SHIFT;
    cell(pixel.row) * columns + cell(pixel.column)
}

const _: () = assert!(MAPS.len() + 1 == super::probe::NOTHING as usize);

#[cfg(test)]
mod tests;
