//! The cache of solutions and tiles of levels.

use crate::harness::Folder;

/// A world whose normalisation is estimated at some times the minimum time for the cache.
pub const SLOW: &str = r#"
orogen = 1
[world]
size = 20000
cell = 10
[nodes.noise]
op = "fbm"
[nodes.soft]
op = "blur"
source = "noise"
radius = 700
[nodes.land]
op = "normalise"
source = "soft"
[outputs]
height = "land"
"#;

#[test]
fn a_slow_solution_is_kept_where_it_was_asked_for_and_changes_nothing() {
    let folder = Folder::new();
    folder.write("slow.toml", SLOW);
    let export = |out: &str, options: &[&str]| {
        let export = ["export", "slow.toml", "-q", "--window", "5,6,4,3", "--threads", "1", "-o", out];
        folder.good(&[&export[..], options].concat());
        folder.read(out)
    };
    let first = export("a.npy", &["--cache", "kept"]);
    assert_eq!(folder.names("kept").len(), 1, "one solution");
    assert_eq!(export("b.npy", &["--cache", "kept"]), first);
    // The folder from the environment; a damaged entry is detected and recomputed.
    let entry = folder.path("kept").join(&folder.names("kept")[0]);
    let sound = std::fs::read(&entry).unwrap();
    std::fs::write(&entry, &sound[..sound.len() - 1]).unwrap();
    let arguments = ["export", "slow.toml", "-q", "--window", "5,6,4,3", "--threads", "1", "-o", "c.npy"];
    assert!(folder.command(&arguments).env("OROGEN_CACHE", "kept").status().unwrap().success());
    assert!(folder.read("c.npy") == first && std::fs::read(&entry).unwrap() == sound);
    assert_eq!(export("e.npy", &["--cache", "small", "--cache-limit", "10"]), first);
    assert!(!folder.path("small").exists(), "what is larger than the limit is not kept");
    folder.bad(&["export", "slow.toml", "-o", "f.npy", "--no-cache", "--cache", "x"], 2, "cannot be used with");
}

/// Land of few levels.
const LEVELS: &str = r#"
orogen = 1
[world]
cell = 60
[nodes.land]
op = "continents"
halvings = 3
[outputs]
height = "land"
"#;

#[test]
fn processes_at_once_share_tiles_of_levels_and_write_the_same_bytes() {
    let folder = Folder::new();
    folder.write("land.toml", LEVELS);
    let arguments = |out: &'static str, options: &[&'static str]| {
        let export =
            ["export", "land.toml", "-q", "--window=-20,-30,40,50", "--cell", "60", "--threads", "1", "-o", out];
        [&export[..], options].concat()
    };
    folder.good(&arguments("plain.npy", &["--no-cache"]));
    let plain = folder.read("plain.npy");
    let outs = ["a.npy", "b.npy", "c.npy"];
    let running = outs.map(|out| folder.command(&arguments(out, &["--cache", "kept"])).spawn().unwrap());
    running.into_iter().for_each(|mut run| assert!(run.wait().unwrap().success()));
    assert!(outs.iter().all(|out| folder.read(out) == plain));
    let names = folder.names("kept");
    assert!(names.len() > 4 && names.iter().all(|name| name.ends_with(".solved")), "{names:?}");
    folder.good(&arguments("d.npy", &["--cache", "kept"]));
    assert!(folder.read("d.npy") == plain && folder.names("kept") == names);
    let told = folder.good(&["cache", "list", "--cache", "kept"]).text().to_string();
    assert!(told.contains(&format!("kept: 0 solutions and {} tiles, ", names.len())), "{told}");
    let json: serde_json::Value =
        serde_json::from_slice(&folder.good(&["cache", "list", "--cache", "kept", "--json"]).out).unwrap();
    assert_eq!(
        (json["tiles"]["count"].as_u64(), json["solutions"].as_array().map(Vec::len)),
        (Some(names.len() as u64), Some(0))
    );
    assert_eq!(json["tiles"]["bytes"], json["bytes"]);
    for name in &names {
        let path = folder.path("kept").join(name);
        let mut bytes = std::fs::read(&path).unwrap();
        bytes[5000] ^= 1;
        std::fs::write(&path, bytes).unwrap();
    }
    folder.good(&arguments("e.npy", &["--cache", "kept"]));
    assert!(folder.read("e.npy") == plain && folder.names("kept") == names);
    let told = folder.good(&["cache", "clear", "--cache", "kept"]).text().to_string();
    assert!(told.starts_with(&format!("kept: 0 solutions and {} tiles removed, ", names.len())), "{told}");
    folder.good(&arguments("f.npy", &["--cache", "small", "--cache-limit", "10"]));
    assert!(
        folder.read("f.npy") == plain && !folder.path("small").exists(),
        "what is larger than the limit is not kept"
    );
}
