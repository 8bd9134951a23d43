//! PNG pictures: grayscale with 8 and 16 bits, color, normals, and animations (APNG).
//!
//! Follows the PNG specification (third edition, W3C 2025). 16-bit samples are big-endian. Grays and normals are data,
//! so they have no gamma or color chunk that a reader could apply. Colors are marked as sRGB. Compression favors speed.

use std::io::{self, Write};
use std::ops::Range;

use ::png::{BitDepth, ColorType, Compression, Encoder, EncodingError, SrgbRenderingIntent};

use super::levels::Levels;
use orogen_grid::grid::Grid;

/// Maximum number of bytes of the rows that are filled at a time: enough to share among threads, and small compared
/// with a grid.
const BAND: usize = 1 << 20;

/// The type of a pixel.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Pixel {
    /// One byte of gray.
    Grey8,
    /// Two bytes of gray, big-endian.
    Grey16,
    /// Three bytes: red, green, blue, as sRGB.
    Rgb8,
    /// Four bytes: red, green, blue, as sRGB, and opacity.
    Rgba8,
    /// Three bytes of data that are not a color, such as the components of a normal.
    Data8,
    /// Three 16-bit numbers, big-endian, that are not a color.
    Data16,
    /// Four bytes of data that are neither color nor opacity, such as weights.
    Weights8,
}

impl Pixel {
    /// Number of bytes per pixel.
    #[must_use]
    pub fn bytes(self) -> usize {
        match self {
            Pixel::Grey8 => 1,
            Pixel::Grey16 => 2,
            Pixel::Rgb8 | Pixel::Data8 => 3,
            Pixel::Data16 => 6,
            Pixel::Rgba8 | Pixel::Weights8 => 4,
        }
    }
}

/// Description of a picture.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct Picture<'a> {
    /// Number of pixels per row.
    pub width: usize,
    /// Number of rows.
    pub height: usize,
    /// The type of the pixels.
    pub pixel: Pixel,
    /// Pairs of keyword and text for the file's text chunks (Latin-1; keywords of 1 to 79 characters).
    pub notes: &'a [(&'a str, &'a str)],
}

impl<'a> Picture<'a> {
    /// A picture without text chunks.
    #[must_use]
    pub const fn new(width: usize, height: usize, pixel: Pixel) -> Picture<'a> {
        Picture { width, height, pixel, notes: &[] }
    }

    /// Sets the text chunks.
    #[must_use]
    pub const fn with_notes(self, notes: &'a [(&'a str, &'a str)]) -> Picture<'a> {
        Picture { notes, ..self }
    }
}

/// Properties of an animation.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub struct Animation {
    /// Number of frames.
    pub frames: u32,
    /// Duration of a frame, in milliseconds. The animation repeats endlessly.
    pub delay: u16,
}

impl Animation {
    /// An animation of `frames` frames of `delay` milliseconds each.
    #[must_use]
    pub const fn new(frames: u32, delay: u16) -> Animation {
        Animation { frames, delay }
    }
}

/// Writes a picture. `fill` computes its rows in bands from the top: it receives the range of rows and their bytes.
///
/// Fails if `out` or `fill` fails, or if the picture has no pixels or more than 2^31 - 1 per side.
pub fn write(
    out: &mut dyn Write,
    picture: &Picture,
    mut fill: impl FnMut(Range<usize>, &mut [u8]) -> io::Result<()>,
) -> io::Result<()> {
    write_bands(out, picture, &mut fill)
}

/// Computes the bytes of a range of rows.
type Fill<'a> = dyn FnMut(Range<usize>, &mut [u8]) -> io::Result<()> + 'a;

// A `dyn` function, so that the encoder is compiled only once and not in every crate that writes pictures.
fn write_bands(out: &mut dyn Write, picture: &Picture, fill: &mut Fill) -> io::Result<()> {
    write_through(out, picture, |rows| {
        let row_bytes = picture.width * picture.pixel.bytes();
        let rows_a_band = (BAND / row_bytes).clamp(1, picture.height);
        let mut band = vec![0; rows_a_band * row_bytes];
        for first in (0..picture.height).step_by(rows_a_band) {
            let last = (first + rows_a_band).min(picture.height);
            let bytes = &mut band[..(last - first) * row_bytes];
            fill(first..last, bytes)?;
            rows.write_all(bytes)?;
        }
        Ok(())
    })
}

/// Writes a picture. `body` writes exactly the bytes of the picture, row by row from the top.
///
/// Fails under the same conditions as [`write()`].
pub fn write_through(
    out: &mut dyn Write,
    picture: &Picture,
    body: impl FnOnce(&mut dyn Write) -> io::Result<()>,
) -> io::Result<()> {
    let mut body = Some(body);
    write_stream(out, picture, &mut |rows| body.take().map_or(Ok(()), |body| body(rows)))
}

fn write_stream(
    out: &mut dyn Write,
    picture: &Picture,
    body: &mut dyn FnMut(&mut dyn Write) -> io::Result<()>,
) -> io::Result<()> {
    let mut writer = encoder(out, picture)?.write_header().map_err(plain)?;
    let mut rows = writer.stream_writer_with_size(BAND).map_err(plain)?;
    body(&mut rows)?;
    rows.finish().map_err(plain)?;
    // Finished explicitly, because an error in the last chunk would be lost on drop.
    writer.finish().map_err(plain)
}

/// Writes an animation. `fill` computes the frames one at a time: it receives the frame's number, from 0, and the
/// frame's bytes.
///
/// Readers without support for animations show the first frame. Fails under the same conditions as [`write()`], and if
/// there are no frames.
pub fn write_animation(
    out: &mut dyn Write,
    picture: &Picture,
    animation: Animation,
    mut fill: impl FnMut(u32, &mut [u8]) -> io::Result<()>,
) -> io::Result<()> {
    write_frames(out, picture, animation, &mut fill)
}

fn write_frames(
    out: &mut dyn Write,
    picture: &Picture,
    animation: Animation,
    fill: &mut dyn FnMut(u32, &mut [u8]) -> io::Result<()>,
) -> io::Result<()> {
    let mut encoder = encoder(out, picture)?;
    encoder.set_animated(animation.frames, 0).map_err(plain)?;
    encoder.set_frame_delay(animation.delay, 1000).map_err(plain)?;
    let mut writer = encoder.write_header().map_err(plain)?;
    // The encoder's streams do not number the chunks of later frames correctly, so each frame is written as a whole.
    let mut bytes = vec![0; picture.width * picture.height * picture.pixel.bytes()];
    for frame in 0..animation.frames {
        fill(frame, &mut bytes)?;
        writer.write_image_data(&bytes).map_err(plain)?;
    }
    writer.finish().map_err(plain)
}

fn encoder<'a>(out: &'a mut dyn Write, picture: &Picture) -> io::Result<Encoder<'a, &'a mut dyn Write>> {
    let mut encoder = Encoder::new(out, side(picture.width)?, side(picture.height)?);
    let (color, depth) = match picture.pixel {
        Pixel::Grey8 => (ColorType::Grayscale, BitDepth::Eight),
        Pixel::Grey16 => (ColorType::Grayscale, BitDepth::Sixteen),
        Pixel::Rgb8 | Pixel::Data8 => (ColorType::Rgb, BitDepth::Eight),
        Pixel::Data16 => (ColorType::Rgb, BitDepth::Sixteen),
        Pixel::Rgba8 | Pixel::Weights8 => (ColorType::Rgba, BitDepth::Eight),
    };
    encoder.set_color(color);
    encoder.set_depth(depth);
    encoder.set_compression(Compression::Fast);
    if matches!(picture.pixel, Pixel::Rgb8 | Pixel::Rgba8) {
        encoder.set_source_srgb(SrgbRenderingIntent::Perceptual);
    }
    for (keyword, text) in picture.notes {
        encoder.add_text_chunk((*keyword).into(), (*text).into()).map_err(plain)?;
    }
    Ok(encoder)
}

/// Writes a grid as 16-bit gray over the range of `levels`.
pub fn write_grey16(out: &mut dyn Write, grid: &Grid, levels: &Levels, notes: &[(&str, &str)]) -> io::Result<()> {
    let picture = Picture { width: grid.width(), height: grid.height(), pixel: Pixel::Grey16, notes };
    write(out, &picture, |rows, bytes| {
        let heights = &grid.data()[rows.start * grid.width()..rows.end * grid.width()];
        for (pixel, &height) in bytes.chunks_exact_mut(2).zip(heights) {
            pixel.copy_from_slice(&levels.to_u16(height).to_be_bytes());
        }
        Ok(())
    })
}

/// Writes a grid as 8-bit gray over the range of `levels`; low heights are black.
pub fn write_grey8(out: &mut dyn Write, grid: &Grid, levels: &Levels, notes: &[(&str, &str)]) -> io::Result<()> {
    let picture = Picture { width: grid.width(), height: grid.height(), pixel: Pixel::Grey8, notes };
    write(out, &picture, |rows, bytes| {
        let heights = &grid.data()[rows.start * grid.width()..rows.end * grid.width()];
        for (pixel, &height) in bytes.iter_mut().zip(heights) {
            *pixel = levels.to_u8(height);
        }
        Ok(())
    })
}

fn side(samples: usize) -> io::Result<u32> {
    match u32::try_from(samples) {
        Ok(n) if n > 0 && n <= i32::MAX as u32 => Ok(n),
        _ => Err(io::Error::new(
            io::ErrorKind::InvalidInput,
            format!("a PNG picture must have 1 to 2147483647 pixels per side, not {samples}"),
        )),
    }
}

/// The I/O error inside the encoder's error, if there is one.
fn plain(error: EncodingError) -> io::Error {
    match error {
        EncodingError::IoError(cause) => cause,
        other => io::Error::new(io::ErrorKind::InvalidInput, other),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::full_disk::Full;
    use orogen_grid::grid::Window;

    /// Reads a picture back: size, color, depth and bytes.
    fn read(bytes: &[u8]) -> (u32, u32, ColorType, BitDepth, Vec<u8>) {
        let mut reader = ::png::Decoder::new(io::Cursor::new(bytes)).read_info().unwrap();
        let mut data = vec![0; reader.output_buffer_size().unwrap()];
        let info = reader.next_frame(&mut data).unwrap();
        (info.width, info.height, info.color_type, info.bit_depth, data)
    }

    /// The chunk types of a PNG file, in order.
    fn chunks(bytes: &[u8]) -> Vec<String> {
        let (mut at, mut names) = (8, Vec::new());
        while at < bytes.len() {
            let length = u32::from_be_bytes(bytes[at..at + 4].try_into().unwrap()) as usize;
            names.push(String::from_utf8(bytes[at + 4..at + 8].to_vec()).unwrap());
            at += length + 12;
        }
        names.dedup();
        names
    }

    fn ramp(width: usize, height: usize) -> Grid {
        let data = (0..width * height).map(|i| i as f32 - 10.0).collect();
        Grid::from_data(Window::new(width, height, 1.0), data).unwrap()
    }

    #[test]
    fn greys_come_back_and_carry_no_gamma() {
        let grid = ramp(7, 5);
        let levels = Levels::of(&grid);
        let mut bytes = Vec::new();
        write_grey16(&mut bytes, &grid, &levels, &[("Software", "Orogen")]).unwrap();
        let (width, height, color, depth, data) = read(&bytes);
        assert_eq!((width, height, color, depth), (7, 5, ColorType::Grayscale, BitDepth::Sixteen));
        let expect: Vec<u8> = grid.data().iter().flat_map(|&h| levels.to_u16(h).to_be_bytes()).collect();
        assert_eq!(data, expect);
        assert_eq!((&data[..2], &data[68..]), (&[0, 0][..], &[255, 255][..]));
        assert_eq!(chunks(&bytes), ["IHDR", "tEXt", "IDAT", "IEND"]);

        bytes.clear();
        write_grey8(&mut bytes, &grid, &levels, &[]).unwrap();
        let (_, _, _, depth, data) = read(&bytes);
        assert_eq!((depth, data[0], data[34]), (BitDepth::Eight, 0, 255));
        assert_eq!(chunks(&bytes), ["IHDR", "IDAT", "IEND"]);
    }

    #[test]
    fn a_picture_of_many_bands_is_asked_for_in_order() {
        let picture = Picture { width: 1000, height: 777, pixel: Pixel::Rgb8, notes: &[] };
        let (mut bytes, mut next) = (Vec::new(), 0);
        write(&mut bytes, &picture, |rows, bytes| {
            assert_eq!((rows.start, bytes.len()), (next, rows.len() * 3000));
            next = rows.end;
            for (row, j) in bytes.chunks_exact_mut(3000).zip(rows) {
                row.fill(j as u8);
            }
            Ok(())
        })
        .unwrap();
        assert_eq!(next, 777);
        let (_, _, _, _, data) = read(&bytes);
        assert!(data.chunks_exact(3000).enumerate().all(|(j, row)| row.iter().all(|&b| b == j as u8)));
        assert_eq!(chunks(&bytes), ["IHDR", "sRGB", "IDAT", "IEND"]);
    }

    #[test]
    fn a_writer_that_fails_at_any_byte_is_an_error() {
        let grid = ramp(9, 9);
        let mut bytes = Vec::new();
        write_grey16(&mut bytes, &grid, &Levels::of(&grid), &[]).unwrap();
        for left in 0..bytes.len() {
            let result = write_grey16(&mut Full { left }, &grid, &Levels::of(&grid), &[]);
            assert!(result.is_err(), "after {left} of {} bytes", bytes.len());
        }
    }

    #[test]
    fn an_animation_has_its_frames_in_order() {
        let picture = Picture { width: 5, height: 4, pixel: Pixel::Data16, notes: &[] };
        let mut bytes = Vec::new();
        let animation = Animation { frames: 3, delay: 40 };
        write_animation(&mut bytes, &picture, animation, |frame, bytes| {
            bytes.fill(frame as u8 + 1);
            Ok(())
        })
        .unwrap();
        assert_eq!(
            chunks(&bytes),
            ["IHDR", "acTL", "fcTL", "IDAT", "fcTL", "fdAT", "fcTL", "fdAT", "IEND"],
            "no color chunk: normals are data"
        );
        let mut reader = ::png::Decoder::new(io::Cursor::new(&bytes)).read_info().unwrap();
        let mut data = vec![0; reader.output_buffer_size().unwrap()];
        for frame in 1..=3 {
            reader.next_frame(&mut data).unwrap();
            assert_eq!(data, [frame; 5 * 4 * 6]);
            assert_eq!(reader.info().frame_control.unwrap().delay_num, 40);
        }
        assert!(reader.next_frame(&mut data).is_err());
        let none = Animation { frames: 0, delay: 40 };
        assert!(write_animation(&mut Vec::new(), &picture, none, |_, _| Ok(())).is_err());
    }

    #[test]
    fn no_pixels_is_an_error() {
        for (width, height) in [(0, 5), (5, 0), (1 << 31, 1)] {
            let picture = Picture { width, height, pixel: Pixel::Grey8, notes: &[] };
            assert!(write(&mut Vec::new(), &picture, |_, _| Ok(())).is_err());
        }
    }
}
