//! A real place, from a file.

use crate::dem::file_ref::FileRef;
use crate::format::dem::Georeference;
use crate::layer::LayerKind;
use crate::op::{Field, Inputs, WorldParams};
use crate::resample::{self, NOWHERE};
use orogen_noise::Points;

choice! {
    /// What of a file of heights is shown.
    pub enum Shows {
        /// The heights, in metres.
        Height = "height",
        /// 1 over the file's ground, 0 beyond it, between them over the width of `fade`: a mask for mixing it with invented terrain.
        Inside = "inside",
    }
}

op! {
    /// The heights of a real place: a digital elevation model from a file, as a field that any recipe can go on from.
    ///
    /// Read are GeoTIFF (.tif), ESRI ASCII grids (.asc), SRTM tiles (.hgt), virtual rasters (.vrt), Zarr arrays, folders of tiles (.tif, .hgt or .asc),
    /// OpenEXR (.exr), NumPy arrays (.npy), 16-bit grey pictures (.png) and headerless samples (.r16, .r32), the last five with the measures that they
    /// lack beside them: in a file NAME.json or NAME.toml (`width`, `height`, `cell`, `low`, `high`, `byte_order`, `nodata`), a world file and a .prj. What is in the file, not its name, decides which solutions of earlier runs are still
    /// good. It is held in memory.
    ///
    /// The file's first sample, its north-west corner, stands at `at`. Between its samples the interpolating cubic is read (Catmull
    /// and Rom 1974). Degrees become metres by the length of a degree at the file's middle latitude (WGS 84), one factor each way for
    /// the whole file; cells that are not square are laid on squares of their shorter side. Samples without a height are filled
    /// smoothly from around them. Beyond the file's edges the border's heights go on; with a `fade` they pass into `outside`.
    pub struct Dem = "dem", field, revision 1;
    params {
        /// The file; a relative path counts from the folder of the recipe.
        path: FileRef = FileRef::default();
        /// The band of a file of several, from 1; 0 is the only one.
        band: u32 = 0, range 0.0 to 65535.0;
        /// What is shown: the heights, or where there are any.
        shows: Shows = Shows::Height;
        /// Where the file's north-west corner stands, east and south.
        at: [f64; 2] = [0.0, 0.0], unit "m", range -1e9 to 1e9;
        /// Factor of the heights.
        scale: f64 = 1.0, range -1e4 to 1e4;
        /// Added to the heights after that.
        offset: f64 = 0.0, unit "m", range -1e6 to 1e6;
        /// Height far outside the file, where there is a `fade`.
        outside: f64 = 0.0, unit "m", range -1e6 to 1e6;
        /// Over how far the border's heights pass into `outside`; 0 lets them go on for ever.
        fade: f64 = 0.0, unit "m", range 0.0 to 1e9;
    }
    check |dem| match dem.path.is_empty() {
        true => Err(("path", "`path` names no file: write the path of a .tif, .asc, .hgt, .vrt, .exr, .npy, .png, .r16 or .r32, of a folder of tiles or of a Zarr array".to_string())),
        false => Ok(()),
    };
}

impl Dem {
    /// How far towards `outside` a position in the file's own metres is, 0 to 1.
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

impl Field for Dem {
    fn eval(&self, at: &Points, _: &Inputs, _: &WorldParams, out: &mut [f32]) {
        // A world is not opened without its files; a plan that runs without a world has nothing to show.
        let Some(ground) = self.path.ground() else { return out.fill(f32::NAN) };
        let [left, top] = self.at;
        let window = ground.grid.window();
        let size = [window.width, window.height].map(|samples| (samples as f64 - 1.0) * window.cell);
        let finish = |xs: &[f64], ys: &[f64], points: &Points, out: &mut [f32]| {
            if self.shows == Shows::Height {
                resample::read(&ground.grid, LayerKind::Height, points, out);
            }
            let lattice = matches!(points, Points::Lattice { .. });
            for (k, sample) in out.iter_mut().enumerate() {
                let (x, y) = if lattice { (xs[k % xs.len()], ys[k / xs.len()]) } else { (xs[k], ys[k]) };
                // 0 / 0 is no number: without a fade there is no way from one to the other.
                let beyond = match self.fade == 0.0 {
                    true => f64::from(u8::from(!((0.0..=size[0]).contains(&x) && (0.0..=size[1]).contains(&y)))),
                    false => self.beyond(x, y, size),
                };
                *sample = match self.shows {
                    Shows::Inside => (1.0 - beyond) as f32,
                    Shows::Height => {
                        let height = f64::from(*sample) * self.scale + self.offset;
                        let share = if self.fade == 0.0 { 0.0 } else { beyond };
                        (height + (self.outside - height) * share) as f32
                    }
                };
            }
        };
        match at {
            Points::Lattice { xs, ys } if !xs.is_empty() => {
                let xs: Vec<f64> = xs.iter().map(|x| x - left).collect();
                let ys: Vec<f64> = ys.iter().map(|y| y - top).collect();
                finish(&xs, &ys, &Points::Lattice { xs: &xs, ys: &ys }, out);
            }
            _ => {
                let (x, y): (Vec<f64>, Vec<f64>) =
                    (0..out.len()).map(|k| at.position(k).unwrap_or(NOWHERE)).map(|(x, y)| (x - left, y - top)).unzip();
                finish(&x, &y, &Points::Scattered { x: &x, y: &y }, out);
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
}
