//! The simulated robot: two arms that follow joint commands, and the switch with its latch.
//!
//! Position mode as on Baxter: a command holds for 0.2 s, then the arm stays where it is; a disabled robot follows
//! nothing. It never plans and never refuses a goal: that is the node's task.

mod arm;
mod switch;

pub(super) use arm::SimulatedLimb;
pub use arm::{ArmDynamics, UNTUCKED_LEFT, UNTUCKED_RIGHT};
pub use switch::Switch;
