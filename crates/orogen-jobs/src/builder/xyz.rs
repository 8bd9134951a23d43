//! An XYZ tree of PNG tiles with encoded heights ([`Encoding`]), with TileJSON.
//!
//! **Position.** Web Mercator. Pixels are areas, and samples are at their centers. Tiles are those of the whole map, so
//! that windows of one world fit together; the part of a tile outside the window repeats its edge.
//!
//! - A world in EPSG:3857 is at its real position, in the tiles of all web maps. Pixels between its samples are
//!   interpolated, also from samples beyond the window where the world has any, so that adjacent windows together have
//!   the same pixels as one large window.
//! - Any other world has its origin at 0 degrees east and north. Near the equator Mercator is true to scale: one metre
//!   of the world is one metre of the map if the cell equals a pixel of some zoom (see [`tile_grid::cell_near`]);
//!   otherwise the map is scaled by a factor that TileJSON states.
//!
//! **Lower zooms.** Each pixel is the mean of the four pixels below it in full precision, rounded once when it is
//! written.

use std::path::PathBuf;

use serde_json::json;

use super::digest::FileDigest;
use super::identity::Identity;
use super::job::{Job, JobFile, Made, Stage};
use super::output_store::OutputStore;
use super::samples;
use super::target::{BuildTarget, Disk};
use super::tile_grid::{self, TileGrid};
use orogen_engine::world::{HEIGHT, World};
use orogen_grid::error::{Error, ErrorKind, Result};
use orogen_grid::grid::{Grid, Window};
use orogen_grid::resample::LayerKind;
use orogen_io::format::encoding::Encoding;
use orogen_io::format::png::{self, Picture, Pixel};
use orogen_io::samples::{halved, to_bytes};

/// The TileJSON file.
const TILEJSON: &str = "tiles.json";

/// The tree. Each zoom is a stage, from the highest zoom down.
pub struct Tree {
    encoding: Encoding,
    identity: Identity,
    about: String,
    /// The tiles of the highest zoom.
    grid: TileGrid,
    /// How samples are interpolated.
    kind: LayerKind,
    stages: Vec<Stage>,
}

impl Tree {
    /// Creates the target of a build.
    ///
    /// # Errors
    /// If tiles do not have 256 or 512 pixels, or the window is outside the map.
    pub fn new(world: &World, identity: &Identity, encoding: Encoding) -> Result<Tree> {
        let refuse = |message: String| Err(Error::new(ErrorKind::Request, message));
        let (window, tile) = (identity.window, identity.tile);
        if !matches!(tile, 256 | 512) {
            return refuse(format!("the tiles of an XYZ tree must have 256 or 512 samples per side, not {tile}"));
        }
        let layer = identity.layers.first().map_or(HEIGHT, String::as_str);
        let mut tree = Tree {
            encoding,
            identity: identity.clone(),
            about: world.recipe().about.clone(),
            grid: TileGrid::over(world, window, tile)?,
            kind: world.kind(layer)?,
            stages: Vec::new(),
        };
        for stage in 0..=tree.grid.zoom() as usize {
            let [[left, right], [top, bottom]] = tree.span(stage);
            let (rows, columns) = ((bottom - top + 1) as usize, (right - left + 1) as usize);
            tree.stages.push(Stage { rows, columns, samples: tile * tile });
            if rows == 1 && columns == 1 {
                break;
            }
        }
        Ok(tree)
    }

    fn tile(&self) -> usize {
        self.identity.tile
    }

    /// The first and last tile of a stage, across and down.
    fn span(&self, stage: usize) -> [[u64; 2]; 2] {
        self.grid.tiles().map(|side| side.map(|tile| tile >> stage))
    }

    /// The address of a job's tile on the whole map: zoom, column, row.
    pub(super) fn address(&self, job: Job) -> (u32, u64, u64) {
        let [[left, _], [top, _]] = self.span(job.stage);
        (self.grid.zoom() - job.stage as u32, left + job.column as u64, top + job.row as u64)
    }

    /// The zoom of a stage.
    pub(super) fn zoom(&self, stage: usize) -> u32 {
        self.grid.zoom() - stage as u32
    }

    /// Distance between the pixels of the highest zoom, in metres of the world.
    pub(super) fn cell(&self) -> f64 {
        self.grid.cell()
    }

    /// West, south, east and north of the window, in degrees.
    pub(super) fn degrees(&self) -> [f64; 4] {
        tile_grid::degrees(self.grid.pixels(), (self.tile() as u64) << self.grid.zoom())
    }

    /// What the tiles are: members of TileJSON, and where they are from.
    pub(super) fn about(&self) -> serde_json::Value {
        let zoom = self.grid.zoom();
        let [west, south, east, north] = self.degrees();
        let lowest = zoom + 1 - self.stages.len() as u32;
        json!({
            "name": if self.about.is_empty() { "Orogen" } else { &self.about },
            "minzoom": lowest,
            "maxzoom": zoom,
            "bounds": [west, south, east, north],
            "center": [(west + east) / 2.0, (south + north) / 2.0, lowest],
            "encoding": self.encoding.tilejson(),
            "tileSize": self.tile(),
            "made_by": format!("Orogen {}", self.identity.version),
            "recipe_sha256": self.identity.recipe,
            "cell": self.identity.window.cell,
            "map_metres_per_metre": match tile_grid::web_map(self.identity.map.as_ref()) {
                Some(map) => map.per_metre[0],
                None => tile_grid::pixel(zoom, self.tile()) / self.identity.window.cell,
            },
            "window": {
                "x": self.identity.window.x, "y": self.identity.window.y,
                "width": self.identity.window.width, "height": self.identity.window.height,
            },
        })
    }

    fn picture(&self, job: Job) -> JobFile {
        let (zoom, column, row) = self.address(job);
        JobFile::Result(format!("{zoom}/{column}/{row}.png").into())
    }

    fn half(&self, job: Job) -> JobFile {
        let (zoom, column, row) = self.address(job);
        JobFile::Scratch(format!("half/{zoom}/{column}/{row}").into())
    }

    /// The pixels of a tile derived from the tiles below it; where one is missing, the edge of its neighbor is
    /// repeated.
    fn gathered(&self, job: Job, store: &OutputStore) -> Result<Vec<f32>> {
        let (tile, half) = (self.tile(), self.tile() / 2);
        let mut quarters: [[Option<Vec<f32>>; 2]; 2] = Default::default();
        for below in self.reads(job) {
            let (_, column, row) = self.address(below);
            quarters[(row % 2) as usize][(column % 2) as usize] =
                Some(samples::read(store, &self.half(below), half * half)?);
        }
        // Tiles of a zoom fill a rectangle, so whole rows or columns of quarters exist or not.
        let [there_down, there_across] = [
            [0, 1].map(|j: usize| quarters[j].iter().any(Option::is_some)),
            [0, 1].map(|i: usize| quarters.iter().any(|row| row[i].is_some())),
        ];
        let place = |at: usize, there: [bool; 2]| match (at / half, there) {
            (0, [false, _]) => (1, 0),
            (1, [_, false]) => (0, half - 1),
            (quarter, _) => (quarter, at % half),
        };
        let mut out = vec![0.0; tile * tile];
        for (j, out) in out.chunks_exact_mut(tile).enumerate() {
            let (down, row) = place(j, there_down);
            for (k, out) in out.chunks_exact_mut(half).enumerate() {
                let (across, column) = place(k * half, there_across);
                let Some(samples) = &quarters[down][across] else { continue };
                match across == k {
                    true => out.copy_from_slice(&samples[row * half..(row + 1) * half]),
                    false => out.fill(samples[row * half + column]),
                }
            }
        }
        Ok(out)
    }
}

impl Tree {
    /// Runs a job; `shown` are the heights of the tile that are written, from the exact ones.
    pub(super) fn made(
        &self,
        job: Job,
        grids: &[Grid],
        store: &OutputStore,
        shown: impl FnOnce(&[f32]) -> Vec<f32>,
    ) -> Result<Made> {
        let samples = match grids.first() {
            Some(grid) => {
                let (_, column, row) = self.address(job);
                self.grid.read(column, row, 0, grid, self.kind)
            }
            None => self.gathered(job, store)?,
        };
        let mut files = vec![encode(self.encoding, self.tile(), &shown(&samples))?];
        if job.stage + 1 < self.stages.len() {
            files.push(to_bytes(&halved(&samples, self.tile())));
        }
        Ok(Made { files, ranges: Vec::new() })
    }
}

impl BuildTarget for Tree {
    fn stages(&self) -> Vec<Stage> {
        self.stages.clone()
    }

    fn window(&self, row: usize, column: usize) -> Window {
        let (_, column, row) = self.address(Job { stage: 0, row, column });
        self.grid.window(column, row, 0)
    }

    fn places(&self, job: Job) -> Vec<JobFile> {
        match job.stage + 1 == self.stages.len() {
            true => vec![self.picture(job)],
            false => vec![self.picture(job), self.half(job)],
        }
    }

    fn reads(&self, job: Job) -> Vec<Job> {
        let Some(stage) = job.stage.checked_sub(1) else { return Vec::new() };
        let (_, column, row) = self.address(job);
        let [[left, right], [top, bottom]] = self.span(stage);
        let below = |at: u64, first: u64, last: u64| (2 * at).max(first)..(2 * at + 2).min(last + 1);
        let job = |column: u64, row: u64| Job { stage, row: (row - top) as usize, column: (column - left) as usize };
        let columns = below(column, left, right);
        below(row, top, bottom).flat_map(|row| columns.clone().map(move |column| job(column, row))).collect()
    }

    fn make(&self, job: Job, grids: &[Grid], store: &OutputStore) -> Result<Made> {
        self.made(job, grids, store, <[f32]>::to_vec)
    }

    fn finish(&self, store: &OutputStore) -> Result<Vec<(PathBuf, FileDigest)>> {
        let mut tiles = self.about();
        tiles["tilejson"] = json!("3.0.0");
        tiles["tiles"] = json!(["{z}/{x}/{y}.png"]);
        tiles["scheme"] = json!("xyz");
        Ok(vec![store.json(TILEJSON, &tiles)?])
    }

    fn extras(&self) -> Vec<PathBuf> {
        vec![TILEJSON.into()]
    }

    fn scratch_memory(&self) -> u64 {
        // The pixels and those that are written, their encoding in three bytes each, the compressed tile, and half the
        // pixels.
        20 * (self.tile() * self.tile()) as u64
    }

    fn disk(&self) -> Disk {
        let (tile, half) = (self.tile() as u64, self.tile() as u64 / 2);
        let tiles: u64 = self.stages.iter().map(|stage| stage.len() as u64).sum();
        Disk { result: tiles * (3 * tile * tile + 2 * tile + 1024) + (1 << 16), scratch: tiles * 4 * half * half }
    }
}

/// A square of heights as a PNG.
///
/// # Errors
/// If a side has no pixels.
pub fn encode(encoding: Encoding, side: usize, samples: &[f32]) -> Result<Vec<u8>> {
    let mut bytes = Vec::new();
    let picture = Picture::new(side, side, Pixel::Data8);
    png::write(&mut bytes, &picture, |rows, out| {
        let samples = &samples[rows.start * side..rows.end * side];
        encoding.fill(out, samples);
        Ok(())
    })
    .map_err(|cause| Error::new(ErrorKind::Request, cause.to_string()))?;
    Ok(bytes)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_mean_of_four() {
        let rows = [[1.0, 2.0, 5.0, 5.0], [3.0, 6.0, 5.0, 5.0], [0.0; 4], [0.0, 8.0, -8.0, 0.0]];
        assert_eq!(halved(rows.as_flattened(), 4), [3.0, 5.0, 2.0, -2.0]);
    }
}
