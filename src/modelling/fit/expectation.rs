//! The state of a fit: components, the density of each at each point, and one sweep over them.
//!
//! Densities are kept as exp(log density - a shift of the point), so a point that is far from everything loses nothing,
//! and the sum over components is carried along. One pass over the points gives a component its new densities and gathers
//! what the next one takes of them: a sweep costs one exponential and one division a point and component.

use super::eigen::floored;
use super::lanes::{Cloud, Density, Lanes, Moments, exponential};
use nalgebra::{SMatrix, SVector};

/// A total above this is worked out anew: the largest density of a point began at 1.
const TOO_MUCH: f64 = 1e6;
/// After so many sweeps the totals are worked out anew, free of what rounding has gathered.
const SWEEPS_TO_REFRESH: u32 = 16;

#[derive(Clone, Debug)]
struct Component<const D: usize> {
    weight: f64,
    /// From the cloud's mean.
    mean: SVector<f64, D>,
    covariance: SMatrix<f64, D, D>,
    /// exp(log density - shift) at each point, without the weight.
    density: Vec<Lanes>,
}

/// The state of a fit.
#[derive(Clone, Debug)]
pub(super) struct State<'a, const D: usize> {
    cloud: &'a Cloud<D>,
    components: Vec<Component<D>>,
    /// One shift a point, and their sum.
    shifts: Vec<Lanes>,
    shift: f64,
    /// The weighted sum of the densities at each point.
    totals: Vec<Lanes>,
    /// What the first component takes of the points, where the last pass has gathered that.
    gathered: Option<Moments<D>>,
    floor_squared: f64,
    sweeps: u32,
}

impl<'a, const D: usize> State<'a, D> {
    pub(super) fn new(
        cloud: &'a Cloud<D>,
        means: Vec<SVector<f64, D>>,
        covariance: SMatrix<f64, D, D>,
        floor: f64,
    ) -> Self {
        let weight = 1.0 / means.len().max(1) as f64;
        let blocks = cloud.blocks().len();
        let make = |mean| Component { weight, mean, covariance, density: vec![Lanes::ZERO; blocks] };
        let means = means.into_iter().map(|mean| mean - cloud.mean());
        let mut state = Self {
            cloud,
            components: means.map(make).collect(),
            shifts: vec![Lanes::ZERO; blocks],
            shift: 0.0,
            totals: vec![Lanes::ZERO; blocks],
            gathered: None,
            floor_squared: floor * floor,
            sweeps: 0,
        };
        state.refresh();
        state
    }

    pub(super) fn count(&self) -> usize {
        self.components.len()
    }

    pub(super) fn parts(&self) -> impl Iterator<Item = (f64, SVector<f64, D>, SMatrix<f64, D, D>)> {
        self.components.iter().map(|part| (part.weight, part.mean + self.cloud.mean(), part.covariance))
    }

    pub(super) fn log_likelihood(&self) -> f64 {
        self.cloud.sum_of_logarithms(&self.totals) + self.shift
    }

    /// The message length of the authors' program: half the parameters of a component times the logarithms of the
    /// weights and of the number of points, less the log likelihood.
    pub(super) fn message_length(&self) -> f64 {
        let half = half_parameters::<D>();
        let weights: f64 = self.components.iter().map(|component| component.weight.ln()).sum();
        let count = self.components.len() as f64;
        half * weights + (half + 0.5) * count * (self.cloud.count() as f64).ln() - self.log_likelihood()
    }

    /// One sweep: every component in turn takes its share of the points, dies where it is not worth its parameters, and
    /// is moved at once.
    pub(super) fn sweep(&mut self) {
        self.sweeps += 1;
        // A total far above its shift has lost the digits of the densities that it is to fall back to.
        let whole = self.totals.split_last().map_or(self.totals.as_slice(), |(_, whole)| whole);
        let most = whole.iter().fold(Lanes::ZERO, |most, total| most.fast_max(*total));
        let is_far = most.to_array().iter().any(|most| *most > TOO_MUCH);
        if self.sweeps.is_multiple_of(SWEEPS_TO_REFRESH) || is_far {
            self.refresh();
        }
        let mut index = 0;
        while index < self.components.len() {
            let Some(shared) = self.gathered.take().or_else(|| self.gather(index)) else { return };
            let own_weight = self.components.get(index).map_or(0.0, |component| component.weight);
            let (mass, mean, covariance) = shared.sums(own_weight);
            let weight = (mass - half_parameters::<D>()).max(0.0) / self.cloud.count() as f64;
            if weight > 0.0 {
                self.move_component(index, mean, &covariance);
                self.set_weight(index, weight);
                index += 1;
            } else {
                self.remove(index);
            }
        }
    }

    pub(super) fn remove_lightest(&mut self) {
        let weights = self.components.iter().map(|component| component.weight).enumerate();
        if let Some((index, _)) = weights.min_by(|left, right| left.1.total_cmp(&right.1)) {
            self.remove(index);
        }
    }

    fn remove(&mut self, index: usize) {
        self.components.remove(index);
        let sum: f64 = self.components.iter().map(|component| component.weight).sum();
        for component in &mut self.components {
            component.weight /= sum;
        }
        self.refresh();
    }

    fn move_component(&mut self, index: usize, mean: SVector<f64, D>, covariance: &SMatrix<f64, D, D>) {
        if let Some(component) = self.components.get_mut(index) {
            component.mean = mean;
            component.covariance = floored(covariance, self.floor_squared);
        }
    }

    /// Gives a moved component its new weight: the others shrink or grow so that all add up to 1, the totals follow, and
    /// what the next component takes of the points is gathered on the way.
    fn set_weight(&mut self, index: usize, weight: f64) {
        let all = self.components.iter().enumerate();
        // Summed and not taken from 1: what rounding had left beside 1 would grow by 1 / sum in every sweep.
        let others: f64 = all.filter(|(other, _)| *other != index).map(|(_, component)| component.weight).sum();
        let sum = others + weight;
        let old_weight = self.components.get(index).map_or(0.0, |component| component.weight);
        for component in &mut self.components {
            component.weight /= sum;
        }
        if let Some(component) = self.components.get_mut(index) {
            component.weight = weight / sum;
        }
        let change = Change { sum, old_weight, new_weight: weight / sum };
        let next = if index + 1 < self.components.len() { index + 1 } else { 0 };
        let Some(moved) = self.components.get_mut(index) else { return };
        let density = Density::new(&moved.mean, moved.covariance);
        let mut values = std::mem::take(&mut moved.density);
        // Alone, a component is its own next one, and what it takes is gathered later.
        let is_alone = next == index;
        let others = self.components.get(next).filter(|_| !is_alone).map_or(&self.shifts, |next| &next.density);
        let points = (self.cloud, self.shifts.as_slice());
        let (moments, in_range) = change.pass(points, &density, &mut values, &mut self.totals, others);
        self.gathered = (!is_alone).then_some(moments);
        if let Some(moved) = self.components.get_mut(index) {
            moved.density = values;
        }
        if !in_range {
            self.refresh();
        }
    }

    /// What a component takes of the points.
    fn gather(&self, index: usize) -> Option<Moments<D>> {
        let component = self.components.get(index)?;
        let mut moments = Moments::default();
        for ((block, density), total) in self.cloud.blocks().iter().zip(&component.density).zip(&self.totals) {
            moments.add(block, *density / *total);
        }
        Some(moments)
    }

    /// Works out shifts, densities and totals anew, free of what rounding has gathered.
    fn refresh(&mut self) {
        self.gathered = None;
        self.shifts.fill(Lanes::splat(f64::NEG_INFINITY));
        for component in &mut self.components {
            let density = Density::new(&component.mean, component.covariance);
            for ((block, value), shift) in self.cloud.blocks().iter().zip(&mut component.density).zip(&mut self.shifts)
            {
                *value = density.logarithm(block);
                *shift = shift.max(*value);
            }
        }
        self.totals.fill(Lanes::ZERO);
        for component in &mut self.components {
            let weight = Lanes::splat(component.weight);
            for ((value, shift), total) in component.density.iter_mut().zip(&self.shifts).zip(&mut self.totals) {
                *value = exponential(*value - *shift);
                *total += weight * *value;
            }
        }
        self.cloud.make_copies_endless(&mut self.totals);
        self.shift = self.cloud.sum_of(&self.shifts);
    }
}

/// A component's new weight: the totals are divided by `sum`, and the component counts as `new_weight` where it counted as
/// `old_weight` before.
#[derive(Clone, Copy)]
struct Change {
    sum: f64,
    old_weight: f64,
    new_weight: f64,
}

impl Change {
    /// One pass over the points: new densities of the moved component, totals, and what a component with the densities
    /// `others` takes of the points. False where a total has become too small to be trusted.
    fn pass<const D: usize>(
        self,
        (cloud, shifts): (&Cloud<D>, &[Lanes]),
        density: &Density<D>,
        values: &mut [Lanes],
        totals: &mut [Lanes],
        others: &[Lanes],
    ) -> (Moments<D>, bool) {
        let mut moments = Moments::default();
        let mut least = Lanes::splat(f64::MAX);
        let [kept, less, more] = [1.0 / self.sum, self.old_weight / self.sum, self.new_weight].map(Lanes::splat);
        let points = cloud.blocks().iter().zip(shifts).zip(values).zip(totals).zip(others);
        for ((((block, shift), value), total), other) in points {
            let new = exponential(density.logarithm(block) - *shift);
            *total = (*total * kept - less * *value).fast_max(Lanes::ZERO) + more * new;
            *value = new;
            least = least.fast_min(*total);
            moments.add(block, *other / *total);
        }
        (moments, least.to_array().iter().all(|total| *total >= f64::MIN_POSITIVE))
    }
}

/// Half the number of parameters of a Gaussian: mean and covariance.
fn half_parameters<const D: usize>() -> f64 {
    (D + D * (D + 1) / 2) as f64 / 2.0
}
