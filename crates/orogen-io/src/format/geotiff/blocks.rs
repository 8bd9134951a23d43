//! The strips or tiles of a raster.

use super::entries::Tiff;
use super::unpack::Packing;
use crate::format::dem::{Part, afford_beside};

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

/// The part of a block that is read: its samples inside the part of the raster that is read.
#[derive(Debug, Clone, Copy)]
pub struct Block {
    /// The first column and row in the block.
    pub from: [usize; 2],
    /// The first column and row in the part.
    pub to: [usize; 2],
    /// Number of columns and rows.
    pub size: [usize; 2],
}

/// Memory limits for decompression.
#[derive(Debug, Clone, Copy)]
pub struct Limits {
    /// Number of heights in memory.
    pub count: usize,
    /// Maximum memory in bytes.
    pub allowed: u64,
    /// Samples per pixel in a block.
    pub bands: usize,
    /// The part of the raster that is read.
    pub part: Part,
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
        // With separate bands there are more blocks.
        let needed = width.div_ceil(block_width).saturating_mul(height.div_ceil(block_height));
        if (offsets.len() as u64) < needed || (lengths.len() as u64) < needed {
            let there = offsets.len().min(lengths.len());
            return Err(format!("it declares {there} blocks, and {width} x {height} samples need {needed}"));
        }
        Ok(Blocks { width: block_width, height: block_height, size, offsets, lengths, tiled })
    }

    /// Decompresses the blocks of a plane that overlap the part, row by row. `row` is the length of a row of a block in
    /// bytes. `visit` receives each block with its bytes; an absent block has no bytes.
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
        let [begin, end] = [limits.part.from, limits.part.end()].map(|at| at.map(|at| at as u64));
        // With a margin, because the tiles of a small raster may be larger than the raster.
        let largest = limits.allowed.saturating_mul(2 * limits.bands as u64).saturating_add(4 << 20);
        for down in begin[1] / self.height..end[1].div_ceil(self.height) {
            let top = down * self.height;
            let rows = self.height.min(height - top);
            for column in begin[0] / self.width..end[0].div_ceil(self.width) {
                let k = first.saturating_add(down * across + column) as usize;
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
                let (from, until) = (
                    [left.max(begin[0]), top.max(begin[1])],
                    [(left + self.width).min(end[0]), (top + rows).min(end[1])],
                );
                let block = Block {
                    from: [from[0] - left, from[1] - top].map(|at| at as usize),
                    to: [from[0] - begin[0], from[1] - begin[1]].map(|at| at as usize),
                    size: [until[0] - from[0], until[1] - from[1]].map(|count| count as usize),
                };
                visit(block, &mut bytes);
            }
        }
        Ok(())
    }
}
