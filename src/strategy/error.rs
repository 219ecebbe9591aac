//! What can be wrong with a strategy's input.

use super::StrategyKind;
use thiserror::Error;

/// Why a strategy cannot be built or begun.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum StrategyError {
    /// A setting has a value that cannot work.
    #[error("`{key}` is {value}, and it must be {needed}")]
    Setting {
        /// Its key, with dots between tables.
        key: &'static str,
        /// Its value.
        value: f64,
        /// What it must be and why.
        needed: &'static str,
    },
    /// A path with fewer than two points.
    #[error(
        "a dressing path needs at least a start and an end, and this one has {points} points; look at the arm again"
    )]
    ShortPath {
        /// How many it has.
        points: usize,
    },
    /// A path with NaN or infinity in it.
    #[error("way-point {index} of the path is not a finite position; look at the arm again")]
    NotFinite {
        /// Which one, from 0.
        index: usize,
    },
    /// Two neighbouring way-points coincide.
    #[error("way-points {index} and {} of the path are the same point; look at the arm again", index + 1)]
    NoLength {
        /// The first of the two, from 0.
        index: usize,
    },
    /// The strategy needs to know where the person can reach.
    #[error(
        "strategy `{strategy}` needs the person's movement space; record and fit it (`valet fit`), or choose `force`"
    )]
    NoMovementSpace {
        /// Which strategy.
        strategy: StrategyKind,
    },
    /// The strategy is to weigh the whole arm, and the movement space knows its joints only one by one.
    #[error(
        "`multimodal.whole_arm` needs a movement space of the whole arm; record the person's movement again, or switch it off"
    )]
    NoWholeArm,
    /// There is nothing more to learn.
    #[error("the strategy has finished ({finish}); start a new trial to learn further")]
    Finished {
        /// How it ended.
        finish: super::Finish,
    },
}
