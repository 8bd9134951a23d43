//! Files of stored solutions, and headers of stored tiles: any bytes are a solution or a tile, or refused with a message.
//!
//! The input is the header after the magic and the key, which are those of a solution and then those of a tile; zeros up to the largest length that the target makes follow. Checksums are not verified.
#![no_main]

mod scratch;

use libfuzzer_sys::fuzz_target;
use orogen::read_at::PositionedFile;
use orogen::store::fuzzing::{read, tile_windows, windows};
use orogen::store::solution_store::EntryKey;
use std::fs::File;
use std::io::{Seek, SeekFrom, Write};
use std::path::Path;
use std::sync::LazyLock;

/// Length of a page and its checksum.
const PAGE: u64 = 256 * 256 * 4 + 4;

static FILE: LazyLock<File> = LazyLock::new(|| {
    let path = scratch::path("");
    let file = File::options().create_new(true).read(true).write(true).open(&path).expect("a temporary file");
    // The descriptor keeps the file.
    std::fs::remove_file(&path).expect("its name is removed");
    file
});

fuzz_target!(|bytes: &[u8]| {
    let Some((&pages, head)) = bytes.split_first() else { return };
    let key = [7; 32];
    let mut tile = [&b"orogen planes 1\n"[..], &key[..], head].concat();
    tile.resize(tile.len() + usize::from(pages) * 64, 0);
    if let Ok((_, planes)) = tile_windows(&tile, Path::new("it"), &EntryKey(key)) {
        assert!(planes.iter().map(|window| 4 * window.len()).sum::<usize>() < tile.len());
    }
    let mut whole = b"orogen solved 1\n".to_vec();
    whole.extend(key);
    whole.extend(head);
    let mut file: &File = &FILE;
    file.set_len(0).and_then(|()| file.seek(SeekFrom::Start(0))).expect("the file is emptied");
    file.write_all(&whole).expect("the file is written");
    // The checksums of the header and of the list of checksums, and whole pages.
    let length = whole.len() as u64 + u64::from(pages % 4) * PAGE + u64::from(pages / 4 % 3) * 4;
    file.set_len(length).expect("the file grows");
    let path = Path::new("it");
    let again = || Box::new(PositionedFile::new(FILE.try_clone().expect("a descriptor")));
    let layers = windows(again(), path, &key);
    for on_disk in [false, true] {
        if let Ok(solution) = read(again(), path, &key, on_disk) {
            let layers = layers.as_ref().expect("the header of a whole file");
            assert!(solution.layers.iter().map(|layer| layer.window()).eq(layers));
            for layer in &solution.layers {
                let window = *layer.window();
                assert_eq!(layer.get(&window).expect("its samples").data().len(), window.len());
            }
        }
    }
});
