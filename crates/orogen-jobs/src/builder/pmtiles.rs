//! PMTiles: the tiles of an XYZ tree in one file, with heights rounded by the zoom so that it stays small.
//!
//! Tiles are temporary files until all exist, then one file is assembled from them.

use std::io;
use std::path::PathBuf;

use serde_json::{Map, json};

use super::digest::FileDigest;
use super::identity::Identity;
use super::job::{Job, JobFile, Made, Stage};
use super::output_store::OutputStore;
use super::samples;
use super::target::{BuildTarget, Disk};
use super::xyz::Tree;
use orogen_engine::world::World;
use orogen_grid::error::Result;
use orogen_grid::grid::{Grid, Window};
use orogen_io::format::encoding::Encoding;
use orogen_io::format::pmtiles::{Archive, ArchiveTile, TileKind};
use orogen_io::samples::rounded_to;

/// The step of heights is at most this share of a pixel.
const SHARE: f64 = 1.0 / 128.0;

/// Maximum step, in metres.
const MAX_STEP: f64 = 8.0;

/// The file.
pub struct Pmtiles {
    tree: Tree,
    encoding: Encoding,
}

impl Pmtiles {
    /// Creates the target of a build.
    ///
    /// # Errors
    /// The errors of [`Tree::new`].
    pub fn new(world: &World, identity: &Identity, encoding: Encoding) -> Result<Pmtiles> {
        Ok(Pmtiles { tree: Tree::new(world, identity, encoding)?, encoding })
    }

    fn tile(&self, job: Job) -> JobFile {
        let (zoom, column, row) = self.tree.address(job);
        JobFile::Scratch(format!("tiles/{zoom}/{column}/{row}").into())
    }

    /// The step of the heights of a stage, in metres: that of the encoding, times a power of two.
    fn step(&self, stage: usize) -> f64 {
        let most = (self.tree.cell() * f64::from(1u32 << stage.min(31)) * SHARE).min(MAX_STEP);
        let mut step = self.encoding.step();
        while 2.0 * step <= most {
            step *= 2.0;
        }
        step
    }
}

impl BuildTarget for Pmtiles {
    fn stages(&self) -> Vec<Stage> {
        self.tree.stages()
    }

    fn window(&self, row: usize, column: usize) -> Window {
        self.tree.window(row, column)
    }

    fn places(&self, job: Job) -> Vec<JobFile> {
        let mut places = self.tree.places(job);
        places[0] = self.tile(job);
        places
    }

    fn reads(&self, job: Job) -> Vec<Job> {
        self.tree.reads(job)
    }

    fn make(&self, job: Job, grids: &[Grid], store: &OutputStore) -> Result<Made> {
        // Lower zooms are means of the samples before they are rounded.
        self.tree.made(job, grids, store, |samples| rounded_to(samples, self.step(job.stage)))
    }

    fn assembles(&self) -> bool {
        true
    }

    fn finish(&self, store: &OutputStore) -> Result<Vec<(PathBuf, FileDigest)>> {
        let jobs: Vec<Job> = (self.stages().iter().enumerate())
            .flat_map(|(stage, Stage { rows, columns, .. })| {
                let columns = *columns;
                (0..*rows).flat_map(move |row| (0..columns).map(move |column| Job { stage, row, column }))
            })
            .collect();
        let digests: Vec<FileDigest> = (jobs.iter())
            .map(|job| store.record(*job).and_then(|record| record.digests.into_iter().next()))
            .map(|digest| digest.unwrap_or_else(|| FileDigest::of(&[])))
            .collect();
        let tiles: Vec<ArchiveTile> = (jobs.iter().zip(&digests))
            .map(|(job, digest)| {
                let (zoom, column, row) = self.tree.address(*job);
                ([u64::from(zoom), column, row], digest.length as u32, digest.sha256.as_str())
            })
            .collect();
        let mut about = self.tree.about();
        let highest = self.stages().len() - 1;
        let [lowest, zoom] = [highest, 0].map(|stage| self.tree.zoom(stage));
        let steps: Map<String, serde_json::Value> =
            (0..=highest).map(|stage| (self.tree.zoom(stage).to_string(), json!(self.step(stage)))).collect();
        about["format"] = json!("png");
        about["height_steps"] = json!(steps);
        let archive = Archive {
            kind: TileKind::Png,
            zooms: [lowest, zoom],
            bounds: self.tree.degrees(),
            shown: lowest,
            metadata: about.to_string(),
        };
        let file = store.assemble(|out| {
            archive.write(out, &tiles, |k, bytes| {
                let place = self.tile(jobs[k]);
                store.read(&place, bytes)?;
                match bytes.len() as u64 == digests[k].length && !bytes.is_empty() {
                    true => Ok(()),
                    false => Err(io::Error::from(samples::changed(store, &place))),
                }
            })
        })?;
        Ok(vec![(PathBuf::new(), file)])
    }

    fn scratch_memory(&self) -> u64 {
        self.tree.scratch_memory()
    }

    fn disk(&self) -> Disk {
        let Disk { result, scratch } = self.tree.disk();
        Disk { result, scratch: scratch + result }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::builder::spec::{BuildSpec, Form};
    use orogen_engine::presets;

    #[test]
    fn steps_are_powers_of_two_that_follow_the_pixel() {
        let world = World::open(presets::find("hills").unwrap().recipe().unwrap()).unwrap();
        let form = Form::Pmtiles(Encoding::Terrarium);
        let spec = BuildSpec::new(form, Window::new(300, 200, 9.554_628_535_647_032));
        let target = Pmtiles::new(&world, &Identity::of(&world, &spec, 256).unwrap(), Encoding::Terrarium).unwrap();
        // Pixels of 9.55 m at zoom 14: at most 1 / 128 of them is 1/16 m.
        assert_eq!([0, 1, 2].map(|stage| target.step(stage)), [0.0625, 0.125, 0.25]);
        assert_eq!([7, 14].map(|stage| target.step(stage)), [8.0, 8.0]);
    }
}
