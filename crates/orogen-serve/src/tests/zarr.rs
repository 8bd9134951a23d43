//! The Zarr store is the one that a build writes.

use std::path::Path;

use orogen::builder::run::Start;
use orogen::builder::{Build, BuildSpec, Form};
use orogen::export::derived::list;
use orogen::io::file::OutputPolicy;
use orogen::io::test_folder::TestFolder;
use orogen::options::Options;
use orogen::{Progress, Window, World};
use orogen_codec::format::zarr::unpack::Codec;

use super::client::{Running, recipe, session, start, world};
use super::{PLAIN, placed};
use crate::served::Served;

/// The files of a folder, by their paths within it.
fn files(folder: &Path, prefix: &str, all: &mut Vec<String>) {
    for entry in std::fs::read_dir(folder).unwrap() {
        let entry = entry.unwrap();
        let name = format!("{prefix}{}", entry.file_name().display());
        match entry.path().is_dir() {
            true => files(&entry.path(), &format!("{name}/"), all),
            false => all.push(name),
        }
    }
}

#[test]
fn the_store_has_the_bytes_of_a_build() {
    let text = placed("EPSG:32632", [600_000.0, 5_200_000.0]).replace("size = [5120, 2560]", "size = [5200, 320]");
    let server = start(&[("hills", &text)], &[]);
    // All layers of the store as layers of one recipe.
    let served = Served::new("hills", &session(), recipe(&text), false).unwrap();
    let mut all = recipe(&text);
    let mut layers = Vec::new();
    for layer in served.layers() {
        if list::named(&layer.name).is_none_or(|derived| derived.channels().is_none()) {
            list::prepare(&mut all, &layer.name, &Options::default()).unwrap();
            layers.push(layer.name);
        }
    }
    assert!(layers.len() > 20, "{layers:?}");
    let world = World::open(all).unwrap();
    let folder = TestFolder::new("serve-zarr").unwrap();
    let spec = BuildSpec::new(Form::Zarr, world.full_window(10.0).unwrap()).with_layers(&layers);
    let output = OutputPolicy::default().output(folder.join("hills.zarr")).unwrap();
    Build::new(&world, &spec, &output).unwrap().run(Start::Fresh, &Progress::none()).unwrap();
    let mut names = Vec::new();
    files(output.path(), "", &mut names);
    assert_eq!(names.len(), 1 + 2 * 2 + 3 * layers.len());
    for name in names {
        let reply = server.get(&format!("/zarr/{name}"));
        assert_eq!(reply.status, 200, "{name}: {}", String::from_utf8_lossy(&reply.body));
        assert!(reply.body == std::fs::read(output.path().join(&name)).unwrap(), "{name}");
        assert!(server.get(&format!("/hills/zarr/levels/0/{name}")).body == reply.body, "{name}");
    }
}

/// The decoded numbers of a chunk.
fn decoded(server: &Running, path: &str) -> Vec<u8> {
    let reply = server.get(path);
    assert_eq!((reply.status, reply.header("content-type")), (200, "application/octet-stream"), "{path}");
    Codec::named("blosc").unwrap().unpack(&reply.body, 1 << 24).unwrap()
}

/// The samples of a chunk.
fn samples(server: &Running, path: &str) -> Vec<f32> {
    decoded(server, path).chunks_exact(4).map(|bytes| f32::from_le_bytes(bytes.try_into().unwrap())).collect()
}

/// Numbers of a chunk of coordinates.
fn coordinates(server: &Running, path: &str) -> Vec<f64> {
    decoded(server, path).chunks_exact(8).map(|bytes| f64::from_le_bytes(bytes.try_into().unwrap())).collect()
}

#[test]
fn chunks_and_coordinates_of_an_unbounded_world_are_those_of_its_windows() {
    let (server, world) = (start(&[("plain", PLAIN)], &[]), world(PLAIN));
    for (level, side, row, column) in [(0, 1 << 20, 1024, 1024), (0, 1 << 20, 0, 2047), (3, 1 << 17, 127, 128)] {
        let folder = format!("/zarr/levels/{level}");
        let array = server.get(&format!("{folder}/height/zarr.json")).json();
        assert_eq!(array["shape"], serde_json::json!([side, side]));
        let cell = 10.0 * f64::from(1 << level);
        let first = |chunk: i64| chunk * 512 - side / 2;
        let window = Window::new(512, 512, cell).at(first(column), first(row));
        let made = world.window("height", &window).unwrap();
        assert!(samples(&server, &format!("{folder}/height/c/{row}/{column}")) == made.data(), "{level} {row}");
        let slopes = samples(&server, &format!("{folder}/slope/c/{row}/{column}"));
        assert!(slopes.iter().all(|slope| (0.0..90.0).contains(slope)));
        let at = |chunk: i64| (chunk * 512 / 65_536, (chunk * 512 % 65_536) as usize);
        let ((n, k), (m, l)) = (at(column), at(row));
        let xs = coordinates(&server, &format!("{folder}/x/c/{n}"));
        let ys = coordinates(&server, &format!("{folder}/y/c/{m}"));
        assert_eq!((xs.len(), xs[k], xs[k + 1]), (65_536, window.x as f64 * cell, (window.x + 1) as f64 * cell));
        assert_eq!((ys.len(), ys[l], ys[l + 1]), (65_536, 0.0 - window.y as f64 * cell, -(window.y + 1) as f64 * cell));
    }
    // Each level has half the samples of the level before, down to one chunk.
    let levels = server.get("/zarr/levels/zarr.json").json();
    let layout = levels["attributes"]["multiscales"]["layout"].as_array().unwrap();
    assert_eq!((layout.len(), &layout[11]["asset"]), (12, &serde_json::json!("11")));
    assert_eq!(levels["consolidated_metadata"]["metadata"]["11/height"]["shape"], serde_json::json!([512, 512]));
}

#[test]
fn what_the_store_does_not_have_is_not_found_without_work() {
    let server = start(&[("hills", &placed("EPSG:4326", [11.0, 47.0])), ("plain", PLAIN)], &[]);
    for key in [
        ".zgroup",
        ".zmetadata",
        ".zattrs",
        "zarr.json/",
        "height",
        "height/.zarray",
        "height/c/1/0",
        "height/c/0/1",
        "height/c/0/-1",
        "height/c/00/0",
        "height/c/0/18446744073709551616",
        "height/c/18446744073709551615/18446744073709551615",
        "height/c/0",
        "x/c/1",
        "x/c/0/0",
        "nothing/zarr.json",
        "nothing/c/0/0",
        "normal/zarr.json",
        "splat/c/0/0",
        "viewshed/zarr.json",
        "levels/9/zarr.json",
        "levels/9/height/c/0/0",
        "levels/4294967296/height/c/0/0",
        "levels/levels/zarr.json",
        "..%2f..%2fetc%2fpasswd",
    ] {
        let reply = server.get(&format!("/hills/zarr/{key}"));
        assert_eq!(reply.status, 404, "{key}");
        assert!(reply.json()["error"].as_str().unwrap().contains("no key"), "{key}");
    }
    assert_eq!(server.metric("orogen_work_total"), 0);
    assert_eq!(server.get("/hills/zarr/zarr.json?cell=5").status, 400);
}

#[test]
fn parts_of_metadata_and_chunks_are_sent_and_copies_are_recognized() {
    let server = start(&[("plain", PLAIN)], &[]);
    for path in ["/zarr/zarr.json", "/zarr/height/c/1024/1024"] {
        let whole = server.get(path);
        assert!(whole.header("cache-control").contains("no-cache") && !whole.header("etag").is_empty(), "{path}");
        let part = server.ask("GET", path, &["Range: bytes=10-19", "Accept-Encoding: gzip"]);
        assert_eq!((part.status, part.header("content-encoding")), (206, ""), "{path}");
        assert!(part.body == whole.body[10..20], "{path}");
        let known = server.ask("GET", path, &[&format!("If-None-Match: {}", whole.header("etag"))]);
        assert_eq!((known.status, known.body.len()), (304, 0), "{path}");
        let head = server.ask("HEAD", path, &[]);
        assert_eq!((head.status, head.body.len()), (200, 0), "{path}");
        assert_eq!(head.header("content-length"), whole.body.len().to_string(), "{path}");
    }
    assert_eq!(server.ask("GET", "/zarr/zarr.json", &["Accept-Encoding: gzip"]).header("content-encoding"), "gzip");
}
