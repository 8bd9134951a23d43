//! Vector tiles: their features are those of the world, and meet those of the tiles beside them.

use orogen::builder::tile_grid::TileGrid;
use orogen_codec::format::zarr::unpack::Codec;

use super::client::{Running, start, world};
use super::vector_reader::{Feature, layers};
use super::{HILLS, PLAIN, placed, watered};

/// The features of a layer of a tile.
fn features(server: &Running, path: &str, layer: &str) -> Vec<Feature> {
    let reply = server.get(path);
    assert_eq!(reply.status, 200, "{path}: {}", String::from_utf8_lossy(&reply.body));
    layers(&reply.body).remove(layer).unwrap_or_default()
}

/// The points at which lines cross a side of a tile, within the other sides, with the attributes of their features.
fn at_side(features: &[Feature], axis: usize, side: i64) -> Vec<String> {
    let mut found = Vec::new();
    for Feature { paths, values, .. } in features {
        let beyond = |point: [i64; 2]| (point[axis] - side).signum();
        for three in paths.iter().flat_map(|path| path.windows(3)) {
            // A point that only rounds to the side is in one of the tiles.
            let crosses = beyond(three[1]) == 0 && beyond(three[0]) * beyond(three[2]) < 0;
            if crosses && (1..4096).contains(&three[1][1 - axis]) {
                found.push(format!("{} {values:?}", three[1][1 - axis]));
            }
        }
    }
    found.sort();
    found.dedup();
    found
}

#[test]
fn lines_of_adjacent_tiles_meet_at_their_sides() {
    let text = watered();
    let place = text.replace("cell = 10", "cell = 10\ncrs = \"EPSG:3857\"\norigin = [1300003.0, 6100007.0]");
    let server = start(&[("hills", &text), ("place", &place)], &[]);
    let grid = TileGrid::web(&world(&place), 14, 512).unwrap();
    let [[west, _], [north, _]] = grid.tiles();
    for (tiles, x, y) in [("/hills/vector/1", 0, 0), ("/hills/vector/2", 1, 0), ("/place/vector/14", west, north)] {
        let query = if tiles.starts_with("/hills") { "?grid=world" } else { "" };
        let tile = |x: u64, y: u64, layer: &str| features(&server, &format!("{tiles}/{x}/{y}.mvt{query}"), layer);
        let mut met = 0;
        for layer in ["contours", "rivers", "lakes"] {
            let here = tile(x, y, layer);
            let across = [at_side(&here, 0, 4096), at_side(&tile(x + 1, y, layer), 0, 0)];
            assert_eq!(across[0], across[1], "{tiles} {layer}");
            met += across[0].len();
            if !tiles.ends_with('1') {
                let down = [at_side(&here, 1, 4096), at_side(&tile(x, y + 1, layer), 1, 0)];
                assert_eq!(down[0], down[1], "{tiles} {layer}");
                met += down[0].len();
            }
        }
        assert!(met > 10, "{tiles}: {met}");
    }
}

#[test]
fn contours_are_at_their_heights() {
    let server = start(&[("hills", HILLS)], &[]);
    let world = world(HILLS);
    let grid = TileGrid::own(&world, 2, 512).unwrap();
    let window = grid.window(1, 1, 16);
    let heights = world.window("height", &window).unwrap();
    let found = features(&server, "/vector/2/1/1.mvt?grid=world&layers=contours&interval=10", "contours");
    let (mut count, mut index) = (0, 0);
    for Feature { kind, paths, values } in found {
        let height = values["elevation"].as_f64().unwrap();
        assert_eq!((kind, height % 10.0), (2, 0.0));
        assert_eq!(values["index"], height % 50.0 == 0.0);
        index += usize::from(height % 50.0 == 0.0);
        for [x, y] in paths.into_iter().flatten() {
            // Rounding moves a point by at most a sixteenth of a sample. The world ends at the south of the tile.
            let [i, j] = [(x, window.x), (y, window.y)].map(|(unit, first)| 512 + unit.div_euclid(8) - first);
            if j + 2 >= window.height as i64 {
                continue;
            }
            let near = |at: i64| [-1, 0, 1, 2].map(|step| (at + step) as usize);
            let around = near(j).into_iter().flat_map(|j| near(i).map(|i| heights[(i, j)]));
            let [low, high] = around.fold([f32::MAX, f32::MIN], |[low, high], own| [low.min(own), high.max(own)]);
            assert!(f64::from(low) <= height && height <= f64::from(high), "{x} {y}: {low} {height} {high}");
            count += 1;
        }
    }
    assert!(count > 500 && index > 2, "{count} {index}");
}

#[test]
fn tiles_have_what_the_world_has() {
    let text = watered();
    let server = start(&[("wet", &text), ("hills", HILLS), ("plain", PLAIN)], &[]);
    let all = |path: &str| layers(&server.get(path).body);
    let names = |path: &str| all(path).into_keys().collect::<Vec<_>>();
    assert_eq!(names("/wet/vector/2/1/0.mvt?grid=world"), ["contours", "lakes", "objects", "rivers", "summits"]);
    assert_eq!(names("/hills/vector/2/1/0.mvt?grid=world"), ["contours", "summits"]);
    assert_eq!(names("/plain/vector/16/32768/32768.mvt?interval=0.01"), ["contours", "summits"]);
    assert_eq!(names("/wet/vector/2/1/0.mvt?grid=world&layers=rivers,lakes"), ["lakes", "rivers"]);
    let wet = all("/wet/vector/1/0/0.mvt?grid=world");
    for (layer, kind, fields) in [
        ("rivers", 2, vec!["discharge", "drainage_area", "strahler", "width"]),
        ("lakes", 3, vec!["area", "level"]),
        ("summits", 1, vec!["height", "prominence", "rank"]),
        ("objects", 1, vec!["height", "kind", "size", "turn"]),
        ("contours", 2, vec!["elevation", "index"]),
    ] {
        assert!(!wet[layer].is_empty(), "{layer}");
        for feature in &wet[layer] {
            assert_eq!(
                (feature.kind, feature.values.keys().map(String::as_str).collect::<Vec<_>>()),
                (kind, fields.clone())
            );
        }
    }
    // The highest summit of the world is in one of its tiles, with its height.
    let tops: Vec<f64> = (0..2)
        .flat_map(|column| features(&server, &format!("/wet/vector/1/{column}/0.mvt?grid=world"), "summits"))
        .filter(|summit| summit.values["rank"] == 1)
        .map(|summit| summit.values["height"].as_f64().unwrap())
        .collect();
    let heights = world(&text);
    let heights = heights.window("height", &heights.full_window(10.0).unwrap()).unwrap();
    let highest = heights.data().iter().copied().fold(f32::MIN, f32::max);
    assert_eq!(tops, [f64::from(highest)]);
    // An object is in one tile: those of four tiles are those of the tile above.
    let count = |zoom: u32, x: u64, y: u64| {
        features(&server, &format!("/wet/vector/{zoom}/{x}/{y}.mvt?grid=world&layers=objects"), "objects").len()
    };
    let four: usize = [(0, 0), (1, 0), (0, 1), (1, 1)].iter().map(|(x, y)| count(2, *x, *y)).sum();
    assert!(four > 1000 && four == count(1, 0, 0), "{four}");
    // Nothing there: no bytes.
    let empty = server.get("/hills/vector/1/0/0.mvt?grid=world&layers=contours&interval=9000");
    assert_eq!((empty.status, empty.body.len()), (200, 0));
}

#[test]
fn vector_tiles_are_described_and_kept_by_clients() {
    let server = start(&[("hills", &watered()), ("place", &placed("EPSG:3857", [1_300_000.0, 6_100_000.0]))], &[]);
    let json = server.get("/hills/tilejson/vector.json?grid=world").json();
    assert_eq!((json["tileSize"].as_u64(), json["maxzoom"].as_u64()), (Some(512), Some(3)), "{json}");
    let layers: Vec<&str> =
        json["vector_layers"].as_array().unwrap().iter().map(|layer| layer["id"].as_str().unwrap()).collect();
    assert_eq!(layers, ["lakes", "contours", "rivers", "objects", "summits"]);
    assert!(json["vector_layers"][0]["fields"]["level"].as_str().unwrap().contains("m"));
    let address = json["tiles"][0].as_str().unwrap();
    let address = address.replace("{z}", "1").replace("{x}", "1").replace("{y}", "0");
    let reply = server.follow(&address);
    assert_eq!((reply.status, reply.header("content-type")), (200, "application/vnd.mapbox-vector-tile"));
    assert_eq!(reply.header("cache-control"), "public, max-age=31536000, immutable");
    let path = "/hills/vector/1/1/0.mvt?grid=world";
    let tag = format!("If-None-Match: {}", reply.header("etag"));
    assert_eq!(server.ask("GET", path, &[&tag]).status, 304);
    let other = server.get(&format!("{path}&layers=rivers"));
    assert_ne!(other.header("etag"), reply.header("etag"));
    assert_eq!(server.get("/place/tilejson/vector.json").json()["vector_layers"].as_array().unwrap().len(), 2);
}

#[test]
fn tiles_are_compressed_for_clients_that_take_it() {
    let server = start(&[("hills", &watered())], &[]);
    let path = "/vector/1/0/0.mvt?grid=world";
    let packed = server.ask("GET", path, &["Accept-Encoding: gzip"]);
    let plain = server.get(path);
    assert_eq!((packed.header("content-encoding"), packed.header("vary")), ("gzip", "accept-encoding"));
    assert_eq!((plain.header("content-encoding"), plain.header("vary")), ("", "accept-encoding"));
    assert_eq!(Codec::named("gzip").unwrap().unpack(&packed.body, 1 << 24).unwrap(), plain.body);
    assert_ne!(packed.header("etag"), plain.header("etag"));
    let known = format!("If-None-Match: {}", packed.header("etag"));
    assert_eq!(server.ask("GET", path, &["Accept-Encoding: gzip", &known]).status, 304);
    // A part is one of the plain bytes; a tile without features has none.
    let part = server.ask("GET", path, &["Accept-Encoding: gzip", "Range: bytes=0-9"]);
    assert!(part.status == 206 && part.body == plain.body[..10]);
    let lakes = (0..8).map(|column| format!("/vector/5/{column}/0.mvt?grid=world&layers=lakes"));
    let all: Vec<_> = lakes.map(|path| server.ask("GET", &path, &["Accept-Encoding: gzip"])).collect();
    let none = all.iter().find(|reply| reply.body.is_empty()).unwrap();
    assert_eq!((none.status, none.header("content-encoding")), (200, ""));
}
