//! Lines and areas from vector files: SVG, GeoJSON and GeoPackage.

use std::path::{Path, PathBuf};

use orogen_grid::error::Result;
use orogen_grid::polylines::outline::{Outline, Piece};
use orogen_grid::words::{bytes_apart, count};

use super::dem::refused;
use super::outlines::{self, Collector, DrawingKind};
use super::{geojson_reader, gpkg_reader, svg_shapes};
use crate::{fs, open};

/// Maximum length of a text, in bytes.
pub const MAX_LENGTH: u64 = 32 << 20;

/// Maximum length of a GeoPackage, which may contain other layers and their indexes.
const MAX_PACKAGE: u64 = 256 << 20;

/// What follows the name of a GeoPackage before the name of one of its layers, as in QGIS.
const LAYER: &str = "|layername=";

/// A format of vector files.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Format {
    /// Scalable Vector Graphics.
    Svg,
    /// GeoJSON (RFC 7946).
    GeoJson,
    /// OGC GeoPackage.
    GeoPackage,
}

/// The file of a name and, of a GeoPackage, the layer that may follow it: `map.gpkg|layername=coast`.
#[must_use]
pub fn file_and_layer(name: &str) -> (&str, Option<&str>) {
    match name.split_once(LAYER) {
        Some((file, layer)) if Format::of_path(Path::new(file)) == Some(Format::GeoPackage) => (file, Some(layer)),
        _ => (name, None),
    }
}

/// The name of a file and, of a GeoPackage, its layer. The inverse of [`file_and_layer`].
#[must_use]
pub fn named(file: &str, layer: Option<&str>) -> String {
    layer.map_or_else(|| file.to_owned(), |layer| format!("{file}{LAYER}{layer}"))
}

impl Format {
    /// The format of a file with this name; `None` if its extension is not supported.
    #[must_use]
    pub fn of_path(path: &Path) -> Option<Format> {
        match path.extension()?.to_ascii_lowercase().to_str()? {
            "svg" => Some(Format::Svg),
            "geojson" | "json" => Some(Format::GeoJson),
            "gpkg" => Some(Format::GeoPackage),
            _ => None,
        }
    }

    /// Maximum length of a file, in bytes, and memory for reading, in bytes per byte of the file.
    fn limits(self) -> (u64, u64) {
        match self {
            Format::Svg | Format::GeoJson => (MAX_LENGTH, 16),
            Format::GeoPackage => (MAX_PACKAGE, 8),
        }
    }
}

/// The lines or areas of a file, in the file's unit, with y to the south.
#[derive(Debug, Clone, PartialEq)]
pub struct Drawing {
    /// The lines or the boundaries.
    pub outlines: Vec<Outline>,
    /// SHA-256 of the outlines.
    pub hash: [u8; 32],
}

impl Drawing {
    /// Reads the lines or the areas of a file, or of a [layer](Drawing::parse) of it. Takes about `allowed` bytes of
    /// memory at most.
    ///
    /// # Errors
    /// If the file cannot be read, is too large, is not valid, or does not contain any.
    pub fn read(path: &Path, layer: Option<&str>, kind: DrawingKind, allowed: u64) -> Result<Drawing> {
        let name = path.display().to_string();
        let Some(format) = Format::of_path(path) else {
            return Err(refused(
                &name,
                format!("the op `{}` reads .svg, .geojson and .gpkg; save the drawing as one of these", kind.op()),
            ));
        };
        if format == Format::GeoPackage && fs::metadata(log_of(path)).is_ok_and(|log| log.len() > 0) {
            return Err(refused(
                &name,
                format!(
                    "a part of it is still in {}; close the program that has it open, or export the layer to a new file",
                    log_of(path).display()
                ),
            ));
        }
        let (longest, memory_per_byte) = format.limits();
        let most = longest.min(allowed / memory_per_byte);
        let Some(bytes) = open::bytes(path, "read", most)? else {
            let [most, needed] = bytes_apart(most, allowed.min(longest * memory_per_byte));
            return Err(refused(
                &name,
                format!(
                    "it has more than {most}, the most that can be read in {needed} of memory; simplify its lines, or split it"
                ),
            ));
        };
        Drawing::parse(&bytes, format, layer, kind).map_err(|why| refused(&name, why))
    }

    /// Reads the lines or the areas of a file's content: of a GeoPackage, those of the layer with this name; without a
    /// name, those of the only layer that has any.
    ///
    /// # Errors
    /// A message if it is not valid, or does not contain any.
    pub fn parse(
        content: &[u8],
        format: Format,
        layer: Option<&str>,
        kind: DrawingKind,
    ) -> std::result::Result<Drawing, String> {
        let mut collector = Collector::new(kind);
        let text = || match std::str::from_utf8(content) {
            Ok(text) => Ok(text.trim_start_matches('\u{feff}')),
            Err(_) => Err("it is not text in UTF-8"),
        };
        match format {
            Format::Svg => svg_shapes::read(text()?, &mut collector)?,
            Format::GeoJson => geojson_reader::read(text()?, &mut collector)?,
            Format::GeoPackage => gpkg_reader::read(content, layer, &mut collector)?,
        }
        let (elements, other) = (elements(kind, format), kind.other());
        match (collector.outlines.is_empty(), collector.others) {
            (false, _) => {}
            (true, 0) => return Err(format!("it has no {}s; {elements} are read", kind.word())),
            (true, others) => {
                return Err(format!(
                    "it has no {}s, of which {elements} are read; the op `{}` reads its {}",
                    kind.word(),
                    other.op(),
                    count(others, other.word()),
                ));
            }
        }
        Ok(Drawing { hash: outlines::hash(&collector.outlines), outlines: collector.outlines })
    }

    /// Memory of the drawing, in bytes.
    #[must_use]
    pub fn memory(&self) -> u64 {
        let pieces: usize = self.outlines.iter().map(|outline| outline.pieces.len()).sum();
        (pieces * size_of::<Piece>() + self.outlines.len() * size_of::<Outline>()) as u64
    }
}

/// The write-ahead log of a database, which contains changes that are not in its file yet.
fn log_of(path: &Path) -> PathBuf {
    let mut log = path.as_os_str().to_owned();
    log.push("-wal");
    log.into()
}

/// The elements that are read.
fn elements(kind: DrawingKind, format: Format) -> &'static str {
    match (kind, format) {
        (DrawingKind::Lines, Format::Svg) => "`path`, `polyline` and `line`",
        (DrawingKind::Areas, Format::Svg) => "`path`, `polygon`, `rect`, `circle` and `ellipse`",
        (DrawingKind::Lines, Format::GeoJson | Format::GeoPackage) => "`LineString` and `MultiLineString`",
        (DrawingKind::Ridges, Format::Svg) => "`path`, `polyline`, `line` and, as summits, `circle`",
        (DrawingKind::Ridges, Format::GeoJson | Format::GeoPackage) => "`LineString`, `Point` and their `Multi` forms",
        (DrawingKind::Areas, Format::GeoJson | Format::GeoPackage) => "`Polygon` and `MultiPolygon`",
    }
}

#[cfg(test)]
mod tests;
