//! Answers have the bits of the library.

use orogen::builder::run::Start;
use orogen::builder::tile_grid::{TileGrid, cell_near};
use orogen::builder::{Build, BuildSpec, Form};
use orogen::export::{ExportJob, registry};
use orogen::io::file::OutputPolicy;
use orogen::io::format::encoding::Encoding;
use orogen::io::test_folder::TestFolder;
use orogen::locate::LocateJob;
use orogen::options::Options;
use orogen::{Progress, Window};
use serde_json::{Value, json};

use super::client::{start, world};
use super::{HILLS, PLAIN, placed, watered};

#[test]
fn tiles_are_the_files_of_a_build() {
    let folder = TestFolder::new("serve-tiles").unwrap();
    for (name, text) in [("plain", HILLS.to_string()), ("place", placed("EPSG:3857", [1_300_003.0, 6_100_007.0]))] {
        let (world, server) = (world(&text), start(&[(name, &text)], &[]));
        let map = world.recipe().georeference();
        let window = world.full_window(cell_near(10.0, 256, map.as_ref())).unwrap();
        for encoding in Encoding::ALL {
            let spec = BuildSpec::new(Form::Xyz(encoding), window);
            let output = OutputPolicy::default().output(folder.join(format!("{name}-{}", encoding.name()))).unwrap();
            Build::new(&world, &spec, &output).unwrap().run(Start::Fresh, &Progress::none()).unwrap();
            let tiles: Value =
                serde_json::from_slice(&std::fs::read(output.path().join("tiles.json")).unwrap()).unwrap();
            let zoom = tiles["maxzoom"].as_u64().unwrap();
            let mut count = 0;
            for column in std::fs::read_dir(output.path().join(zoom.to_string())).unwrap() {
                let column = column.unwrap();
                for row in std::fs::read_dir(column.path()).unwrap() {
                    let row = row.unwrap();
                    let (x, y) = (column.file_name(), row.file_name());
                    let path = format!("/{}/{zoom}/{}/{}", encoding.name(), x.display(), y.display());
                    assert!(server.get(&path).body == std::fs::read(row.path()).unwrap(), "{path}");
                    count += 1;
                }
            }
            assert!(count >= 6, "{name}: {count}");
            // Served and built tiles are described alike.
            let served = server.get(&format!("/tilejson/{}.json", encoding.name())).json();
            assert_eq!((&served["bounds"], &served["encoding"]), (&tiles["bounds"], &tiles["encoding"]), "{name}");
            assert_eq!(served["minzoom"], tiles["minzoom"], "{name}");
        }
    }
}

#[test]
fn pixels_are_samples_at_every_zoom() {
    let server = start(&[("hills", HILLS), ("plain", PLAIN)], &[]);
    for (name, text) in [("hills", HILLS), ("plain", PLAIN)] {
        let world = world(text);
        for (zoom, column, row) in [(0, 0, 0), (3, 3, 2), (3, 4, 4), (17, 65_536, 65_536)] {
            let grid = TileGrid::own(&world, zoom, 256).unwrap();
            let path = format!("/{name}/terrarium/{zoom}/{column}/{row}.png?grid=world");
            let reply = server.get(&path);
            if !grid.has(column, row) {
                assert_eq!(reply.status, 404, "{path}");
                assert!(reply.json()["error"].as_str().unwrap().contains("outside the world"), "{path}");
                continue;
            }
            assert_eq!((reply.status, reply.header("content-type")), (200, "image/png"), "{path}");
            let window = Window::new(256, 256, grid.cell());
            let first = if name == "plain" { -(128i64 << zoom) } else { 0 };
            let at = |tile: u64| tile as i64 * 256 + first;
            let whole = world.full_window(grid.cell()).unwrap_or(window.at(at(column), at(row)));
            let window = window.at(at(column), at(row)).intersection(&whole);
            let heights = world.window("height", &window).unwrap();
            let pixels = reply.pixels();
            for j in 0..window.height {
                for (i, height) in heights.row(j).iter().enumerate() {
                    let pixel: [u8; 3] = std::array::from_fn(|part| pixels[3 * (256 * j + i) + part]);
                    assert_eq!(pixel, Encoding::Terrarium.bytes(*height), "{path} {i} {j}");
                }
            }
        }
    }
    // Twice as many pixels on a side are every zoom twice as fine.
    let (large, small) =
        (server.get("/hills/terrarium/1/1/0@2x.png?grid=world"), server.get("/hills/terrarium/2/2/1.png?grid=world"));
    let (large, small) = (large.pixels(), small.pixels());
    assert!((0..256).all(|j| large[3 * 512 * (256 + j)..][..3 * 256] == small[3 * 256 * j..][..3 * 256]));
}

#[test]
fn windows_are_exports() {
    let text = placed("EPSG:32632", [600_000.0, 5_200_000.0]);
    let (server, world) = (start(&[("hills", &text)], &[]), world(&text));
    for (query, layer, window) in [
        ("", "height", Window::new(512, 256, 10.0)),
        ("?width=256", "height", Window::new(256, 128, 20.0)),
        ("?cell=40&layer=noise", "noise", Window::new(128, 64, 40.0)),
        ("?bbox=601000,5198500,602000,5199000", "height", Window::new(100, 50, 10.0).at(100, 100)),
        ("?bbox=601000,5198500,602000,5199000&height=25", "height", Window::new(50, 25, 20.0).at(50, 50)),
        ("?bbox=601000,5198500,602000,5199000&width=200&height=100", "height", Window::new(200, 100, 5.0).at(200, 200)),
        ("?layer=hillshade&width=128", "hillshade", Window::new(128, 64, 40.0)),
    ] {
        for format in ["tif", "png", "npy"] {
            let path = format!("/window.{format}{query}");
            let reply = server.get(&path);
            assert_eq!(reply.status, 200, "{path}: {}", String::from_utf8_lossy(&reply.body));
            let job = ExportJob::new(registry::named(format).unwrap()).with_layer(layer).with_window(window);
            let mut recipe = world.recipe().clone();
            job.prepare(&mut recipe).unwrap();
            let mut expect = Vec::new();
            job.to_stream(&orogen::World::open(recipe).unwrap(), &mut expect, &Progress::none()).unwrap();
            assert!(reply.body == expect, "{path}");
            let Window { x, y, width, height, cell } = window;
            let place = format!("x={x}, y={y}, width={width}, height={height}, cell={cell}");
            assert_eq!(reply.header("x-orogen-window"), place);
        }
    }
    let whole = server.get("/window.tif?width=64").body;
    let part = server.ask("GET", "/window.tif?width=64", &["Range: bytes=100-299"]);
    assert_eq!((part.status, part.header("content-length")), (206, "200"));
    assert!(part.body == whole[100..300]);
    // Options of formats and layers are parameters.
    assert_eq!(server.get("/window.png?width=64&bits=8").pixels().len(), 64 * 32);
    assert_eq!(server.get("/window.png?width=64&encoding=terrarium").pixels().len(), 3 * 64 * 32);
    let [one, other] =
        ["", "&azimuth=90"].map(|more| server.get(&format!("/window.npy?width=64&layer=hillshade{more}")));
    assert!(one.body != other.body && other.status == 200);
}

#[test]
fn points_are_those_of_the_library() {
    let (server, world) = (start(&[("hills", HILLS)], &[]), world(HILLS));
    let reply = server.get("/height?x=1234.5&y=-777");
    let height = world.height(1234.5, 777.0).unwrap();
    assert_eq!(reply.json(), json!({ "x": 1234.5, "y": -777.0, "layer": "height", "unit": "m", "value": height }));
    let reply = server.get("/profile?points=0,0;3000,-2000;3000,0&samples=11&layer=slope").json();
    assert_eq!((reply["values"].as_array().unwrap().len(), &reply["layer"]), (11, &json!("slope")));
    assert_eq!((&reply["x"][0], &reply["y"][10], &reply["x"][10]), (&json!(0.0), &json!(0.0), &json!(3000.0)));
    let length = 2000.0 + libm::hypot(3000.0, 2000.0);
    assert!((reply["length"].as_f64().unwrap() - length).abs() < 1e-9);
    let values = server.get("/profile?points=0,-100;2550,-100&samples=256").json();
    let heights = world.window("height", &Window::new(256, 1, 10.0).at(0, 10)).unwrap();
    let values: Vec<f32> = serde_json::from_value(values["values"].clone()).unwrap();
    assert_eq!(values, heights.data());
}

#[test]
fn places_are_those_of_the_library() {
    let (server, world) = (start(&[("hills", HILLS)], &[]), world(HILLS));
    let reply = server.get("/locate?where=height%3E200&near=1000,-1000&count=2");
    let options = [("where", "height>200"), ("near", "1000,-1000"), ("count", "2")];
    let job = LocateJob::new(&Options::of(LocateJob::OPTIONS, options).unwrap()).unwrap();
    let found = job.run(&world, &Progress::none()).unwrap();
    assert_eq!((reply.status, found.places.len()), (200, 2));
    assert_eq!(reply.body, found.to_json().as_bytes());
    // A layer that is derived from the heights, and a copy that the client has already.
    let reply = server.get("/locate?where=slope%3C3+and+height%3E100");
    assert!(reply.json()["places"][0]["values"]["slope"].as_f64().unwrap() < 3.0);
    assert_eq!(server.get("/locate?find=summits&largest=height").json()["places"].as_array().unwrap().len(), 1);
}

#[test]
fn maps_are_opaque_within_the_world_and_show_every_layer() {
    let server = start(&[("hills", HILLS)], &[]);
    for layer in ["height", "noise", "slope", "hillshade", "normal", "albedo"] {
        let pixels = server.get(&format!("/tiles/{layer}/0/0/0.png?grid=world")).pixels();
        assert_eq!(pixels.len(), 4 * 256 * 256, "{layer}");
        let (inside, outside) = pixels.split_at(4 * 256 * 128);
        assert!(inside.chunks(4).all(|pixel| pixel[3] == 255), "{layer}");
        assert!(outside.iter().all(|byte| *byte == 0), "{layer}");
        let shades: std::collections::BTreeSet<&[u8]> = inside.chunks(4).collect();
        assert!(shades.len() > 50, "{layer}: {} colors", shades.len());
    }
}

#[test]
fn features_are_those_of_an_export() {
    let text = watered();
    let (world, server) = (world(&text), start(&[("hills", &text)], &[]));
    for (name, layer, more) in [
        ("objects", "scatter", ""),
        ("rivers", "rivers", ""),
        ("lakes", "lakes", ""),
        ("summits", "summits", "prominence=30"),
        ("contours", "contours", "interval=25"),
    ] {
        let options = more.split_once('=');
        let geojson = registry::named("geojson").unwrap();
        let window = Window::new(200, 100, 10.0).at(100, 50);
        let job = ExportJob::new(geojson)
            .with_layer(layer)
            .with_window(window)
            .with_options(Options::of(geojson.options, options).unwrap());
        let mut bytes = Vec::new();
        job.to_stream(&world, &mut bytes, &Progress::none()).unwrap();
        let path = format!("/objects.geojson?layer={name}&bbox=1000,-1500,3000,-500&{more}");
        let reply = server.get(&path);
        assert_eq!((reply.status, reply.header("content-type")), (200, "application/geo+json"), "{reply:?}");
        assert!(reply.body == bytes && reply.json()["features"][0].is_object(), "{name}");
        let tag = format!("If-None-Match: {}", reply.header("etag"));
        assert_eq!(server.ask("GET", &path, &[&tag]).status, 304);
    }
    // Objects are the default.
    assert_eq!(
        server.get("/objects.geojson?bbox=1000,-1500,3000,-500").body,
        server.get("/objects.geojson?layer=objects&bbox=1000,-1500,3000,-500").body
    );
}
