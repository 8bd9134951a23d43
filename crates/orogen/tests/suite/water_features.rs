//! Water as vector features: rivers agree with the recipe's own drainage, for presets and seeds.

use orogen::export::features::list;
use orogen::export::features::options::FeatureOptions;
use orogen::export::features::source::FeatureSource;
use orogen::export::options::Options;
use orogen::format::features::{Geometry, Value};
use orogen::hydrography::rivers::Mouth;
use orogen::{Progress, Recipe, Window, World, presets};

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
    let none = Options::default();
    let options = FeatureOptions::new(&none, world.recipe()).unwrap();
    let ground = FeatureSource::of(&world, &window, &options, 0, &Progress::none()).unwrap();
    for layer in list::all() {
        let Some(made) = layer.of_ground(&ground, &options) else { continue };
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
    let rivers = list::named("rivers").unwrap().of_ground(&ground, &options).unwrap().unwrap();
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
