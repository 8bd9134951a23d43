//! Water of worlds with their own network: the rivers of a window are the same in every other window.

use std::collections::HashMap;

use orogen::export::derived::list::prepare;
use orogen::export::features::list;
use orogen::export::features::options::FeatureOptions;
use orogen::export::features::source::FeatureSource;
use orogen::grid::hydrography::rivers::Source;
use orogen::grid::hydrography::{Mouth, River};
use orogen::grid::hydrology::direction::STEPS;
use orogen::io::format::features::{FeatureLayer, Geometry, Value};
use orogen::options::Options;
use orogen::{Budget, ErrorKind, Progress, Recipe, Window, World, presets};

fn world(preset: &str) -> World {
    World::open(presets::find(preset).unwrap().recipe().unwrap()).unwrap()
}

fn source(world: &World, window: &Window) -> FeatureSource {
    let none = Options::default();
    let options = FeatureOptions::new(&none, world.recipe()).unwrap();
    FeatureSource::of(world, window, &options, 0, &Progress::none()).unwrap()
}

fn layer(world: &World, source: &FeatureSource, name: &str) -> FeatureLayer {
    let none = Options::default();
    let options = FeatureOptions::new(&none, world.recipe()).unwrap();
    list::named(name).unwrap().of_ground(source, &options, &Progress::none()).unwrap().unwrap()
}

fn quarters(window: &Window) -> Vec<Window> {
    let (width, height) = (window.width / 2, window.height / 2);
    let part = |i: usize, j: usize| Window {
        x: window.x + (i * width) as i64,
        y: window.y + (j * height) as i64,
        width,
        height,
        ..*window
    };
    vec![part(0, 0), part(1, 0), part(0, 1), part(1, 1)]
}

/// Windows of `endless`: mountains at the finest cell, a coast with rivers at coarse cells, a cell between two levels
/// and one below the finest, and two shores of a large lake.
fn windows() -> Vec<Window> {
    vec![
        Window::new(300, 300, 60.0),
        Window::new(240, 240, 960.0).at(-40, -240),
        Window::new(200, 160, 7680.0).at(-120, -100),
        Window::new(200, 200, 1000.0).at(60, -60),
        Window::new(160, 160, 25.0).at(-80, 60),
        Window::new(240, 240, 240.0).at(-1416, -1432),
        Window::new(300, 300, 60.0).at(-5254, -5398),
    ]
}

fn line_of(source: &FeatureSource, river: &River) -> Vec<[f64; 3]> {
    let place = |[x, y, z]: &[f64; 3]| {
        let [east, south] = source.place([*x, *y]);
        [east, south, *z]
    };
    river.points.iter().map(place).collect()
}

fn length(line: &[[f64; 3]]) -> f64 {
    let square = |difference: f64| difference * difference;
    line.windows(2).map(|pair| (square(pair[1][0] - pair[0][0]) + square(pair[1][1] - pair[0][1])).sqrt()).sum()
}

#[test]
fn every_river_that_crosses_a_border_is_the_same_on_both_sides() {
    let world = world("endless");
    let mut crossings = 0;
    for window in windows() {
        let whole = source(&world, &window);
        let parts: Vec<FeatureSource> = quarters(&window).iter().map(|part| source(&world, part)).collect();
        // The lines between the quarters.
        let half = |first: i64, count: usize| (first as f64 + count as f64 / 2.0 - 0.5) * window.cell;
        let (x, y) = (half(window.x, window.width), half(window.y, window.height));
        // A side between two samples of another lattice is rounded to a millionth of its cell.
        let is_at = |a: f64, b: f64| (a - b).abs() < 2e-6 * window.cell;
        // For each point on these lines, whether reaches begin or end there.
        let mut ends: HashMap<[u64; 3], Vec<bool>> = HashMap::new();
        for part in &parts {
            for river in &part.rivers {
                let line = line_of(part, river);
                let at_ends = [(line[0], false), (line[line.len() - 1], true)];
                for (at, is_end) in at_ends.into_iter().filter(|(at, _)| is_at(at[0], x) || is_at(at[1], y)) {
                    let is_border = if is_end { river.mouth == Mouth::Border } else { river.source == Source::Border };
                    assert!(is_border, "{river:?}");
                    ends.entry(at.map(f64::to_bits)).or_default().push(is_end);
                }
            }
        }
        for (at, kinds) in &ends {
            let at = at.map(f64::from_bits);
            assert!(kinds.len() == 2 && kinds[0] != kinds[1], "{window:?}: {at:?} {kinds:?}");
        }
        crossings += ends.len();
        // The parts together are as long as the whole, and each of their points is a point of the whole or lies at a
        // side.
        let all =
            |source: &FeatureSource| -> f64 { source.rivers.iter().map(|river| length(&line_of(source, river))).sum() };
        let sum: f64 = parts.iter().map(all).sum();
        assert!((sum / all(&whole) - 1.0).abs() < 1e-9, "{window:?}: {sum} {}", all(&whole));
    }
    assert!(crossings > 60, "{crossings}");
}

#[test]
fn beds_never_rise_and_reaches_join() {
    for (preset, windows) in [
        ("endless", windows()),
        ("island", vec![Window::new(500, 500, 20.0).at(250, 250), Window::new(200, 200, 80.0)]),
        ("archipelago", vec![Window::new(600, 600, 40.0).at(200, 200), Window::new(250, 250, 160.0)]),
        (
            "continent",
            vec![
                Window::new(500, 500, 3840.0).at(250, 300),
                Window::new(512, 512, 7680.0),
                Window::new(200, 200, 60.0).at(30000, 30000),
            ],
        ),
    ] {
        let world = world(preset);
        let (mut shores, mut mouths) = (0, 0);
        for window in windows {
            let ground = source(&world, &window);
            let is_finest = ground.cell() <= world.recipe().world.cell;
            assert!(!ground.rivers.is_empty(), "{preset} {window:?}");
            for (k, river) in ground.rivers.iter().enumerate() {
                let told = || format!("{preset} {window:?}: {river:?}");
                assert!(
                    river.points.len() > 1 && river.points.windows(2).all(|pair| pair[1][2] <= pair[0][2]),
                    "{}",
                    told()
                );
                let last = river.points[river.points.len() - 1];
                match river.mouth {
                    Mouth::Reach(next) => {
                        let next = &ground.rivers[next as usize];
                        assert_eq!(next.points[0], last, "{}", told());
                        assert!(river.order == 0 || next.order == 0 || next.order >= river.order, "{}", told());
                        // Once part of a catchment is unknown, everything downstream is unknown too.
                        assert!(river.order > 0 || next.order == 0, "{}", told());
                    }
                    Mouth::Sea => {
                        // Coarser levels have inlets that the samples do not show.
                        let is_shore = ground.shores.coasts().any(|line| line.contains(&[last[0], last[1]]));
                        assert!(is_shore || !is_finest, "{}", told());
                        (shores, mouths) = (shores + usize::from(is_shore), mouths + 1);
                        assert_eq!(last[2], 0.0);
                    }
                    Mouth::Lake(lake) => {
                        let Some(id) = ground.lake_id(lake) else { continue };
                        let area = &ground.lakes[id as usize - 1];
                        let rings = || area.parts.iter().flatten();
                        assert!(rings().any(|ring| ring.contains(&[last[0], last[1]])), "{}", told());
                        assert_eq!(last[2], f64::from(ground.water.lakes[lake as usize - 1].level));
                    }
                    Mouth::Border => assert_eq!(river.downstream, None),
                }
                let (mut at, mut steps) = (k, 0);
                while let Some(next) = ground.rivers[at].downstream {
                    at = next as usize;
                    steps += 1;
                    assert!(steps <= ground.rivers.len());
                }
            }
        }
        assert!(mouths > 20 && shores * 20 >= mouths * 19, "{preset}: {shores} of {mouths}");
    }
}

#[test]
fn drained_areas_are_those_of_the_layer_and_include_the_land_outside() {
    let world = world("endless");
    for window in [Window::new(300, 300, 60.0), Window::new(200, 200, 960.0).at(-200, -200)] {
        let ground = source(&world, &window);
        let flow = world.window("land.node_flow", &window).unwrap();
        let receiver = world.window("land.node_receiver", &window).unwrap();
        let (width, mut found) = (ground.water.heights.width(), 0);
        for river in &ground.rivers {
            let at = [river.end as usize % width, river.end as usize / width];
            let [i, j] =
                [at[0] as i64 - ground.frame.columns.start as i64, at[1] as i64 - ground.frame.rows.start as i64];
            let (Ok(i), Ok(j)) = (usize::try_from(i), usize::try_from(j)) else { continue };
            if i >= window.width || j >= window.height {
                continue;
            }
            let expect = f64::from(flow[(i, j)]);
            let area = river.drained * window.cell * window.cell;
            assert!((area / expect - 1.0).abs() < 1e-12, "{area} {expect}");
            // A river continues through a small lake with an outlet.
            assert!((0.0..8.0).contains(&(receiver[(i, j)] % 16.0)));
            found += 1;
        }
        assert!(found * 20 > ground.rivers.len() * 19, "{found} of {}", ground.rivers.len());
        if window.cell == 60.0 {
            // At the finest level these layers equal the layers at the samples.
            let outputs = ["flow", "receiver"].map(|layer| world.window(layer, &window).unwrap());
            // In lakes with an outlet, 16 is added to the directions of nodes.
            let mut directions = receiver;
            for code in directions.data_mut() {
                *code -= if *code >= 16.0 { 16.0 } else { 0.0 };
            }
            assert!(outputs == [flow, directions]);
        }
    }
    // A small window at a large river: nearly all of its drainage area is outside.
    let map = source(&world, &Window::new(200, 160, 7680.0).at(-120, -100));
    let largest = map.rivers.iter().max_by(|a, b| a.drained.total_cmp(&b.drained)).unwrap();
    let [x, y, _] = largest.points[largest.points.len() / 2];
    let [east, south] = map.place([x, y]);
    let near = Window::new(300, 300, 120.0).at((east / 120.0) as i64 - 150, (south / 120.0) as i64 - 150);
    let ground = source(&world, &near);
    let most = ground.rivers.iter().map(|river| river.drained * 14_400.0).fold(0.0, f64::max);
    assert!(most > 100.0 * near.len() as f64 * 14_400.0, "{most}");
    // Therefore its order is unknown.
    let rivers = layer(&world, &ground, "rivers");
    let column = |name: &str| rivers.fields.iter().position(|field| field.name == name).unwrap();
    let orders = || rivers.features.iter().map(|river| &river.values[column("strahler")]);
    assert!(orders().any(|order| *order == Value::Null) && orders().any(|order| *order == Value::Integer(1)));
    for river in &rivers.features {
        let Value::Real(area) = river.values[column("drainage_area")] else { continue };
        assert!(area < most || river.values[column("strahler")] == Value::Null);
    }
}

/// Twice the area of rings; holes count as negative.
fn twice_area(geometry: &Geometry) -> f64 {
    let Geometry::MultiPolygon(parts) = geometry else { return 0.0 };
    let ring = |ring: &Vec<[f64; 2]>| -> f64 {
        let [x0, y0] = ring[0];
        ring.windows(2).map(|p| (p[0][1] - y0) * (p[1][0] - x0) - (p[0][0] - x0) * (p[1][1] - y0)).sum()
    };
    parts.iter().flatten().map(ring).sum()
}

#[test]
fn lakes_and_coasts_of_parts_are_those_of_the_whole() {
    let world = world("endless");
    let (mut lakes, mut coasts) = (0, 0.0);
    for window in windows() {
        let whole = source(&world, &window);
        let parts: Vec<FeatureSource> = quarters(&window).iter().map(|part| source(&world, part)).collect();
        let area = |source: &FeatureSource| -> f64 {
            layer(&world, source, "lakes").features.iter().map(|lake| twice_area(&lake.geometry)).sum()
        };
        let coast = |source: &FeatureSource| -> f64 {
            let to_line = |line: &Vec<[f64; 2]>| line.iter().map(|[x, y]| [*x, *y, 0.0]).collect::<Vec<_>>();
            source.shores.coasts().map(|line| length(&to_line(line)) * source.cell()).sum()
        };
        for measure in [&area as &dyn Fn(&FeatureSource) -> f64, &coast] {
            let (expect, sum) = (measure(&whole), parts.iter().map(measure).sum::<f64>());
            assert!((sum - expect).abs() <= 1e-9 * expect, "{window:?}: {sum} {expect}");
        }
        lakes += whole.lakes.len();
        coasts += coast(&whole);
        // Watersheds fill each window up to its sides, except for the sea.
        for part in parts.iter().chain([&whole]) {
            let found = layer(&world, part, "watersheds");
            let sum: f64 = found.features.iter().map(|area| twice_area(&area.geometry) / 2.0).sum();
            let all = part.requested.len() as f64 * part.requested.cell * part.requested.cell;
            if part.shores.coasts().next().is_none() {
                assert!((sum / all - 1.0).abs() < 1e-9, "{window:?}: {sum} {all}");
            } else {
                assert!(sum < all && sum > 0.0);
            }
        }
    }
    assert!(lakes > 2 && coasts > 1e6, "{lakes} {coasts}");
}

#[test]
fn recipes_without_both_outputs_find_rivers_in_their_heights() {
    let mut recipe = presets::find("endless").unwrap().recipe().unwrap();
    let text = recipe.to_toml().replace("receiver = \"land.receiver\"\n", "");
    let without = World::open(Recipe::parse(&text, "test").unwrap()).unwrap();
    let window = Window::new(120, 120, 60.0);
    let ground = source(&without, &window);
    assert!(ground.water.network.is_none() && ground.water.heights.window() == &window);
    assert!(source(&world("endless"), &window).water.network.is_some());
    // Layers of drainage need a solver there, which requires a bounded world.
    let mut plain = without.recipe().clone();
    let why = prepare(&mut plain, "drainage-area", &Options::default()).unwrap_err();
    assert!(why.to_string().contains("or the outputs `flow` and `receiver`"), "{why}");
    let why = prepare(&mut recipe, "strahler", &Options::default()).unwrap_err();
    assert!(why.to_string().contains("needs a bounded world"), "{why}");
}

#[test]
fn layers_of_drainage_follow_the_network() {
    for (preset, window) in [
        ("endless", Window::new(90, 70, 60.0).at(-9, 14)),
        ("endless", Window::new(90, 70, 1920.0).at(-40, -40)),
        ("island", Window::new(200, 200, 20.0).at(400, 400)),
    ] {
        let mut recipe = presets::find(preset).unwrap().recipe().unwrap();
        for layer in ["drainage-area", "flow-direction"] {
            prepare(&mut recipe, layer, &Options::default()).unwrap();
        }
        let world = World::open(recipe).unwrap();
        let layers = ["drainage-area", "flow-direction", "height"];
        let grids = world.grids(&layers, &window, &Progress::none()).unwrap();
        let mut wet = 0;
        for k in 0..window.len() {
            let code = grids[1].data()[k];
            wet += usize::from(code == 0.0);
            if grids[2].data()[k] <= 0.0 {
                assert_eq!(code, 0.0, "the sea has no direction");
            } else if code > 0.0 {
                assert!((code as u32).is_power_of_two() && code <= 128.0);
            }
            assert!(grids[0].data()[k] >= (window.cell * window.cell * 0.99) as f32);
        }
        assert!(wet * 2 < window.len(), "{preset} {window:?} {wet}");
        // Every path along the directions ends.
        for start in 0..window.len() {
            let (mut i, mut j, mut steps) = ((start % window.width) as isize, (start / window.width) as isize, 0);
            while (0..window.width as isize).contains(&i) && (0..window.height as isize).contains(&j) {
                let code = grids[1][(i as usize, j as usize)];
                if code == 0.0 {
                    break;
                }
                let (east, south) = STEPS[(code as u32).trailing_zeros() as usize];
                (i, j, steps) = (i + east, j + south, steps + 1);
                assert!(steps < window.len(), "{preset} {window:?}: a cycle");
            }
        }
    }
}

#[test]
fn it_can_be_cancelled_and_needs_its_memory() {
    let endless = world("endless");
    let none = Options::default();
    let options = FeatureOptions::new(&none, endless.recipe()).unwrap();
    let window = Window::new(200, 200, 60.0);
    let progress = Progress::none();
    progress.cancel();
    let why = FeatureSource::of(&endless, &window, &options, 0, &progress).err().unwrap();
    assert_eq!(why.kind(), ErrorKind::Cancelled);
    let recipe = presets::find("endless").unwrap().recipe().unwrap();
    let limited = orogen::Options { memory: Budget::of(256 << 20), ..Default::default() };
    let small = World::with_options(recipe, limited).unwrap();
    assert!(FeatureSource::of(&small, &window, &options, 0, &Progress::none()).is_ok());
    let why = FeatureSource::of(&small, &window, &options, 250 << 20, &Progress::none()).err().unwrap();
    assert_eq!(why.kind(), ErrorKind::Memory, "{why}");
    let far = Window::new(200, 200, 60.0).at(1 << 53, 0);
    assert!(FeatureSource::of(&endless, &far, &options, 0, &Progress::none()).is_err());
}

/// Distance in samples around the end of a river within which there must be sea, because a bay may be narrower than a
/// sample; minimum number of sea samples there; minimum number of samples of a lake.
const AROUND: usize = 6;
const SEA_SAMPLES: usize = 4;
const LAKE_SAMPLES: usize = 2;

/// The number of samples around the end of a river that are sea.
fn sea_around(source: &FeatureSource, sea_level: f32, end: [f64; 3]) -> usize {
    let heights = &source.water.heights;
    let near = |at: f64, count: usize| (at as usize).saturating_sub(AROUND)..(at as usize + AROUND + 1).min(count);
    let row = |j: usize| near(end[0], heights.width()).filter(|i| heights[(*i, j)] <= sea_level).count();
    near(end[1], heights.height()).map(row).sum()
}

#[test]
fn rivers_end_in_a_sea_or_a_lake_that_is_there() {
    // Cells at which the land has coasts, with seeds.
    let cases = [
        ("biomes", 6400.0, 10..=21),
        ("continent", 7680.0, 1..=2),
        ("endless", 7680.0, 1..=2),
        ("island", 80.0, 1..=3),
        ("archipelago", 160.0, 1..=3),
        ("tile-continent", 400.0, 1..=3),
    ];
    let mut wrong = Vec::new();
    for (preset, cell, seeds) in cases {
        let mut ends = 0;
        for seed in seeds {
            let mut recipe = presets::find(preset).unwrap().recipe().unwrap();
            recipe.world.seed = seed;
            let world = World::open(recipe).unwrap();
            let size = world.recipe().world.size.unwrap_or([2e6; 2]);
            let count = |side: f64| (side / cell) as usize;
            let source = source(&world, &Window::new(count(size[0]), count(size[1]), cell));
            let sea_level = world.recipe().world.sea_level as f32;
            for river in source.rivers.iter().filter(|river| river.drained >= 64.0) {
                let end = *river.points.last().unwrap();
                let (samples, least) = match river.mouth {
                    Mouth::Lake(lake) => {
                        (source.water.lakes.get(lake as usize - 1).map_or(0, |lake| lake.cells as usize), LAKE_SAMPLES)
                    }
                    Mouth::Sea => (sea_around(&source, sea_level, end), SEA_SAMPLES),
                    Mouth::Reach(_) | Mouth::Border => continue,
                };
                ends += 1;
                if samples < least {
                    let [east, south] = source.place([end[0], end[1]]);
                    let (mouth, drained) = (river.mouth, river.drained * cell * cell * 1e-6);
                    wrong.push(format!(
                        "{preset} {seed}: {drained:.0} km2 ends at {east:.0}, {south:.0}: {mouth:?} of {samples}"
                    ));
                }
            }
        }
        assert!(ends > 10, "{preset}: {ends} rivers end");
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}
