//! Which pixels of the foreground are asked for joints: neighbours tell the same.
//!
//! The nearer a person is, the more pixels there are; so that a frame takes no longer then, fewer of them are asked.

use crate::vision::foreground::Pixel;

/// At most so many are asked, unless the person fills the image.
const MOST: usize = 8_000;

/// How the pixels that are asked are spread.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) enum Sampling {
    /// Every second pixel of every second row.
    #[default]
    Quarter,
    /// Half of those, as the white squares of a chessboard.
    Eighth,
    /// Every fourth pixel of every fourth row.
    Sixteenth,
}

impl Sampling {
    /// What keeps so many pixels of foreground within [`MOST`].
    pub(super) fn of(pixels: usize) -> Self {
        let fits = |sampling: &Self| pixels / sampling.each() <= MOST;
        [Self::Quarter, Self::Eighth].into_iter().find(fits).unwrap_or(Self::Sixteenth)
    }

    /// Pixels of the image that each one asked stands for.
    pub(super) const fn each(self) -> usize {
        match self {
            Self::Quarter => 4,
            Self::Eighth => 8,
            Self::Sixteenth => 16,
        }
    }

    /// Whether a pixel is asked.
    pub(super) const fn asks(self, pixel: Pixel) -> bool {
        let (column, row) = (pixel.column, pixel.row);
        match self {
            Self::Quarter => column.is_multiple_of(2) && row.is_multiple_of(2),
            Self::Eighth => Self::Quarter.asks(pixel) && (column ^ row) & 2 == 0,
            Self::Sixteenth => column.is_multiple_of(4) && row.is_multiple_of(4),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn asked(sampling: Sampling) -> usize {
        let pixels = (0..64).flat_map(|row| (0..64).map(move |column| Pixel { column, row, depth: 1000 }));
        pixels.filter(|pixel| sampling.asks(*pixel)).count()
    }

    #[test]
    fn each_pixel_asked_stands_for_as_many_as_it_says() {
        for sampling in [Sampling::Quarter, Sampling::Eighth, Sampling::Sixteenth] {
            assert_eq!(asked(sampling) * sampling.each(), 64 * 64, "{sampling:?}");
        }
    }

    #[test]
    fn the_more_pixels_there_are_the_fewer_of_them_are_asked() {
        assert_eq!(Sampling::of(0), Sampling::Quarter);
        assert_eq!(Sampling::of(4 * MOST), Sampling::Quarter);
        assert_eq!(Sampling::of(4 * (MOST + 1)), Sampling::Eighth);
        assert_eq!(Sampling::of(640 * 480), Sampling::Sixteenth);
    }
}
