//! What each kind of result has to know.

use std::collections::BTreeSet;
use std::path::PathBuf;

use super::digest::FileDigest;
use super::job::{Job, JobFile, Made, Stage};
use super::output_store::OutputStore;
use orogen_grid::error::Result;
use orogen_grid::grid::{Grid, Window};

/// A kind of result: how it is cut into jobs, and what each makes.
pub trait BuildTarget: Sync {
    /// The stages, in order. The first one's jobs read the world.
    fn stages(&self) -> Vec<Stage>;

    /// The samples that a job of the first stage gets, at the cell of the order.
    fn window(&self, row: usize, column: usize) -> Window;

    /// The files that a job makes.
    fn places(&self, job: Job) -> Vec<JobFile>;

    /// The jobs, all of the stage before, whose files a job reads.
    fn reads(&self, job: Job) -> Vec<Job>;

    /// Does a job: `grids` are its window's samples, one grid a layer, in the first stage, and none later.
    fn make(&self, job: Job, grids: &[Grid], store: &OutputStore) -> Result<Made>;

    /// Whether the result is one file, assembled by [`BuildTarget::finish`] from all files of the store.
    fn assembles(&self) -> bool {
        false
    }

    /// Writes what belongs to no tile, once all tiles are there; returns the files, by their paths within the result.
    fn finish(&self, store: &OutputStore) -> Result<Vec<(PathBuf, FileDigest)>>;

    /// The files that [`BuildTarget::finish`] writes, by their paths within the result; none if the result is one file.
    fn extras(&self) -> Vec<PathBuf> {
        Vec::new()
    }

    /// Bytes that a job needs beside its samples.
    fn scratch_memory(&self) -> u64;

    /// The most bytes on disk: those of the result, and those needed on the way.
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

/// Bytes on disk, at most.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Disk {
    /// Of the result.
    pub result: u64,
    /// Beside it, until it is finished.
    pub scratch: u64,
}
