//! Tilesets of Tiled and descriptions of tilesets: any text is a tileset, or refused with a message. What is drawn with
//! it fits.

use orogen::Progress;
use orogen::grid::autotile::choose::layers;
use orogen::grid::autotile::{Classes, clean};
use orogen::tilemap::load::any::parse;
use orogen::tilemap::tiled::write_tsx;
use orogen::tilemap::tileset::parts;

/// Runs the target on an input; one that is no text is skipped.
pub fn run(input: &[u8]) {
    let Ok(text) = std::str::from_utf8(input) else { return };
    for is_toml in [false, true] {
        let Ok(set) = parse(text, is_toml, None, 32) else { continue };
        let count = set.terrains.len();
        let mut classes = Classes::new([-3, 5], 9, 7, (0..63).map(|cell| (cell * 5 % 11 % count) as u8).collect());
        let drawable = set.drawable();
        clean(&mut classes, &drawable, &Progress::none()).unwrap();
        for layer in layers(&classes, &drawable, &set.choices(), 1) {
            for tile in layer.into_iter().filter(|tile| *tile != orogen::grid::autotile::choose::NONE) {
                assert!((parts(tile).0 as usize) < set.count, "{text}");
            }
        }
        let mut out = Vec::new();
        write_tsx(&set, &mut out, "tiles.png", "fuzz").unwrap();
    }
}
