//! The pixels of a PNG as heights.

use std::io::BufReader;

use ::png::{BitDepth, ColorType, Decoder, DecodingError, Limits, Reader, Transformations};

use super::encoding::Encoding;
use super::input::{Input, afford};
use super::stored::{Kind, Stored};

/// A picture that is read row by row.
pub struct Pixels<'a> {
    reader: Reader<BufReader<&'a mut dyn Input>>,
    /// Number of pixels per row.
    pub width: u64,
    /// Number of rows.
    pub height: u64,
    /// The color type of its pixels.
    pub color: ColorType,
    /// Number of bits per channel.
    pub depth: BitDepth,
    count: usize,
}

fn broken(fault: DecodingError) -> String {
    match fault {
        DecodingError::LimitsExceeded => {
            "it needs more memory than a picture of its size should; it is damaged".to_string()
        }
        other => format!("it is not a valid PNG ({other})"),
    }
}

impl<'a> Pixels<'a> {
    /// Reads the header of a picture and checks its size.
    ///
    /// # Errors
    /// A message if it is not a PNG, or if its heights need more than `allowed` bytes.
    pub fn open(input: &'a mut dyn Input, allowed: u64) -> Result<Pixels<'a>, String> {
        let limit = usize::try_from(allowed).unwrap_or(usize::MAX);
        // The memory that the decoder needs for any picture is allowed in any case, so that a picture that is too large
        // is rejected with a message about its size.
        const DECODER: usize = 64 << 10;
        let mut decoder = Decoder::new_with_limits(BufReader::new(input), Limits { bytes: limit.max(DECODER) });
        decoder.set_transformations(Transformations::IDENTITY);
        let reader = decoder.read_info().map_err(broken)?;
        let info = reader.info();
        let (width, height, color, depth) =
            (u64::from(info.width), u64::from(info.height), info.color_type, info.bit_depth);
        let count = afford(width, height, allowed)?;
        Ok(Pixels { reader, width, height, color, depth, count })
    }

    /// Checks that the rows of the picture are stored in order.
    ///
    /// # Errors
    /// A message if the picture is interlaced.
    pub fn check_rows(&self) -> Result<(), String> {
        match self.reader.info().interlaced {
            true => Err("it is interlaced; save it without interlacing".into()),
            false => Ok(()),
        }
    }

    fn heights(&mut self, append: &mut dyn FnMut(&[u8], &mut Vec<f32>)) -> Result<Vec<f32>, String> {
        let mut heights: Vec<f32> = Vec::new();
        while let Some(row) = self.reader.next_row().map_err(broken)? {
            append(row.data(), &mut heights);
            if heights.len() >= self.count {
                break;
            }
        }
        match heights.len() == self.count {
            true => Ok(heights),
            false => Err("it ends within its rows".into()),
        }
    }

    /// The heights of gray levels of `size` bytes. Level 0 is the height `range[0]`, level `most` is `range[1]`.
    ///
    /// # Errors
    /// A message if the picture is damaged.
    pub fn greys(&mut self, size: usize, most: f64, range: [f64; 2], nodata: Option<f64>) -> Result<Vec<f32>, String> {
        let stored = Stored { kind: Kind::Unsigned, size, big_endian: true };
        self.heights(&mut |row, heights| stored.append_scaled(row, most, range, nodata, heights))
    }

    /// The heights that are encoded in pixels of `size` bytes: red, green, blue and, if `size` is 4, alpha.
    ///
    /// # Errors
    /// A message if the picture is damaged.
    pub fn encoded(&mut self, size: usize, encoding: Encoding) -> Result<Vec<f32>, String> {
        self.heights(&mut |row, heights| {
            heights.extend(row.chunks_exact(size).map(|pixel| match *pixel {
                // Transparent pixels and pixels 0, 0, 0 have no height.
                [_, _, _, 0] | [0, 0, 0, ..] => f32::NAN,
                [red, green, blue, ..] => encoding.height([red, green, blue]) as f32,
                _ => f32::NAN,
            }));
        })
    }
}
