//! Lines and areas drawn on the map.

use orogen_engine::recipe::document::Recipe;
use orogen_engine::world::World;
use orogen_grid::{Grid, Window};
use orogen_io::test_folder::TestFolder;
use std::fs;
use std::path::Path;

fn text(op: &str, rest: &str) -> String {
    format!("orogen = 1\n[nodes.drawn]\nop = \"{op}\"\n{rest}\n[outputs]\nheight = \"drawn\"\n")
}

fn open(op: &str, rest: &str) -> World {
    let recipe = Recipe::parse(&text(op, rest), "t").unwrap_or_else(|error| panic!("{error}"));
    World::open(recipe).unwrap_or_else(|error| panic!("{error}"))
}

/// The values of a layer at points.
fn at(world: &World, layer: &str, points: &[[f64; 2]]) -> Vec<f32> {
    let (x, y): (Vec<f64>, Vec<f64>) = points.iter().map(|[x, y]| (*x, *y)).unzip();
    world.points(layer, &x, &y).unwrap()
}

fn close(a: &[f32], b: &[f64], within: f64) -> bool {
    a.len() == b.len() && a.iter().zip(b).all(|(a, b)| (f64::from(*a) - b).abs() <= within)
}

#[test]
fn layers_of_a_path() {
    let world = open("path", "points = [[0, 0, 100], [300, 400, 50], [300, 1000, 50]]\nwidth = 40\nfalloff = 80");
    let points = [[0.0, 0.0], [150.0 + 8.0, 200.0 - 6.0], [360.0, 700.0], [300.0, 1030.0], [-300.0, -400.0]];
    for (layer, expect) in [
        ("drawn", [0.0, 10.0, 60.0, 30.0, 500.0]),
        ("drawn.distance", [0.0, 10.0, 60.0, 30.0, 500.0]),
        ("drawn.chainage", [0.0, 250.0, 800.0, 1100.0, 0.0]),
        ("drawn.position", [0.0, 250.0 / 1100.0, 800.0 / 1100.0, 1.0, 0.0]),
        ("drawn.height", [100.0, 75.0, 50.0, 50.0, 100.0]),
        // Half the width is 20 m, so the middle of the falloff is at 60 m.
        ("drawn.inside", [1.0, 1.0, 0.5, 0.957_031_25, 0.0]),
    ] {
        let values = at(&world, layer, &points);
        assert!(close(&values, &expect, 1e-4), "{layer}: {values:?}");
    }
    // Closed: a line also joins the last point and the first.
    let ring = open("path", "points = [[0, 0], [300, 0], [300, 300]]\nclosed = true\nfalloff = 0\nwidth = 2");
    assert!(close(&at(&ring, "drawn", &[[150.0, 150.0], [0.0, 300.0]]), &[0.0, 212.132], 1e-3));
    assert_eq!(at(&ring, "drawn.inside", &[[150.0, 150.9], [150.0, 152.0]]), [1.0, 0.0]);
    // Of several lines the nearest one counts.
    let two = open("path", "points = [[[0, 0], [0, 100]], [[1000, 0], [1000, 50]]]");
    assert_eq!(at(&two, "drawn", &[[10.0, 50.0], [970.0, 20.0]]), [10.0, 30.0]);
    assert_eq!(at(&two, "drawn.position", &[[10.0, 50.0], [970.0, 25.0]]), [0.5, 0.5]);
}

#[test]
fn layers_of_a_polygon() {
    // A square with a square hole that has an island.
    let square = |low: f64, high: f64, z: f64| {
        format!("[[{low}, {low}, {z}], [{high}, {low}, {z}], [{high}, {high}, {z}], [{low}, {high}, {z}]]")
    };
    let rings =
        format!("points = [{}, {}, {}]", square(0.0, 100.0, 5.0), square(20.0, 80.0, 7.0), square(40.0, 60.0, 9.0));
    let points = [[10.0, 50.0], [30.0, 50.0], [50.0, 50.0], [-10.0, 50.0], [2.0, 50.0], [-2.0, 50.0]];
    for (falloff, layer, expect) in [
        (0.0, "drawn", [1.0, 0.0, 1.0, 0.0, 1.0, 0.0]),
        (8.0, "drawn.inside", [1.0, 0.0, 1.0, 0.0, 0.84375, 0.15625]),
        (8.0, "drawn.distance", [-10.0, 10.0, -10.0, 10.0, -2.0, 2.0]),
        (0.0, "drawn.height", [5.0, 7.0, 9.0, 5.0, 5.0, 5.0]),
    ] {
        let values = at(&open("polygon", &format!("{rings}\nfalloff = {falloff}")), layer, &points);
        assert!(close(&values, &expect, 1e-5), "{layer}: {values:?}");
    }
    let edge = at(&open("polygon", &format!("{rings}\nfalloff = 8")), "drawn", &[[0.0, 50.0], [100.0, 50.0]]);
    assert_eq!(edge, [0.5, 0.5], "half on the boundary");
}

#[test]
fn smooth_lines_keep_the_tolerance() {
    // Points of a circle: a smooth ring through twelve of them is close to it.
    let points: Vec<String> = (0..12)
        .map(|k| std::f64::consts::TAU * f64::from(k) / 12.0)
        .map(|angle| format!("[{:?}, {:?}]", 1e3 * libm::cos(angle), 1e3 * libm::sin(angle)))
        .collect();
    let points = format!("points = [{}]", points.join(", "));
    let around: Vec<[f64; 2]> = (0..500)
        .map(|k| std::f64::consts::TAU * f64::from(k) / 500.0)
        .map(|angle| [1e3 * libm::cos(angle), 1e3 * libm::sin(angle)])
        .collect();
    let worst = |rest: &str| {
        let world = open("path", &format!("{points}\nclosed = true\n{rest}"));
        at(&world, "drawn", &around).into_iter().fold(0.0, f32::max)
    };
    assert!((30.0..40.0).contains(&worst("smooth = false")), "{}", worst("smooth = false"));
    let fine = worst("smooth = true\ntolerance = 0.001");
    assert!(fine < 3.0, "{fine}");
    for tolerance in [0.01, 0.1, 1.0, 5.0] {
        let coarse = worst(&format!("smooth = true\ntolerance = {tolerance}"));
        assert!((coarse - fine).abs() <= tolerance as f32 + 0.002, "{tolerance}: {coarse} {fine}");
    }
    let area = open("polygon", &format!("{points}\nsmooth = true"));
    let inside: Vec<[f64; 2]> = around.iter().map(|[x, y]| [0.99 * x, 0.99 * y]).collect();
    assert!(at(&area, "drawn", &inside).iter().all(|inside| *inside == 1.0));
}

#[test]
fn tiles_are_crops_and_points_are_samples() {
    let points = "[[0, 0, 5], [300, 40, 7], [350, 400, 9], [10, 220, 2], [-90, 500, 1]]";
    let far = "[[1000000, -1000000, 5], [1000300, -999960, 7], [1000350, -999600, 9], [1000010, -999780, 2], [999910, -999500, 1]]";
    for (op, layers) in [
        ("path", &["distance", "position", "chainage", "height", "inside"][..]),
        ("polygon", &["inside", "distance", "height"]),
    ] {
        for (points, shift) in [(points, 0), (far, 100_000)] {
            let world = open(op, &format!("points = {points}\nsmooth = true\nfalloff = 60"));
            for layer in layers {
                let layer = format!("drawn.{layer}");
                let window = Window::new(60, 70, 10.0).at(shift - 15, -shift - 5);
                let full = world.window(&layer, &window).unwrap();
                for (x, y, width, height) in [(3, 5, 20, 31), (59, 69, 1, 1), (0, 33, 60, 7)] {
                    let tile = Window::new(width, height, 10.0).at(window.x + x, window.y + y);
                    let crop = full.crop(&tile).unwrap();
                    assert_eq!(bits(&world.window(&layer, &tile).unwrap()), bits(&crop), "{layer}");
                    let first = [tile.east(0), tile.south(0)];
                    assert_eq!(at(&world, &layer, &[first])[0].to_bits(), crop[(0, 0)].to_bits(), "{layer}");
                }
            }
        }
    }
}

fn bits(grid: &Grid) -> Vec<u32> {
    grid.data().iter().map(|sample| sample.to_bits()).collect()
}

#[test]
fn files_of_both_formats_give_what_points_give() {
    let folder = TestFolder::new("drawings").unwrap();
    let write = |name: &str, text: &str| fs::write(folder.join(name), text).unwrap();
    write(
        "line.svg",
        "<svg xmlns='http://www.w3.org/2000/svg'><g transform='translate(5 0)'><polyline points='-5,0 25,40 25,100'/></g></svg>",
    );
    write("line.geojson", r#"{"type":"LineString","coordinates":[[0,0,1],[30,-40,2],[30,-100,3]]}"#);
    write("area.svg", "<svg xmlns='http://www.w3.org/2000/svg'><path d='M0 0h90v60H0z M30 20v20h30v-20z'/></svg>");
    write(
        "area.json",
        r#"{"type":"Polygon","coordinates":[[[0,0],[90,0],[90,-60],[0,-60],[0,0]],[[30,-20],[60,-20],[60,-40],[30,-40],[30,-20]]]}"#,
    );
    let window = Window::new(40, 40, 31.0).at(-8, -6);
    let read = |op: &str, rest: &str, layer: &str| {
        fs::write(folder.join("recipe.toml"), text(op, rest)).unwrap();
        let world = World::open(Recipe::read(&folder.join("recipe.toml")).unwrap()).unwrap();
        world.window(&format!("drawn.{layer}"), &window).unwrap()
    };
    let placed = "scale = [10, 10]\noffset = [100, -50]";
    let line = "points = [[100, -50, 1], [400, 350, 2], [400, 950, 3]]";
    for layer in ["distance", "chainage", "inside"] {
        let points = read("path", line, layer);
        for file in ["line.svg", "line.geojson"] {
            assert_eq!(read("path", &format!("file = \"{file}\"\n{placed}"), layer), points, "{file}.{layer}");
        }
    }
    assert_eq!(read("path", &format!("file = \"line.geojson\"\n{placed}"), "height"), read("path", line, "height"));
    let area = "points = [[[100, -50], [1000, -50], [1000, 550], [100, 550]], [[400, 150], [700, 150], [700, 350], [400, 350]]]";
    for layer in ["inside", "distance"] {
        let points = read("polygon", &format!("{area}\nfalloff = 90"), layer);
        for file in ["area.svg", "area.json"] {
            let made = read("polygon", &format!("file = \"{file}\"\nfalloff = 90\n{placed}"), layer);
            assert_eq!(made, points, "{file}.{layer}");
        }
    }
    // A layer of a file with several.
    let layers = concat!(env!("CARGO_MANIFEST_DIR"), "/../../fuzz/corpus/drawing/layers.gpkg");
    fs::copy(layers, folder.join("layers.gpkg")).unwrap();
    let roads = read("path", "points = [[0, 5], [50, 5]]", "distance");
    assert_eq!(read("path", "file = \"layers.gpkg|layername=roads\"", "distance"), roads);
    let recipe = Recipe::read(&folder.join("recipe.toml")).unwrap();
    assert_eq!(recipe.files(), [folder.join("layers.gpkg")]);
    // A missing file or one of the wrong kind is reported with the node and the position.
    let refused = |op: &str, file: &str| {
        fs::write(folder.join("recipe.toml"), text(op, &format!("file = \"{file}\""))).unwrap();
        let recipe = Recipe::read(&folder.join("recipe.toml")).unwrap();
        assert!(recipe.files().iter().any(|path| path.ends_with(Path::new(file))));
        World::open(recipe).err().unwrap().to_string()
    };
    for (op, file, message) in [
        ("path", "none.svg", "node `drawn`"),
        ("path", "layers.gpkg", "lines in the layers `rivers`, `roads`"),
        ("path", "area.json", "the op `polygon` reads its 2 areas"),
        ("polygon", "line.svg", "the op `path` reads its 1 line"),
        ("polygon", "recipe.toml", "the op `polygon` reads .svg, .geojson and .gpkg"),
    ] {
        let error = refused(op, file);
        assert!(error.contains(message) && error.contains("recipe.toml:4:8"), "{error}");
    }
}

#[test]
fn the_content_of_a_file_decides_about_stored_solutions() {
    let folder = TestFolder::new("drawing-keys").unwrap();
    let key = |name: &str, line: &str| {
        fs::write(folder.join(name), format!("<svg><polyline points='{line}'/></svg>")).unwrap();
        fs::write(folder.join("recipe.toml"), text("path", &format!("file = \"{name}\""))).unwrap();
        let mut recipe = Recipe::read(&folder.join("recipe.toml")).unwrap();
        recipe.load(1 << 20).unwrap();
        assert!(recipe.held() > 0);
        recipe.nodes()[0].node.param_key(1)
    };
    let first = key("a.svg", "0 0 5 5");
    assert_eq!(key("b.svg", "0,0 5,5"), first);
    assert_ne!(key("a.svg", "0 0 5 6"), first);
}
