//! The land as rays intersect it: bilinear patches between samples, water over some of them, and a pyramid of maxima.

use orogen_grid::parallel;

use orogen_grid::error::{Error, ErrorKind, Result};
use orogen_grid::grid::Grid;
use orogen_io::dem::fill::fill;

/// The input of a picture.
#[derive(Debug, Clone, Copy)]
pub struct Land<'a> {
    /// Heights in metres. Samples that are not finite are interpolated.
    pub heights: &'a Grid,
    /// Water level of lakes, in metres, and the ground elsewhere; over the same window.
    pub surface: Option<&'a Grid>,
    /// Drainage area of each sample, in m^2; over the same window.
    pub flow: Option<&'a Grid>,
    /// Sea level in metres, if there is a sea; it covers ground at or below it.
    pub sea_level: Option<f64>,
}

/// The land in units of cells along all three axes: x east and y south from the first sample, z up from the lowest one.
#[derive(Debug, Clone)]
pub struct Relief {
    columns: usize,
    rows: usize,
    bed: Vec<f32>,
    /// The water level of each patch, negative infinity where there is none; empty if there is no water.
    water: Vec<f32>,
    /// The maxima of each patch, of each 2 x 2 patches, and so on up to a single one.
    tops: Vec<Tops>,
    datum: f64,
    cell: f64,
    origin: [f64; 2],
    exaggeration: f64,
    sea: Option<f64>,
}

/// A level of the pyramid.
#[derive(Debug, Clone)]
pub(super) struct Tops {
    pub columns: usize,
    pub highest: Vec<f32>,
}

impl Tops {
    pub fn at(&self, i: usize, j: usize) -> f32 {
        self.highest[j * self.columns + i]
    }
}

/// The water level of a patch without water.
pub(super) const DRY: f32 = f32::NEG_INFINITY;

/// Water shallower than this, in metres, is ignored: rounding errors of solvers leave such films.
const FILM: f32 = 1e-3;

impl Relief {
    /// Prepares the land with heights multiplied by `exaggeration`.
    ///
    /// # Errors
    /// If there are fewer than 2 x 2 samples or no finite ones, or if layers do not have the same window.
    pub fn new(land: &Land, exaggeration: f64) -> Result<Relief> {
        let window = *land.heights.window();
        let fault = |message: String| Err(Error::new(ErrorKind::Request, message));
        let (columns, rows) = (window.width, window.height);
        if columns < 2 || rows < 2 {
            return fault(format!("a picture needs at least 2 x 2 samples of ground, not {columns} x {rows}"));
        }
        if [land.surface, land.flow].into_iter().flatten().any(|layer| *layer.window() != window) {
            return fault("water and heights of a picture must have the same window".into());
        }
        let mut heights: Vec<f32> =
            land.heights.data().iter().map(|&height| if height.is_finite() { height } else { f32::NAN }).collect();
        if fill(&mut heights, columns, rows) == heights.len() {
            return fault("the window has no finite heights, so nothing can be drawn".into());
        }
        let datum = f64::from(heights.iter().copied().fold(f32::INFINITY, f32::min));
        let mut relief = Relief {
            columns,
            rows,
            bed: Vec::new(),
            water: Vec::new(),
            tops: Vec::new(),
            datum,
            cell: window.cell,
            origin: [window.east(0), window.south(0)],
            exaggeration,
            sea: None,
        };
        relief.sea = land.sea_level.map(|level| relief.level_of(level));
        relief.flood(&heights, land);
        relief.bed = parallel::samples(heights.len(), |at| relief.level_of(f64::from(heights[at])) as f32);
        relief.pile();
        Ok(relief)
    }

    /// Computes the water level of each patch: the highest of its corners.
    fn flood(&mut self, heights: &[f32], land: &Land) {
        let sea = land.sea_level.map(|level| level as f32);
        let surfaces = land.surface.map(Grid::data);
        let level = |at: usize| -> f32 {
            let height = heights[at];
            match surfaces
                .map(|surfaces| surfaces[at])
                .filter(|surface| surface.is_finite() && *surface > height + FILM)
            {
                Some(lake) => sea.map_or(lake, |sea| if height <= sea { lake.max(sea) } else { lake }),
                None => sea.filter(|sea| height <= *sea).unwrap_or(DRY),
            }
        };
        let levels = parallel::samples(heights.len(), level);
        if levels.iter().all(|level| *level == DRY) {
            return;
        }
        let (columns, rows) = (self.columns, self.rows);
        let this = &*self;
        self.water = of_patches([columns, rows], |i, j| {
            let at = j * columns + i;
            let corners = [levels[at], levels[at + 1], levels[at + columns], levels[at + columns + 1]];
            match corners.into_iter().fold(DRY, f32::max) {
                DRY => DRY,
                level => this.level_of(f64::from(level)) as f32,
            }
        });
    }

    /// Builds the pyramid.
    fn pile(&mut self) {
        let (columns, rows) = (self.columns - 1, self.rows - 1);
        let highest = of_patches([self.columns, self.rows], |i, j| {
            let corners = self.corners(i, j).into_iter().fold(f32::NEG_INFINITY, f32::max);
            corners.max(self.water_of(i, j))
        });
        let mut tops = vec![Tops { columns, highest }];
        let (mut columns, mut rows) = (columns, rows);
        while let Some(below) = tops.last().filter(|_| columns > 1 || rows > 1) {
            let (wide, high) = (columns.div_ceil(2), rows.div_ceil(2));
            let mut highest = Vec::with_capacity(wide * high);
            for j in 0..high {
                for i in 0..wide {
                    let (right, lower) = ((2 * i + 1).min(columns - 1), (2 * j + 1).min(rows - 1));
                    let upper = below.at(2 * i, 2 * j).max(below.at(right, 2 * j));
                    highest.push(upper.max(below.at(2 * i, lower)).max(below.at(right, lower)));
                }
            }
            tops.push(Tops { columns: wide, highest });
            (columns, rows) = (wide, high);
        }
        self.tops = tops;
    }

    /// Number of columns and rows.
    #[must_use]
    pub fn samples(&self) -> [usize; 2] {
        [self.columns, self.rows]
    }

    /// Extent of the land east and south of its first sample, in cells.
    #[must_use]
    pub fn reach(&self) -> [f64; 2] {
        [(self.columns - 1) as f64, (self.rows - 1) as f64]
    }

    /// The position of the first sample: metres east and south of the world's origin.
    #[must_use]
    pub fn origin(&self) -> [f64; 2] {
        self.origin
    }

    /// Metres per cell.
    #[must_use]
    pub fn cell(&self) -> f64 {
        self.cell
    }

    /// The factor of heights.
    #[must_use]
    pub fn exaggeration(&self) -> f64 {
        self.exaggeration
    }

    /// The z of a height in metres.
    #[must_use]
    pub fn level_of(&self, height: f64) -> f64 {
        (height - self.datum) * self.exaggeration / self.cell
    }

    /// The height in metres of z.
    #[must_use]
    pub fn height_of(&self, z: f64) -> f64 {
        z * self.cell / self.exaggeration + self.datum
    }

    /// The z of the sea level, if there is a sea.
    #[must_use]
    pub fn sea(&self) -> Option<f64> {
        self.sea
    }

    /// The z of the highest ground or water.
    #[must_use]
    pub fn highest(&self) -> f64 {
        self.tops.last().map_or(0.0, |tops| f64::from(tops.at(0, 0)))
    }

    /// The z of all ground samples.
    pub(super) fn bed(&self) -> &[f32] {
        &self.bed
    }

    /// The water level of each patch; empty if there is no water.
    pub(super) fn water(&self) -> &[f32] {
        &self.water
    }

    /// The pyramid, the finest level first.
    pub(super) fn tops(&self) -> &[Tops] {
        &self.tops
    }

    /// The z of the ground at the corners of a patch: north-west, north-east, south-west, south-east.
    pub(super) fn corners(&self, i: usize, j: usize) -> [f32; 4] {
        let at = j * self.columns + i;
        let (north, south) = (&self.bed[at..at + 2], &self.bed[at + self.columns..at + self.columns + 2]);
        [north[0], north[1], south[0], south[1]]
    }

    /// The z of the water of a patch, [`DRY`] where there is none.
    pub(super) fn water_of(&self, i: usize, j: usize) -> f32 {
        if self.water.is_empty() { DRY } else { self.water[j * (self.columns - 1) + i] }
    }

    /// The patch that contains or is nearest to a point, and the position in it, from 0 to 1 along each axis.
    pub(super) fn patch(&self, x: f64, y: f64) -> ([usize; 2], [f64; 2]) {
        let [east, south] = self.reach();
        let (x, y) = (x.clamp(0.0, east), y.clamp(0.0, south));
        let (i, j) = ((x as usize).min(self.columns - 2), (y as usize).min(self.rows - 2));
        ([i, j], [x - i as f64, y - j as f64])
    }

    /// The z of the ground at a point; outside, that of the nearest point of the edge.
    pub fn ground(&self, x: f64, y: f64) -> f64 {
        let ([i, j], [u, v]) = self.patch(x, y);
        let [nw, ne, sw, se] = self.corners(i, j).map(f64::from);
        let (north, south) = (nw + (ne - nw) * u, sw + (se - sw) * u);
        north + (south - north) * v
    }

    /// The z of the ground or the water, whichever is higher.
    #[must_use]
    pub fn top(&self, x: f64, y: f64) -> f64 {
        let ([i, j], _) = self.patch(x, y);
        self.ground(x, y).max(f64::from(self.water_of(i, j)))
    }
}

/// Evaluates `of` for each patch between columns and rows of samples.
fn of_patches([columns, rows]: [usize; 2], of: impl Fn(usize, usize) -> f32 + Sync) -> Vec<f32> {
    let mut patches = vec![0.0; (columns - 1) * (rows - 1)];
    parallel::for_each(patches.chunks_mut((columns - 1).max(1)).enumerate(), |(j, row)| {
        row.iter_mut().enumerate().for_each(|(i, patch)| *patch = of(i, j));
    });
    patches
}

#[cfg(test)]
mod tests {
    use super::*;
    use orogen_grid::grid::Window;

    fn land(heights: &Grid) -> Land<'_> {
        Land { heights, surface: None, flow: None, sea_level: None }
    }

    #[test]
    fn a_pyramid_holds_the_highest_of_all_below() {
        for (columns, rows) in [(2, 2), (9, 5), (17, 33), (6, 2), (2, 40)] {
            let window = Window::new(columns, rows, 10.0);
            let data = (0..window.len()).map(|i| ((i * 7919) % 101) as f32).collect();
            let heights = Grid::from_data(window, data).unwrap();
            let relief = Relief::new(&land(&heights), 2.0).unwrap();
            for (level, tops) in relief.tops().iter().enumerate() {
                for j in 0..rows - 1 {
                    for i in 0..columns - 1 {
                        let corners = relief.corners(i, j);
                        assert!(corners.iter().all(|z| *z <= tops.at(i >> level, j >> level)));
                    }
                }
            }
            let most = heights.data().iter().copied().fold(f32::MIN, f32::max);
            assert_eq!(relief.height_of(relief.highest()) as f32, most);
        }
    }

    #[test]
    fn holes_are_filled_and_what_is_no_land_is_refused() {
        let mut heights = Grid::filled(Window::new(5, 4, 3.0), 12.0);
        heights.row_mut(2)[2] = f32::NAN;
        heights.row_mut(0)[0] = f32::INFINITY;
        let relief = Relief::new(&land(&heights), 1.0).unwrap();
        assert!(relief.bed().iter().all(|z| *z == 0.0));
        let nothing = Grid::filled(Window::new(5, 4, 3.0), f32::NAN);
        let error = Relief::new(&land(&nothing), 1.0).unwrap_err().to_string();
        assert!(error.contains("no finite heights"), "{error}");
        let line = Grid::filled(Window::new(5, 1, 3.0), 1.0);
        let error = Relief::new(&land(&line), 1.0).unwrap_err().to_string();
        assert!(error.contains("5 x 1"), "{error}");
        let other = Grid::filled(Window::new(4, 4, 3.0), 1.0);
        assert!(Relief::new(&Land { surface: Some(&other), ..land(&heights) }, 1.0).is_err());
    }

    #[test]
    fn water_stands_where_the_sea_or_a_lake_is() {
        let window = Window::new(4, 2, 10.0);
        let heights = Grid::from_data(window, [-5.0, 20.0, 20.0, 8.0].repeat(2)).unwrap();
        let surface = Grid::from_data(window, [-5.0, 20.0, 20.0, 18.0].repeat(2)).unwrap();
        let land = Land { surface: Some(&surface), sea_level: Some(0.0), ..land(&heights) };
        let relief = Relief::new(&land, 1.0).unwrap();
        assert_eq!([0, 1, 2].map(|i| relief.water_of(i, 0)), [0.5, DRY, 2.3]);
        assert_eq!((relief.top(0.0, 0.0), relief.ground(0.0, 0.0)), (0.5, 0.0));
        assert_eq!(relief.top(1.5, 0.5), 2.5);
    }
}
