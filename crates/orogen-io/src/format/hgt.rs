//! SRTM `.hgt`: one degree by one degree, whole metres, 16-bit big-endian; the file's name contains its south-west
//! corner.
//!
//! The 1201 x 1201 samples (3 arc seconds), 3601 x 3601 (1) or 1801 x 3601 (2 and 1, far north) lie *on* the degree's
//! edges, which neighboring files share. Coordinates are degrees of WGS 84. -32768 is nodata.

use std::io::{Read, Write};

use super::crs::keys;
use super::crs::unit::Unit;
use super::dem::{Dem, Input, Placement, afford, length, refused};
use super::metres16;
use orogen_grid::error::Result;

/// The supported sizes: columns and rows.
pub const SIZES: [[usize; 2]; 4] = [[1201, 1201], [3601, 3601], [1801, 3601], [601, 1201]];

/// Writes heights of a grid with one of the sizes, in pieces of any length: rounded to whole metres, halves away from
/// zero; NaN becomes nodata.
pub fn write(out: &mut dyn Write, heights: &[f32]) -> std::io::Result<()> {
    let mut bytes = Vec::with_capacity(1 << 16);
    for piece in heights.chunks(1 << 15) {
        bytes.clear();
        metres16::append_bytes(&mut bytes, piece);
        out.write_all(&bytes)?;
    }
    Ok(())
}

/// Reads a tile. `name` is the file's name in errors; the tile has a position if it has the form N46E007.hgt.
///
/// # Errors
/// If it does not have one of the sizes, or its heights take more than `allowed` bytes.
pub fn read(input: &mut dyn Input, name: &str, allowed: u64) -> Result<Dem> {
    open(input, name, allowed).map_err(|why| refused(name, why))
}

/// The size and position of a tile, without reading its samples.
///
/// # Errors
/// If it does not have one of the sizes.
pub fn head(input: &mut dyn Input, name: &str) -> Result<([usize; 2], Option<Placement>)> {
    let size = size(input).map_err(|why| refused(name, why))?;
    Ok((size, place(name, size)))
}

fn size(input: &mut dyn Input) -> std::result::Result<[usize; 2], String> {
    let bytes = length(input)?;
    SIZES.into_iter().find(|[columns, rows]| (2 * columns * rows) as u64 == bytes).ok_or_else(|| {
        format!(
            "an .hgt must have 1201 x 1201 samples of two bytes (2884802 bytes) or 3601 x 3601 (25934402 bytes), not {bytes} bytes"
        )
    })
}

/// The position of a tile with this name.
fn place(name: &str, [columns, rows]: [usize; 2]) -> Option<Placement> {
    corner(name).map(|[south, west]| Placement {
        origin: [west, south + 1.0],
        step: [1.0 / (columns - 1) as f64, 1.0 / (rows - 1) as f64],
        unit: Unit::Degrees,
        cell: None,
        keys: Some(keys::of_epsg(4326, true)),
    })
}

fn open(input: &mut dyn Input, name: &str, allowed: u64) -> std::result::Result<Dem, String> {
    let [columns, rows] = size(input)?;
    let bytes = (2 * columns * rows) as u64;
    let count = afford(columns as u64, rows as u64, allowed)?;
    let mut raw = Vec::with_capacity(2 * count);
    input.take(bytes).read_to_end(&mut raw).map_err(|cause| cause.to_string())?;
    let heights = metres16::heights(&raw);
    if heights.len() != count {
        return Err("it ends within its samples".into());
    }
    Dem::new([columns, rows], heights, place(name, [columns, rows]))
}

/// Latitude and longitude of the south-west corner, from a name such as N46E007.hgt or s09w077.SRTMGL1.hgt.
#[must_use]
pub fn corner(name: &str) -> Option<[f64; 2]> {
    let file = name.rsplit(['/', '\\']).next()?;
    let sign = |at: usize, plus: char, minus: char| match file.chars().nth(at)?.to_ascii_uppercase() {
        c if c == plus => Some(1.0),
        c if c == minus => Some(-1.0),
        _ => None,
    };
    let degrees = |digits: Option<&str>, most: f64| digits?.parse().ok().filter(|degrees: &f64| *degrees <= most);
    let south = sign(0, 'N', 'S')? * degrees(file.get(1..3), 90.0)?;
    let west = sign(3, 'E', 'W')? * degrees(file.get(4..7), 180.0)?;
    Some([south, west])
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::io::Cursor;

    #[test]
    fn what_is_written_is_read_back_at_its_corner() {
        let mut heights: Vec<f32> = (0..1201 * 1201).map(|k| (k % 1201) as f32 - (k / 1201) as f32).collect();
        heights[5] = f32::NAN;
        let mut bytes = Vec::new();
        write(&mut bytes, &heights).unwrap();
        let dem = read(&mut Cursor::new(&bytes), "dems/S09w077.hgt", 1 << 30).unwrap();
        assert_eq!((dem.width, dem.height, dem.missing()), (1201, 1201, 1));
        assert!(dem.heights.iter().zip(&heights).all(|(a, b)| a == b || b.is_nan()));
        let place = dem.place.unwrap();
        assert_eq!((place.origin, place.unit), ([-77.0, -8.0], Unit::Degrees));
        assert!((place.step[0] - 1.0 / 1200.0).abs() < 1e-15);
        assert_eq!(read(&mut Cursor::new(&bytes), "here.hgt", 1 << 30).unwrap().place, None);
        let error = read(&mut Cursor::new(&bytes), "N00E000.hgt", 1 << 20).unwrap_err().to_string();
        assert!(error.contains("1.0 MiB is allowed"), "{error}");
    }

    #[test]
    fn other_sizes_are_sentences() {
        for bytes in [vec![], vec![0; 77]] {
            let error = read(&mut Cursor::new(&bytes), "N00E000.hgt", 1 << 30).unwrap_err().to_string();
            assert!(error.contains(&format!("not {} bytes", bytes.len())), "{error}");
        }
        let void = [0x80, 0].repeat(1201 * 1201);
        assert!(
            read(&mut Cursor::new(&void), "N00E000.hgt", 1 << 30)
                .unwrap_err()
                .to_string()
                .contains("samples are nodata")
        );
    }
}
