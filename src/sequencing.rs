//! The order of a trial: the six steps of table 3.1, the passes of the garment along each arm, and what ends them.
//!
//! Pure bookkeeping: it says where the grippers should go next and what was reached, and never how a gripper gets there,
//! what force is or whether it may move at all.

pub mod steps;
pub mod trial;

pub use steps::{Place, Step};
pub use trial::{Next, Order, PersonPlan, Stage, Trial, TrialEvent, TrialSettings};
