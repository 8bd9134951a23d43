//! A picture of a vertical section through blocks.

use std::io::{self, Write};

use orogen_grid::error::{Error, ErrorKind, Result};
use orogen_grid::grid::Window;
use orogen_io::format::png::{self, Picture, Pixel};

use super::kind::Block;
use super::picture::SKY;
use super::volume::BlockVolume;

/// Maximum side of a block in pixels, and the width of a picture up to which blocks have that size.
const MAX_SIDE: usize = 8;
const WIDTH: usize = 2048;

/// Maximum number of pixels along a side.
const MAX_PIXELS: usize = 16384;

/// Color of the air in caves and below overhangs.
const CAVE: [u8; 3] = [52, 48, 46];

/// The position of a section.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Section {
    /// Along a row of the window, from west to east; rows are counted from 0 in the north.
    Row(usize),
    /// Along a column of the window, from north to south; columns are counted from 0 in the west.
    Column(usize),
}

impl Section {
    /// Reads `row=N` or `column=N`.
    ///
    /// # Errors
    /// If it is neither.
    pub fn parse(text: &str) -> Result<Section> {
        let parsed = text.split_once('=').and_then(|(what, number)| match (what.trim(), number.trim().parse().ok()?) {
            ("row", row) => Some(Section::Row(row)),
            ("column", column) => Some(Section::Column(column)),
            _ => None,
        });
        parsed.ok_or_else(|| {
            let message =
                format!("`{}` is no section; it must be row=N or column=N, such as row=120", text.escape_debug());
            Error::new(ErrorKind::Request, message)
        })
    }

    /// The side of a block in pixels, in a picture of this many levels.
    ///
    /// # Errors
    /// If the window does not have this row or column, or the picture would have more than 16384 pixels along a side.
    pub fn check(self, window: &Window, levels: usize) -> Result<usize> {
        let (name, at, count) = match self {
            Section::Row(at) => ("row", at, window.height),
            Section::Column(at) => ("column", at, window.width),
        };
        if at >= count {
            let message = format!(
                "there is no {name} {at} to cut along; the window has the {name}s 0 to {}",
                count.saturating_sub(1)
            );
            return Err(Error::new(ErrorKind::Request, message));
        }
        let across = self.across(window);
        if across.max(levels) > MAX_PIXELS {
            let message = format!(
                "a picture of a section has at most {MAX_PIXELS} pixels along a side, and this one needs {across} x {levels}; use a smaller window or a larger cell"
            );
            return Err(Error::new(ErrorKind::Request, message));
        }
        Ok((WIDTH / across.max(1)).min(MAX_PIXELS / levels.max(1)).clamp(1, MAX_SIDE))
    }

    /// Number of blocks from left to right.
    fn across(self, window: &Window) -> usize {
        match self {
            Section::Row(_) => window.width,
            Section::Column(_) => window.height,
        }
    }

    /// Writes the picture: blocks in the colors of their kinds, the highest levels at the top.
    ///
    /// # Errors
    /// If [`check`](Section::check) fails, or `out` does.
    pub fn write(self, out: &mut dyn Write, volume: &BlockVolume, notes: &[(&str, &str)]) -> io::Result<()> {
        let levels = volume.levels.count.max(1);
        let side = self.check(&volume.window, levels)?;
        let across = self.across(&volume.window);
        let place = |k: usize| match self {
            Section::Row(row) => [k, row],
            Section::Column(column) => [column, k],
        };
        let grounds: Vec<Option<usize>> = (0..across).map(|k| volume.ground(place(k))).collect();
        let picture = Picture::new(side * across, side * levels, Pixel::Rgb8).with_notes(notes);
        png::write(out, &picture, |rows, bytes| {
            for (y, line) in rows.zip(bytes.chunks_exact_mut(3 * side * across)) {
                let level = levels - 1 - y / side;
                for (k, pixels) in line.chunks_exact_mut(3 * side).enumerate() {
                    let [column, row] = place(k);
                    let color = match volume.block([column as i64, row as i64, level as i64]) {
                        Block::Air if grounds[k].is_some_and(|ground| level < ground) => CAVE,
                        Block::Air => SKY,
                        block => block.kind().color,
                    };
                    pixels.chunks_exact_mut(3).for_each(|pixel| pixel.copy_from_slice(&color));
                }
            }
            Ok(())
        })
    }
}
