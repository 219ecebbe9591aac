//! The forest that valet brings along: trained on simulated people of many sizes, shapes, clothes and postures, so that a new
//! person needs neither coloured clothes nor training.
//!
//! `docs/results.md` says with which commands its trees were trained, and how well it does.

use super::file::FileError;
use super::tree::Forest;

/// The file, part of the program.
const BYTES: &[u8] = include_bytes!("../../assets/generic.forest");

/// The forest that valet brings along.
///
/// # Errors
/// Where the file that the program was built with is not a forest of this version.
pub fn forest() -> Result<Forest, FileError> {
    Forest::from_bytes(BYTES)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_is_whole_has_three_trees_and_is_not_too_large() {
        assert_eq!(forest().unwrap().trees().len(), 3);
        assert!(BYTES.len() <= 20 << 20);
    }
}
