//! The border to the robot: ports that adapters implement, and the guards that stand before them and refuse.
//!
//! Ports carry plain values: which topic or simulator is behind them, nobody here knows. Guards never mend a command: what breaks a
//! limit does not leave the node, and the refusal says what, which value and which range.

mod breach;
pub mod dummy;
mod guard;
mod handle;
mod pair;
mod planner;
mod ports;

pub use breach::{Limit, LimitBreach};
pub use guard::{GuardSettings, GuardedLimb};
pub use handle::{MotionHandle, Progress};
pub use pair::GuardedPair;
pub use planner::{BuiltInPlanner, PlanRequest, Planner};
pub use ports::{BodyPoseSource, CommandError, Limb, PortError, RobotSwitch};
