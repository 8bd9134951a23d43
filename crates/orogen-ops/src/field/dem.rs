//! Heights from a digital elevation model in a file.

use crate::layer::LayerKind;
use crate::lower::Lowering;
use crate::op::{Field, Inputs, WorldParams};
use orogen_grid::error::{Error, ErrorKind, Result};
use orogen_grid::grid::Window;
use orogen_grid::resample::{self, NOWHERE};
use orogen_io::dem::file_ref::FileRef;
use orogen_io::dem::prepared::PreparedDem;
use orogen_io::format::dem::Georeference;
use orogen_noise::Points;
use orogen_noise::shader::function::Shader;

choice! {
    /// The values of a file of heights that the field has.
    pub enum DemShows {
        /// The heights, in metres.
        Height = "height",
        /// A mask of the file's extent: 1 inside, 0 outside, with a transition of width `fade`. Use it to mix the file
        /// with generated terrain.
        Inside = "inside",
    }
}

op! {
    /// Heights of a digital elevation model (DEM), read from a file.
    ///
    /// Supported formats: GeoTIFF (.tif), ESRI ASCII grid (.asc), SRTM tile (.hgt), virtual raster (.vrt), Zarr array,
    /// folder of tiles (.tif, .hgt or .asc), OpenEXR (.exr), NumPy array (.npy), 16-bit gray PNG (.png) and headerless
    /// samples (.r16, .r32). Files of the last five kinds lack metadata: it is read from NAME.json or NAME.toml beside
    /// the file (`width`, `height`, `cell`, `low`, `high`, `byte_order`, `nodata`), from a world file and from a .prj.
    /// Stored solutions are reused as long as the content of the file is the same; its name does not matter. The
    /// heights are kept in memory. From a large GeoTIFF or NetCDF file, requests of windows read only the blocks that
    /// they need, unless the recipe has a node that reads the whole world.
    ///
    /// The file's first sample, its north-west corner, is placed at `at`. Between samples the heights are interpolated
    /// by a cubic (Catmull and Rom 1974). Geographic coordinates are converted to metres with the length of a degree at
    /// the file's middle latitude (WGS 84), with one factor per axis for the whole file. Cells that are not square are
    /// resampled to squares of their shorter side. Nodata samples are filled smoothly from their surroundings. Beyond
    /// the file's extent the heights of its border continue; with a `fade` they change gradually to `outside`.
    pub struct Dem = "dem", field, revision 1;
    params {
        /// Path of the file. A relative path is resolved against the folder of the recipe.
        path: FileRef = FileRef::default();
        /// Band of a multi-band file, counted from 1. 0 stands for the only band of a single-band file.
        band: u32 = 0, range 0.0 to 65535.0;
        /// What the field shows: heights, or a mask of the file's extent.
        shows: DemShows = DemShows::Height;
        /// Position of the file's north-west corner: metres east, metres south.
        at: [f64; 2] = [0.0, 0.0], unit "m", range -1e9 to 1e9;
        /// Factor applied to the heights.
        scale: f64 = 1.0, range -1e4 to 1e4;
        /// Value added to the heights after `scale`.
        offset: f64 = 0.0, unit "m", range -1e6 to 1e6;
        /// Height far outside the file's extent. It is used only if `fade` is above 0.
        outside: f64 = 0.0, unit "m", range -1e6 to 1e6;
        /// Distance over which the border's heights change to `outside`. With 0 the border's heights continue without
        /// end.
        fade: f64 = 0.0, unit "m", range 0.0 to 1e9;
    }
    check |dem| match dem.path.is_empty() {
        true => Err(("path", "`path` is empty; write the path of a .tif, .asc, .hgt, .vrt, .exr, .npy, .png, .r16 or .r32, of a folder of tiles or of a Zarr array".to_string())),
        false => Ok(()),
    };
}

/// The error if heights are used before they were read. Requests read them first.
fn unread() -> Error {
    Error::new(ErrorKind::Internal, "heights of a file were used before they were read")
}

impl Dem {
    /// Whether the heights of the file that a window reads are available. If only a part of the file was read, the
    /// window must be inside that part.
    #[must_use]
    pub fn holds(&self, window: &Window) -> bool {
        let Some(ground) = self.path.ground().filter(|ground| ground.is_part() && self.shows == DemShows::Height)
        else {
            return true;
        };
        self.reads(window).is_some_and(|read| ground.grid.window().contains(&read))
    }

    /// The samples of the file that a window reads, on the lattice of the file. `None` if the file has no samples yet.
    #[doc(hidden)]
    #[must_use]
    pub fn reads(&self, window: &Window) -> Option<Window> {
        let [left, top] = self.at;
        let (right, bottom) = (window.east(window.width.max(1) - 1), window.south(window.height.max(1) - 1));
        let (west, north) = (window.east(0) - left, window.south(0) - top);
        self.path.ground().map(|ground| around(ground, [west, right - left], [north, bottom - top]))
    }

    /// The share of `outside`, 0 to 1, at a position in the file's own metres.
    fn beyond(&self, x: f64, y: f64, [width, height]: [f64; 2]) -> f64 {
        let past = |at: f64, end: f64| (-at).max(at - end).max(0.0);
        let (east, south) = (past(x, width), past(y, height));
        if east == 0.0 && south == 0.0 {
            return 0.0;
        }
        let t = (east * east + south * south).sqrt() / self.fade;
        if t >= 1.0 { 1.0 } else { t * t * (3.0 - 2.0 * t) }
    }
}

/// The samples of a file that the interpolating cubic reads between the first and the last of positions, in metres from
/// the first sample of the file.
fn around(ground: &PreparedDem, xs: [f64; 2], ys: [f64; 2]) -> Window {
    let cell = ground.grid.window().cell;
    // It reads one sample before and two after a position. Beyond the file it reads the samples at the border.
    let span = |[first, last]: [f64; 2], samples: usize| {
        let samples = samples as i64;
        let [first, last] = [first, last].map(|at| (at / cell).floor() as i64);
        let start = first.saturating_sub(2).clamp(0, (samples - 4).max(0));
        (start, (last.saturating_add(4).clamp(samples.min(4), samples) - start) as usize)
    };
    let ((x, width), (y, height)) = (span(xs, ground.size[0]), span(ys, ground.size[1]));
    Window { x, y, width, height, cell }
}

/// The lowest and the highest of values.
fn range(values: &[f64]) -> [f64; 2] {
    values.iter().fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], value| [low.min(*value), high.max(*value)])
}

impl Field for Dem {
    fn eval(&self, at: &Points, _: &Inputs, _: &WorldParams, out: &mut [f32]) -> Result<()> {
        // A world is not opened without its files. A plan that runs without a world has no values here.
        let Some(ground) = self.path.ground() else {
            out.fill(f32::NAN);
            return Ok(());
        };
        let [left, top] = self.at;
        let cell = ground.grid.window().cell;
        let size = ground.size.map(|samples| (samples as f64 - 1.0) * cell);
        let finish = |xs: &[f64], ys: &[f64], points: &Points, out: &mut [f32]| {
            if self.shows == DemShows::Height {
                let window = self.path.dem_file().map(|file| file.covering(&around(ground, range(xs), range(ys))));
                let heights = match &window {
                    None => ground,
                    Some(held) => held.as_ref().ok_or_else(unread)?,
                };
                resample::read(&heights.grid, LayerKind::Height, points, out);
            }
            if self.shows == DemShows::Height && self.fade == 0.0 {
                for sample in out.iter_mut() {
                    *sample = (f64::from(*sample) * self.scale + self.offset) as f32;
                }
                return Ok(());
            }
            let lattice = matches!(points, Points::Lattice { .. });
            for (k, sample) in out.iter_mut().enumerate() {
                let (x, y) = if lattice { (xs[k % xs.len()], ys[k / xs.len()]) } else { (xs[k], ys[k]) };
                // 0 / 0 is NaN, so a fade of 0 is handled separately.
                let beyond = match self.fade == 0.0 {
                    true => f64::from(u8::from(!((0.0..=size[0]).contains(&x) && (0.0..=size[1]).contains(&y)))),
                    false => self.beyond(x, y, size),
                };
                *sample = match self.shows {
                    DemShows::Inside => (1.0 - beyond) as f32,
                    DemShows::Height => {
                        let height = f64::from(*sample) * self.scale + self.offset;
                        (height + (self.outside - height) * beyond) as f32
                    }
                };
            }
            Ok(())
        };
        match at {
            Points::Lattice { xs, ys } if !xs.is_empty() => {
                let xs: Vec<f64> = xs.iter().map(|x| x - left).collect();
                let ys: Vec<f64> = ys.iter().map(|y| y - top).collect();
                finish(&xs, &ys, &Points::Lattice { xs: &xs, ys: &ys }, out)
            }
            _ => {
                let (x, y): (Vec<f64>, Vec<f64>) =
                    (0..out.len()).map(|k| at.position(k).unwrap_or(NOWHERE)).map(|(x, y)| (x - left, y - top)).unzip();
                finish(&x, &y, &Points::Scattered { x: &x, y: &y }, out)
            }
        }
    }

    fn cost(&self) -> f64 {
        30.0
    }

    fn cost_in_rows(&self) -> f64 {
        9.0
    }

    fn georeference(&self) -> Option<Georeference> {
        let ground = self.path.ground()?;
        ground.georeference.as_ref().map(|map| map.moved(self.at[0], self.at[1]))
    }

    fn memory(&self) -> u64 {
        self.path.ground().map_or(0, |ground| ground.memory())
    }

    fn lower(&self, _: usize, _: &WorldParams) -> Lowering<Shader> {
        Lowering::Processor("heights of files are interpolated in f64")
    }
}
