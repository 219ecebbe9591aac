//! The arms: where the grippers are, how to get them somewhere, and what must not touch.
//!
//! Works in the robot's `base` frame with metres and radians. Everything here is pure: a motion is planned and checked
//! before it starts, sampled by the time that has passed, and stopped along the same path. Nothing is sent to a robot.

mod chain;
mod check;
mod collision;
mod cone;
mod damped;
mod description;
mod difference;
mod inverse;
mod limits;
mod line;
mod model;
mod motion;
mod path;
mod plan;
mod posture;
mod refusal;
mod scene;
mod seeds;
mod timing;
mod ways;

pub use chain::JOINTS;
pub use collision::Proximity;
pub use cone::OrientationTolerance;
pub use description::JOINT_SUFFIXES;
pub use difference::Difference;
pub use inverse::{InverseError, TOLERANCE};
pub use limits::{JOINT_TOLERANCE, JointLimits, MotionLimits, Workspace};
pub use model::{ArmModel, BAXTER_URDF, ModelError, Placement, RobotModel, Tool};
pub use motion::{PairMotion, Setpoint};
pub use plan::{Target, plan_pair, plan_postures};
pub use posture::{Leg, dressing_orientation, dressing_postures, start_postures, start_postures_for, waiting_place};
pub use refusal::MotionRefusal;
pub use scene::{BodyBuild, BodyPart, Capsule, Scene};
pub use timing::TimingError;
pub use ways::{Ways, plan_through};

/// Positions (radians), speeds or accelerations of an arm's joints in the order s0, s1, e0, e1, w0, w1, w2.
pub type JointVector = nalgebra::SVector<f64, JOINTS>;
