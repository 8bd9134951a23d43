//! Everything beside a picture of heights at once: any texts are understood or refused with a message.
//!
//! The input is the content of the files in [`NAMES`], in this order, separated by lines of `---`.

use crate::scratch::Scratch;
use orogen::io::dem::PreparedDem;
use orogen::io::format::import;

/// What may stand beside a picture.
pub const NAMES: [&str; 6] = ["a.png.json", "a.json", "a.toml", "a.pgw", "a.prj", "a.png.aux.xml"];

thread_local! {
    /// A folder with a picture.
    static FOLDER: Scratch = {
        let folder = Scratch::new("sidecar");
        std::fs::write(folder.join("a.png"), include_bytes!("../../corpus/dem/grey.png")).expect("a picture");
        folder
    };
}

/// Runs the target on an input.
pub fn run(bytes: &[u8]) {
    FOLDER.with(|folder| {
        folder.write_parts(&NAMES, bytes);
        let path = folder.join("a.png");
        if let Ok(dem) = import::read(&path, 1 << 20) {
            assert_eq!(dem.heights.len(), dem.width * dem.height);
            // In square metres, at a cell that the size of the result limits.
            if let Ok(ground) = PreparedDem::read(&path, None, 1 << 20) {
                let cell = ground.grid.window().cell;
                assert!(cell.is_finite() && cell > 0.0 && ground.grid.data().iter().all(|height| height.is_finite()));
            }
        }
    });
}
