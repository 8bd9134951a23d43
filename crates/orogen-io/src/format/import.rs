//! The registry of readers of heights.

use std::io::Cursor;
use std::path::Path;

use super::band::BandMetadata;
use super::dem::{Dem, Input, Part, Placement, Request, refused};
use super::foreign::foreign;
use super::noted::noted;
use super::raw::Sample;
use super::sidecar::Sidecar;
use super::{asc, content, dted, ehdr, exr_reader, geotiff, grey, hgt, netcdf, npy, raw, xyz, zip};
use crate::{open, samples};
use orogen_grid::error::{Error, Result};

/// Extensions of readable files.
pub const EXTENSIONS: [&str; 19] = [
    "tif", "tiff", "asc", "hgt", "hgt.zip", "png", "r16", "r32", "npy", "exr", "bil", "flt", "xyz", "dt0", "dt1",
    "dt2", "nc", "cdf", "grd",
];

/// Extensions of files that may have several bands.
const SEVERAL_BANDS: [&str; 6] = ["tif", "tiff", "exr", "nc", "cdf", "grd"];

/// Whether a file's name has one of these extensions.
#[must_use]
pub fn is_dem(path: &Path) -> bool {
    extension(path).is_some_and(|extension| EXTENSIONS.contains(&extension.as_str()))
}

fn extension(path: &Path) -> Option<String> {
    let name = path.file_name()?.to_str()?.to_ascii_lowercase();
    if name.ends_with(".hgt.zip") {
        return Some("hgt.zip".into());
    }
    Some(path.extension()?.to_str()?.to_ascii_lowercase())
}

/// Whether a file's size and position can be read without its heights, as mosaics of tiles require.
#[must_use]
pub fn has_head(path: &Path) -> bool {
    extension(path).is_some_and(|extension| matches!(extension.as_str(), "tif" | "tiff" | "asc" | "hgt"))
}

/// Whether a part of a file can be read without the rest of it.
#[must_use]
pub fn reads_parts(path: &Path) -> bool {
    extension(path).is_some_and(|extension| is_read_in_parts(&extension))
}

fn is_read_in_parts(extension: &str) -> bool {
    matches!(extension, "tif" | "tiff" | "nc" | "cdf" | "grd")
}

/// The size and position of a file that [has a head](has_head), or can be [read in parts](reads_parts).
///
/// # Errors
/// If it cannot be read.
pub fn head(path: &Path, band: Option<u32>) -> Result<([usize; 2], Option<Placement>)> {
    let name = path.display().to_string();
    let mut file = open::regular(path, "read")?;
    let (size, mut place) = noted(&mut file, |file| match extension(path).unwrap_or_default().as_str() {
        "asc" => asc::head(file, &name),
        "hgt" => hgt::head(file, &name),
        "nc" | "cdf" | "grd" => netcdf::reader::head(file, &name, band),
        _ => geotiff::reader::head(file, &name),
    })?;
    if let (Some(place), Some(told)) = (&mut place, Sidecar::beside(path)?) {
        told.complete(place).map_err(|why| refused(&name, why))?;
    }
    Ok((size, place))
}

/// Reads one band of a file; its extension determines the format. `request` limits the memory of the heights.
///
/// # Errors
/// If the format is unknown, or the file cannot be read, or is too large.
pub fn read(path: &Path, request: impl Into<Request>) -> Result<Dem> {
    let name = path.display().to_string();
    known(path, &name)?;
    let mut file = open::regular(path, "read")?;
    let sidecar = Sidecar::beside(path)?;
    parse(&mut file, &name, &extension(path).unwrap_or_default(), sidecar, request).map_err(|error| named(path, error))
}

/// The error for a file that cannot be read. If its content is in another format than its extension, the error says so.
fn named(path: &Path, error: Error) -> Error {
    content::of_file(path).map_or(error, |why| refused(&path.display().to_string(), why))
}

/// [`read`] with metadata of the band that replaces the metadata of the file and its sidecars, as in virtual rasters.
///
/// # Errors
/// The errors of [`read`].
pub fn read_with(path: &Path, request: Request, metadata: &BandMetadata) -> Result<Dem> {
    if metadata.is_empty() {
        return read(path, request);
    }
    let name = path.display().to_string();
    known(path, &name)?;
    let mut file = open::regular(path, "read")?;
    let mut told = Sidecar::beside(path)?.unwrap_or_default();
    told.replaced = metadata.clone();
    parse(&mut file, &name, &extension(path).unwrap_or_default(), Some(told), request)
        .map_err(|error| named(path, error))
}

/// An error if a file's extension does not belong to a format for heights.
fn known(path: &Path, name: &str) -> Result<()> {
    if is_dem(path) {
        return Ok(());
    }
    if extension(path).is_some_and(|extension| extension == "vrt") {
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        let why = format!(
            "a virtual raster within another is not supported; convert it, for example with gdal_translate {name} out.tif"
        );
        return Err(refused(&path.display().to_string(), why));
    }
    if let Some(why) = foreign(path).or_else(|| content::of_file(path)) {
        return Err(refused(name, why));
    }
    let known = "supported are .tif, .asc, .hgt, .hgt.zip, .nc, .grd, .bil, .flt, .xyz, .dt0 to .dt2, .png, .r16, .r32, .npy, .exr and .vrt, folders of .tif, .hgt or .asc, and Zarr";
    Err(refused(name, format!("its extension is not that of a format for heights; {known}")))
}

/// [`read`] for bytes in memory: `extension` determines the format.
///
/// # Errors
/// The errors of [`read`].
pub fn parse(
    input: &mut dyn Input,
    name: &str,
    extension: &str,
    sidecar: Option<Sidecar>,
    request: impl Into<Request>,
) -> Result<Dem> {
    noted(input, |input| band(input, name, extension, sidecar, request.into()))
}

fn band(input: &mut dyn Input, name: &str, extension: &str, sidecar: Option<Sidecar>, request: Request) -> Result<Dem> {
    let mut told = sidecar.unwrap_or_default();
    // Sidecars of a file apply to all of it.
    let is_tiff = matches!(extension, "tif" | "tiff");
    if let Some(part) = request.part
        && !(is_read_in_parts(extension) && (is_tiff || told.mask.is_none()))
    {
        let whole = band(input, name, extension, Some(told), request.with_part(None))?;
        return whole.cropped(part).map_err(|why| refused(name, why));
    }
    let Request { allowed, .. } = request;
    if !SEVERAL_BANDS.contains(&extension) {
        request.choose(1).map_err(|why| refused(name, why))?;
    }
    if matches!(extension, "png" | "r16" | "r32") {
        // These readers compare nodata with stored samples.
        told.nodata = told.nodata.or(told.band(request.band).nodata.first().copied());
    }
    let mut dem = match extension {
        "tif" | "tiff" => geotiff::reader::read_with(input, name, request, &told)?,
        "asc" => asc::read(input, name, allowed)?,
        "hgt" => hgt::read(input, name, allowed)?,
        "hgt.zip" => {
            // The largest tile has 3601 x 3601 samples of two bytes, and its heights need twice as much.
            let most = (2 * 3601 * 3601).min(allowed / 2);
            let tile = zip::only_file(input, most).map_err(|why| refused(name, why))?;
            hgt::read(&mut Cursor::new(tile), name, allowed)?
        }
        "png" => grey::read(input, name, &told, allowed)?,
        "r16" => raw::read(input, name, Sample::U16, &told, allowed)?,
        "r32" => raw::read(input, name, Sample::F32, &told, allowed)?,
        "bil" | "flt" => {
            let (header, metadata) = (told.header.as_deref(), told.band(None));
            ehdr::read(input, name, header, extension == "flt", &metadata, told.vertical, allowed)?
        }
        "xyz" => xyz::read(input, name, allowed)?,
        "dt0" | "dt1" | "dt2" => dted::read(input, name, allowed)?,
        "exr" => exr_reader::read(input, name, &told, request)?,
        "nc" | "cdf" | "grd" => netcdf::reader::read(input, name, request)?,
        "npy" => {
            let grid = npy::read_within(input, name, told.cell.unwrap_or(1.0), allowed)?;
            let size = [grid.width(), grid.height()];
            let read = told.north_first(grid.into_data(), size[0]);
            read.and_then(|heights| Dem::new(size, heights, told.place(size[1])?)).map_err(|why| refused(name, why))?
        }
        other => return Err(refused(name, format!("the format .{other} is not supported"))),
    };
    // A GeoTIFF without position tags, but with a world file.
    if dem.place.is_none() && told.geotransform.is_some() {
        let heights = std::mem::take(&mut dem.heights);
        dem.heights = told.north_first(heights, dem.width).map_err(|why| refused(name, why))?;
        dem.place = told.place(dem.height).map_err(|why| refused(name, why))?;
    }
    if !is_tiff {
        // Samples between `low` and `high` are metres, and their nodata is known.
        let metadata = match extension {
            "png" | "r16" | "bil" | "flt" => BandMetadata::default(),
            _ => told.band(request.band).with_nodata(told.nodata),
        };
        // The reader of headers converts heights itself.
        let vertical = told.vertical.filter(|_| !matches!(extension, "png" | "r16" | "bil" | "flt"));
        convert(&mut dem, &told, request, &metadata, vertical).map_err(|why| refused(name, why))?;
    }
    if let Some(place) = &mut dem.place {
        told.complete(place).map_err(|why| refused(name, why))?;
        if place.keys.is_none() {
            dem.notes.extend(told.notes);
        }
        on_earth(place, dem.height).map_err(|why| refused(name, why))?;
    }
    Ok(dem)
}

/// Checks that no row is beyond a pole; a sample may be at a pole.
fn on_earth(place: &Placement, rows: usize) -> std::result::Result<(), String> {
    let Some(degrees) = place.unit.degrees() else { return Ok(()) };
    let [north, step] = [place.origin[1], place.step[1]].map(|at| at * degrees);
    let south = north - step * (rows as f64 - 1.0);
    match [north, south].into_iter().find(|latitude| latitude.abs() > 90.0 + step) {
        Some(beyond) => Err(format!(
            "its georeference is invalid: a latitude of {} degrees is beyond the pole; if its coordinates are metres, correct its coordinate system, for example with gdal_edit.py -a_srs",
            (beyond * 1e6).round() / 1e6
        )),
        None => Ok(()),
    }
}

/// Applies the separate mask file, and the nodata, scale, offset and unit that GDAL's sidecar and a vertical coordinate
/// system state.
fn convert(
    dem: &mut Dem,
    told: &Sidecar,
    request: Request,
    metadata: &BandMetadata,
    vertical: Option<f64>,
) -> std::result::Result<(), String> {
    if let Some(mask) = &told.mask {
        if told.first_row.as_deref() == Some("south") {
            return Err(
                "it has a .msk and rows from the south, which is not supported; save it with rows from the north"
                    .into(),
            );
        }
        let mut file = open::regular(mask, "read the mask").map_err(|error| error.to_string())?;
        let size = [dem.width, dem.height];
        geotiff::mask::external(
            &mut file,
            size.map(|samples| samples as u64),
            Part::whole(size),
            request,
            &mut dem.heights,
        )?;
    }
    let mut conversion = metadata.conversion(vertical)?;
    conversion.apply(&mut dem.heights);
    dem.notes.extend(conversion.notes());
    match request.part.is_none() && !samples::has_height(&dem.heights) {
        true => Err(format!("all of its {} x {} samples are nodata", dem.width, dem.height)),
        false => Ok(()),
    }
}
