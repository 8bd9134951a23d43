//! Laws of tilemaps over random classes.

use super::choose::{ClassTiles, NONE, Tiles, Variant, WangTiles, layers};
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

/// Random classes, or classes of random blobs of about `grain` cells.
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
        let tiles = Tiles::Layers((0..4).map(|_| numbered(layout, &masks)).collect());
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
            // Tiles depend on one more cell around.
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

/// Two adjacent tiles show the same along their common edge and at its corners.
#[test]
fn neighbors_match_along_edges_and_corners() {
    for (name, layout, masks) in sets() {
        let drawable = Drawable::new(layout, (1..4).map(|_| masks.as_slice()));
        let mut map = random(3, 2, 4, 90);
        clean(&mut map, &drawable, &Progress::none()).unwrap();
        let [width, height] = drawable.tiles(&map);
        // The masks of a layer, for all tiles that it reaches, including those that are hidden by tiles above.
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
                    // Both tiles show a side as covered, or it is a border of the layer.
                    assert_eq!(own.is_some_and(|mask| mask & E != 0), own.is_some() && east.is_some(), "{name}");
                    assert_eq!(east.is_some_and(|mask| mask & W != 0), own.is_some() && east.is_some(), "{name}");
                    assert_eq!(own.is_some_and(|mask| mask & S != 0), own.is_some() && south.is_some(), "{name}");
                    // Where the layer continues, both tiles show the same at the ends of the side.
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
    let tiles = Tiles::Layers((0..3).map(|_| numbered(Layout::Blob, &Layout::Blob.masks())).collect());
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

/// Wang tiles for all ways in which two classes of a pair can meet.
fn of_pairs(layout: Layout, pairs: &[[u8; 2]], is_removed: impl Fn(u8) -> bool) -> Vec<[u8; 8]> {
    let tiles = pairs.iter().flat_map(|[low, high]| {
        let masks = (0..=255).filter(|mask| mask & !layout.directions() == 0 && !is_removed(*mask));
        masks.map(move |mask: u8| {
            let class = |bit: usize| match (layout.directions() >> bit & 1, mask >> bit & 1) {
                (0, _) => 0,
                (_, 0) => *low,
                _ => *high,
            };
            std::array::from_fn(class)
        })
    });
    tiles.collect()
}

/// Sets of wang tiles as commonly published: no tile shows three classes, and only some pairs meet.
fn wang_sets() -> Vec<(&'static str, Drawable)> {
    let (hub, chain) = ([[0, 1], [0, 2], [0, 3]], [[0, 1], [1, 2], [2, 3]]);
    let all = |_| false;
    let is_saddle = |mask: u8| mask == NW | SE || mask == NE | SW;
    let set = |layout, ids: Vec<[u8; 8]>| Drawable::wang(layout, 4, ids);
    vec![
        ("corners, all with the first", set(Layout::Corner, of_pairs(Layout::Corner, &hub, all))),
        ("corners, a chain", set(Layout::Corner, of_pairs(Layout::Corner, &chain, all))),
        ("corners, a chain without saddles", set(Layout::Corner, of_pairs(Layout::Corner, &chain, is_saddle))),
        ("dual, a chain", set(Layout::Dual, of_pairs(Layout::Dual, &chain, all))),
        ("sides, a chain", set(Layout::Edge, of_pairs(Layout::Edge, &chain, all))),
        ("sides and corners, a chain", set(Layout::Blob, of_pairs(Layout::Blob, &chain, all))),
        ("sides and corners, all with the first", set(Layout::Blob, of_pairs(Layout::Blob, &hub, all))),
    ]
}

#[test]
fn wang_tiles_are_cleaned_too() {
    for (name, drawable) in wang_sets() {
        for (seed, grain) in [(1, 1), (2, 2), (3, 3), (4, 5), (5, 13)] {
            let mut map = random(seed, grain, 4, 120);
            clean(&mut map, &drawable, &Progress::none()).unwrap();
            assert_eq!(drawable.gaps(&map), [], "{name}, grain {grain}");
            assert!(map.counts().len() > 1, "{name}, grain {grain}: not all is one class");
        }
    }
}

#[test]
fn wang_tiles_join_and_parts_are_the_whole() {
    for (name, drawable) in wang_sets() {
        let whole = random(9, 4, 4, 340);
        let mut cleaned = whole.clone();
        clean(&mut cleaned, &drawable, &Progress::none()).unwrap();
        let (at, [width, height]) = ([HALO + 5, HALO + 9], [60, 41]);
        let start = [whole.x + at[0] as i64, whole.y + at[1] as i64];
        let halo = HALO as i64;
        let mut part = whole.part([start[0] - halo, start[1] - halo], width + 2 * HALO, height + 2 * HALO);
        clean(&mut part, &drawable, &Progress::none()).unwrap();
        assert_eq!(part.part(start, width, height), cleaned.part(start, width, height), "{name}");

        // Each tile and its neighbors show the same along their common sides, including the ends.
        let id = |x: i64, y: i64| drawable.wang_id(|x, y| cleaned.at(x, y), x, y);
        let [columns, rows] = drawable.tiles(&cleaned).map(|side| side as i64);
        for (x, y) in (0..rows - 1).flat_map(|y| (0..columns - 1).map(move |x| (x, y))) {
            let [own, east, south] = [id(x, y), id(x + 1, y), id(x, y + 1)];
            assert_eq!([own[1], own[2], own[3]], [east[7], east[6], east[5]], "{name}");
            assert_eq!([own[5], own[4], own[3]], [south[7], south[0], south[1]], "{name}");
        }
        let ids: Vec<([u8; 8], Variant)> = (0..rows)
            .flat_map(|y| (0..columns).map(move |x| (x, y)))
            .map(|(x, y)| (id(x, y), Variant { tile: 7, weight: 1.0 }))
            .collect();
        let drawn = layers(&cleaned, &drawable, &Tiles::Wang(WangTiles::new(&ids[..1])), 1);
        assert_eq!(drawn.len(), 1);
        for ((id, _), tile) in ids.iter().zip(&drawn[0]) {
            assert_eq!(*tile, if *id == ids[0].0 { 7 } else { NONE });
        }
    }
}
