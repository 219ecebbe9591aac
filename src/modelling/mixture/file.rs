//! How a mixture looks in a file: a list of components with `weight`, `mean` and the rows of `covariance`.

use super::{Mixture, MixtureError};
use nalgebra::{SMatrix, SVector};
use serde::{Deserialize, Deserializer, Serialize, Serializer, de::Error};

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct ComponentFile {
    weight: f64,
    mean: Vec<f64>,
    covariance: Vec<Vec<f64>>,
}

impl<const D: usize> Serialize for Mixture<D> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_seq(self.components().iter().map(|component| ComponentFile {
            weight: component.weight(),
            mean: component.mean().iter().copied().collect(),
            covariance: component.covariance().row_iter().map(|row| row.iter().copied().collect()).collect(),
        }))
    }
}

impl<'de, const D: usize> Deserialize<'de> for Mixture<D> {
    fn deserialize<R: Deserializer<'de>>(deserializer: R) -> Result<Self, R::Error> {
        let components = Vec::<ComponentFile>::deserialize(deserializer)?;
        read(&components).map_err(R::Error::custom)
    }
}

fn read<const D: usize>(components: &[ComponentFile]) -> Result<Mixture<D>, MixtureError> {
    let parts = components.iter().enumerate().map(|(index, component)| {
        check_length(index, "mean", component.mean.len(), D)?;
        check_length(index, "covariance", component.covariance.len(), D)?;
        for row in &component.covariance {
            check_length(index, "covariance", row.len(), D)?;
        }
        let mean = SVector::from_iterator(component.mean.iter().copied());
        let covariance = SMatrix::from_row_iterator(component.covariance.iter().flatten().copied());
        Ok((component.weight, mean, covariance))
    });
    Mixture::new(parts.collect::<Result<Vec<_>, _>>()?)
}

const fn check_length(component: usize, key: &'static str, found: usize, expected: usize) -> Result<(), MixtureError> {
    if found == expected { Ok(()) } else { Err(MixtureError::Shape { component, key, found, expected }) }
}
