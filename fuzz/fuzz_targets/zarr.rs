//! Zarr groups of versions 2 and 3: any metadata and chunks are heights or a message.
//!
//! The input is the content of the files in [`NAMES`], in this order, separated by lines of `---`.
#![no_main]

mod scratch;

use libfuzzer_sys::fuzz_target;
use orogen::dem::open;
use orogen::format::dem::Request;
use std::path::PathBuf;
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
    let folder = scratch::path(".zarr");
    for name in NAMES {
        std::fs::create_dir_all(folder.join(name).parent().expect("a folder")).expect("the folder is made");
    }
    std::fs::write(folder.join("zarr.json"), r#"{"zarr_format": 3, "node_type": "group"}"#).expect("a group");
    folder
});

fuzz_target!(|bytes: &[u8]| {
    scratch::write_parts(&FOLDER, &NAMES, bytes);
    for folder in [FOLDER.clone(), FOLDER.join("height")] {
        if let Ok(dem) = open::read(&folder, Request::new(1 << 20).with_band(Some(1))) {
            assert_eq!(dem.heights.len(), dem.width * dem.height);
        }
    }
});
