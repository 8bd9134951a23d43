//! A Zarr group: one array per layer, one chunk per tile.

use std::path::{Path, PathBuf};

use super::digest::FileDigest;
use super::identity::Identity;
use super::job::{Job, JobFile, Made, Stage};
use super::output_store::OutputStore;
use super::target::{BuildTarget, Disk};
use super::zarr_layout::ZarrLayout;
use orogen_grid::error::{Error, Result};
use orogen_grid::grid::{Grid, Window};

/// The group.
pub struct Zarr {
    layout: ZarrLayout,
}

impl Zarr {
    /// Creates the target of a build.
    ///
    /// # Errors
    /// If a chunk cannot have this side.
    pub fn new(identity: &Identity, about: &str) -> Result<Zarr> {
        let layout = ZarrLayout {
            about: about.to_string(),
            recipe: identity.recipe.clone(),
            layers: identity.layers.iter().cloned().zip(identity.units.iter().cloned()).collect(),
            window: identity.window,
            tile: identity.tile,
            map: identity.map.clone(),
        };
        layout.check()?;
        Ok(Zarr { layout })
    }

    fn stage(&self) -> Stage {
        let [columns, rows] = self.layout.chunks();
        Stage { rows, columns, samples: self.layout.tile * self.layout.tile * self.layout.layers.len() }
    }
}

/// The path of a chunk of coordinates.
fn coordinate_path(axis: usize, chunk: usize) -> PathBuf {
    Path::new(ZarrLayout::axis_name(axis)).join(format!("c/{chunk}"))
}

impl BuildTarget for Zarr {
    fn stages(&self) -> Vec<Stage> {
        vec![self.stage()]
    }

    fn window(&self, row: usize, column: usize) -> Window {
        self.layout.chunk_window(row, column)
    }

    fn places(&self, job: Job) -> Vec<JobFile> {
        let chunk =
            |(layer, _): &(String, String)| JobFile::Result(format!("{layer}/c/{}/{}", job.row, job.column).into());
        self.layout.layers.iter().map(chunk).collect()
    }

    fn reads(&self, _: Job) -> Vec<Job> {
        Vec::new()
    }

    fn make(&self, _: Job, grids: &[Grid], _: &OutputStore) -> Result<Made> {
        let files = grids.iter().map(|grid| self.layout.chunk(grid));
        Ok(Made { files: files.collect::<Result<_>>()?, ranges: Vec::new() })
    }

    fn finish(&self, store: &OutputStore) -> Result<Vec<(PathBuf, FileDigest)>> {
        let mut written = Vec::new();
        let mut put = |path: PathBuf, bytes: &[u8]| {
            let digest = store.file(&JobFile::Result(path.clone()), bytes)?;
            written.push((path, digest));
            Ok::<(), Error>(())
        };
        for axis in [0, 1] {
            for chunk in 0..self.layout.coordinate_chunks(axis) {
                put(coordinate_path(axis, chunk), &self.layout.coordinate_chunk(axis, chunk)?)?;
            }
        }
        for (name, array) in self.layout.arrays() {
            put(Path::new(&name).join("zarr.json"), format!("{array:#}\n").as_bytes())?;
        }
        // Written last: without this file there is no group, so a partial group does not exist.
        put("zarr.json".into(), format!("{:#}\n", self.layout.group()).as_bytes())?;
        Ok(written)
    }

    fn extras(&self) -> Vec<PathBuf> {
        let mut paths = vec![PathBuf::from("zarr.json")];
        for axis in [0, 1] {
            paths.extend((0..self.layout.coordinate_chunks(axis)).map(|chunk| coordinate_path(axis, chunk)));
            paths.push(Path::new(ZarrLayout::axis_name(axis)).join("zarr.json"));
        }
        paths.extend(self.layout.layers.iter().map(|(layer, _)| Path::new(layer).join("zarr.json")));
        paths
    }

    fn scratch_memory(&self) -> u64 {
        self.layout.scratch_memory()
    }

    fn disk(&self) -> Disk {
        let stage = self.stage();
        // A chunk takes at most its uncompressed size plus a frame.
        let (samples, chunks) = (stage.samples as u64, self.layout.layers.len() as u64);
        let sides = self.layout.coordinate_bytes();
        Disk { result: stage.len() as u64 * (4 * samples + 64 * chunks) + sides + (1 << 16), scratch: 0 }
    }
}
