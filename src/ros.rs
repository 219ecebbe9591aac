//! The ROS 1 adapter: the only user of rosrust.
//!
//! It decodes the robot's messages into the core's inputs and sends the core's effects back, and guards against what the
//! transport does badly (a master that hangs or restarts, publishers that go silent, callbacks that panic). It decides
//! nothing, blocks no thread of the core and prints nothing.

pub mod checked;
pub mod decode;
mod definitions;
pub mod ears;
mod encode;
pub mod environment;
pub mod error;
mod frames;
pub mod graph;
mod greeting;
pub mod link;
pub mod master;
pub mod message;
pub mod monitor;
pub mod moveit;
pub mod node;
mod service_call;
pub mod simulation;
mod subscription;
mod watch;
mod watcher;
pub mod xmlrpc;

pub use decode::DepthFrame;
pub use error::RosError;
pub use frames::FrameError;
pub use link::{Commander, DepthWatcher, LinkSettings, RobotLink, RosLimb, Showing, StopPublisher};
pub use monitor::TopicReport;
pub use moveit::{MoveItError, MoveItPlanner};
pub use node::{Node, leave};
pub use service_call::ServiceError;
pub use simulation::SimNode;
pub use subscription::Sink;
pub use watcher::WatchLink;
