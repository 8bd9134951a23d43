//! Reading heights from Zarr arrays of versions 2 and 3: a folder that is an array, or a group that contains one.
//!
//! In a group, the array `height` is read, or else the only two-dimensional array. In an array of three dimensions, the
//! first dimension is the band. The position is taken from coordinate arrays with the names of the dimensions (`x`,
//! `y`, `lon`, `lat`, ...), and the coordinate system from `crs_wkt`, `spatial_ref` or GDAL's `_CRS`.

use std::path::{Path, PathBuf};

use serde_json::Value;

use super::unpack::Codec;
use crate::format::affine::Affine;
use crate::format::band::BandMetadata;
use crate::format::crs::keys::{self, GeoKeys};
use crate::format::crs::unit::Unit;
use crate::format::dem::{Dem, Placement, Request, afford, afford_beside, refused, turn_rows};
use crate::format::stored::{Kind, Stored};
use crate::{fs, open, samples};
use orogen_grid::error::{Error, Result};

/// Maximum length of metadata, in bytes.
const MAX_METADATA: u64 = 4 << 20;

/// Maximum size of a chunk, in bytes.
const MAX_CHUNK: u64 = 1 << 30;

/// Maximum number of samples along a side.
const MAX_SIDE: u64 = 1 << 31;

/// Whether a folder is a Zarr array or group.
pub fn is_zarr(folder: &Path) -> bool {
    ["zarr.json", ".zarray", ".zgroup"].iter().any(|name| fs::is_file(&folder.join(name)))
}

/// Reads heights.
///
/// # Errors
/// If there is no such array, or it is damaged, uses an unsupported codec, or is too large.
pub fn read(folder: &Path, request: Request) -> Result<Dem> {
    let name = folder.display().to_string();
    open(folder, request).map_err(|fault| match fault {
        ReadFault::Other(error) => error,
        ReadFault::Message(why) => refused(&name, why),
    })
}

/// The reason why an array was not read.
enum ReadFault {
    Message(String),
    Other(Error),
}

impl From<String> for ReadFault {
    fn from(why: String) -> ReadFault {
        ReadFault::Message(why)
    }
}

impl From<&str> for ReadFault {
    fn from(why: &str) -> ReadFault {
        ReadFault::Message(why.to_string())
    }
}

impl From<Error> for ReadFault {
    fn from(error: Error) -> ReadFault {
        ReadFault::Other(error)
    }
}

/// An array, as described by its metadata.
struct Array {
    folder: PathBuf,
    shape: Vec<u64>,
    chunk: Vec<u64>,
    kind: Kind,
    size: usize,
    big_endian: bool,
    /// The codecs, in the order of decoding.
    codecs: Vec<Codec>,
    /// The separator between the numbers of a chunk's name, and the prefix before them.
    separator: String,
    prefix: &'static str,
    fill: f64,
    names: Vec<String>,
    attributes: Value,
}

/// The content of a small file; `None` if it does not exist.
fn text(path: &Path) -> std::result::Result<Option<Value>, ReadFault> {
    if !fs::is_present(path) {
        return Ok(None);
    }
    let text = open::bytes(path, "read", MAX_METADATA)?;
    let text = text.ok_or_else(|| format!("its {} is longer than {MAX_METADATA} bytes", path.display()))?;
    let value = serde_json::from_slice(&text);
    value.map(Some).map_err(|fault| ReadFault::Message(format!("its {} is not valid JSON ({fault})", path.display())))
}

/// The array of a folder, if it is one.
fn array(folder: &Path) -> std::result::Result<Option<Array>, ReadFault> {
    if let Some(value) = text(&folder.join("zarr.json"))? {
        return match value["node_type"].as_str() {
            Some("array") => Ok(Some(version3(folder, &value)?)),
            _ => Ok(None),
        };
    }
    match text(&folder.join(".zarray"))? {
        Some(value) => {
            let attributes = text(&folder.join(".zattrs"))?.unwrap_or_default();
            Ok(Some(version2(folder, &value, attributes)?))
        }
        None => Ok(None),
    }
}

fn sides(value: &Value, what: &str) -> std::result::Result<Vec<u64>, String> {
    let sides = value.as_array().map(|sides| sides.iter().map(Value::as_u64).collect::<Option<Vec<u64>>>());
    sides.flatten().filter(|sides| sides.len() <= 8).ok_or(format!("its metadata has no {what}"))
}

fn fill(value: &Value) -> f64 {
    match value {
        Value::Number(number) => number.as_f64().unwrap_or(f64::NAN),
        _ => f64::NAN,
    }
}

fn version3(folder: &Path, value: &Value) -> std::result::Result<Array, String> {
    let kind = value["data_type"].as_str().unwrap_or_default();
    let bits = |prefix: &str| kind.strip_prefix(prefix)?.parse::<usize>().ok().filter(|bits| bits % 8 == 0);
    let (kind, bits) = match (bits("float"), bits("uint"), bits("int")) {
        (Some(bits), ..) => (Kind::Float, bits),
        (_, Some(bits), _) => (Kind::Unsigned, bits),
        (.., Some(bits)) => (Kind::Signed, bits),
        _ => return Err(format!("its samples are of the type {}", value["data_type"])),
    };
    if value["chunk_grid"]["name"] != "regular" {
        return Err("its chunks have different sizes".into());
    }
    let (mut codecs, mut big_endian) = (Vec::new(), false);
    for codec in value["codecs"].as_array().map(Vec::as_slice).unwrap_or_default() {
        let name = codec["name"].as_str().or(codec.as_str()).unwrap_or_default();
        match (name, Codec::named(name)) {
            ("bytes", _) => big_endian = codec["configuration"]["endian"] == "big",
            (_, Some(codec)) => codecs.insert(0, codec),
            _ => {
                return Err(format!(
                    "its chunks are compressed with `{}`, which is not supported",
                    name.escape_debug()
                ));
            }
        }
    }
    let encoding = &value["chunk_key_encoding"];
    let default = encoding["name"] != "v2";
    let separator = encoding["configuration"]["separator"].as_str().unwrap_or(if default { "/" } else { "." });
    let names = value["dimension_names"].as_array().map(Vec::as_slice).unwrap_or_default();
    check(Array {
        folder: folder.to_path_buf(),
        shape: sides(&value["shape"], "shape")?,
        chunk: sides(&value["chunk_grid"]["configuration"]["chunk_shape"], "chunks")?,
        kind,
        size: bits / 8,
        big_endian,
        codecs,
        separator: separator.to_string(),
        prefix: if default { "c" } else { "" },
        fill: fill(&value["fill_value"]),
        names: names.iter().map(|name| name.as_str().unwrap_or_default().to_string()).collect(),
        attributes: value["attributes"].clone(),
    })
}

fn version2(folder: &Path, value: &Value, attributes: Value) -> std::result::Result<Array, String> {
    let kind = value["dtype"].as_str().unwrap_or_default();
    let unknown = || format!("its samples are of the type {}", value["dtype"]);
    let (order, rest) = kind.split_at_checked(1).ok_or_else(unknown)?;
    let (letter, size) = rest.split_at_checked(1).ok_or_else(unknown)?;
    let kind = match letter {
        "f" => Kind::Float,
        "i" => Kind::Signed,
        "u" => Kind::Unsigned,
        _ => return Err(unknown()),
    };
    if value["order"] == "F" {
        return Err("its chunks are in Fortran order, which is not supported".into());
    }
    if value["filters"].as_array().is_some_and(|filters| !filters.is_empty()) {
        return Err("its chunks use filters, which are not supported".into());
    }
    let codecs =
        match value["compressor"]["id"].as_str() {
            None => Vec::new(),
            Some(name) => {
                vec![Codec::named(name).ok_or(format!(
                    "its chunks are compressed with `{}`, which is not supported",
                    name.escape_debug()
                ))?]
            }
        };
    let names = attributes["_ARRAY_DIMENSIONS"].as_array().map(Vec::as_slice).unwrap_or_default();
    check(Array {
        folder: folder.to_path_buf(),
        shape: sides(&value["shape"], "shape")?,
        chunk: sides(&value["chunks"], "chunks")?,
        kind,
        size: size.parse().map_err(|_| unknown())?,
        big_endian: order == ">",
        codecs,
        separator: value["dimension_separator"].as_str().unwrap_or(".").to_string(),
        prefix: "",
        fill: fill(&value["fill_value"]),
        names: names.iter().map(|name| name.as_str().unwrap_or_default().to_string()).collect(),
        attributes,
    })
}

fn check(array: Array) -> std::result::Result<Array, String> {
    let Array { shape, chunk, kind, size, .. } = &array;
    let sound = if *kind == Kind::Float { matches!(size, 4 | 8) } else { matches!(size, 1 | 2 | 4 | 8) };
    if !sound {
        return Err(format!("its samples have {size} bytes"));
    }
    let bytes = chunk.iter().try_fold(*size as u64, |bytes, side| bytes.checked_mul(*side));
    if chunk.len() != shape.len() || shape.iter().any(|side| *side > MAX_SIDE) {
        return Err("its shape and its chunk shape do not match".into());
    }
    match bytes {
        Some(1..=MAX_CHUNK) => Ok(array),
        _ => Err(format!("its chunk shape {chunk:?} is invalid")),
    }
}

impl Array {
    /// Whether it has two dimensions, or three with the band as the first.
    fn is_map(&self) -> bool {
        matches!(self.shape.len(), 2 | 3)
    }

    /// The bytes of a chunk's samples; `None` if the chunk is absent. `count` heights are in memory in addition.
    fn chunk(&self, at: &[u64], count: usize, allowed: u64) -> std::result::Result<Option<Vec<u8>>, ReadFault> {
        let numbers: Vec<String> = at.iter().map(u64::to_string).collect();
        let name = match (self.prefix, self.separator.as_str()) {
            ("", _) => numbers.join(&self.separator),
            (prefix, separator) => format!("{prefix}{separator}{}", numbers.join(separator)),
        };
        let path = self.folder.join(name);
        let due = self.chunk.iter().product::<u64>() as usize * self.size;
        let most = due as u64 + due as u64 / 8 + (1 << 16);
        let Ok(there) = fs::metadata(&path) else { return Ok(None) };
        // The compressed and the decompressed bytes, and one intermediate step.
        afford_beside(count, there.len().min(most) + 2 * due as u64, allowed)?;
        let bytes = open::bytes(&path, "read", most)?;
        let mut bytes = bytes.ok_or_else(|| format!("{} is longer than its samples", path.display()))?;
        for codec in &self.codecs {
            bytes = codec.unpack(&bytes, most as usize).map_err(|why| format!("{why}: {}", path.display()))?;
        }
        if bytes.len() != due {
            return Err(format!("{} holds {} bytes instead of {due}", path.display(), bytes.len()).into());
        }
        Ok(Some(bytes))
    }

    /// How its samples are stored.
    fn stored(&self) -> Stored {
        Stored { kind: self.kind, size: self.size, big_endian: self.big_endian }
    }

    /// A numeric attribute.
    fn attribute(&self, name: &str) -> Option<f64> {
        let value = &self.attributes[name];
        value.as_f64().or_else(|| value.as_array()?.first()?.as_f64())
    }

    /// All numbers of a one-dimensional array.
    fn line(&self, allowed: u64) -> std::result::Result<Vec<f64>, ReadFault> {
        let (length, chunk) = (self.shape[0], self.chunk[0]);
        let mut line = Vec::new();
        for k in 0..length.div_ceil(chunk) {
            let bytes = self.chunk(&[k], 0, allowed)?.ok_or_else(|| "its coordinates lack a chunk".to_string())?;
            let inside = (length - k * chunk).min(chunk) as usize;
            self.stored().append_values(&bytes[..inside * self.size], &mut line);
        }
        Ok(line)
    }
}

fn open(folder: &Path, request: Request) -> std::result::Result<Dem, ReadFault> {
    let (array, group) = match array(folder)? {
        Some(array) => (array, folder.parent().map(Path::to_path_buf)),
        None => (find(folder)?, Some(folder.to_path_buf())),
    };
    let [bands, height, width] = match array.shape[..] {
        [height, width] => [1, height, width],
        [bands, height, width] => [bands, height, width],
        _ => return Err(format!("its array has {} dimensions; heights have two", array.shape.len()).into()),
    };
    let count = afford(width, height, request.allowed)?;
    let band = request.choose(usize::try_from(bands).unwrap_or(usize::MAX))? as u64;
    let place = place(&array, group.as_deref(), request.allowed)?;
    let unit = array.attributes["units"].as_str().map(str::trim).filter(|unit| !matches!(*unit, "" | "1"));
    let metadata = BandMetadata {
        nodata: [array.attribute("_FillValue"), array.attribute("missing_value")].into_iter().flatten().collect(),
        scale: array.attribute("scale_factor"),
        offset: array.attribute("add_offset"),
        unit: unit.map(String::from),
        metres: None,
        whole: None,
    };
    let mut conversion = metadata.conversion(None)?;
    // Absent chunks consist of the fill value: for floats it means no height, for integers it is an ordinary value.
    let [chunk_height, chunk_width] = [array.chunk[array.chunk.len() - 2], array.chunk[array.chunk.len() - 1]];
    let (first, layer) = match array.chunk[..] {
        [bands, ..] if array.chunk.len() == 3 => (Some(band / bands), (band % bands) * chunk_height * chunk_width),
        _ => (None, 0),
    };
    let mut heights = samples::filled(conversion.height(array.fill, array.size), count);
    for row in 0..height.div_ceil(chunk_height) {
        for column in 0..width.div_ceil(chunk_width) {
            let at: Vec<u64> = first.into_iter().chain([row, column]).collect();
            let Some(bytes) = array.chunk(&at, count, request.allowed)? else { continue };
            let (top, left) = (row * chunk_height, column * chunk_width);
            let inside = chunk_width.min(width - left) as usize;
            for j in 0..chunk_height.min(height - top) {
                let from = (layer + j * chunk_width) as usize;
                let to = ((top + j) * width + left) as usize;
                let bytes = &bytes[from * array.size..(from + inside) * array.size];
                array.stored().convert(bytes, &mut conversion, &mut heights[to..to + inside]);
            }
        }
    }
    let (place, from_south) = place.map_or((None, false), |(place, from_south)| (Some(place), from_south));
    if from_south {
        turn_rows(&mut heights, width as usize);
    }
    let mut dem = Dem::new([width as usize, height as usize], heights, place)?;
    dem.notes = conversion.notes();
    Ok(dem)
}

/// The array of heights in a group.
fn find(folder: &Path) -> std::result::Result<Array, ReadFault> {
    let mut maps = Vec::new();
    let entries = fs::read_dir(folder).map_err(|cause| Error::file("read", folder, &cause))?;
    for entry in entries {
        let path = entry.map_err(|cause| Error::file("read", folder, &cause))?.path();
        if fs::is_dir(&path)
            && let Some(array) = array(&path)?
            && array.is_map()
        {
            maps.push(array);
        }
    }
    let name = |array: &Array| array.folder.file_name().unwrap_or_default().to_string_lossy().into_owned();
    maps.sort_by_key(name);
    if let Some(k) = maps.iter().position(|array| name(array) == "height") {
        return Ok(maps.swap_remove(k));
    }
    match maps.len() {
        0 => Err("it is a Zarr group without an array of two dimensions".into()),
        1 => Ok(maps.swap_remove(0)),
        _ => {
            let names: Vec<String> = maps.iter().map(name).collect();
            Err(format!("it is a Zarr group with the arrays {}; name the folder of one of them", names.join(", "))
                .into())
        }
    }
}

/// The position of an array's samples, and whether its first row is the southernmost.
fn place(
    array: &Array,
    group: Option<&Path>,
    allowed: u64,
) -> std::result::Result<Option<(Placement, bool)>, ReadFault> {
    let sides = array.names.get(array.names.len().saturating_sub(2)..).unwrap_or_default();
    let keys = system(array, group)?;
    let (rows, columns) = (array.shape[array.shape.len() - 2], array.shape[array.shape.len() - 1]);
    if let ([south, east], Some(group)) = (sides, group) {
        let line = |name: &str, length: u64| {
            let plain = !name.is_empty() && !name.contains(['/', '\\']) && name != "..";
            match if plain { self::array(&group.join(name))? } else { None } {
                Some(line) if line.shape == [length] => Ok::<_, ReadFault>(regular(&line.line(allowed)?)),
                _ => Ok(None),
            }
        };
        if let (Some((y, down)), Some((x, across))) = (line(south, rows)?, line(east, columns)?) {
            let lattice = Affine([across, 0.0, x, 0.0, down, y]).lattice(rows as usize)?;
            let degrees = east.to_ascii_lowercase().starts_with("lon");
            let unit = match &keys {
                Some(keys) => keys::unit(keys)?,
                None if degrees => Unit::Degrees,
                None => Unit::Metres(1.0),
            };
            let place = Placement { origin: lattice.origin, step: lattice.step, unit, cell: None, keys };
            return Ok(Some((place, lattice.from_south)));
        }
    }
    Ok(None)
}

/// The first of evenly spaced numbers, and their distance; `None` if the spacing is not even.
fn regular(line: &[f64]) -> Option<(f64, f64)> {
    let (first, last) = (*line.first()?, *line.last()?);
    let step = (last - first) / (line.len() as f64 - 1.0).max(1.0);
    let even = line.iter().enumerate().all(|(k, at)| (at - first - k as f64 * step).abs() <= 1e-3 * step.abs());
    (line.len() > 1 && step != 0.0 && even).then_some((first, step))
}

/// The coordinate system that an array states itself, or in the scalar array that it names as `grid_mapping`.
fn system(array: &Array, group: Option<&Path>) -> std::result::Result<Option<GeoKeys>, ReadFault> {
    let mut all = vec![array.attributes.clone()];
    let mapping = array.attributes["grid_mapping"].as_str().unwrap_or("spatial_ref");
    if let Some(group) = group.filter(|_| !mapping.contains(['/', '\\', '.'])) {
        let folder = group.join(mapping);
        all.extend(text(&folder.join("zarr.json"))?.map(|value| value["attributes"].clone()));
        all.extend(text(&folder.join(".zattrs"))?);
    }
    let texts = all.iter().flat_map(|attributes| {
        [
            &attributes["_CRS"]["wkt"],
            &attributes["crs_wkt"],
            &attributes["spatial_ref"],
            &attributes["crs"],
            &attributes["_CRS"]["url"],
        ]
    });
    Ok(texts.filter_map(Value::as_str).find_map(|text| keys::of_text(text).ok()))
}
