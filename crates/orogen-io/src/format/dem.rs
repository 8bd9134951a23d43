//! A digital elevation model as a file holds it: heights, and where they stand.

use std::io::{Read, Seek};

use super::affine::Affine;
use super::crs::keys::{self, GeoKeys};
use super::crs::registry::Crs;
use super::crs::unit::Unit;
use orogen_grid::error::{Error, ErrorKind};
use orogen_grid::grid::Window;
use orogen_grid::words::bytes;
use serde::{Deserialize, Serialize};

/// What readers read from: a file, or bytes in memory.
pub trait Input: Read + Seek {}

impl<T: Read + Seek> Input for T {}

/// What is asked of a reader.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Request {
    /// The band to read, from 1; `None` is the only one.
    pub band: Option<u32>,
    /// Most bytes of the heights.
    pub allowed: u64,
}

impl From<u64> for Request {
    fn from(allowed: u64) -> Request {
        Request { band: None, allowed }
    }
}

impl Request {
    /// Which of so many bands is read, from 0.
    ///
    /// # Errors
    /// A message if it has no such band, or several and none was chosen.
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
pub struct Dem {
    /// Samples a row.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// Metres, row after row from the north, each from west to east; NaN where the file has no height.
    pub heights: Vec<f32>,
    /// Where they stand, if the file says so.
    pub place: Option<Placement>,
    /// What was done to it and what could not be read, in messages.
    pub notes: Vec<String>,
}

/// Where samples stand on a map.
#[derive(Debug, Clone, PartialEq)]
pub struct Placement {
    /// East and north of the first sample itself: of the middle of its pixel, where the file speaks of pixels as areas.
    pub origin: [f64; 2],
    /// From a column to the next one east, and from a row to the next one south: both above 0.
    pub step: [f64; 2],
    /// What origin and steps are measured in.
    pub unit: Unit,
    /// Metres between samples either way, where something beside a file in degrees says so.
    pub cell: Option<f64>,
    /// The coordinate system as a GeoTIFF tells it; kept on the way out.
    pub keys: Option<GeoKeys>,
}

/// How a lattice lies on a map.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Georeference {
    /// East and north of the lattice's origin, in the map's own unit.
    pub origin: [f64; 2],
    /// The map's units in a metre of the lattice, east and north.
    pub per_metre: [f64; 2],
    /// What a GeoTIFF says of its coordinates.
    pub keys: Option<GeoKeys>,
}

impl Georeference {
    /// East and north of a position in metres of the lattice, in the map's unit.
    pub fn at(&self, x: f64, y: f64) -> [f64; 2] {
        [self.origin[0] + x * self.per_metre[0], self.origin[1] - y * self.per_metre[1]]
    }

    /// The same map, the lattice's origin moved to a position of a world.
    pub fn moved(&self, x: f64, y: f64) -> Georeference {
        Georeference { origin: self.at(-x, -y), ..self.clone() }
    }

    /// The EPSG code of its coordinate system, if its keys tell one.
    pub fn epsg(&self) -> Option<u16> {
        keys::epsg(self.keys.as_ref()?)
    }

    /// Whether its keys tell a coordinate system of the Earth: not none, and not local ones.
    pub fn is_on_map(&self) -> bool {
        self.keys.as_ref().is_some_and(keys::is_named)
    }

    /// Whether its units are so long that they can only be degrees, whatever its keys tell.
    pub fn counts_degrees(&self) -> bool {
        self.per_metre[0] < 1e-3
    }

    /// Whether its units can be those of a coordinate system.
    pub fn fits(&self, crs: &Crs) -> bool {
        match crs.unit() {
            Unit::Degrees => self.counts_degrees(),
            Unit::Metres(unit) => unit == 1.0 && !self.counts_degrees(),
        }
    }

    /// Whether its coordinates are degrees of longitude and latitude.
    pub fn is_degrees(&self) -> bool {
        self.keys.as_ref().is_some_and(keys::is_degrees)
    }

    /// How the columns and rows of a window become coordinates; its rows from the south if the file's are.
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
    /// A message that says what could not be expressed.
    pub fn wkt(&self) -> Result<String, String> {
        match &self.keys {
            Some(keys) => keys::to_wkt(keys),
            None => Err("the input has none".into()),
        }
    }

    /// How the first sample of a window lies, and the steps between its samples, in the map's unit.
    pub fn of(&self, window: &Window) -> ([f64; 2], [f64; 2]) {
        (self.at(window.east(0), window.south(0)), self.per_metre.map(|unit| unit * window.cell))
    }
}

/// Heights beyond this are no heights: some programs write the largest float where they have none.
const HIGHEST: f32 = 1e30;

impl Dem {
    /// A DEM of samples read, its missing ones made NaN.
    ///
    /// # Errors
    /// If there is no height among them.
    pub fn new(size: [usize; 2], mut heights: Vec<f32>, place: Option<Placement>) -> Result<Dem, String> {
        let [width, height] = size;
        let mut found = false;
        for sample in &mut heights {
            if sample.abs() < HIGHEST {
                found = true;
            } else {
                *sample = f32::NAN;
            }
        }
        match found {
            true => Ok(Dem { width, height, heights, place, notes: Vec::new() }),
            false => Err(format!("all of its {width} x {height} samples are nodata")),
        }
    }

    /// How many samples have no height.
    pub fn missing(&self) -> usize {
        self.heights.iter().filter(|height| height.is_nan()).count()
    }
}

/// What is refused, in one message that names the file.
pub fn refused(name: &str, why: impl AsRef<str>) -> Error {
    Error::new(ErrorKind::File, format!("cannot read {name}: {}", why.as_ref()))
}

/// Checks that heights of this size can be held in `allowed` bytes, before any is.
///
/// # Errors
/// A message with both figures.
pub fn afford(width: u64, height: u64, allowed: u64) -> Result<usize, String> {
    if width == 0 || height == 0 {
        return Err(format!("its header declares {width} x {height} samples, which is empty"));
    }
    let needed = width.saturating_mul(height).saturating_mul(4);
    match needed > allowed || needed > isize::MAX as u64 {
        true => Err(format!(
            "its {width} x {height} samples need {} of memory, and {} is allowed; cut out a part of it, or raise the memory limit",
            bytes(needed),
            bytes(allowed)
        )),
        false => Ok((width * height) as usize),
    }
}

/// Bytes that a reader's buffers may take uncounted.
const BUFFER: u64 = 4 << 20;

/// Checks that `beside` bytes more, which a reader holds while it unpacks them, can be held with `count` heights in `allowed` bytes.
///
/// # Errors
/// A message with both figures.
pub fn afford_beside(count: usize, beside: u64, allowed: u64) -> Result<(), String> {
    let needed = (count as u64).saturating_mul(4).saturating_add(beside);
    match beside > BUFFER && needed > allowed {
        true => Err(format!(
            "reading it needs {} of memory for its heights and one decompressed block, and {} is allowed; save it with smaller blocks, or raise the memory limit",
            bytes(needed),
            bytes(allowed)
        )),
        false => Ok(()),
    }
}

/// Samples row after row from the other end, in place.
pub fn turn_rows(samples: &mut [f32], width: usize) {
    let rows = samples.len().checked_div(width).unwrap_or(0);
    for j in 0..rows / 2 {
        let (upper, lower) = samples.split_at_mut((rows - 1 - j) * width);
        upper[j * width..(j + 1) * width].swap_with_slice(&mut lower[..width]);
    }
}

/// How long an input is; it stands at its beginning afterwards.
pub fn length(input: &mut dyn Input) -> Result<u64, String> {
    let length = input.seek(std::io::SeekFrom::End(0)).map_err(|cause| cause.to_string())?;
    input.rewind().map_err(|cause| cause.to_string())?;
    Ok(length)
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

    #[test]
    fn sizes_are_known_before_memory_is_taken() {
        assert_eq!(afford(1 << 10, 1 << 10, 1 << 22), Ok(1 << 20));
        let why = afford(1 << 16, 1 << 16, 1 << 30).unwrap_err();
        assert!(why.contains("16 GiB") && why.contains("1.0 GiB"), "{why}");
        assert!(afford(u64::MAX, u64::MAX, u64::MAX).is_err());
        assert!(afford(0, 5, 100).unwrap_err().contains("0 x 5 samples, which is empty"));
    }
}
