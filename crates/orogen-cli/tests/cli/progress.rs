//! Progress for other programs, and files after a cancelled run.

use crate::harness::{Folder, share};

const RIVERS: &str = r#"
orogen = 1
[world]
size = [6000, 4000]
cell = 50.0
[nodes.land]
op = "fbm"
wavelength = 3000
[nodes.metres]
op = "remap"
source = "land"
to = [50, 400]
[nodes.terrain]
op = "stream-power"
source = "metres"
steps = 4
[outputs]
height = "terrain"
"#;

/// The shares that a command reports.
fn shares(folder: &Folder, arguments: &[&str]) -> Vec<f64> {
    let outcome = folder.good(&[arguments, &["--progress", "json"]].concat());
    outcome.err.lines().filter_map(share).collect()
}

#[test]
fn every_command_reports_one_share_that_only_grows_to_the_end() {
    let folder = Folder::new();
    folder.write("rivers.toml", RIVERS);
    folder.good(&["export", "rivers.toml", "-o", "place.tif"]);
    let commands: [&[&str]; 17] = [
        &["generate", "rivers.toml", "-o", "out"],
        &["export", "rivers.toml", "-o", "land.tif"],
        &["export", "rivers.toml", "--layer", "normal", "-o", "normal.png"],
        &["export", "rivers.toml", "-o", "full.glb", "--lods", "2"],
        &["export", "rivers.toml", "-o", "few.stl", "--max-error", "2"],
        &["map", "rivers.toml", "-o", "map.png"],
        &["analyze", "rivers.toml", "-o", "page.png"],
        &["locate", "rivers.toml", "--largest", "height"],
        &["render", "rivers.toml", "--size", "120", "--turntable", "3", "-o", "around.gif"],
        &["grow", "rivers.toml", "--frames", "9", "-o", "grow.gif"],
        &["build", "rivers.toml", "-o", "built.tif"],
        &["noise", "perlin", "--size", "64", "--frames", "8", "-o", "noise.png"],
        &["compare", "-o", "compare.png"],
        &["tilemap", "rivers.toml", "-o", "tiles"],
        &["blocks", "rivers.toml", "-o", "world"],
        &["blocks", "rivers.toml", "-o", "blocks.glb"],
        &["refine", "place.tif", "--cell", "20", "-o", "fine.tif"],
    ];
    for command in commands {
        let shares = shares(&folder, command);
        assert!(shares.windows(2).all(|pair| pair[0] <= pair[1]), "{command:?}: {shares:?}");
        assert_eq!(shares.last(), Some(&1.0), "{command:?}: {shares:?}");
    }
    // No progress by default.
    assert_eq!(folder.good(&["generate", "rivers.toml", "-o", "out"]).err, "");
    assert!(folder.good(&["generate", "rivers.toml", "-o", "out", "--progress", "plain"]).err.ends_with("100 %\n"));
}

#[test]
fn arrays_that_no_disk_holds_are_refused_before_they_are_begun() {
    let folder = Folder::new();
    folder.bad(
        &["noise", "perlin", "--volume", "100000000", "--size", "4096", "-o", "block.npy"],
        1,
        "not enough disk space",
    );
    assert_eq!(folder.names(""), [] as [&str; 0]);
}

#[cfg(unix)]
#[test]
fn a_block_that_is_interrupted_leaves_nothing() {
    use crate::harness::Running;
    let folder = Folder::new();
    let arguments = ["noise", "worley", "--volume", "3000", "--size", "512", "-o", "block.npy"];
    let mut running = Running::start_and_wait(&folder, &arguments);
    assert_eq!(folder.names("").len(), 2, "the file and its lock");
    running.signal("-INT");
    let (code, said) = running.ended();
    assert_eq!(code, Some(130), "{said:?}");
    assert_eq!(folder.names(""), [] as [&str; 0]);
}
