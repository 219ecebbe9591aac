//! Axes: their range, their marks, and the words at the marks.

/// An axis: a label with its unit, and what its range must hold.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Axis {
    pub(super) label: String,
    pub(super) range: Option<[f64; 2]>,
    pub(super) includes: Vec<f64>,
    pub(super) categories: Vec<String>,
    pub(super) reversed: bool,
    whole: bool,
}

impl Axis {
    /// An axis that spans its data. Name quantity and unit, as in `energy (N)`.
    #[must_use]
    pub fn new(label: impl Into<String>) -> Self {
        Self { label: label.into(), ..Self::default() }
    }

    /// An axis of names: the first stands at 0, the next at 1, and so on.
    #[must_use]
    pub fn categories<S: Into<String>>(label: impl Into<String>, names: impl IntoIterator<Item = S>) -> Self {
        Self { label: label.into(), categories: names.into_iter().map(Into::into).collect(), ..Self::default() }
    }

    /// Spans exactly this range; what lies outside is cut off.
    #[must_use]
    pub const fn range(mut self, low: f64, high: f64) -> Self {
        self.range = Some([low, high]);
        self
    }

    /// Spans its data and this value.
    #[must_use]
    pub fn including(mut self, value: f64) -> Self {
        self.includes.push(value);
        self
    }

    /// Runs from the high value to the low one.
    #[must_use]
    pub const fn reversed(mut self) -> Self {
        self.reversed = true;
        self
    }

    /// Marks whole numbers only: for counts.
    #[must_use]
    pub const fn whole(mut self) -> Self {
        self.whole = true;
        self
    }

    /// The range that holds `data` (lowest and highest value) and what the axis must include.
    pub(super) fn span(&self, data: Option<[f64; 2]>) -> [f64; 2] {
        if let Some([low, high]) = self.range
            && low.is_finite()
            && high.is_finite()
            && low < high
        {
            return [low, high];
        }
        if !self.categories.is_empty() {
            return [-0.6, self.categories.len() as f64 - 0.4];
        }
        let values = data.into_iter().flatten().chain(self.includes.iter().copied()).filter(|value| value.is_finite());
        let (low, high) =
            values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| (low.min(value), high.max(value)));
        if low > high {
            return [0.0, 1.0];
        }
        let margin = if high > low { (high - low) * 0.05 } else { (low.abs() * 0.1).max(0.5) };
        // A quantity that starts at zero is drawn from zero: no margin below it.
        let low = if low >= 0.0 && low < margin { low.min(0.0) } else { low - margin };
        [low, high + margin]
    }

    /// The marks on a range, about `wanted` of them: place and words.
    pub(super) fn marks(&self, span: [f64; 2], wanted: usize) -> Vec<(f64, String)> {
        if !self.categories.is_empty() {
            return self.categories.iter().enumerate().map(|(index, name)| (index as f64, name.clone())).collect();
        }
        let step = nice_step((span[1] - span[0]) / wanted.max(1) as f64);
        let step = if self.whole { step.ceil() } else { step };
        let first = (span[0] / step).ceil();
        let last = (span[1] / step).floor();
        let decimals = decimals_of(step);
        let mut marks = Vec::new();
        let mut index = first;
        while index <= last && marks.len() <= 100 {
            let value = index * step;
            // Minus zero would be written with its sign.
            let value = if value == 0.0 { 0.0 } else { value };
            marks.push((value, words(value, step, decimals)));
            index += 1.0;
        }
        marks
    }
}

/// The value itself for a person: plain digits, or powers of ten where those would be long.
fn words(value: f64, step: f64, decimals: usize) -> String {
    if (1e-5..1e6).contains(&step) {
        format!("{value:.decimals$}").replace('-', "\u{2212}")
    } else {
        format!("{value:.1e}")
    }
}

/// The smallest of 1, 2, 2.5 and 5 times a power of ten that is not below `least`.
fn nice_step(least: f64) -> f64 {
    if !least.is_finite() || least <= 0.0 {
        return 1.0;
    }
    let power = 10_f64.powf(least.log10().floor());
    [1.0, 2.0, 2.5, 5.0, 10.0]
        .into_iter()
        .map(|factor| factor * power)
        .find(|step| *step >= least * 0.999_999)
        .unwrap_or(power * 10.0)
}

/// Digits after the point that a multiple of `step` needs.
fn decimals_of(step: f64) -> usize {
    (0..6)
        .find(|decimals| {
            let scaled = step * 10_f64.powi(*decimals);
            (scaled - scaled.round()).abs() < 1e-6 * scaled.max(1.0)
        })
        .map_or(6, |decimals| usize::try_from(decimals).unwrap_or(6))
}
