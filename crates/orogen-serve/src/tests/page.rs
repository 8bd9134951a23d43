//! The map page: its files are all there, its texts are in both languages, and its colors are those of tiles.

use std::collections::BTreeMap;
use std::path::Path;

use super::HILLS;
use super::client::start;

/// The files of the page that are our own.
fn sources() -> BTreeMap<String, String> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("page");
    let files = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).filter(|path| path.is_file());
    files
        .map(|path| (path.file_name().unwrap().to_string_lossy().into_owned(), std::fs::read_to_string(&path).unwrap()))
        .collect()
}

/// What stands between two texts, wherever it does.
fn between<'a>(text: &'a str, start: &'a str, end: &'a str) -> impl Iterator<Item = &'a str> {
    text.split(start).skip(1).filter_map(move |rest| Some(rest.split_once(end)?.0))
}

#[test]
fn the_page_finds_its_files() {
    let server = start(&[("hills", HILLS)], &[("token", "secret-token-of-a-test")]);
    for (path, root) in [("/?token=secret-token-of-a-test", ""), ("/hills/?token=secret-token-of-a-test", "../")] {
        let reply = server.get(path);
        assert_eq!((reply.status, reply.header("content-type")), (200, "text/html; charset=utf-8"));
        let policy = reply.header("content-security-policy");
        assert!(policy.contains("default-src 'none'") && !policy.contains("script-src 'self' "), "{policy}");
        let text = reply.text();
        assert!(text.contains("<title>hills</title>") && !text.contains("{root}") && !text.contains("http"));
        for name in between(text, &format!("\"{root}assets/"), "\"") {
            // Scripts and styles are no secret.
            let reply = server.get(&format!("/assets/{name}"));
            assert!(reply.status == 200 && !reply.body.is_empty(), "{name}");
            let tag = format!("If-None-Match: {}", reply.header("etag"));
            assert_eq!(server.ask("GET", &format!("/assets/{name}"), &[&tag]).status, 304);
            let packed = server.ask("GET", &format!("/assets/{name}"), &["Accept-Encoding: gzip"]);
            assert!(packed.header("content-encoding") == "gzip" && packed.body.len() < reply.body.len(), "{name}");
        }
    }
    assert_eq!(server.get("/").status, 401);
    let folder = server.get("/hills?token=secret-token-of-a-test");
    assert_eq!((folder.status, folder.header("location")), (308, "hills/?token=secret-token-of-a-test"));
    for (file, text) in sources() {
        for name in between(&text, " from \"./", "\"") {
            let reply = server.get(&format!("/assets/{name}"));
            assert!(
                reply.status == 200 && reply.header("content-type").starts_with("text/javascript"),
                "{file}: {name}"
            );
        }
        if file.ends_with(".js") {
            let reply = server.get(&format!("/assets/{file}"));
            assert_eq!(reply.text(), text, "{file} is not a file of the page");
        }
    }
}

#[test]
fn texts_are_in_both_languages_and_used() {
    let sources = sources();
    let read = |name: &str| -> BTreeMap<String, String> { serde_json::from_str(&sources[name]).unwrap() };
    let (english, chinese) = (read("en.json"), read("zh-CN.json"));
    // The names of what the program declares are English in the program itself.
    let is_declared = |key: &str| ["layer.", "palette.", "class."].iter().any(|start| key.starts_with(start));
    let own: Vec<&String> = chinese.keys().filter(|key| !is_declared(key)).collect();
    assert_eq!(english.keys().collect::<Vec<_>>(), own);
    for (key, text) in &english {
        let places = |text: &str| {
            let mut names: Vec<String> = between(text, "{", "}").map(str::to_string).collect();
            names.sort();
            names
        };
        assert_eq!(places(text), places(&chinese[key]), "{key}");
    }
    let code: String =
        sources.iter().filter(|(name, _)| !name.ends_with(".json")).map(|(_, text)| text.as_str()).collect();
    // Not the end of `get("about")`.
    let calls = code.match_indices("t(\"").filter(|(at, _)| !code[..*at].ends_with(|c: char| c.is_alphanumeric()));
    let texts = calls.filter_map(|(at, start)| Some(code[at + start.len()..].split_once('"')?.0));
    let asked = ["data-text=\"", "data-label=\"", "data-title=\""].map(|name| between(&code, name, "\""));
    for key in texts.chain(asked.into_iter().flatten()) {
        assert!(english.contains_key(key), "{key} has no text");
    }
    for key in english.keys() {
        let stem = key.split_once('.').map_or(key.as_str(), |(stem, _)| stem);
        assert!(code.contains(&format!("\"{key}\"")) || code.contains(&format!("`{stem}.$")), "{key} is not used");
    }
}

/// The hills with some of them in the sea.
fn coast() -> String {
    HILLS.replace("sea_level = 20", "sea_level = 140")
}

#[test]
fn colors_are_those_of_tiles() {
    let server = start(&[("hills", &coast())], &[]);
    let json = server.get("/colors/height.json").json();
    let stops = json["stops"].as_array().unwrap();
    assert_eq!(json["unit"], "m");
    let values: Vec<f64> = stops.iter().map(|stop| stop[0].as_f64().unwrap()).collect();
    assert!(values.is_sorted_by(|a, b| a < b) && values[0] < 140.0 && *values.last().unwrap() > 160.0);
    assert!(values.contains(&140.0), "the shore is a stop");
    let grey = server.get("/colors/height.json?palette=grey").json();
    let color = grey["stops"][40][1].as_str().unwrap();
    assert!(color.len() == 7 && color[1..3] == color[3..5] && color[3..5] == color[5..7], "{color}");
    // Two palettes are two tiles.
    let [own, other] = ["", "?palette=grey"].map(|query| server.get(&format!("/tiles/height/14/8192/8192.png{query}")));
    assert!(
        own.status == 200
            && other.status == 200
            && own.body != other.body
            && own.header("etag") != other.header("etag")
    );
    let linked = server.get("/tilejson/height.json?palette=grey").json();
    assert!(linked["tiles"][0].as_str().unwrap().contains("palette=grey"));
    for (path, expect) in [
        ("/colors/height", "has no extension"),
        ("/colors/nothing.json", "no layer `nothing`"),
        ("/colors/height.json?palette=viridi", "no palette is called `viridi`; did you mean `viridis`?"),
        ("/colors/slope.json?palette=hypsometric", "applies to heights only"),
        ("/tilejson/height.json?palette=x", "no palette"),
        ("/terrarium/14/8192/8192.png?surface=ice", "`surface` must be"),
    ] {
        let reply = server.get(path);
        assert!((400..500).contains(&reply.status) && reply.text().contains(expect), "{path}: {}", reply.text());
    }
}

#[test]
fn the_surface_has_a_flat_sea_also_outside_the_world() {
    let server = start(&[("hills", &coast())], &[]);
    let heights = |query: &str| -> Vec<f64> {
        // The south-east corner of the world is in the middle of this tile.
        let reply = server.get(&format!("/terrarium/12/2048/2048.png{query}"));
        let pixels = reply.pixels();
        pixels
            .chunks(3)
            .map(|rgb| 256.0 * f64::from(rgb[0]) + f64::from(rgb[1]) + f64::from(rgb[2]) / 256.0 - 32768.0)
            .collect()
    };
    let (ground, water) = (heights(""), heights("?surface=water"));
    assert!(ground.iter().any(|height| *height < 135.0), "some ground is below the sea");
    assert!(water.iter().all(|height| *height >= 140.0));
    assert_eq!(water.last(), Some(&140.0));
    assert!(ground.iter().zip(&water).take(100).all(|(ground, water)| *water == ground.max(140.0)));
}

#[test]
fn windows_are_files_of_every_format_of_samples() {
    let server = start(&[("hills", HILLS)], &[]);
    for (name, start) in [
        ("asc", &b"ncols"[..]),
        ("exr", b"\x76\x2f\x31\x01"),
        ("glb", b"glTF"),
        ("npy", b"\x93NUMPY"),
        ("obj", b"#"),
        ("pgm", b"P5"),
        ("ply", b"ply"),
        ("png", b"\x89PNG"),
        ("stl", b""),
        ("3mf", b"PK"),
        ("tif", b"II"),
    ] {
        let reply = server.get(&format!("/window.{name}?width=64"));
        assert_eq!(reply.status, 200, "{name}: {:?}", String::from_utf8_lossy(&reply.body));
        assert!(reply.body.len() > 64 && reply.body.starts_with(start), "{name}: {:?}", &reply.body[..8]);
        assert!(reply.header("content-disposition").contains(&format!("hills.{name}")));
    }
    let world = server.get("/world.json").json();
    let formats = world["formats"].as_array().unwrap();
    assert!(
        formats.iter().all(|format| server
            .get(&format!("/window.{}?width=8&nonsense=1", format["name"].as_str().unwrap()))
            .status
            == 400)
    );
    assert_eq!(server.get("/window.geojson").status, 404);
    // A mesh has more bytes than its samples: it is refused when it does not fit.
    let small = super::client::start_within(&[("hills", HILLS)], &[], 24 << 20);
    let refused = small.get("/window.obj?cell=2");
    assert!(refused.status >= 400 && refused.text().contains("memory"), "{} {}", refused.status, refused.text());
    assert_eq!(small.get("/window.npy?width=64").status, 200);
}
