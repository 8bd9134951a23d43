//! Reading the heights of a GeoTIFF written by any program.
//!
//! Supported: classic TIFF and BigTIFF of both byte orders; one band, or one of several interleaved or separate bands,
//! of integers (8, 16, 32, 64 bits, signed or unsigned) or floats (16, 32, 64); strips and tiles; no compression, LZW,
//! deflate, PackBits, Zstandard, LZMA and LERC (with deflate and Zstandard); predictors 1, 2 and 3; GDAL's nodata; a
//! band's scale, offset and unit in GDAL's metadata; masks in the file and in a separate file; an alpha band; absent
//! blocks. Sizes stated in a file are checked against its length.

use super::blocks::{Blocks, Limits};
use super::entries::Tiff;
use super::unpack::{Layout, Packing, Row};
use super::{mask, place};
use crate::format::band::BandMetadata;
use crate::format::dem::{Dem, Input, Part, Placement, Request, afford, beyond, refused, turn_rows};
use crate::format::sidecar::Sidecar;
use crate::format::stored::{Kind, Stored};
use crate::{open, samples};
use orogen_grid::error::Result;

/// Reads a band of a GeoTIFF. `name` is the file's name in errors.
///
/// # Errors
/// If it is not a TIFF, is damaged, does not contain heights, or is too large.
pub fn read(input: &mut dyn Input, name: &str, request: impl Into<Request>) -> Result<Dem> {
    read_with(input, name, request, &Sidecar::default())
}

/// [`read()`] with the content of sidecars: a mask, and values that replace the file's nodata, scale, offset and unit.
///
/// # Errors
/// The errors of [`read()`], and errors of the mask.
pub fn read_with(input: &mut dyn Input, name: &str, request: impl Into<Request>, told: &Sidecar) -> Result<Dem> {
    let request = request.into();
    let mut external = told.mask.as_deref().map(|path| open::regular(path, "read the mask")).transpose()?;
    let mask = external.as_mut().map(|file| file as &mut dyn Input);
    heights(input, request, told, mask).map_err(|why| refused(name, why))
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

struct Samples {
    layout: Layout,
    packing: Packing,
    /// The index of the band, from 0, among the bands interleaved in a block.
    band: usize,
    /// The number of preceding bands, if each band has its own blocks.
    plane: usize,
    /// The plane of the alpha band, and its index among the bands interleaved in a block. Samples whose alpha is 0 are
    /// missing.
    alpha: Option<[usize; 2]>,
    metadata: BandMetadata,
}

fn heights(
    input: &mut dyn Input,
    request: Request,
    told: &Sidecar,
    external: Option<&mut dyn Input>,
) -> std::result::Result<Dem, String> {
    let tiff = &mut Tiff::open(input)?;
    let size = [side(tiff, 256, "width")?, side(tiff, 257, "height")?];
    let [width, height] = request.part.map_or(size, |part| part.size.map(|samples| samples as u64));
    let count = afford(width, height, request.allowed)?;
    let whole = size.map(|samples| samples as usize);
    let wanted = request.part.unwrap_or(Part::whole(whole));
    if !wanted.is_within(whole) {
        return Err(beyond(whole));
    }
    let samples = samples(tiff, request)?;
    let found = place::find(tiff, whole[1])?;
    let part = if found.from_south { wanted.from_south(whole[1]) } else { wanted };
    let metadata = samples.metadata.clone().replaced_by(&told.band(request.band));
    // A separate `.prj` file applies to files without a coordinate system.
    let has_system = found.place.as_ref().is_some_and(|place| place.keys.is_some());
    let vertical = if has_system { found.vertical } else { found.vertical.or(told.vertical) };
    let mut conversion = metadata.conversion(vertical)?;
    let blocks = Blocks::read(tiff, size)?;
    let row = blocks.width.saturating_mul((samples.layout.stored.size * samples.layout.bands) as u64);
    let limits = Limits { count, allowed: request.allowed, bands: samples.layout.bands, part };
    let mut heights: Vec<f32> = Vec::new();
    let mut bits = Vec::new();
    let row_of = |first: usize, band: usize| Row { layout: samples.layout, first, band };
    blocks.each(tiff, samples.plane, row, &samples.packing, &limits, |block, bytes| {
        let [left, top] = block.to;
        if left == 0 {
            // Allocate only for this row of blocks: a file with a wrong size fails early.
            let grown = heights.len() + block.size[1] * part.size[0];
            heights.reserve(if top == 0 { count.min(2 * grown) } else { grown - heights.len() });
            samples::grow(&mut heights, grown, conversion.absent());
        }
        let lines = bytes.chunks_exact_mut(row as usize).skip(block.from[1]).take(block.size[1]);
        for (j, line) in lines.enumerate() {
            let begin = (top + j) * part.size[0] + left;
            let own = &mut heights[begin..begin + block.size[0]];
            row_of(block.from[0], samples.band).convert(line, &mut bits, &mut conversion, own);
        }
    })?;
    if let Some([plane, index]) = samples.alpha {
        blocks.each(tiff, plane, row, &samples.packing, &limits, |block, bytes| {
            for j in 0..block.size[1] {
                let begin = (block.to[1] + j) * part.size[0] + block.to[0];
                let own = &mut heights[begin..begin + block.size[0]];
                let Some(line) = bytes.chunks_exact_mut(row as usize).nth(block.from[1] + j) else {
                    own.fill(f32::NAN);
                    continue;
                };
                row_of(block.from[0], index).hide(line, &mut bits, own);
            }
        })?;
    }
    let damaged = mask::internal(tiff, size, part, request.allowed, &mut heights)?;
    if let Some(external) = external {
        mask::external(external, size, part, request, &mut heights)?;
    }
    if found.from_south {
        turn_rows(&mut heights, part.size[0]);
    }
    let mut dem = match request.part {
        Some(part) => Dem::part(part, heights, found.place),
        None => Dem::new(whole, heights, found.place)?,
    };
    dem.notes = conversion.notes_of(&dem.heights);
    dem.notes.extend(damaged);
    if found.is_depth {
        let note = "its vertical system counts depths downward, and its samples were read as heights; if they are depths, change their sign first, for example with gdal_calc.py --calc=-A";
        dem.notes.push(note.into());
    }
    Ok(dem)
}

/// Maximum number of bands.
const MAX_BANDS: u64 = 4096;

fn samples(tiff: &mut Tiff, request: Request) -> std::result::Result<Samples, String> {
    let bands = tiff.one(277)?.unwrap_or(1);
    if !(1..=MAX_BANDS).contains(&bands) {
        return Err(format!("it has {bands} bands; 1 to {MAX_BANDS} are supported"));
    }
    // Extra samples are the last ones; 1 and 2 are alpha.
    let extra = tiff.wholes(338)?.unwrap_or_default();
    let alpha = extra.iter().position(|kind| matches!(kind, 1 | 2));
    let alpha = alpha.and_then(|k| (bands as usize + k).checked_sub(extra.len()));
    let band = match (request.band, bands, alpha) {
        (None, 2, Some(1)) => 0,
        _ => request.choose(bands as usize)?,
    };
    let alpha = alpha.filter(|alpha| *alpha != band);
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
        Kind::Float => matches!(bits, 16 | 32 | 64),
        _ => matches!(bits, 8 | 16 | 32 | 64),
    };
    if !sound {
        let what = if kind == Kind::Float { "floats have 16, 32 or 64" } else { "whole numbers have 8, 16, 32 or 64" };
        return Err(format!(
            "its samples have {bits} bits; {what}; convert it, for example with gdal_translate -ot Float32"
        ));
    }
    if tiff.one(266)?.unwrap_or(1) != 1 {
        return Err("its fill order is lowest bit first (tag 266), which is not supported".into());
    }
    let predictor = tiff.one(317)?.unwrap_or(1);
    if !(1..=3).contains(&predictor) || predictor == 3 && kind != Kind::Float {
        return Err(format!("its predictor {predictor} is invalid for its samples"));
    }
    let nodata: Option<f64> = tiff.text(42113)?.and_then(|text| text.trim().parse().ok());
    let mut metadata = BandMetadata::of_tiff(&tiff.text(42112)?.unwrap_or_default(), band);
    metadata.nodata.extend(nodata);
    // Separate bands have their own blocks, one band after the other.
    let apart = tiff.one(284)?.unwrap_or(1) == 2;
    let (together, size) = (if apart { 1 } else { bands as usize }, bits as usize / 8);
    let packing = Packing {
        method: tiff.one(259)?.unwrap_or(1),
        outer: tiff.wholes(50674)?.and_then(|numbers| numbers.get(1).copied()).unwrap_or(0),
        bands: together,
        size,
    };
    let stored = Stored { kind, size, big_endian: tiff.big_endian };
    Ok(Samples {
        // Also for LERC: libtiff compresses samples whose bytes are in the file's order.
        layout: Layout { stored, predictor, bands: together },
        packing,
        band: if apart { 0 } else { band },
        plane: if apart { band } else { 0 },
        alpha: alpha.map(|alpha| if apart { [alpha, 0] } else { [0, alpha] }),
        metadata,
    })
}
