//! Exports of windows that share a row or a column agree there to the bit.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "a test that fails panics")]

use std::collections::BTreeMap;

use orogen::export::options::Options;
use orogen::export::subject::Subject;
use orogen::export::{registry, run};
use orogen::{Progress, Recipe, Window, World};

/// Hills between 0 and some hundred metres, eroded by a filter.
fn world(size: &str) -> World {
    let text = format!(
        "orogen = 1\n[world]\nseed = 5\n{size}\ncell = 20\n[nodes.hills]\nop = \"fbm\"\nwavelength = 700\n[nodes.land]\nop = \"remap\"\n\
         source = \"hills\"\nfrom = [-1, 1]\nto = [-300, 700]\n[nodes.worn]\nop = \"thermal\"\nsource = \"land\"\niterations = 8\n\
         [outputs]\nheight = \"worn\"\n"
    );
    World::open(Recipe::parse(&text, "test").unwrap()).unwrap()
}

fn exported(world: &World, format: &str, layer: &str, window: Window, given: &[[&str; 2]]) -> Vec<u8> {
    let progress = Progress::none();
    let subject = Subject::new(world, layer, window, &progress).unwrap();
    let mut options = Options::default();
    let format = registry::named(format).unwrap();
    for [name, value] in given {
        options.give(format.options.iter().find(|spec| spec.name == *name).unwrap(), value).unwrap();
    }
    let mut bytes = Vec::new();
    run::to_stream(format, subject, &options, &mut bytes).unwrap();
    bytes
}

/// Corners of a mesh by their place in the world in samples: height and normal (east, up, south), as bits.
type Corners = BTreeMap<[i64; 2], [u32; 4]>;

fn corners(format: &str, bytes: &[u8], window: &Window) -> Corners {
    let mut found = Corners::new();
    let mut keep = |[east, height, south]: [f32; 3], normal: [f32; 3]| {
        let at = |metres: f32, first: i64| (f64::from(metres) / window.cell).round() as i64 + first;
        let bits = [height, normal[0], normal[1], normal[2]].map(|part| (part + 0.0).to_bits());
        found.insert([at(east, window.x), at(south, window.y)], bits);
    };
    let floats = |bytes: &[u8]| -> Vec<f32> {
        bytes.chunks_exact(4).map(|four| f32::from_le_bytes(four.try_into().unwrap())).collect()
    };
    match format {
        "obj" => {
            let text = String::from_utf8(bytes.to_vec()).unwrap();
            let all = |tag: &str| -> Vec<[f32; 3]> {
                let lines = text.lines().filter_map(|line| line.strip_prefix(tag));
                lines
                    .map(|line| {
                        let parts: Vec<f32> = line.split(' ').map(|part| part.parse().unwrap()).collect();
                        [parts[0], parts[1], parts[2]]
                    })
                    .collect()
            };
            all("v ").into_iter().zip(all("vn ")).for_each(|(place, normal)| keep(place, normal));
        }
        "ply" => {
            let end = bytes.windows(11).position(|part| part == b"end_header\n").unwrap() + 11;
            let header = std::str::from_utf8(&bytes[..end]).unwrap();
            let count =
                header.split("element vertex ").nth(1).unwrap().lines().next().unwrap().parse::<usize>().unwrap();
            // x east, y north, z up, the normal likewise, and three bytes of colour.
            for corner in bytes[end..end + 27 * count].chunks_exact(27) {
                let [x, y, z, nx, ny, nz] = floats(&corner[..24]).try_into().unwrap();
                keep([x, z, -y], [nx, nz, -ny]);
            }
        }
        _ => {
            let length = u32::from_le_bytes(bytes[12..16].try_into().unwrap()) as usize;
            let json: serde_json::Value = serde_json::from_slice(&bytes[20..20 + length]).unwrap();
            let count = json["accessors"][0]["count"].as_u64().unwrap() as usize;
            let binary = &bytes[28 + length..];
            for corner in binary[..32 * count].chunks_exact(32) {
                let [x, y, z, nx, ny, nz] = floats(&corner[..24]).try_into().unwrap();
                keep([x, y, z], [nx, ny, nz]);
            }
        }
    }
    found
}

/// Two windows of a world that share a row, and two that share a column.
fn neighbours() -> [[Window; 2]; 2] {
    let window = Window::new(41, 31, 20.0);
    [[window.at(3, 0), window.at(3, 30)], [window.at(0, 7), window.at(40, 7)]]
}

#[test]
fn meshes_of_neighbours_have_the_same_normals_where_they_meet() {
    for size in ["size = [2000, 2000]", ""] {
        let world = world(size);
        for windows in neighbours() {
            for format in ["obj", "ply", "glb"] {
                for given in [vec![], vec![["max-error", "2"]]] {
                    let [a, b] = windows
                        .map(|window| corners(format, &exported(&world, format, "height", window, &given), &window));
                    let shared: Vec<&[i64; 2]> = a.keys().filter(|place| b.contains_key(*place)).collect();
                    let least = if given.is_empty() { 31 } else { 4 };
                    assert!(shared.len() >= least, "{format}: {} shared", shared.len());
                    for place in &shared {
                        assert_eq!(a[*place], b[*place], "{format} {given:?} {place:?} {size}");
                    }
                    // Where they meet neither has a corner that the other lacks.
                    let [row, column] = [windows[1].y, windows[1].x];
                    let vertical = windows[0].x != windows[1].x;
                    let on_border = |place: &&[i64; 2]| if vertical { place[0] == column } else { place[1] == row };
                    assert_eq!(a.keys().filter(on_border).count(), b.keys().filter(on_border).count());
                }
            }
        }
    }
}

#[test]
fn a_mesh_has_the_normals_of_its_map() {
    let world = world("size = [2000, 2000]");
    let window = Window::new(25, 20, 20.0).at(30, 40);
    let mesh = corners("glb", &exported(&world, "glb", "height", window, &[]), &window);
    let map = exported(&world, "npy", "normal", window, &[]);
    let floats = &map[map.len() - 25 * 20 * 12..];
    for (k, part) in floats.chunks_exact(12).enumerate() {
        let place = [window.x + (k % 25) as i64, window.y + (k / 25) as i64];
        let [east, north, up]: [f32; 3] =
            std::array::from_fn(|c| f32::from_le_bytes(part[4 * c..4 * c + 4].try_into().unwrap()));
        let [_, x, y, z] = mesh[&place].map(f32::from_bits);
        for (a, b) in [(east, x), (up, y), (-north, z)] {
            assert!((a - b).abs() < 1e-6, "{place:?}: {a} {b}");
        }
    }
}

#[test]
fn contours_of_neighbours_meet() {
    let world = world("");
    for [first, second] in neighbours() {
        let given = [["interval", "25"]];
        let ends = |window: &Window, on: &dyn Fn([f64; 2]) -> bool| -> Vec<[u64; 3]> {
            let bytes = exported(&world, "geojson", "height", *window, &given);
            let json: serde_json::Value = serde_json::from_slice(&bytes).unwrap();
            let mut ends: Vec<[u64; 3]> = Vec::new();
            for feature in json["features"].as_array().unwrap() {
                let elevation = feature["properties"]["elevation"].as_f64().unwrap();
                let line = feature["geometry"]["coordinates"].as_array().unwrap();
                for end in [line.first().unwrap(), line.last().unwrap()] {
                    let [x, y] = [0, 1].map(|k| end[k].as_f64().unwrap());
                    if on([x, y]) {
                        ends.push([elevation, x, y].map(f64::to_bits));
                    }
                }
            }
            ends.sort_unstable();
            ends.dedup();
            ends
        };
        // A world's own metres count north in GeoJSON.
        let (x, y) = (second.east(0), second.south(0));
        let vertical = first.x != second.x;
        let on = move |place: [f64; 2]| if vertical { place[0] == x } else { place[1].abs() == y };
        let [a, b] = [ends(&first, &on), ends(&second, &on)];
        assert!(a.len() > 3 && a == b, "{vertical}: {} and {}", a.len(), b.len());
    }
}
