//! Journals of builds: any bytes are a journal or refused, and a build that is resumed from any journal ends with the
//! same files.
//!
//! The first byte of the input chooses a file that is lost before the build is resumed, the others change the journal.
//! Each line then gets its right checksum, so that the target reaches what it protects.

use crate::edits::edited;
use crate::scratch::Scratch;
use orogen::builder::journal::JournalState;
use orogen::builder::run::Start;
use orogen::builder::{Build, BuildSpec, Form};
use orogen::io::file::OutputPolicy;
use orogen::{Options, Progress, Recipe, Window, World};
use sha2::{Digest, Sha256};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// A world that takes no time.
const RECIPE: &str = "orogen = 1\n[nodes.a]\nop = \"fbm\"\n[outputs]\nheight = \"a\"\n";

/// Number of digits of the checksum of a line, after a tab.
const CHECK: usize = 16;

/// A build that is complete.
struct Site {
    world: World,
    /// The folder of everything.
    folder: Scratch,
    /// The journal of an undisturbed build: its first line, and the others.
    first: Vec<u8>,
    lines: Vec<u8>,
    /// Its files.
    files: BTreeMap<PathBuf, Vec<u8>>,
}

/// Two rows of tiles.
fn spec() -> BuildSpec {
    BuildSpec::new(Form::Zarr, Window::new(20, 17, 30.0)).with_tile(16)
}

/// Adds all files of a folder, with their bytes.
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
    /// Makes the build.
    fn new() -> Site {
        let recipe = Recipe::parse(RECIPE, "it").expect("a recipe");
        let options = Options { threads: Some(1), ..Options::default() };
        let world = World::with_options(recipe, options).expect("a world");
        let folder = Scratch::new("journal");
        let mut site = Site { world, folder, first: Vec::new(), lines: Vec::new(), files: BTreeMap::new() };
        site.resume(Start::Fresh).expect("a build");
        let journal = std::fs::read(site.journal()).expect("a journal");
        let end = journal.iter().position(|byte| *byte == b'\n').expect("a line");
        site.lines = journal[end + 1..].to_vec();
        site.first = journal[..end + 1].to_vec();
        files(&site.out(), &mut site.files);
        site
    }

    /// The result.
    fn out(&self) -> PathBuf {
        self.folder.join("out.zarr")
    }

    /// The journal beside the result.
    fn journal(&self) -> PathBuf {
        self.folder.join("out.zarr.build/journal")
    }

    /// Begins or goes on with the build.
    fn resume(&self, start: Start) -> orogen::Result<()> {
        let build = Build::new(&self.world, &spec(), &OutputPolicy::default().output(self.out())?)?;
        let _ = build.disk();
        build.run(start, &Progress::none()).map(drop)
    }
}

thread_local! {
    /// The build, once for each thread.
    static SITE: Site = Site::new();
}

/// The lines of a journal, each with its right checksum.
fn signed(lines: &[u8]) -> Vec<u8> {
    let sign = |line: &[u8]| {
        let mut line = line.to_vec();
        if let Some(end) = line.len().checked_sub(CHECK + 1).filter(|end| line[*end] == b'\t') {
            let digits: String = Sha256::digest(&line[..end]).iter().map(|byte| format!("{byte:02x}")).collect();
            line[end + 1..].copy_from_slice(&digits.as_bytes()[..CHECK]);
        }
        line
    };
    lines.split(|byte| *byte == b'\n').map(sign).collect::<Vec<_>>().join(&b'\n')
}

/// Runs the target on an input.
pub fn run(bytes: &[u8]) {
    let Some((&remove, edits)) = bytes.split_first() else { return };
    let _ = JournalState::parse(&signed(edits));
    SITE.with(|site| resumed(site, remove, edits));
}

/// Resumes the build from a changed journal, without one of its files.
fn resumed(site: &Site, remove: u8, edits: &[u8]) {
    let whole = [&site.first[..], &signed(&edited(&site.lines, edits))].concat();
    let state = JournalState::parse(&whole).expect("the first line is intact");
    if state.records.is_empty() && state.finished.is_none() {
        return;
    }
    std::fs::write(site.journal(), &whole).expect("the journal is written");
    if let Some((path, _)) = site.files.iter().nth(usize::from(remove)) {
        std::fs::remove_file(path).expect("a file of the result is removed");
    }
    // A second first line of another build may be refused; then a new build follows.
    if site.resume(Start::Resume).is_err() {
        site.resume(Start::Force).expect("a new build");
    }
    let mut now = BTreeMap::new();
    files(&site.out(), &mut now);
    assert!(now == site.files, "{}", String::from_utf8_lossy(&whole));
}
