//! Every target on the files of `fuzz/corpus` and on changes of them, which are the same in every run. `cargo xtask
//! fuzz` finds other inputs; these tests need no other compiler and take seconds.
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test that fails panics")]

mod change;
mod lists;

use orogen_fuzz_targets::TARGETS;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};

/// A test for each target, with the number of changed inputs: each takes a second or two of one core.
macro_rules! replays {
    ($($target:ident: $changes:literal,)*) => {
        /// The targets that are tested.
        const REPLAYED: &[&str] = &[$(stringify!($target)),*];

        $(
            #[test]
            fn $target() {
                replay(stringify!($target), $changes);
            }
        )*
    };
}

replays! {
    author_map: 4000,
    dem: 60000,
    drawing: 100000,
    journal: 2000,
    network: 2000,
    options: 30000,
    palette: 60000,
    place: 40000,
    plan: 60000,
    points: 60000,
    recipe: 40000,
    sidecar: 8000,
    solution: 8000,
    tileset: 40000,
    zarr: 8000,
}

/// The folder `fuzz`.
fn fuzz() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

/// The names of the files in a folder, or of the folders, sorted.
fn names(folder: &Path, are_files: bool) -> Vec<String> {
    let paths = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    let chosen = paths.filter(|path| path.is_file() == are_files);
    let mut names: Vec<String> = chosen.map(|path| path.file_name().unwrap().to_str().unwrap().to_owned()).collect();
    names.sort();
    names
}

/// Runs a target on the files of its corpus, and on this number of changes of them.
fn replay(target: &str, changes: u64) {
    let (_, run) = TARGETS.iter().find(|(name, _)| *name == target).unwrap();
    let folder = fuzz().join("corpus").join(target);
    let names = names(&folder, true);
    let corpus: Vec<Vec<u8>> = names.iter().map(|name| std::fs::read(folder.join(name)).unwrap()).collect();
    let check = |name: &str, seed: Option<u64>, input: &[u8]| {
        if catch_unwind(AssertUnwindSafe(|| run(input))).is_err() {
            let change = seed.map_or_else(|| "as it is".to_owned(), |seed| format!("with the change of seed {seed}"));
            panic!("the target `{target}` fails on fuzz/corpus/{target}/{name} {change}: {:?}", Excerpt(input));
        }
    };
    for (name, input) in names.iter().zip(&corpus) {
        check(name, None, input);
    }
    for seed in 0..changes {
        let which = seed as usize % corpus.len();
        check(&names[which], Some(seed), &change::changed(&corpus, which, seed));
    }
}

/// The beginning of an input, for messages.
struct Excerpt<'a>(&'a [u8]);

impl std::fmt::Debug for Excerpt<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        const MOST: usize = 300;
        write!(f, "b\"{}\"", self.0[..self.0.len().min(MOST)].escape_ascii())?;
        match self.0.len() {
            ..=MOST => Ok(()),
            length => write!(f, "... of {length} bytes"),
        }
    }
}
