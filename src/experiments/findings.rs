//! What an experiment hands over: rows of numbers, figures, and words about what they mean.

use crate::modelling::MixtureError;
use crate::report::plot::{Figure, PlotError};
use crate::strategy::StrategyError;
use serde::ser::{Serialize, SerializeMap, Serializer};
use serde_json::Value;
use thiserror::Error;

/// Why an experiment could not be run or written down.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum ExperimentError {
    /// A strategy refused its settings or path.
    #[error("an experiment could not be run: {0}")]
    Strategy(#[from] StrategyError),
    /// A random scene was no scene.
    #[error("a scene could not be made: {0}")]
    Scene(#[from] MixtureError),
    /// A figure could not be drawn or a page not be written.
    #[error(transparent)]
    Plot(#[from] PlotError),
    /// Anything else, in words.
    #[error("{0}")]
    Other(String),
}

/// One row of a table: names and values in the order in which they are to be read.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Row(Vec<(String, Value)>);

impl Row {
    /// A row of a table.
    #[must_use]
    pub fn of(table: &str) -> Self {
        Self::default().with("event", "row").with("table", table)
    }

    /// Adds a value; units belong into the name.
    #[must_use]
    pub fn with(mut self, name: impl Into<String>, value: impl Into<Value>) -> Self {
        self.0.push((name.into(), value.into()));
        self
    }

    /// Adds `NAME_mean` and `NAME_sd` of some values.
    #[must_use]
    pub fn with_statistics(self, name: &str, values: impl IntoIterator<Item = f64>) -> Self {
        let (mean, deviation) = mean_and_deviation(values);
        self.with(format!("{name}_mean"), mean).with(format!("{name}_sd"), deviation)
    }

    /// Adds the cells of another row.
    #[must_use]
    pub fn and(mut self, other: &Self) -> Self {
        self.0.extend_from_slice(&other.0);
        self
    }

    /// The value of a name.
    #[must_use]
    pub fn value(&self, name: &str) -> Option<&Value> {
        self.0.iter().find(|(other, _)| other == name).map(|(_, value)| value)
    }

    /// The number of a name; NaN where there is none.
    #[must_use]
    pub fn number(&self, name: &str) -> f64 {
        self.value(name).and_then(Value::as_f64).unwrap_or(f64::NAN)
    }

    /// Names and values.
    pub fn cells(&self) -> impl Iterator<Item = (&str, &Value)> {
        self.0.iter().map(|(name, value)| (name.as_str(), value))
    }

    /// The table that the row belongs to.
    #[must_use]
    pub fn table(&self) -> &str {
        self.value("table").and_then(Value::as_str).unwrap_or_default()
    }
}

impl Serialize for Row {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut map = serializer.serialize_map(Some(self.0.len()))?;
        for (name, value) in &self.0 {
            map.serialize_entry(name, value)?;
        }
        map.end()
    }
}

/// Mean and sample deviation (0 of fewer than two values).
#[must_use]
pub fn mean_and_deviation(values: impl IntoIterator<Item = f64>) -> (f64, f64) {
    let values: Vec<f64> = values.into_iter().collect();
    let count = values.len() as f64;
    if values.is_empty() {
        return (0.0, 0.0);
    }
    let mean = values.iter().sum::<f64>() / count;
    let squares: f64 = values.iter().map(|value| (value - mean).powi(2)).sum();
    (mean, if values.len() > 1 { (squares / (count - 1.0)).sqrt() } else { 0.0 })
}

/// A figure with the stem of its files and its caption.
#[derive(Debug)]
pub struct Drawing {
    /// The stem of the files.
    pub stem: String,
    /// The figure.
    pub figure: Figure,
    /// What it shows, and what differs from the thesis.
    pub caption: String,
}

/// What came of an experiment.
#[derive(Debug, Default)]
pub struct Findings {
    /// Rows, tables one after the other.
    pub rows: Vec<Row>,
    /// Figures.
    pub drawings: Vec<Drawing>,
    /// Paragraphs: what the numbers mean, and what differs from the thesis and why.
    pub remarks: Vec<String>,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_keep_their_order_and_know_their_statistics() {
        let row = Row::of("4.1").with("method", "adam").with_statistics("error", [1.0, 2.0, 3.0]);
        let text = serde_json::to_string(&row).unwrap();
        assert_eq!(text, r#"{"event":"row","table":"4.1","method":"adam","error_mean":2.0,"error_sd":1.0}"#);
        assert!((row.number("error_mean") - 2.0).abs() < 1e-12);
        assert!(row.number("nothing").is_nan());
    }

    #[test]
    fn statistics_of_little_are_no_division_by_nothing() {
        assert_eq!(mean_and_deviation([]), (0.0, 0.0));
        assert_eq!(mean_and_deviation([4.0]), (4.0, 0.0));
    }
}
