//! Journals of builds: any bytes are a journal or refused, and a build that is resumed from any journal ends with the same files.
//!
//! The first byte of the input chooses a file that is lost before the build is resumed, the others change the journal. Checksums are not verified.
#![no_main]

mod edits;
mod scratch;

use edits::edited;
use libfuzzer_sys::fuzz_target;
use orogen::builder::journal::JournalState;
use orogen::builder::run::{Build, Start};
use orogen::builder::spec::{BuildSpec, Form};
use orogen::file::OutputPolicy;
use orogen::{Options, Progress, Recipe, Window, World};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::LazyLock;

const RECIPE: &str = "orogen = 1\n[nodes.a]\nop = \"fbm\"\n[outputs]\nheight = \"a\"\n";

struct Site {
    world: World,
    out: PathBuf,
    /// The journal of an undisturbed build: its first line, and the others.
    first: Vec<u8>,
    lines: Vec<u8>,
    /// Its files.
    files: BTreeMap<PathBuf, Vec<u8>>,
}

fn spec() -> BuildSpec {
    BuildSpec::new(Form::Zarr, Window::new(20, 17, 30.0)).with_tile(16)
}

fn files(folder: &Path, into: &mut BTreeMap<PathBuf, Vec<u8>>) {
    for entry in std::fs::read_dir(folder).expect("a folder") {
        let path = entry.expect("an entry").path();
        match path.is_dir() {
            true => files(&path, into),
            false => drop(into.insert(path.clone(), std::fs::read(&path).expect("a file"))),
        }
    }
}

impl Site {
    fn resume(&self, start: Start) -> orogen::Result<()> {
        let build = Build::new(&self.world, &spec(), &OutputPolicy::default().output(&self.out)?)?;
        let _ = build.disk();
        build.run(start, &Progress::none()).map(drop)
    }
}

static SITE: LazyLock<Site> = LazyLock::new(|| {
    let out = scratch::path(".zarr");
    let recipe = Recipe::parse(RECIPE, "it").expect("a recipe");
    let options = Options { threads: Some(1), ..Options::default() };
    let world = World::with_options(recipe, options).expect("a world");
    let mut site = Site { world, out, first: Vec::new(), lines: Vec::new(), files: BTreeMap::new() };
    site.resume(Start::Fresh).expect("a build");
    let journal = std::fs::read(journal(&site.out)).expect("a journal");
    let end = journal.iter().position(|byte| *byte == b'\n').expect("a line");
    site.lines = journal[end + 1..].to_vec();
    site.first = journal[..end + 1].to_vec();
    files(&site.out, &mut site.files);
    site
});

fn journal(out: &Path) -> PathBuf {
    out.with_extension("zarr.build").join("journal")
}

fuzz_target!(|bytes: &[u8]| {
    let Some((&remove, edits)) = bytes.split_first() else { return };
    let _ = JournalState::parse(edits);
    let site = &*SITE;
    let whole = [&site.first[..], &edited(&site.lines, edits)].concat();
    let state = JournalState::parse(&whole).expect("the first line is intact");
    if state.records.is_empty() && state.finished.is_none() {
        return;
    }
    std::fs::write(journal(&site.out), &whole).expect("the journal is written");
    if let Some((path, _)) = site.files.iter().nth(usize::from(remove)) {
        std::fs::remove_file(path).expect("a file of the result is removed");
    }
    // A second first line of another build may be refused; then a new build follows.
    if site.resume(Start::Resume).is_err() {
        site.resume(Start::Force).expect("a new build");
    }
    let mut now = BTreeMap::new();
    files(&site.out, &mut now);
    assert!(now == site.files, "{}", String::from_utf8_lossy(&whole));
});
