//! What a build is cut into.

use std::path::PathBuf;

use super::digest::FileDigest;

/// One tile of one stage.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Job {
    /// The stage, from 0: it reads only what the stage before it made.
    pub stage: usize,
    /// The tile's row, from the north.
    pub row: usize,
    /// The tile's column, from the west.
    pub column: usize,
}

/// Jobs that may be done in any order.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Stage {
    /// Rows of tiles.
    pub rows: usize,
    /// Tiles a row.
    pub columns: usize,
    /// Samples that a tile has: what progress is counted in.
    pub samples: usize,
}

impl Stage {
    /// How many jobs it has.
    pub fn len(&self) -> usize {
        self.rows * self.columns
    }
}

/// A file that a job makes.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum JobFile {
    /// Part of the result: a path within it.
    Result(PathBuf),
    /// Needed on the way, and gone in the end: a path within the scratch folder.
    Scratch(PathBuf),
}

/// What a job made.
#[derive(Debug, Default)]
pub struct Made {
    /// The bytes of each of its files, in the order of its places.
    pub files: Vec<Vec<u8>>,
    /// The lowest and highest finite sample of each layer, where somebody needs them later.
    pub ranges: Vec<[f32; 2]>,
}

/// What the journal knows of a job that was done.
#[derive(Debug, Clone, PartialEq)]
pub struct Record {
    /// Its files.
    pub digests: Vec<FileDigest>,
    /// As in [`Made`].
    pub ranges: Vec<[f32; 2]>,
}
