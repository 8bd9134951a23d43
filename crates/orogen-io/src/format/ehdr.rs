//! ESRI's headerless rasters, `.bil` and `.flt`, with a text file NAME.hdr: one band, rows from the north.
//!
//! Keys read: `nrows`, `ncols`, `nbits`, `pixeltype`, `byteorder`, `skipbytes`, `bandrowbytes`, `totalrowbytes`,
//! `ulxmap` and `ulymap` (the center of the first pixel) with `xdim` and `ydim`, or `xllcorner`, `yllcorner` and
//! `cellsize` as in `.asc`, `zunits` and `nodata`. The defaults are GDAL's: `.bil` has integers of 8 bits, which are
//! unsigned unless nodata is negative; `.flt` has floats of 32 bits.

use std::collections::BTreeMap;
use std::io::Read;

use super::affine::{Affine, Lattice};
use super::band::BandMetadata;
use super::crs::unit::{Unit, length_of_name};
use super::dem::{Dem, Input, Placement, afford, length, refused};
use super::stored::{Kind, Stored};
use crate::samples;
use orogen_grid::error::Result;

/// Maximum length of a header, in bytes.
pub const MAX_LENGTH: u64 = 1 << 16;

/// Reads a raster. `header` is the text of the file NAME.hdr, `is_float` is true for a `.flt`, `metadata` is what
/// GDAL's sidecar states about the band, and `vertical` is metres per unit of the vertical system of a `.prj`.
///
/// # Errors
/// If there is no header, it is not valid, the file does not have the stated length, or heights take more than
/// `allowed` bytes.
pub fn read(
    input: &mut dyn Input,
    name: &str,
    header: Option<&str>,
    is_float: bool,
    metadata: &BandMetadata,
    vertical: Option<f64>,
    allowed: u64,
) -> Result<Dem> {
    open(input, header, is_float, metadata, vertical, allowed).map_err(|why| refused(name, why))
}

/// The keys of a header, in lower case, with their values.
struct Header(BTreeMap<String, String>);

impl Header {
    fn parse(text: &str) -> std::result::Result<Header, String> {
        let mut keys = BTreeMap::new();
        for line in text.lines() {
            let mut words = line.split_whitespace();
            let (Some(key), Some(value)) = (words.next(), words.next()) else { continue };
            if keys.insert(key.to_ascii_lowercase(), value.to_string()).is_some() {
                return Err(format!("its .hdr states `{}` twice", key.escape_debug()));
            }
        }
        Ok(Header(keys))
    }

    fn text(&self, key: &str) -> Option<&str> {
        self.0.get(key).map(String::as_str)
    }

    fn number(&self, key: &str) -> std::result::Result<Option<f64>, String> {
        let Some(text) = self.text(key) else { return Ok(None) };
        let number = text.parse().ok().filter(|number: &f64| number.is_finite());
        number.map(Some).ok_or_else(|| format!("`{key}` in its .hdr is `{}`, not a number", text.escape_debug()))
    }

    fn whole(&self, key: &str) -> std::result::Result<Option<u64>, String> {
        let Some(number) = self.number(key)? else { return Ok(None) };
        let is_whole = number.fract() == 0.0 && (0.0..1e15).contains(&number);
        is_whole.then_some(Some(number as u64)).ok_or_else(|| format!("`{key}` in its .hdr is {number}"))
    }

    /// The position of `rows` rows, if the header states it.
    fn place(&self, rows: u64) -> std::result::Result<Option<Placement>, String> {
        let cell = self.number("cellsize")?;
        let step = [self.number("xdim")?.or(cell), self.number("ydim")?.or(cell)];
        let [Some(dx), Some(dy)] = step else { return Ok(None) };
        let middle = |corner: Option<f64>, center: Option<f64>, step: f64| center.or(corner.map(|at| at + 0.5 * step));
        let (east, north) = match (self.number("ulxmap")?, self.number("ulymap")?) {
            (Some(east), Some(north)) => (east, north),
            _ => {
                let east = middle(self.number("xllcorner")?, self.number("xllcenter")?, dx);
                let south = middle(self.number("yllcorner")?, self.number("yllcenter")?, dy);
                let (Some(east), Some(south)) = (east, south) else { return Ok(None) };
                (east, south + (rows as f64 - 1.0) * dy)
            }
        };
        let Lattice { origin, step, .. } = Affine([dx, 0.0, east, 0.0, -dy, north]).lattice(rows as usize)?;
        Ok(Some(Placement { origin, step, unit: Unit::guess(origin, step), cell: None, keys: None }))
    }
}

fn open(
    input: &mut dyn Input,
    header: Option<&str>,
    is_float: bool,
    metadata: &BandMetadata,
    vertical: Option<f64>,
    allowed: u64,
) -> std::result::Result<Dem, String> {
    let there = length(input)?;
    let header = Header::parse(header.ok_or("it lacks its header, a file of the same name with the extension .hdr")?)?;
    let (Some(width), Some(height)) = (header.whole("ncols")?, header.whole("nrows")?) else {
        return Err("its .hdr has no ncols and nrows".into());
    };
    let count = afford(width, height, allowed)?;
    if header.whole("nbands")?.unwrap_or(1) != 1 {
        return Err("its .hdr states several bands; convert it to GeoTIFF with gdal_translate".into());
    }
    let bits = header.whole("nbits")?.unwrap_or(if is_float { 32 } else { 8 });
    let nodata = header.number("nodata")?.or(header.number("nodata_value")?);
    let word = |key: &str| header.text(key).unwrap_or_default().to_ascii_uppercase();
    let kind = match word("pixeltype").as_str() {
        "FLOAT" => Kind::Float,
        "" if is_float => Kind::Float,
        "SIGNEDINT" => Kind::Signed,
        "" if nodata.is_some_and(|nodata| nodata < 0.0) => Kind::Signed,
        "" | "UNSIGNEDINT" => Kind::Unsigned,
        other => return Err(format!("`pixeltype` in its .hdr is `{}`", other.escape_debug())),
    };
    let size = match (kind, bits) {
        (Kind::Float, 32 | 64) | (Kind::Signed | Kind::Unsigned, 8 | 16 | 32) => bits / 8,
        _ => return Err(format!("its .hdr states samples of {bits} bits, which is not supported")),
    };
    let big = match word("byteorder").as_str() {
        "" | "I" | "LSBFIRST" | "L" => false,
        "M" | "MSBFIRST" => true,
        other => return Err(format!("`byteorder` in its .hdr is `{}`", other.escape_debug())),
    };
    let row = header.whole("totalrowbytes")?.or(header.whole("bandrowbytes")?).unwrap_or(width * size);
    let skip = header.whole("skipbytes")?.unwrap_or(0);
    let needed = row.checked_mul(height).and_then(|bytes| bytes.checked_add(skip));
    if row < width * size || row > width * size + (1 << 16) || needed.is_none_or(|needed| needed > there) {
        return Err(format!("{width} x {height} samples of {size} bytes do not fit in its {there} bytes"));
    }
    let metadata = BandMetadata::default().with_nodata(nodata).replaced_by(metadata);
    let stated = header.text("zunits").and_then(length_of_name);
    let mut conversion = metadata.conversion(vertical.or(stated))?;
    let stored = Stored { kind, size: size as usize, big_endian: big };
    let mut heights = samples::filled(f32::NAN, count);
    let mut bytes = vec![0; row as usize];
    std::io::copy(&mut input.take(skip), &mut std::io::sink()).map_err(|cause| cause.to_string())?;
    for heights in heights.chunks_exact_mut(width as usize) {
        input.read_exact(&mut bytes).map_err(|cause| cause.to_string())?;
        stored.convert(&bytes, &mut conversion, heights);
    }
    let mut dem = Dem::new([width as usize, height as usize], heights, header.place(height)?)?;
    dem.notes = conversion.notes();
    Ok(dem)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::io::Cursor;

    fn parse(header: &str, bytes: &[u8], is_float: bool) -> std::result::Result<Dem, String> {
        open(&mut Cursor::new(bytes), Some(header), is_float, &BandMetadata::default(), None, 1 << 20)
    }

    #[test]
    fn headers_are_read_as_gdal_reads_them() {
        let bytes: Vec<u8> = [1i16, 2, 3, 4, -5, 6].into_iter().flat_map(i16::to_be_bytes).collect();
        let head = "NROWS 2\nNCOLS 3\nNBITS 16\nBYTEORDER M\n";
        assert_eq!(parse(head, &bytes, false).unwrap().heights[4], 65531.0);
        let dem = parse(&format!("{head}PIXELTYPE SIGNEDINT\n"), &bytes, false).unwrap();
        assert_eq!((dem.heights[4], dem.place), (-5.0, None));
        let dem =
            parse(&format!("{head}ULXMAP 100\nULYMAP 200\nXDIM 10\nYDIM 10\nNODATA -5\n"), &bytes, false).unwrap();
        assert_eq!((dem.missing(), dem.place.unwrap().origin), (1, [100.0, 200.0]));
        let floats: Vec<u8> = [1f32, 2.0, 3.0, 4.0, -5.0, 6.0].into_iter().flat_map(f32::to_le_bytes).collect();
        let head = "ncols 3\nnrows 2\nxllcorner 100\nyllcorner 200\ncellsize 10\nbyteorder LSBFIRST\n";
        let dem = parse(head, &floats, true).unwrap();
        assert_eq!((dem.heights[4], dem.place.unwrap().origin), (-5.0, [105.0, 215.0]));
        // A header of the file, and rows with padding.
        let padded = [&[9][..], &[1, 2, 0, 3, 4, 0]].concat();
        let dem = parse("nrows 2\nncols 2\nskipbytes 1\ntotalrowbytes 3", &padded, false).unwrap();
        assert_eq!(dem.heights, [1.0, 2.0, 3.0, 4.0]);
    }

    #[test]
    fn damaged_ones_are_messages() {
        for (header, expect) in [
            ("", "no ncols and nrows"),
            ("ncols 2\nnrows 2", "do not fit in its 3 bytes"),
            ("ncols 2\nncols 2", "`ncols` twice"),
            ("ncols x\nnrows 2", "`ncols` in its .hdr is `x`"),
            ("ncols 1\nnrows 1\nnbits 12", "12 bits"),
            ("ncols 1\nnrows 1\nnbands 3", "several bands"),
            ("ncols 1\nnrows 1\nskipbytes 900000000000000", "do not fit"),
            ("ncols 1\nnrows 1\ncellsize 1\nulxmap 1e300\nulymap 0", "is not on a map"),
        ] {
            let why = parse(header, &[0, 1, 2], false).unwrap_err();
            assert!(why.contains(expect), "{header:?}: {why}");
        }
        let none = open(&mut Cursor::new([0]), None, false, &BandMetadata::default(), None, 1 << 20);
        assert!(none.unwrap_err().contains("extension .hdr"));
    }
}
