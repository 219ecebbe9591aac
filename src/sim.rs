//! The simulated world: a Baxter, a seated person, a garment between them, and what the robot senses of it.
//!
//! [`World`] is stepped in virtual time: no socket, no clock, and everything random comes from a seed, so the same setup and
//! the same commands give the same bytes. `valet sim` carries it over ROS in real time; `valet demo --headless`, cohorts and
//! fault tests step it as fast as they can. Nothing here knows the node: it sees joint commands and the switch, as Baxter does.

pub mod baxter;
pub mod camera;
pub mod faults;
pub mod garment;
pub mod person;
mod random;
pub mod rig;
pub mod world;
pub mod wrench;

pub use world::{SimError, SimOutput, World, WorldSetup};
