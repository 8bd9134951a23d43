//! Water on mosaics of tiles that are made separately: depressions, beds of rivers, agreement of heights and drainage
//! areas, borders.

use crate::support::water::borders::{self, Places};
use crate::support::water::faults;
use crate::support::water::layers::{Tiles, Water, cells_to_edge, neighbors, tiles_in, tiles_of};
use crate::support::water::mosaic::Mosaic;
use crate::support::water::network::Network;
use crate::support::water::report::{Figure, measure, of_pairs, table};
use orogen::grid::hydrology::direction::NONE;
use orogen::grid::hydrology::steepest::Descent;
use orogen::grid::hydrology::{Outlets, accumulate, route_carving};
use orogen::{Grid, Options, Recipe, Session, Window, World, presets};

/// Rough land with lakes, with `cells` cells along each side; with `directions`, it has an output `receiver`.
fn small(cells: usize, directions: bool) -> Recipe {
    let length = cells as f64 * 60.0;
    let receiver = if directions { "receiver = \"rivers.receiver\"" } else { "" };
    let text = format!(
        r#"
orogen = 1
[world]
seed = 4
size = [{length}, {length}]
cell = 60.0
sea_level = 0.0
[nodes.noise]
op = "fbm"
wavelength = 16000.0
octaves = 7
gain = 0.45
[nodes.land]
op = "remap"
source = "noise"
from = [-0.5, 0.5]
to = [-200.0, 1200.0]
[nodes.terrain]
op = "lakes"
source = "land"
smallest = 14400.0
[nodes.rivers]
op = "drainage"
source = "terrain.surface"
over = "surface"
[outputs]
height = "terrain"
lakes = "terrain.depth"
flow = "rivers.flow"
{receiver}
"#
    );
    Recipe::parse(&text, "water.toml").unwrap()
}

/// The mosaic in the middle of [`small`]; the rest of the world surrounds it.
const MOSAIC: Mosaic = Mosaic { cell: 60.0, origin: [7, 11], side: 100 };

fn small_figures(tiles: Tiles) -> Vec<Figure> {
    let figures = measure(tiles, &MOSAIC).unwrap();
    println!("{}", table(&figures));
    figures
}

/// Names of the figures that miss their targets.
fn missed(figures: &[Figure]) -> Vec<String> {
    figures.iter().filter(|figure| !figure.holds()).map(|figure| figure.name.clone()).collect()
}

/// Tiles cut from a mosaic that is already made: faster, for tests of the measurements themselves.
fn crops(mosaic: &Water) -> impl Fn(&Window) -> orogen::Result<Water> + Sync {
    |window| {
        let mut tile = Water::like(mosaic, *window);
        tile.paste(mosaic);
        Ok(tile)
    }
}

#[test]
fn water_holds_on_a_small_mosaic() {
    let figures = small_figures(&tiles_of(&small(320, false), None));
    assert_eq!(missed(&figures), [""; 0]);
    assert!(figures.iter().all(|figure| figure.of > 0 || figure.name.contains("above 100 km²")), "{figures:?}");
}

#[test]
fn rivers_continue_in_adjacent_windows() {
    for directions in [false, true] {
        let recipe = small(128, directions);
        let places = Places { extent: full_window(&recipe), side: 56, pairs: 100, near: 1, seed: 1 };
        let tiles = tiles_of(&recipe, Some(1));
        let found = borders::measure_pairs([&tiles, &tiles], &places, 2).unwrap();
        println!("{}", table(&of_pairs(&found)));
        let found = found.borders;
        assert!(found.cut + found.falling + found.unbalanced == 0 && found.crossings > 30, "{found:?}");
    }
}

/// Checks that the receivers found from areas alone are those of the world.
fn compare_receivers(recipe: &Recipe) {
    let water = tiles_of(recipe, None)(&full_window(recipe)).unwrap();
    let window = water.window();
    let areas = Water { receiver: None, ..water.clone() };
    let from_areas = Network::new(&areas);
    let known = Network::new(&water);
    let (mut rivers, mut differ) = (0, 0);
    for cell in (0..window.len()).filter(|cell| water.area(*cell) > 1e6 && cells_to_edge(window, *cell) > 1) {
        if water.receiver.as_ref().unwrap().data()[cell] < f32::from(NONE) {
            rivers += 1;
            differ += usize::from(known.receiver(cell) != from_areas.receiver(cell));
        }
    }
    println!("{differ} of {rivers} receivers of rivers differ");
    assert!(rivers > 1000 && differ * 1000 <= rivers, "{differ} of {rivers} receivers of rivers differ");
}

#[test]
fn areas_determine_receivers() {
    compare_receivers(&small(320, true));
}

/// A cell of a river larger than `area` that is not near lakes, the sea or the edge of [`MOSAIC`], and the cell it
/// drains to.
fn river_cell(water: &Water, area: f64) -> [[i64; 2]; 2] {
    let window = *water.window();
    let network = Network::new(water);
    let at = |cell: usize| [window.x + (cell % window.width) as i64, window.y + (cell / window.width) as i64];
    let width = window.width;
    let dry = |cell: usize| !water.is_standing(cell);
    let inland = |cell: &usize| {
        let mut around = (0..17 * 17).map(|k| cell + k / 17 * width + k % 17 - 8 * width - 8);
        cells_to_edge(&window, *cell) > 8 && around.all(dry)
    };
    let mut rivers = (0..window.len()).filter(|cell| water.area(*cell) > area).filter(inland);
    let cell = rivers.next().expect("a river");
    [at(cell), at(network.receiver(cell).unwrap())]
}

/// Measures a mosaic in which some cells are changed, and returns the names of the figures that miss their targets.
fn missed_with(
    tiles: Tiles,
    chosen: impl Fn([i64; 2]) -> bool + Sync,
    change: impl Fn(&mut Water, usize) + Sync,
) -> Vec<String> {
    missed(&small_figures(&faults::changed(tiles, chosen, change)))
}

#[test]
fn faults_are_found() {
    let water = MOSAIC.make(&tiles_of(&small(320, false), None)).unwrap();
    let tiles = crops(&water);
    assert_eq!(missed(&small_figures(&tiles)), [""; 0]);
    let [river, next] = river_cell(&water, 6e6);
    let expect = |found: &[String], names: &[&str]| {
        assert!(names.iter().all(|name| found.iter().any(|other| other.starts_with(name))), "{found:?}");
    };

    let pit = missed_with(&tiles, |at| at == river, |water, cell| water.bed.data_mut()[cell] -= 40.0);
    expect(&pit, &["depressions, depth", "beds that rise, height"]);

    let across = |at: [i64; 2]| at[0].abs_diff(next[0]).max(at[1].abs_diff(next[1])) <= 4;
    let dam = missed_with(&tiles, across, |water, cell| water.bed.data_mut()[cell] += 100.0);
    expect(&dam, &["depressions, %", "depressions, depth", "beds that rise, %", "beds that rise, height"]);

    let border = MOSAIC.origin[0] + MOSAIC.side as i64;
    let step = missed_with(&tiles, |at| at[0] < border, |water, cell| water.bed.data_mut()[cell] += 20.0);
    expect(&step, &["depressions", "beds that rise, %"]);

    let cut = missed_with(
        &tiles,
        |at| at[0] >= border,
        |water, cell| {
            let area = &mut water.flow.data_mut()[cell];
            *area = area.min(2e5);
        },
    );
    expect(&cut, &["areas unbalanced at borders"]);

    // Areas that do not match the heights. Rivers do not change.
    let areas = missed_with(&tiles, |_| true, |water, cell| water.flow.data_mut()[cell] *= 1.5);
    expect(&areas, &["D8 agrees"]);
    assert!(areas.iter().all(|name| name.starts_with("D8 agrees")), "{areas:?}");

    let lake = lake_cell(&water);
    let level = missed_with(&tiles, |at| at == lake, |water, cell| water.lakes.data_mut()[cell] += 2.0);
    expect(&level, &["lakes, step"]);

    let full = missed_with(&tiles, |_| true, |water, cell| water.lakes.data_mut()[cell] *= 3.0);
    expect(&full, &["lakes, surface above the shore"]);
}

/// A cell in the middle of a lake.
fn lake_cell(water: &Water) -> [i64; 2] {
    let window = *water.window();
    let is_lake = |cell: usize| water.lakes.data()[cell] > 0.0;
    let amid = |cell: &usize| is_lake(*cell) && neighbors(&window, *cell).all(|(_, near)| is_lake(near));
    let cell = (0..window.len()).find(amid).expect("a lake");
    [window.x + (cell % window.width) as i64, window.y + (cell / window.width) as i64]
}

/// A single river is cut in a single tile, on either side of the border. With known receivers every cut is detected;
/// without them, a tributary or a parallel river along the border may explain the areas.
#[test]
fn one_cut_river_is_found() {
    for directions in [false, true] {
        let water = MOSAIC.make(&tiles_of(&small(320, directions), None)).unwrap();
        let network = Network::new(&water);
        let window = MOSAIC.window();
        let tile = |cell: usize| (cell % window.width / MOSAIC.side, cell / window.width / MOSAIC.side);
        let dry = |cell: usize| neighbors(&window, cell).all(|(_, near)| !water.is_standing(near));
        let (mut cut, mut seen) = (0, 0);
        for cell in (0..window.len()).filter(|cell| water.area(*cell) > 2e6 && cells_to_edge(&window, *cell) > 2) {
            let Some(to) = network.receiver(cell).filter(|to| tile(*to) != tile(cell) && dry(cell) && dry(*to)) else {
                continue;
            };
            let mut less = water.clone();
            less.flow.data_mut()[if cut % 2 == 0 { cell } else { to }] = 3600.0;
            cut += 1;
            let found = borders::measure(&Network::new(&less), &MOSAIC);
            seen += usize::from(found.cut + found.unbalanced > 0);
        }
        println!("{seen} of {cut} cut rivers are found");
        assert!(cut >= 10 && seen * 10 >= cut * if directions { 10 } else { 9 }, "{seen} of {cut}");
    }
}

/// The area within each tile only, as if no water came from outside: rivers are cut at nearly every border.
#[test]
fn drainage_of_single_tiles_is_cut() {
    let water = MOSAIC.make(&tiles_of(&small(320, false), None)).unwrap();
    let tiles = crops(&water);
    let alone = |window: &Window| {
        let mut water = tiles(window)?;
        let outlets = Outlets::new(&water.bed, Some(water.sea_level));
        let areas = accumulate(&route_carving(&water.bed, &outlets, Descent::Steepest).receivers).area;
        let data = areas.data().iter().map(|cells| *cells as f32 * 3600.0).collect();
        water.flow = Grid::from_data(*window, data).unwrap();
        Ok(water)
    };
    assert!(missed(&small_figures(&alone)).iter().any(|name| name == "rivers cut at borders of tiles"));
    let places = Places { extent: MOSAIC.window(), side: 64, pairs: 20, near: 1, seed: 1 };
    let found = borders::measure_pairs([&alone, &alone], &places, 2).unwrap().borders;
    assert!(found.cut + found.unbalanced > 10, "{found:?}");
}

/// Pairs of windows in which each window comes from a separate session, so no tile of a level and no solution is shared
/// across a border.
fn pairs(recipe: &Recipe, places: &Places) -> borders::Pairs {
    let sessions = [(); 2].map(|()| Session::new(Options { threads: Some(1), ..Options::default() }).unwrap());
    let tiles = sessions.each_ref().map(|session| tiles_in(recipe, session));
    let found = borders::measure_pairs([&tiles[0], &tiles[1]], places, threads()).unwrap();
    println!("{}, seed {}: {places:?}\n{}", recipe.about, recipe.world.seed, table(&of_pairs(&found)));
    assert_eq!(
        borders::count_different([&tiles[0], &tiles[1]], places, 16).unwrap(),
        0,
        "pairs differ from windows made at once"
    );
    found
}

fn threads() -> usize {
    std::thread::available_parallelism().map_or(1, usize::from)
}

/// Checks that no river of `endless` is cut between windows that are made separately, in a square of `width` cells
/// around the origin. Areas of levels are carried down with a small error, so some are not balanced, also inside
/// windows.
fn no_river_is_cut(width: usize, count: usize, near: usize) -> borders::Borders {
    let recipe = presets::find("endless").unwrap().recipe().unwrap();
    let half = width as i64 / 2;
    let extent = Window::new(width, width, recipe.world.cell).at(-half, -half);
    let borders::Pairs { borders, middles } = pairs(&recipe, &Places { extent, side: 64, pairs: count, near, seed: 1 });
    assert_eq!((borders.borders, borders.cut, middles.cut), (count, 0, 0));
    assert!(borders.unbalanced * 20 <= borders.crossings, "{borders:?}");
    borders
}

#[test]
fn rivers_of_levels_continue_in_adjacent_windows() {
    let found = no_river_is_cut(320, 20, 1);
    assert!(found.crossings > 15, "{found:?}");
}

#[test]
#[ignore = "long: 10 000 pairs of windows at random places of the preset endless"]
fn rivers_of_levels_continue_in_ten_thousand_adjacent_windows() {
    let found = no_river_is_cut(1 << 21, 10_000, 50);
    assert!(found.crossings > 3000, "{found:?}");
}

/// Measures a mosaic of tiles from separate worlds, and pairs of windows; prints the tables.
fn check(recipe: &Recipe, mosaic: &Mosaic, count: usize) {
    println!("{}: seed {}, {mosaic:?}", recipe.about, recipe.world.seed);
    let mut figures = measure(&tiles_of(recipe, None), mosaic).unwrap();
    let places = Places { extent: full_window(recipe), side: 64, pairs: count, near: 1, seed: 1 };
    figures.extend(of_pairs(&pairs(recipe, &places)));
    println!("{}", table(&figures));
    assert_eq!(missed(&figures), [""; 0]);
}

#[test]
#[ignore = "long: two presets whole, and 10 000 pairs of windows in each"]
fn water_holds_in_whole_presets() {
    for name in ["rolling", "alpine"] {
        let recipe = presets::find(name).unwrap().recipe().unwrap();
        let cell = recipe.world.cell;
        let side = (recipe.world.size.unwrap()[0] / cell) as usize / 3;
        check(&recipe, &Mosaic { cell, origin: [0, 0], side }, 10_000);
    }
}

fn full_window(recipe: &Recipe) -> Window {
    World::open(recipe.clone()).unwrap().full_window(recipe.world.cell).unwrap()
}
