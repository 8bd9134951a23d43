//! Properties of the built-in tilesets and of the files of a map.

use orogen_engine::{Recipe, World};
use orogen_grid::autotile::classes::Classes;
use orogen_grid::autotile::mask::{CORNERS, Layout, OFFSETS, SIMPLE_BLOB};
use orogen_grid::grid::Window;
use orogen_grid::progress::Progress;
use orogen_grid::random::Random;
use orogen_io::test_folder::TestFolder;

use super::art::set::SETS;
use super::job::{AtOnce, TilemapJob};
use super::map::Tilemap;
use super::tileset::{Fit, Tileset};

/// Whether a pixel of the tile for a class and a mask is opaque.
fn covers(tileset: &Tileset, class: u8, mask: u8, [x, y]: [usize; 2]) -> bool {
    if mask == 0 && tileset.layout.is_on_corners() {
        return false;
    }
    let tile = tileset.tiles.iter().position(|tile| tile.fit == Fit::Layer { class, mask }).unwrap();
    tileset.row(tile, y)[x][3] > 0
}

/// A border has the same shape whether it is drawn by tiles of cells or by tiles on corners, so tiles join: every pixel
/// next to a side of a tile in one of the two layouts is in the middle of a tile in the other.
#[test]
fn borders_are_the_same_in_all_layouts() {
    for set in SETS {
        let [blob, dual] = [Layout::Blob, Layout::Dual].map(|layout| set.draw(layout));
        let size = set.size;
        let mut random = Random::new(5, size as u64);
        let classes = Classes::new([0, 0], 12, 12, (0..144).map(|_| random.below(3) as u8).collect());
        for class in 1..3 {
            for y in size..11 * size {
                for x in size..11 * size {
                    let (column, row) = ((x / size) as i64, (y / size) as i64);
                    let bits = OFFSETS
                        .iter()
                        .enumerate()
                        .map(|(bit, [dx, dy])| u8::from(classes.at(column + dx, row + dy) >= class) << bit);
                    let mask = Layout::Blob.reduced(bits.sum());
                    let of_cells = classes.at(column, row) >= class && covers(&blob, class, mask, [x % size, y % size]);
                    // The tile on corners that shows this pixel starts in the middle of a cell.
                    let (from_x, from_y) = (x - size / 2, y - size / 2);
                    let (column, row) = ((from_x / size) as i64, (from_y / size) as i64);
                    let corners = [[0, 0, 128], [1, 0, 2], [0, 1, 32], [1, 1, 8]];
                    let bits = corners.iter().map(|[dx, dy, bit]| match classes.at(column + dx, row + dy) >= class {
                        true => *bit as u8,
                        false => 0,
                    });
                    let mask: u8 = bits.sum::<u8>() & CORNERS;
                    let on_corners = covers(&dual, class, mask, [from_x % size, from_y % size]);
                    assert_eq!(of_cells, on_corners, "{} class {class}, pixel {x}, {y}", set.name);
                }
            }
        }
    }
}

#[test]
fn the_tilesets_have_a_tile_for_everything() {
    for set in SETS {
        for layout in Layout::ALL {
            let tileset = set.draw(layout);
            assert!(tileset.drawable().is_complete(), "{}, {}", set.name, layout.name());
            assert_eq!(tileset.pixels.len(), tileset.width() * tileset.height());
            assert!(tileset.pixels.iter().all(|pixel| [0, 255].contains(&pixel[3])), "crisp");
            for (n, tile) in tileset.tiles.iter().enumerate() {
                let Fit::Layer { class, mask } = tile.fit else { panic!("a tile of a layer") };
                let mut rows = (0..set.size).flat_map(|y| tileset.row(n, y));
                assert!(
                    mask != layout.full() || rows.all(|pixel| pixel[3] == 255),
                    "a full tile of {class} covers its cell"
                );
            }
        }
    }
}

const RECIPE: &str = r#"
        orogen = 1
        world = { seed = 3, cell = 10 }
        outputs = { class = "class" }
        nodes.land = { op = "fbm", wavelength = 120, octaves = 4 }
        nodes.class = { op = "expr", expr = "min(5, max(0, floor(land * 8 + 3)))" }
    "#;

fn map(layout: Layout, window: &Window) -> Tilemap {
    let job = TilemapJob::new(SETS[0].draw(layout));
    let mut recipe = Recipe::parse(RECIPE, "test").unwrap();
    job.prepare(&mut recipe, window.cell).unwrap();
    job.make(&World::open(recipe).unwrap(), window, &Progress::none()).unwrap()
}

#[test]
fn parts_of_an_unbounded_map_join() {
    for layout in Layout::ALL {
        let whole = map(layout, &Window::new(50, 40, 10.0).at(-30, 1000));
        let part = map(layout, &Window::new(21, 9, 10.0).at(-12, 1007));
        for (whole_layer, layer) in whole.layers.iter().zip(&part.layers) {
            let [whole_layer, layer] = [whole_layer, layer].map(|layer| layer.tiles.in_memory().unwrap());
            for (y, row) in layer.chunks(part.width).enumerate() {
                assert_eq!(row, &whole_layer[(y + 7) * whole.width + 18..][..part.width], "{}", layout.name());
            }
        }
        assert_eq!((whole.gaps_before, whole.gap_count, whole.changed), (0, 0, 0));
    }
}

/// An engine reads the same map from the files as the library has in memory.
#[test]
fn the_files_hold_the_map() {
    let map = map(Layout::Blob, &Window::new(7, 5, 10.0));
    let mut json = Vec::new();
    map.write_tmj(&mut json, "tiles.png", "test").unwrap();
    let json: serde_json::Value = serde_json::from_slice(&json).unwrap();
    let named = |name: &str| map.tileset.terrains.iter().position(|terrain| terrain.name == name).unwrap();
    for layer in json["layers"].as_array().unwrap() {
        let tiles = &map.layers[named(layer["name"].as_str().unwrap())];
        let data: Vec<u32> =
            layer["data"].as_array().unwrap().iter().map(|tile| tile.as_u64().unwrap() as u32).collect();
        assert_eq!(data, tiles.tiles.to_vec().unwrap());
    }
    let mut text = Vec::new();
    map.write_tmx(&mut text, "a \"b\" & <c>.tsx", "test -- 1").unwrap();
    let text = String::from_utf8(text).unwrap();
    assert!(
        text.contains("source=\"a &quot;b&quot; &amp; &lt;c&gt;.tsx\"") && text.contains("<!-- made by test - - 1 -->")
    );
}

/// Scattered objects, and terrains that are only in places wide enough for the simplest tiles.
const ROUGH: &str = r#"
    orogen = 1
    world = { seed = 7, size = [1500, 2500], cell = 10 }
    outputs = { height = "land", class = "class" }
    nodes.land = { op = "fbm", wavelength = 90, octaves = 5 }
    nodes.class = { op = "expr", expr = "min(5, max(0, floor(land * 8 + 3)))" }
    scatter = [{ name = "tree", spacing = 40 }, { name = "rock", spacing = 60 }]
"#;

/// The tileset with 13 tiles per class.
fn simple() -> Tileset {
    let mut tileset = SETS[0].draw(Layout::Blob);
    tileset.tiles.retain(|tile| match tile.fit {
        Fit::Layer { mask, .. } => SIMPLE_BLOB.contains(&mask),
        Fit::Wang(_) => false,
    });
    tileset
}

/// All files of a map.
fn files(map: &Tilemap) -> Vec<Vec<u8>> {
    let mut files = vec![serde_json::to_vec(&map.summary("test")).unwrap()];
    let mut file = |write: &dyn Fn(&mut Vec<u8>) -> std::io::Result<()>| {
        let mut bytes = Vec::new();
        write(&mut bytes).unwrap();
        files.push(bytes);
    };
    file(&|out| map.write_tmx(out, "tiles.tsx", "test"));
    file(&|out| map.write_tmj(out, "tiles.png", "test"));
    file(&|out| map.write_tscn(out, "tiles.tres", "test"));
    file(&|out| map.write_csv(out));
    file(&|out| map.write_png(out, &[]));
    if map.fits_ldtk() {
        file(&|out| map.write_ldtk(out, "tiles.png", "test"));
    }
    files
}

/// All files of a map are bit-identical, wherever its tiles are stored and however many pieces they were drawn in.
#[test]
fn a_streamed_map_is_the_map_in_memory() {
    let folder = TestFolder::new("tilemap-streamed").unwrap();
    let path = folder.join("map.tmx");
    let unbounded = Window::new(200, 260, 10.0).at(-300, 5);
    let bounded = Window::new(151, 251, 10.0);
    let cases = [
        (RECIPE, SETS[0].draw(Layout::Blob), unbounded),
        (RECIPE, simple(), unbounded),
        (ROUGH, simple(), bounded),
        (ROUGH, SETS[0].draw(Layout::Dual), bounded),
        (ROUGH, SETS[1].draw(Layout::Corner), bounded),
        // A picture with one pixel for several tiles, and packed layers.
        (RECIPE, SETS[0].draw(Layout::Edge), Window { width: 8500, height: 130, ..unbounded }),
    ];
    for (recipe, tileset, window) in cases {
        let (name, layout) = (tileset.name.clone(), tileset.layout.name());
        let mut recipe = Recipe::parse(recipe, "test").unwrap();
        let mut job = TilemapJob::new(tileset).with_infinite(layout == "corner");
        job.prepare(&mut recipe, window.cell).unwrap();
        let world = World::open(recipe).unwrap();
        let whole = job.make(&world, &window, &Progress::none()).unwrap();
        job.at_once = AtOnce { cleaned: 0, cleaned_rows: 100, drawn: 10_000 };
        let streamed = job.stream(&world, &window, &path, &Progress::none()).unwrap();
        assert!(streamed.layers.iter().all(|layer| layer.tiles.in_memory().is_none()));
        for (nth, (streamed, whole)) in files(&streamed).iter().zip(files(&whole)).enumerate() {
            assert!(*streamed == whole, "{name} {layout}: file {nth}");
        }
        let cells: u64 = whole.class_counts.iter().sum();
        assert_eq!(cells, whole.classes.len());
        // A part that is cleaned separately.
        let part = Window::new(60, 30, 10.0).at(window.x + 80, window.y + 95);
        let part = job.make(&world, &part, &Progress::none()).unwrap();
        for (whole_layer, layer) in whole.layers.iter().zip(&part.layers) {
            let [whole_layer, layer] = [whole_layer, layer].map(|layer| layer.tiles.in_memory().unwrap());
            for (y, row) in layer.chunks(part.width).enumerate() {
                assert_eq!(row, &whole_layer[(y + 95) * whole.width + 80..][..part.width], "{name} {layout}");
            }
        }
    }
}
