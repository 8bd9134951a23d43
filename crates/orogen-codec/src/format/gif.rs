//! GIF animations.
//!
//! Follows "Graphics Interchange Format, Version 89a" (CompuServe, 1990), with the extension that repeats the animation
//! endlessly in browsers. A GIF has at most 256 colors. One palette is used for all frames, which avoids flicker. It is
//! found by median cut (P. Heckbert, "Color image quantization for frame buffer display", 1982). Intermediate colors
//! are dithered with the same pattern in every frame (B. Bayer's ordered dither, 1973). Unchanged pixels are
//! transparent, which compresses better.

use std::io::{self, Write};

use super::png::Animation;

/// Number of colors, and the index that means "unchanged".
const COLORS: usize = 255;
const SAME: u8 = 255;

/// Bits per channel for counting and looking up colors.
const BITS: usize = 5;
const SIDE: usize = 1 << BITS;

/// The colors of an animation.
#[derive(Debug, Clone)]
pub struct Palette {
    colors: Vec<[u8; 3]>,
    /// The index of the nearest color, for each of `SIDE`^3 colors.
    nearest: Vec<u8>,
    /// Amplitude of the dither, in units of a byte's steps.
    spread: i32,
}

/// A box of colors that are replaced with one color.
#[derive(Debug, Clone)]
struct Cluster {
    /// Cells of the histogram.
    cells: Vec<usize>,
    /// The variation along the channel with the largest variation, weighted by the number of pixels; then that channel.
    spread: f64,
    channel: usize,
}

impl Palette {
    /// The palette for pixels of three bytes each.
    pub fn of(pixels: &[u8]) -> Palette {
        let mut counts = vec![0u32; SIDE * SIDE * SIDE];
        let mut sums = vec![[0u64; 3]; SIDE * SIDE * SIDE];
        for pixel in pixels.chunks_exact(3) {
            let cell = cell([pixel[0], pixel[1], pixel[2]].map(i32::from));
            counts[cell] += 1;
            sums[cell].iter_mut().zip(pixel).for_each(|(sum, byte)| *sum += u64::from(*byte));
        }
        let mean = |cell: usize, channel: usize| sums[cell][channel] as f64 / f64::from(counts[cell]);
        let cluster = |cells: Vec<usize>| {
            let pixels: f64 = cells.iter().map(|cell| f64::from(counts[*cell])).sum();
            let vary = [0, 1, 2].map(|channel| {
                let weigh = |power: f64| {
                    let value = |cell: &usize| f64::from(counts[*cell]) * libm::pow(mean(*cell, channel), power);
                    cells.iter().map(value).sum::<f64>() / pixels
                };
                // The eye distinguishes shades of green best, and shades of blue worst.
                (weigh(2.0) - weigh(1.0) * weigh(1.0)).max(0.0) * [0.9, 1.4, 0.6][channel]
            });
            let channel = (0..3).fold(0, |best, channel| if vary[channel] > vary[best] { channel } else { best });
            // The square root gives more weight to rare colors.
            Cluster { cells, spread: vary[channel] * pixels.sqrt(), channel }
        };
        let mut clusters = vec![cluster((0..counts.len()).filter(|cell| counts[*cell] > 0).collect())];
        while clusters.len() < COLORS {
            let widest = (0..clusters.len())
                .filter(|at| clusters[*at].cells.len() > 1)
                .reduce(|best, at| if clusters[at].spread > clusters[best].spread { at } else { best });
            let Some(widest) = widest else {
                break;
            };
            let Cluster { mut cells, channel, .. } = clusters.swap_remove(widest);
            cells.sort_by(|a, b| mean(*a, channel).total_cmp(&mean(*b, channel)).then(a.cmp(b)));
            let all: u64 = cells.iter().map(|cell| u64::from(counts[*cell])).sum();
            let mut below = 0;
            let middle = cells.iter().position(|cell| {
                below += u64::from(counts[*cell]);
                2 * below >= all
            });
            let cut = middle.map_or(1, |at| at + 1).clamp(1, cells.len() - 1);
            let upper = cells.split_off(cut);
            clusters.push(cluster(cells));
            clusters.push(cluster(upper));
        }
        let mut colors: Vec<[u8; 3]> = clusters
            .iter()
            .map(|cluster| {
                let pixels: u64 = cluster.cells.iter().map(|cell| u64::from(counts[*cell])).sum();
                [0, 1, 2].map(|channel| {
                    let sum: u64 = cluster.cells.iter().map(|cell| sums[*cell][channel]).sum();
                    ((sum + pixels / 2) / pixels.max(1)) as u8
                })
            })
            .collect();
        // The order must not depend on how the boxes were split.
        colors.sort_unstable();
        colors.dedup();
        Palette::new(colors)
    }

    fn new(colors: Vec<[u8; 3]>) -> Palette {
        let off = |a: [i32; 3], b: [u8; 3]| {
            let [r, g, b] = [0, 1, 2].map(|c| (a[c] - i32::from(b[c])) * (a[c] - i32::from(b[c])));
            3 * r + 5 * g + 2 * b
        };
        let near = |color: [i32; 3], but: Option<usize>| {
            let all = (0..colors.len()).filter(|at| Some(*at) != but);
            all.reduce(|best, at| if off(color, colors[at]) < off(color, colors[best]) { at } else { best })
        };
        let half = 1 << (7 - BITS);
        let nearest = (0..SIDE * SIDE * SIDE)
            .map(|cell| {
                let channel = |shift: usize| (((cell >> shift) & (SIDE - 1)) << (8 - BITS)) as i32 + half;
                near([channel(2 * BITS), channel(BITS), channel(0)], None).unwrap_or(0) as u8
            })
            .collect();
        // The median distance between colors.
        let mut gaps: Vec<i32> = (0..colors.len())
            .filter_map(|at| {
                let color = colors[at].map(i32::from);
                near(color, Some(at)).map(|other| off(color, colors[other]))
            })
            .collect();
        let middle = gaps.len() / 2;
        let gap = if gaps.is_empty() { 0 } else { *gaps.select_nth_unstable(middle).1 };
        Palette { colors, nearest, spread: (f64::from(gap / 10).sqrt() as i32).clamp(0, 24) }
    }

    /// The index of the color for a pixel at a position.
    fn index(&self, pixel: &[u8], x: usize, y: usize) -> u8 {
        let push = (i32::from(BAYER[y & 7][x & 7]) * 2 - 63) * self.spread / 64;
        let color = [0, 1, 2].map(|c| (i32::from(pixel[c]) + push).clamp(0, 255));
        self.nearest[cell(color)]
    }
}

/// The cell of the histogram that contains a color.
fn cell(color: [i32; 3]) -> usize {
    color.iter().fold(0, |cell, byte| cell << BITS | *byte as usize >> (8 - BITS))
}

const BAYER: [[u8; 8]; 8] = [
    [0, 32, 8, 40, 2, 34, 10, 42],
    [48, 16, 56, 24, 50, 18, 58, 26],
    [12, 44, 4, 36, 14, 46, 6, 38],
    [60, 28, 52, 20, 62, 30, 54, 22],
    [3, 35, 11, 43, 1, 33, 9, 41],
    [51, 19, 59, 27, 49, 17, 57, 25],
    [15, 47, 7, 39, 13, 45, 5, 37],
    [63, 31, 55, 23, 61, 29, 53, 21],
];

/// Writes an animation. `fill` computes the frames one at a time: it receives the frame's number, from 0, and the
/// frame's bytes, three per pixel. The animation repeats endlessly. The delay of a frame is rounded to hundredths of a
/// second, with a minimum of two, which is also the minimum in browsers.
///
/// Fails if `out` or `fill` fails, or if the picture has no pixels or more than 65 535 per side.
pub fn write_animation(
    out: &mut dyn Write,
    size: [usize; 2],
    palette: &Palette,
    animation: Animation,
    mut fill: impl FnMut(u32, &mut [u8]) -> io::Result<()>,
) -> io::Result<()> {
    write_frames(out, size, palette, animation, &mut fill)
}

fn write_frames(
    out: &mut dyn Write,
    size: [usize; 2],
    palette: &Palette,
    animation: Animation,
    fill: &mut dyn FnMut(u32, &mut [u8]) -> io::Result<()>,
) -> io::Result<()> {
    let [width, height] = size;
    let side = |side: usize| match u16::try_from(side) {
        Ok(n) if n > 0 => Ok(n.to_le_bytes()),
        _ => Err(io::Error::new(
            io::ErrorKind::InvalidInput,
            format!("a GIF must have 1 to 65535 pixels per side, not {side}"),
        )),
    };
    let (wide, high) = (side(width)?, side(height)?);
    if animation.frames == 0 {
        return Err(io::Error::new(io::ErrorKind::InvalidInput, "an animation needs at least one frame"));
    }
    out.write_all(b"GIF89a")?;
    out.write_all(&[wide[0], wide[1], high[0], high[1]])?;
    // A palette of 256 colors that applies to all frames.
    out.write_all(&[0xf7, 0, 0])?;
    let mut table = [0u8; 768];
    table.chunks_exact_mut(3).zip(&palette.colors).for_each(|(entry, color)| entry.copy_from_slice(color));
    out.write_all(&table)?;
    out.write_all(b"\x21\xff\x0bNETSCAPE2.0\x03\x01\x00\x00\x00")?;
    let [low, high_delay] = ((animation.delay + 5) / 10).max(2).to_le_bytes();
    let mut bytes = vec![0; width * height * 3];
    let (mut before, mut indices) = (Vec::new(), vec![0u8; width * height]);
    for frame in 0..animation.frames {
        fill(frame, &mut bytes)?;
        for (at, (index, pixel)) in indices.iter_mut().zip(bytes.chunks_exact(3)).enumerate() {
            *index = palette.index(pixel, at % width, at / width);
        }
        // Frames are drawn over each other, and one index is transparent.
        out.write_all(&[0x21, 0xf9, 4, 0b101, low, high_delay, SAME, 0])?;
        out.write_all(&[0x2c, 0, 0, 0, 0, wide[0], wide[1], high[0], high[1], 0])?;
        match before.is_empty() {
            true => pack(out, indices.iter().copied())?,
            false => {
                let same = |(now, before): (&u8, &u8)| if now == before { SAME } else { *now };
                pack(out, indices.iter().zip(&before).map(same))?;
            }
        }
        before.clone_from(&indices);
    }
    out.write_all(b"\x3b")
}

/// Converts gray values to pixels of three bytes.
pub fn rgb_of_grey(greys: &[u8], rgb: &mut [u8]) {
    rgb.chunks_exact_mut(3).zip(greys).for_each(|(rgb, grey)| rgb.fill(*grey));
}

/// Maximum number of bits of a code.
const LONGEST: u32 = 12;
const CLEAR: u16 = 256;
const END: u16 = 257;

/// Writes indices with GIF's variant of LZW (J. Ziv, A. Lempel and T. Welch): codes of 9 to 12 bits, the lowest bit
/// first, in blocks of up to 255 bytes.
fn pack(out: &mut dyn Write, indices: impl Iterator<Item = u8>) -> io::Result<()> {
    let mut blocks = Blocks { out, block: Vec::with_capacity(255), bits: 0, held: 0 };
    blocks.out.write_all(&[8])?;
    // For each code and each next index, the code of both together; 0 if there is none.
    let mut after = vec![0u16; 256 << LONGEST];
    let (mut next, mut width) = (END + 1, 9);
    blocks.push(CLEAR, width)?;
    let mut code: Option<u16> = None;
    for index in indices {
        let Some(known) = code else {
            code = Some(u16::from(index));
            continue;
        };
        let slot = usize::from(known) << 8 | usize::from(index);
        if after[slot] != 0 {
            code = Some(after[slot]);
            continue;
        }
        blocks.push(known, width)?;
        if next < 1 << LONGEST {
            after[slot] = next;
            // The decoder learns each code one step later than the encoder.
            width += u32::from(next == 1 << width);
            next += 1;
        } else {
            blocks.push(CLEAR, width)?;
            after.fill(0);
            (next, width) = (END + 1, 9);
        }
        code = Some(u16::from(index));
    }
    if let Some(code) = code {
        blocks.push(code, width)?;
        // The decoder adds one more code after this one.
        width += u32::from(next == 1 << width && width < LONGEST);
    }
    blocks.push(END, width)?;
    blocks.finish()
}

/// Packs codes into blocks.
struct Blocks<'a> {
    out: &'a mut dyn Write,
    block: Vec<u8>,
    bits: u32,
    held: u32,
}

impl Blocks<'_> {
    fn push(&mut self, code: u16, width: u32) -> io::Result<()> {
        self.bits |= u32::from(code) << self.held;
        self.held += width;
        while self.held >= 8 {
            self.byte()?;
        }
        Ok(())
    }

    fn byte(&mut self) -> io::Result<()> {
        self.block.push(self.bits as u8);
        self.bits >>= 8;
        self.held = self.held.saturating_sub(8);
        if self.block.len() == 255 { self.flush() } else { Ok(()) }
    }

    fn flush(&mut self) -> io::Result<()> {
        if !self.block.is_empty() {
            self.out.write_all(&[self.block.len() as u8])?;
            self.out.write_all(&self.block)?;
            self.block.clear();
        }
        Ok(())
    }

    fn finish(mut self) -> io::Result<()> {
        if self.held > 0 {
            self.byte()?;
        }
        self.flush()?;
        self.out.write_all(&[0])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::full_disk::Full;

    /// Decodes compressed indices; returns them and the number of bytes read.
    fn unpack(bytes: &[u8]) -> (Vec<u8>, usize) {
        assert_eq!(bytes[0], 8);
        let (mut data, mut at) = (Vec::new(), 1);
        while bytes[at] != 0 {
            let length = usize::from(bytes[at]);
            data.extend_from_slice(&bytes[at + 1..at + 1 + length]);
            at += length + 1;
        }
        let (mut bit, mut width) = (0usize, 9usize);
        let mut code = |width: usize| {
            let value = (0..width).map(|k| usize::from(data[(bit + k) / 8] >> ((bit + k) % 8) & 1) << k).sum::<usize>();
            bit += width;
            value
        };
        let roots = || (0..258u16).map(|k| vec![k as u8]).collect::<Vec<Vec<u8>>>();
        let (mut table, mut out, mut before) = (roots(), Vec::new(), None::<usize>);
        loop {
            match code(width) {
                256 => (table, width, before) = (roots(), 9, None),
                257 => return (out, at + 1),
                now => {
                    if let Some(before) = before.filter(|_| table.len() < 4096) {
                        let mut entry = table[before].clone();
                        entry.push(if now < table.len() { table[now][0] } else { entry[0] });
                        table.push(entry);
                    }
                    out.extend_from_slice(&table[now]);
                    before = Some(now);
                    if table.len() == 1 << width && width < 12 {
                        width += 1;
                    }
                }
            }
        }
    }

    #[test]
    fn packed_indices_come_back() {
        let mut state = 1u32;
        let mut random = move |below: u32| {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (state >> 8) % below
        };
        for (length, colors) in [(0, 1), (1, 1), (2, 1), (700, 1), (5000, 2), (4000, 256), (100_000, 256), (60_000, 3)]
        {
            let indices: Vec<u8> = (0..length).map(|_| random(colors) as u8).collect();
            let mut bytes = Vec::new();
            pack(&mut bytes, indices.iter().copied()).unwrap();
            let (back, used) = unpack(&bytes);
            assert!(back == indices && used == bytes.len(), "{length} of {colors}");
        }
        // All lengths near those at which codes get longer.
        for length in (200..800).chain(3500..4500) {
            let indices: Vec<u8> = (0..length).map(|k| (k * k / 7 % 256) as u8).collect();
            let mut bytes = Vec::new();
            pack(&mut bytes, indices.iter().copied()).unwrap();
            assert!(unpack(&bytes).0 == indices, "{length}");
        }
    }

    #[test]
    fn few_colors_are_kept_exactly() {
        let pixels: Vec<u8> = (0..3000).flat_map(|k| [[10, 200, 30], [0, 0, 0], [250, 249, 7]][k % 3]).collect();
        let palette = Palette::of(&pixels);
        assert_eq!(palette.colors, [[0, 0, 0], [10, 200, 30], [250, 249, 7]]);
        assert!(Palette::of(&[]).colors.len() <= 1);
    }

    #[test]
    fn many_colors_come_close_and_dither_to_their_mean() {
        let pixels: Vec<u8> = (0..64 * 64).flat_map(|k| [(k % 64 * 4) as u8, (k / 64 * 4) as u8, 90]).collect();
        let palette = Palette::of(&pixels);
        assert!(palette.colors.len() > 200);
        for pixel in pixels.chunks_exact(3).step_by(37) {
            let mut sum = [0i32; 3];
            for place in 0..64 {
                let shown = palette.colors[usize::from(palette.index(pixel, place % 8, place / 8))];
                sum.iter_mut().zip(shown).for_each(|(sum, byte)| *sum += i32::from(byte));
            }
            let off = sum.iter().zip(pixel).map(|(sum, byte)| (sum / 64 - i32::from(*byte)).abs()).max().unwrap();
            assert!(off <= 12, "{pixel:?}: {sum:?}");
        }
    }

    #[test]
    fn a_frame_shows_only_what_changed() {
        let palette = Palette::of(&[0, 0, 0, 255, 255, 255]);
        let mut bytes = Vec::new();
        write_animation(&mut bytes, [3, 2], &palette, Animation { frames: 2, delay: 120 }, |frame, bytes| {
            bytes.fill(0);
            bytes[..3].fill(if frame == 0 { 0 } else { 255 });
            Ok(())
        })
        .unwrap();
        assert_eq!((&bytes[..6], &bytes[6..10], bytes.last()), (&b"GIF89a"[..], &[3, 0, 2, 0][..], Some(&0x3b)));
        let frames = 13 + 768 + 19;
        assert_eq!(bytes[frames..frames + 8], [0x21, 0xf9, 4, 5, 12, 0, 255, 0]);
        let (first, used) = unpack(&bytes[frames + 18..]);
        assert_eq!(first, [0; 6]);
        let (second, _) = unpack(&bytes[frames + 18 + used + 18..]);
        assert_eq!(second, [1, 255, 255, 255, 255, 255]);
    }

    #[test]
    fn a_writer_that_fails_at_any_byte_is_an_error() {
        let palette = Palette::of(&[0, 0, 0, 255, 255, 255]);
        let write = |out: &mut dyn Write| {
            write_animation(out, [9, 9], &palette, Animation { frames: 2, delay: 40 }, |frame, bytes| {
                bytes.iter_mut().enumerate().for_each(|(at, byte)| *byte = (at as u32 * 37 * (frame + 1)) as u8);
                Ok(())
            })
        };
        let mut bytes = Vec::new();
        write(&mut bytes).unwrap();
        for left in 0..bytes.len() {
            assert!(write(&mut Full { left }).is_err(), "after {left} of {} bytes", bytes.len());
        }
    }

    #[test]
    fn what_gif_cannot_hold_is_an_error() {
        let palette = Palette::of(&[0, 0, 0]);
        let write = |size, frames| {
            write_animation(&mut Vec::new(), size, &palette, Animation { frames, delay: 40 }, |_, _| Ok(()))
        };
        assert!(write([0, 5], 1).is_err() && write([65_536, 1], 1).is_err() && write([5, 5], 0).is_err());
        assert!(write([5, 5], 1).is_ok());
    }
}
