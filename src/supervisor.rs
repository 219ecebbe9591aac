//! The door into the core: what may reach the supervisor.

mod input;

pub use input::{EndpointSample, Input, JointSample, LinkEvent};
