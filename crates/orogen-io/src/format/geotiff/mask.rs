//! Masks: a raster of one bit or one byte per sample, which is 0 where heights are missing. In the file, it has its own
//! directory. GDAL also writes separate files NAME.EXT.msk, which are TIFFs as well.

use super::blocks::{Blocks, Limits};
use super::entries::Tiff;
use super::unpack::{Packing, mask};
use crate::format::dem::{Input, Part, Request};

/// Sets heights to NaN where the file's own mask is 0. Without a mask nothing changes. Returns a note if the file is
/// damaged after its raster: heights could be read, but a mask may have been lost.
pub fn internal(
    tiff: &mut Tiff,
    size: [u64; 2],
    part: Part,
    allowed: u64,
    heights: &mut [f32],
) -> Result<Option<String>, String> {
    match tiff.seek_mask(size) {
        Ok(false) => Ok(None),
        Err(why) => Ok(Some(format!("a mask or overviews after its raster cannot be read: {why}"))),
        Ok(true) => {
            apply(tiff, size, part, 1, allowed, heights).map_err(|why| format!("its mask cannot be read: {why}"))?;
            Ok(None)
        }
    }
}

/// Sets heights to NaN where a separate mask file is 0. A mask file has one band for all bands, or one for each.
pub fn external(
    input: &mut dyn Input,
    size: [u64; 2],
    part: Part,
    request: Request,
    heights: &mut [f32],
) -> Result<(), String> {
    let mut read = |input| {
        let tiff = &mut Tiff::open(input)?;
        let own = [tiff.one(256)?.unwrap_or(0), tiff.one(257)?.unwrap_or(0)];
        if own != size {
            return Err(format!(
                "it has {} x {} samples, and the heights have {} x {}",
                own[0], own[1], size[0], size[1]
            ));
        }
        apply(tiff, size, part, request.band.unwrap_or(1), request.allowed, heights)
    };
    read(input).map_err(|why| format!("the .msk beside it cannot be read: {why}"))
}

fn apply(
    tiff: &mut Tiff,
    size: [u64; 2],
    part: Part,
    band: u32,
    allowed: u64,
    heights: &mut [f32],
) -> Result<(), String> {
    let bands = tiff.one(277)?.unwrap_or(1).clamp(1, 4096) as usize;
    let band = (band as usize).saturating_sub(1).min(bands - 1);
    let bits = tiff.one(258)?.unwrap_or(1);
    let apart = tiff.one(284)?.unwrap_or(1) == 2;
    let together = if apart { 1 } else { bands };
    if !(bits == 8 || bits == 1 && together == 1) {
        return Err(format!("it has {bits} bits per sample; 1 and 8 are supported"));
    }
    if tiff.one(266)?.unwrap_or(1) != 1 || tiff.one(317)?.unwrap_or(1) != 1 {
        return Err("its bits are reversed or predicted, which is not supported".into());
    }
    let method = tiff.one(259)?.unwrap_or(1);
    let packing = Packing { method, outer: 0, bands: together, size: 1 };
    let blocks = Blocks::read(tiff, size)?;
    let row = match bits {
        1 => blocks.width.div_ceil(8),
        _ => blocks.width.saturating_mul(together as u64),
    };
    let (plane, inner) = if apart { (band, 0) } else { (0, band) };
    let limits = Limits { count: heights.len(), allowed, bands: together, part };
    blocks.each(tiff, plane, row, &packing, &limits, |block, bytes| {
        let row = row as usize;
        for j in 0..block.size[1] {
            let line = bytes.get((block.from[1] + j) * row..).unwrap_or_default();
            let at = (block.to[1] + j) * part.size[0] + block.to[0];
            let heights = &mut heights[at..at + block.size[0]];
            mask(&line[..line.len().min(row)], bits, together, inner, block.from[0], heights);
        }
    })
}
