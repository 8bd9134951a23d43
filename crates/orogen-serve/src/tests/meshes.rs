//! Tiles of meshes have the heights of the world, and neighbors fit.

use std::collections::BTreeMap;

use orogen::Window;
use orogen::jobs::mesh_tiles::{max_error, step};
use orogen_codec::format::zarr::unpack::Codec;
use serde_json::json;

use super::client::{start, world};
use super::{HILLS, PLAIN, placed};

/// The number of cells of a tile's side.
const CELLS: u64 = 256;

/// Columns, rows from the south and heights of the vertices of a tile: bytes 88 and on, after the header.
fn vertices(bytes: &[u8]) -> Vec<(u64, u64, f64)> {
    let f32_at = |at: usize| f64::from(f32::from_le_bytes(bytes[at..at + 4].try_into().unwrap()));
    let (low, high) = (f32_at(24), f32_at(28));
    let count = u32::from_le_bytes(bytes[88..92].try_into().unwrap()) as usize;
    let numbers = |axis: usize| {
        let codes = bytes[92 + 2 * count * axis..][..2 * count].chunks_exact(2);
        let codes = codes.map(|code| i32::from(u16::from_le_bytes(code.try_into().unwrap())));
        codes.scan(0, |sum, code| {
            *sum += (code >> 1) ^ -(code & 1);
            Some(f64::from(*sum) / 32_767.0)
        })
    };
    let cell = |share: f64| (share * CELLS as f64).round() as u64;
    let all = numbers(0).zip(numbers(1)).zip(numbers(2));
    all.map(|((u, v), h)| (cell(u), cell(v), low + h * (high - low))).collect()
}

#[test]
fn vertices_are_samples_of_the_world() {
    let server = start(&[("hills", HILLS), ("plain", PLAIN)], &[]);
    for (name, text, zoom, column, row) in [
        ("hills", HILLS, 14, 16_385, 8190),
        ("hills", HILLS, 15, 32_769, 16_382),
        ("plain", PLAIN, 14, 3, 16_000),
        ("plain", PLAIN, 6, 63, 31),
    ] {
        let world = world(text);
        let reply = server.get(&format!("/{name}/mesh/{zoom}/{column}/{row}.terrain"));
        assert_eq!((reply.status, reply.header("content-type")), (200, "application/vnd.quantized-mesh"), "{name}");
        let found = vertices(&reply.body);
        assert!(found.len() >= 4, "{}", found.len());
        let cell = 2.0 * std::f64::consts::PI * 6_378_137.0 / (2u64 << zoom) as f64 / CELLS as f64;
        let (x, y) = ((column as i64 - (1 << zoom)) * 256, ((1 << zoom) - 1 - row as i64) * 256 - (128 << zoom));
        let window = Window::new(257, 257, cell).at(x, y);
        let heights = world.window("height", &window).unwrap();
        for (u, v, height) in found {
            let sample = f64::from(heights[(u as usize, 256 - v as usize)]);
            assert!((height - sample).abs() <= step(zoom) / 2.0 + 1e-6, "{name} {u} {v}: {height} {sample}");
        }
    }
}

/// The vertices of a tile at an edge by their position along it: west, south, east and north.
fn edge(found: &[(u64, u64, f64)], edge: usize) -> BTreeMap<u64, i64> {
    let on = found.iter().filter(|(u, v, _)| [*u == 0, *v == 0, *u == CELLS, *v == CELLS][edge]);
    // Heights in the smallest step of all zooms.
    on.map(|(u, v, height)| (if edge.is_multiple_of(2) { *v } else { *u }, (height * 1024.0).round() as i64)).collect()
}

#[test]
fn neighbors_have_the_same_vertices_along_their_edge() {
    let worlds = [
        ("hills", HILLS.to_string()),
        ("degrees", placed("EPSG:4326", [11.0, 47.0])),
        ("mercator", placed("EPSG:3857", [1_300_003.0, 6_100_007.0])),
    ];
    let worlds: Vec<(&str, &str)> = worlds.iter().map(|(name, text)| (*name, text.as_str())).collect();
    let server = start(&worlds, &[]);
    for (name, _) in worlds {
        let layer = server.get(&format!("/{name}/mesh/layer.json")).json();
        let zoom = layer["maxzoom"].as_u64().unwrap().min(15);
        let [west, south] = ["startX", "startY"].map(|key| layer["available"][zoom as usize][0][key].as_u64().unwrap());
        let at = |column: u64, row: u64| {
            let reply = server.get(&format!("/{name}/mesh/{zoom}/{column}/{row}.terrain"));
            assert_eq!(reply.status, 200, "{name}");
            vertices(&reply.body)
        };
        let (own, east, north) = (at(west, south), at(west + 1, south), at(west, south + 1));
        assert_eq!(edge(&own, 2), edge(&east, 0), "{name}");
        assert_eq!(edge(&own, 3), edge(&north, 1), "{name}");
        assert!(edge(&own, 2).len() > 3, "{name}: {:?}", edge(&own, 2));
    }
}

#[test]
fn the_description_lists_the_tiles_there_are() {
    let server = start(&[("hills", HILLS)], &[]);
    let layer = server.get("/mesh/layer.json").json();
    assert_eq!((&layer["format"], &layer["scheme"]), (&json!("quantized-mesh-1.0"), &json!("tms")));
    assert_eq!(layer["available"][0], json!([{ "startX": 0, "startY": 0, "endX": 1, "endY": 0 }]));
    let most = layer["maxzoom"].as_u64().unwrap() as usize;
    assert_eq!(layer["available"].as_array().unwrap().len(), most + 1);
    let template = layer["tiles"][0].as_str().unwrap();
    for zoom in 0..=most.min(14) {
        let range = &layer["available"][zoom][0];
        let at = |key: &str| range[key].as_u64().unwrap();
        for (column, row) in [(at("startX"), at("startY")), (at("endX"), at("endY"))] {
            let path = template.replace("{z}", &zoom.to_string()).replace("{x}", &column.to_string());
            let reply = server.follow(&path.replace("{y}", &row.to_string()));
            assert_eq!(reply.status, 200, "{path}");
            assert!(reply.header("cache-control").contains("immutable"), "{path}");
        }
        if zoom > 0 {
            let outside = server.get(&format!("/mesh/{zoom}/{}/{}.terrain", at("endX") + 1, at("endY")));
            assert_eq!(outside.status, 404, "{zoom}");
        }
    }
    let seed = server.get("/mesh/layer.json?seed=9").json();
    assert!(seed["tiles"][0].as_str().unwrap().contains("&seed=9"));
}

#[test]
fn extensions_and_compression_are_those_that_a_client_asks_for() {
    let server = start(&[("hills", HILLS)], &[]);
    let path = "/mesh/14/16385/8190.terrain";
    let plain = server.get(path);
    let accept = "Accept: application/vnd.quantized-mesh;extensions=octvertexnormals-metadata,*/*;q=0.01";
    let more = server.ask("GET", path, &[accept]);
    assert!(more.body.starts_with(&plain.body) && more.header("etag") != plain.header("etag"));
    assert_eq!(server.get(&format!("{path}?extensions=octvertexnormals-metadata")).body, more.body);
    let rest = &more.body[plain.body.len()..];
    let count = vertices(&plain.body).len();
    assert_eq!((rest[0], &rest[1..5]), (1, &(2 * count as u32).to_le_bytes()[..]));
    let metadata = &rest[5 + 2 * count..];
    assert_eq!(metadata[0], 4);
    let metadata: serde_json::Value = serde_json::from_slice(&metadata[9..]).unwrap();
    assert_eq!(metadata["geometricerror"], json!(max_error(14)));
    assert_eq!(metadata["available"][0][0]["startX"], json!(32_768));
    let packed = server.ask("GET", path, &["Accept-Encoding: gzip"]);
    assert_eq!((packed.header("content-encoding"), packed.header("vary")), ("gzip", "accept, accept-encoding"));
    assert_eq!(Codec::named("gzip").unwrap().unpack(&packed.body, 1 << 24).unwrap(), plain.body);
    for (path, expect) in [
        ("/mesh/14/0/0.terrain", "outside the world"),
        ("/mesh/14/16385/8190", "is not a tile"),
        ("/mesh/14/16385/8190.png", "is not a tile"),
        ("/mesh/99/0/0.terrain", "the zoom must be"),
        ("/mesh/4294967296/0/0.terrain", "the zoom must be"),
        ("/mesh/14/18446744073709551616/0.terrain", "is not a tile"),
        ("/mesh/24/99999999999/0.terrain", "outside the world"),
        ("/mesh/-1/0/0.terrain", "is not a tile"),
    ] {
        let reply = server.get(path);
        assert_eq!(reply.status, 404, "{path}");
        assert!(reply.json()["error"].as_str().unwrap().contains(expect), "{path}");
    }
}
