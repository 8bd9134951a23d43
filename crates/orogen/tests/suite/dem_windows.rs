//! Windows of large files of heights: they have the bits of the whole file, and read only the blocks that they need.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use orogen::field::{Dem, DemShows};
use orogen::filter::{Blur, Slope};
use orogen::io::dem::dem_file::DemFile;
use orogen::io::dem::{FileRef, PreparedDem};
use orogen::io::format::Request;
use orogen::io::format::geotiff::{Options as Layout, writer};
use orogen::io::spool::Spool;
use orogen::io::test_folder::TestFolder;
use orogen::node::Node;
use orogen::solver::Drainage;
use orogen::{Budget, ErrorKind, Grid, Options, Recipe, Window, World, WorldSpec};

use crate::dems::{bits, corpus};

/// A recipe with layers that read the windows of a file in different ways. The file is not at the origin.
fn recipe(path: &Path, band: Option<u32>, file: Option<Arc<DemFile>>) -> Recipe {
    let mut recipe = Recipe::new(WorldSpec::default().with_cell(30.0));
    let node = |shows| Dem {
        path: FileRef::from(path.to_string_lossy().as_ref()),
        band: band.unwrap_or(0),
        at: [45.0, -70.0],
        shows,
        ..Dem::default()
    };
    recipe.add("height", node(DemShows::Height)).add("inside", node(DemShows::Inside));
    recipe.add("soft", Blur { source: "height".into(), radius: 100.0 });
    recipe.add("slope", Slope { source: "height".into(), ..Slope::default() });
    for layer in ["height", "inside", "soft", "slope"] {
        recipe.output(layer, layer);
    }
    if let Some(file) = file {
        recipe.change(|node| {
            if let Node::Dem(dem) = node {
                dem.path.hold_file(Arc::clone(&file));
            }
        });
    }
    recipe
}

#[test]
fn windows_of_every_kind_of_file_have_the_bits_of_the_whole() {
    let mut seen = 0;
    for entry in std::fs::read_dir(corpus()).unwrap() {
        let path = entry.unwrap().path();
        let extension = path.extension().unwrap_or_default().to_string_lossy().into_owned();
        if !matches!(extension.as_str(), "tif" | "nc" | "grd") {
            continue;
        }
        // Files with several bands need one.
        let read =
            |band| PreparedDem::read(&path, None, Request::new(1 << 20).with_band(band)).map(|dem| dem.missing > 0);
        let found = [None, Some(2)].into_iter().find_map(|band| Some((band, read(band).ok()?)));
        let Some((band, holes)) = found else { continue };
        // Almost no memory, so that the file is not read whole.
        let Ok(Some(file)) = DemFile::open(&path, band, 1) else { continue };
        seen += 1;
        let name = path.display();
        let whole = World::open(recipe(&path, band, None)).unwrap();
        assert!(whole.recipe().held() > 0, "{name}");
        let part = World::open(recipe(&path, band, Some(Arc::new(file)))).unwrap();
        assert_eq!(part.recipe().georeference(), whole.recipe().georeference(), "{name}");
        // Inside, across the edges, beyond them, far away, and at other cells.
        for window in [
            Window::new(5, 4, 30.0).at(7, 6),
            Window::new(9, 9, 30.0).at(-4, -5),
            Window::new(12, 9, 30.0).at(33, 15),
            Window::new(3, 3, 30.0).at(4000, -4000),
            Window::new(60, 50, 30.0).at(-10, -10),
            Window::new(17, 11, 11.0).at(20, 30),
            Window::new(6, 6, 200.0).at(-1, -1),
        ] {
            for layer in ["height", "inside", "soft", "slope"] {
                let [own, expect] = [&part, &whole].map(|world| world.window(layer, &window).unwrap());
                assert_eq!(bits(own.data()), bits(expect.data()), "{name}: {layer} {window:?}");
            }
            // The holes of such small files are filled from all of their heights.
            let is_read = holes && part.recipe().held() == whole.recipe().held();
            assert!(part.recipe().held() == 0 || is_read, "{name}: only windows were read");
        }
        // Points may be anywhere, so all heights are read once and kept.
        let at = |world: &World| world.points("height", &[100.0, -500.0, 731.5], &[-70.0, 90.0, 333.3]).unwrap();
        assert_eq!(bits(&at(&part)), bits(&at(&whole)), "{name}");
        assert_eq!(part.recipe().held(), whole.recipe().held(), "{name}");
    }
    assert!(seen > 40, "{seen}");
}

/// A file of 2400 x 2000 samples, 18 MiB, in tiles of 256 x 256. Sample (70, 80) is a hole.
fn large(folder: &TestFolder) -> (PathBuf, Grid) {
    let window = Window::new(2400, 2000, 30.0);
    let height = |k: usize| ((k % 2400) as f32 * 0.25).fract() + (k / 2400) as f32 + ((k * 7919) % 64) as f32;
    let mut grid = Grid::from_data(window, (0..window.len()).map(height).collect()).unwrap();
    grid[(70, 80)] = f32::NAN;
    let path = folder.join("large.tif");
    let mut bytes = Vec::new();
    writer::write(&mut bytes, &grid, &Layout::of_unit("m").with_tile(Some(256)), Spool::in_memory()).unwrap();
    std::fs::write(&path, bytes).unwrap();
    (path, grid)
}

/// Offset and length of each tile of the full raster of a classic little-endian TIFF.
fn tiles(bytes: &[u8]) -> Vec<[usize; 2]> {
    let number = |at: usize, size: usize| {
        bytes[at..at + size].iter().rev().fold(0, |number, byte| number << 8 | usize::from(*byte))
    };
    let directory = number(4, 4);
    let values = |tag: usize| {
        let entries = (0..number(directory, 2)).map(|k| directory + 2 + 12 * k);
        let entry = entries.clone().find(|entry| number(*entry, 2) == tag).unwrap();
        let at = number(entry + 8, 4);
        (0..number(entry + 4, 4)).map(move |k| number(at + 4 * k, 4)).collect::<Vec<usize>>()
    };
    values(324).into_iter().zip(values(325)).map(|(at, length)| [at, length]).collect()
}

fn limited(recipe: Recipe, memory: u64) -> orogen::Result<World> {
    World::with_options(recipe, Options { memory: Budget::of(memory), threads: Some(1), ..Options::default() })
}

#[test]
fn a_window_reads_only_its_blocks_within_a_small_memory_limit() {
    let folder = TestFolder::new("dem-windows").unwrap();
    let (path, grid) = large(&folder);
    let mut bytes = std::fs::read(&path).unwrap();
    // All blocks are damaged but the two under the window and its halo.
    let all = tiles(&bytes);
    assert_eq!(all.len(), 10 * 8);
    let needed = [3 * 10 + 4, 3 * 10 + 5];
    for (_, [at, length]) in all.iter().enumerate().filter(|(k, _)| !needed.contains(k)) {
        bytes[*at..at + length].fill(0xff);
    }
    std::fs::write(&path, bytes).unwrap();
    let text = "orogen = 1\n[nodes.place]\nop = \"dem\"\npath = \"large.tif\"\n[nodes.slope]\nop = \"slope\"\nsource = \"place\"\n\
                [world]\ncell = 30.0\n[outputs]\nheight = \"place\"\nslope = \"slope\"\n";
    std::fs::write(folder.join("land.toml"), text).unwrap();
    let world = limited(Recipe::read(&folder.join("land.toml")).unwrap(), 6 << 20).unwrap();
    let window = Window::new(200, 200, 30.0).at(1180, 800);
    let plan = world.plan(&["height", "slope"], &window).unwrap();
    assert!((200 * 200 * 4..4 << 20).contains(&world.memory_of(&plan).unwrap()));
    let own = world.window("height", &window).unwrap();
    assert_eq!(bits(own.data()), bits(grid.crop(&window).unwrap().data()));
    assert!(world.window("slope", &window).unwrap().data().iter().all(|slope| slope.is_finite()));
    assert_eq!(world.recipe().held(), 0);
    // A damaged block within the window is an error that names the file.
    let error = world.window("height", &window.at(1000, 800)).unwrap_err();
    assert_eq!(error.kind(), ErrorKind::File, "{error}");
    assert!(error.to_string().starts_with("cannot read ") && error.to_string().contains("large.tif"), "{error}");
    // All heights do not fit: nothing is read.
    let error = world.window("height", &Window::new(2400, 2000, 30.0)).unwrap_err();
    assert_eq!(error.kind(), ErrorKind::Memory, "{error}");
    let world = orogen::open(&path).unwrap();
    assert_eq!(world.recipe().held(), 0);
    assert_eq!(bits(world.window("height", &window).unwrap().data()), bits(own.data()));
    // A file that was changed does not fit to the windows that were read before.
    std::fs::write(&path, b"II*").unwrap();
    let why = world.window("height", &window).unwrap_err().to_string();
    assert!(why.contains("it was changed since it was opened"), "{why}");
}

#[test]
fn nodes_that_read_the_whole_world_read_the_whole_file() {
    let folder = TestFolder::new("dem-windows-whole").unwrap();
    let (path, grid) = large(&folder);
    let place = orogen::open(&path).unwrap();
    let mut recipe = place.recipe().clone();
    recipe.add("rivers", Drainage { source: "place".into(), cell: 480.0, ..Drainage::default() });
    recipe.output("flow", "rivers.flow");
    let world = World::open(recipe).unwrap();
    assert_eq!(world.recipe().held(), 4 * grid.data().len() as u64);
    let ground = Arc::new(PreparedDem::read(&path, None, 64 << 20).unwrap());
    let mut whole = Recipe::from_dem(&path, &ground);
    whole.add("rivers", Drainage { source: "place".into(), cell: 480.0, ..Drainage::default() });
    whole.output("flow", "rivers.flow");
    let whole = World::open(whole).unwrap();
    // Stored solutions are found by the content of the file.
    assert_eq!(world.key("flow").unwrap(), whole.key("flow").unwrap());
    assert_ne!(place.key("height").unwrap(), whole.key("height").unwrap());
    let checked = place.recipe().with_whole_files(64 << 20).unwrap().unwrap();
    assert_eq!(World::open(checked).unwrap().key("height").unwrap(), whole.key("height").unwrap());
    // Requests at the same time hold their own windows, one of them around the hole.
    let place = orogen::open(&path).unwrap();
    std::thread::scope(|scope| {
        for x in [0, 300, 900, 2000] {
            let (place, grid) = (&place, &ground.grid);
            scope.spawn(move || {
                for y in [0, 700, 1500] {
                    let window = Window::new(150, 90, 30.0).at(x, y);
                    let own = place.window("height", &window).unwrap();
                    assert_eq!(bits(own.data()), bits(grid.crop(&window).unwrap().data()));
                }
            });
        }
    });
    assert_eq!(place.recipe().held(), 0);
}
