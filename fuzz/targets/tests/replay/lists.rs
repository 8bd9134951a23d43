//! The lists of targets agree.

use crate::{REPLAYED, fuzz, names};
use orogen_fuzz_targets::TARGETS;

#[test]
fn every_list_names_all_targets() {
    let targets: Vec<&str> = TARGETS.iter().map(|(name, _)| *name).collect();
    assert!(targets.is_sorted());
    assert_eq!(REPLAYED, targets);
    assert_eq!(names(&fuzz().join("corpus"), false), targets);
    let entries = names(&fuzz().join("fuzz_targets"), true);
    assert_eq!(entries, targets.iter().map(|name| format!("{name}.rs")).collect::<Vec<_>>());
    let manifest = std::fs::read_to_string(fuzz().join("Cargo.toml")).unwrap();
    let bins = manifest.split("[[bin]]").skip(1);
    let mut bins: Vec<&str> =
        bins.map(|bin| bin.lines().find_map(|line| line.strip_prefix("name = ")).unwrap().trim_matches('"')).collect();
    bins.sort_unstable();
    assert_eq!(bins, targets);
    for name in targets {
        assert!(manifest.contains(&format!("path = \"fuzz_targets/{name}.rs\"")), "{name}");
        let entry = std::fs::read_to_string(fuzz().join("fuzz_targets").join(format!("{name}.rs"))).unwrap();
        assert!(entry.contains(&format!("orogen_fuzz_targets::{name}::run(")), "{name}");
    }
}
