//! Way-points and how they are moved: straight lines, the optimisers of thesis section 4.3, the choice of the next goal
//! of algorithm 3, and the criteria by which paths are judged (reachability and comfort). Pure arithmetic: never asks a
//! robot for anything.

pub mod blend;
pub mod criteria;
pub mod line;
pub mod next_goal;
pub mod optimiser;
mod warm_start;

pub use criteria::Reach;
pub use next_goal::GoalSearch;
pub use optimiser::{Method, Optimiser, OptimiserSettings, OptimiserState, SecondMoment};
pub use warm_start::{ArmJoints, ArmRelative, carried_over};
