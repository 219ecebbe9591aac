//! Responses of one pixel to many features at once, in passes that compilers turn into vector instructions.
//!
//! Gives exactly what [`ProbeImage::response`] gives one by one; training spends nearly all of its time here.

use super::super::probe::{BACKGROUND, Feature, NOTHING, Plane, ProbeImage};
use std::ops::Range;

/// Features that are computed side by side: lists are padded to whole blocks of so many.
pub(super) const BLOCK: usize = 16;

/// Features whose numbers lie side by side.
#[derive(Clone, Debug, Default)]
pub(super) struct Features {
    /// Columns of u, rows of u, columns of v, rows of v, in pixel metres.
    offsets: [Vec<f32>; 4],
    /// Neighbours that read the same planes.
    runs: Vec<([u8; 2], Range<usize>)>,
}

/// Room for one pixel's responses; kept from pixel to pixel.
#[derive(Clone, Debug, Default)]
pub(super) struct Room {
    first: Vec<i32>,
    second: Vec<i32>,
    /// The responses in millimetres, one for each feature and padding up to a whole block.
    pub(super) responses: Vec<i16>,
}

impl Features {
    /// Features from their offsets; the last block is filled up with features that probe the pixel itself.
    pub(super) fn new(of: &[Feature]) -> Self {
        let mut features = Self::default();
        for (number, Feature { offsets, planes }) in of.iter().enumerate() {
            features.offsets.iter_mut().zip(offsets).for_each(|(list, offset)| list.push(*offset));
            match features.runs.last_mut().filter(|(last, _)| last == planes) {
                Some((_, run)) => run.end = number + 1,
                None => features.runs.push((*planes, number..number + 1)),
            }
        }
        if let Some((_, last)) = features.runs.last_mut() {
            last.end = of.len().next_multiple_of(BLOCK);
        }
        for list in &mut features.offsets {
            list.resize(list.len().next_multiple_of(BLOCK), 0.0);
        }
        features
    }

    /// Fills the room with a pixel's responses, in the order in which the features were given.
    #[inline(always)]
    #[expect(clippy::inline_always, reason = "to become vector instructions where the caller is compiled for them")]
    pub(super) fn respond(&self, image: &ProbeImage, place: (f32, f32), per_metre: f32, room: &mut Room) {
        let [u_x, u_y, v_x, v_y] = &self.offsets;
        for list in [&mut room.first, &mut room.second] {
            list.resize(u_x.len(), 0);
        }
        room.responses.resize(u_x.len(), 0);
        for (planes, run) in &self.runs {
            let [first, second] = planes.map(|plane| image.plane(plane));
            indices(image, first, place, per_metre, (of(u_x, run), of(u_y, run)), of_mut(&mut room.first, run));
            let seconds = of_mut(&mut room.second, run);
            if planes[1] == NOTHING {
                // The border's corner.
                seconds.fill(0);
            } else {
                indices(image, second, place, per_metre, (of(v_x, run), of(v_y, run)), seconds);
            }
        }
        let values = image.values();
        let value = |index: i32| values.get(index.cast_unsigned() as usize).copied().unwrap_or(BACKGROUND);
        for ((response, u), v) in room.responses.iter_mut().zip(&room.first).zip(&room.second) {
            *response = value(*u).cast_signed() - value(*v).cast_signed();
        }
    }
}

#[inline(always)]
#[expect(clippy::inline_always, reason = "to become vector instructions where the caller is compiled for them")]
fn of<'a>(list: &'a [f32], run: &Range<usize>) -> &'a [f32] {
    list.get(run.clone()).unwrap_or(&[])
}

#[inline(always)]
#[expect(clippy::inline_always, reason = "to become vector instructions where the caller is compiled for them")]
fn of_mut<'a>(list: &'a mut [i32], run: &Range<usize>) -> &'a mut [i32] {
    list.get_mut(run.clone()).unwrap_or(&mut [])
}

/// Where probes stand in the image's values; outside is clamped to the border.
#[inline(always)]
#[expect(clippy::inline_always, reason = "to become vector instructions where the caller is compiled for them")]
#[expect(clippy::cast_possible_truncation, clippy::cast_possible_wrap, reason = "clamped to the image and its border")]
fn indices(
    image: &ProbeImage,
    plane: Plane,
    (column, row): (f32, f32),
    per_metre: f32,
    (across, down): (&[f32], &[f32]),
    into: &mut [i32],
) {
    let (last_column, last_row) = ((image.width() + 1) as f32, (image.height() + 1) as f32);
    let (shift, stride, first) = (plane.shift, plane.stride as i32, plane.first as i32);
    for ((index, across), down) in into.iter_mut().zip(across).zip(down) {
        let column = (column + across * per_metre + 0.5 + 1.0).clamp(0.0, last_column);
        let row = (row + down * per_metre + 0.5 + 1.0).clamp(0.0, last_row);
        *index = (row as i32 >> shift) * stride + (column as i32 >> shift) + first;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Point;
    use crate::vision::camera::Intrinsics;
    use crate::vision::foreground::Pixel;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn many_at_once_respond_as_one_by_one(
            drawn in proptest::collection::vec((proptest::array::uniform4(-300.0_f32..300.0), 0_u8..8, 0_u8..8), 1..40),
            (column, row) in (0_u8..40, 0_u8..30),
            depth in 400_u16..4000,
            filled in 0_u16..1200,
        ) {
            let mut image = ProbeImage::new(40, 30);
            (0..filled).for_each(|index| image.set(usize::from(index * 7 % 40), usize::from(index * 11 % 30), 500 + index));
            image.measure_from_neck(&[Pixel { column: 3, row: 9, depth: 700 }], &Intrinsics::default(), &Point::new(0.0, 0.0, 0.6));
            let list: Vec<Feature> =
                drawn.iter().map(|(offsets, first, second)| Feature { offsets: *offsets, planes: [*first, *second] }).collect();
            let features = Features::new(&list);
            let (place, per_metre) = ((f32::from(column), f32::from(row)), 1000.0 / f32::from(depth));
            let mut room = Room::default();
            features.respond(&image, place, per_metre, &mut room);
            let one_by_one: Vec<i32> = list.iter().map(|feature| image.response(place, per_metre, feature)).collect();
            prop_assert_eq!(room.responses.iter().take(list.len()).map(|response| i32::from(*response)).collect::<Vec<_>>(), one_by_one);
        }
    }
}
