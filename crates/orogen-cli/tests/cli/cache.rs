//! The cache of solutions.

use crate::harness::Folder;

/// A world whose normalisation takes longer than the minimum time for the cache.
pub const SLOW: &str = r#"
orogen = 1
[world]
size = 15000
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
        folder.good(&[&["export", "slow.toml", "-q", "--window", "5,6,4,3", "-o", out][..], options].concat());
        folder.read(out)
    };
    let first = export("a.npy", &["--cache", "kept"]);
    assert_eq!(folder.names("kept").len(), 1, "one solution");
    assert_eq!(export("b.npy", &["--cache", "kept"]), first);
    // The folder from the environment; a damaged entry is detected and recomputed.
    let entry = folder.path("kept").join(&folder.names("kept")[0]);
    let sound = std::fs::read(&entry).unwrap();
    std::fs::write(&entry, &sound[..sound.len() - 1]).unwrap();
    let arguments = ["export", "slow.toml", "-q", "--window", "5,6,4,3", "-o", "c.npy"];
    assert!(folder.command(&arguments).env("OROGEN_CACHE", "kept").status().unwrap().success());
    assert!(folder.read("c.npy") == first && std::fs::read(&entry).unwrap() == sound);
    assert_eq!(export("e.npy", &["--cache", "small", "--cache-limit", "10"]), first);
    assert!(!folder.path("small").exists(), "what is larger than the limit is not kept");
    folder.bad(&["export", "slow.toml", "-o", "f.npy", "--no-cache", "--cache", "x"], 2, "cannot be used with");
}
