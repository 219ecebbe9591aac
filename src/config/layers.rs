//! Settings in layers: what a later layer says replaces what an earlier one said, key by key.

use super::ConfigError;
use serde::Serialize;
use serde::de::DeserializeOwned;
use std::path::Path;
use toml::{Table, Value};

/// The defaults of `T` with each layer laid over them in turn. A layer is where it comes from (a file, for errors) and its
/// keys.
///
/// # Errors
/// [`ConfigError::Value`] names the first layer that brings a key or value that `T` does not take.
pub fn layered<T: Serialize + DeserializeOwned + Default>(layers: &[(&Path, &Table)]) -> Result<T, ConfigError> {
    let mut settings = T::default();
    for (path, layer) in layers {
        let mut table = Table::try_from(&settings).map_err(|error| ConfigError::value(path, "settings", error))?;
        lay_over(&mut table, layer);
        settings = table.try_into().map_err(|error: toml::de::Error| {
            let reason = error.to_string();
            ConfigError::value(path, "settings", reason.trim_end().replace('\n', ", "))
        })?;
    }
    Ok(settings)
}

fn lay_over(table: &mut Table, layer: &Table) {
    for (key, value) in layer {
        match (table.get_mut(key), value) {
            (Some(Value::Table(below)), Value::Table(above)) => lay_over(below, above),
            _ => {
                table.insert(key.clone(), value.clone());
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sensing::WindowSettings;

    fn table(text: &str) -> Table {
        text.parse().unwrap()
    }

    #[test]
    fn a_later_layer_wins_key_by_key() {
        let (first, second) = (table("length = 7\nthreshold_newtons = 4.0"), table("threshold_newtons = 3.0"));
        let settings: WindowSettings =
            layered(&[(Path::new("config.toml"), &first), (Path::new("p01.toml"), &second)]).unwrap();
        let expected = WindowSettings { length: 7, threshold_newtons: 3.0, ..WindowSettings::default() };
        assert_eq!(settings, expected);
    }

    #[test]
    fn a_key_that_does_not_exist_is_named_with_its_file() {
        let layer = table("treshold_newtons = 3.0");
        let error = layered::<WindowSettings>(&[(Path::new("p01.toml"), &layer)]).unwrap_err().to_string();
        assert!(error.contains("p01.toml") && error.contains("treshold_newtons"), "{error}");
    }

    #[test]
    fn a_value_of_the_wrong_kind_is_named_with_its_key() {
        let layer = table("length = \"many\"");
        let error = layered::<WindowSettings>(&[(Path::new("p01.toml"), &layer)]).unwrap_err().to_string();
        assert!(error.contains("p01.toml") && error.contains("length"), "{error}");
    }
}
