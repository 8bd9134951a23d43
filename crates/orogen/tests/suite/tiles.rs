//! Large windows as streams of tiles.

use crate::support::{open, recipe_of, world_of};
use orogen::node::Node;
use orogen::tiles::{Tile, Tiling};
use orogen::{Budget, ErrorKind, Options, Progress, Recipe, Window, World};
use std::collections::HashSet;

fn recipe(op: &str) -> Recipe {
    recipe_of(&Node::named(op).unwrap(), world_of(10.0), false)
}

fn limited(recipe: &Recipe, memory: u64) -> World {
    World::with_options(recipe.clone(), Options { threads: Some(2), memory: Budget::of(memory), ..Options::default() })
        .unwrap()
}

#[test]
fn tiles_are_the_crops_of_the_window_in_order() {
    for op in ["blur", "slope", "bake", "normalise", "fbm"] {
        let recipe = recipe(op);
        let world = open(&recipe, 2);
        let window = Window::new(90, 71, 10.0).at(3, 5);
        let layers: Vec<&str> = recipe.outputs().collect();
        let wholes = world.grids(&layers, &window, &Progress::none()).unwrap();
        for (side, overlap) in [(1, 0), (7, 1), (32, 0), (32, 1), (45, 3), (500, 1)] {
            let tiling = Tiling { overlap, ..Tiling::of(side) };
            let none = Progress::none();
            // From all tiles at once to tile by tile.
            for memory in [u64::MAX, 3 << 20, 1_200_000] {
                let tiling = Tiling { memory: Some(memory), ..tiling };
                let world = limited(&recipe, u64::MAX);
                let Ok(tiles) = world.tiles(&layers, &window, tiling, &none) else {
                    assert!(memory != u64::MAX, "{op}, {side}");
                    continue;
                };
                let [columns, rows] = tiles.layout();
                let tiles: Vec<Tile> = tiles.map(|tile| tile.unwrap()).collect();
                let places: Vec<(usize, usize)> = tiles.iter().map(|tile| (tile.row, tile.column)).collect();
                let expect: Vec<(usize, usize)> =
                    (0..rows).flat_map(|row| (0..columns).map(move |c| (row, c))).collect();
                assert_eq!(places, expect);
                let mut covered = HashSet::new();
                for tile in &tiles {
                    assert_eq!(tile.grids.len(), layers.len());
                    for (grid, whole) in tile.grids.iter().zip(&wholes) {
                        assert_eq!(whole.crop(grid.window()).as_ref(), Some(grid), "{op} in tiles of {side}");
                    }
                    let part = tile.grids[0].window();
                    covered.extend((part.y..part.bottom()).flat_map(|y| (part.x..part.right()).map(move |x| (x, y))));
                    let full = |at: usize, count: usize| at + 1 < count;
                    assert!(!full(tile.column, columns) || part.width == side + overlap, "{part:?}");
                    assert!(!full(tile.row, rows) || part.height == side + overlap, "{part:?}");
                }
                assert_eq!(covered.len(), window.len());
            }
        }
    }
}

#[test]
fn what_is_there_already_is_not_made_again() {
    let recipe = recipe("blur");
    let world = open(&recipe, 1);
    let window = Window::new(90, 70, 10.0);
    let none = Progress::none();
    let tiles = world.tiles(&["height"], &window, Tiling::of(10), &none).unwrap();
    let tiles = tiles.only(|column, row| column == 8 && row > 3);
    let places: Vec<(usize, usize)> = tiles.map(|tile| tile.unwrap()).map(|tile| (tile.column, tile.row)).collect();
    assert_eq!(places, [(8, 4), (8, 5), (8, 6)]);
    assert!(world.tiles(&["height"], &window, Tiling::of(10), &none).unwrap().only(|_, _| false).next().is_none());
}

#[test]
fn strips_grow_and_shrink_with_the_memory() {
    let recipe = recipe("blur");
    let world = limited(&recipe, u64::MAX);
    let window = Window::new(96, 80, 10.0);
    let at_once = |memory| {
        let tiling = Tiling { memory: Some(memory), ..Tiling::of(16) };
        world.tiles(&["height"], &window, tiling, &Progress::none()).map(|tiles| tiles.at_once())
    };
    assert_eq!(at_once(u64::MAX).unwrap(), [6, 5]);
    let mut last = 30;
    for memory in (1..4000).rev().map(|kib| kib << 10) {
        match at_once(memory) {
            Ok([wide, tall]) => {
                assert!(wide * tall <= last && (tall == 1 || wide == 6), "{wide} x {tall} after {last}");
                last = wide * tall;
            }
            Err(error) => {
                assert_eq!(last, 1, "the smallest strip is one tile");
                assert_eq!(error.kind(), ErrorKind::Memory);
                assert!(error.to_string().contains("a tile of 16 x 16 samples needs up to"), "{error}");
                return;
            }
        }
    }
    panic!("no limit was too small");
}

#[test]
fn a_stream_ends_after_what_went_wrong() {
    let recipe = recipe("blur");
    let world = limited(&recipe, u64::MAX);
    let progress = Progress::none();
    let tiling = Tiling { memory: Some(2 << 20), ..Tiling::of(16) };
    let mut tiles = world.tiles(&["height"], &Window::new(96, 80, 10.0), tiling, &progress).unwrap();
    progress.cancel();
    let errors: Vec<ErrorKind> = tiles.by_ref().filter_map(|tile| tile.err().map(|error| error.kind())).collect();
    assert_eq!(errors, [ErrorKind::Cancelled]);
    for (layers, window, tiling, said) in [
        (["height"], Window::new(9, 9, 10.0), Tiling::of(0), "size must be at least 1"),
        (["height"], Window::new(9, 9, 10.0), Tiling { overlap: 5, ..Tiling::of(4) }, "cannot overlap"),
        (["hight"], Window::new(9, 9, 10.0), Tiling::of(4), "did you mean `height`"),
        (["height"], Window::new(999, 9, 10.0), Tiling::of(4), "not inside the world"),
    ] {
        let error = world.tiles(&layers, &window, tiling, &Progress::none()).err().unwrap();
        assert!(error.to_string().contains(said), "{error}");
    }
}
