//! From a depth image to a person's joints: camera model, foreground, body parts by a decision forest, joints by votes.
//!
//! Everything here is arithmetic on images that others bring: no camera, file, clock or thread (training uses all cores
//! through rayon). A joint that is not seen stays unknown; no place is carried over or made up here.

pub mod camera;
pub mod depth;
pub mod file;
pub mod foreground;
pub mod generic;
pub mod joints;
pub mod labels;
mod neck;
pub mod part;
pub mod probe;
pub mod training;
pub mod tree;
pub mod walk;

pub use camera::{CameraError, Intrinsics};
pub use depth::{DepthError, DepthImage, RawImage};
pub use file::FileError;
pub use foreground::{Facing, View, ViewError};
pub use joints::{CameraJoints, PoseFinder};
pub use part::Part;
pub use tree::Forest;
