//! Scattered objects: they keep their distances, and are the same in any window and on any number of threads.

use orogen_engine::{Object, Options, Progress, Recipe, Window, World};
use orogen_grid::random::Random;
use orogen_grid::triangles;

const SCATTER: &str = r#"
[[scatter]]
name = "house"
spacing = 90
density = 0.5
slope = { max = 12, fade = 6 }
turn = 45
[[scatter]]
name = "tree"
spacing = 9
size = [0.7, 1.4]
clearance = 25
density = "cover"
height = { max = 60, fade = 30 }
[[scatter]]
name = "rock"
spacing = 14
clearance = 3
slope = { min = 14, fade = 6 }
water = "any"
[[scatter]]
name = "reed"
spacing = 8
water = "only"
"#;

fn recipe(world: &str) -> String {
    format!(
        "orogen = 1\n[world]\nseed = 3\n{world}\ncell = 10\nsea_level = 140\n\
         [nodes.hills]\nop = \"fbm\"\nwavelength = 700\noctaves = 4\n[nodes.land]\nop = \"remap\"\nsource = \"hills\"\nfrom = [-1, 1]\nto = [-50, 350]\n\
         [nodes.cover]\nop = \"fbm\"\nwavelength = 300\nseed = 2\n[outputs]\nheight = \"land\"\n{SCATTER}"
    )
}

fn open(world: &str, threads: usize) -> World {
    let recipe = Recipe::parse(&recipe(world), "test").unwrap();
    World::with_options(recipe, Options { threads: Some(threads), ..Options::default() }).unwrap()
}

fn objects(world: &World, window: &Window) -> Vec<Object> {
    world.objects(window, &Progress::none()).unwrap()
}

/// Sorts objects in an order that does not depend on windows.
fn sorted(mut objects: Vec<Object>) -> Vec<Object> {
    objects.sort_by(|a, b| {
        let key = |object: &Object| (object.entry, object.position[1], object.position[0]);
        key(a).partial_cmp(&key(b)).unwrap()
    });
    objects
}

#[test]
fn windows_side_by_side_have_each_object_once() {
    let mut random = Random::new(9, 9);
    let mut counts = [0; 4];
    for (size, x, y, side) in [("", -37, -61, 90), ("", 1_000_000, -1_000_000, 70), ("size = [900, 715]", 0, 0, 90)] {
        let world = open(size, 2);
        let whole = match size {
            "" => Window::new(side, side - 13, 10.0).at(x, y),
            _ => world.full_window(10.0).unwrap(),
        };
        let all = sorted(objects(&world, &whole));
        all.iter().for_each(|object| counts[object.entry] += 1);
        for _ in 0..3 {
            let cut = |random: &mut Random, length: usize| 1 + random.below(length - 1);
            let (i, j) = (cut(&mut random, whole.width), cut(&mut random, whole.height));
            let mut tiles = Vec::new();
            for (x, width) in [(0, i), (i, whole.width - i)] {
                for (y, height) in [(0, j), (j, whole.height - j)] {
                    let tile = Window::new(width, height, 10.0).at(whole.x + x as i64, whole.y + y as i64);
                    tiles.extend(objects(&world, &tile));
                }
            }
            assert_eq!(sorted(tiles), all, "cut at {i}, {j} of {size:?}");
        }
        assert_eq!(sorted(objects(&open(size, 1), &whole)), all, "on one thread");
    }
    assert!(counts.iter().all(|count| *count > 20), "{counts:?}");
}

#[test]
fn distances_are_kept() {
    let world = open("", 2);
    let all = objects(&world, &Window::new(120, 120, 10.0).at(-999_950, 1_000_000));
    // Spacings, and distances to earlier entries.
    let distances = [(90.0, 90.0), (9.0, 25.0), (14.0, 3.0), (8.0, 8.0)];
    for (k, a) in all.iter().enumerate() {
        for b in &all[k + 1..] {
            let distance = libm::hypot(a.position[0] - b.position[0], a.position[1] - b.position[1]);
            let (spacing, clearance) = distances[b.entry];
            let least = if a.entry == b.entry { spacing } else { clearance };
            assert!(distance >= least * (1.0 - 1e-15), "{a:?} {b:?}: {distance}");
        }
    }
}

#[test]
fn objects_stand_on_the_mesh_of_their_window() {
    let world = open("", 2);
    let coarse = Window::new(30, 30, 20.0).at(-15, 3);
    let all = objects(&world, &coarse);
    // The same objects at another cell, at other heights.
    let fine = objects(&world, &Window::new(120, 120, 5.0).at(-60, 12));
    assert_eq!(all.len(), fine.len());
    for (a, b) in all.iter().zip(&fine) {
        assert_eq!(Object { height: b.height, ..*a }, *b);
    }
    let heights = world.window("height", &Window { width: 31, height: 31, ..coarse }).unwrap();
    for object in &all {
        let [x, y] = object.position.map(|at| at / 20.0);
        let (i, j) = ((x.floor() + 15.0) as usize, (y.floor() - 3.0) as usize);
        let corners = [(i, j), (i + 1, j), (i, j + 1), (i + 1, j + 1)].map(|at| heights[at]);
        assert_eq!(object.height, triangles::height(corners, [x - x.floor(), y - y.floor()]));
    }
}

#[test]
fn conditions_water_and_ranges_hold() {
    let world = open("size = 3000", 2);
    let all = objects(&world, &world.full_window(10.0).unwrap());
    let slopes = |object: &Object| {
        let at = |x: f64, y: f64| f64::from(world.height(object.position[0] + x, object.position[1] + y).unwrap());
        let [east, south] = [at(5.0, 0.0) - at(-5.0, 0.0), at(0.0, 5.0) - at(0.0, -5.0)];
        libm::atan(libm::hypot(east, south) / 10.0).to_degrees()
    };
    for object in &all {
        let inside = object.position.iter().all(|at| (0.0..3000.0).contains(at));
        assert!(inside && (0.0..360.0).contains(&object.turn), "{object:?}");
        match object.entry {
            0 => assert!(object.turn == 45.0 && object.size == 1.0 && object.height > 140.0, "{object:?}"),
            1 => assert!(
                (0.7..=1.4).contains(&object.size) && object.height > 140.0 && object.height < 235.0,
                "{object:?}"
            ),
            2 => {}
            _ => assert!(object.height <= 140.0, "{object:?}"),
        }
    }
    let mean = |entry: usize| {
        let inside =
            |object: &&Object| object.entry == entry && object.position.iter().all(|at| (10.0..2990.0).contains(at));
        let slopes: Vec<f64> = all.iter().filter(inside).map(slopes).collect();
        slopes.iter().sum::<f64>() / slopes.len() as f64
    };
    assert!(mean(2) > mean(0) + 5.0, "rocks {}, houses {}", mean(2), mean(0));
    let turns =
        |quarter: f64| all.iter().filter(|object| object.entry == 1 && (object.turn / 90.0).floor() == quarter).count();
    let trees = all.iter().filter(|object| object.entry == 1).count();
    assert!([0.0, 1.0, 2.0, 3.0].iter().all(|quarter| turns(*quarter) * 5 > trees), "{trees}");
}

#[test]
fn requests_without_objects_are_errors() {
    let text = recipe("").replace(SCATTER, "");
    let world = World::open(Recipe::parse(&text, "test").unwrap()).unwrap();
    let error = world.objects(&Window::new(9, 9, 10.0), &Progress::none()).unwrap_err();
    assert!(error.to_string().contains("`[[scatter]]`"), "{error}");
    let world = open("size = 500", 1);
    let error = world.objects(&Window::new(9, 9, 10.0).at(100, 0), &Progress::none()).unwrap_err();
    assert!(error.to_string().contains("not inside the world"), "{error}");
    let progress = Progress::none();
    progress.cancel();
    assert!(world.objects(&Window::new(9, 9, 10.0), &progress).is_err());
}
