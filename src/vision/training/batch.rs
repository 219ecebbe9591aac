//! Responses of one pixel to many features at once, in passes that compilers turn into vector instructions.
//!
//! Gives exactly what [`ProbeImage::response`] gives one by one; training spends nearly all of its time here.

use super::super::probe::{BACKGROUND, Offsets, ProbeImage};

/// Features whose numbers lie side by side.
#[derive(Clone, Debug, Default)]
pub(super) struct Features {
    /// Columns of u, rows of u, columns of v, rows of v, in pixel metres.
    offsets: [Vec<f32>; 4],
}

/// Room for one pixel's responses; kept from pixel to pixel.
#[derive(Clone, Debug, Default)]
pub(super) struct Room {
    first: Vec<i32>,
    second: Vec<i32>,
    /// The responses in millimetres.
    pub(super) responses: Vec<i16>,
}

impl Features {
    pub(super) fn push(&mut self, offsets: &Offsets) {
        self.offsets.iter_mut().zip(offsets).for_each(|(list, offset)| list.push(*offset));
    }

    /// Fills the room with a pixel's responses, in the order in which the features were pushed.
    pub(super) fn respond(&self, image: &ProbeImage, place: (f32, f32), per_metre: f32, room: &mut Room) {
        let [u_x, u_y, v_x, v_y] = &self.offsets;
        indices(image, place, per_metre, (u_x, u_y), &mut room.first);
        indices(image, place, per_metre, (v_x, v_y), &mut room.second);
        let values = image.values();
        let value = |index: i32| values.get(index.cast_unsigned() as usize).copied().unwrap_or(BACKGROUND);
        room.responses.clear();
        room.responses.extend(
            room.first.iter().zip(&room.second).map(|(u, v)| value(*u).cast_signed() - value(*v).cast_signed()),
        );
    }
}

/// Where probes stand in the image's values; outside is clamped to the border.
#[expect(clippy::cast_possible_truncation, clippy::cast_possible_wrap, reason = "clamped to the image and its border")]
fn indices(
    image: &ProbeImage,
    (column, row): (f32, f32),
    per_metre: f32,
    (across, down): (&[f32], &[f32]),
    into: &mut Vec<i32>,
) {
    let (last_column, last_row) = ((image.width() + 1) as f32, (image.height() + 1) as f32);
    let stride = image.stride() as i32;
    into.clear();
    into.extend(across.iter().zip(down).map(|(across, down)| {
        let column = (column + across * per_metre + 0.5 + 1.0).clamp(0.0, last_column);
        let row = (row + down * per_metre + 0.5 + 1.0).clamp(0.0, last_row);
        row as i32 * stride + column as i32
    }));
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn many_at_once_respond_as_one_by_one(
            offsets in proptest::collection::vec(proptest::array::uniform4(-300.0_f32..300.0), 1..40),
            (column, row) in (0_u8..40, 0_u8..30),
            depth in 400_u16..4000,
            filled in 0_u16..1200,
        ) {
            let mut image = ProbeImage::new(40, 30);
            (0..filled).for_each(|index| image.set(usize::from(index * 7 % 40), usize::from(index * 11 % 30), 500 + index));
            let mut features = Features::default();
            offsets.iter().for_each(|offsets| features.push(offsets));
            let (place, per_metre) = ((f32::from(column), f32::from(row)), 1000.0 / f32::from(depth));
            let mut room = Room::default();
            features.respond(&image, place, per_metre, &mut room);
            let one_by_one: Vec<i32> = offsets.iter().map(|offsets| image.response(place, per_metre, offsets)).collect();
            prop_assert_eq!(room.responses.iter().map(|response| i32::from(*response)).collect::<Vec<_>>(), one_by_one);
        }
    }
}
