//! Tiles of meshes for globes: a quantized-mesh tile is computed from the samples of its square.
//!
//! The tiles are those of Cesium's geographic tiling: two at zoom 0, each 180 degrees wide; columns count from the
//! west, rows from the south. A world in degrees or in Web Mercator is at its real position, and vertices between its
//! samples are interpolated. Any other world has its origin at 0 degrees east and north, and one metre of the world is
//! one metre on the equator, as in the [tiles of web maps](crate::builder::tile_grid); its vertices are samples.

use crate::builder::tile_grid::{EQUATOR, MAX_ZOOM, web_map};
use orogen_engine::world::{HEIGHT, World};
use orogen_grid::error::{Error, ErrorKind, Result};
use orogen_grid::grid::Window;
use orogen_grid::progress::Progress;
use orogen_grid::resample::{self, LayerKind};
use orogen_io::format::dem::Georeference;
use orogen_noise::Points;
use orogen_output::mesh::quantized::{CELLS, QuantizedTile, SIDE};

/// The error of a mesh at zoom 0 in metres; it is half as much at each further zoom. Cesium expects four times as much
/// of tiles of heights with 65 samples a side.
const ERROR_0: f64 = EQUATOR * 0.25 / (65.0 * 2.0) / 4.0;

/// Heights of a zoom are multiples of a power of two, of at most 2^0 and at least 2^-10 metres.
const STEPS: [f64; 2] = [1.0 / 1024.0, 1.0];

/// The largest height difference in a tile without a larger step, as a multiple of the tile's side.
const STEEPEST: f64 = 2.0;

/// Number of samples around a position that the interpolation reads on each side.
const AROUND: usize = 2;

/// Bytes for making a tile, beside the samples of its window.
pub const SCRATCH: u64 = 16 << 20;

/// The position of a tile: its zoom, its column from the west and its row from the south.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct MeshAddress {
    /// The zoom.
    pub zoom: u32,
    /// The column, 0 to 2^(zoom + 1) - 1.
    pub column: u64,
    /// The row, 0 to 2^zoom - 1.
    pub row: u64,
}

/// What tiles have beside their mesh.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Extensions {
    /// Normals of the vertices, `octvertexnormals`.
    pub normals: bool,
    /// The text of `metadata`, JSON.
    pub metadata: Option<String>,
}

/// The side of a tile, in degrees.
fn side(zoom: u32) -> f64 {
    180.0 / f64::from(1u32 << zoom.min(31))
}

/// The maximum error of the meshes of a zoom, in metres.
#[must_use]
pub fn max_error(zoom: u32) -> f64 {
    ERROR_0 / f64::from(1u32 << zoom.min(31))
}

/// The step of the heights of a zoom, in metres.
#[must_use]
pub fn step(zoom: u32) -> f64 {
    let metres = side(zoom) / 360.0 * EQUATOR;
    let (least, mut step) = (STEEPEST * metres / 32_767.0, STEPS[1]);
    while step / 2.0 >= least.max(STEPS[0]) {
        step /= 2.0;
    }
    step
}

/// The tiles of a world.
pub struct MeshTiles<'a> {
    world: &'a World,
    frame: Frame,
}

/// How degrees become positions in the world.
enum Frame {
    /// Metres of the world from its origin are metres on the equator.
    Local,
    /// The world is in degrees.
    Degrees(Georeference),
    /// The world is in Web Mercator.
    Mercator(Georeference),
}

impl<'a> MeshTiles<'a> {
    /// The tiles of a world.
    #[must_use]
    pub fn new(world: &'a World) -> MeshTiles<'a> {
        let map = world.recipe().georeference();
        let frame = match map {
            Some(map) if web_map(Some(&map)).is_some() => Frame::Mercator(map),
            Some(map) if map.is_degrees() => Frame::Degrees(map),
            _ => Frame::Local,
        };
        MeshTiles { world, frame }
    }

    /// Whether the world is at its real position.
    #[must_use]
    pub fn is_real(&self) -> bool {
        !matches!(self.frame, Frame::Local)
    }

    /// The columns or rows of a zoom that have a part of the world, first and last: from the west, and from the south.
    #[must_use]
    pub fn tiles(&self, zoom: u32) -> [[u64; 2]; 2] {
        let whole = [2, 1].map(|tiles: u64| [0, (tiles << zoom) - 1]);
        let Some([width, height]) = self.world.recipe().world.size else { return whole };
        let ([west, north], [east, south]) = (self.degrees([0.0, 0.0]), self.degrees([width, height]));
        let span = |axis: usize, low: f64, high: f64, start: f64| {
            let [first, last] = whole[axis];
            let cell = |at: f64| ((at - start) / side(zoom)).clamp(first as f64, last as f64);
            let (low, high) = (cell(low).floor() as u64, cell(high).ceil() as u64);
            [low, high.saturating_sub(1).clamp(low, last)]
        };
        [span(0, west, east, -180.0), span(1, south, north, -90.0)]
    }

    /// Whether there is a tile: it has a part of the world, or it is one of zoom 0, which globes always request.
    #[must_use]
    pub fn has(&self, at: MeshAddress) -> bool {
        let [columns, rows] = self.tiles(at.zoom);
        let is_there = (columns[0]..=columns[1]).contains(&at.column) && (rows[0]..=rows[1]).contains(&at.row);
        is_there || at.zoom == 0 && at.column < 2 && at.row == 0
    }

    /// West, south, east and north of the world in degrees.
    #[must_use]
    pub fn bounds(&self) -> [f64; 4] {
        let Some([width, height]) = self.world.recipe().world.size else { return [-180.0, -90.0, 180.0, 90.0] };
        let ([west, north], [east, south]) = (self.degrees([0.0, 0.0]), self.degrees([width, height]));
        [west.max(-180.0), south.max(-90.0), east.min(180.0), north.min(90.0)]
    }

    /// Degrees east and north of a position in metres of the world.
    fn degrees(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        match &self.frame {
            Frame::Local => [x, 0.0 - y].map(|metres| metres / EQUATOR * 360.0),
            Frame::Degrees(map) => map.at(x, y),
            Frame::Mercator(map) => {
                let [east, north] = map.at(x, y).map(|metres| metres / EQUATOR * std::f64::consts::TAU);
                [east, libm::atan(libm::sinh(north))].map(f64::to_degrees)
            }
        }
    }

    /// The position in metres of the world of a longitude (axis 0) or a latitude (axis 1). `cell` is the distance of
    /// samples at this zoom, of which the position is the `n`-th from the origin in a local frame.
    fn position(&self, axis: usize, degrees: f64, n: i64, cell: f64) -> f64 {
        match &self.frame {
            // A multiple of the cell is a sample, bit for bit.
            Frame::Local => n as f64 * cell,
            Frame::Degrees(map) => map.metres(degrees, degrees)[axis],
            Frame::Mercator(map) => {
                let metres = |radians: f64| radians / std::f64::consts::TAU * EQUATOR;
                let half = degrees.clamp(-89.99, 89.99).to_radians() / 2.0;
                let north = libm::log(libm::tan(std::f64::consts::FRAC_PI_4 + half));
                map.metres(metres(degrees.to_radians()), metres(north))[axis]
            }
        }
    }

    /// The distance of samples from which the tiles of a zoom are made, in metres of the world.
    fn cell(&self, zoom: u32) -> f64 {
        let per_metre = match &self.frame {
            Frame::Local => 1.0,
            Frame::Degrees(map) => map.per_metre[0] * EQUATOR / 360.0,
            Frame::Mercator(map) => map.per_metre[0],
        };
        side(zoom) / 360.0 * EQUATOR / CELLS as f64 / per_metre
    }

    /// The bytes of a tile.
    ///
    /// # Errors
    /// If there is no such tile, the world has no heights, or the work is cancelled.
    pub fn tile(&self, at: MeshAddress, extensions: &Extensions, progress: &Progress) -> Result<Vec<u8>> {
        if at.zoom > MAX_ZOOM || !self.has(at) {
            return Err(Error::new(ErrorKind::Request, "the world has no such tile"));
        }
        let (MeshAddress { zoom, column, row }, cells) = (at, CELLS as i64);
        let rows = 1i64 << zoom;
        // The first column and row of the tile, from the origin of degrees; rows count south.
        let first = [column as i64 * cells - rows * cells, (rows - 1 - row as i64) * cells - rows * cells / 2];
        let (own, spacing) = (self.cell(zoom), side(zoom) / CELLS as f64);
        let [xs, ys]: [Vec<f64>; 2] = [0, 1].map(|axis| {
            let most = self.world.recipe().world.size.map_or(f64::INFINITY, |size| size[axis]);
            let least = if most.is_finite() { 0.0 } else { f64::NEG_INFINITY };
            let sign = if axis == 0 { 1.0 } else { -1.0 };
            let cell = |k: i64| {
                let n = first[axis] + k - 1;
                self.position(axis, sign * n as f64 * spacing, n, own).clamp(least, most)
            };
            (0..SIDE as i64).map(cell).collect()
        });
        // A world that is smaller than a few cells is read at a smaller cell.
        let mut cell = own;
        if let Some([width, height]) = self.world.recipe().world.size {
            while cell * 4.0 > width.min(height) {
                cell /= 2.0;
            }
        }
        let window = self.world.surroundings(&window(&xs, &ys, cell), AROUND);
        let grid = self.world.grids(&[HEIGHT], &window, progress)?.pop();
        let grid = grid.ok_or_else(|| Error::new(ErrorKind::Request, "the world has no heights"))?;
        let mut samples = vec![0.0; SIDE * SIDE];
        resample::read(&grid, LayerKind::Height, &Points::Lattice { xs: &xs, ys: &ys }, &mut samples);
        drop(grid);
        let sea_level = self.world.recipe().world.sea_level as f32;
        samples.iter_mut().filter(|sample| !sample.is_finite()).for_each(|sample| *sample = sea_level);
        let [west, north] = [first[0] as f64 * spacing, 0.0 - first[1] as f64 * spacing];
        let tile = QuantizedTile {
            bounds: [west, north - side(zoom), west + side(zoom), north],
            samples: &samples,
            max_error: max_error(zoom),
            step: step(zoom),
            has_normals: extensions.normals,
            metadata: extensions.metadata.as_deref(),
        };
        tile.to_bytes(progress)
    }
}

/// The window with the samples around these positions.
fn window(xs: &[f64], ys: &[f64], cell: f64) -> Window {
    let span = |positions: &[f64]| {
        let low = positions.iter().copied().fold(f64::INFINITY, f64::min);
        let high = positions.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let (first, last) = ((low / cell).floor() as i64, (high / cell).ceil() as i64);
        (first, (last - first) as usize + 1)
    };
    let ((x, width), (y, height)) = (span(xs), span(ys));
    Window::new(width, height, cell).at(x, y)
}

#[cfg(test)]
mod tests {
    use super::*;
    use orogen_engine::recipe::document::Recipe;

    fn world(text: &str) -> World {
        let text = format!(
            "orogen = 1\n[world]\n{text}\n[nodes.a]\nop = \"fbm\"\nwavelength = 900\n[nodes.b]\nop = \"multiply\"\na = \"a\"\nb = 200\n[outputs]\nheight = \"b\"\n"
        );
        World::open(Recipe::parse(&text, "test").unwrap()).unwrap()
    }

    #[test]
    fn errors_and_steps_are_halved_from_zoom_to_zoom() {
        assert!((max_error(0) - 77_067.34 / 4.0).abs() < 0.01);
        assert_eq!(max_error(14), max_error(0) / 16_384.0);
        assert_eq!((step(0), step(14), step(15), step(24)), (1.0, 0.125, 0.0625, 1.0 / 1024.0));
        // The step takes a small part of the error.
        assert!((0..=16).all(|zoom| step(zoom) / 2.0 < max_error(zoom) / 8.0));
    }

    #[test]
    fn a_world_without_a_map_is_south_east_of_0_degrees() {
        let world = world("size = [5120, 2560]\ncell = 10");
        let tiles = MeshTiles::new(&world);
        assert_eq!((tiles.tiles(0), tiles.tiles(1)), ([[1, 1], [0, 0]], [[2, 2], [0, 0]]));
        // At zoom 14 a tile has 1223 m.
        assert_eq!(tiles.tiles(14), [[16_384, 16_388], [8189, 8191]]);
        let [west, south, east, north] = tiles.bounds();
        assert_eq!((west, north), (0.0, 0.0));
        assert!((east - 0.04599).abs() < 1e-5 && (south + 0.022997).abs() < 1e-5);
        let at = |zoom, column, row| tiles.has(MeshAddress { zoom, column, row });
        assert!(at(0, 0, 0) && at(0, 1, 0) && at(14, 16_384, 8191) && !at(14, 16_383, 8191) && !at(14, 16_384, 8192));
        assert!(!tiles.is_real());
        for (zoom, column, row) in [(0, 0, 0), (0, 1, 0), (5, 32, 15), (14, 16_386, 8190)] {
            let address = MeshAddress { zoom, column, row };
            assert!(
                tiles.tile(address, &Extensions { normals: true, metadata: None }, &Progress::none()).unwrap().len()
                    > 100,
                "{address:?}"
            );
        }
        let refused =
            tiles.tile(MeshAddress { zoom: 14, column: 0, row: 0 }, &Extensions::default(), &Progress::none());
        assert!(refused.unwrap_err().to_string().contains("no such tile"));
    }

    #[test]
    fn worlds_on_a_map_are_at_their_place() {
        let degrees = world("size = [11120, 11120]\ncell = 10\ncrs = \"EPSG:4326\"\norigin = [11, 47]");
        let mercator = world("size = [5120, 2560]\ncell = 10\ncrs = \"EPSG:3857\"\norigin = [1300003, 6100007]");
        for (world, west, north) in [(degrees, 11.0, 47.0), (mercator, 11.67813, 47.95882)] {
            let tiles = MeshTiles::new(&world);
            let bounds = tiles.bounds();
            assert!((bounds[0] - west).abs() < 1e-5 && (bounds[3] - north).abs() < 1e-5, "{bounds:?}");
            assert!(tiles.is_real());
            let [columns, rows] = tiles.tiles(13);
            let address = MeshAddress { zoom: 13, column: columns[0], row: rows[1] };
            assert!(tiles.tile(address, &Extensions::default(), &Progress::none()).unwrap().len() > 1000);
        }
    }
}
