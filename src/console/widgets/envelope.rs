//! The least and the most of each series in each column of a plot, and where there is no data.
//!
//! A spike of one sample shows however long a time is plotted, and a hole in the data is a hole in the plot.

use crate::snapshot::ForceSample;
use crate::time::Stamp;

/// Series of one kind: x, y, z and combined.
pub(in crate::console) const SERIES: usize = 4;

/// Least and most of a series in a column; `None` where it has no value there.
pub(in crate::console) type Extent = Option<(f64, f64)>;

/// The columns of a plot, oldest first.
#[derive(Clone, Debug)]
pub(in crate::console) struct Envelope {
    /// For each column the extent of each series.
    pub(in crate::console) columns: Vec<[Extent; SERIES]>,
    /// For each column, whether data is missing there.
    pub(in crate::console) gaps: Vec<bool>,
    end: i64,
    width: f64,
}

/// The time that a plot shows.
#[derive(Clone, Copy, Debug)]
pub(in crate::console) struct Window {
    /// The moment at its right edge.
    pub(in crate::console) now: Stamp,
    /// Seconds that it shows.
    pub(in crate::console) span: f64,
    /// Columns of dots.
    pub(in crate::console) columns: usize,
    /// Seconds without a sample that make a gap.
    pub(in crate::console) gap: f64,
}

impl Envelope {
    /// Sorts samples (newest first) into columns; `values` picks the four series of a sample.
    pub(in crate::console) fn new<'a>(
        newest_first: impl Iterator<Item = &'a ForceSample>,
        window: Window,
        values: impl Fn(&ForceSample) -> [Option<f64>; SERIES],
    ) -> Self {
        let width = (window.span / window.columns.max(1) as f64).max(1e-6);
        let mut envelope = Self {
            columns: vec![[None; SERIES]; window.columns],
            gaps: vec![false; window.columns],
            end: column_of(window.now, width),
            width,
        };
        let mut later: Option<(Stamp, [Option<f64>; SERIES])> = None;
        for sample in newest_first {
            let column = envelope.index(sample.stamp);
            let present = values(sample);
            let (after, known) = later.map_or((window.now, [None; SERIES]), |(stamp, known)| (stamp, known));
            if after.since(sample.stamp).as_secs_f64() > window.gap {
                // Silence until now reaches the edge of the plot; a gap ends before the sample that ends it.
                envelope.mark_gap(column, envelope.index(after) + i64::from(later.is_none()));
            } else {
                envelope.connect((column, present), (envelope.index(after), known));
            }
            if column < 0 {
                break;
            }
            envelope.include(column, present);
            later = Some((sample.stamp, present));
        }
        envelope
    }

    /// The column of a moment, from 0 at the left; negative where it is older than the plot.
    pub(in crate::console) fn index(&self, stamp: Stamp) -> i64 {
        signed(self.columns.len()) - 1 - (self.end - column_of(stamp, self.width))
    }

    /// The largest magnitude of all series.
    pub(in crate::console) fn largest(&self) -> f64 {
        let ends = self.columns.iter().flatten().flatten().flat_map(|(least, most)| [least.abs(), most.abs()]);
        ends.filter(|value| value.is_finite()).fold(0.0, f64::max)
    }

    /// The least value of a series, or zero where it has none.
    pub(in crate::console) fn least(&self, series: usize) -> f64 {
        let extents = self.columns.iter().filter_map(|column| column.get(series).copied().flatten());
        extents.map(|(least, _)| least).fold(0.0, f64::min)
    }

    fn include(&mut self, column: i64, values: [Option<f64>; SERIES]) {
        let Some(extents) = usize::try_from(column).ok().and_then(|column| self.columns.get_mut(column)) else {
            return;
        };
        for (extent, value) in extents.iter_mut().zip(values) {
            if let Some(value) = value.filter(|value| value.is_finite()) {
                let (least, most) = extent.unwrap_or((value, value));
                *extent = Some((least.min(value), most.max(value)));
            }
        }
    }

    /// Draws a line from column to column between two neighbouring samples: what is sparse or steep stays one piece.
    fn connect(&mut self, older: (i64, [Option<f64>; SERIES]), newer: (i64, [Option<f64>; SERIES])) {
        let distance = (newer.0 - older.0) as f64;
        let between = |share: f64| {
            let mut values = [None; SERIES];
            for ((slot, start), end) in values.iter_mut().zip(older.1).zip(newer.1) {
                *slot = start.zip(end).map(|(start, end)| start + (end - start) * share);
            }
            values
        };
        for column in older.0.max(-1)..newer.0 {
            let edge = between(((column - older.0) as f64 + 0.5) / distance);
            self.include(column, edge);
            self.include(column + 1, edge);
        }
    }

    fn mark_gap(&mut self, from: i64, to: i64) {
        let last = signed(self.gaps.len());
        for column in (from + 1).max(0)..to.min(last) {
            if let Some(gap) = usize::try_from(column).ok().and_then(|column| self.gaps.get_mut(column)) {
                *gap = true;
            }
        }
    }
}

fn signed(count: usize) -> i64 {
    i64::try_from(count).unwrap_or(i64::MAX)
}

/// Columns are fixed to the epoch and not to the right edge, so that the plot does not shimmer as time goes on.
#[expect(clippy::cast_possible_truncation, reason = "seconds since the epoch over at least a microsecond")]
fn column_of(stamp: Stamp, width: f64) -> i64 {
    (stamp.seconds() / width).floor() as i64
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn sample(milliseconds: u64, x: f64) -> ForceSample {
        ForceSample {
            stamp: Stamp::from_nanoseconds(milliseconds * 1_000_000),
            force: [x, 0.0, 0.0],
            ..ForceSample::default()
        }
    }

    fn window(milliseconds: u64, columns: usize) -> Window {
        let now = Stamp::from_nanoseconds(milliseconds * 1_000_000);
        Window { now, span: 10.0, columns, gap: 0.05 }
    }

    fn of_x(samples: &[ForceSample], window: Window) -> Envelope {
        Envelope::new(samples.iter().rev(), window, |sample| [Some(sample.force[0]), None, None, None])
    }

    #[test]
    fn a_spike_of_one_sample_shows() {
        let samples: Vec<_> =
            (0..1000).map(|index| sample(index * 10, if index == 500 { 30.0 } else { 1.0 })).collect();
        let envelope = of_x(&samples, window(9990, 40));
        assert!((envelope.largest() - 30.0).abs() < 1e-12);
        let spiked = envelope.columns.iter().filter(|column| column[0].is_some_and(|(_, most)| most > 29.0)).count();
        assert_eq!(spiked, 1);
    }

    #[test]
    fn a_hole_in_the_data_is_a_gap_and_so_is_silence_until_now() {
        let samples: Vec<_> =
            (0..1000).filter(|index| !(400..600).contains(index)).map(|index| sample(index * 10, 1.0)).collect();
        let envelope = of_x(&samples, window(12_000, 100));
        let (hole, silence) = (envelope.index(Stamp::from_nanoseconds(5_000_000_000)), 99);
        assert!(envelope.gaps[usize::try_from(hole).unwrap()] && envelope.gaps[silence]);
        assert!(envelope.columns[usize::try_from(hole).unwrap()][0].is_none());
        assert!(!envelope.gaps[usize::try_from(hole).unwrap() - 15]);
    }

    #[test]
    fn sparse_data_is_a_line_and_numbers_that_are_not_finite_are_left_out() {
        let samples = [sample(9900, 0.0), sample(9940, 4.0), sample(9950, f64::NAN)];
        let envelope = Envelope::new(samples.iter().rev(), Window { span: 0.1, ..window(9950, 100) }, |sample| {
            [Some(sample.force[0]), None, None, None]
        });
        let known = envelope.columns.iter().filter(|column| column[0].is_some()).count();
        assert!((40..=42).contains(&known), "{known}");
        assert!((envelope.largest() - 4.0).abs() < 1e-9);
    }

    proptest! {
        #[test]
        fn no_sample_in_the_plot_is_outside_its_columns_extent(
            stamps in proptest::collection::vec((0_u64..20_000, -50.0..50.0_f64), 1..60),
            columns in 1_usize..80,
        ) {
            let mut samples: Vec<_> = stamps.iter().map(|(stamp, value)| sample(*stamp, *value)).collect();
            samples.sort_by_key(|sample| sample.stamp);
            let newest = samples[samples.len() - 1].stamp;
            let envelope = of_x(&samples, Window { now: newest, ..window(0, columns) });
            for sample in &samples {
                if let Ok(column) = usize::try_from(envelope.index(sample.stamp)) {
                    let (least, most) = envelope.columns[column][0].unwrap();
                    prop_assert!(least <= sample.force[0] && sample.force[0] <= most);
                }
            }
        }
    }
}
