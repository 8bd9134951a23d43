//! Writing OpenEXR: float channels without conversion.
//!
//! Follows "OpenEXR File Layout" (openexr.com), version 2 without tiles or parts: scan lines from the top in increasing
//! order, in blocks of 16 rows compressed with ZIP (bytes split into two halves, differences, zlib). Readers in game
//! engines support this kind. Channels are sorted by name, as the format requires; a single channel is called `Y`,
//! which is gray.
//!
//! Compressed blocks are kept in a spool, because the table of their offsets precedes them in the file.

use std::io::{self, Write};

use orogen_grid::parallel;

use super::{deflate, half};
use crate::spool::Spool;

/// Number of rows in a block.
const ROWS: usize = 16;

/// Size of a piece that is compressed in one way, in bytes.
const PLANE: usize = 4096;

/// The type of a sample.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Sample {
    /// Four bytes: the f32 itself.
    Float,
    /// Two bytes, the nearest half-precision value (see [`half`]).
    Half,
}

impl Sample {
    fn bytes(self) -> usize {
        match self {
            Sample::Float => 4,
            Sample::Half => 2,
        }
    }
}

/// Description of a picture.
#[derive(Debug, Clone)]
pub struct Picture {
    /// Number of samples per row.
    pub width: usize,
    /// Number of rows.
    pub height: usize,
    /// Names of the channels; they must differ.
    pub channels: Vec<String>,
    /// The type of the samples.
    pub sample: Sample,
    /// The `comments` attribute.
    pub comments: String,
}

/// Writes a picture: [`Writer::rows`] takes all rows from the top, in any pieces, then [`Writer::finish`] writes the
/// file.
pub struct Writer {
    picture: Picture,
    /// The channels sorted by name.
    order: Vec<usize>,
    spool: Spool,
    /// Rows that do not fill a block yet.
    waiting: Vec<u8>,
    /// Position and length of each compressed block.
    blocks: Vec<(u64, usize)>,
    /// Number of rows received.
    rows: usize,
}

impl Writer {
    /// Starts a file.
    ///
    /// Fails if the picture has no samples or more than 2^31 - 1 per side, or if names are equal, empty or longer than
    /// 31 bytes.
    pub fn new(picture: Picture, spool: Spool) -> io::Result<Writer> {
        let refuse = |why: String| Err(io::Error::new(io::ErrorKind::InvalidInput, why));
        for side in [picture.width, picture.height] {
            if !(1..=i32::MAX as usize).contains(&side) {
                return refuse(format!("an EXR picture must have 1 to 2147483647 samples per side, not {side}"));
            }
        }
        let mut order: Vec<usize> = (0..picture.channels.len()).collect();
        order.sort_by(|a, b| picture.channels[*a].cmp(&picture.channels[*b]));
        if order.is_empty() || order.windows(2).any(|pair| picture.channels[pair[0]] == picture.channels[pair[1]]) {
            return refuse("the channels of an EXR picture must have different names".into());
        }
        if picture.channels.iter().any(|name| !(1..=31).contains(&name.len()) || name.contains('\0')) {
            return refuse("the name of an EXR channel must have 1 to 31 bytes".into());
        }
        Ok(Writer { picture, order, spool, waiting: Vec::new(), blocks: Vec::new(), rows: 0 })
    }

    fn row_bytes(&self) -> usize {
        self.picture.width * self.order.len() * self.picture.sample.bytes()
    }

    /// Takes the next rows. `channels` has a slice for each channel, in the order of [`Picture::channels`], all with
    /// the same number of complete rows.
    ///
    /// Fails if the spool fails, or if the samples are not whole rows or exceed the picture.
    pub fn rows(&mut self, channels: &[&[f32]]) -> io::Result<()> {
        let (width, samples) = (self.picture.width, channels.first().map_or(0, |channel| channel.len()));
        let rows = samples / width;
        let whole = channels.len() == self.order.len() && channels.iter().all(|channel| channel.len() == rows * width);
        if !whole || self.rows + rows > self.picture.height {
            return Err(io::Error::new(
                io::ErrorKind::InvalidInput,
                "the samples are not complete rows of the picture",
            ));
        }
        for first in (0..rows).step_by(PIECE) {
            let last = (first + PIECE).min(rows);
            for j in first..last {
                for channel in &self.order {
                    let row = &channels[*channel][j * width..(j + 1) * width];
                    let start = self.waiting.len();
                    self.waiting.resize(start + width * self.picture.sample.bytes(), 0);
                    let bytes = &mut self.waiting[start..];
                    match self.picture.sample {
                        Sample::Float => {
                            let pairs = bytes.as_chunks_mut::<4>().0.iter_mut().zip(row);
                            pairs.for_each(|(bytes, sample)| *bytes = sample.to_le_bytes());
                        }
                        Sample::Half => {
                            let pairs = bytes.as_chunks_mut::<2>().0.iter_mut().zip(row);
                            pairs.for_each(|(bytes, sample)| *bytes = half::from_f32(*sample).to_le_bytes());
                        }
                    }
                }
            }
            self.rows += last - first;
            self.pack()?;
        }
        Ok(())
    }

    /// Compresses the complete blocks, or all of them after the last row.
    fn pack(&mut self) -> io::Result<()> {
        let block = ROWS * self.row_bytes();
        let ready = match self.rows == self.picture.height {
            true => self.waiting.len(),
            false => self.waiting.len() / block * block,
        };
        let packed: Vec<Vec<u8>> = parallel::map(self.waiting[..ready].chunks(block), pack);
        self.waiting.drain(..ready);
        for bytes in packed {
            self.blocks.push((self.spool.push(&bytes)?, bytes.len()));
        }
        Ok(())
    }

    /// Writes the file.
    ///
    /// Fails if `out` or the spool fails, or if rows are missing.
    pub fn finish(mut self, out: &mut dyn Write) -> io::Result<()> {
        if self.rows < self.picture.height {
            return Err(io::Error::new(io::ErrorKind::InvalidInput, "rows of the picture are missing"));
        }
        let head = self.head();
        out.write_all(&head)?;
        let mut at = (head.len() + 8 * self.blocks.len()) as u64;
        for (_, length) in &self.blocks {
            out.write_all(&at.to_le_bytes())?;
            at += 8 + *length as u64;
        }
        let mut bytes = Vec::new();
        for (n, (at, length)) in self.blocks.iter().enumerate() {
            bytes.resize(*length, 0);
            self.spool.read(*at, &mut bytes)?;
            out.write_all(&((n * ROWS) as i32).to_le_bytes())?;
            out.write_all(&(*length as i32).to_le_bytes())?;
            out.write_all(&bytes)?;
        }
        Ok(())
    }

    fn head(&self) -> Vec<u8> {
        let mut head = Head(vec![0x76, 0x2f, 0x31, 0x01, 2, 0, 0, 0]);
        let mut channels = Vec::new();
        for channel in &self.order {
            channels.extend_from_slice(self.picture.channels[*channel].as_bytes());
            // End of the name; type of the sample; not logarithmic, and padding; no subsampling.
            let kind: i32 = if self.picture.sample == Sample::Half { 1 } else { 2 };
            channels.push(0);
            [kind, 0, 1, 1].into_iter().for_each(|number| channels.extend(number.to_le_bytes()));
        }
        channels.push(0);
        head.attribute("channels", "chlist", &channels);
        if !self.picture.comments.is_empty() {
            head.attribute("comments", "string", self.picture.comments.as_bytes());
        }
        // ZIP, 16 rows per block.
        head.attribute("compression", "compression", &[3]);
        let last = [self.picture.width, self.picture.height].map(|side| side as i32 - 1);
        let window: Vec<u8> = [0, 0, last[0], last[1]].iter().flat_map(|number: &i32| number.to_le_bytes()).collect();
        head.attribute("dataWindow", "box2i", &window);
        head.attribute("displayWindow", "box2i", &window);
        head.attribute("lineOrder", "lineOrder", &[0]);
        head.attribute("pixelAspectRatio", "float", &1.0f32.to_le_bytes());
        head.attribute("screenWindowCenter", "v2f", &[0; 8]);
        head.attribute("screenWindowWidth", "float", &1.0f32.to_le_bytes());
        head.0.push(0);
        head.0
    }
}

/// Number of rows taken at a time: complete blocks, enough for all threads.
const PIECE: usize = 16 * ROWS;

struct Head(Vec<u8>);

impl Head {
    fn attribute(&mut self, name: &str, kind: &str, value: &[u8]) {
        for text in [name, kind] {
            self.0.extend_from_slice(text.as_bytes());
            self.0.push(0);
        }
        self.0.extend((value.len() as i32).to_le_bytes());
        self.0.extend_from_slice(value);
    }
}

/// A compressed block, or the uncompressed bytes if they are not longer.
fn pack(bytes: &[u8]) -> Vec<u8> {
    let mut parted = vec![0u8; bytes.len()];
    let (even, odd) = parted.split_at_mut(bytes.len().div_ceil(2));
    let pairs = bytes.as_chunks::<2>().0;
    for ((even, odd), pair) in even.iter_mut().zip(&mut *odd).zip(pairs) {
        (*even, *odd) = (pair[0], pair[1]);
    }
    if let ([.., last], [.., byte]) = (&mut *even, bytes)
        && bytes.len() % 2 == 1
    {
        *last = *byte;
    }
    let mut differences = Vec::with_capacity(parted.len());
    differences.extend(parted.first());
    differences.extend(parted.windows(2).map(|pair| pair[1].wrapping_sub(pair[0]).wrapping_add(128)));
    let packed = deflate::pack_mixed(&differences, PLANE);
    if packed.len() < bytes.len() { packed } else { bytes.to_vec() }
}

#[cfg(test)]
mod tests {
    use super::*;
    use miniz_oxide::inflate::decompress_to_vec_zlib;

    /// Reads the output of the writer: the names and samples of the channels.
    fn read(bytes: &[u8]) -> Vec<(String, Vec<f32>)> {
        assert_eq!(bytes[..8], [0x76, 0x2f, 0x31, 0x01, 2, 0, 0, 0]);
        let mut at = 8;
        let text = |at: &mut usize| {
            let end = *at + bytes[*at..].iter().position(|byte| *byte == 0).unwrap();
            let text = String::from_utf8(bytes[*at..end].to_vec()).unwrap();
            *at = end + 1;
            text
        };
        let int = |at: usize| i32::from_le_bytes(bytes[at..at + 4].try_into().unwrap());
        let (mut names, mut kind, mut size) = (Vec::new(), 0, [0, 0]);
        while bytes[at] != 0 {
            let (name, _) = (text(&mut at), text(&mut at));
            let length = int(at) as usize;
            at += 4;
            match name.as_str() {
                "channels" => {
                    let mut inside = at;
                    while bytes[inside] != 0 {
                        names.push(text(&mut inside));
                        kind = int(inside);
                        inside += 16;
                    }
                }
                "dataWindow" => size = [int(at + 8) as usize + 1, int(at + 12) as usize + 1],
                _ => {}
            }
            at += length;
        }
        at += 1;
        let [width, height] = size;
        let (bytes_each, blocks) = (if kind == 1 { 2 } else { 4 }, height.div_ceil(ROWS));
        let mut channels: Vec<(String, Vec<f32>)> = names.into_iter().map(|name| (name, Vec::new())).collect();
        for n in 0..blocks {
            let place = u64::from_le_bytes(bytes[at + 8 * n..at + 8 * n + 8].try_into().unwrap()) as usize;
            assert_eq!(int(place), (n * ROWS) as i32);
            let packed = &bytes[place + 8..place + 8 + int(place + 4) as usize];
            let rows = ROWS.min(height - n * ROWS);
            let long = rows * width * channels.len() * bytes_each;
            let plain = match packed.len() == long {
                true => packed.to_vec(),
                false => {
                    let mut parted = decompress_to_vec_zlib(packed).unwrap();
                    assert_eq!(parted.len(), long);
                    for k in 1..long {
                        parted[k] = parted[k].wrapping_add(parted[k - 1]).wrapping_sub(128);
                    }
                    let (even, odd) = parted.split_at(long.div_ceil(2));
                    (0..long).map(|k| if k % 2 == 0 { even[k / 2] } else { odd[k / 2] }).collect()
                }
            };
            let mut samples = plain.chunks_exact(bytes_each).map(|b| match bytes_each {
                2 => half::to_f32(u16::from_le_bytes([b[0], b[1]])),
                _ => f32::from_le_bytes([b[0], b[1], b[2], b[3]]),
            });
            for _ in 0..rows {
                for (_, channel) in &mut channels {
                    channel.extend(samples.by_ref().take(width));
                }
            }
        }
        channels
    }

    fn picture(width: usize, height: usize, names: &[&str], sample: Sample) -> Picture {
        let channels = names.iter().map(ToString::to_string).collect();
        Picture { width, height, channels, sample, comments: "a test".into() }
    }

    #[test]
    fn what_is_written_is_read_back() {
        for (width, height) in [(1, 1), (7, 5), (33, 16), (20, 17), (9, 700)] {
            let y: Vec<f32> = (0..width * height).map(|k| libm::sinf(k as f32) * 1000.0).collect();
            let mut writer = Writer::new(picture(width, height, &["Y"], Sample::Float), Spool::in_memory()).unwrap();
            // In pieces whose size does not divide the total.
            y.chunks(3 * width).for_each(|rows| writer.rows(&[rows]).unwrap());
            let mut bytes = Vec::new();
            writer.finish(&mut bytes).unwrap();
            assert_eq!(read(&bytes), [("Y".to_string(), y)]);
        }
    }

    #[test]
    fn channels_lie_in_the_order_of_their_names() {
        let (r, g) = (vec![1.0, 2.0, 3.0], vec![4.0, 5.0, -6.0]);
        let mut writer = Writer::new(picture(3, 1, &["R", "G"], Sample::Half), Spool::in_memory()).unwrap();
        writer.rows(&[&r, &g]).unwrap();
        let mut bytes = Vec::new();
        writer.finish(&mut bytes).unwrap();
        assert_eq!(read(&bytes), [("G".to_string(), g), ("R".to_string(), r)]);
    }

    #[test]
    fn what_no_file_can_hold_is_refused() {
        let new = |picture: Picture| Writer::new(picture, Spool::in_memory());
        assert!(new(picture(0, 1, &["Y"], Sample::Float)).is_err());
        assert!(new(picture(1, 1, &[], Sample::Float)).is_err());
        assert!(new(picture(1, 1, &["Y", "Y"], Sample::Float)).is_err());
        assert!(new(picture(1, 1, &["a name that is longer than the format knows"], Sample::Float)).is_err());
        let mut writer = new(picture(2, 2, &["Y"], Sample::Float)).unwrap();
        assert!(writer.rows(&[&[1.0]]).is_err() && writer.rows(&[&[1.0; 6]]).is_err());
        writer.rows(&[&[1.0; 2]]).unwrap();
        assert!(writer.finish(&mut Vec::new()).is_err(), "a row is missing");
    }
}
