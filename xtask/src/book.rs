//! `cargo xtask book`: the documentation as a site. The program that makes it is a workspace of its own, `book/`.

use std::path::{Path, PathBuf};
use std::process::Command;

use crate::failure::{Failure, Result};
use crate::licences;
use crate::shell::{self, root, target_dir};

pub const ABOUT: &str = "make the documentation as a site: tutorial, cookbook and reference, with search";

pub const HELP: &str = "
Usage: cargo xtask book [FOLDER]

Makes the site in FOLDER, or in target/web/book, from the pages that docs/SUMMARY.md and docs/SUMMARY.zh-CN.md list. The folder is
emptied before. Then every link of the site is checked. The pages load nothing from other hosts; they open recipes in the studio for
browsers if that stands beside them, in target/web/studio.

The first run compiles mdBook into target/book.
";

/// The licence of the icons that mdBook puts into pages, those of Font Awesome Free: they are to be credited, as
/// docs/development.md does.
const ICONS: &[&str] = &["CC-BY-4.0"];

/// Makes the site.
pub fn run(args: &[String]) -> Result {
    let out = match args {
        [] => target_dir().join("web/book"),
        [folder] if !folder.starts_with('-') => PathBuf::from(folder),
        _ => return Err(Failure::usage("expected nothing or a folder")),
    };
    build(&out)
}

/// Makes the site in a folder.
pub fn build(out: &Path) -> Result {
    let out = std::path::absolute(out).map_err(|error| Failure::new(format!("no such folder: {error}")))?;
    shell::run(program().arg("build").arg(root()).arg(out))
}

/// Checks the program that makes the site: its format, its tests, and the licences of its libraries.
pub fn check() -> Result {
    shell::run(&mut shell::cargo("fmt --manifest-path book/Cargo.toml --check"))?;
    let mut tests = shell::cargo("test --quiet --locked --manifest-path book/Cargo.toml --target-dir");
    shell::run(tests.arg(target_dir().join("book")))?;
    licences::check_of(Some(&root().join("book/Cargo.toml")), ICONS)
}

/// What runs the commands and scripts of the pages.
pub struct Programs {
    /// `orogen`.
    pub orogen: PathBuf,
    /// The folder of the Python that runs scripts.
    pub bin: PathBuf,
    /// The folder of its packages.
    pub packages: PathBuf,
}

/// Runs the commands and scripts of the pages in a folder, and compares the pictures with what they draw.
pub fn follow(programs: &Programs, work: &Path) -> Result {
    shell::run(&mut commands(programs, work)?)
}

/// Writes the recipes that the pages contain as files, and the pictures that their commands draw.
pub fn write(programs: &Programs, work: &Path) -> Result {
    shell::run(program().arg("recipes").arg(root()))?;
    shell::run(commands(programs, work)?.arg("--write"))
}

fn commands(programs: &Programs, work: &Path) -> Result<Command> {
    let path = std::env::var_os("PATH").unwrap_or_default();
    let path = std::env::join_paths(std::iter::once(programs.bin.clone()).chain(std::env::split_paths(&path)));
    let path = path.map_err(|error| Failure::new(format!("the search path: {error}")))?;
    let mut command = program();
    command.env("PATH", path).env("PYTHONPATH", &programs.packages);
    command.arg("commands").arg(root()).arg(&programs.orogen).arg(work);
    Ok(command)
}

/// The program that makes the site.
fn program() -> Command {
    let mut command = shell::cargo("run --quiet --locked --manifest-path book/Cargo.toml --target-dir");
    command.arg(target_dir().join("book")).arg("--");
    command
}
