//! Grids of square tiles with the samples at their pixels: that of web maps, and the one of a world itself.
//!
//! **Web maps** ([`TileGrid::web`]): Web Mercator. A world in EPSG:3857 is at its real position; pixels between its
//! samples are interpolated. Any other world has its origin at 0 degrees east and north, where one metre of the world
//! is one metre of the map, and every pixel of a zoom is a sample of the cell that its pixels have.
//!
//! **The world itself** ([`TileGrid::own`]): zoom 0 is one tile, the square that the world fits in, with its north-west
//! corner at the origin. An unbounded world has a square of 2^[`UNBOUNDED_ZOOM`] tiles of its own cell with the origin
//! in the middle. Columns count east, rows south. Every pixel is a sample.

use orogen_engine::world::World;
use orogen_grid::error::{Error, ErrorKind, Result};
use orogen_grid::grid::{Grid, Window};
use orogen_grid::resample::{self, LayerKind};
use orogen_io::format::dem::Georeference;
use orogen_io::samples::pick;
use orogen_noise::Points;

/// Length of the equator in metres, on the sphere of Web Mercator.
pub const EQUATOR: f64 = 2.0 * std::f64::consts::PI * 6_378_137.0;

/// The highest zoom, with tiles of a few metres.
pub const MAX_ZOOM: u32 = 24;

/// The zoom whose pixels are closest in size to `cell` metres, for tiles of `tile` pixels.
fn zoom_near(cell: f64, tile: usize) -> u32 {
    libm::log2(EQUATOR / (tile as f64 * cell)).round().clamp(0.0, f64::from(MAX_ZOOM)) as u32
}

/// The side of a pixel at the equator, in metres of the map.
#[must_use]
pub fn pixel(zoom: u32, tile: usize) -> f64 {
    EQUATOR / (tile as f64 * f64::from(1 << zoom))
}

/// The cell closest to `cell` at which the map is true to scale: the pixel size of a zoom.
#[must_use]
pub fn cell_near(cell: f64, tile: usize, map: Option<&Georeference>) -> f64 {
    let unit = web_map(map).map_or(1.0, |map| map.per_metre[0]);
    pixel(zoom_near(cell * unit, tile), tile) / unit
}

/// The position of a world in Web Mercator.
#[must_use]
pub fn web_map(map: Option<&Georeference>) -> Option<&Georeference> {
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
    fn at(&self, pixel: i64) -> f64 {
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

/// The zoom at which tiles of an unbounded world have its own cell, in the grid of the world itself.
pub const UNBOUNDED_ZOOM: u32 = 17;

/// The pixels of a zoom, and the samples at them.
#[derive(Debug, Clone)]
pub struct TileGrid {
    zoom: u32,
    /// Side of a tile, in pixels.
    tile: usize,
    /// The samples at the pixels of the whole zoom, across and down.
    axes: [Axis; 2],
    /// The first and last pixel of the window, across and down.
    pixels: [[u64; 2]; 2],
    /// Distance between samples, in metres of the world.
    cell: f64,
    /// The window and the samples around it that may be read; `None` if the world is unbounded.
    reach: Option<Window>,
    /// Whether the samples are at the centers of pixels.
    is_centered: bool,
}

impl TileGrid {
    /// The tiles of web maps over a window, at the zoom whose pixels are closest in size to the window's cell.
    ///
    /// # Errors
    /// If the window is outside the map.
    pub fn over(world: &World, window: Window, tile: usize) -> Result<TileGrid> {
        let map = world.recipe().georeference();
        let map = web_map(map.as_ref());
        let zoom = zoom_near(window.cell * map.map_or(1.0, |map| map.per_metre[0]), tile);
        let most = (tile as u64) << zoom;
        let axes = web_axes(map, window.cell, zoom, tile);
        let [x, y] = axes;
        let axes = match map {
            Some(_) => [x.rounded(window.x, window.width), y.rounded(window.y, window.height)],
            None => axes,
        };
        let across = axes[0].pixels(window.x, window.width, most);
        let down = axes[1].pixels(window.y, window.height, most);
        let (Some(across), Some(down)) = (across, down) else {
            let message = match map {
                None => format!(
                    "the window does not fit on the map, which has {most} x {most} samples at zoom {zoom} with the origin in the middle; use a smaller window or a larger cell"
                ),
                Some(_) => format!(
                    "the window is not on the map of EPSG:3857, which extends {0} m from 0, 0 in each direction, or is smaller than its pixels at zoom {zoom}",
                    (0.5 * EQUATOR) as u64
                ),
            };
            return Err(Error::new(ErrorKind::Request, message));
        };
        let mut grid = TileGrid {
            zoom,
            tile,
            axes,
            pixels: [across, down],
            cell: window.cell,
            reach: Some(window),
            is_centered: map.is_some(),
        };
        if !grid.is_exact() {
            grid.reach = Some(world.surroundings(&window, 2 * AROUND));
        }
        Ok(grid)
    }

    /// The tiles of web maps over a whole world, at a zoom.
    ///
    /// # Errors
    /// If there is no such zoom, or the world has no sample at its cell or is outside the map.
    pub fn web(world: &World, zoom: u32, tile: usize) -> Result<TileGrid> {
        check_zoom(zoom)?;
        let map = world.recipe().georeference();
        let map = web_map(map.as_ref());
        let cell = pixel(zoom, tile) / map.map_or(1.0, |map| map.per_metre[0]);
        if world.recipe().world.size.is_some() {
            return TileGrid::over(world, world.full_window(cell)?, tile);
        }
        let axes = web_axes(map, cell, zoom, tile).map(|axis| axis.rounded(0, 1));
        let last = ((tile as u64) << zoom) - 1;
        let is_centered = map.is_some();
        Ok(TileGrid { zoom, tile, axes, pixels: [[0, last]; 2], cell, reach: None, is_centered })
    }

    /// The tiles of the world itself, at a zoom.
    ///
    /// # Errors
    /// If there is no such zoom, or the world has no sample at its cell.
    pub fn own(world: &World, zoom: u32, tile: usize) -> Result<TileGrid> {
        check_zoom(zoom)?;
        let spec = &world.recipe().world;
        let most = (tile as u64) << zoom;
        let at = |cell: f64, first: f64, pixels, reach| {
            let axes = [Axis { first, step: 1.0 }; 2];
            Ok(TileGrid { zoom, tile, axes, pixels, cell, reach, is_centered: false })
        };
        match spec.size {
            Some([width, height]) => {
                let cell = width.max(height) / most as f64;
                let window = world.full_window(cell)?;
                let pixels = [[0, window.width as u64 - 1], [0, window.height as u64 - 1]];
                at(cell, 0.0, pixels, Some(window))
            }
            None => {
                let cell = spec.cell * f64::from(1u32 << UNBOUNDED_ZOOM) / f64::from(1u32 << zoom);
                at(cell, -(most as f64 / 2.0), [[0, most - 1]; 2], None)
            }
        }
    }

    /// The zoom.
    #[must_use]
    pub fn zoom(&self) -> u32 {
        self.zoom
    }

    /// Distance between samples, in metres of the world.
    #[must_use]
    pub fn cell(&self) -> f64 {
        self.cell
    }

    /// The first and last pixel that has a sample of the window, across and down.
    #[must_use]
    pub fn pixels(&self) -> [[u64; 2]; 2] {
        self.pixels
    }

    /// The first and last tile that has a sample of the window, across and down.
    #[must_use]
    pub fn tiles(&self) -> [[u64; 2]; 2] {
        self.pixels.map(|side| side.map(|pixel| pixel / self.tile as u64))
    }

    /// Whether a tile has a sample of the window.
    #[must_use]
    pub fn has(&self, column: u64, row: u64) -> bool {
        let [across, down] = self.tiles();
        (across[0]..=across[1]).contains(&column) && (down[0]..=down[1]).contains(&row)
    }

    /// The north-west corner of a tile in metres of the world, east and south, and pixels per metre.
    #[must_use]
    pub fn corner(&self, column: u64, row: u64) -> ([f64; 2], [f64; 2]) {
        let shift = self.shift();
        let first = |axis: usize, tile: u64| {
            let Axis { first, step } = self.axes[axis];
            (first + ((tile * self.tile as u64) as f64 - shift) * step) * self.cell
        };
        ([first(0, column), first(1, row)], self.axes.map(|axis| 1.0 / (axis.step * self.cell)))
    }

    /// Where in a pixel its sample is, in pixels: at the north-west corner or, for a world in Web Mercator, in the
    /// middle.
    #[must_use]
    pub fn shift(&self) -> f64 {
        if self.is_centered { 0.5 } else { 0.0 }
    }

    /// The columns and rows, from the north-west corner of a tile, of the pixels of the tile and of a margin around it
    /// that have a sample of the window.
    #[must_use]
    pub fn within(&self, column: u64, row: u64, margin: usize) -> [std::ops::Range<i64>; 2] {
        let (side, margin) = (self.tile as i64, margin as i64);
        [(0, column), (1, row)].map(|(axis, tile)| {
            let [first, last] = self.pixels[axis].map(|pixel| pixel as i64 - tile as i64 * side);
            first.max(-margin)..(last + 1).min(side + margin)
        })
    }

    /// Whether every pixel is a sample.
    #[must_use]
    pub fn is_exact(&self) -> bool {
        self.axes.iter().all(Axis::is_exact)
    }

    /// The columns or rows of a tile that have a sample of the window; the other ones repeat its edge.
    #[must_use]
    pub fn covered(&self, column: u64, row: u64) -> [std::ops::Range<usize>; 2] {
        let side = self.tile as u64;
        [(0, column), (1, row)].map(|(axis, tile)| {
            let [first, last] = self.pixels[axis];
            let within = |pixel: u64| pixel.saturating_sub(tile * side).min(side) as usize;
            within(first)..within(last + 1)
        })
    }

    /// The window of samples from which a tile with a margin of pixels around it is made.
    #[must_use]
    pub fn window(&self, column: u64, row: u64, margin: usize) -> Window {
        let span = |axis: usize, tile: u64| {
            let (first, last) = self
                .positions(axis, tile, margin)
                .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), at| (low.min(at), high.max(at)));
            (first.floor() as i64, (last.ceil() - first.floor()) as usize + 1)
        };
        let ((x, width), (y, height)) = (span(0, column), span(1, row));
        let window = Window { x, y, width, height, cell: self.cell };
        match (self.is_exact(), &self.reach) {
            (true, _) => window,
            (false, Some(reach)) => window.grown(AROUND).intersection(reach),
            (false, None) => window.grown(AROUND),
        }
    }

    /// The pixels of a tile with a margin around it, from the samples of its [window](TileGrid::window). Pixels outside
    /// the grid's window repeat its edge.
    #[must_use]
    pub fn read(&self, column: u64, row: u64, margin: usize, grid: &Grid, kind: LayerKind) -> Vec<f32> {
        let (columns, rows) = (self.positions(0, column, margin), self.positions(1, row, margin));
        let window = grid.window();
        if self.is_exact() {
            let columns: Vec<usize> = columns.map(|at| (at as i64 - window.x) as usize).collect();
            let rows: Vec<usize> = rows.map(|at| (at as i64 - window.y) as usize).collect();
            return pick(grid, &columns, &rows);
        }
        let xs: Vec<f64> = columns.map(|at| at * window.cell).collect();
        let ys: Vec<f64> = rows.map(|at| at * window.cell).collect();
        let mut out = vec![0.0; xs.len() * ys.len()];
        resample::read(grid, kind, &Points::Lattice { xs: &xs, ys: &ys }, &mut out);
        out
    }

    /// The positions, in samples, of the pixels of a tile and its margin along an axis. Pixels outside the window are
    /// moved to its edge.
    fn positions(&self, axis: usize, tile: u64, margin: usize) -> impl Iterator<Item = f64> {
        let (side, margin) = (self.tile as i64, margin as i64);
        let [first, last] = self.pixels[axis].map(|pixel| pixel as i64);
        let start = tile as i64 * side;
        (start - margin..start + side + margin).map(move |pixel| self.axes[axis].at(pixel.clamp(first, last)))
    }
}

/// Checks that a zoom exists.
fn check_zoom(zoom: u32) -> Result<()> {
    match zoom <= MAX_ZOOM {
        true => Ok(()),
        false => Err(Error::new(ErrorKind::Request, format!("the zoom must be 0 to {MAX_ZOOM}, not {zoom}"))),
    }
}

/// The samples at the pixels of web maps: for a world in Web Mercator with this position, otherwise with the world's
/// origin in the middle of the map.
fn web_axes(map: Option<&Georeference>, cell: f64, zoom: u32, tile: usize) -> [Axis; 2] {
    let most = (tile as u64) << zoom;
    let Some(Georeference { origin: [east, north], per_metre, .. }) = map else {
        return [Axis { first: -(most as f64 / 2.0), step: 1.0 }; 2];
    };
    let (pixel, [across, down]) = (pixel(zoom, tile), per_metre.map(|unit| unit * cell));
    // The center of the first pixel is half a pixel within the map.
    let corner = 0.5 * (pixel - EQUATOR);
    [
        Axis { first: (corner - east) / across, step: pixel / across },
        Axis { first: (corner + north) / down, step: pixel / down },
    ]
}

/// West, south, east and north, in degrees, of pixels on a map with this many on a side.
#[must_use]
pub fn degrees([[left, right], [top, bottom]]: [[u64; 2]; 2], most: u64) -> [f64; 4] {
    use std::f64::consts::PI;
    let share = |pixel: u64| pixel as f64 / most as f64;
    let longitude = |pixel: u64| share(pixel) * 360.0 - 180.0;
    let latitude = |pixel: u64| libm::atan(libm::sinh(PI * (1.0 - 2.0 * share(pixel)))) * 180.0 / PI;
    [longitude(left), latitude(bottom + 1), longitude(right + 1), latitude(top)]
}

#[cfg(test)]
mod tests {
    use super::*;
    use orogen_engine::recipe::document::Recipe;

    fn world(text: &str) -> World {
        let text = format!(
            "orogen = 1\n[world]\n{text}\n[nodes.a]\nop = \"fbm\"\nwavelength = 900\n[outputs]\nheight = \"a\"\n"
        );
        World::open(Recipe::parse(&text, "test").unwrap()).unwrap()
    }

    #[test]
    fn pixels_are_true_to_scale_at_the_equator() {
        assert_eq!(zoom_near(156_543.0, 256), 0);
        assert_eq!(zoom_near(10.0, 256), 14);
        assert_eq!(zoom_near(10.0, 512), 13);
        assert!((cell_near(10.0, 256, None) - 9.554_628_535_647_032).abs() < 1e-12);
        assert_eq!(cell_near(cell_near(10.0, 256, None), 256, None), cell_near(10.0, 256, None));
    }

    #[test]
    fn the_square_of_a_world_is_zoom_0_of_its_own_tiles() {
        let world = world("size = [5120, 2560]\ncell = 10");
        let grid = TileGrid::own(&world, 1, 256).unwrap();
        assert_eq!((grid.cell(), grid.tiles()), (10.0, [[0, 1], [0, 0]]));
        assert_eq!(grid.window(1, 0, 0), Window::new(256, 256, 10.0).at(256, 0));
        // Its south repeats its edge.
        let grid = TileGrid::own(&world, 0, 256).unwrap();
        assert_eq!((grid.cell(), grid.covered(0, 0)), (20.0, [0..256, 0..128]));
        let window = grid.window(0, 0, 1);
        assert_eq!((window.x, window.y, window.width, window.height), (0, 0, 256, 128));
        let made = world.window("height", &window).unwrap();
        let read = grid.read(0, 0, 1, &made, LayerKind::Height);
        assert_eq!(read.len(), 258 * 258);
        assert_eq!((read[258 + 1], read[257 * 258 + 1]), (made[(0, 0)], made[(0, 127)]));
        assert!(!grid.has(1, 0) && grid.has(0, 0));
        assert!(TileGrid::own(&world, 25, 256).unwrap_err().to_string().contains("0 to 24"));
    }

    #[test]
    fn an_unbounded_world_has_its_origin_in_the_middle() {
        let world = world("cell = 10");
        for zoom in [0, UNBOUNDED_ZOOM, MAX_ZOOM] {
            let grid = TileGrid::own(&world, zoom, 256).unwrap();
            assert_eq!(grid.cell(), 10.0 * 131_072.0 / f64::from(1u32 << zoom));
            let half = if zoom == 0 { 128 } else { 0 };
            let middle = (1u64 << zoom) / 2;
            let window = grid.window(middle, middle, 0);
            assert_eq!((window.x, window.y), (-half, -half));
            assert!(world.check(&window).is_ok() && grid.has(middle, middle));
        }
        let web = TileGrid::web(&world, 14, 256).unwrap();
        assert_eq!((web.window(1 << 13, 1 << 13, 0).x, web.cell()), (0, pixel(14, 256)));
        assert_eq!(web.tiles(), [[0, (1 << 14) - 1]; 2]);
    }
}
