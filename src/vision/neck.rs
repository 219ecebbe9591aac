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
/// Neighbouring cells whose depths differ by more are not the same surface, in millimetres.
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
    /// The longest way that leads through here.
    end: f32,
    root: f32,
    before: u32,
    done: bool,
}

/// What is kept from frame to frame, so that a frame costs no allocation.
#[derive(Clone, Debug, Default)]
pub(super) struct Room {
    cells: Vec<Cell>,
    ahead: BinaryHeap<Reverse<(u32, u32)>>,
    order: Vec<u32>,
}

const NO_CELL: u32 = u32::MAX;
const EMPTY: Cell = Cell { place: [0.0; 3], way: f32::INFINITY, end: 0.0, root: 0.0, before: NO_CELL, done: false };

impl ProbeImage {
    /// Fills the maps from the image's foreground pixels; `camera` and `neck` are the image's own.
    pub(super) fn measure_from_neck(&mut self, pixels: &[Pixel], camera: &Intrinsics, neck: &Point) {
        let mut room = std::mem::take(&mut self.room);
        let (columns, rows) = self.cells();
        room.place(pixels, columns, rows, camera, neck);
        room.walk(columns);
        room.end();
        for (map, of) in MAPPED.iter().enumerate() {
            for (value, cell) in self.map_mut(map).iter_mut().zip(&room.cells) {
                *value = if cell.way.is_finite() { to_millimetres(of(cell)) } else { BACKGROUND };
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
        self.cells.clear();
        self.cells.resize(columns * rows, EMPTY);
        self.ahead.clear();
        let neck = neck.map(|metres| metres * 1000.0);
        let deep = |pixel: &Pixel| f32::from(pixel.depth) - neck.z as f32;
        for pixel in pixels {
            let index = cell_of(*pixel, columns);
            let Some(cell) = self.cells.get_mut(index) else { continue };
            if cell.way.is_finite() && cell.place[2] <= deep(pixel) {
                continue;
            }
            let point = camera.point(f64::from(pixel.column), f64::from(pixel.row), f64::from(pixel.depth));
            cell.place = [(point.x - neck.x) as f32, (point.y - neck.y) as f32, (point.z - neck.z) as f32];
            let straight = cell.place.iter().map(|value| value * value).sum::<f32>().sqrt();
            cell.way = if straight < TRUNK { straight } else { straight + ISLAND };
            cell.root = cell.place[0];
        }
        for (index, cell) in (0_u32..).zip(&self.cells).filter(|(_, cell)| cell.way.is_finite()) {
            self.ahead.push(Reverse((u32::from(to_millimetres(cell.way)), index)));
        }
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
            for row in [at.wrapping_sub(columns), at, at.wrapping_add(columns)] {
                for next in [row.wrapping_sub(1), row, row.wrapping_add(1)] {
                    self.reach(next, &cell, index);
                }
            }
        }
    }

    /// Takes the way over `from` to a cell where it is shorter.
    fn reach(&mut self, next: usize, from: &Cell, index: u32) {
        let Some(cell) = self.cells.get_mut(next).filter(|cell| cell.way.is_finite() && !cell.done) else { return };
        let square: f32 = cell.place.iter().zip(from.place).map(|(to, from)| (to - from) * (to - from)).sum();
        let jump = if (cell.place[2] - from.place[2]).abs() > STEP { JUMP } else { 0.0 };
        let way = from.way + square.sqrt() + jump;
        if way >= cell.way {
            return;
        }
        cell.way = way;
        cell.before = index;
        cell.root = if way < ROOT { cell.place[0] } else { from.root };
        #[expect(clippy::cast_possible_truncation, reason = "counted in 32 bits from the start")]
        self.ahead.push(Reverse((u32::from(to_millimetres(way)), next as u32)));
    }

    /// How far the ways through each cell go on, from their ends backwards.
    fn end(&mut self) {
        for index in self.order.iter().rev() {
            let Some(cell) = self.cells.get_mut(*index as usize) else { continue };
            cell.end = cell.end.max(cell.way);
            let (end, before) = (cell.end, cell.before as usize);
            if let Some(before) = self.cells.get_mut(before) {
                before.end = before.end.max(end);
            }
        }
    }
}

/// The cell of a pixel, counted as probes count: with the image's border.
fn cell_of(pixel: Pixel, columns: usize) -> usize {
    let cell = |at: u16| (usize::from(at) + 1) >> CELL_SHIFT;
    cell(pixel.row) * columns + cell(pixel.column)
}

const _: () = assert!(MAPS.len() + 1 == super::probe::NOTHING as usize);
