//! Zarr groups of versions 2 and 3: any metadata and chunks are heights or a message.
//!
//! The input is the content of the files in [`NAMES`], in this order, separated by lines of `---`.
#![no_main]

use libfuzzer_sys::fuzz_target;
use orogen::dem::open;
use orogen::format::dem::Request;
use std::path::{Path, PathBuf};
use std::sync::LazyLock;

/// The metadata of the array, of version 3 or 2, and its attributes of version 2; that of the coordinates; chunks of the names of both versions.
const NAMES: [&str; 10] = [
    "height/zarr.json",
    "height/.zarray",
    "height/.zattrs",
    "x/zarr.json",
    "y/zarr.json",
    "x/c/0",
    "y/c/0",
    "height/c/0/0",
    "height/0.0",
    "spatial_ref/zarr.json",
];

static FOLDER: LazyLock<PathBuf> = LazyLock::new(|| {
    let folder = Path::new("/dev/shm");
    let folder = if folder.is_dir() { folder.to_path_buf() } else { std::env::temp_dir() };
    let folder = folder.join(format!("orogen-fuzz-{}.zarr", std::process::id()));
    for name in NAMES {
        std::fs::create_dir_all(folder.join(name).parent().expect("a folder")).expect("the folder is made");
    }
    std::fs::write(folder.join("zarr.json"), r#"{"zarr_format": 3, "node_type": "group"}"#).expect("a group");
    folder
});

fuzz_target!(|bytes: &[u8]| {
    let mut rest = Some(bytes);
    for name in NAMES {
        let part = rest.and_then(|bytes| {
            let end = bytes.windows(5).position(|part| part == b"\n---\n");
            rest = end.map(|end| &bytes[end + 5..]);
            Some(&bytes[..end.unwrap_or(bytes.len())]).filter(|part| !part.is_empty())
        });
        let path = FOLDER.join(name);
        match part {
            Some(part) => std::fs::write(&path, part).expect("a file is written"),
            None => drop(std::fs::remove_file(&path)),
        }
    }
    for folder in [FOLDER.clone(), FOLDER.join("height")] {
        if let Ok(dem) = open::read(&folder, Request::new(1 << 20).with_band(Some(1))) {
            assert_eq!(dem.heights.len(), dem.width * dem.height);
        }
    }
});
