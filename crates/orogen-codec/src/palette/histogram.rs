//! Representative colors of a picture, from its histogram.

use std::io::{BufRead, BufReader, Seek};
use std::path::Path;

use super::color::{Light, decode, oklab};
use crate::fs::{self, File};
use orogen_grid::error::{Error, ErrorKind, Result};

/// Number of lightness levels in the histogram.
const LEVELS: usize = 4096;

/// Maximum number of pixels of a picture.
const MAX_PIXELS: u64 = 1 << 27;

/// Number of pixels of a picture up to which all pixels are counted. In a larger picture only every second row is
/// counted, or every third, and so on.
const COUNTED: u64 = 1 << 24;

/// Reads a `.png` and returns `count` colors in linear light, from dark to light. Each is the mean color of an equal
/// share of the pixels, which are ordered by their lightness in Oklab. Transparent pixels are ignored. The picture is
/// read row by row and is never completely in memory.
///
/// # Errors
/// If the file cannot be read, is not a PNG, or has no opaque pixel.
pub fn read(path: &Path, count: usize) -> Result<Vec<Light>> {
    let name = path.display().to_string();
    let refused = |why: String| Error::new(ErrorKind::File, format!("cannot read the picture {name}: {why}"));
    let metadata = fs::metadata(path).map_err(|cause| Error::file("read", path, &cause))?;
    if !metadata.is_file() {
        return Err(refused("it is not a regular file".into()));
    }
    let file = File::open(path).map_err(|cause| Error::file("read", path, &cause))?;
    parse(BufReader::new(file), count).map_err(refused)
}

/// [`read`] for a picture in memory or from any reader.
///
/// # Errors
/// A message that describes the problem.
pub fn parse(input: impl BufRead + Seek, count: usize) -> std::result::Result<Vec<Light>, String> {
    let mut decoder = ::png::Decoder::new(input);
    decoder.set_transformations(::png::Transformations::EXPAND | ::png::Transformations::STRIP_16);
    let mut reader = decoder.read_info().map_err(|cause| format!("it is not a PNG picture: {cause}"))?;
    let (width, height) = (reader.info().width, reader.info().height);
    let pixels = u64::from(width) * u64::from(height);
    if pixels > MAX_PIXELS {
        return Err(format!(
            "it has {width} x {height} pixels, more than {MAX_PIXELS}; scale it down, which changes its colors little"
        ));
    }
    let every = pixels.div_ceil(COUNTED).max(1);
    let (color, _) = reader.output_color_type();
    let channels = color.samples();
    let light: Vec<f32> = (0..=255).map(decode).collect();
    // Counts and sums in f64, in the order of the file, so that they are the same on every machine.
    let mut levels = vec![[0.0f64; 4]; LEVELS];
    let mut rows = 0;
    while let Some(row) = reader.next_row().map_err(|cause| format!("it is damaged: {cause}"))? {
        rows += 1;
        if (rows - 1) % every != 0 {
            continue;
        }
        for pixel in row.data().chunks_exact(channels) {
            let (rgb, alpha) = match *pixel {
                [grey] => ([grey; 3], 255),
                [grey, alpha] => ([grey; 3], alpha),
                [r, g, b] => ([r, g, b], 255),
                [r, g, b, alpha, ..] => ([r, g, b], alpha),
                [] => continue,
            };
            if alpha < 128 {
                continue;
            }
            let color = rgb.map(|byte| light[usize::from(byte)]);
            let level = (oklab(color)[0].clamp(0.0, 1.0) * (LEVELS - 1) as f32) as usize;
            let sums = &mut levels[level];
            sums[0] += 1.0;
            for (sum, part) in sums[1..].iter_mut().zip(color) {
                *sum += f64::from(part);
            }
        }
    }
    let total: f64 = levels.iter().map(|sums| sums[0]).sum();
    if total == 0.0 {
        return Err("it has no opaque pixel".into());
    }
    Ok(shares(&levels, total, count))
}

/// The mean color of each of `count` equal shares.
fn shares(levels: &[[f64; 4]], total: f64, count: usize) -> Vec<Light> {
    let share = total / count as f64;
    let mut out = Vec::with_capacity(count);
    let mut levels = levels.iter().filter(|sums| sums[0] > 0.0).copied();
    let mut rest = levels.next().unwrap_or_default();
    for _ in 0..count {
        let (mut missing, mut sum) = (share, [0.0f64; 3]);
        // The last share may be smaller by the rounding errors.
        while missing > total * 1e-12 {
            if rest[0] <= 0.0 {
                match levels.next() {
                    Some(next) => rest = next,
                    None => break,
                }
            }
            let part = (missing / rest[0]).min(1.0);
            for (sum, color) in sum.iter_mut().zip(&rest[1..]) {
                *sum += color * part;
            }
            missing -= rest[0] * part;
            rest = rest.map(|value| value * (1.0 - part));
        }
        out.push(sum.map(|sum| (sum / (share - missing).max(total * 1e-12)) as f32));
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::palette::color::encode;

    fn png(width: u32, height: u32, color: ::png::ColorType, data: &[u8]) -> Vec<u8> {
        let mut bytes = Vec::new();
        let mut encoder = ::png::Encoder::new(&mut bytes, width, height);
        encoder.set_color(color);
        encoder.write_header().unwrap().write_image_data(data).unwrap();
        bytes
    }

    #[test]
    fn colors_occur_as_often_as_in_the_picture() {
        // A quarter dark green, half sand, a quarter white.
        let mut data = Vec::new();
        for k in 0..400 {
            data.extend_from_slice(match k % 4 {
                0 => &[20, 60, 10],
                1 | 2 => &[200, 180, 120],
                _ => &[250, 250, 250],
            });
        }
        let colors = parse(std::io::Cursor::new(png(20, 20, ::png::ColorType::Rgb, &data)), 8).unwrap();
        let bytes: Vec<[u8; 3]> = colors.iter().map(|color| color.map(encode)).collect();
        assert_eq!(bytes[..2], [[20, 60, 10]; 2]);
        assert_eq!(bytes[2..6], [[200, 180, 120]; 4]);
        assert_eq!(bytes[6..], [[250, 250, 250]; 2]);
    }

    #[test]
    fn transparent_pixels_do_not_count_and_what_is_no_picture_is_refused() {
        let data = [10, 20, 30, 255, 200, 200, 200, 0];
        let colors = parse(std::io::Cursor::new(png(2, 1, ::png::ColorType::Rgba, &data)), 3).unwrap();
        assert!(colors.iter().all(|color| color.map(encode) == [10, 20, 30]));
        let empty = png(2, 1, ::png::ColorType::Rgba, &[0; 8]);
        assert!(parse(std::io::Cursor::new(empty), 3).unwrap_err().contains("no opaque pixel"));
        assert!(parse(std::io::Cursor::new(b"GIF89a"), 3).unwrap_err().contains("not a PNG"));
        let mut cut = png(64, 64, ::png::ColorType::Grayscale, &vec![7; 4096]);
        cut.truncate(60);
        assert!(parse(std::io::Cursor::new(cut), 3).is_err());
    }

    #[test]
    fn a_picture_with_too_many_pixels_is_refused_by_its_header() {
        let mut bytes = Vec::new();
        let mut encoder = ::png::Encoder::new(&mut bytes, 30_000, 30_000);
        encoder.set_color(::png::ColorType::Grayscale);
        // The picture ends before its first row.
        encoder.write_header().unwrap().write_chunk(::png::chunk::IDAT, &[]).unwrap();
        let error = parse(std::io::Cursor::new(bytes), 3).unwrap_err();
        assert!(error.contains("it has 30000 x 30000 pixels, more than 134217728; scale it down"), "{error}");
    }
}
