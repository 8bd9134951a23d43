//! Mosaics of several files of heights: a folder of georeferenced tiles, or the sources of a virtual raster.

use std::path::{Path, PathBuf};

use crate::format::affine::Affine;
use crate::format::band::BandMetadata;
use crate::format::crs::unit::Unit;
use crate::format::crs::{keys, vertical};
use crate::format::dem::{Dem, Placement, Request, afford, refused};
use crate::format::import;
use crate::format::vrt::{self, Band, Virtual};
use crate::{fs, samples};
use orogen_grid::error::{Error, Result};

/// Maximum number of files.
const MAX_FILES: usize = 20_000;

/// Maximum misalignment of a tile's samples with the common lattice, in cells.
const BESIDE: f64 = 0.05;

/// A part of a file, and its position in the mosaic.
struct Part {
    path: PathBuf,
    band: Option<u32>,
    from: [usize; 2],
    to: [usize; 2],
    /// Columns and rows; `None` means all.
    size: Option<[usize; 2]>,
    /// Metadata that replaces the metadata of the file.
    metadata: BandMetadata,
}

/// The files of a folder that can be tiles, sorted by name.
///
/// # Errors
/// If the folder cannot be read.
pub fn tiles(folder: &Path) -> Result<Vec<PathBuf>> {
    let failed = |cause: std::io::Error| Error::file("read", folder, &cause);
    let mut tiles = Vec::new();
    for entry in fs::read_dir(folder).map_err(failed)? {
        let path = entry.map_err(failed)?.path();
        if import::has_head(&path) && fs::is_file(&path) {
            tiles.push(path);
        }
    }
    tiles.sort();
    Ok(tiles)
}

/// Reads a folder of tiles with the same cells and coordinate system. Where tiles overlap, the first tile by name that
/// has a height is used. Areas without a tile have no height.
///
/// # Errors
/// If the tiles do not fit together, one cannot be read, or their heights exceed the memory limit.
pub fn folder(folder: &Path, request: Request) -> Result<Dem> {
    let name = folder.display().to_string();
    let tiles = tiles(folder)?;
    if tiles.len() > MAX_FILES {
        return Err(refused(&name, format!("it has {} tiles, and at most {MAX_FILES} are supported", tiles.len())));
    }
    let heads: Vec<(PathBuf, [usize; 2], Placement)> = tiles
        .into_iter()
        .map(|path| {
            let (size, place) = import::head(&path, request.band)?;
            let place = place
                .ok_or_else(|| refused(&path.display().to_string(), "it has no georeferencing, which a tile needs"))?;
            Ok((path, size, place))
        })
        .collect::<Result<_>>()?;
    let (size, place, to) = layout(&heads).map_err(|why| refused(&name, why))?;
    let parts = heads.into_iter().zip(to).map(|((path, ..), to)| Part {
        path,
        band: request.band,
        from: [0; 2],
        to,
        size: None,
        metadata: BandMetadata::default(),
    });
    // Later parts cover earlier ones.
    let parts: Vec<Part> = parts.rev().collect();
    lay(&name, size, Some(place), &parts, f32::NAN, request)
}

/// Size and position of the mosaic, and the first column and row of each tile.
type Layout = ([u64; 2], Placement, Vec<[usize; 2]>);

fn layout(tiles: &[(PathBuf, [usize; 2], Placement)]) -> std::result::Result<Layout, String> {
    let Some((first, _, own)) = tiles.first() else {
        return Err("it is a folder without tiles (.tif, .hgt or .asc)".into());
    };
    let called = |path: &Path| path.file_name().unwrap_or(path.as_os_str()).to_string_lossy().into_owned();
    let system = |place: &Placement| {
        (place.unit == Unit::Degrees, place.keys.as_ref().map(|keys| keys::epsg(keys).ok_or_else(|| keys.clone())))
    };
    for (path, _, place) in &tiles[1..] {
        let pair = format!("{} and {}", called(first), called(path));
        if system(place) != system(own) || place.unit != own.unit {
            return Err(format!(
                "{pair} are in different coordinate systems; reproject them to one, for example with gdalwarp"
            ));
        }
        if (0..2).any(|k| (place.step[k] - own.step[k]).abs() > 1e-6 * own.step[k]) {
            return Err(format!(
                "{pair} have different cell sizes, {} x {} and {} x {}; resample them to one, for example with gdalwarp",
                own.step[0], own.step[1], place.step[0], place.step[1]
            ));
        }
    }
    let west = tiles.iter().map(|(.., place)| place.origin[0]).fold(f64::INFINITY, f64::min);
    let north = tiles.iter().map(|(.., place)| place.origin[1]).fold(f64::NEG_INFINITY, f64::max);
    let (mut size, mut to) = ([0u64; 2], Vec::with_capacity(tiles.len()));
    for (path, tile, place) in tiles {
        let at = [(place.origin[0] - west) / own.step[0], (north - place.origin[1]) / own.step[1]];
        if at.iter().any(|at| (at - at.round()).abs() > BESIDE || *at > 1e9) {
            return Err(format!(
                "the samples of {} are not aligned with those of the others; align them, for example with gdalwarp -tap",
                called(path)
            ));
        }
        let at = at.map(|at| at.round() as usize);
        (0..2).for_each(|k| size[k] = size[k].max((at[k] + tile[k]) as u64));
        to.push(at);
    }
    Ok((size, Placement { origin: [west, north], ..own.clone() }, to))
}

/// Reads a virtual raster.
///
/// # Errors
/// If it is not a virtual raster, if it changes samples, if one of its files cannot be read, or if its heights exceed
/// the memory limit.
pub fn virtual_raster(path: &Path, request: Request) -> Result<Dem> {
    let name = path.display().to_string();
    let refuse = |why: String| refused(&name, why);
    let read = parsed(path)?;
    let band = request.choose(read.bands.len()).map_err(refuse)?;
    let place = place(&read).map_err(refuse)?;
    let vertical = read.system.as_deref().and_then(vertical::metres_of_text);
    let Virtual { size, mut bands, has_mask, .. } = read;
    let Band { sources, mut metadata } = bands.swap_remove(band);
    if metadata.unit.is_none() {
        metadata.metres = vertical;
    }
    let absent = if has_mask { f32::NAN } else { metadata.conversion(None).map_err(refuse)?.absent() };
    if sources.len() > MAX_FILES {
        return Err(refuse(format!("it has {} sources, and at most {MAX_FILES} are supported", sources.len())));
    }
    let parts: Vec<Part> = sources
        .into_iter()
        .map(|source| Part {
            path: lies_at(path, &source),
            band: Some(source.band),
            from: source.from.map(|at| at as usize),
            to: source.to.map(|at| at as usize),
            size: source.size.map(|size| size.map(|samples| samples as usize)),
            metadata: metadata.clone().with_nodata(source.nodata),
        })
        .collect();
    lay(&name, size, place, &parts, absent, request)
}

/// The parsed text of a virtual raster.
fn parsed(path: &Path) -> Result<Virtual> {
    let name = path.display().to_string();
    let bytes = crate::open::bytes(path, "read", vrt::MAX_LENGTH)?;
    let bytes = bytes.ok_or_else(|| refused(&name, format!("it is longer than {} bytes", vrt::MAX_LENGTH)))?;
    vrt::parse(&String::from_utf8_lossy(&bytes)).map_err(|why| refused(&name, why))
}

/// The path of a source of the virtual raster at `path`.
fn lies_at(path: &Path, source: &vrt::Source) -> PathBuf {
    match source.relative {
        true => path.parent().unwrap_or(Path::new("")).join(&source.path),
        false => PathBuf::from(&source.path),
    }
}

/// The source files of a virtual raster; empty if it cannot be read.
pub fn sources(path: &Path) -> Vec<PathBuf> {
    let bands = parsed(path).map_or(Vec::new(), |read| read.bands);
    bands.iter().flat_map(|band| &band.sources).map(|source| lies_at(path, source)).collect()
}

/// The position of a virtual raster.
fn place(read: &Virtual) -> std::result::Result<Option<Placement>, String> {
    let Some(affine) = read.affine else { return Ok(None) };
    let lattice = Affine::lattice(&affine, read.size[1] as usize)?;
    if lattice.from_south {
        return Err("its rows run from south to north; convert it to north-up first, for example with gdalwarp".into());
    }
    let keys = match read.system.as_deref() {
        None => None,
        Some(text) => Some(keys::of_text(text)?),
    };
    let unit = keys.as_ref().map_or(Ok(Unit::guess(lattice.origin, lattice.step)), keys::unit)?;
    Ok(Some(Placement { origin: lattice.origin, step: lattice.step, unit, cell: None, keys }))
}

/// Composes parts in order. Files are read one at a time, so the memory of one file is needed in addition to the
/// mosaic. Samples without a part get the height `absent`.
fn lay(
    name: &str,
    size: [u64; 2],
    place: Option<Placement>,
    parts: &[Part],
    absent: f32,
    request: Request,
) -> Result<Dem> {
    let count = afford(size[0], size[1], request.allowed).map_err(|why| refused(name, why))?;
    let [width, height] = size.map(|side| side as usize);
    let left = request.allowed.saturating_sub(4 * count as u64);
    // Marks samples without a part until all parts are in place.
    const NO_PART: f32 = f32::INFINITY;
    let mut heights = samples::filled(NO_PART, count);
    let mut notes = Vec::new();
    for part in parts {
        let dem = import::read_with(&part.path, Request::new(left).with_band(part.band), &part.metadata)?;
        let outside = || {
            let path = part.path.display();
            refused(
                name,
                format!(
                    "the part of {path} that it uses is outside its {width} x {height} samples, or outside that file"
                ),
            )
        };
        let size = part.size.unwrap_or([dem.width, dem.height]);
        let ends = |at: [usize; 2], within: [usize; 2]| {
            (0..2).all(|k| at[k].checked_add(size[k]).is_some_and(|end| end <= within[k]))
        };
        if !ends(part.from, [dem.width, dem.height]) || !ends(part.to, [width, height]) {
            return Err(outside());
        }
        for j in 0..size[1] {
            let source = (part.from[1] + j) * dem.width + part.from[0];
            let to = (part.to[1] + j) * width + part.to[0];
            // A missing sample shows the part below. Where there is none, the mark must not become a height.
            samples::lay(&mut heights[to..to + size[0]], &dem.heights[source..source + size[0]], NO_PART);
        }
        notes.extend(dem.notes);
    }
    samples::replace(&mut heights, NO_PART, absent);
    let mut dem = Dem::new([width, height], heights, place).map_err(|why| refused(name, why))?;
    notes.dedup();
    dem.notes = notes;
    Ok(dem)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::test_folder::TestFolder;
    use std::fs::write;

    const HEAD: &str = "ncols 3\nnrows 1\nxllcorner 0\nyllcorner 0\ncellsize 10\n";

    fn source(kind: &str, file: &str, more: &str) -> String {
        format!("<{kind}><SourceFilename relativeToVRT=\"1\">{file}</SourceFilename>{more}</{kind}>")
    }

    #[test]
    fn missing_samples_of_a_virtual_raster_show_the_source_below() {
        let folder = TestFolder::new("mosaic").unwrap();
        write(folder.join("a.asc"), format!("{HEAD}1 2.6 300\n")).unwrap();
        write(folder.join("b.asc"), format!("{HEAD}7 -1 9\n")).unwrap();
        let below = source("SimpleSource", "a.asc", "");
        let above = source("ComplexSource", "b.asc", "<NODATA>-1</NODATA>");
        // As GDAL reads them, except that a hole of the lowest source, which GDAL fills with 0, is missing.
        for (kind, sources, expect) in [
            ("Float32", format!("{below}{above}"), [7.0, 2.6, 9.0]),
            ("Float32", format!("{above}{below}"), [1.0, 2.6, 300.0]),
            ("Byte", below.clone(), [1.0, 3.0, 255.0]),
            ("Float32", above.clone(), [7.0, f32::NAN, 9.0]),
            ("Float32", String::new(), [0.0; 3]),
        ] {
            let text = format!(
                "<VRTDataset rasterXSize=\"3\" rasterYSize=\"1\"><VRTRasterBand dataType=\"{kind}\">{sources}</VRTRasterBand></VRTDataset>"
            );
            write(folder.join("c.vrt"), text).unwrap();
            let dem = virtual_raster(&folder.join("c.vrt"), Request::new(1 << 20)).unwrap();
            let same = dem
                .heights
                .iter()
                .zip(expect)
                .all(|(own, expect)| own.to_bits() == expect.to_bits() || own.is_nan() && expect.is_nan());
            assert!(same, "{kind} {sources}: {:?}", dem.heights);
        }
        let nested = source("SimpleSource", "c.vrt", "");
        let text = format!(
            "<VRTDataset rasterXSize=\"3\" rasterYSize=\"1\"><VRTRasterBand>{nested}</VRTRasterBand></VRTDataset>"
        );
        write(folder.join("d.vrt"), text).unwrap();
        let why = virtual_raster(&folder.join("d.vrt"), Request::new(1 << 20)).unwrap_err().to_string();
        assert!(
            why.contains("a virtual raster within another") && why.contains("gdal_translate c.vrt out.tif"),
            "{why}"
        );
    }

    #[test]
    fn seconds_and_feet_of_an_old_projection_file_are_converted() {
        let folder = TestFolder::new("seconds").unwrap();
        let head = "ncols 2\nnrows 2\nxllcenter 36000\nyllcenter 162000\ncellsize 3\n";
        write(folder.join("a.asc"), format!("{head}1 2\n3 1000\n")).unwrap();
        write(folder.join("a.prj"), "Projection GEOGRAPHIC\nDatum WGS84\nZunits FEET\nUnits DS\nParameters\n").unwrap();
        let dem = import::read(&folder.join("a.asc"), 1 << 20).unwrap();
        let place = dem.place.unwrap();
        assert!((place.origin[0] - 10.0).abs() < 1e-12 && (place.origin[1] - 45.0 - 1.0 / 1200.0).abs() < 1e-12);
        assert!((place.step[0] - 1.0 / 1200.0).abs() < 1e-15 && place.unit == Unit::Degrees);
        assert!((dem.heights[3] - 304.8006).abs() < 1e-4, "{:?}", dem.heights);
        // The same numbers are not on Earth if they are degrees.
        write(folder.join("a.prj"), "Projection GEOGRAPHIC\nDatum WGS84\nUnits DD\nParameters\n").unwrap();
        let why = import::read(&folder.join("a.asc"), 1 << 20).unwrap_err().to_string();
        assert!(why.contains("a latitude of 162003 degrees is beyond the pole"), "{why}");
    }
}
