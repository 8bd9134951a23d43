//! Lines and areas from vector files: SVG and GeoJSON.

use std::path::Path;

use orogen_grid::error::Result;
use orogen_grid::polylines::outline::{Outline, Piece};
use orogen_grid::words::{bytes_apart, count};

use super::dem::refused;
use super::outlines::{self, Collector, DrawingKind};
use super::{geojson_reader, svg_shapes};
use crate::open;

/// Maximum length of a file, in bytes.
pub const MAX_LENGTH: u64 = 32 << 20;

/// Memory for reading, in bytes per byte of a file.
const MEMORY_PER_BYTE: u64 = 16;

/// A format of vector files.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Format {
    /// Scalable Vector Graphics.
    Svg,
    /// GeoJSON (RFC 7946).
    GeoJson,
}

impl Format {
    /// The format of a file with this name; `None` if its extension is not supported.
    #[must_use]
    pub fn of_path(path: &Path) -> Option<Format> {
        match path.extension()?.to_ascii_lowercase().to_str()? {
            "svg" => Some(Format::Svg),
            "geojson" | "json" => Some(Format::GeoJson),
            _ => None,
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
    /// Reads the lines or the areas of a file. Takes about `allowed` bytes of memory at most.
    ///
    /// # Errors
    /// If the file cannot be read, is too large, is not valid, or does not contain any.
    pub fn read(path: &Path, kind: DrawingKind, allowed: u64) -> Result<Drawing> {
        let name = path.display().to_string();
        let Some(format) = Format::of_path(path) else {
            return Err(refused(
                &name,
                format!("the op `{}` reads .svg and .geojson; save the drawing as one of these", kind.op()),
            ));
        };
        let most = MAX_LENGTH.min(allowed / MEMORY_PER_BYTE);
        let Some(bytes) = open::bytes(path, "read", most)? else {
            let [most, needed] = bytes_apart(most, allowed.min(MAX_LENGTH * MEMORY_PER_BYTE));
            return Err(refused(
                &name,
                format!(
                    "it has more than {most}, the most that can be read in {needed} of memory; simplify its lines, or split it"
                ),
            ));
        };
        let text = String::from_utf8(bytes).map_err(|_| refused(&name, "it is not text in UTF-8"))?;
        Drawing::parse(&text, format, kind).map_err(|why| refused(&name, why))
    }

    /// Reads the lines or the areas of a text.
    ///
    /// # Errors
    /// A message if it is not valid, or does not contain any.
    pub fn parse(text: &str, format: Format, kind: DrawingKind) -> std::result::Result<Drawing, String> {
        let mut collector = Collector::new(kind);
        let text = text.trim_start_matches('\u{feff}');
        match format {
            Format::Svg => svg_shapes::read(text, &mut collector)?,
            Format::GeoJson => geojson_reader::read(text, &mut collector)?,
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

/// The elements that are read.
fn elements(kind: DrawingKind, format: Format) -> &'static str {
    match (kind, format) {
        (DrawingKind::Lines, Format::Svg) => "`path`, `polyline` and `line`",
        (DrawingKind::Areas, Format::Svg) => "`path`, `polygon`, `rect`, `circle` and `ellipse`",
        (DrawingKind::Lines, Format::GeoJson) => "`LineString` and `MultiLineString`",
        (DrawingKind::Areas, Format::GeoJson) => "`Polygon` and `MultiPolygon`",
    }
}

#[cfg(test)]
mod tests;
