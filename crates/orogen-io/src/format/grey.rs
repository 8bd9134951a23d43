//! Reading heights from a grayscale PNG of 8 or 16 bits, with a [`Sidecar`] that states the heights of black and white,
//! and from a color PNG of 8 bits whose sidecar states the encoding.

use ::png::{BitDepth, ColorType};

use super::dem::{Dem, Input, refused};
use super::grey_rows::Pixels;
use super::sidecar::{Sidecar, needs};
use orogen_grid::error::Result;

/// Reads a grayscale picture. `name` is the file's name in errors.
///
/// # Errors
/// If it is not a PNG, not grayscale, damaged or too large, or the sidecar does not state the heights of black and
/// white.
pub fn read(input: &mut dyn Input, name: &str, sidecar: &Sidecar, allowed: u64) -> Result<Dem> {
    open(input, sidecar, allowed).map_err(|why| refused(name, why))
}

fn open(input: &mut dyn Input, sidecar: &Sidecar, allowed: u64) -> std::result::Result<Dem, String> {
    let mut picture = Pixels::open(input, allowed)?;
    let Pixels { width, height, color, depth, .. } = picture;
    let encoding = sidecar.encoding();
    let size = match (color, depth) {
        (ColorType::Grayscale, BitDepth::Eight) => 1,
        (ColorType::Grayscale, BitDepth::Sixteen) => 2,
        (ColorType::Rgb, BitDepth::Eight) if encoding.is_some() => 3,
        (ColorType::Rgba, BitDepth::Eight) if encoding.is_some() => 4,
        // If the heights of black and white are given, gray is expected.
        (ColorType::Rgb | ColorType::Rgba, BitDepth::Eight) if sidecar.low.is_none() => {
            return Err(needs("the encoding of heights in its colors, `encoding` (\"terrarium\" or \"terrain-rgb\")"));
        }
        _ => {
            return Err(format!(
                "its pixels are {color:?} with {depth:?} bits; only grey with 8 or 16 bits, and colors of 8 bits with `encoding`, are supported"
            ));
        }
    };
    picture.check_rows()?;
    let encoding = encoding.filter(|_| size > 2);
    let most = if size == 1 { 255.0 } else { 65535.0 };
    let [low, high] = if encoding.is_some() { [0.0; 2] } else { sidecar.range(most)? };
    let heights = match encoding {
        Some(encoding) => picture.encoded(size, encoding)?,
        None => picture.greys(size, most, [low, high], sidecar.nodata)?,
    };
    let heights = sidecar.north_first(heights, width as usize)?;
    Dem::new([width as usize, height as usize], heights, sidecar.place(height as usize)?)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::format::encoding::Encoding;
    use crate::format::levels::Levels;
    use crate::format::png;
    use orogen_grid::grid::{Grid, Window};
    use std::io::Cursor;

    #[test]
    fn heights_in_colors_are_read_back() {
        let heights = [f32::NAN, 100.5, -12.25, 8848.0];
        for encoding in Encoding::ALL {
            let mut bytes = Vec::new();
            let picture = png::Picture::new(2, 2, png::Pixel::Data8);
            let samples: Vec<u8> = heights.iter().flat_map(|height| encoding.bytes(*height)).collect();
            png::write_through(&mut bytes, &picture, |out| out.write_all(&samples)).unwrap();
            let named = Sidecar { sample: Some(encoding.name().into()), cell: Some(1.0), ..Sidecar::default() };
            let dem = read(&mut Cursor::new(&bytes), "a.png", &named, 1 << 20).unwrap();
            assert!(dem.heights[0].is_nan());
            assert!((1..4).all(|k| (dem.heights[k] - heights[k]).abs() <= 0.051), "{:?}", dem.heights);
            let why = read(&mut Cursor::new(&bytes), "a.png", &Sidecar::default(), 1 << 20).unwrap_err().to_string();
            assert!(why.contains("`encoding`"), "{why}");
        }
    }

    #[test]
    fn a_picture_that_does_not_fit_is_not_called_damaged() {
        let grid = Grid::filled(Window::new(64, 64, 1.0), 5.0f32);
        let mut bytes = Vec::new();
        png::write_grey16(&mut bytes, &grid, &Levels::new(0.0, 9.0), &[]).unwrap();
        let sidecar = Sidecar { cell: Some(1.0), low: Some(0.0), high: Some(9.0), ..Sidecar::default() };
        for allowed in [0, 1, 2000, 16_383] {
            let why = read(&mut Cursor::new(&bytes), "a.png", &sidecar, allowed).unwrap_err().to_string();
            assert!(why.contains("64 x 64 samples need 16"), "{why}");
        }
        assert!(read(&mut Cursor::new(&bytes), "a.png", &sidecar, 16_384).is_ok());
    }

    #[test]
    fn what_is_written_is_read_back() {
        let heights: Vec<f32> = (0..35).map(|k| 100.0 + (k * k % 37) as f32 * 5.0).collect();
        let grid = Grid::from_data(Window::new(7, 5, 4.0), heights).unwrap();
        let levels = Levels::of(&grid);
        let sidecar = Sidecar {
            cell: Some(4.0),
            low: Some(f64::from(levels.low())),
            high: Some(f64::from(levels.high())),
            ..Sidecar::default()
        };
        for (bits, error) in [(16, 0.002f32), (8, 0.4)] {
            let mut bytes = Vec::new();
            match bits {
                16 => png::write_grey16(&mut bytes, &grid, &levels, &[]).unwrap(),
                _ => png::write_grey8(&mut bytes, &grid, &levels, &[]).unwrap(),
            }
            let dem = read(&mut Cursor::new(&bytes), "a.png", &sidecar, 1 << 20).unwrap();
            assert_eq!((dem.width, dem.height), (7, 5));
            assert!(dem.heights.iter().zip(grid.data()).all(|(a, b)| (a - b).abs() <= error), "{bits} bits");
            let why = read(&mut Cursor::new(&bytes), "a.png", &Sidecar::default(), 1 << 20).unwrap_err().to_string();
            assert!(why.contains("low and high"), "{why}");
            for n in 0..bytes.len() - 12 {
                match read(&mut Cursor::new(&bytes[..n]), "a.png", &sidecar, 1 << 20) {
                    // Only checksums were cut off.
                    Ok(cut) => assert!(cut == dem && n + 24 > bytes.len(), "{n}"),
                    Err(error) => assert!(error.to_string().starts_with("cannot read a.png: "), "{n}: {error}"),
                }
            }
        }
    }
}
