//! A digital elevation model read from a file: heights and their position.

use super::affine::Affine;
use super::crs::keys::{self, GeoKeys};
use super::crs::registry::Crs;
use super::crs::unit::Unit;
use crate::samples;
use orogen_grid::error::{Error, ErrorKind};
use orogen_grid::grid::Window;
use serde::{Deserialize, Serialize};

pub use super::input::{Input, afford, afford_beside, length, turn_rows};

/// Options of a reader.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub struct Request {
    /// The band to read, from 1; `None` requires that there is only one.
    pub band: Option<u32>,
    /// Maximum size of the heights, in bytes.
    pub allowed: u64,
    /// The part to read; `None` for all. Files that cannot be [read in parts](super::import::reads_parts) are read
    /// whole and then cropped.
    #[doc(hidden)]
    pub part: Option<Part>,
}

/// A rectangle of a raster's samples, counted from its north-west corner.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Part {
    /// The first column and row.
    pub from: [usize; 2],
    /// Number of columns and rows.
    pub size: [usize; 2],
}

impl Part {
    /// All samples of a raster.
    #[must_use]
    pub const fn whole(size: [usize; 2]) -> Part {
        Part { from: [0; 2], size }
    }

    /// The column and row after the last.
    #[must_use]
    pub fn end(&self) -> [usize; 2] {
        [self.from[0] + self.size[0], self.from[1] + self.size[1]]
    }

    /// Whether the part is not empty and lies within a raster of this size.
    #[must_use]
    pub fn is_within(&self, size: [usize; 2]) -> bool {
        (0..2).all(|k| self.size[k] > 0 && self.from[k].checked_add(self.size[k]).is_some_and(|end| end <= size[k]))
    }

    /// The same samples with rows counted from the south of a raster with `height` rows.
    #[must_use]
    pub fn from_south(self, height: usize) -> Part {
        Part { from: [self.from[0], height - self.end()[1]], ..self }
    }
}

impl From<u64> for Request {
    fn from(allowed: u64) -> Request {
        Request::new(allowed)
    }
}

orogen_noise::builder!(Request: with_band(band: Option<u32>), with_allowed(allowed: u64), with_part(part: Option<Part>));

impl Request {
    /// A request for the heights of a file with one band, up to this many bytes.
    #[must_use]
    pub const fn new(allowed: u64) -> Request {
        Request { band: None, allowed, part: None }
    }

    /// The index, from 0, of the band to read among `bands`.
    ///
    /// # Errors
    /// A message if the file does not have the band, or has several and none was chosen.
    pub fn choose(&self, bands: usize) -> Result<usize, String> {
        match self.band {
            Some(band) if band >= 1 && band as usize <= bands => Ok(band as usize - 1),
            Some(band) if bands == 1 => Err(format!("it has one band, not a band {band}")),
            Some(band) => Err(format!("it has {bands} bands, not a band {band}")),
            None if bands == 1 => Ok(0),
            None => Err(format!(
                "it has {bands} bands; choose one with `band = 1` in the node, or with FILE:1 on the command line"
            )),
        }
    }
}

/// Heights of a real place.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Dem {
    /// Samples per row.
    pub width: usize,
    /// Number of rows.
    pub height: usize,
    /// Heights in metres, row-major from the north, each row from west to east; NaN where the file has no height.
    pub heights: Vec<f32>,
    /// The position, if the file states it.
    pub place: Option<Placement>,
    /// Messages about conversions, and about content that could not be read.
    pub notes: Vec<String>,
}

/// The position of samples on a map.
#[derive(Debug, Clone, PartialEq)]
pub struct Placement {
    /// East and north of the first sample, which is the center of its pixel if the file treats pixels as areas.
    pub origin: [f64; 2],
    /// Distance between columns eastward and between rows southward; both positive.
    pub step: [f64; 2],
    /// The unit of origin and steps.
    pub unit: Unit,
    /// Distance between samples in metres, along both axes, if a sidecar of a file in degrees states it.
    pub cell: Option<f64>,
    /// The coordinate system as GeoTIFF keys, which exports keep.
    pub keys: Option<GeoKeys>,
}

/// The position of a lattice on a map.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Georeference {
    /// East and north of the lattice's origin, in map units.
    pub origin: [f64; 2],
    /// Map units per metre of the lattice, east and north.
    pub per_metre: [f64; 2],
    /// GeoTIFF keys of the coordinate system.
    pub keys: Option<GeoKeys>,
}

impl Georeference {
    /// That of a world without a map: metres east and north of its north-west corner.
    pub const LOCAL: Georeference = Georeference { origin: [0.0; 2], per_metre: [1.0; 2], keys: None };

    /// East and north, in map units, of a position in metres of the lattice.
    #[must_use]
    pub fn at(&self, x: f64, y: f64) -> [f64; 2] {
        [self.origin[0] + x * self.per_metre[0], self.origin[1] - y * self.per_metre[1]]
    }

    /// Metres of the lattice, east and south, of a position in map units.
    #[must_use]
    pub fn metres(&self, east: f64, north: f64) -> [f64; 2] {
        [(east - self.origin[0]) / self.per_metre[0], (self.origin[1] - north) / self.per_metre[1]]
    }

    /// The same map for a lattice in which the origin of this one is at (x, y), in metres east and south.
    #[must_use]
    pub fn moved(&self, x: f64, y: f64) -> Georeference {
        Georeference { origin: self.at(-x, -y), ..self.clone() }
    }

    /// The EPSG code of the coordinate system, if its keys have one.
    #[must_use]
    pub fn epsg(&self) -> Option<u16> {
        keys::epsg(self.keys.as_ref()?)
    }

    /// Whether the keys describe a coordinate system on Earth.
    pub fn is_on_map(&self) -> bool {
        self.keys.as_ref().is_some_and(keys::is_named)
    }

    /// Whether the units are so long that they can only be degrees, whatever the keys state.
    #[must_use]
    pub fn counts_degrees(&self) -> bool {
        self.per_metre[0] < 1e-3
    }

    /// Whether the units are consistent with a coordinate system.
    #[must_use]
    pub fn fits(&self, crs: &Crs) -> bool {
        match crs.unit() {
            Unit::Degrees | Unit::Grads => self.counts_degrees(),
            Unit::Metres(unit) => unit == 1.0 && !self.counts_degrees(),
        }
    }

    /// The unit of the coordinates; `None` if the keys do not state it.
    #[must_use]
    pub fn unit(&self) -> Option<Unit> {
        keys::unit(self.keys.as_ref()?).ok()
    }

    /// Whether the coordinates are degrees of longitude and latitude.
    #[must_use]
    pub fn is_degrees(&self) -> bool {
        self.unit() == Some(Unit::Degrees)
    }

    /// The transform from columns and rows of a window to coordinates; rows start in the south if `from_south`.
    #[must_use]
    pub fn affine(&self, window: &Window, from_south: bool) -> Affine {
        let ([east, north], [across, down]) = self.of(window);
        let south = north - down * (window.height.max(1) - 1) as f64;
        match from_south {
            true => Affine([across, 0.0, east, 0.0, down, south]),
            false => Affine([across, 0.0, east, 0.0, -down, north]),
        }
    }

    /// The coordinate system as well-known text, as `.prj` files hold it.
    ///
    /// # Errors
    /// A message that names the part that cannot be expressed.
    pub fn wkt(&self) -> Result<String, String> {
        match &self.keys {
            Some(keys) => keys::to_wkt(keys),
            None => Err("the input has none".into()),
        }
    }

    /// The coordinates of the first sample of a window, and the distances between its samples, in map units.
    #[must_use]
    pub fn of(&self, window: &Window) -> ([f64; 2], [f64; 2]) {
        (self.at(window.east(0), window.south(0)), self.per_metre.map(|unit| unit * window.cell))
    }
}

impl Dem {
    /// A DEM of the samples that were read; missing ones become NaN.
    ///
    /// # Errors
    /// If no sample has a height.
    pub fn new(size: [usize; 2], heights: Vec<f32>, place: Option<Placement>) -> Result<Dem, String> {
        match Dem::checked(size, heights, place) {
            (dem, true) => Ok(dem),
            (_, false) => Err(format!("all of its {} x {} samples are nodata", size[0], size[1])),
        }
    }

    /// A part of a raster, which may have no height at all; `place` is the position of the whole raster.
    #[must_use]
    pub fn part(part: Part, heights: Vec<f32>, place: Option<Placement>) -> Dem {
        let place = place.map(|mut place| {
            place.origin[0] += part.from[0] as f64 * place.step[0];
            place.origin[1] -= part.from[1] as f64 * place.step[1];
            place
        });
        Dem::checked(part.size, heights, place).0
    }

    /// A part of a whole raster.
    ///
    /// # Errors
    /// A message if the part is not within it.
    pub fn cropped(self, part: Part) -> Result<Dem, String> {
        if !part.is_within([self.width, self.height]) {
            return Err(beyond([self.width, self.height]));
        }
        let ([left, top], [width, height]) = (part.from, part.size);
        let mut heights = Vec::with_capacity(width * height);
        for row in self.heights.chunks_exact(self.width).skip(top).take(height) {
            heights.extend_from_slice(&row[left..left + width]);
        }
        Ok(Dem { notes: self.notes, ..Dem::part(part, heights, self.place) })
    }

    /// A DEM of the samples that were read, and whether it has any height.
    fn checked(size: [usize; 2], mut heights: Vec<f32>, place: Option<Placement>) -> (Dem, bool) {
        let [width, height] = size;
        let found = samples::keep_heights(&mut heights);
        (Dem { width, height, heights, place, notes: Vec::new() }, found)
    }

    /// Number of samples without a height.
    #[must_use]
    pub fn missing(&self) -> usize {
        samples::missing(&self.heights)
    }
}

/// An error that rejects a file, with the file's name.
pub fn refused(name: &str, why: impl AsRef<str>) -> Error {
    Error::new(ErrorKind::File, format!("cannot read {name}: {}", why.as_ref()))
}

/// The message for a part that is outside a raster.
pub(super) fn beyond(size: [usize; 2]) -> String {
    format!("it has {} x {} samples, and others were asked for", size[0], size[1])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_no_height_is_missing() {
        let dem = Dem::new([4, 1], vec![1.0, f32::INFINITY, f32::MIN, f32::NAN], None).unwrap();
        assert_eq!((dem.missing(), dem.heights[0]), (3, 1.0));
        let why = Dem::new([2, 1], vec![f32::NAN; 2], None).unwrap_err();
        assert!(why.contains("2 x 1 samples are nodata"), "{why}");
    }
}
