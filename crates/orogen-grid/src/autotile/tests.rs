//! Laws of tilemaps over random classes.

use super::choose::{ClassTiles, NONE, Variant, layers};
use super::classes::Classes;
use super::clean::{HALO, clean};
use super::drawable::Drawable;
use super::mask::{CORNERS, E, Layout, N, NE, NW, S, SE, SIMPLE_BLOB, SW, W};
use crate::progress::Progress;
use crate::random::Random;

/// Corner tiles without the two whose covered corners are opposite.
fn without_saddles() -> Vec<u8> {
    Layout::Corner.masks().into_iter().filter(|mask| ![NW | SE, NE | SW].contains(&(mask & CORNERS))).collect()
}

/// Classes drawn at random, or those of random blobs of about `grain` cells.
fn random(seed: u64, grain: i64, count: u64, side: usize) -> Classes {
    let at = |x: i64, y: i64, level: i64| {
        let cell = [x, y].map(|at| at.div_euclid(level));
        Random::new(seed ^ (cell[0] as u64).wrapping_mul(77), (cell[1] as u64).wrapping_mul(31) ^ level as u64).share()
    };
    let class = |x: i64, y: i64| {
        let value = if grain == 1 { at(x, y, 1) } else { 0.7 * at(x, y, grain) + 0.3 * at(x, y, (grain + 1) / 2) };
        (value * count as f64) as u8
    };
    let cells = (0..side as i64).flat_map(|y| (0..side as i64).map(move |x| (x - 20, y + 7)));
    Classes::new([-20, 7], side, side, cells.map(|(x, y)| class(x, y)).collect())
}

fn sets() -> Vec<(&'static str, Layout, Vec<u8>)> {
    let mut sets: Vec<_> = Layout::ALL.into_iter().map(|layout| (layout.name(), layout, layout.masks())).collect();
    sets.push(("blob of 13", Layout::Blob, SIMPLE_BLOB.to_vec()));
    let without = |removed: &[u8]| Layout::Blob.masks().into_iter().filter(|mask| !removed.contains(mask)).collect();
    sets.push(("blob without islets and necks", Layout::Blob, without(&[0, N | S, E | W, N, E, S, W])));
    sets.push(("corners without saddles", Layout::Corner, without_saddles()));
    sets.push(("dual without saddles", Layout::Dual, without_saddles()));
    sets
}

#[test]
fn after_the_clean_up_every_cell_has_a_tile() {
    for (name, layout, masks) in sets() {
        for classes in [2, 3, 6] {
            for (seed, grain) in [(1, 1), (2, 2), (3, 3), (4, 5), (5, 13)] {
                let drawable = Drawable::new(layout, (1..classes).map(|_| masks.as_slice()));
                let mut map = random(seed, grain, classes, 120);
                let before = map.clone();
                let gaps = drawable.gaps(&map).len();
                clean(&mut map, &drawable, &Progress::none()).unwrap();
                let changed = map.data().iter().zip(before.data()).filter(|(a, b)| a != b).count();
                let left = drawable.gaps(&map);
                assert_eq!(left, [], "{name}, {classes} classes, grain {grain}");
                assert!(gaps > 0 || changed == 0, "only what cannot be drawn is changed");
            }
        }
    }
}

/// Tiles whose number is their reduced mask, and a second variant of it above 256.
fn numbered(layout: Layout, masks: &[u8]) -> ClassTiles {
    let variant = |mask: u8, more: u32| (mask, Variant { tile: u32::from(mask) + more, weight: 1.0 });
    let tiles: Vec<(u8, Variant)> = masks.iter().flat_map(|mask| [variant(*mask, 0), variant(*mask, 256)]).collect();
    ClassTiles::new(layout, &tiles)
}

#[test]
fn a_part_is_cleaned_and_drawn_as_the_whole_is() {
    for (name, layout, masks) in sets() {
        let drawable = Drawable::new(layout, (1..4).map(|_| masks.as_slice()));
        let tiles: Vec<ClassTiles> = (0..4).map(|_| numbered(layout, &masks)).collect();
        let whole = random(9, 2, 4, 330);
        let mut cleaned = whole.clone();
        clean(&mut cleaned, &drawable, &Progress::none()).unwrap();
        let drawn = layers(&cleaned, &drawable, &tiles, 5);
        for (at, [width, height]) in [([HALO, HALO], [64, 33]), ([HALO + 51, HALO + 3], [17, 70])] {
            let start = [whole.x + at[0] as i64, whole.y + at[1] as i64];
            let halo = HALO as i64;
            let mut part = whole.part([start[0] - halo, start[1] - halo], width + 2 * HALO, height + 2 * HALO);
            clean(&mut part, &drawable, &Progress::none()).unwrap();
            assert_eq!(part.part(start, width, height), cleaned.part(start, width, height), "{name}");
            // Tiles need one more cell around.
            let around = part.part([start[0] - 1, start[1] - 1], width + 2, height + 2);
            let small = layers(&around, &drawable, &tiles, 5);
            let ([columns, _], [inner, _]) = (drawable.tiles(&cleaned), drawable.tiles(&around));
            for (layer, small) in drawn.iter().zip(&small) {
                for y in 0..height {
                    let row = &layer[(at[1] + y) * columns + at[0]..][..width];
                    assert_eq!(&small[(y + 1) * inner + 1..][..width], row, "{name}");
                }
            }
        }
    }
}

/// What two tiles side by side show along their common edge and at its corners is the same.
#[test]
fn neighbors_match_along_edges_and_corners() {
    for (name, layout, masks) in sets() {
        let drawable = Drawable::new(layout, (1..4).map(|_| masks.as_slice()));
        let mut map = random(3, 2, 4, 90);
        clean(&mut map, &drawable, &Progress::none()).unwrap();
        let [width, height] = drawable.tiles(&map);
        // The masks of a layer: of all tiles that it reaches, also of those that tiles above it hide.
        let masks_of = |class: u8| -> Vec<Option<u8>> {
            let tiles = (0..height as i64).flat_map(|y| (0..width as i64).map(move |x| (x, y)));
            let mask = |(x, y): (i64, i64)| {
                let (seen, own) = drawable.seen(|x, y| map.at(x, y), x, y);
                (own >= class).then(|| layout.reduced(drawable.mask(&seen, class)))
            };
            tiles.map(mask).collect()
        };
        for class in 1..4 {
            let found = masks_of(class);
            for y in 0..height - 1 {
                for x in 0..width - 1 {
                    let [own, east, south] =
                        [found[y * width + x], found[y * width + x + 1], found[(y + 1) * width + x]];
                    let bits = |of: Option<u8>, bits: [u8; 2]| of.map(|mask| bits.map(|bit| mask & bit != 0));
                    if layout.is_on_corners() {
                        let none = Some([false; 2]);
                        assert_eq!(bits(own, [NE, SE]).or(none), bits(east, [NW, SW]).or(none), "{name}");
                        assert_eq!(bits(own, [SW, SE]).or(none), bits(south, [NW, NE]).or(none), "{name}");
                        continue;
                    }
                    // A side is covered on both sides of it, or it is a border of the layer.
                    assert_eq!(own.is_some_and(|mask| mask & E != 0), own.is_some() && east.is_some(), "{name}");
                    assert_eq!(east.is_some_and(|mask| mask & W != 0), own.is_some() && east.is_some(), "{name}");
                    assert_eq!(own.is_some_and(|mask| mask & S != 0), own.is_some() && south.is_some(), "{name}");
                    // Where the layer goes on, both tiles show the same at the ends of the side.
                    if let (Layout::Blob, Some(own), Some(east)) = (layout, own, east) {
                        let corner = |mask: u8, side: u8, corner: u8| mask & side != 0 && mask & corner != 0;
                        assert_eq!(corner(own, N, NE), corner(east, N, NW), "{name}");
                        assert_eq!(corner(own, S, SE), corner(east, S, SW), "{name}");
                    }
                }
            }
        }
    }
}

#[test]
fn layers_hide_what_is_below_a_full_tile() {
    let tiles: Vec<ClassTiles> = (0..3).map(|_| numbered(Layout::Blob, &Layout::Blob.masks())).collect();
    let drawable = Drawable::complete(Layout::Blob, 3);
    let map = random(1, 8, 3, 60);
    let drawn = layers(&map, &drawable, &tiles, 0);
    for place in 0..drawn[0].len() {
        let shown: Vec<u32> = drawn.iter().map(|layer| layer[place]).filter(|tile| *tile != NONE).collect();
        assert!(shown.first().is_some_and(|tile| tile % 256 == 255), "something covers every cell");
        assert!(shown[1..].iter().all(|tile| tile % 256 != 255), "nothing hides another tile");
    }
}

#[test]
fn variants_are_drawn_by_their_weights() {
    let variant = |tile, weight| (255, Variant { tile, weight });
    let tiles = ClassTiles::new(Layout::Blob, &[variant(0, 6.0), variant(1, 3.0), variant(2, 1.0)]);
    let mut counts = [0; 3];
    for at in 0..100_000 {
        let tile = tiles.choose(255, [at % 317 - 150, at / 317], 11).unwrap();
        counts[tile as usize] += 1;
    }
    for (count, share) in counts.into_iter().zip([0.6, 0.3, 0.1]) {
        assert!((f64::from(count) / 1e5 - share).abs() < 0.01, "{counts:?}");
    }
    assert_eq!(tiles.choose(7, [0, 0], 11), None);
}
