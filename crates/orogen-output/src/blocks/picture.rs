//! An isometric picture of blocks, seen from the south-east and from above at 2:1.

use std::io::{self, Write};

use orogen_grid::error::{Error, ErrorKind, Result};
use orogen_io::format::png::{self, Picture, Pixel};

use super::hash::hash;
use super::kind::Block;
use super::volume::BlockVolume;

/// Maximum width of the face of a block in pixels.
const MAX_FACE: usize = 8;

/// Faces get the largest size with which the picture is at most this wide, in pixels.
const WIDTH: usize = 2048;

/// Maximum number of pixels along a side.
const MAX_SIDE: usize = 8192;

/// Color of the background.
pub(super) const SKY: [u8; 3] = [222, 232, 240];

/// Light on the upper, the southern and the eastern face, and on a face in shadow.
const LIGHT: [f32; 3] = [1.0, 0.66, 0.82];
const SHADOW: f32 = 0.7;

/// Length of shadows, in blocks.
const REACH: i64 = 40;

/// Opacity of a block of water, and the increase for each further block of water below it.
const WATER: [f32; 2] = [0.62, 0.045];

/// Depth in blocks from which water is no more opaque.
const DEEP: i64 = 7;

/// The layout of a picture of a volume: its size and the size of a block.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Isometric {
    width: usize,
    height: usize,
    /// Width of a face in pixels; it descends by half of that.
    face: usize,
}

impl Isometric {
    /// Lays out a picture of this many blocks to the east, up and to the south.
    ///
    /// # Errors
    /// If it would have more than 8192 pixels along a side.
    pub fn new([east, up, south]: [usize; 3]) -> Result<Isometric> {
        let across = east + south;
        let face = (WIDTH / across.max(1)).clamp(2, MAX_FACE) / 2 * 2;
        let (width, height) = (across * face, (across * face).div_ceil(2) + up * face);
        if width > MAX_SIDE || height > MAX_SIDE {
            let message = format!(
                "a picture of blocks has at most {MAX_SIDE} pixels along a side, and this one needs {width} x {height}; use a smaller window or a larger cell"
            );
            return Err(Error::new(ErrorKind::Request, message));
        }
        Ok(Isometric { width, height, face })
    }

    /// Memory for drawing the picture, in bytes.
    #[must_use]
    pub fn memory(&self) -> u64 {
        3 * (self.width * self.height) as u64
    }

    /// Draws and writes the picture.
    ///
    /// # Errors
    /// If `out` fails.
    pub fn write(&self, out: &mut dyn Write, volume: &BlockVolume, notes: &[(&str, &str)]) -> io::Result<()> {
        let mut pixels = SKY.repeat(self.width * self.height);
        let [east, up, south] = volume.size().map(|side| side as i64);
        // From the back to the front.
        for row in 0..south {
            for column in 0..east {
                for level in 0..up {
                    let at = [column, row, level];
                    let block = volume.block(at);
                    if block != Block::Air {
                        self.draw(&mut pixels, volume, at, block);
                    }
                }
            }
        }
        let picture = Picture::new(self.width, self.height, Pixel::Rgb8).with_notes(notes);
        png::write(out, &picture, |rows, bytes| {
            bytes.copy_from_slice(&pixels[3 * rows.start * self.width..3 * rows.end * self.width]);
            Ok(())
        })
    }

    fn draw(&self, pixels: &mut [u8], volume: &BlockVolume, at: [i64; 3], block: Block) {
        let next = [[0, 0, 1], [0, 1, 0], [1, 0, 0]].map(|step| [0, 1, 2].map(|axis| at[axis] + step[axis]));
        let hides = |other: Block| other.is_solid() || block == Block::Water && other == Block::Water;
        let shown = next.map(|next| !hides(volume.block(next)));
        if !shown.contains(&true) {
            return;
        }
        let grain = 0.96 + (hash(volume.seed, at) % 64) as f32 / 800.0;
        let below = |below: &i64| volume.block([at[0], at[1], at[2] - below]) == Block::Water;
        let share = match block {
            Block::Water => WATER[0] + WATER[1] * (1..=DEEP).take_while(below).count() as f32,
            _ => 1.0,
        };
        let colors = [0, 1, 2].map(|side| {
            let is_lit = side == 1 || !is_shaded(volume, next[side]);
            let light = LIGHT[side] * grain * if is_lit { 1.0 } else { SHADOW };
            block.kind().color.map(|part| f32::from(part) * light)
        });
        let south = volume.window.height as i64;
        let up = volume.levels.count as i64;
        let face = self.face as i64;
        let left = (at[0] - at[1] + south - 1) * face;
        let middle = (at[0] + at[1] + 1) * face / 2 + (up - 1 - at[2]) * face;
        for across in 0..2 * face {
            let slant = (across.min(2 * face - 1 - across) + 1) / 2;
            let side = if across < face { 1 } else { 2 };
            let spans = [(0, middle - slant, middle + slant), (side, middle + slant, middle + slant + face)];
            for (side, from, to) in spans.into_iter().filter(|(side, ..)| shown[*side]) {
                for y in from..to {
                    let at = 3 * (y as usize * self.width + (left + across) as usize);
                    for (pixel, color) in pixels[at..at + 3].iter_mut().zip(colors[side]) {
                        *pixel = (f32::from(*pixel) * (1.0 - share) + color * share).round().min(255.0) as u8;
                    }
                }
            }
        }
    }
}

/// Whether there are blocks between a position and the sun, which is in the west.
fn is_shaded(volume: &BlockVolume, [column, row, level]: [i64; 3]) -> bool {
    (1..REACH).any(|step| volume.block([column - step, row + step / 2, level + step]).is_solid())
}
