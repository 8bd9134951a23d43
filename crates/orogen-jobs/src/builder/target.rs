//! The trait of result forms.

use std::collections::BTreeSet;
use std::path::PathBuf;

use super::digest::FileDigest;
use super::job::{Job, JobFile, Made, Stage};
use super::output_store::OutputStore;
use orogen_grid::error::Result;
use orogen_grid::grid::{Grid, Window};

/// A form of result: how it is split into jobs, and how each job is done.
pub trait BuildTarget: Sync {
    /// The stages, in order. The jobs of the first stage read the world.
    fn stages(&self) -> Vec<Stage>;

    /// The window of a job of the first stage, at the cell of the specification.
    fn window(&self, row: usize, column: usize) -> Window;

    /// The files that a job writes.
    fn places(&self, job: Job) -> Vec<JobFile>;

    /// The jobs of the previous stage whose files a job reads.
    fn reads(&self, job: Job) -> Vec<Job>;

    /// Runs a job. In the first stage `grids` has the samples of its window, one grid per layer; later it is empty.
    fn make(&self, job: Job, grids: &[Grid], store: &OutputStore) -> Result<Made>;

    /// Whether the result is one file, assembled by [`BuildTarget::finish`] from all files of the store.
    fn assembles(&self) -> bool {
        false
    }

    /// Writes the files that belong to no tile, after all tiles; returns them by their paths within the result.
    fn finish(&self, store: &OutputStore) -> Result<Vec<(PathBuf, FileDigest)>>;

    /// The files that [`BuildTarget::finish`] writes, by their paths within the result; empty if the result is a single
    /// file.
    fn extras(&self) -> Vec<PathBuf> {
        Vec::new()
    }

    /// Memory of a job in addition to its samples, in bytes.
    fn scratch_memory(&self) -> u64;

    /// Maximum disk space of the result and of temporary files.
    fn disk(&self) -> Disk;
}

/// All files of a result that is a folder, by their paths within it.
pub fn paths(target: &dyn BuildTarget) -> BTreeSet<PathBuf> {
    let mut paths: BTreeSet<PathBuf> = target.extras().into_iter().collect();
    for (stage, Stage { rows, columns, .. }) in target.stages().into_iter().enumerate() {
        for (row, column) in (0..rows).flat_map(|row| (0..columns).map(move |column| (row, column))) {
            let places = target.places(Job { stage, row, column }).into_iter();
            paths.extend(places.filter_map(|place| match place {
                JobFile::Result(path) => Some(path),
                JobFile::Scratch(_) => None,
            }));
        }
    }
    paths
}

/// Maximum disk space, in bytes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Disk {
    /// Of the result.
    pub result: u64,
    /// Of temporary files, until completion.
    pub scratch: u64,
}
