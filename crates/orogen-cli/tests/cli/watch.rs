//! `orogen generate --watch`.

use crate::harness::{Folder, SMALL};
use std::io::{BufRead, BufReader};
use std::process::{Child, Stdio};
use std::sync::mpsc::{Receiver, channel};
use std::time::{Duration, Instant};

/// A watching process, ended when dropped.
struct Watcher {
    child: Child,
    lines: Receiver<String>,
}

impl Watcher {
    fn start(folder: &Folder, arguments: &[&str]) -> Watcher {
        let mut child = folder.command(arguments).stdout(Stdio::null()).stderr(Stdio::piped()).spawn().unwrap();
        let stderr = BufReader::new(child.stderr.take().unwrap());
        let (sender, lines) = channel();
        std::thread::spawn(move || stderr.lines().map_while(Result::ok).try_for_each(|line| sender.send(line)));
        Watcher { child, lines }
    }

    /// Waits until the process prints a line that contains `expect`.
    fn says(&self, expect: &str) {
        let until = Instant::now() + Duration::from_secs(60);
        let mut said = Vec::new();
        while let Ok(line) = self.lines.recv_timeout(until.saturating_duration_since(Instant::now())) {
            assert!(!line.contains("panicked"), "{line}");
            if line.contains(expect) {
                return;
            }
            said.push(line);
        }
        panic!("never said {expect:?}, but {said:?}");
    }
}

impl Drop for Watcher {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

#[test]
fn it_remakes_what_changes_and_outlives_mistakes() {
    let folder = Folder::with_small();
    let watcher = Watcher::start(&folder, &["generate", "small.toml", "--watch"]);
    watcher.says("watching small.toml");
    let first = folder.json("out/summary.json")["sha256"].clone();
    folder.write("small.toml", SMALL.replace("octaves", "octavs"));
    watcher.says("did you mean `octaves`?");
    watcher.says("watching small.toml");
    assert_eq!(folder.json("out/summary.json")["sha256"], first);
    folder.write("small.toml", SMALL.replace("seed = 3", "seed = 4"));
    watcher.says("watching small.toml");
    assert_eq!(folder.json("out/summary.json")["seed"], 4);
    std::fs::remove_file(folder.path("small.toml")).unwrap();
    watcher.says("cannot read the recipe small.toml");
    watcher.says("watching small.toml");
    folder.write("small.toml", SMALL);
    watcher.says("watching small.toml");
    assert_eq!(folder.json("out/summary.json")["sha256"], first);
}

#[test]
fn a_change_cancels_work_that_is_outdated() {
    let folder = Folder::new();
    folder.write("small.toml", SMALL.replace("cell = 10", "cell = 0.05").replace("octaves = 4", "octaves = 24"));
    let watcher = Watcher::start(&folder, &["generate", "small.toml", "--watch", "--memory", "100GiB"]);
    std::thread::sleep(Duration::from_millis(500));
    folder.write("small.toml", SMALL);
    watcher.says("watching small.toml");
    // A finished first run would have printed so, and its 12 800 samples per row would be here.
    assert_eq!(folder.json("out/summary.json")["width"], 64);
}

#[test]
fn only_files_can_be_watched() {
    Folder::new().bad(&["generate", "hills", "--watch"], 2, "orogen new NAME --preset hills");
    Folder::new().bad(&["generate", "--watch"], 2, "`alpine` is a preset");
}
