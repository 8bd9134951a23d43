//! Sidecars of files of heights that lack some properties: NAME.json or NAME.toml, for NAME.r16 also NAME.r16.json.
//!
//! Keys: `width`, `height` (samples); `cell` (metres between samples); `low`, `high` (heights in metres of 0 and 65535,
//! or of 0 and 255); `byte_order` ("little", the default, or "big"); `first_row` ("north", the default, or "south");
//! `nodata` (the value of missing samples); `encoding` ("terrarium" or "terrain-rgb", for heights in the colors of a
//! picture); `geotransform` (six numbers in GDAL's order: west edge, column step, 0, north edge, 0, row step, which is
//! negative); `crs` ("EPSG:32632"); `wkt` (the coordinate system as well-known text). Other keys are ignored, so the
//! `summary.json` that `orogen generate` writes with `height.png` is also a sidecar.
//!
//! Missing properties of the position are taken from a world file, a `.prj` and an `.aux.xml` with the same name.

use std::path::{Path, PathBuf};

use serde::Deserialize;

use super::affine::Affine;
use super::band::BandMetadata;
use super::crs::keys::{self, GeoKeys};
use super::crs::unit::Unit;
use super::crs::wkt::MAX_LENGTH;
use super::crs::{arc_info, vertical};
use super::dem::{Placement, refused, turn_rows};
use super::encoding::Encoding;
use super::{aux_xml, ehdr, world_file};
use crate::{fs, open};
use orogen_grid::error::Result;

/// Maximum length of a text, in bytes.
const LONGEST: u64 = 1 << 20;

/// The content of a sidecar.
#[derive(Debug, Clone, Default, PartialEq, Deserialize)]
#[serde(default)]
pub struct Sidecar {
    /// Samples per row.
    pub width: Option<u64>,
    /// Number of rows.
    pub height: Option<u64>,
    /// Distance between samples, in metres.
    pub cell: Option<f64>,
    /// The height of a sample of 0, in metres.
    #[serde(alias = "height_min")]
    pub low: Option<f64>,
    /// The height of the largest possible sample, in metres.
    #[serde(alias = "height_max")]
    pub high: Option<f64>,
    /// "little" or "big".
    pub byte_order: Option<String>,
    /// "north" or "south".
    pub first_row: Option<String>,
    /// The value of missing samples.
    pub nodata: Option<f64>,
    /// The encoding of heights in the colors of a picture: "terrarium" or "terrain-rgb".
    pub encoding: Option<String>,
    /// The type of the samples in exports; for a picture, its encoding.
    pub sample: Option<String>,
    /// The transform from columns and rows to coordinates, in GDAL's order, for pixel corners.
    pub geotransform: Option<[f64; 6]>,
    /// The EPSG code of the coordinate system, with the prefix `EPSG:`.
    pub crs: Option<String>,
    /// The coordinate system as well-known text.
    pub wkt: Option<String>,
    /// The coordinate system from other sidecars, for a format that stores its position itself.
    #[serde(skip)]
    pub keys: Option<GeoKeys>,
    /// Metres per unit of the vertical coordinate system from other sidecars, if they state one.
    #[serde(skip)]
    pub vertical: Option<f64>,
    /// Whether the coordinates of the file are in seconds of arc, as stated by an ARC/INFO `.prj`.
    #[serde(skip)]
    pub is_in_seconds: bool,
    /// The metadata of each band in GDAL's sidecar, in the order of the bands.
    #[serde(skip)]
    pub bands: Vec<BandMetadata>,
    /// The text of the NAME.hdr file of a `.bil` or `.flt`.
    #[serde(skip)]
    pub header: Option<String>,
    /// Metadata that replaces the metadata of the band that is read, as in virtual rasters.
    #[serde(skip)]
    pub replaced: BandMetadata,
    /// The separate mask file: NAME.EXT.msk.
    #[serde(skip)]
    pub mask: Option<PathBuf>,
    /// Messages about sidecars that could not be interpreted.
    #[serde(skip)]
    pub notes: Vec<String>,
}

impl Sidecar {
    /// Reads all sidecars of `path`; `None` if there are none.
    ///
    /// # Errors
    /// If a sidecar cannot be read.
    pub fn beside(path: &Path) -> Result<Option<Sidecar>> {
        let mut places: Vec<PathBuf> = vec![own(path), path.with_extension("json"), path.with_extension("toml")];
        if path.file_name().is_some_and(|name| name == "height.png" || name == "height8.png") {
            places.push(path.with_file_name("summary.json"));
        }
        let told =
            places.into_iter().find(|place| fs::is_file(place)).map(|place| Sidecar::read(&place)).transpose()?;
        let mut all = told.clone().unwrap_or_default();
        let world = world_file::names(path).into_iter().find(|place| fs::is_file(place));
        if let Some(world) = world {
            let affine = text(&world, world_file::MAX_LENGTH, world_file::parse)?;
            all.geotransform.get_or_insert(affine.geotransform());
        }
        let (notes, projection) = (aux_xml(path), path.with_extension("prj"));
        if fs::is_file(&projection) {
            let parse =
                |wkt: &str| Ok((keys::of_wkt(wkt)?, vertical::metres_of_text(wkt), arc_info::is_in_seconds(wkt)));
            match text(&projection, MAX_LENGTH as u64, parse) {
                Ok((keys, vertical, is_in_seconds)) => {
                    (all.keys, all.vertical, all.is_in_seconds) = (Some(keys), vertical, is_in_seconds);
                }
                Err(why) => all.notes.push(format!("its coordinate system is not known: {why}")),
            }
        }
        let header = path.with_extension("hdr");
        if path.extension().is_some_and(|own| own.eq_ignore_ascii_case("bil") || own.eq_ignore_ascii_case("flt"))
            && fs::is_file(&header)
        {
            all.header = Some(text(&header, ehdr::MAX_LENGTH, |text| Ok(text.to_string()))?);
        }
        all.mask = Some(beside(path, ".msk")).filter(|mask| fs::is_file(mask));
        if fs::is_file(&notes) {
            let notes = text(&notes, aux_xml::MAX_LENGTH, aux_xml::parse)?;
            all.geotransform = all.geotransform.or(notes.affine.map(|affine| affine.geotransform()));
            all.vertical = all.vertical.or(notes.system.as_deref().and_then(vertical::metres_of_text));
            // An unknown system in GDAL's sidecar is not a reason to reject the heights.
            all.keys = all.keys.or(notes.system.and_then(|system| keys::of_text(&system).ok()));
            all.bands = notes.bands;
        }
        Ok((told.is_some() || all != Sidecar::default()).then_some(all))
    }

    fn read(path: &Path) -> Result<Sidecar> {
        let toml = path.extension().is_some_and(|extension| extension == "toml");
        text(path, LONGEST, |text| Sidecar::parse(text, toml))
    }

    /// Parses TOML or JSON.
    ///
    /// # Errors
    /// A message about what is wrong.
    pub fn parse(text: &str, toml: bool) -> std::result::Result<Sidecar, String> {
        let read: std::result::Result<Sidecar, String> = match toml {
            true => toml::from_str(text).map_err(|fault| fault.message().to_string()),
            false => serde_json::from_str(text).map_err(|fault| fault.to_string()),
        };
        let sidecar = read.map_err(|fault| format!("it is not a valid sidecar for heights: {fault}"))?;
        if sidecar.cell.is_some_and(|cell| !(cell.is_finite() && cell > 0.0)) {
            return Err("its `cell` is not greater than 0".into());
        }
        if [sidecar.low, sidecar.high].into_iter().flatten().any(|number| !number.is_finite()) {
            return Err("its `low` and `high` are not both numbers".into());
        }
        Ok(sidecar)
    }

    /// Whether samples are big-endian.
    ///
    /// # Errors
    /// If the value is neither "big" nor "little".
    pub fn big_endian(&self) -> std::result::Result<bool, String> {
        match self.byte_order.as_deref() {
            None | Some("little") => Ok(false),
            Some("big") => Ok(true),
            Some(other) => {
                Err(format!("the `byte_order` beside it is \"{}\", not \"little\" or \"big\"", other.escape_debug()))
            }
        }
    }

    /// Reorders samples row-major from the north.
    ///
    /// # Errors
    /// If `first_row` is neither "north" nor "south".
    pub fn north_first(&self, mut samples: Vec<f32>, width: usize) -> std::result::Result<Vec<f32>, String> {
        let from_south = match self.first_row.as_deref() {
            None => self.geotransform.is_some_and(|numbers| numbers[5] > 0.0),
            Some("north") => false,
            Some("south") => true,
            Some(other) => {
                let other = other.escape_debug();
                return Err(format!("the `first_row` beside it is \"{other}\", not \"north\" or \"south\""));
            }
        };
        if from_south {
            turn_rows(&mut samples, width);
        }
        Ok(samples)
    }

    /// The encoding of heights in the colors of a picture, if it is stated.
    #[must_use]
    pub fn encoding(&self) -> Option<Encoding> {
        let stated = |name: &str| [&self.encoding, &self.sample].into_iter().flatten().any(|own| own == name);
        Encoding::ALL.into_iter().find(|encoding| stated(encoding.name()))
    }

    /// The metadata of a band, from 1, in GDAL's sidecar, or the metadata that replaces it.
    pub fn band(&self, band: Option<u32>) -> BandMetadata {
        let index = band.unwrap_or(1).saturating_sub(1) as usize;
        self.bands.get(index).cloned().unwrap_or_default().replaced_by(&self.replaced)
    }

    /// The heights, in metres, of a sample of 0 and of the largest possible one, `most`: `low` and `high`, otherwise
    /// the result of the scale, offset and unit in GDAL's sidecar.
    ///
    /// # Errors
    /// If neither is stated, or a virtual raster replaces the metadata of a file with `low` and `high`.
    pub fn range(&self, most: f64) -> std::result::Result<[f64; 2], String> {
        let band = self.band(None);
        let has_scale = |band: &BandMetadata| band.scale.is_some() || band.offset.is_some();
        match (self.low, self.high) {
            (Some(_), Some(_)) if has_scale(&self.replaced) || self.replaced.unit.is_some() => Err(
                "a virtual raster states its scale, offset or unit, and `low` and `high` beside it state other heights; remove one of them".into(),
            ),
            (Some(low), Some(high)) => Ok([low, high]),
            _ if has_scale(&band) => Ok(band.conversion(self.vertical)?.range(most)),
            _ => Err(needs("low and high, the heights in metres of its lowest and highest sample value")),
        }
    }

    /// The position of `rows` rows of samples on their map; if only the cell is known, from the origin.
    ///
    /// # Errors
    /// A message if the position is not valid.
    pub fn place(&self, rows: usize) -> std::result::Result<Option<Placement>, String> {
        let Some(numbers) = self.geotransform else {
            let Some(cell) = self.cell else { return Ok(None) };
            let origin = [0.0, rows as f64 * cell - cell];
            return Ok(Some(Placement { origin, step: [cell; 2], unit: Unit::Metres(1.0), cell: None, keys: None }));
        };
        let lattice = Affine::of_geotransform(numbers).lattice(rows)?;
        let keys = self.system()?;
        let unit = keys.as_ref().map_or(Ok(Unit::guess(lattice.origin, lattice.step)), keys::unit)?;
        Ok(Some(Placement { origin: lattice.origin, step: lattice.step, unit, cell: self.cell, keys }))
    }

    /// The coordinate system of this sidecar, or of another sidecar of the file.
    fn system(&self) -> std::result::Result<Option<GeoKeys>, String> {
        if let Some(wkt) = &self.wkt {
            return keys::of_wkt(wkt).map(Some).map_err(|why| format!("the `wkt` beside it is not understood: {why}"));
        }
        let Some(crs) = &self.crs else { return Ok(self.keys.clone()) };
        keys::of_text(crs).map(Some).map_err(|why| format!("the `crs` beside it is \"{}\": {why}", crs.escape_debug()))
    }

    /// Adds the coordinate system of a `.prj` or `.aux.xml` to a position without one.
    ///
    /// # Errors
    /// A message if the system has a unit that is not supported.
    pub fn complete(&self, place: &mut Placement) -> std::result::Result<(), String> {
        if let (None, Some(keys)) = (&place.keys, &self.keys) {
            place.unit = keys::unit(keys)?;
            if self.is_in_seconds {
                for number in place.origin.iter_mut().chain(&mut place.step) {
                    *number /= 3600.0;
                }
            }
            place.keys = Some(keys.clone());
        }
        Ok(())
    }
}

/// The parsed content of a sidecar.
fn text<T>(path: &Path, most: u64, parse: impl Fn(&str) -> std::result::Result<T, String>) -> Result<T> {
    let name = path.display().to_string();
    let bytes = open::bytes(path, "read", most)?;
    let bytes = bytes.ok_or_else(|| refused(&name, format!("it is longer than {most} bytes")))?;
    parse(&String::from_utf8_lossy(&bytes)).map_err(|why| refused(&name, why))
}

/// GDAL's sidecar of a raster: NAME.EXT.aux.xml.
#[must_use]
pub fn aux_xml(path: &Path) -> PathBuf {
    beside(path, ".aux.xml")
}

/// The sidecar that belongs only to this file, not to other files called NAME: NAME.r16.json.
#[must_use]
pub fn own(path: &Path) -> PathBuf {
    beside(path, ".json")
}

/// The path with a suffix after its extension.
fn beside(path: &Path, more: &str) -> PathBuf {
    let mut name = path.file_name().unwrap_or_default().to_os_string();
    name.push(more);
    path.with_file_name(name)
}

/// The message for a file that lacks the properties `what`.
#[must_use]
pub fn needs(what: &str) -> String {
    format!("it lacks {what}; write them to a file of the same name with the extension .json or .toml")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn toml_and_json_say_the_same() {
        let toml =
            Sidecar::parse("width = 3\nheight = 2\ncell = 10\nlow = -5\nhigh = 95.5\nother = 'x'", true).unwrap();
        let json =
            "{\"width\": 3, \"height\": 2, \"cell\": 10.0, \"height_min\": -5, \"height_max\": 95.5, \"seed\": 7}";
        assert_eq!(toml, Sidecar::parse(json, false).unwrap());
        assert_eq!((toml.range(255.0), toml.big_endian()), (Ok([-5.0, 95.5]), Ok(false)));
        assert_eq!(toml.place(2).unwrap().unwrap().origin, [0.0, 10.0]);
    }

    #[test]
    fn rows_from_the_south_are_turned() {
        let south = Sidecar { first_row: Some("south".into()), ..Sidecar::default() };
        for (samples, expect) in [
            (vec![1.0, 2.0, 3.0, 4.0], vec![3.0, 4.0, 1.0, 2.0]),
            (vec![1.0, 2.0, 3.0, 4.0, 5.0, 6.0], vec![5.0, 6.0, 3.0, 4.0, 1.0, 2.0]),
            (vec![1.0, 2.0], vec![1.0, 2.0]),
        ] {
            assert_eq!(south.north_first(samples, 2).unwrap(), expect);
        }
        assert_eq!(own(Path::new("a/b.r16")), Path::new("a/b.r16.json"));
    }

    #[test]
    fn places_and_systems_are_told() {
        let text = "cell = 64.5\ngeotransform = [7, 0.001, 0, 46, 0, -0.001]\ncrs = 'EPSG:4326'";
        let place = Sidecar::parse(text, true).unwrap().place(3).unwrap().unwrap();
        assert_eq!((place.origin, place.unit, place.cell), ([7.0005, 45.9995], Unit::Degrees, Some(64.5)));
        assert_eq!(place.keys, Some(keys::of_epsg(4326, true)));
        let south = Sidecar { geotransform: Some([0.0, 10.0, 0.0, 0.0, 0.0, 10.0]), ..Sidecar::default() };
        assert_eq!(south.place(3).unwrap().unwrap().origin, [5.0, 25.0]);
        assert_eq!(south.north_first(vec![1.0, 2.0], 1).unwrap(), [2.0, 1.0]);
        for (text, expect) in [("crs = 'here'", "the `crs` beside it is \"here\""), ("wkt = 'here'", "not understood")]
        {
            let sidecar = Sidecar::parse(&format!("geotransform = [0, 1, 0, 0, 0, -1]\n{text}"), true).unwrap();
            assert!(sidecar.place(3).unwrap_err().contains(expect));
        }
    }

    #[test]
    fn scale_and_offset_of_the_band_state_the_range() {
        let band = BandMetadata { scale: Some(0.5), offset: Some(10.0), unit: Some("ft".into()), ..Default::default() };
        let scaled = Sidecar { bands: vec![band.clone()], ..Sidecar::default() };
        assert_eq!(scaled.range(200.0), Ok([3.048, 33.528]));
        let both = Sidecar { low: Some(0.0), high: Some(1.0), ..scaled };
        assert_eq!(both.range(200.0), Ok([0.0, 1.0]));
        assert!(Sidecar { replaced: band, ..both }.range(200.0).unwrap_err().contains("a virtual raster"));
    }

    #[test]
    fn wrong_ones_are_sentences() {
        for (text, expect) in [
            ("width = 'a'", "not a valid sidecar for heights"),
            ("= 3", "not a valid sidecar for heights"),
            ("cell = 0", "`cell` is not greater than 0"),
            ("low = nan", "not both numbers"),
        ] {
            let why = Sidecar::parse(text, true).unwrap_err();
            assert!(why.contains(expect), "{text}: {why}");
        }
        let across = Sidecar { first_row: Some("east".into()), ..Sidecar::default() };
        assert!(across.north_first(vec![1.0], 1).unwrap_err().contains("\"east\""));
        let middle = Sidecar { byte_order: Some("middle".into()), ..Sidecar::default() };
        assert!(middle.big_endian().unwrap_err().contains("\"middle\""));
        assert!(middle.range(255.0).unwrap_err().contains("low and high"));
    }
}
