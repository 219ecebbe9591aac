//! SGD, momentum, Adagrad, RMSProp and Adam: how a resistance becomes a displacement (thesis section 4.3).
//!
//! All five share one shape: moments that are carried from iteration to iteration, and a rule that turns the moments
//! before an iteration and one resistance into new moments and a displacement. Within an iteration every contact reads
//! the same old moments; at its end the moments become the mean over the contacts (algorithm 2).

use crate::geometry::Vector;
use serde::{Deserialize, Serialize};
use std::fmt::{self, Debug};

/// Decay of the first moment (Kingma and Ba, 2015; thesis section 4.3.2).
const FIRST_DECAY: f64 = 0.9;
/// Decay of the second moment (the same).
const SECOND_DECAY: f64 = 0.999;
/// Keeps the division defined (the same).
const EPSILON: f64 = 1e-8;
/// Friction of the momentum update: its usual value.
const MOMENTUM: f64 = 0.9;
/// Decay of RMSProp's mean square: its usual value, without bias correction.
const MEAN_SQUARE_DECAY: f64 = 0.99;

/// Which of the five methods.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Method {
    /// A fixed share of the resistance. With a rate of 0.01 m/N this is the preliminary adjustment of equation 4.1.
    Sgd,
    /// A running sum of resistances.
    Momentum,
    /// Divided by the root of the sum of squares.
    Adagrad,
    /// Divided by the root of the running mean of squares.
    RmsProp,
    /// Running means of both, corrected for their start (the thesis' method).
    #[default]
    Adam,
}

impl Method {
    /// All methods in the order of thesis table 4.1.
    pub const ALL: [Self; 5] = [Self::Sgd, Self::Momentum, Self::Adagrad, Self::RmsProp, Self::Adam];

    /// The name that files, arguments and tables share.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Sgd => "sgd",
            Self::Momentum => "momentum",
            Self::Adagrad => "adagrad",
            Self::RmsProp => "rmsprop",
            Self::Adam => "adam",
        }
    }

    fn rule(self) -> &'static dyn UpdateRule {
        match self {
            Self::Sgd => &Sgd,
            Self::Momentum => &Momentum,
            Self::Adagrad => &Adagrad,
            Self::RmsProp => &RmsProp,
            Self::Adam => &Adam,
        }
    }
}

impl fmt::Display for Method {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.pad(self.name())
    }
}

/// What the second moment is a moment of.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum SecondMoment {
    /// The squared length of the resistance: one number, the same in every frame of reference.
    #[default]
    Norm,
    /// The square of each coordinate, as Adam is usually written.
    Axis,
}

impl SecondMoment {
    /// The name that files and tables share.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Norm => "norm",
            Self::Axis => "axis",
        }
    }

    fn square(self, resistance: &Vector) -> Vector {
        match self {
            Self::Norm => Vector::repeat(resistance.norm_squared()),
            Self::Axis => resistance.component_mul(resistance),
        }
    }
}

/// Which method, how far it moves, and what its second moment is.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct OptimiserSettings {
    /// The method.
    pub method: Method,
    /// Metres a step for the normalised methods (Adagrad, RMSProp, Adam), metres a newton for the other two.
    ///
    /// The thesis gives no value for the robot; Adam's first step is exactly this long whatever the force, so 0.03 m.
    pub learning_rate: f64,
    /// What the second moment is a moment of.
    pub second_moment: SecondMoment,
}

impl Default for OptimiserSettings {
    fn default() -> Self {
        Self { method: Method::Adam, learning_rate: 0.03, second_moment: SecondMoment::Norm }
    }
}

/// The two moments. With [`SecondMoment::Norm`] the three numbers of the second are equal.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Moments {
    /// Of the resistance itself: m.
    pub first: Vector,
    /// Of its square: v.
    pub second: Vector,
}

/// What an optimiser carries from one iteration to the next; enough to go on where another left off.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct OptimiserState {
    /// Iterations begun so far, also those without a contact.
    pub iteration: u32,
    /// The mean moments of the last iteration that had contacts.
    pub moments: Moments,
}

/// One contact as a rule sees it.
struct Step<'a> {
    old: &'a Moments,
    resistance: &'a Vector,
    square: Vector,
    rate: f64,
    iteration: i32,
}

/// How one method works. The displacement is to be subtracted.
trait UpdateRule: Debug + Send + Sync {
    fn advance(&self, step: &Step<'_>) -> (Moments, Vector);
}

#[derive(Debug)]
struct Sgd;
#[derive(Debug)]
struct Momentum;
#[derive(Debug)]
struct Adagrad;
#[derive(Debug)]
struct RmsProp;
#[derive(Debug)]
struct Adam;

impl UpdateRule for Sgd {
    fn advance(&self, step: &Step<'_>) -> (Moments, Vector) {
        (*step.old, step.resistance * step.rate)
    }
}

impl UpdateRule for Momentum {
    fn advance(&self, step: &Step<'_>) -> (Moments, Vector) {
        let first = step.old.first * MOMENTUM + step.resistance * step.rate;
        (Moments { first, second: step.old.second }, first)
    }
}

impl UpdateRule for Adagrad {
    fn advance(&self, step: &Step<'_>) -> (Moments, Vector) {
        let second = step.old.second + step.square;
        (Moments { first: step.old.first, second }, divide(&(step.resistance * step.rate), &second))
    }
}

impl UpdateRule for RmsProp {
    fn advance(&self, step: &Step<'_>) -> (Moments, Vector) {
        let second = step.old.second * MEAN_SQUARE_DECAY + step.square * (1.0 - MEAN_SQUARE_DECAY);
        (Moments { first: step.old.first, second }, divide(&(step.resistance * step.rate), &second))
    }
}

impl UpdateRule for Adam {
    fn advance(&self, step: &Step<'_>) -> (Moments, Vector) {
        let first = step.old.first * FIRST_DECAY + step.resistance * (1.0 - FIRST_DECAY);
        let second = step.old.second * SECOND_DECAY + step.square * (1.0 - SECOND_DECAY);
        let corrected = first / (1.0 - FIRST_DECAY.powi(step.iteration));
        let corrected_square = second / (1.0 - SECOND_DECAY.powi(step.iteration));
        (Moments { first, second }, divide(&(corrected * step.rate), &corrected_square))
    }
}

fn divide(step: &Vector, square: &Vector) -> Vector {
    step.zip_map(square, |step, square| step / (square.sqrt() + EPSILON))
}

/// One optimiser at work.
#[derive(Clone, Debug)]
pub struct Optimiser {
    settings: OptimiserSettings,
    state: OptimiserState,
    sum: Moments,
    contacts: u32,
}

impl Optimiser {
    /// An optimiser that has learned nothing yet.
    #[must_use]
    pub fn new(settings: OptimiserSettings) -> Self {
        Self::resume(settings, OptimiserState::default())
    }

    /// An optimiser that goes on from a saved state.
    #[must_use]
    pub fn resume(settings: OptimiserSettings, state: OptimiserState) -> Self {
        Self { settings, state, sum: Moments::default(), contacts: 0 }
    }

    /// What it is set to.
    #[must_use]
    pub const fn settings(&self) -> &OptimiserSettings {
        &self.settings
    }

    /// What it has learned up to the last [`Optimiser::end`].
    #[must_use]
    pub const fn state(&self) -> &OptimiserState {
        &self.state
    }

    /// Begins an iteration.
    pub fn begin(&mut self) {
        self.state.iteration = self.state.iteration.saturating_add(1);
        self.sum = Moments::default();
        self.contacts = 0;
    }

    /// The displacement, to be **subtracted** from the position, that answers a resistance.
    pub fn step(&mut self, resistance: &Vector) -> Vector {
        let step = Step {
            old: &self.state.moments,
            resistance,
            square: self.settings.second_moment.square(resistance),
            rate: self.settings.learning_rate,
            iteration: i32::try_from(self.state.iteration.max(1)).unwrap_or(i32::MAX),
        };
        let (moments, displacement) = self.settings.method.rule().advance(&step);
        self.sum.first += moments.first;
        self.sum.second += moments.second;
        self.contacts += 1;
        displacement
    }

    /// Ends an iteration: the moments become their mean over its contacts, and stay where it had none.
    pub fn end(&mut self) {
        if self.contacts > 0 {
            let count = f64::from(self.contacts);
            self.state.moments = Moments { first: self.sum.first / count, second: self.sum.second / count };
        }
        self.contacts = 0;
    }
}

#[cfg(test)]
mod tests;
