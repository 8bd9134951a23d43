//! Water on mosaics of tiles that are made apart: depressions, beds of rivers, agreement of heights and drainage areas, borders.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "a test that fails panics")]

#[path = "support/water/mod.rs"]
#[allow(dead_code, reason = "each test binary uses its part")]
mod water;

use orogen::hydrology::accumulation::accumulate;
use orogen::hydrology::direction::NONE;
use orogen::hydrology::drainage::route_carving;
use orogen::hydrology::outlets::Outlets;
use orogen::hydrology::steepest::Descent;
use orogen::{Grid, Options, Recipe, Session, Window, World, presets};
use water::layers::{Tiles, Water, cells_to_edge, neighbours, tiles_in, tiles_of};
use water::mosaic::Mosaic;
use water::network::Network;
use water::report::{Figure, measure, of_pairs, table};
use water::{borders, faults};

/// Rough land with lakes, `cells` cells along each side; `receiver` as an output if `directions`.
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

/// Tiles from one session: faster, for tests of the measurements themselves.
fn shared(recipe: &Recipe) -> impl Fn(&Window) -> orogen::Result<Water> + use<> {
    tiles_in(recipe, &Session::new(Options::default()).unwrap())
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
        let found = borders::measure_pairs(&tiles_of(&recipe, Some(1)), &full_window(&recipe), 56, 100, 1).unwrap();
        println!("{}", table(&[of_pairs(&found)]));
        assert!(found.cut == 0 && found.crossings > 30, "{found:?}");
    }
}

/// The receivers found from areas alone are those of the world.
fn compare_receivers(tiles: Tiles, window: &Window) {
    let water = tiles(window).unwrap();
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
    let recipe = small(320, true);
    compare_receivers(&shared(&recipe), &full_window(&recipe));
}

/// A cell of a river larger than `area`, in the first tile of [`MOSAIC`] and on high land, and the cell it drains to.
fn river_cell(water: &Water, area: f64) -> [[i64; 2]; 2] {
    let window = *water.window();
    let network = Network::new(water);
    let at = |cell: usize| [window.x + (cell % window.width) as i64, window.y + (cell / window.width) as i64];
    let inner = |cell: &usize| {
        let inside = |k: usize| (10..90).contains(&(at(*cell)[k] - MOSAIC.origin[k]));
        inside(0) && inside(1)
    };
    let dry = |cell: &usize| neighbours(&window, *cell).all(|(_, near)| !water.is_standing(near));
    let mut rivers = (0..window.len()).filter(|cell| water.area(*cell) > area).filter(inner).filter(dry);
    let cell = rivers.next().expect("a river");
    [at(cell), at(network.receiver(cell).unwrap())]
}

#[test]
fn faults_are_found() {
    let tiles = shared(&small(320, false));
    let water = MOSAIC.make(&tiles).unwrap();
    assert_eq!(missed(&small_figures(&tiles)), [""; 0]);
    let [river, next] = river_cell(&water, 6e6);

    let pit = faults::with_cell(&tiles, [river[0], river[1]], |water, cell| water.bed.data_mut()[cell] -= 40.0);
    let found = missed(&small_figures(&pit)).join(", ");
    assert!(found.contains("depressions, depth in m") && found.contains("beds that rise, height"), "{found}");

    let dam = faults::with_cell(&tiles, next, |water, cell| water.bed.data_mut()[cell] += 100.0);
    let found = missed(&small_figures(&dam)).join(", ");
    assert!(found.contains("beds that rise, % of links") && found.contains("beds that rise, height in m"), "{found}");

    let areas = faults::with_flow_behind(&tiles, i64::MIN, |area| area * 1.5);
    let found = missed(&small_figures(&areas));
    assert!(!found.is_empty() && found.iter().all(|name| name.starts_with("D8 agrees")), "{found:?}");

    let border = MOSAIC.origin[0] + MOSAIC.side as i64;
    let cut = faults::with_flow_behind(&tiles, border, |area| area.min(2e5));
    let found = missed(&small_figures(&cut)).join(", ");
    assert!(found.contains("rivers cut at borders"), "{found}");

    let level = faults::with_cell(&tiles, lake_cell(&water), |water, cell| water.lakes.data_mut()[cell] += 2.0);
    let figures = small_figures(&level);
    let step = figures.iter().find(|figure| figure.name.starts_with("lakes, step")).and_then(|figure| figure.value);
    assert!(step > Some(1.9), "{step:?}");
}

/// A cell amid a lake.
fn lake_cell(water: &Water) -> [i64; 2] {
    let window = *water.window();
    let is_lake = |cell: usize| water.lakes.data()[cell] > 0.0;
    let amid = |cell: &usize| is_lake(*cell) && neighbours(&window, *cell).all(|(_, near)| is_lake(near));
    let cell = (0..window.len()).find(amid).expect("a lake");
    [window.x + (cell % window.width) as i64, window.y + (cell / window.width) as i64]
}

/// A single river is cut in a single tile, on either side of the border. With known receivers every cut is found; without,
/// a tributary or a parallel river beside the border may explain the areas.
#[test]
fn one_cut_river_is_found() {
    for directions in [false, true] {
        let tiles = shared(&small(320, directions));
        let water = MOSAIC.make(&tiles).unwrap();
        let network = Network::new(&water);
        let window = MOSAIC.window();
        let at = |cell: usize| [window.x + (cell % window.width) as i64, window.y + (cell / window.width) as i64];
        let tile = |cell: usize| (cell % window.width / MOSAIC.side, cell / window.width / MOSAIC.side);
        let dry = |cell: usize| neighbours(&window, cell).all(|(_, near)| !water.is_standing(near));
        let (mut cut, mut seen) = (0, 0);
        for cell in (0..window.len()).filter(|cell| water.area(*cell) > 2e6 && cells_to_edge(&window, *cell) > 2) {
            let Some(to) = network.receiver(cell).filter(|to| tile(*to) != tile(cell) && dry(cell) && dry(*to)) else {
                continue;
            };
            for without in [cell, to] {
                let less = faults::with_cell(&tiles, at(without), |water, cell| water.flow.data_mut()[cell] = 3600.0);
                let water = MOSAIC.make(&less).unwrap();
                cut += 1;
                seen += usize::from(borders::measure(&Network::new(&water), &MOSAIC).cut > 0);
            }
        }
        println!("{seen} of {cut} cut rivers are found");
        assert!(cut >= 10 && seen * 10 >= cut * if directions { 10 } else { 9 }, "{seen} of {cut}");
    }
}

/// The area of every tile alone, as if no water came from outside: rivers are cut at nearly every border.
#[test]
fn drainage_of_single_tiles_is_cut() {
    let tiles = shared(&small(320, false));
    let alone = |window: &Window| {
        let mut water = tiles(window)?;
        let outlets = Outlets::new(&water.bed, Some(water.sea_level));
        let areas = accumulate(&route_carving(&water.bed, &outlets, Descent::Steepest).receivers).area;
        let data = areas.data().iter().map(|cells| *cells as f32 * 3600.0).collect();
        water.flow = Grid::from_data(*window, data).unwrap();
        Ok(water)
    };
    assert!(missed(&small_figures(&alone)).iter().any(|name| name == "rivers cut at borders"));
    let found = borders::measure_pairs(&alone, &full_window(&small(320, false)), 64, 20, 1).unwrap();
    assert!(found.cut > 10, "{found:?}");
}

/// Measures a mosaic of tiles from worlds of their own, and pairs of windows; prints the tables.
fn check(recipe: &Recipe, mosaic: &Mosaic, pairs: usize) {
    println!("{}: seed {}, {mosaic:?}", recipe.about, recipe.world.seed);
    let mut figures = measure(&tiles_of(recipe, None), mosaic).unwrap();
    // Pairs from one solution: a bounded world is the same from every window, see `laws`.
    figures.push(of_pairs(&borders::measure_pairs(&shared(recipe), &full_window(recipe), 64, pairs, 1).unwrap()));
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
