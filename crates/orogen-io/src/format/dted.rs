//! DTED (MIL-PRF-89020B), `.dt0`, `.dt1` and `.dt2`: one degree of WGS 84, whole metres; columns from the west, each
//! from the south. -32767 is nodata; negative heights have a sign bit.

use std::io::Read;

use super::crs::keys;
use super::crs::unit::Unit;
use super::dem::{Dem, Input, Placement, afford, length, refused};
use super::metres16;
use crate::samples;
use orogen_grid::error::Result;

/// Bytes before the columns: the labels UHL, DSI and ACC.
const HEAD: usize = 80 + 648 + 2700;

/// Bytes of a column before and after its samples.
const LEADER: usize = 8;
const TRAILER: usize = 4;

/// Reads a cell. `name` is the file's name in errors.
///
/// # Errors
/// If it is not DTED, does not have the stated length, or its heights take more than `allowed` bytes.
pub fn read(input: &mut dyn Input, name: &str, allowed: u64) -> Result<Dem> {
    open(input, allowed).map_err(|why| refused(name, why))
}

fn open(input: &mut dyn Input, allowed: u64) -> std::result::Result<Dem, String> {
    let there = length(input)?;
    let mut head = Vec::new();
    input.take(HEAD as u64).read_to_end(&mut head).map_err(|cause| cause.to_string())?;
    if head.len() < HEAD || !head.starts_with(b"UHL1") {
        return Err("it is not DTED: it does not begin with the label UHL1".into());
    }
    let field = |from: usize, to: usize| {
        let text = head.get(from..to).and_then(|bytes| std::str::from_utf8(bytes).ok());
        text.map(str::trim).ok_or_else(|| format!("bytes {from} to {to} of its label are not text"))
    };
    let number = |from: usize, to: usize, what: &str| {
        let text = field(from, to)?;
        text.parse::<u32>().map_err(|_| format!("its {what} is `{}`", text.escape_debug()))
    };
    let (west, south) = (angle(field(4, 12)?)?, angle(field(12, 20)?)?);
    // Tenths of arc seconds.
    let step = [number(20, 24, "longitude interval")?, number(24, 28, "latitude interval")?];
    let (columns, rows) = (number(47, 51, "number of columns")?, number(51, 55, "number of rows")?);
    let count = afford(u64::from(columns), u64::from(rows), allowed)?;
    let (width, height) = (columns as usize, rows as usize);
    let record = LEADER + 2 * height + TRAILER;
    if there < (HEAD + record * width) as u64 {
        return Err(format!("{width} x {height} samples need {} bytes, and it has {there}", HEAD + record * width));
    }
    if step.contains(&0) {
        return Err("its intervals are 0".into());
    }
    let mut heights = samples::filled(f32::NAN, count);
    let mut bytes = vec![0; record];
    for i in 0..width {
        input.read_exact(&mut bytes).map_err(|cause| cause.to_string())?;
        if bytes.first() != Some(&0xaa) {
            return Err(format!("its column {i} has no sentinel; it is damaged"));
        }
        metres16::dted_column(&bytes[LEADER..LEADER + 2 * height], &mut heights, width, i);
    }
    let step = step.map(|tenths| f64::from(tenths) / 36_000.0);
    let place = Placement {
        origin: [west, south + step[1] * (f64::from(rows) - 1.0)],
        step,
        unit: Unit::Degrees,
        cell: None,
        keys: Some(keys::of_epsg(4326, true)),
    };
    Dem::new([width, height], heights, Some(place))
}

/// Degrees from a text such as 0070000E.
fn angle(text: &str) -> std::result::Result<f64, String> {
    let invalid = || format!("its corner `{}` is not an angle", text.escape_debug());
    let part = |from: usize, to: usize| text.get(from..to).and_then(|part| part.parse::<u32>().ok()).map(f64::from);
    let (Some(degrees), Some(minutes), Some(seconds)) = (part(0, 3), part(3, 5), part(5, 7)) else {
        return Err(invalid());
    };
    let degrees = degrees + minutes / 60.0 + seconds / 3600.0;
    match text.get(7..) {
        Some("E" | "N") if degrees <= 180.0 => Ok(degrees),
        Some("W" | "S") if degrees <= 180.0 => Ok(-degrees),
        _ => Err(invalid()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::io::Cursor;

    /// Three columns of two rows, as GDAL writes labels.
    fn file(west: &str) -> Vec<u8> {
        let mut bytes = format!("UHL1{west}0460000N00300030NA  U  \0           000300020").into_bytes();
        bytes.resize(HEAD, b' ');
        for column in [[1u16, 2], [0x8003, 4], [0xffff, 6]] {
            bytes.extend([0xaa, 0, 0, 0, 0, 0, 0, 0]);
            column.into_iter().for_each(|sample| bytes.extend(sample.to_be_bytes()));
            bytes.extend([0; 4]);
        }
        bytes
    }

    #[test]
    fn columns_run_from_the_south() {
        let dem = open(&mut Cursor::new(file("0070000E")), 1 << 20).unwrap();
        assert_eq!((dem.width, dem.height, &dem.heights[..5]), (3, 2, &[2.0, 4.0, 6.0, 1.0, -3.0][..]));
        assert!(dem.heights[5].is_nan());
        let place = dem.place.unwrap();
        assert!(place.origin[0] == 7.0 && (place.origin[1] - (46.0 + 3.0 / 3600.0)).abs() < 1e-12);
        assert_eq!(place.step, [30.0 / 36_000.0; 2]);
    }

    #[test]
    fn damage_is_a_message() {
        let mut short = file("0070000E");
        short.truncate(short.len() - 1);
        assert!(open(&mut Cursor::new(short), 1 << 20).unwrap_err().contains("3 x 2 samples need"));
        assert!(open(&mut Cursor::new(file("007000xE")), 1 << 20).unwrap_err().contains("not an angle"));
        assert!(open(&mut Cursor::new(b"UHL1"), 1 << 20).unwrap_err().contains("not DTED"));
        let mut damaged = file("0070000W");
        damaged[HEAD] = 0;
        assert!(open(&mut Cursor::new(damaged), 1 << 20).unwrap_err().contains("no sentinel"));
    }
}
