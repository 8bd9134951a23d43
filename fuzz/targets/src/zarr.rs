//! Zarr groups of versions 2 and 3: any metadata and chunks are heights or a message.
//!
//! The input is the content of the files in [`NAMES`], in this order, separated by lines of `---`.

use crate::scratch::Scratch;
use orogen::io::dem::open;
use orogen::io::format::Request;

/// The metadata of the array, of version 3 or 2, and its attributes of version 2; that of the coordinates; chunks of
/// the names of both versions.
pub const NAMES: [&str; 10] = [
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

thread_local! {
    /// A group without arrays.
    static FOLDER: Scratch = {
        let folder = Scratch::new("zarr");
        for name in NAMES {
            let inside = folder.join("group.zarr").join(name);
            std::fs::create_dir_all(inside.parent().expect("a folder")).expect("the folder is made");
        }
        let group = r#"{"zarr_format": 3, "node_type": "group"}"#;
        std::fs::write(folder.join("group.zarr/zarr.json"), group).expect("a group");
        folder
    };
}

/// Runs the target on an input.
pub fn run(bytes: &[u8]) {
    FOLDER.with(|folder| {
        folder.write_parts(&NAMES.map(|name| ["group.zarr/", name].concat()), bytes);
        let group = folder.join("group.zarr");
        for folder in [group.join("height"), group] {
            if let Ok(dem) = open::read(&folder, Request::new(1 << 20).with_band(Some(1))) {
                assert_eq!(dem.heights.len(), dem.width * dem.height);
            }
        }
    });
}
