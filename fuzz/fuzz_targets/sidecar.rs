//! Everything beside a picture of heights at once: any texts are understood or refused with a message.
//!
//! The input is the content of the files in [`NAMES`], in this order, separated by lines of `---`.
#![no_main]

use libfuzzer_sys::fuzz_target;
use orogen::dem::prepared::PreparedDem;
use orogen::format::import;
use std::path::{Path, PathBuf};
use std::sync::LazyLock;

const NAMES: [&str; 6] = ["a.png.json", "a.json", "a.toml", "a.pgw", "a.prj", "a.png.aux.xml"];

static FOLDER: LazyLock<PathBuf> = LazyLock::new(|| {
    let folder = Path::new("/dev/shm");
    let folder = if folder.is_dir() { folder.to_path_buf() } else { std::env::temp_dir() };
    let folder = folder.join(format!("orogen-fuzz-{}", std::process::id()));
    std::fs::create_dir_all(&folder).expect("the folder is made");
    std::fs::write(folder.join("a.png"), include_bytes!("../corpus/dem/grey.png")).expect("a picture");
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
