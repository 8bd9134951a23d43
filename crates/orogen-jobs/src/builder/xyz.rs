//! An XYZ tree of PNG tiles with encoded heights ([`Encoding`]), with TileJSON.
//!
//! **Position.** Web Mercator. Pixels are areas, and samples are at their centers. Tiles are those of the whole map, so
//! that windows of one world fit together; the part of a tile outside the window repeats its edge.
//!
//! - A world in EPSG:3857 is at its real position, in the tiles of all web maps. Pixels between its samples are
//!   interpolated, also from samples beyond the window where the world has any, so that adjacent windows together have
//!   the same pixels as one large window.
//! - Any other world has its origin at 0 degrees east and north. Near the equator Mercator is true to scale: one metre
//!   of the world is one metre of the map if the cell equals a pixel of some zoom (see [`cell_near`]); otherwise the
//!   map is scaled by a factor that TileJSON states.
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
use orogen_engine::world::{HEIGHT, World};
use orogen_grid::error::{Error, ErrorKind, Result};
use orogen_grid::grid::{Grid, Window};
use orogen_grid::resample::{self, LayerKind};
use orogen_io::format::dem::Georeference;
use orogen_io::format::encoding::Encoding;
use orogen_io::format::png::{self, Picture, Pixel};
use orogen_io::samples::{halved, pick, to_bytes};
use orogen_noise::Points;

/// The TileJSON file.
const TILEJSON: &str = "tiles.json";

/// Length of the equator in metres, on the sphere of Web Mercator.
const EQUATOR: f64 = 2.0 * std::f64::consts::PI * 6_378_137.0;

/// The highest zoom, with tiles of a few metres.
const DEEPEST: f64 = 24.0;

/// The zoom whose pixels are closest in size to `cell` metres, for tiles of `tile` pixels.
fn zoom_near(cell: f64, tile: usize) -> u32 {
    libm::log2(EQUATOR / (tile as f64 * cell)).round().clamp(0.0, DEEPEST) as u32
}

fn pixel(zoom: u32, tile: usize) -> f64 {
    EQUATOR / (tile as f64 * f64::from(1 << zoom))
}

/// The cell closest to `cell` at which the map is true to scale: the pixel size of a zoom.
#[must_use]
pub fn cell_near(cell: f64, tile: usize, map: Option<&Georeference>) -> f64 {
    let unit = web_map(map).map_or(1.0, |map| map.per_metre[0]);
    pixel(zoom_near(cell * unit, tile), tile) / unit
}

/// The position of a world in Web Mercator.
fn web_map(map: Option<&Georeference>) -> Option<&Georeference> {
    map.filter(|map| map.epsg() == Some(WEB_MERCATOR))
}

/// The EPSG code of Web Mercator.
const WEB_MERCATOR: u16 = 3857;

/// Maximum distance of a pixel from a sample, in cells, at which the two count as the same.
const SAME: f64 = 1e-3;

/// Number of samples around a position that the interpolation reads on each side.
const AROUND: usize = 2;

/// The samples at the pixels of an axis: pixel k is at sample `first + k * step`.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Axis {
    first: f64,
    step: f64,
}

impl Axis {
    fn at(&self, pixel: u64) -> f64 {
        self.first + pixel as f64 * self.step
    }

    /// Whether every pixel is a sample.
    fn is_exact(&self) -> bool {
        self.step == 1.0 && self.first == self.first.floor()
    }

    /// The first and last of `most` pixels whose centers are in the cells of `count` samples, starting at sample
    /// `from`. The last edge is excluded.
    fn pixels(&self, from: i64, count: usize, most: u64) -> Option<[u64; 2]> {
        let first = |edge: f64| ((edge - 0.5 - self.first) / self.step).ceil();
        let (first, end) = (first(from as f64), first(from as f64 + count as f64));
        (first >= 0.0 && end <= most as f64 && end > first).then_some([first as u64, end as u64 - 1])
    }

    /// Rounds to whole samples, if the pixels of `count` samples starting at `from` are all within [`SAME`] of them.
    fn rounded(self, from: i64, count: usize) -> Axis {
        let pixel = ((from as f64 - self.first) / self.step).round();
        let shift = (self.first + pixel * self.step).round() - pixel;
        let whole = Axis { first: shift, step: 1.0 };
        let differ = |pixel: f64| (self.first + pixel * self.step - shift - pixel).abs() > SAME;
        if differ(pixel) || differ(pixel + count as f64) { self } else { whole }
    }
}

/// The tree. Each zoom is a stage, from the highest zoom down.
pub struct Tree {
    encoding: Encoding,
    identity: Identity,
    about: String,
    /// The highest zoom.
    zoom: u32,
    /// The samples at the pixels of the whole map, across and down.
    axes: [Axis; 2],
    /// The window's first and last pixel on the whole map, across and down.
    pixels: [[u64; 2]; 2],
    /// The window and the samples around it that may be read.
    reach: Window,
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
        let map = web_map(identity.map.as_ref());
        let zoom = zoom_near(window.cell * map.map_or(1.0, |map| map.per_metre[0]), tile);
        let most = (tile as u64) << zoom;
        let axes = match map {
            None => [Axis { first: -(most as f64 / 2.0), step: 1.0 }; 2],
            Some(Georeference { origin: [east, north], per_metre, .. }) => {
                let (pixel, [across, down]) = (pixel(zoom, tile), per_metre.map(|unit| unit * window.cell));
                // The center of the first pixel is half a pixel within the map.
                let corner = 0.5 * (pixel - EQUATOR);
                let x = Axis { first: (corner - east) / across, step: pixel / across };
                let y = Axis { first: (corner + north) / down, step: pixel / down };
                [x.rounded(window.x, window.width), y.rounded(window.y, window.height)]
            }
        };
        let across = axes[0].pixels(window.x, window.width, most);
        let down = axes[1].pixels(window.y, window.height, most);
        let (Some(across), Some(down)) = (across, down) else {
            return refuse(match map {
                None => format!(
                    "the window does not fit on the map, which has {most} x {most} samples at zoom {zoom} with the origin in the middle; use a smaller window or a larger cell"
                ),
                Some(_) => format!(
                    "the window is not on the map of EPSG:3857, which extends {0} m from 0, 0 in each direction, or is smaller than its pixels at zoom {zoom}",
                    (0.5 * EQUATOR) as u64
                ),
            });
        };
        let is_exact = axes.iter().all(Axis::is_exact);
        let layer = identity.layers.first().map_or(HEIGHT, String::as_str);
        let mut tree = Tree {
            encoding,
            identity: identity.clone(),
            about: world.recipe().about.clone(),
            zoom,
            axes,
            pixels: [across, down],
            reach: if is_exact { window } else { world.surroundings(&window, 2 * AROUND) },
            kind: world.kind(layer)?,
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

    /// The positions, in samples, of the pixels of a tile of the highest zoom along an axis. Pixels outside the window
    /// are moved to its edge.
    fn positions(&self, axis: usize, tile: u64) -> impl Iterator<Item = f64> {
        let (side, [first, last]) = (self.tile() as u64, self.pixels[axis]);
        (tile * side..(tile + 1) * side).map(move |pixel| self.axes[axis].at(pixel.clamp(first, last)))
    }

    /// Whether every pixel is a sample.
    fn is_exact(&self) -> bool {
        self.axes.iter().all(Axis::is_exact)
    }

    /// The window of samples from which a tile of the highest zoom is made.
    fn inside(&self, row: usize, column: usize) -> Window {
        let (_, column, row) = self.address(Job { stage: 0, row, column });
        let span = |axis: usize, tile: u64| {
            let (first, last) = self
                .positions(axis, tile)
                .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), at| (low.min(at), high.max(at)));
            (first.floor() as i64, (last.ceil() - first.floor()) as usize + 1)
        };
        let ((x, width), (y, height)) = (span(0, column), span(1, row));
        let window = Window { x, y, width, height, cell: self.identity.window.cell };
        if self.is_exact() { window } else { window.grown(AROUND).intersection(&self.reach) }
    }

    /// The pixels of a tile of the highest zoom.
    fn full(&self, job: Job, grid: &Grid) -> Vec<f32> {
        let (_, column, row) = self.address(job);
        let (columns, rows) = (self.positions(0, column), self.positions(1, row));
        let window = grid.window();
        if self.is_exact() {
            let columns: Vec<usize> = columns.map(|at| (at as i64 - window.x) as usize).collect();
            let rows: Vec<usize> = rows.map(|at| (at as i64 - window.y) as usize).collect();
            return pick(grid, &columns, &rows);
        }
        let xs: Vec<f64> = columns.map(|at| at * window.cell).collect();
        let ys: Vec<f64> = rows.map(|at| at * window.cell).collect();
        let mut out = vec![0.0; xs.len() * ys.len()];
        resample::read(grid, self.kind, &Points::Lattice { xs: &xs, ys: &ys }, &mut out);
        out
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

    fn encode(&self, samples: &[f32]) -> Result<Vec<u8>> {
        let side = self.tile();
        let mut bytes = Vec::new();
        let picture = Picture::new(side, side, Pixel::Data8);
        png::write(&mut bytes, &picture, |rows, out| {
            let samples = &samples[rows.start * side..rows.end * side];
            self.encoding.fill(out, samples);
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

impl BuildTarget for Tree {
    fn stages(&self) -> Vec<Stage> {
        self.stages.clone()
    }

    fn window(&self, row: usize, column: usize) -> Window {
        self.inside(row, column)
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
            files.push(to_bytes(&halved(&samples, self.tile())));
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
            "map_metres_per_metre": match web_map(self.identity.map.as_ref()) {
                Some(map) => map.per_metre[0],
                None => pixel(self.zoom, self.tile()) / self.identity.window.cell,
            },
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
        // The pixels, their encoding in three bytes each, the compressed tile, and half the pixels.
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
        assert!((cell_near(10.0, 256, None) - 9.554_628_535_647_032).abs() < 1e-12);
        assert_eq!(cell_near(cell_near(10.0, 256, None), 256, None), cell_near(10.0, 256, None));
    }

    #[test]
    fn a_mean_of_four() {
        let rows = [[1.0, 2.0, 5.0, 5.0], [3.0, 6.0, 5.0, 5.0], [0.0; 4], [0.0, 8.0, -8.0, 0.0]];
        assert_eq!(halved(rows.as_flattened(), 4), [3.0, 5.0, 2.0, -2.0]);
    }
}
