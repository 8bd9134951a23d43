//! All parts of the file except the samples: header, ghost area, and a directory per level.

use crate::format::crs::rebuilt::with_short;
use crate::format::dem::Georeference;
use orogen_grid::grid::Window;

/// Properties that readers may rely on. The final space leaves room for programs that edit the file to change NO to
/// YES.
const PROMISES: &str = "LAYOUT=IFDS_BEFORE_DATA\n\
    BLOCK_ORDER=ROW_MAJOR\n\
    BLOCK_LEADER=SIZE_AS_UINT4\n\
    BLOCK_TRAILER=LAST_4_BYTES_REPEATED\n\
    KNOWN_INCOMPATIBLE_EDITION=NO\n ";

/// The citation of the coordinate system, terminated as GeoTIFF requires.
const CITATION: &str = "Local metres|";

/// The key of the raster type, and pixel-is-point.
const RASTER_TYPE: u16 = 1025;
const POINT: u16 = 2;

/// Bytes before and after each tile.
pub const LEADER: u64 = 4;
pub const TRAILER: u64 = 4;

/// The full raster or an overview, as its directory describes it.
#[derive(Debug)]
pub struct Level {
    /// Samples per row.
    pub width: usize,
    /// Number of rows.
    pub height: usize,
    /// Size of each compressed tile in bytes, row by row.
    pub lengths: Vec<u32>,
}

/// The common description of all directories.
#[derive(Debug)]
#[non_exhaustive]
pub struct Description {
    /// The window of the full raster.
    pub window: Window,
    /// Samples along a tile's side.
    pub tile: usize,
    /// The nodata value.
    pub nodata: Option<f32>,
    /// The unit of the samples; empty if they have none.
    pub unit: String,
    /// The position of metres on a map.
    pub map: Option<Georeference>,
}

/// The file's first bytes, before the tiles, which are stored from the last level to the first. Classic TIFF if `big`
/// is false and the file is at most 4 GiB, otherwise BigTIFF.
pub fn head(description: &Description, levels: &[Level], big: bool) -> Vec<u8> {
    let wanted = if big { Form::Big } else { Form::Classic };
    let (form, begin) = match length(description, levels, wanted) {
        begin if begin + data_length(levels) > u64::from(u32::MAX) => {
            (Form::Big, length(description, levels, Form::Big))
        }
        begin => (wanted, begin),
    };
    encode(description, levels, &offsets(levels, begin), form)
}

/// Number of bytes of the tiles of all levels.
pub fn data_length(levels: &[Level]) -> u64 {
    levels.iter().flat_map(|level| &level.lengths).map(|length| LEADER + u64::from(*length) + TRAILER).sum()
}

/// The position of each tile of each level if the first leader is at `begin`.
fn offsets(levels: &[Level], begin: u64) -> Vec<Vec<u64>> {
    let mut next = begin;
    let mut offsets: Vec<Vec<u64>> = levels
        .iter()
        .rev()
        .map(|level| {
            let place = |length: &u32| {
                let here = next + LEADER;
                next = here + u64::from(*length) + TRAILER;
                here
            };
            level.lengths.iter().map(place).collect()
        })
        .collect();
    offsets.reverse();
    offsets
}

/// Length of the head in bytes; it does not depend on the offsets in it.
fn length(description: &Description, levels: &[Level], form: Form) -> u64 {
    let nowhere: Vec<Vec<u64>> = levels.iter().map(|level| vec![0; level.lengths.len()]).collect();
    encode(description, levels, &nowhere, form).len() as u64
}

fn encode(description: &Description, levels: &[Level], offsets: &[Vec<u64>], form: Form) -> Vec<u8> {
    let mut out = Vec::new();
    out.extend_from_slice(form.header());
    let ghost = format!("GDAL_STRUCTURAL_METADATA_SIZE={:06} bytes\n{PROMISES}", PROMISES.len());
    let first = (out.len() + form.word() + ghost.len()).next_multiple_of(form.alignment());
    form.put_word(&mut out, first as u64);
    out.extend_from_slice(ghost.as_bytes());
    out.resize(first, 0);
    for (k, (level, offsets)) in levels.iter().zip(offsets).enumerate() {
        let fields = fields(description, level, offsets, k, form);
        put_directory(&mut out, &fields, k + 1 == levels.len(), form);
    }
    out
}

/// One entry of a directory.
struct Field {
    tag: u16,
    kind: u16,
    count: u64,
    bytes: Vec<u8>,
}

impl Field {
    fn shorts(tag: u16, values: &[u16]) -> Field {
        Field::new(tag, 3, values.len(), values.iter().flat_map(|v| v.to_le_bytes()).collect())
    }

    fn longs(tag: u16, values: &[u32]) -> Field {
        Field::new(tag, 4, values.len(), values.iter().flat_map(|v| v.to_le_bytes()).collect())
    }

    fn doubles(tag: u16, values: &[f64]) -> Field {
        Field::new(tag, 12, values.len(), values.iter().flat_map(|v| v.to_le_bytes()).collect())
    }

    /// A text field; TIFF counts the terminating zero.
    fn text(tag: u16, text: &str) -> Field {
        Field::new(tag, 2, text.len() + 1, [text.as_bytes(), &[0]].concat())
    }

    fn new(tag: u16, kind: u16, count: usize, bytes: Vec<u8>) -> Field {
        Field { tag, kind, count: count as u64, bytes }
    }
}

/// The entries of level `k`, sorted by tag. Only the full raster has the position tags; overviews share them.
fn fields(description: &Description, level: &Level, offsets: &[u64], k: usize, form: Form) -> Vec<Field> {
    let Description { window, tile, nodata, unit, map } = description;
    let (width, height, tile) = (level.width as u32, level.height as u32, *tile as u32);
    let mut fields = vec![
        // Subfile type: 1 marks a reduced copy of the first.
        Field::longs(254, &[u32::from(k > 0)]),
        Field::longs(256, &[width]),
        Field::longs(257, &[height]),
        // One 32-bit sample per pixel, compressed with deflate, black is the minimum.
        Field::shorts(258, &[32]),
        Field::shorts(259, &[8]),
        Field::shorts(262, &[1]),
        Field::shorts(277, &[1]),
        Field::shorts(284, &[1]),
        Field::shorts(317, &[3]),
        Field::longs(322, &[tile]),
        Field::longs(323, &[tile]),
        form.offsets(324, offsets),
        Field::longs(325, &level.lengths),
        // Floating point.
        Field::shorts(339, &[3]),
    ];
    if k == 0 {
        // The tie point is column 0, row 0. GeoKey 1025 declares pixel-is-point, so the tie point has the coordinates
        // of the first sample. Subtraction from 0.0 avoids a -0.
        let local = ([window.east(0), 0.0 - window.south(0)], [window.cell; 2]);
        let ([east, north], steps) = map.as_ref().map_or(local, |map| map.of(window));
        fields.push(Field::doubles(33550, &[steps[0], steps[1], 0.0]));
        fields.push(Field::doubles(33922, &[0.0, 0.0, 0.0, east, north, 0.0]));
        match map.as_ref().and_then(|map| map.keys.as_ref()) {
            Some(keys) => {
                fields.push(Field::shorts(34735, &with_short(keys, RASTER_TYPE, POINT)));
                if !keys.doubles.is_empty() {
                    fields.push(Field::doubles(34736, &keys.doubles));
                }
                if !keys.text.is_empty() {
                    fields.push(Field::text(34737, &keys.text));
                }
            }
            None => {
                fields.push(Field::shorts(34735, &geo_keys()));
                fields.push(Field::text(34737, CITATION));
            }
        }
    }
    if k == 0 && !unit.is_empty() {
        let unit = unit.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;");
        let item = format!("<Item name=\"UNITTYPE\" sample=\"0\" role=\"unittype\">{unit}</Item>");
        fields.push(Field::text(42112, &format!("<GDALMetadata>{item}</GDALMetadata>")));
    }
    if let Some(nodata) = nodata {
        // Written as f64, whose digits every reader parses to exactly this number.
        fields.push(Field::text(42113, &f64::from(*nodata).to_string().to_lowercase()));
    }
    fields
}

/// The GeoKey directory of a user-defined system in metres, with pixel-is-point.
fn geo_keys() -> Vec<u16> {
    const USER_DEFINED: u16 = 32767;
    const TEXTS: u16 = 34737;
    const METRE: u16 = 9001;
    let keys = [
        [1024, 0, 1, USER_DEFINED],
        [RASTER_TYPE, 0, 1, POINT],
        [1026, TEXTS, CITATION.len() as u16, 0],
        [3076, 0, 1, METRE],
    ];
    [[1, 1, 0, keys.len() as u16]].iter().chain(&keys).flatten().copied().collect()
}

fn put_directory(out: &mut Vec<u8>, fields: &[Field], last: bool, form: Form) {
    let inline = form.word();
    let directory = form.count_length() + fields.len() * form.entry_length() + form.word();
    let mut values = Vec::new();
    let behind = (out.len() + directory).next_multiple_of(form.alignment());
    form.put_count(out, fields.len());
    for field in fields {
        out.extend_from_slice(&field.tag.to_le_bytes());
        out.extend_from_slice(&field.kind.to_le_bytes());
        form.put_word(out, field.count);
        if field.bytes.len() <= inline {
            out.extend_from_slice(&field.bytes);
            out.resize(out.len() + inline - field.bytes.len(), 0);
        } else {
            form.put_word(out, (behind + values.len()) as u64);
            values.extend_from_slice(&field.bytes);
            values.resize(values.len().next_multiple_of(form.alignment()), 0);
        }
    }
    let next = if last { 0 } else { behind + values.len() };
    form.put_word(out, next as u64);
    out.resize(behind, 0);
    out.append(&mut values);
}

/// The two forms of TIFF: offsets of four or of eight bytes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Form {
    Classic,
    Big,
}

impl Form {
    /// The bytes before the offset of the first directory.
    fn header(self) -> &'static [u8] {
        match self {
            Form::Classic => b"II\x2a\0",
            Form::Big => b"II\x2b\0\x08\0\0\0",
        }
    }

    /// Bytes per offset or count of values.
    fn word(self) -> usize {
        match self {
            Form::Classic => 4,
            Form::Big => 8,
        }
    }

    fn alignment(self) -> usize {
        match self {
            Form::Classic => 2,
            Form::Big => 8,
        }
    }

    /// Bytes of the count of entries.
    fn count_length(self) -> usize {
        match self {
            Form::Classic => 2,
            Form::Big => 8,
        }
    }

    fn entry_length(self) -> usize {
        4 + 2 * self.word()
    }

    /// In a file of at most 4 GiB all numbers fit in four bytes.
    fn put_word(self, out: &mut Vec<u8>, value: u64) {
        out.extend_from_slice(&value.to_le_bytes()[..self.word()]);
    }

    fn put_count(self, out: &mut Vec<u8>, count: usize) {
        out.extend_from_slice(&(count as u64).to_le_bytes()[..self.count_length()]);
    }

    fn offsets(self, tag: u16, offsets: &[u64]) -> Field {
        match self {
            Form::Classic => {
                let bytes = offsets.iter().flat_map(|offset| (*offset as u32).to_le_bytes()).collect();
                Field::new(tag, 4, offsets.len(), bytes)
            }
            Form::Big => {
                let bytes = offsets.iter().flat_map(|offset| offset.to_le_bytes()).collect();
                Field::new(tag, 16, offsets.len(), bytes)
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn levels(tiles: usize, length: u32) -> Vec<Level> {
        vec![Level { width: 512 * tiles, height: 512, lengths: vec![length; tiles] }]
    }

    #[test]
    fn a_file_past_four_gibibytes_is_big() {
        let description =
            Description { window: Window::new(1, 1, 1.0), tile: 512, nodata: None, unit: String::new(), map: None };
        let classic = |levels: &[Level]| head(&description, levels, false)[2] == 42;
        let mut levels = levels(4, 1 << 30);
        assert!(!classic(&levels));
        // Exactly 2^32 - 1 bytes is the largest size whose end fits in four bytes.
        levels[0].lengths[3] = 0;
        let others = head(&description, &levels, false).len() as u64 + data_length(&levels);
        levels[0].lengths[3] = (u64::from(u32::MAX) - others) as u32;
        assert!(classic(&levels));
        levels[0].lengths[3] += 1;
        assert!(!classic(&levels));
    }

    #[test]
    fn the_ghost_area_is_as_long_as_it_says() {
        assert_eq!(PROMISES.len(), 140);
        let description =
            Description { window: Window::new(1, 1, 1.0), tile: 512, nodata: None, unit: String::new(), map: None };
        for (big, start, first) in [(false, 8, 192), (true, 16, 200)] {
            let head = head(&description, &levels(1, 9), big);
            assert!(
                head[start..].starts_with(b"GDAL_STRUCTURAL_METADATA_SIZE=000140 bytes\nLAYOUT=IFDS_BEFORE_DATA\n")
            );
            assert_eq!(usize::from(head[if big { 8 } else { 4 }]), first);
        }
    }
}
