//! Reading the heights of a GeoTIFF that any program wrote.
//!
//! Read: classic TIFF and BigTIFF of both byte orders; one band of whole numbers (8, 16, 32, 64 bits, signed or not) or floats (32,
//! 64); strips and tiles; none, LZW, deflate and PackBits; predictors 1, 2 and 3; GDAL's nodata; a band's scale and offset in
//! GDAL's metadata; blocks that are left out. Never believed further than the file's bytes go.

use super::entries::Tiff;
use super::place;
use super::unpack::{Layout, MOST_GROWTH, unpack};
use crate::error::Result;
use crate::format::dem::{Dem, Input, afford, afford_beside, refused};

/// Reads a GeoTIFF whose heights take no more than `allowed` bytes. `name` is what errors call it.
///
/// # Errors
/// If it is no TIFF, is damaged, holds something else than one band of heights, or is too large.
pub fn read(input: &mut dyn Input, name: &str, allowed: u64) -> Result<Dem> {
    open(input, allowed).map_err(|why| refused(name, why))
}

/// What the samples' bits mean.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Kind {
    Unsigned,
    Signed,
    Float,
}

/// How the raster is cut.
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
    nodata: Option<f64>,
    scale: f64,
    offset: f64,
}

fn open(input: &mut dyn Input, allowed: u64) -> std::result::Result<Dem, String> {
    let tiff = &mut Tiff::open(input)?;
    let lacks = |what: &str| format!("its directory does not tell its {what}");
    let width = tiff.one(256)?.ok_or_else(|| lacks("width"))?;
    let height = tiff.one(257)?.ok_or_else(|| lacks("height"))?;
    let count = afford(width, height, allowed)?;
    let samples = samples(tiff)?;
    let compression = tiff.one(259)?.unwrap_or(1);
    let blocks = blocks(tiff, [width, height])?;
    let across = width.div_ceil(blocks.width);
    let full = blocks.width * samples.layout.size as u64;
    let mut heights: Vec<f32> = Vec::new();
    let mut bits = Vec::new();
    for (row, top) in (0..height).step_by(blocks.height as usize).enumerate() {
        let rows = blocks.height.min(height - top);
        for column in 0..across {
            let k = row * across as usize + column as usize;
            let (Some(&at), Some(&packed)) = (blocks.offsets.get(k), blocks.lengths.get(k)) else {
                return Err(format!("it tells of {} blocks and has more", blocks.offsets.len()));
            };
            let length = full * if blocks.tiled { blocks.height } else { rows };
            if packed > 0 && at > 0 && length > packed.saturating_mul(MOST_GROWTH) {
                return Err(format!("a block of {packed} bytes is said to hold {length}: it is damaged"));
            }
            afford_beside(count, length.saturating_add(packed), allowed)?;
            let mut bytes = match packed == 0 || at == 0 {
                true => Vec::new(),
                false => unpack(compression, tiff.bytes(at, packed, "samples")?, length as usize)?,
            };
            if column == 0 {
                // Room for this row of blocks only: a file that lies about its size ends before it has cost much.
                let grown = heights.len() + (rows * width) as usize;
                heights.reserve(if row == 0 { count.min(2 * grown) } else { grown - heights.len() });
                heights.resize(grown, f32::NAN);
            }
            let left = column * blocks.width;
            let inside = blocks.width.min(width - left) as usize;
            for (j, line) in bytes.chunks_exact_mut(full as usize).take(rows as usize).enumerate() {
                samples.layout.row(line, &mut bits);
                let begin = ((top + j as u64) * width + left) as usize;
                for (height, bits) in heights[begin..begin + inside].iter_mut().zip(&bits) {
                    *height = samples.height(*bits);
                }
            }
        }
    }
    let found = place::find(tiff, height as usize)?;
    if found.from_south {
        let width = width as usize;
        for j in 0..height as usize / 2 {
            let (upper, lower) = heights.split_at_mut((height as usize - 1 - j) * width);
            upper[j * width..(j + 1) * width].swap_with_slice(&mut lower[..width]);
        }
    }
    if found.metres_high != 1.0 {
        heights.iter_mut().for_each(|h| *h = (f64::from(*h) * found.metres_high) as f32);
    }
    Dem::new([width as usize, height as usize], heights, found.place)
}

fn samples(tiff: &mut Tiff) -> std::result::Result<Samples, String> {
    let bands = tiff.one(277)?.unwrap_or(1);
    if bands != 1 {
        return Err(format!("it has {bands} bands; heights have one: choose it, such as by gdal_translate -b 1"));
    }
    let bits = tiff.one(258)?.unwrap_or(1);
    let kind = match tiff.one(339)?.unwrap_or(1) {
        1 => Kind::Unsigned,
        2 => Kind::Signed,
        3 => Kind::Float,
        other => return Err(format!("its samples are of the format {other}; heights are whole numbers or floats")),
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
        return Err("its bytes have their lowest bit first (tag 266), which no heights have".into());
    }
    let predictor = tiff.one(317)?.unwrap_or(1);
    if !(1..=3).contains(&predictor) || predictor == 3 && kind != Kind::Float {
        return Err(format!("it has the predictor {predictor}, which such samples cannot have"));
    }
    let nodata = tiff.text(42113)?.and_then(|text| text.trim().parse().ok());
    let metadata = tiff.text(42112)?.unwrap_or_default();
    let number = |role: &str| {
        let (_, rest) = metadata.split_once(&format!("role=\"{role}\">"))?;
        rest.split('<').next()?.trim().parse::<f64>().ok().filter(|number| number.is_finite())
    };
    Ok(Samples {
        kind,
        layout: Layout { size: bits as usize / 8, big_endian: tiff.big_endian, predictor },
        nodata,
        scale: number("scale").unwrap_or(1.0),
        offset: number("offset").unwrap_or(0.0),
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
        return Err("its directory does not tell the size of its tiles".into());
    };
    // Tiles are multiples of 16; 2^16 a side is far beyond any.
    if block_width == 0 || block_height == 0 || tiled && block_width.max(block_height) > 1 << 16 {
        return Err(format!("its blocks are said to have {block_width} x {block_height} samples: it is damaged"));
    }
    let (Some(offsets), Some(lengths)) = (offsets, lengths) else {
        return Err("its directory does not tell where its samples lie".into());
    };
    let needed = width.div_ceil(block_width).saturating_mul(height.div_ceil(block_height));
    if (offsets.len() as u64) < needed || (lengths.len() as u64) < needed {
        let there = offsets.len().min(lengths.len());
        return Err(format!("it tells of {there} blocks, and {width} x {height} samples take {needed}"));
    }
    Ok(Blocks { width: block_width, height: block_height, offsets, lengths, tiled })
}

impl Samples {
    /// A sample's bits as a height, NaN where it is missing.
    fn height(&self, bits: u64) -> f32 {
        let shift = 64 - 8 * self.layout.size as u32;
        let value = match (self.kind, self.layout.size) {
            (Kind::Unsigned, _) => bits as f64,
            (Kind::Signed, _) => ((bits << shift) as i64 >> shift) as f64,
            (Kind::Float, 4) => f64::from(f32::from_bits(bits as u32)),
            (Kind::Float, _) => f64::from_bits(bits),
        };
        // Some programs write nodata with fewer digits than its float has.
        let missing =
            self.nodata.is_some_and(|nodata| value == nodata || self.layout.size == 4 && value as f32 == nodata as f32);
        match missing {
            true => f32::NAN,
            false if self.scale == 1.0 && self.offset == 0.0 => value as f32,
            false => (value * self.scale + self.offset) as f32,
        }
    }
}
