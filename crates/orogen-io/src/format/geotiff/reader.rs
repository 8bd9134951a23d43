//! Reading the heights of a GeoTIFF that any program wrote.
//!
//! Supported: classic TIFF and BigTIFF of both byte orders; one band, of several that are interleaved or separate, of
//! integers (8, 16, 32, 64 bits, signed or unsigned) or floats (32, 64); strips and tiles; no compression, LZW,
//! deflate, PackBits, Zstandard, LZMA and LERC (with deflate and Zstandard); predictors 1, 2 and 3; GDAL's nodata; a
//! band's scale and offset in GDAL's metadata; absent blocks. Sizes in a file are checked against its length.

use super::entries::Tiff;
use super::place;
use super::unpack::{Layout, Packing};
use crate::format::dem::{Dem, Input, Placement, Request, afford, afford_beside, refused, turn_rows};
use orogen_grid::error::Result;

/// Reads a band of a GeoTIFF. `name` is the file's name in errors.
///
/// # Errors
/// If it is not a TIFF, is damaged, does not contain heights, or is too large.
pub fn read(input: &mut dyn Input, name: &str, request: impl Into<Request>) -> Result<Dem> {
    open(input, request.into()).map_err(|why| refused(name, why))
}

/// The size and position of a GeoTIFF, without reading its samples.
///
/// # Errors
/// If it is not a TIFF, or its directory is damaged.
pub fn head(input: &mut dyn Input, name: &str) -> Result<([usize; 2], Option<Placement>)> {
    let read = |input| {
        let tiff = &mut Tiff::open(input)?;
        let size = [side(tiff, 256, "width")?, side(tiff, 257, "height")?];
        let [width, height] = size.map(usize::try_from);
        let (Ok(width), Ok(height)) = (width, height) else { return Err("its width or height is invalid".to_string()) };
        Ok(([width, height], place::find(tiff, height)?.place))
    };
    read(input).map_err(|why| refused(name, why))
}

/// The number of samples along a side.
fn side(tiff: &mut Tiff, tag: u16, what: &str) -> std::result::Result<u64, String> {
    tiff.one(tag)?.ok_or_else(|| format!("its directory has no {what}"))
}

/// The type of the samples.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Kind {
    Unsigned,
    Signed,
    Float,
}

/// The blocks of the raster.
struct Blocks {
    width: u64,
    height: u64,
    offsets: Vec<u64>,
    lengths: Vec<u64>,
    tiled: bool,
}

struct Samples {
    kind: Kind,
    layout: Layout,
    packing: Packing,
    /// The index, from 0, of the band among those interleaved in a block.
    band: usize,
    /// The first block of the band.
    plane: usize,
    nodata: Option<f64>,
    scale: f64,
    offset: f64,
}

fn open(input: &mut dyn Input, request: Request) -> std::result::Result<Dem, String> {
    let tiff = &mut Tiff::open(input)?;
    let (width, height) = (side(tiff, 256, "width")?, side(tiff, 257, "height")?);
    let count = afford(width, height, request.allowed)?;
    let mut samples = samples(tiff, request)?;
    let blocks = blocks(tiff, [width, height])?;
    let across = width.div_ceil(blocks.width);
    samples.plane *= (across * height.div_ceil(blocks.height)) as usize;
    let full = blocks.width.saturating_mul((samples.layout.size * samples.layout.bands) as u64);
    // A block may exceed the limit only as much as the tiles around a small raster.
    let largest = request.allowed.saturating_mul(2 * samples.layout.bands as u64).saturating_add(4 << 20);
    let mut heights: Vec<f32> = Vec::new();
    let mut bits = Vec::new();
    for (row, top) in (0..height).step_by(blocks.height as usize).enumerate() {
        let rows = blocks.height.min(height - top);
        for column in 0..across {
            let k = samples.plane + row * across as usize + column as usize;
            let (Some(&at), Some(&packed)) = (blocks.offsets.get(k), blocks.lengths.get(k)) else {
                return Err(format!("it declares {} blocks but has more", blocks.offsets.len()));
            };
            let lines = if blocks.tiled { blocks.height } else { rows };
            let length = full.saturating_mul(lines);
            let there = packed > 0 && at > 0;
            if there && length > packed.saturating_mul(samples.packing.max_growth()).min(largest) {
                return Err(format!("a block of {packed} bytes should decompress to {length}; it is damaged"));
            }
            afford_beside(count, length.saturating_add(packed), request.allowed)?;
            let mut bytes = match there {
                false => Vec::new(),
                true => {
                    let size = [blocks.width as usize, lines as usize];
                    samples.packing.unpack(tiff.bytes(at, packed, "samples")?, length as usize, size)?
                }
            };
            if column == 0 {
                // Allocate only for this row of blocks: a file with a wrong size fails early.
                let grown = heights.len() + (rows * width) as usize;
                heights.reserve(if row == 0 { count.min(2 * grown) } else { grown - heights.len() });
                heights.resize(grown, f32::NAN);
            }
            let left = column * blocks.width;
            let inside = blocks.width.min(width - left) as usize;
            for (j, line) in bytes.chunks_exact_mut(full as usize).take(rows as usize).enumerate() {
                samples.layout.row(line, &mut bits);
                let begin = ((top + j as u64) * width + left) as usize;
                let own = bits.iter().skip(samples.band).step_by(samples.layout.bands);
                for (height, bits) in heights[begin..begin + inside].iter_mut().zip(own) {
                    *height = samples.height(*bits);
                }
            }
        }
    }
    let found = place::find(tiff, height as usize)?;
    if found.from_south {
        turn_rows(&mut heights, width as usize);
    }
    if found.metres_high != 1.0 {
        heights.iter_mut().for_each(|h| *h = (f64::from(*h) * found.metres_high) as f32);
    }
    Dem::new([width as usize, height as usize], heights, found.place)
}

/// Maximum number of bands.
const MAX_BANDS: u64 = 4096;

fn samples(tiff: &mut Tiff, request: Request) -> std::result::Result<Samples, String> {
    let bands = tiff.one(277)?.unwrap_or(1);
    if !(1..=MAX_BANDS).contains(&bands) {
        return Err(format!("it has {bands} bands; 1 to {MAX_BANDS} are supported"));
    }
    let band = request.choose(bands as usize)?;
    let all_bits = tiff.wholes(258)?.unwrap_or_else(|| vec![1]);
    let bits = all_bits.first().copied().unwrap_or(1);
    if all_bits.iter().any(|other| *other != bits) {
        return Err("its bands have samples of different sizes".into());
    }
    let formats = tiff.wholes(339)?.unwrap_or_default();
    let kind = match formats.get(band).or(formats.first()).copied().unwrap_or(1) {
        1 => Kind::Unsigned,
        2 => Kind::Signed,
        3 => Kind::Float,
        other => return Err(format!("its sample format is {other}; only integers and floats are supported")),
    };
    let sound = match kind {
        Kind::Float => matches!(bits, 32 | 64),
        _ => matches!(bits, 8 | 16 | 32 | 64),
    };
    if !sound {
        let what = if kind == Kind::Float { "floats have 32 or 64" } else { "whole numbers have 8, 16, 32 or 64" };
        return Err(format!("its samples have {bits} bits; {what}"));
    }
    if tiff.one(266)?.unwrap_or(1) != 1 {
        return Err("its fill order is lowest bit first (tag 266), which is not supported".into());
    }
    let predictor = tiff.one(317)?.unwrap_or(1);
    if !(1..=3).contains(&predictor) || predictor == 3 && kind != Kind::Float {
        return Err(format!("its predictor {predictor} is invalid for its samples"));
    }
    let nodata = tiff.text(42113)?.and_then(|text| text.trim().parse().ok());
    let [scale, offset] = scale_and_offset(&tiff.text(42112)?.unwrap_or_default(), band);
    // Separate bands have their own blocks, one band after the other.
    let apart = tiff.one(284)?.unwrap_or(1) == 2;
    let (together, size) = (if apart { 1 } else { bands as usize }, bits as usize / 8);
    let packing = Packing {
        method: tiff.one(259)?.unwrap_or(1),
        outer: tiff.wholes(50674)?.and_then(|numbers| numbers.get(1).copied()).unwrap_or(0),
        bands: together,
        size,
    };
    Ok(Samples {
        kind,
        // Also for LERC: libtiff compresses a file's samples with their bytes in the file's order.
        layout: Layout { size, big_endian: tiff.big_endian, predictor, bands: together },
        packing,
        band: if apart { 0 } else { band },
        plane: if apart { band } else { 0 },
        nodata,
        scale,
        offset,
    })
}

/// A band's scale and offset in GDAL's metadata.
fn scale_and_offset(metadata: &str, band: usize) -> [f64; 2] {
    let document = roxmltree::Document::parse(metadata).ok();
    ["scale", "offset"].map(|role| {
        let items = document.iter().flat_map(|document| document.root_element().children());
        let own = |node: &roxmltree::Node| {
            node.attribute("role") == Some(role) && node.attribute("sample").map_or(Ok(0), str::parse) == Ok(band)
        };
        let number = items.filter(own).find_map(|node| node.text()?.trim().parse::<f64>().ok());
        number.filter(|number| number.is_finite()).unwrap_or(if role == "scale" { 1.0 } else { 0.0 })
    })
}

fn blocks(tiff: &mut Tiff, [width, height]: [u64; 2]) -> std::result::Result<Blocks, String> {
    let tiled = tiff.one(322)?.is_some();
    let (sizes, offsets, lengths) = match tiled {
        true => ([tiff.one(322)?, tiff.one(323)?], tiff.wholes(324)?, tiff.wholes(325)?),
        false => {
            let rows = tiff.one(278)?.unwrap_or(height).min(height);
            ([Some(width), Some(rows)], tiff.wholes(273)?, tiff.wholes(279)?)
        }
    };
    let [Some(block_width), Some(block_height)] = sizes else {
        return Err("its directory has no tile size".into());
    };
    // Tiles are multiples of 16; 2^16 per side is far beyond real ones.
    if block_width == 0 || block_height == 0 || tiled && block_width.max(block_height) > 1 << 16 {
        return Err(format!("its block size of {block_width} x {block_height} samples is invalid"));
    }
    let (Some(offsets), Some(lengths)) = (offsets, lengths) else {
        return Err("its directory has no offsets of strips or tiles".into());
    };
    // With separate bands there are more.
    let needed = width.div_ceil(block_width).saturating_mul(height.div_ceil(block_height));
    if (offsets.len() as u64) < needed || (lengths.len() as u64) < needed {
        let there = offsets.len().min(lengths.len());
        return Err(format!("it declares {there} blocks, and {width} x {height} samples need {needed}"));
    }
    Ok(Blocks { width: block_width, height: block_height, offsets, lengths, tiled })
}

impl Samples {
    /// A sample's bits as a height; NaN if it is missing.
    fn height(&self, bits: u64) -> f32 {
        let shift = 64 - 8 * self.layout.size as u32;
        let value = match (self.kind, self.layout.size) {
            (Kind::Unsigned, _) => bits as f64,
            (Kind::Signed, _) => ((bits << shift) as i64 >> shift) as f64,
            (Kind::Float, 4) => f64::from(f32::from_bits(bits as u32)),
            (Kind::Float, _) => f64::from_bits(bits),
        };
        // Some programs write nodata with fewer digits than the float has.
        let missing =
            self.nodata.is_some_and(|nodata| value == nodata || self.layout.size == 4 && value as f32 == nodata as f32);
        match missing {
            true => f32::NAN,
            false if self.scale == 1.0 && self.offset == 0.0 => value as f32,
            false => (value * self.scale + self.offset) as f32,
        }
    }
}
