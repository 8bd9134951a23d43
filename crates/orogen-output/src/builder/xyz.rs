//! An XYZ tree of PNG tiles with encoded heights ([`Encoding`]), with TileJSON.
//!
//! **Position.** Web Mercator, with the world's origin at 0 degrees east and north. Pixels are areas, and samples are
//! at their centres. Near the equator Mercator is true to scale: one metre of the world is one metre of the map if the
//! cell equals a pixel of some zoom (see [`cell_near`]); otherwise the map is scaled by a factor that TileJSON states.
//! Tiles are those of the whole map, so that windows of one world fit together; the part of a tile outside the window
//! repeats its edge.
//!
//! **Lower zooms.** Each pixel is the mean of the four below it in full precision, rounded once when it is written.

use std::path::PathBuf;

use serde_json::json;

use super::digest::FileDigest;
use super::identity::Identity;
use super::job::{Job, JobFile, Made, Stage};
use super::output_store::OutputStore;
use super::samples;
use super::target::{BuildTarget, Disk};
use orogen_grid::error::{Error, ErrorKind, Result};
use orogen_grid::grid::{Grid, Window};
use orogen_io::format::encoding::Encoding;
use orogen_io::format::png::{self, Picture, Pixel};

/// The TileJSON file.
const TILEJSON: &str = "tiles.json";

/// Length of the equator in metres, on the sphere of Web Mercator.
const EQUATOR: f64 = 2.0 * std::f64::consts::PI * 6_378_137.0;

/// The highest zoom, with tiles of a few metres.
const DEEPEST: f64 = 24.0;

/// The zoom whose pixels are closest to `cell` metres, for tiles of `tile` pixels.
fn zoom_near(cell: f64, tile: usize) -> u32 {
    libm::log2(EQUATOR / (tile as f64 * cell)).round().clamp(0.0, DEEPEST) as u32
}

fn pixel(zoom: u32, tile: usize) -> f64 {
    EQUATOR / (tile as f64 * f64::from(1 << zoom))
}

/// The cell closest to `cell` with which the map is true to scale.
#[must_use]
pub fn cell_near(cell: f64, tile: usize) -> f64 {
    pixel(zoom_near(cell, tile), tile)
}

/// The tree. Each zoom is a stage, from the highest zoom down.
pub struct Tree {
    encoding: Encoding,
    identity: Identity,
    about: String,
    /// The highest zoom.
    zoom: u32,
    /// The window's first and last pixel on the whole map, across and down.
    pixels: [[u64; 2]; 2],
    stages: Vec<Stage>,
}

impl Tree {
    /// The target of a build.
    ///
    /// # Errors
    /// If tiles do not have 256 or 512 pixels, or the window is outside the map.
    pub fn new(identity: &Identity, about: &str, encoding: Encoding) -> Result<Tree> {
        let refuse = |message: String| Err(Error::new(ErrorKind::Request, message));
        let (window, tile) = (identity.window, identity.tile);
        if !matches!(tile, 256 | 512) {
            return refuse(format!("the tiles of an XYZ tree must have 256 or 512 samples per side, not {tile}"));
        }
        let zoom = zoom_near(window.cell, tile);
        let most = (tile as u64) << zoom;
        let side = |first: i64, samples: usize| -> Option<[u64; 2]> {
            let first = u64::try_from(first.checked_add(most as i64 / 2)?).ok()?;
            let last = first + samples as u64 - 1;
            (last < most).then_some([first, last])
        };
        let (Some(across), Some(down)) = (side(window.x, window.width), side(window.y, window.height)) else {
            return refuse(format!(
                "the window does not fit on the map, which has {most} x {most} samples at zoom {zoom} with the origin in the middle; use a smaller window or a larger cell"
            ));
        };
        let mut tree = Tree {
            encoding,
            identity: identity.clone(),
            about: about.to_string(),
            zoom,
            pixels: [across, down],
            stages: Vec::new(),
        };
        for stage in 0..=zoom as usize {
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
        self.pixels.map(|side| side.map(|pixel| (pixel / self.identity.tile as u64) >> stage))
    }

    /// The address of a job's tile on the whole map: zoom, column, row.
    fn address(&self, job: Job) -> (u32, u64, u64) {
        let [[left, _], [top, _]] = self.span(job.stage);
        (self.zoom - job.stage as u32, left + job.column as u64, top + job.row as u64)
    }

    fn picture(&self, job: Job) -> JobFile {
        let (zoom, column, row) = self.address(job);
        JobFile::Result(format!("{zoom}/{column}/{row}.png").into())
    }

    fn half(&self, job: Job) -> JobFile {
        let (zoom, column, row) = self.address(job);
        JobFile::Scratch(format!("half/{zoom}/{column}/{row}").into())
    }

    /// The part of the window in a tile, and the position of the tile on the lattice.
    fn inside(&self, row: usize, column: usize) -> (Window, i64, i64) {
        let (_, column, row) = self.address(Job { stage: 0, row, column });
        let (tile, middle) = (self.tile() as i64, ((self.tile() as u64) << self.zoom) as i64 / 2);
        let (left, top) = (column as i64 * tile - middle, row as i64 * tile - middle);
        let window = self.identity.window;
        let (x, y) = (window.x.max(left), window.y.max(top));
        let inside = Window {
            x,
            y,
            width: (window.right().min(left + tile) - x) as usize,
            height: (window.bottom().min(top + tile) - y) as usize,
            cell: window.cell,
        };
        (inside, left, top)
    }

    /// The samples of a tile of the highest zoom.
    fn full(&self, job: Job, grid: &Grid) -> Vec<f32> {
        let (_, left, top) = self.inside(job.row, job.column);
        let (tile, window) = (self.tile() as i64, grid.window());
        let column = |i: i64| (left + i - window.x).clamp(0, window.width as i64 - 1) as usize;
        let row = |j: i64| (top + j - window.y).clamp(0, window.height as i64 - 1) as usize;
        (0..tile).flat_map(|j| (0..tile).map(move |i| (i, j))).map(|(i, j)| grid[(column(i), row(j))]).collect()
    }

    /// The samples of a tile derived from those below it; where there is none, the edge of its neighbour is repeated.
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
        let mut out = Vec::with_capacity(tile * tile);
        for j in 0..tile {
            let (down, row) = place(j, there_down);
            for i in 0..tile {
                let (across, column) = place(i, there_across);
                out.push(quarters[down][across].as_ref().map_or(0.0, |samples| samples[row * half + column]));
            }
        }
        Ok(out)
    }

    fn encode(&self, samples: &[f32]) -> Result<Vec<u8>> {
        let side = self.tile();
        let mut bytes = Vec::new();
        let picture = Picture::new(side, side, Pixel::Data8);
        png::write(&mut bytes, &picture, |rows, out| {
            let samples = &samples[rows.start * side..rows.end * side];
            for (pixel, sample) in out.chunks_exact_mut(3).zip(samples) {
                pixel.copy_from_slice(&self.encoding.bytes(*sample));
            }
            Ok(())
        })
        .map_err(|cause| Error::new(ErrorKind::Request, cause.to_string()))?;
        Ok(bytes)
    }

    /// West, south, east and north of the window, in degrees.
    fn bounds(&self) -> [f64; 4] {
        use std::f64::consts::PI;
        let most = ((self.tile() as u64) << self.zoom) as f64;
        let [[left, right], [top, bottom]] =
            self.pixels.map(|[first, last]| [first as f64 / most, (last + 1) as f64 / most]);
        let longitude = |x: f64| x * 360.0 - 180.0;
        let latitude = |y: f64| libm::atan(libm::sinh(PI * (1.0 - 2.0 * y))) * 180.0 / PI;
        [longitude(left), latitude(bottom), longitude(right), latitude(top)]
    }
}

/// Half the samples per side, each the mean of four.
fn halved(samples: &[f32], side: usize) -> Vec<f32> {
    let half = side / 2;
    let mean = |(i, j): (usize, usize)| {
        let at = 2 * j * side + 2 * i;
        let sum: f64 = [at, at + 1, at + side, at + side + 1].iter().map(|at| f64::from(samples[*at])).sum();
        (sum * 0.25) as f32
    };
    (0..half).flat_map(|j| (0..half).map(move |i| (i, j))).map(mean).collect()
}

impl BuildTarget for Tree {
    fn stages(&self) -> Vec<Stage> {
        self.stages.clone()
    }

    fn window(&self, row: usize, column: usize) -> Window {
        self.inside(row, column).0
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
        let samples = match grids.first() {
            Some(grid) => self.full(job, grid),
            None => self.gathered(job, store)?,
        };
        let mut files = vec![self.encode(&samples)?];
        if job.stage + 1 < self.stages.len() {
            files.push(samples::to_bytes(&halved(&samples, self.tile())));
        }
        Ok(Made { files, ranges: Vec::new() })
    }

    fn finish(&self, store: &OutputStore) -> Result<Vec<(PathBuf, FileDigest)>> {
        let [west, south, east, north] = self.bounds();
        let lowest = self.zoom + 1 - self.stages.len() as u32;
        let tiles = json!({
            "tilejson": "3.0.0",
            "name": if self.about.is_empty() { "Orogen" } else { &self.about },
            "tiles": ["{z}/{x}/{y}.png"],
            "scheme": "xyz",
            "minzoom": lowest,
            "maxzoom": self.zoom,
            "bounds": [west, south, east, north],
            "center": [(west + east) / 2.0, (south + north) / 2.0, lowest],
            "encoding": self.encoding.tilejson(),
            "tileSize": self.tile(),
            "made_by": format!("Orogen {}", self.identity.version),
            "recipe_sha256": self.identity.recipe,
            "cell": self.identity.window.cell,
            "map_metres_per_metre": pixel(self.zoom, self.tile()) / self.identity.window.cell,
            "window": {
                "x": self.identity.window.x, "y": self.identity.window.y,
                "width": self.identity.window.width, "height": self.identity.window.height,
            },
        });
        Ok(vec![store.json(TILEJSON, &tiles)?])
    }

    fn extras(&self) -> Vec<PathBuf> {
        vec![TILEJSON.into()]
    }

    fn scratch_memory(&self) -> u64 {
        // Its samples, three bytes each, compressed, and half the samples.
        16 * (self.tile() * self.tile()) as u64
    }

    fn disk(&self) -> Disk {
        let (tile, half) = (self.tile() as u64, self.tile() as u64 / 2);
        let tiles: u64 = self.stages.iter().map(|stage| stage.len() as u64).sum();
        Disk { result: tiles * (3 * tile * tile + 2 * tile + 1024) + (1 << 16), scratch: tiles * 4 * half * half }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pixels_are_true_to_scale_at_the_equator() {
        assert_eq!(zoom_near(156_543.0, 256), 0);
        assert_eq!(zoom_near(10.0, 256), 14);
        assert_eq!(zoom_near(10.0, 512), 13);
        assert!((cell_near(10.0, 256) - 9.554_628_535_647_032).abs() < 1e-12);
        assert_eq!(cell_near(cell_near(10.0, 256), 256), cell_near(10.0, 256));
    }

    #[test]
    fn a_mean_of_four() {
        let rows = [[1.0, 2.0, 5.0, 5.0], [3.0, 6.0, 5.0, 5.0], [0.0; 4], [0.0, 8.0, -8.0, 0.0]];
        assert_eq!(halved(rows.as_flattened(), 4), [3.0, 5.0, 2.0, -2.0]);
    }
}
