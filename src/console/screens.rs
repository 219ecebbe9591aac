//! The screens: each is a function of the scene, drawn into the middle of the frame.

pub(super) mod compact;
pub(super) mod force;
mod front;
pub(super) mod health;
pub(super) mod log;
pub(super) mod path;
pub(super) mod strategies;
mod timeline;
pub(super) mod trial;
