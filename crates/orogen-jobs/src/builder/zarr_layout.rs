//! What a Zarr group has: the metadata of the group and its arrays, and the bytes of chunks. Builds write all of it to
//! files; servers make the parts that are requested.

use serde_json::{Value, json};

use super::samples::square;
use orogen_engine::tiles::Tiling;
use orogen_grid::error::{Error, ErrorKind, Result};
use orogen_grid::grid::{Grid, Window};
use orogen_io::format::dem::Georeference;
use orogen_io::format::zarr::blosc;
use orogen_io::format::zarr::metadata::{self, Array, Number};
use orogen_io::samples::to_bytes;

/// Maximum number of coordinates per chunk.
const COORDINATES: usize = 1 << 16;

/// Maximum side of a chunk; with larger chunks readers run out of memory.
const LARGEST: usize = 8192;

/// Names of the coordinate arrays.
const SIDES: [&str; 2] = ["x", "y"];

/// The layout of a group with one array per layer, and one chunk per tile.
#[derive(Debug, Clone)]
pub struct ZarrLayout {
    /// The description of the world, or empty.
    pub about: String,
    /// SHA-256 over the nodes of the layers, in hexadecimal digits.
    pub recipe: String,
    /// The layers and their units, which may be empty.
    pub layers: Vec<(String, String)>,
    /// The window.
    pub window: Window,
    /// Side of a chunk, in samples.
    pub tile: usize,
    /// The position of metres on a map, if the world has one.
    pub map: Option<Georeference>,
}

impl ZarrLayout {
    /// Checks that a chunk can have this side.
    ///
    /// # Errors
    /// If it cannot.
    pub fn check(&self) -> Result<()> {
        if (1..=LARGEST).contains(&self.tile) {
            return Ok(());
        }
        let message = format!("the tiles of a .zarr must have 1 to {LARGEST} samples per side, not {}", self.tile);
        Err(Error::new(ErrorKind::Request, message))
    }

    /// Number of chunks of a layer, across and down.
    #[must_use]
    pub fn chunks(&self) -> [usize; 2] {
        Tiling::of(self.tile).layout(&self.window)
    }

    /// The window of a chunk.
    #[must_use]
    pub fn chunk_window(&self, row: usize, column: usize) -> Window {
        Tiling::of(self.tile).tile(&self.window, column, row)
    }

    /// The bytes of a chunk with these samples.
    ///
    /// # Errors
    /// If the chunk is too large.
    pub fn chunk(&self, grid: &Grid) -> Result<Vec<u8>> {
        pack(&to_bytes(&square(grid, self.tile, f32::NAN)), 4)
    }

    /// Maximum memory for making a chunk, beside its samples: the padded chunk, its bytes, the shuffled bytes, and the
    /// compressed ones.
    #[must_use]
    pub fn scratch_memory(&self) -> u64 {
        16 * (self.tile * self.tile) as u64
    }

    /// All arrays by name: coordinates, then layers.
    #[must_use]
    pub fn arrays(&self) -> Vec<(String, Value)> {
        let coordinates = [0, 1].map(|axis| (SIDES[axis].to_string(), self.coordinate_array(axis)));
        let layers = self.layers.iter().map(|(layer, unit)| (layer.clone(), self.array(layer, unit)));
        coordinates.into_iter().chain(layers).collect()
    }

    /// The metadata of the group.
    #[must_use]
    pub fn group(&self) -> Value {
        let attributes = json!({
            "title": self.about,
            "source": format!("Orogen {}", env!("CARGO_PKG_VERSION")),
            "recipe_sha256": self.recipe,
            "cell": self.window.cell,
        });
        metadata::group(&self.arrays(), attributes)
    }

    /// The metadata of a layer's array.
    fn array(&self, layer: &str, unit: &str) -> Value {
        let (Window { width, height, .. }, side) = (self.window, self.tile);
        let mut attributes = json!({ "long_name": layer });
        if !unit.is_empty() {
            attributes["units"] = json!(unit);
        }
        // The attributes that GDAL reads, and those that xarray's extensions read.
        if let Some(map) = &self.map {
            if let Some(code) = map.epsg() {
                attributes["_CRS"] = json!({ "url": format!("http://www.opengis.net/def/crs/EPSG/0/{code}") });
            }
            if let Ok(wkt) = map.wkt() {
                attributes["crs_wkt"] = json!(wkt);
            }
        }
        metadata::array(&Array {
            shape: &[height, width],
            chunk: &[side, side],
            sides: &["y", "x"],
            number: Number::F32,
            attributes,
        })
    }

    /// The axis of a coordinate array: 0 for `x`, 1 for `y`.
    #[must_use]
    pub fn axis(name: &str) -> Option<usize> {
        SIDES.iter().position(|side| *side == name)
    }

    /// The name of an axis' coordinate array.
    #[must_use]
    pub fn axis_name(axis: usize) -> &'static str {
        SIDES[axis]
    }

    /// Number of coordinates of an axis.
    #[must_use]
    pub fn length(&self, axis: usize) -> usize {
        if axis == 0 { self.window.width } else { self.window.height }
    }

    /// Number of chunks of an axis' coordinates.
    #[must_use]
    pub fn coordinate_chunks(&self, axis: usize) -> usize {
        self.length(axis).div_ceil(COORDINATES)
    }

    /// The bytes of a chunk of coordinates.
    ///
    /// # Errors
    /// If the chunk is too large.
    pub fn coordinate_chunk(&self, axis: usize, chunk: usize) -> Result<Vec<u8>> {
        let (first, count) = (chunk * COORDINATES, self.length(axis).min(COORDINATES));
        let inside = self.length(axis).saturating_sub(first).min(count);
        let Window { x, y, cell, .. } = self.window;
        let values = match axis {
            0 => eastings(&Window::new(inside, 1, cell).at(x + first as i64, y), self.map.as_ref()),
            _ => northings(&Window::new(1, inside, cell).at(x, y + first as i64), self.map.as_ref()),
        };
        // Chunks are complete; values beyond the side are never read.
        let beyond = std::iter::repeat_n(0.0, count - inside);
        pack(&values.into_iter().chain(beyond).flat_map(f64::to_le_bytes).collect::<Vec<u8>>(), 8)
    }

    /// The metadata of a coordinate array.
    fn coordinate_array(&self, axis: usize) -> Value {
        let degrees = self.map.as_ref().map(Georeference::is_degrees);
        let [unit, long, standard] = match (axis, degrees) {
            (0, None) => ["m", "metres east of the origin", "projection_x_coordinate"],
            (_, None) => ["m", "metres north of the origin", "projection_y_coordinate"],
            (0, Some(true)) => ["degrees_east", "longitude", "longitude"],
            (_, Some(true)) => ["degrees_north", "latitude", "latitude"],
            (0, Some(false)) => ["m", "easting", "projection_x_coordinate"],
            (_, Some(false)) => ["m", "northing", "projection_y_coordinate"],
        };
        let letter = if axis == 0 { "X" } else { "Y" };
        metadata::array(&Array {
            shape: &[self.length(axis)],
            chunk: &[self.length(axis).min(COORDINATES)],
            sides: &[SIDES[axis]],
            number: Number::F64,
            attributes: json!({ "units": unit, "long_name": long, "standard_name": standard, "axis": letter }),
        })
    }

    /// Maximum bytes of all chunks of coordinates.
    #[must_use]
    pub fn coordinate_bytes(&self) -> u64 {
        8 * (self.window.width + self.window.height + 2 * COORDINATES) as u64
    }
}

/// The coordinates of a window's columns.
fn eastings(window: &Window, map: Option<&Georeference>) -> Vec<f64> {
    let eastings = window.eastings();
    match map {
        Some(map) => eastings.iter().map(|x| map.at(*x, 0.0)[0]).collect(),
        None => eastings,
    }
}

/// The coordinates of a window's rows.
fn northings(window: &Window, map: Option<&Georeference>) -> Vec<f64> {
    // Subtraction from 0.0 avoids a -0.
    let northings = window.southings().into_iter().map(|south| 0.0 - south);
    match map {
        Some(map) => northings.map(|north| map.at(0.0, -north)[1]).collect(),
        None => northings.collect(),
    }
}

/// A chunk of encoded numbers.
fn pack(bytes: &[u8], size: u8) -> Result<Vec<u8>> {
    blosc::pack(bytes, size)
        .ok_or_else(|| Error::new(ErrorKind::Request, "a chunk would be larger than 2 GiB; use smaller tiles"))
}
