//! Water as vector features: rivers agree with the recipe's own drainage, for presets and seeds.

use orogen::export::contour_options::SMOOTH;
use orogen::export::derived::list as derived;
use orogen::export::features::list;
use orogen::export::features::options::FeatureOptions;
use orogen::export::features::outlets::{OUTLET, SNAP};
use orogen::export::features::source::FeatureSource;
use orogen::grid::contour::line::twice_area;
use orogen::grid::hydrography::Mouth;
use orogen::grid::hydrology::direction::STEPS;
use orogen::io::format::features::{Geometry, Value};
use orogen::options::Options;
use orogen::{Grid, Progress, Recipe, Window, World, presets};
use std::cmp::Reverse;
use std::collections::BinaryHeap;

fn preset(name: &str, seed: u64, cell: f64) -> World {
    let mut recipe = presets::find(name).unwrap().recipe().unwrap();
    recipe.world.seed = seed;
    recipe.world.cell = cell;
    World::open(recipe).unwrap()
}

fn ground(world: &World, window: &Window) -> FeatureSource {
    let none = Options::default();
    let options = FeatureOptions::new(&none, world.recipe()).unwrap();
    FeatureSource::of(world, window, &options, 0, &Progress::none()).unwrap()
}

#[test]
fn beds_never_rise_and_every_reach_ends_somewhere() {
    let mut count = 0;
    for (name, cell) in [("island", 20.0), ("archipelago", 40.0), ("hills", 60.0), ("mesa", 80.0)] {
        for seed in [1, 2, 3] {
            let world = preset(name, seed, cell);
            let ground = ground(&world, &world.full_window(cell).unwrap());
            count += ground.rivers.len();
            for river in &ground.rivers {
                assert!(river.points.windows(2).all(|pair| pair[1][2] <= pair[0][2]), "{name} {seed}: {river:?}");
                let last = river.points[river.points.len() - 1];
                match river.mouth {
                    Mouth::Reach(next) => assert_eq!(ground.rivers[next as usize].points[0], last),
                    Mouth::Lake(lake) => {
                        assert_eq!(last[2], f64::from(ground.water.lakes[lake as usize - 1].level));
                        let area = &ground.lakes[ground.lake_id(lake).unwrap() as usize - 1];
                        assert!(
                            area.parts.iter().flatten().any(|ring| ring.contains(&[last[0], last[1]])),
                            "{name} {seed}"
                        );
                    }
                    Mouth::Sea => assert!(ground.shores.coasts().any(|line| line.contains(&[last[0], last[1]]))),
                    Mouth::Border => assert_eq!(river.downstream, None),
                }
                if let Some(next) = river.downstream {
                    assert!(ground.rivers[next as usize].points[0][2] <= last[2]);
                }
            }
        }
    }
    assert!(count > 100, "{count}");
}

#[test]
fn rivers_are_those_of_the_recipes_own_drainage() {
    let text = "orogen = 1\n[world]\nseed = 4\nsize = [6000, 5000]\ncell = 50\n[nodes.hills]\nop = \"fbm\"\nwavelength = 2500\n[nodes.land]\n\
                op = \"remap\"\nsource = \"hills\"\nfrom = [-1, 1]\nto = [-200, 800]\n[nodes.water]\nop = \"drainage\"\nsource = \"land\"\n\
                stream = 200000\n[outputs]\nheight = \"land\"\n";
    let world = World::open(Recipe::parse(text, "test").unwrap()).unwrap();
    for window in [world.full_window(50.0).unwrap(), Window::new(70, 60, 50.0).at(30, 25)] {
        let ground = ground(&world, &window);
        let flow = world.window("water.flow", &window).unwrap();
        let orders = world.window("water.strahler", &window).unwrap();
        let mut found = 0;
        for river in &ground.rivers {
            let width = ground.water.heights.width();
            let (i, j) = (river.end as usize % width, river.end as usize / width);
            let (i, j) = (i - ground.frame.columns.start, j - ground.frame.rows.start);
            if river.mouth != Mouth::Border {
                assert_eq!(f64::from(flow[(i, j)]), river.drained * 2500.0);
                assert_eq!(orders[(i, j)], f32::from(river.order));
                found += 1;
            }
        }
        assert!(found > 10, "{found}");
    }
}

#[test]
fn every_layer_has_its_fields_and_lies_in_the_window() {
    let world = preset("fjords", 3, 160.0);
    let window = Window::new(120, 110, 160.0).at(60, 70);
    let mut given = Options::default();
    given.give(&OUTLET, "19200,-19200").unwrap();
    given.give(&SNAP, "1e6").unwrap();
    let options = FeatureOptions::new(&given, world.recipe()).unwrap();
    let ground = FeatureSource::of(&world, &window, &options, 0, &Progress::none()).unwrap();
    for layer in list::all() {
        let Some(made) = layer.of_ground(&ground, &options, &Progress::none()) else { continue };
        let made = made.unwrap();
        assert!(!made.features.is_empty(), "{}", layer.name);
        let [west, north, east, south] = made.bounds().unwrap();
        // Squares around samples extend half a cell beyond them.
        let (left, top) = (window.east(0) - 80.0, window.south(0) - 80.0);
        assert!(
            west >= left && north >= top && east <= left + 120.0 * 160.0 && south <= top + 110.0 * 160.0,
            "{}",
            layer.name
        );
        for feature in &made.features {
            assert_eq!(feature.values.len(), made.fields.len());
            if let Geometry::MultiPolygon(parts) = &feature.geometry {
                assert!(parts.iter().flatten().all(|ring| ring.len() > 3 && ring.first() == ring.last()));
            }
        }
        // A name that is requested twice is one layer.
        assert_eq!(list::listed(&format!("{0}, {0}", layer.name)).unwrap().len(), 1);
    }
    assert!(list::listed("rivers,nothing").is_none());
    // Ids refer to existing features.
    let rivers = list::named("rivers").unwrap().of_ground(&ground, &options, &Progress::none()).unwrap().unwrap();
    let column = |name: &str| rivers.fields.iter().position(|field| field.name == name).unwrap();
    let lakes = ground.lakes.len() as i64;
    for feature in &rivers.features {
        if let Value::Integer(id) = feature.values[column("downstream")] {
            assert!((1..=rivers.features.len() as i64).contains(&id));
        }
        if feature.values[column("mouth")] == Value::text("lake") {
            assert!(matches!(feature.values[column("mouth_lake")], Value::Integer(id) if (1..=lakes).contains(&id)));
        }
    }
}

#[test]
fn a_watershed_is_all_land_whose_flow_directions_lead_to_its_outlet() {
    let text = "orogen = 1\n[world]\nseed = 4\nsize = [6000, 5000]\ncell = 50\nsea_level = 220\n[nodes.hills]\nop = \"fbm\"\nwavelength = 2500\n[nodes.land]\n\
                op = \"remap\"\nsource = \"hills\"\nfrom = [-1, 1]\nto = [-200, 800]\n[nodes.water]\nop = \"drainage\"\nsource = \"land\"\n\
                stream = 200000\n[outputs]\nheight = \"land\"\n";
    let world = World::open(Recipe::parse(text, "test").unwrap()).unwrap();
    let window = world.full_window(50.0).unwrap();
    let receiver = world.window("water.receiver", &window).unwrap();
    let flow = world.window("water.flow", &window).unwrap();
    let (mut known, mut drained) = (0, 0);
    for at in [[1500.0, 1200.0], [3100.0, 2450.0], [4800.0, 3900.0], [700.0, 4000.0]] {
        let mut given = Options::default();
        given.give(&OUTLET, &format!("{},{}", at[0], -at[1])).unwrap();
        given.give(&SNAP, "3000").unwrap();
        given.give(&SMOOTH, "0").unwrap();
        let options = FeatureOptions::new(&given, world.recipe()).unwrap();
        let ground = FeatureSource::of(&world, &window, &options, 0, &Progress::none()).unwrap();
        let layer = list::named("watershed").unwrap().of_ground(&ground, &options, &Progress::none()).unwrap().unwrap();
        let [feature] = &layer.features[..] else { panic!("{}", layer.features.len()) };
        let real = |name: &str| match feature.values[layer.fields.iter().position(|field| field.name == name).unwrap()]
        {
            Value::Real(value) => value,
            ref other => panic!("{name}: {other:?}"),
        };
        let outlet = [real("outlet_x") / 50.0, -real("outlet_y") / 50.0].map(|at| at as i64);
        assert_eq!(f64::from(flow[(outlet[0] as usize, outlet[1] as usize)]), real("drainage_area"));
        assert!(real("drainage_area") >= 200_000.0 && real("moved") <= 3000.0);
        // Whether the path of flow directions from a sample passes the outlet; unknown if the path leaves the window.
        let leads = |start: [i64; 2]| {
            let mut at = start;
            while at != outlet {
                if !(0..window.width as i64).contains(&at[0]) || !(0..window.height as i64).contains(&at[1]) {
                    return None;
                }
                let code = receiver[(at[0] as usize, at[1] as usize)] as usize;
                let Some((east, south)) = STEPS.get(code) else { return Some(false) };
                at = [at[0] + *east as i64, at[1] + *south as i64];
            }
            Some(true)
        };
        let Geometry::MultiPolygon(parts) = &feature.geometry else { panic!("{:?}", feature.geometry) };
        let rings = || parts.iter().flatten();
        let area: f64 = rings().map(|ring| twice_area(ring) / 2.0).sum();
        assert!((area - real("area")).abs() < 1e-3, "{area}");
        let inside = |[i, j]: [i64; 2]| {
            let [x, y] = [i, j].map(|at| at as f64 * 50.0);
            let crosses = |pair: &[[f64; 2]]| {
                (pair[0][1] > y) != (pair[1][1] > y)
                    && x < pair[0][0] + (y - pair[0][1]) / (pair[1][1] - pair[0][1]) * (pair[1][0] - pair[0][0])
            };
            rings().flat_map(|ring| ring.windows(2)).filter(|pair| crosses(pair)).count() % 2 == 1
        };
        for at in (0..window.height as i64).flat_map(|j| (0..window.width as i64).map(move |i| [i, j])) {
            if let Some(leads) = leads(at) {
                assert_eq!(inside(at), leads, "{at:?}");
                known += 1;
                drained += usize::from(leads);
            }
        }
    }
    assert!(drained > 500 && known > drained + 5000, "{drained} of {known}");
}

/// Priority-Flood (Barnes, Lehman and Mulla 2014): from the border and the sea inwards, always from the lowest sample.
fn flooded(heights: &Grid, sea_level: f32) -> Vec<f32> {
    let (width, height) = (heights.width() as i64, heights.height() as i64);
    let mut level = vec![f32::NAN; heights.data().len()];
    // Non-negative heights sort like their bits.
    let key = |h: f32| Reverse((h + 1e4).to_bits());
    let mut queue = BinaryHeap::new();
    for (k, h) in heights.data().iter().enumerate() {
        let (i, j) = (k as i64 % width, k as i64 / width);
        if i == 0 || j == 0 || i + 1 == width || j + 1 == height || *h <= sea_level {
            level[k] = *h;
            queue.push((key(*h), k));
        }
    }
    while let Some((_, k)) = queue.pop() {
        let (i, j) = (k as i64 % width, k as i64 / width);
        for (x, y) in STEPS.map(|(east, south)| (i + east as i64, j + south as i64)) {
            let next = (y * width + x) as usize;
            if (0..width).contains(&x) && (0..height).contains(&y) && level[next].is_nan() {
                level[next] = heights.data()[next].max(level[k]);
                queue.push((key(level[next]), next));
            }
        }
    }
    level
}

#[test]
fn filled_heights_are_those_of_a_priority_flood() {
    for (seed, sea_level) in [(4, 0.0), (5, 0.0), (6, -500.0)] {
        let text = |size: &str| {
            format!(
                "orogen = 1\n[world]\nseed = {seed}\n{size}\ncell = 50\nsea_level = {sea_level}\n[nodes.hills]\nop = \"fbm\"\n\
             wavelength = 1500\n[nodes.land]\nop = \"remap\"\nsource = \"hills\"\nfrom = [-1, 1]\nto = [-200, 800]\n[outputs]\nheight = \"land\"\n"
            )
        };
        let mut recipe = Recipe::parse(&text("size = [6000, 5000]"), "test").unwrap();
        derived::prepare(&mut recipe, "filled", &Options::default()).unwrap();
        let world = World::open(recipe).unwrap();
        let window = Window::new(121, 101, 50.0);
        let (heights, filled) = (world.window("height", &window).unwrap(), world.window("filled", &window).unwrap());
        // Solvers work on the world and two samples beyond it.
        let unbounded = World::open(Recipe::parse(&text(""), "test").unwrap()).unwrap();
        let around = unbounded.window("height", &window.grown(2)).unwrap();
        let expect =
            Grid::from_data(*around.window(), flooded(&around, sea_level as f32)).unwrap().crop(&window).unwrap();
        let deep = filled.data().iter().zip(heights.data()).filter(|(filled, height)| *filled - *height > 1.0).count();
        assert!(deep > 100, "{seed}: {deep}");
        assert!(filled.data() == expect.data(), "{seed}");
    }
}
