//! Pieces that several screens are made of: text that cannot leave its place, dots, strips of force, bars.

pub(super) mod dots;
pub(super) mod envelope;
pub(super) mod strip;
pub(super) mod text;
