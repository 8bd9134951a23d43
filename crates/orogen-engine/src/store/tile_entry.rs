//! The file format of a tile of a level.
//!
//! A header (magic, key, level, number of planes, window, a checksum), the samples of one plane after the other, and
//! their checksum. Numbers are little-endian. The length follows from the header, so that a truncated file is detected
//! at once.

use super::entry_key::EntryKey;
use super::level_tile::LevelTile;
use orogen_grid::error::{Error, ErrorKind, Result};
use orogen_grid::grid::{Grid, Window};
use orogen_io::pages::{checksum, has_checksum};
use orogen_io::read_at::ReadAt;
use orogen_io::samples::{append_bytes, from_bytes};
use std::io::{self, Write};
use std::path::Path;

/// The magic of every file. Its number changes with the layout.
const MAGIC: &[u8; 16] = b"orogen planes 1\n";

/// Length of the header with its checksum, in bytes.
const HEAD: usize = 16 + 32 + 7 * 8 + 4;

/// Size of a stored tile, in bytes.
pub fn length(tile: &LevelTile) -> u64 {
    let samples = (tile.window.width as u64).saturating_mul(tile.window.height as u64);
    samples.saturating_mul(4).saturating_mul(tile.planes as u64).saturating_add(HEAD as u64 + 4)
}

/// Writes the planes of a tile.
pub fn write(out: &mut dyn Write, key: &EntryKey, tile: &LevelTile, planes: &[Grid]) -> io::Result<()> {
    let mut samples = Vec::with_capacity(usize::try_from(length(tile)).unwrap_or_default());
    planes.iter().for_each(|plane| append_bytes(&mut samples, plane.data()));
    out.write_all(&head(key, tile))?;
    out.write_all(&samples)?;
    out.write_all(&checksum(&samples).to_le_bytes())
}

/// Reads the bytes of [`write`] and verifies all of them.
///
/// # Errors
/// If the bytes cannot be read, are incomplete or damaged, or contain another tile.
pub fn read(bytes: &dyn ReadAt, name: &Path, key: &EntryKey, tile: &LevelTile) -> Result<Vec<Grid>> {
    let failed = |cause: io::Error| Error::file("read", name, &cause);
    let (there, whole) = (bytes.length().map_err(failed)?, length(tile));
    if there != whole {
        return Err(fault(name, &format!("it has {there} bytes instead of {whole}")));
    }
    let mut all = vec![0; usize::try_from(whole).map_err(|_| fault(name, "it is too large"))?];
    bytes.read_exact_at(0, &mut all).map_err(failed)?;
    let (head_read, rest) = all.split_at(HEAD);
    if *head_read != head(key, tile)[..] {
        return Err(fault(name, "its header is damaged or belongs to another tile"));
    }
    let (samples, sum) = rest.split_at(rest.len() - 4);
    if !has_checksum(samples, u32::from_le_bytes([sum[0], sum[1], sum[2], sum[3]])) {
        return Err(fault(name, "its samples are damaged"));
    }
    let plane = |bytes: &[u8]| {
        Grid::from_data(tile.window, from_bytes(bytes)).ok_or_else(|| fault(name, "it has too few samples"))
    };
    samples.chunks(4 * tile.window.len().max(1)).map(plane).collect()
}

/// The level of a stored tile, and its window once for each plane, from its header.
///
/// # Errors
/// If the header cannot be read, is damaged, or belongs to another entry.
pub fn windows(bytes: &dyn ReadAt, name: &Path, key: &EntryKey) -> Result<(usize, Vec<Window>)> {
    let failed = |cause: io::Error| Error::file("read", name, &cause);
    let mut head = [0; HEAD];
    bytes.read_exact_at(0, &mut head).map_err(failed)?;
    let (front, sum) = head.split_at(HEAD - 4);
    let is_tile = front[..16] == MAGIC[..] && front[16..48] == key.0;
    if !is_tile || !has_checksum(front, u32::from_le_bytes([sum[0], sum[1], sum[2], sum[3]])) {
        return Err(fault(name, "its header is damaged or belongs to another entry"));
    }
    let mut numbers = [0; 7];
    for (number, bytes) in numbers.iter_mut().zip(front[48..].as_chunks().0) {
        *number = u64::from_le_bytes(*bytes);
    }
    let [level, planes, x, y, width, height, cell] = numbers;
    let too_large = |_| fault(name, "it is too large");
    let [level, planes, width, height] =
        [usize::try_from(level), usize::try_from(planes), usize::try_from(width), usize::try_from(height)];
    let window = Window {
        x: x as i64,
        y: y as i64,
        width: width.map_err(too_large)?,
        height: height.map_err(too_large)?,
        cell: f64::from_bits(cell),
    };
    let (level, planes) = (level.map_err(too_large)?, planes.map_err(too_large)?);
    let (there, whole) = (bytes.length().map_err(failed)?, length(&LevelTile { node: [0; 32], level, planes, window }));
    if there != whole || window.is_empty() {
        return Err(fault(name, &format!("it has {there} bytes instead of {whole}")));
    }
    Ok((level, vec![window; planes]))
}

fn head(key: &EntryKey, tile: &LevelTile) -> Vec<u8> {
    let Window { x, y, width, height, cell } = tile.window;
    let mut head = Vec::with_capacity(HEAD);
    head.extend_from_slice(MAGIC);
    head.extend_from_slice(&key.0);
    let sizes = [tile.level as u64, tile.planes as u64];
    for number in sizes.into_iter().chain([x as u64, y as u64, width as u64, height as u64, cell.to_bits()]) {
        head.extend_from_slice(&number.to_le_bytes());
    }
    let sum = checksum(&head);
    head.extend_from_slice(&sum.to_le_bytes());
    head
}

fn fault(name: &Path, why: &str) -> Error {
    Error::new(ErrorKind::File, format!("{} is not a stored tile of a level: {why}", name.display()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_tile_is_read_back_and_any_damage_is_found() {
        let window = Window::new(5, 3, 7.5).at(-5, 3);
        let tile = LevelTile { node: [3; 32], level: 2, planes: 2, window };
        let samples = |factor: f32| (0..window.len()).map(|k| k as f32 * factor).collect();
        let mut planes = [0.3, -1.0].map(|factor| Grid::from_data(window, samples(factor)).unwrap());
        planes[1].data_mut()[4] = f32::from_bits(0x7FC0_1234);
        let (key, name) = (tile.entry_key(), Path::new("it"));
        let mut bytes = Vec::new();
        write(&mut bytes, &key, &tile, &planes).unwrap();
        assert_eq!(bytes.len() as u64, length(&tile));
        let bits =
            |planes: &[Grid]| planes.iter().flat_map(Grid::data).map(|sample| sample.to_bits()).collect::<Vec<_>>();
        assert_eq!(bits(&read(&bytes, name, &key, &tile).unwrap()), bits(&planes));
        assert_eq!(windows(&bytes, name, &key).unwrap(), (2, vec![window; 2]));
        for at in 0..bytes.len() {
            let mut damaged = bytes.clone();
            damaged[at] ^= 0x10;
            assert!(read(&damaged, name, &key, &tile).is_err(), "byte {at}");
            assert_eq!(windows(&damaged, name, &key).is_err(), at < HEAD, "byte {at}");
            damaged.truncate(at);
            assert!(read(&damaged, name, &key, &tile).is_err() && windows(&damaged, name, &key).is_err(), "{at} bytes");
        }
        for other in [
            LevelTile { node: [4; 32], ..tile },
            LevelTile { level: 3, ..tile },
            LevelTile { window: window.at(0, 0), ..tile },
        ] {
            assert!(read(&bytes, name, &other.entry_key(), &other).is_err(), "{other:?}");
        }
    }

    /// Sizes that no program writes, with a valid checksum.
    #[test]
    fn impossible_sizes_are_refused() {
        let tile = LevelTile { node: [3; 32], level: 2, planes: 1, window: Window::new(4, 4, 1.0) };
        let key = tile.entry_key();
        for (planes, width, height) in
            [(usize::MAX, 4, 4), (1, usize::MAX, usize::MAX), (1, 0, 4), (1 << 40, 0, 0), (1, 1 << 40, 4)]
        {
            let window = Window { width, height, ..tile.window };
            let mut bytes = head(&key, &LevelTile { planes, window, ..tile });
            bytes.extend([0; 4]);
            assert!(windows(&bytes, Path::new("it"), &key).is_err(), "{planes} of {width} x {height}");
        }
    }
}
