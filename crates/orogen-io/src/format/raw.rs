//! Headerless samples, `.r16` (u16, scaled over a range of heights) and `.r32` (f32, metres), with a [`Sidecar`].

use std::io::{self, Read, Write};

use super::dem::{Dem, Input, afford, length, refused};
use super::levels::Levels;
use super::sidecar::{Sidecar, needs};
use super::stored::{Kind, Stored};
use crate::samples;
use orogen_grid::error::Result;
use orogen_grid::grid::Grid;

/// Number of bytes that are read at a time.
const PIECE: usize = 1 << 16;

/// The type of the samples.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Sample {
    /// Two bytes: 0 is the low end of the range and 65535 the high end.
    U16,
    /// Four bytes, metres.
    F32,
}

/// Writes a grid as u16, little-endian, over the range of `levels`.
pub fn write_r16(out: &mut dyn Write, grid: &Grid, levels: &Levels) -> io::Result<()> {
    write_u16(out, grid.data(), levels)
}

/// Writes a grid as f32, little-endian.
pub fn write_r32(out: &mut dyn Write, grid: &Grid) -> io::Result<()> {
    write_f32(out, grid.data())
}

/// Writes samples as u16, little-endian, over the range of `levels`.
pub fn write_u16(out: &mut dyn Write, samples: &[f32], levels: &Levels) -> io::Result<()> {
    samples.chunks(1 << 15).try_for_each(|piece| out.write_all(&levels.to_le_bytes(piece)))
}

/// Writes samples as f32, little-endian.
pub fn write_f32(out: &mut dyn Write, samples: &[f32]) -> io::Result<()> {
    samples.chunks(1 << 14).try_for_each(|piece| out.write_all(&samples::to_bytes(piece)))
}

/// Reads samples as described by their sidecar. `name` is the file's name in errors.
///
/// # Errors
/// If the sidecar is incomplete, the file does not have the stated length, or heights take more than `allowed` bytes.
pub fn read(input: &mut dyn Input, name: &str, sample: Sample, sidecar: &Sidecar, allowed: u64) -> Result<Dem> {
    open(input, sample, sidecar, allowed).map_err(|why| refused(name, why))
}

fn open(input: &mut dyn Input, sample: Sample, sidecar: &Sidecar, allowed: u64) -> std::result::Result<Dem, String> {
    let (Some(width), Some(height)) = (sidecar.width, sidecar.height) else {
        return Err(needs("its width and height in samples"));
    };
    let big = sidecar.big_endian()?;
    let [low, high] = if sample == Sample::U16 { sidecar.range(65535.0)? } else { [0.0, 1.0] };
    let count = afford(width, height, allowed)?;
    let size: usize = if sample == Sample::U16 { 2 } else { 4 };
    let there = length(input)?;
    if there != (count * size) as u64 {
        return Err(format!(
            "{width} x {height} samples of {size} bytes need {} bytes, and it has {there}",
            (count * size) as u64
        ));
    }
    let kind = if sample == Sample::U16 { Kind::Unsigned } else { Kind::Float };
    let stored = Stored { kind, size, big_endian: big };
    let mut heights: Vec<f32> = Vec::with_capacity(count);
    let mut bytes = Vec::with_capacity(PIECE);
    while heights.len() < count {
        bytes.clear();
        input.take(PIECE as u64).read_to_end(&mut bytes).map_err(|cause| cause.to_string())?;
        if bytes.is_empty() {
            return Err("it ends within its samples".into());
        }
        match sample {
            Sample::U16 => stored.append_scaled(&bytes, 65535.0, [low, high], sidecar.nodata, &mut heights),
            Sample::F32 => stored.append(&bytes, sidecar.nodata, &mut heights),
        }
    }
    let heights = sidecar.north_first(heights, width as usize)?;
    Dem::new([width as usize, height as usize], heights, sidecar.place(height as usize)?)
}

#[cfg(test)]
mod tests {
    use super::*;
    use orogen_grid::grid::Window;
    use std::io::Cursor;

    fn sidecar() -> Sidecar {
        let text = "width = 5\nheight = 3\ncell = 4\nlow = 0\nhigh = 6553.5\nnodata = 7";
        Sidecar::parse(text, true).unwrap()
    }

    #[test]
    fn what_is_written_is_read_back() {
        let grid = Grid::from_data(Window::new(5, 3, 4.0), (0..15).map(|k| k as f32 * 3.1).collect()).unwrap();
        let mut bytes = Vec::new();
        write_r32(&mut bytes, &grid).unwrap();
        let dem = read(&mut Cursor::new(&bytes), "a.r32", Sample::F32, &sidecar(), 1 << 20).unwrap();
        assert_eq!((dem.heights, dem.place.unwrap().step), (grid.data().to_vec(), [4.0; 2]));
        bytes.clear();
        write_r16(&mut bytes, &grid, &Levels::new(0.0, 6553.5)).unwrap();
        let dem = read(&mut Cursor::new(&bytes), "a.r16", Sample::U16, &sidecar(), 1 << 20).unwrap();
        assert!(dem.heights.iter().zip(grid.data()).all(|(a, b)| (a - b).abs() <= 0.051));
        for pair in bytes.chunks_exact_mut(2) {
            pair.reverse();
        }
        let big = Sidecar { byte_order: Some("big".into()), ..sidecar() };
        assert_eq!(read(&mut Cursor::new(&bytes), "a.r16", Sample::U16, &big, 1 << 20).unwrap().heights, dem.heights);
        bytes[..2].copy_from_slice(&[0, 7]);
        assert_eq!(read(&mut Cursor::new(&bytes), "a.r16", Sample::U16, &big, 1 << 20).unwrap().missing(), 1);
    }

    #[test]
    fn wrong_lengths_and_missing_facts_are_sentences() {
        let error = |sidecar: &Sidecar, bytes: usize| {
            let read = read(&mut Cursor::new(vec![0; bytes]), "a.r16", Sample::U16, sidecar, 1 << 20);
            read.unwrap_err().to_string()
        };
        assert!(error(&sidecar(), 29).contains("need 30 bytes, and it has 29"));
        assert!(error(&Sidecar::default(), 30).contains("width and height"));
        assert!(error(&Sidecar { low: None, ..sidecar() }, 30).contains("low and high"));
        assert!(error(&Sidecar { width: Some(1 << 40), ..sidecar() }, 30).contains("is allowed"));
    }
}
