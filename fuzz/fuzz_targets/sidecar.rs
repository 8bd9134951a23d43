//! Everything beside a picture of heights at once: any texts are understood or refused with a message.
//!
//! The input is the content of the files in [`NAMES`], in this order, separated by lines of `---`.
#![no_main]

mod scratch;

use libfuzzer_sys::fuzz_target;
use orogen::dem::prepared::PreparedDem;
use orogen::format::import;
use std::path::PathBuf;
use std::sync::LazyLock;

const NAMES: [&str; 6] = ["a.png.json", "a.json", "a.toml", "a.pgw", "a.prj", "a.png.aux.xml"];

static FOLDER: LazyLock<PathBuf> = LazyLock::new(|| {
    let folder = scratch::path("");
    std::fs::create_dir_all(&folder).expect("the folder is made");
    std::fs::write(folder.join("a.png"), include_bytes!("../corpus/dem/grey.png")).expect("a picture");
    folder
});

fuzz_target!(|bytes: &[u8]| {
    scratch::write_parts(&FOLDER, &NAMES, bytes);
    let path = FOLDER.join("a.png");
    if let Ok(dem) = import::read(&path, 1 << 20) {
        assert_eq!(dem.heights.len(), dem.width * dem.height);
        // In square metres, at a cell that the size of the result limits.
        if let Ok(ground) = PreparedDem::read(&path, None, 1 << 20) {
            let cell = ground.grid.window().cell;
            assert!(cell.is_finite() && cell > 0.0 && ground.grid.data().iter().all(|height| height.is_finite()));
        }
    }
});
