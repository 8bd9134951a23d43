//! `orogen generate --watch`.

use crate::harness::{Folder, Running, SMALL, slow};

#[test]
fn it_remakes_what_changes_and_outlives_mistakes() {
    let folder = Folder::with_small();
    let watcher = Running::start(&folder, &["generate", "small.toml", "--watch"]);
    watcher.says("watching small.toml");
    let first = folder.json("out/summary.json")["sha256"].clone();
    folder.replace("small.toml", SMALL.replace("octaves", "octavs"));
    watcher.says("did you mean `octaves`?");
    watcher.says("watching small.toml");
    assert_eq!(folder.json("out/summary.json")["sha256"], first);
    folder.replace("small.toml", SMALL.replace("seed = 3", "seed = 4"));
    watcher.says("watching small.toml");
    assert_eq!(folder.json("out/summary.json")["seed"], 4);
    std::fs::remove_file(folder.path("small.toml")).unwrap();
    watcher.says("cannot read the recipe small.toml");
    watcher.says("watching small.toml");
    folder.replace("small.toml", SMALL);
    watcher.says("watching small.toml");
    assert_eq!(folder.json("out/summary.json")["sha256"], first);
}

#[test]
fn a_change_cancels_work_that_is_outdated() {
    let folder = Folder::new();
    folder.write("small.toml", slow().replace("cell = 10", "cell = 0.05"));
    let arguments = ["generate", "small.toml", "--watch", "--memory", "100GiB"];
    let watcher = Running::start_and_wait(&folder, &arguments);
    folder.replace("small.toml", SMALL);
    watcher.says("watching small.toml");
    // If the first run had finished, it would have printed a message, and the summary would have 12 800 samples per
    // row.
    assert_eq!(folder.json("out/summary.json")["width"], 64);
}

#[test]
fn only_files_can_be_watched() {
    Folder::new().bad(&["generate", "hills", "--watch"], 2, "orogen new NAME --preset hills");
    Folder::new().bad(&["generate", "--watch"], 2, "`alpine` is a preset");
}
