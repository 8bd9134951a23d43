//! Jobs and stages of a build.

use std::path::PathBuf;

use super::digest::FileDigest;

/// One tile of one stage.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Job {
    /// The stage, from 0: it reads only results of the previous stage.
    pub stage: usize,
    /// The tile's row, from the north.
    pub row: usize,
    /// The tile's column, from the west.
    pub column: usize,
}

/// Jobs that may run in any order.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Stage {
    /// Number of rows of tiles.
    pub rows: usize,
    /// Number of tiles per row.
    pub columns: usize,
    /// Samples per tile, the unit of progress.
    pub samples: usize,
}

impl Stage {
    /// Number of jobs.
    pub fn len(&self) -> usize {
        self.rows * self.columns
    }
}

/// A file that a job writes.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum JobFile {
    /// Part of the result: a path within the result.
    Result(PathBuf),
    /// A temporary file: a path within the scratch folder.
    Scratch(PathBuf),
}

/// The output of a job.
#[derive(Debug, Default)]
pub struct Made {
    /// The content of each file, in the order of [`places`](super::target::BuildTarget::places).
    pub files: Vec<Vec<u8>>,
    /// Minimum and maximum finite sample of each layer, if they are needed later.
    pub ranges: Vec<[f32; 2]>,
}

/// The journal's record of a completed job.
#[derive(Debug, Clone, PartialEq)]
pub struct Record {
    /// The digests of the files.
    pub digests: Vec<FileDigest>,
    /// As in [`Made`].
    pub ranges: Vec<[f32; 2]>,
}
