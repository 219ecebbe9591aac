//! A forest as bytes: versioned, self-describing, and checked whole before anything of it is used.
//!
//! Layout, little endian: magic, version, length of the header, header (JSON), for each tree its nodes and leaves, and the
//! SHA-256 of everything before. Children must follow level by level, each node with exactly one parent: so there are no cycles.

use super::neck::MAPS;
use super::part::CLASSES;
use super::probe::{BACKGROUND, PLANES};
use super::tree::{Forest, LEAF, Leaf, Node, Tree, VOTED, Vote};
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};
use thiserror::Error;

const MAGIC: &[u8; 8] = b"valetRDF";
/// The version of the layout and of the conventions in [`super::part`] and [`super::probe`].
const VERSION: u32 = 2;
/// The version before, which knew depth alone: thresholds of 32 bits, no planes.
const DEPTH_ALONE: u32 = 1;
const NODE_BYTES: usize = 16;
const LEAF_BYTES: usize = CLASSES + VOTED * 8;
const DIGEST_BYTES: usize = 32;
/// More trees or nodes than this are no forest of ours.
const MOST_TREES: usize = 64;
const MOST_NODES: usize = 1 << 22;

/// Why a file is not a forest that can be used.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum FileError {
    /// Something else.
    #[error("not a forest of valet: make one with `valet train`")]
    Magic,
    /// Another version.
    #[error(
        "a forest of version {found}, but this valet reads versions {DEPTH_ALONE} and {VERSION}: train it again with this valet"
    )]
    Version {
        /// The version in the file.
        found: u32,
    },
    /// Bytes are missing or too many.
    #[error("the forest is cut short or has bytes too many (at byte {at}): copy the file again")]
    Length {
        /// Where.
        at: usize,
    },
    /// A byte has changed.
    #[error("the forest's checksum is wrong: the file is damaged, copy it again")]
    Checksum,
    /// The header is not what it should be.
    #[error("the forest's header is unusable: {0}; train it again")]
    Header(String),
    /// Trained under another convention.
    #[error(
        "the forest was trained with {what} {found}, but this valet uses {used}: it would label nonsense; train it again"
    )]
    Convention {
        /// What differs.
        what: &'static str,
        /// In the file.
        found: String,
        /// Here.
        used: String,
    },
    /// A node leads nowhere or back.
    #[error("the forest's tree {tree} is broken at node {node}: train it again")]
    Structure {
        /// Which tree, from 0.
        tree: usize,
        /// Which node, from 0.
        node: usize,
    },
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Header {
    description: String,
    background_millimetres: u16,
    mirrored: bool,
    focal_pixels: f64,
    classes: usize,
    joints: usize,
    /// What the planes after depth show; version 1 had none.
    #[serde(default)]
    maps: Vec<String>,
    /// Nodes and leaves of each tree.
    trees: Vec<(usize, usize)>,
}

impl Forest {
    /// A forest of trees trained for a focal length.
    #[must_use]
    pub const fn new(focal: f64, description: String, trees: Vec<Tree>) -> Self {
        Self { focal, description, trees }
    }

    /// Adds a tree.
    pub fn push(&mut self, tree: Tree) {
        self.trees.push(tree);
    }

    /// The forest as a file's bytes.
    ///
    /// # Errors
    /// [`FileError::Header`] where the header cannot be written.
    pub fn to_bytes(&self) -> Result<Vec<u8>, FileError> {
        let header = Header {
            description: self.description.clone(),
            background_millimetres: BACKGROUND,
            mirrored: false,
            focal_pixels: self.focal,
            classes: CLASSES,
            joints: VOTED,
            maps: MAPS.map(String::from).to_vec(),
            trees: self.trees.iter().map(|tree| (tree.nodes.len(), tree.leaves.len())).collect(),
        };
        let header = serde_json::to_vec(&header).map_err(|error| FileError::Header(error.to_string()))?;
        let mut bytes = MAGIC.to_vec();
        bytes.extend(VERSION.to_le_bytes());
        bytes.extend(u32::try_from(header.len()).unwrap_or(u32::MAX).to_le_bytes());
        bytes.extend(header);
        for tree in &self.trees {
            tree.nodes.iter().for_each(|node| write_node(node, &mut bytes));
            tree.leaves.iter().for_each(|leaf| write_leaf(leaf, &mut bytes));
        }
        let digest = Sha256::digest(&bytes);
        bytes.extend(digest);
        Ok(bytes)
    }

    /// Reads a forest and checks everything.
    ///
    /// # Errors
    /// Where the file is anything but a whole forest of this version and these conventions.
    pub fn from_bytes(bytes: &[u8]) -> Result<Self, FileError> {
        let mut reader = Reader { bytes, at: 0 };
        if reader.take(MAGIC.len()).ok() != Some(MAGIC.as_slice()) {
            return Err(FileError::Magic);
        }
        let found = reader.word()?;
        if found != VERSION && found != DEPTH_ALONE {
            return Err(FileError::Version { found });
        }
        let length = reader.word()? as usize;
        let header: Header =
            serde_json::from_slice(reader.take(length)?).map_err(|error| FileError::Header(error.to_string()))?;
        header.check(found)?;
        let body: usize = header.trees.iter().map(|(nodes, leaves)| nodes * NODE_BYTES + leaves * LEAF_BYTES).sum();
        if reader.at + body + DIGEST_BYTES != bytes.len() {
            return Err(FileError::Length { at: bytes.len() });
        }
        let (content, digest) = bytes.split_at(reader.at + body);
        if Sha256::digest(content).as_slice() != digest {
            return Err(FileError::Checksum);
        }
        let mut trees = Vec::with_capacity(header.trees.len());
        for (index, (nodes, leaves)) in header.trees.iter().enumerate() {
            trees.push(read_tree(&mut reader, (found, index), *nodes, *leaves)?);
        }
        Ok(Self { focal: header.focal_pixels, description: header.description, trees })
    }
}

impl Header {
    fn check(&self, version: u32) -> Result<(), FileError> {
        let same = |what, found: String, used: String| {
            if found == used { Ok(()) } else { Err(FileError::Convention { what, found, used }) }
        };
        same("a background of millimetres", self.background_millimetres.to_string(), BACKGROUND.to_string())?;
        same("mirrored images", self.mirrored.to_string(), false.to_string())?;
        same("classes", self.classes.to_string(), CLASSES.to_string())?;
        if version == VERSION {
            same("maps of the neck", self.maps.join(", "), MAPS.join(", "))?;
        }
        same("joints", self.joints.to_string(), VOTED.to_string())?;
        if !(50.0..5000.0).contains(&self.focal_pixels) {
            return Err(FileError::Header(format!("focal length {} pixels", self.focal_pixels)));
        }
        let fine = |(nodes, leaves): &(usize, usize)| (1..=MOST_NODES).contains(nodes) && *nodes == 2 * leaves - 1;
        if !(1..=MOST_TREES).contains(&self.trees.len()) || !self.trees.iter().all(|tree| tree.1 > 0 && fine(tree)) {
            return Err(FileError::Header(format!("trees of {:?} nodes and leaves", self.trees)));
        }
        Ok(())
    }
}

fn write_node(node: &Node, bytes: &mut Vec<u8>) {
    node.offsets.iter().for_each(|offset| bytes.extend(offset.to_le_bytes()));
    bytes.extend(node.threshold.to_le_bytes());
    bytes.extend(node.planes);
    bytes.extend(node.next.to_le_bytes());
}

fn write_leaf(leaf: &Leaf, bytes: &mut Vec<u8>) {
    bytes.extend(leaf.shares);
    for vote in leaf.votes {
        vote.offset.iter().for_each(|value| bytes.extend(value.to_le_bytes()));
        bytes.extend(vote.deviation.to_le_bytes());
    }
}

fn read_tree(
    reader: &mut Reader<'_>,
    (version, tree): (u32, usize),
    nodes: usize,
    leaves: usize,
) -> Result<Tree, FileError> {
    let mut next_child = 1_usize;
    let mut next_leaf = 0_u32;
    let mut read = Tree { nodes: Vec::with_capacity(nodes), leaves: Vec::with_capacity(leaves) };
    for node in 0..nodes {
        let offsets = [reader.short()?, reader.short()?, reader.short()?, reader.short()?];
        let threshold = reader.short()?;
        let mut planes: [u8; 2] = reader.array()?;
        if version == DEPTH_ALONE {
            // The upper half of the threshold, which is its sign: responses are differences of at most 10,000.
            let sign = if threshold < 0 { u8::MAX } else { 0 };
            planes.iter_mut().for_each(|plane| *plane ^= sign);
        }
        let known = planes.iter().all(|plane| usize::from(*plane) < if version == VERSION { PLANES } else { 1 });
        let next = reader.word()?;
        // Children and leaves are numbered in the order in which they are met: each has one parent, which comes before it.
        let sound = if next & LEAF == 0 {
            next_child += 2;
            next as usize == next_child - 2 && next as usize > node && next_child <= nodes
        } else {
            next_leaf += 1;
            next & !LEAF == next_leaf - 1
        };
        if !sound || !known {
            return Err(FileError::Structure { tree, node });
        }
        read.nodes.push(Node { offsets, threshold, planes, next });
    }
    if next_child != nodes || next_leaf as usize != leaves {
        return Err(FileError::Structure { tree, node: nodes });
    }
    for _ in 0..leaves {
        read.leaves.push(reader.leaf()?);
    }
    Ok(read)
}

struct Reader<'a> {
    bytes: &'a [u8],
    at: usize,
}

impl<'a> Reader<'a> {
    fn take(&mut self, count: usize) -> Result<&'a [u8], FileError> {
        let end = self.at.checked_add(count).ok_or(FileError::Length { at: self.at })?;
        let taken = self.bytes.get(self.at..end).ok_or(FileError::Length { at: self.bytes.len() })?;
        self.at = end;
        Ok(taken)
    }

    fn array<const COUNT: usize>(&mut self) -> Result<[u8; COUNT], FileError> {
        let at = self.at;
        self.take(COUNT)?.try_into().map_err(|_| FileError::Length { at })
    }

    fn word(&mut self) -> Result<u32, FileError> {
        self.array().map(u32::from_le_bytes)
    }

    fn short(&mut self) -> Result<i16, FileError> {
        self.array().map(i16::from_le_bytes)
    }

    fn leaf(&mut self) -> Result<Leaf, FileError> {
        let shares = self.array()?;
        let mut votes = [Vote { offset: [0; 3], deviation: 0 }; VOTED];
        for vote in &mut votes {
            let offset = [self.short()?, self.short()?, self.short()?];
            *vote = Vote { offset, deviation: u16::from_le_bytes(self.array()?) };
        }
        Ok(Leaf { shares, votes })
    }
}

#[cfg(test)]
mod tests;
