//! Reading a grid of a NetCDF-3 file.
//!
//! A grid is a variable of numbers whose last two dimensions are rows and columns. Each step of its other dimensions is
//! a band; each of several variables is a band, too. The position is taken from variables with the names of the
//! dimensions, with GMT's `actual_range` and `node_offset`, or from GDAL's `GeoTransform`. The coordinate system is
//! taken from `grid_mapping`. Packed values have `scale_factor` and `add_offset`.

use std::io::SeekFrom;
use std::path::Path;

use super::header::{Attributes, Header, Kind, Type, Variable};
use crate::format::affine::{Affine, Lattice};
use crate::format::band::BandMetadata;
use crate::format::crs::keys::{self, GeoKeys};
use crate::format::crs::unit::{Unit, length_of_name};
use crate::format::dem::{Dem, Input, Part, Placement, Request, afford, beyond, refused, turn_rows};
use crate::samples;
use orogen_grid::error::Result;

/// Maximum number of coordinates along a side.
const MAX_SIDE: u64 = 1 << 24;

/// Maximum deviation of a coordinate from even spacing, in cells: coordinates of 32 bits are not exact.
const UNEVEN: f64 = 0.1;

type Fallible<T> = std::result::Result<T, String>;

/// Reads a grid. `name` is the file's name in errors.
///
/// # Errors
/// If it is not NetCDF-3, is damaged, has no grid, or is too large.
pub fn read(input: &mut dyn Input, name: &str, request: Request) -> Result<Dem> {
    open(input, name, request).map_err(|why| refused(name, why))
}

/// The size and position of a grid, without reading its samples.
///
/// # Errors
/// The errors of [`read`], except for errors of samples.
pub fn head(input: &mut dyn Input, name: &str, band: Option<u32>) -> Result<([usize; 2], Option<Placement>)> {
    let mut found = || {
        let file = Header::read(input, file_name(name))?;
        let grid = Grid::find(&file, Request::new(0).with_band(band))?;
        let size = grid.size.map(|samples| samples as usize);
        Ok((size, place(&file, &grid, input)?.map(|(place, _)| place)))
    };
    found().map_err(|why: String| refused(name, why))
}

fn file_name(name: &str) -> &str {
    Path::new(name).file_name().and_then(|name| name.to_str()).unwrap_or(name)
}

/// A grid of a file.
struct Grid<'a> {
    variable: &'a Variable,
    /// Columns and rows.
    size: [u64; 2],
    /// Number of preceding grids of the variable.
    index: u64,
}

impl<'a> Grid<'a> {
    fn find(file: &'a Header, request: Request) -> Fallible<Grid<'a>> {
        let mut bands = Vec::new();
        for variable in file.variables.iter().filter(|variable| variable.type_of.kind != Kind::Text) {
            let shape = file.shape(variable);
            // Bounds of cells have two numbers for each cell.
            if let [others @ .., height, width] = &shape[..]
                && *height > 1
                && *width > 1
                && !is_bounds(file, &variable.name)
            {
                bands.push((variable, [*width, *height], product(others)));
            }
        }
        let count = bands.iter().fold(0u64, |sum, band| sum.saturating_add(band.2));
        if count == 0 {
            return Err(format!(
                "it has no grid: no variable of numbers has rows and columns{}",
                if file.variables.iter().any(|own| own.name == "x_range") {
                    "; it is a grid of GMT before version 4: convert it, for example with gmt grdconvert"
                } else {
                    ""
                }
            ));
        }
        let names: Vec<&str> = bands.iter().map(|band| band.0.name.as_str()).collect();
        let chosen = request.choose(usize::try_from(count).unwrap_or(usize::MAX));
        let mut index = chosen.map_err(|why| match names.len() {
            1 => why,
            _ => format!("{why}; its grids are {}", names.join(", ").escape_debug()),
        })? as u64;
        for (variable, size, own) in bands {
            if index < own {
                return Ok(Grid { variable, size, index });
            }
            index -= own;
        }
        Err("it has no grid".into())
    }

    /// The position in the file of the samples of a row, starting at a column.
    fn at(&self, file: &Header, row: u64, column: u64) -> Option<u64> {
        let ([width, height], variable) = (self.size, self.variable);
        // The index of the row among all rows of the variable.
        let row = self.index.checked_mul(height)?.checked_add(row)?;
        let (record, row) = match file.is_recorded(variable) {
            false => (0, row),
            true => {
                let rows = product(&file.shape(variable)[1..variable.dimensions.len() - 1]);
                (row.checked_div(rows)?, row.checked_rem(rows)?)
            }
        };
        let within = row.checked_mul(width)?.checked_add(column)?.checked_mul(variable.type_of.size as u64)?;
        variable.begin.checked_add(record.checked_mul(file.record_size())?)?.checked_add(within)
    }
}

fn product(lengths: &[u64]) -> u64 {
    lengths.iter().fold(1, |product: u64, length| product.saturating_mul(*length))
}

/// Whether a variable contains the bounds of another variable's cells.
fn is_bounds(file: &Header, name: &str) -> bool {
    file.variables.iter().any(|own| own.attributes.text("bounds") == Some(name))
}

fn open(input: &mut dyn Input, name: &str, request: Request) -> Fallible<Dem> {
    let file = Header::read(input, file_name(name))?;
    let grid = Grid::find(&file, request)?;
    let [width, height] = request.part.map_or(grid.size, |part| part.size.map(|samples| samples as u64));
    let count = afford(width, height, request.allowed)?;
    let size = grid.size.map(|samples| samples as usize);
    let wanted = request.part.unwrap_or(Part::whole(size));
    if !wanted.is_within(size) {
        return Err(beyond(size));
    }
    let placed = place(&file, &grid, input)?;
    let from_south = placed.as_ref().is_some_and(|(_, from_south)| *from_south);
    let part = if from_south { wanted.from_south(size[1]) } else { wanted };
    let Variable { attributes, type_of, .. } = grid.variable;
    let type_of = stored(attributes, *type_of);
    let mut conversion = metadata(attributes, type_of).conversion(None)?;
    let bytes_of_row = part.size[0] * type_of.size;
    let row = |j: usize| grid.at(&file, (part.from[1] + j) as u64, part.from[0] as u64);
    let end = row(part.size[1] - 1).and_then(|at| at.checked_add(bytes_of_row as u64));
    match end {
        Some(end) if end <= file.length => {}
        Some(end) => {
            return Err(format!(
                "its samples should reach byte {end}, and the file has {}; it is damaged",
                file.length
            ));
        }
        None => return Err("its samples are beyond the end of any file; it is damaged".into()),
    }
    let mut heights = samples::filled(f32::NAN, count);
    let mut bytes = vec![0; bytes_of_row];
    let rows = heights.chunks_exact_mut(part.size[0]);
    for (heights, at) in rows.zip((0..part.size[1]).filter_map(row)) {
        input.seek(SeekFrom::Start(at)).map_err(|cause| cause.to_string())?;
        input.read_exact(&mut bytes).map_err(|cause| cause.to_string())?;
        type_of.stored().convert(&bytes, &mut conversion, heights);
    }
    if from_south {
        turn_rows(&mut heights, part.size[0]);
    }
    let place = placed.map(|(place, _)| place);
    let mut dem = match request.part {
        Some(part) => Dem::part(part, heights, place),
        None => Dem::new(size, heights, place)?,
    };
    dem.notes = conversion.notes();
    Ok(dem)
}

/// The type of stored values. Files without unsigned types mark unsigned values with an attribute.
fn stored(attributes: &Attributes, type_of: Type) -> Type {
    let is_unsigned = attributes.text("_Unsigned").is_some_and(|text| text.eq_ignore_ascii_case("true"));
    match type_of.kind {
        Kind::Signed if is_unsigned => Type { kind: Kind::Unsigned, ..type_of },
        _ => type_of,
    }
}

/// The metadata of a variable's samples. Without a `_FillValue`, samples that were never written have the default fill
/// value of their type.
fn metadata(attributes: &Attributes, type_of: Type) -> BandMetadata {
    let mut nodata = [attributes.numbers("_FillValue"), attributes.numbers("missing_value")].concat();
    // Stored with the bits of the unsigned value.
    if type_of.kind == Kind::Unsigned {
        let all = 2.0 * (1u64 << (8 * type_of.size - 1)) as f64;
        nodata.iter_mut().filter(|value| **value < 0.0).for_each(|value| *value += all);
    }
    if nodata.is_empty() {
        nodata.extend(match (type_of.kind, type_of.size) {
            (Kind::Signed, 2) => Some(-32_767.0),
            (Kind::Signed, 4) => Some(-2_147_483_647.0),
            (Kind::Unsigned, 2) => Some(65_535.0),
            (Kind::Unsigned, 4) => Some(4_294_967_295.0),
            // The fill value of floats is too large for a height, and bytes have none.
            _ => None,
        });
    }
    let unit = attributes.text("units").filter(|unit| !matches!(*unit, "" | "1"));
    BandMetadata {
        nodata,
        scale: attributes.number("scale_factor"),
        offset: attributes.number("add_offset"),
        unit: unit.map(String::from),
        metres: None,
        whole: None,
    }
}

/// The position of a grid's samples, and whether its first row is the southernmost.
fn place(file: &Header, grid: &Grid, input: &mut dyn Input) -> Fallible<Option<(Placement, bool)>> {
    let [.., down, across] = grid.variable.dimensions[..] else { return Ok(None) };
    let mapping = grid.variable.attributes.text("grid_mapping");
    let mapping = file.variables.iter().find(|own| mapping == Some(&own.name)).map(|own| &own.attributes);
    let axis = |input: &mut dyn Input, dimension: usize| Axis::read(file, dimension, input);
    let (affine, unit) = match (axis(input, across)?, axis(input, down)?) {
        (Some(x), Some(y)) => {
            // Longitudes of 180 degrees and more become negative, as in GDAL.
            let west = if x.is_degrees && x.first >= 180.0 { x.first - 360.0 } else { x.first };
            let unit = match x.metres {
                _ if x.is_degrees => Unit::Degrees,
                Some(metres) => Unit::Metres(metres),
                None => Unit::guess([x.first, y.first], [x.step.abs(), y.step.abs()]),
            };
            (Affine([x.step, 0.0, west, 0.0, y.step, y.first]), Some(unit))
        }
        _ => {
            let text = mapping.and_then(|own| own.text("GeoTransform")).unwrap_or_default();
            let numbers: Vec<f64> = text.split_whitespace().filter_map(|word| word.parse().ok()).collect();
            let Ok(numbers) = <[f64; 6]>::try_from(numbers) else { return Ok(None) };
            (Affine::of_geotransform(numbers), None)
        }
    };
    let keys = mapping.and_then(system);
    let keys = match unit {
        // Longitudes and latitudes without a datum are treated as WGS 84.
        Some(Unit::Degrees) => keys.or(Some(keys::of_epsg(4326, true))),
        _ => keys,
    };
    let unit = match (&keys, unit) {
        (Some(keys), _) => keys::unit(keys)?,
        (None, unit) => unit.unwrap_or(Unit::Metres(1.0)),
    };
    let Lattice { origin, step, from_south } = affine.lattice(grid.size[1] as usize)?;
    Ok(Some((Placement { origin, step, unit, cell: None, keys }, from_south)))
}

/// The coordinate system of a grid mapping.
fn system(mapping: &Attributes) -> Option<GeoKeys> {
    ["crs_wkt", "spatial_ref", "spatial_epsg"]
        .into_iter()
        .filter_map(|name| mapping.text(name))
        .find_map(|text| keys::of_text(text).ok())
}

/// The coordinates along a dimension: sample k is at `first + k * step`.
struct Axis {
    first: f64,
    step: f64,
    is_degrees: bool,
    /// Metres per unit, if the unit is a length.
    metres: Option<f64>,
}

impl Axis {
    fn read(file: &Header, dimension: usize, input: &mut dyn Input) -> Fallible<Option<Axis>> {
        let (name, count) = &file.dimensions[dimension];
        let own = |variable: &&Variable| variable.name == *name && variable.dimensions[..] == [dimension];
        let Some(variable) = file.variables.iter().find(own) else { return Ok(None) };
        if *count < 2 || *count > MAX_SIDE || variable.type_of.kind == Kind::Text {
            return Ok(None);
        }
        let line = Line::of(file, variable, *count)?;
        let (first, last, cells) = (line.one(0, input)?, line.one(count - 1, input)?, (count - 1) as f64);
        let step = (last - first) / cells;
        let mut is_even = step != 0.0;
        line.each(input, |k, at| is_even &= (at - first - k as f64 * step).abs() <= UNEVEN * step.abs())?;
        if !is_even {
            return Err(format!(
                "its coordinates `{}` are not evenly spaced; resample it first, for example with gdalwarp or gmt grdsample",
                name.escape_debug()
            ));
        }
        let units = variable.attributes.text("units").unwrap_or_default();
        let lower = name.to_ascii_lowercase();
        let is_degrees = units.to_ascii_lowercase().starts_with("degree")
            || units.is_empty() && (lower.starts_with("lon") || lower.starts_with("lat"));
        let metres = length_of_name(units).filter(|_| !is_degrees);
        let [first, step] = ranged(file, variable, first, step, cells).unwrap_or([first, step]);
        Ok(Some(Axis { first, step, is_degrees, metres }))
    }
}

/// The first coordinate and the step from GMT's `actual_range`, which is a range of cell edges if `node_offset` is 1.
/// It is more precise than coordinates of 32 bits. `None` if it is absent or contradicts them.
fn ranged(file: &Header, variable: &Variable, first: f64, step: f64, cells: f64) -> Option<[f64; 2]> {
    let [low, high] = variable.attributes.numbers("actual_range") else { return None };
    let is_pixels = file.attributes.number("node_offset") == Some(1.0);
    let own = (high - low) / if is_pixels { cells + 1.0 } else { cells };
    let start = low + if is_pixels { 0.5 * own } else { 0.0 };
    let [start, own] = if step < 0.0 { [start + cells * own, -own] } else { [start, own] };
    let agree = (start - first).abs() <= UNEVEN * step.abs() && (own - step).abs() * cells <= UNEVEN * step.abs();
    agree.then_some([start, own])
}

/// The numbers of a variable with one dimension.
struct Line {
    type_of: Type,
    begin: u64,
    /// Number of bytes from one number to the next.
    pace: u64,
    count: u64,
    scale: f64,
    offset: f64,
}

/// Number of numbers that are read at once.
const PIECE: u64 = 4096;

impl Line {
    fn of(file: &Header, variable: &Variable, count: u64) -> Fallible<Line> {
        let type_of = stored(&variable.attributes, variable.type_of);
        let pace = if file.is_recorded(variable) { file.record_size() } else { type_of.size as u64 };
        let length = pace.saturating_mul(count - 1).saturating_add(type_of.size as u64);
        if variable.begin.checked_add(length).is_none_or(|end| end > file.length) {
            return Err(format!("it ends within its coordinates `{}`", variable.name.escape_debug()));
        }
        let number = |name: &str, otherwise: f64| variable.attributes.number(name).unwrap_or(otherwise);
        let (scale, offset) = (number("scale_factor", 1.0), number("add_offset", 0.0));
        Ok(Line { type_of, begin: variable.begin, pace, count, scale, offset })
    }

    fn one(&self, k: u64, input: &mut dyn Input) -> Fallible<f64> {
        let mut number = f64::NAN;
        self.piece(k, 1, input, &mut |_, at| number = at)?;
        Ok(number)
    }

    /// Calls a function with each number and its index.
    fn each(&self, input: &mut dyn Input, mut visit: impl FnMut(u64, f64)) -> Fallible<()> {
        // Numbers in records are not contiguous.
        let piece = if self.pace == self.type_of.size as u64 { PIECE } else { 1 };
        for first in (0..self.count).step_by(piece as usize) {
            self.piece(first, piece.min(self.count - first), input, &mut visit)?;
        }
        Ok(())
    }

    fn piece(&self, first: u64, count: u64, input: &mut dyn Input, visit: &mut dyn FnMut(u64, f64)) -> Fallible<()> {
        let mut bytes = vec![0; count as usize * self.type_of.size];
        let at = self.begin + first * self.pace;
        input.seek(SeekFrom::Start(at)).map_err(|cause| cause.to_string())?;
        input.read_exact(&mut bytes).map_err(|cause| cause.to_string())?;
        for (k, bytes) in (first..).zip(bytes.chunks_exact(self.type_of.size)) {
            visit(k, self.type_of.stored().value(bytes) * self.scale + self.offset);
        }
        Ok(())
    }
}
