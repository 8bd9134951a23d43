//! Files of stored solutions, and headers of stored tiles: any bytes are a solution or a tile, or refused with a
//! message.
//!
//! The input is the header after the magic and the key, which are those of a solution and then those of a tile; zeros
//! up to the largest length that the target makes follow. The target puts the right checksums in their places, so that
//! it reaches what they protect.

use orogen::store::EntryKey;
use orogen::store::fuzzing::{read, tile_windows, windows};
use orogen_io::pages::{BYTES, checksum};
use std::path::Path;

/// The key of the entries.
const KEY: [u8; 32] = [7; 32];

/// Length of the header of a tile, without its checksum.
const TILE_HEAD: usize = 16 + 32 + 7 * 8;

/// Puts the checksum of a part of the bytes at a place, if the bytes reach that far.
fn put_checksum(bytes: &mut [u8], from: usize, to: usize, at: usize) {
    let Some(sum) = bytes.get(from..to).map(checksum) else { return };
    if let Some(place) = bytes.get_mut(at..at + 4) {
        place.copy_from_slice(&sum.to_le_bytes());
    }
}

/// Puts all checksums of a solution in the places that its header tells.
fn put_checksums(bytes: &mut [u8]) {
    let number = |at: usize| bytes.get(at..at + 8).and_then(|word| word.try_into().ok()).map(u64::from_le_bytes);
    let (Some(numbers @ ..=0xFFFF), Some(layers @ ..=0xFFFF)) = (number(48), number(56)) else { return };
    let end = 64 + 8 * numbers as usize + 40 * layers as usize;
    put_checksum(bytes, 0, end, end);
    let pages = bytes.len().saturating_sub(end + 8) / (BYTES + 4);
    let sums = end + 4 + pages * BYTES;
    for page in 0..pages {
        let from = end + 4 + page * BYTES;
        put_checksum(bytes, from, from + BYTES, sums + 4 * page);
    }
    put_checksum(bytes, sums, sums + 4 * pages, sums + 4 * pages);
}

/// Runs the target on an input.
pub fn run(bytes: &[u8]) {
    let Some((&pages, head)) = bytes.split_first() else { return };
    let path = Path::new("it");
    let mut tile = [&b"orogen planes 1\n"[..], &KEY, head].concat();
    tile.resize(tile.len() + usize::from(pages) * 64, 0);
    put_checksum(&mut tile, 0, TILE_HEAD, TILE_HEAD);
    if let Ok((_, planes)) = tile_windows(&tile, path, &EntryKey(KEY)) {
        assert!(planes.iter().map(|window| 4 * window.len()).sum::<usize>() < tile.len());
    }
    let mut whole = [&b"orogen solved 1\n"[..], &KEY, head].concat();
    // The checksums of the header and of the list of checksums, and whole pages.
    whole.resize(whole.len() + usize::from(pages % 4) * (BYTES + 4) + usize::from(pages / 4 % 3) * 4, 0);
    put_checksums(&mut whole);
    let again = || Box::new(whole.clone());
    let layers = windows(again(), path, &KEY);
    for on_disk in [false, true] {
        if let Ok(solution) = read(again(), path, &KEY, on_disk) {
            let layers = layers.as_ref().expect("the header of a whole file");
            assert!(solution.layers.iter().map(|layer| layer.window()).eq(layers));
            for layer in &solution.layers {
                let window = *layer.window();
                assert_eq!(layer.get(&window).expect("its samples").data().len(), window.len());
            }
        }
    }
}
