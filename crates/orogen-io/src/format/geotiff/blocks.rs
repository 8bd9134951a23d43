//! The strips or tiles of a raster.

use super::entries::Tiff;
use super::unpack::Packing;
use crate::format::dem::afford_beside;

/// The blocks of a raster.
pub struct Blocks {
    /// Columns of a block.
    pub width: u64,
    /// Rows of a block.
    height: u64,
    /// Columns and rows of the raster.
    size: [u64; 2],
    offsets: Vec<u64>,
    lengths: Vec<u64>,
    tiled: bool,
}

/// The part of a block inside the raster.
#[derive(Debug, Clone, Copy)]
pub struct Block {
    /// The first column and row.
    pub left: u64,
    pub top: u64,
    /// Number of columns and rows.
    pub columns: u64,
    pub rows: u64,
}

/// Limits of the memory of decompression.
#[derive(Debug, Clone, Copy)]
pub struct Limits {
    /// Number of heights that are held.
    pub count: usize,
    /// Maximum memory in bytes.
    pub allowed: u64,
    /// Samples per pixel in a block.
    pub bands: usize,
}

impl Blocks {
    /// Reads the positions of the blocks of a raster of `size` columns and rows.
    pub fn read(tiff: &mut Tiff, size: [u64; 2]) -> Result<Blocks, String> {
        let [width, height] = size;
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
        Ok(Blocks { width: block_width, height: block_height, size, offsets, lengths, tiled })
    }

    /// Decompresses all blocks of a plane, row by row. `row` is the length of a row of a block in bytes. `visit` gets
    /// each block with its bytes; an absent block has none.
    pub fn each(
        &self,
        tiff: &mut Tiff,
        plane: usize,
        row: u64,
        packing: &Packing,
        limits: &Limits,
        mut visit: impl FnMut(Block, &mut [u8]),
    ) -> Result<(), String> {
        let [width, height] = self.size;
        let across = width.div_ceil(self.width);
        let first = (across * height.div_ceil(self.height)).saturating_mul(plane as u64);
        // A block may exceed the limit only as much as the tiles around a small raster.
        let largest = limits.allowed.saturating_mul(2 * limits.bands as u64).saturating_add(4 << 20);
        for (down, top) in (0..height).step_by(self.height as usize).enumerate() {
            let rows = self.height.min(height - top);
            for column in 0..across {
                let k = first.saturating_add(down as u64 * across + column) as usize;
                let (Some(&at), Some(&packed)) = (self.offsets.get(k), self.lengths.get(k)) else {
                    return Err(format!("it declares {} blocks but has more", self.offsets.len()));
                };
                let lines = if self.tiled { self.height } else { rows };
                let length = row.saturating_mul(lines);
                let there = packed > 0 && at > 0;
                if there && length > packed.saturating_mul(packing.max_growth()).min(largest) {
                    return Err(format!("a block of {packed} bytes should decompress to {length}; it is damaged"));
                }
                afford_beside(limits.count, length.saturating_add(packed), limits.allowed)?;
                let mut bytes = match there {
                    false => Vec::new(),
                    true => {
                        let size = [self.width as usize, lines as usize];
                        packing.unpack(tiff.bytes(at, packed, "samples")?, length as usize, size)?
                    }
                };
                let left = column * self.width;
                visit(Block { left, top, columns: self.width.min(width - left), rows }, &mut bytes);
            }
        }
        Ok(())
    }
}
