//! Adds a noise, a filter, a format and a preset to a copy of the tree, as described in docs/development.md. Checks
//! that the copy compiles, and that the checks list everything that is still missing.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use crate::failure::{Failure, Result, on_file};
use crate::shell::{self, cargo, program, run as sh};
use crate::{codegen, output};

/// New files, and their templates in xtask/templates.
const FILES: [(&str, &str); 4] = [
    ("crates/orogen-ops/src/filter/added.rs", include_str!("../templates/filter.rs")),
    ("crates/orogen-ops/src/filter/added.wgsl", include_str!("../templates/filter.wgsl")),
    ("crates/orogen-jobs/src/export/formats/added.rs", include_str!("../templates/format.rs")),
    ("crates/orogen-engine/recipes/added-preset.toml", include_str!("../templates/preset.toml")),
];

/// The table of bases, and a row of it.
const BASES: &str = "crates/orogen-noise/src/basis.rs";
const BASIS: &str = include_str!("../templates/basis.txt");

/// The messages of the check of the lists about missing things afterwards.
const MISSING: [&str; 10] = [
    "crates/orogen-noise/tests/goldens.txt does not have `added-noise`: run `cargo xtask bless golden`",
    "golden/ops.txt does not have `added-filter`: run `cargo xtask bless golden`",
    "docs/ops/README.md does not have `added-filter`: add its node, command and picture, and run `cargo xtask gallery book`",
    "docs/formats.md or docs/meshes.md or docs/water.md does not have `added`: add a row that describes it",
    "golden/presets.txt does not have `added-preset`: run `cargo xtask bless golden`",
    "docs/images/added-preset.png is missing: run `cargo xtask gallery added-preset`",
    "docs/images/added-preset-hillshade.png is missing: run `cargo xtask gallery added-preset`",
    "crates/orogen-studio/assets/presets/added-preset.png is missing: run `cargo xtask gallery added-preset`",
    "docs/gallery.md does not have `added-preset`: run `cargo xtask gallery added-preset`",
    "docs/resolution.md does not have `added-preset`: run `cargo xtask resolution`",
];

/// Adds the things to a copy of the tree and compiles it.
pub fn check() -> Result {
    let root = added()?;
    sh(&mut in_copy(&root, "check --quiet --package orogen-cli --package orogen-features --no-default-features"))
}

/// Makes the copy with everything added, a workspace in the target folder. Only changed files are written, so that
/// cargo recompiles only these.
fn added() -> Result<PathBuf> {
    let folder = shell::target_dir().join("adding");
    let (staged, copy) = (folder.join("staged"), folder.join("copy"));
    shell::empty_dir(&staged)?;
    copy_tree(&staged)?;
    add(&staged.join("tree"))?;
    std::fs::create_dir_all(&copy).map_err(|e| on_file("create", &copy, &e))?;
    let mut stale: BTreeSet<PathBuf> = files(&copy)?.into_iter().collect();
    for file in files(&staged)? {
        stale.remove(&file);
        replace(&staged.join(&file), &copy.join(&file))?;
    }
    for file in stale {
        std::fs::remove_file(copy.join(&file)).map_err(|e| on_file("delete", &file, &e))?;
    }
    Ok(copy)
}

/// Copies the files that git does not ignore from the folders that codegen and the libraries need. They are one folder
/// deeper than in the original, because cargo would treat packages with the same relative path as the same package.
fn copy_tree(to: &Path) -> Result {
    let folders = ["crates", "docs", "golden", "fuzz/corpus/dem", "xtask/features", "clippy.toml", "rustfmt.toml"];
    let mut git = program("git");
    let listed = git.args(["ls-files", "--cached", "--others", "--exclude-standard"]).args(folders);
    for file in shell::capture(listed)?.lines().filter(|file| shell::root().join(file).is_file()) {
        replace(&shell::root().join(file), &to.join("tree").join(file))?;
    }
    let manifest = shell::read(&shell::root().join("Cargo.toml"))?;
    shell::write(&to.join("Cargo.toml"), &workspace(&manifest)?)?;
    replace(&shell::root().join("Cargo.lock"), &to.join("Cargo.lock"))
}

/// The manifest of the workspace with the folder `tree`.
fn workspace(manifest: &str) -> Result<String> {
    let members = manifest.lines().find(|line| line.starts_with("members = "));
    let members = members.ok_or_else(|| Failure::new("Cargo.toml has no line of members"))?;
    let manifest = manifest.replacen(members, "members = [\"crates/*\", \"tree/xtask/features\"]", 1);
    Ok(manifest.replace("\"crates/", "\"tree/crates/"))
}

/// Adds the things to the tree at `root`. The checks must fail first, then list everything that is missing.
fn add(root: &Path) -> Result {
    for (file, text) in FILES {
        shell::write(&root.join(file), text)?;
    }
    let bases = shell::read(&root.join(BASES))?;
    let table = bases.split_once("\nbases! {\n").and_then(|(head, rest)| Some((head, rest.split_once("\n}\n")?)));
    let (head, (rows, rest)) =
        table.ok_or_else(|| Failure::new(format!("{BASES}: the table `bases!` is not found")))?;
    let table = format!("{head}\nbases! {{\n{rows}\n{}\n}}\n{rest}", BASIS.trim_end());
    shell::write(&root.join(BASES), &table)?;
    let stale = codegen::lists(root, true).err().map(|failure| failure.message().to_owned()).unwrap_or_default();
    if !stale.contains("is not current; run `cargo xtask codegen`") {
        return Err(Failure::new(format!("new files are not noticed, but: {stale}")));
    }
    codegen::lists(root, false)?;
    let missing = codegen::lists(root, true).err().map(|failure| failure.message().to_owned()).unwrap_or_default();
    let said: BTreeSet<&str> = missing.lines().skip(1).map(str::trim).collect();
    let expected = BTreeSet::from(MISSING);
    if said != expected {
        return Err(Failure::new(format!("the check of lists says\n{missing}\ninstead of\n{MISSING:#?}")));
    }
    output::line(format_args!("    {} missing things are named", said.len()));
    Ok(())
}

/// Cargo in the copy. Arguments after `--` are passed to the program that it runs.
fn in_copy(copy: &Path, args: &str) -> std::process::Command {
    let (args, others) = args.split_once(" -- ").unwrap_or((args, ""));
    let mut command = cargo(args);
    command.arg("--manifest-path").arg(copy.join("Cargo.toml"));
    command.arg("--target-dir").arg(shell::target_dir());
    if !others.is_empty() {
        command.arg("--").args(others.split_whitespace());
    }
    command
}

/// Copies a file, if it differs.
fn replace(from: &Path, to: &Path) -> Result {
    let bytes = std::fs::read(from).map_err(|e| on_file("read", from, &e))?;
    if std::fs::read(to).is_ok_and(|current| current == bytes) {
        return Ok(());
    }
    let folder = to.parent().unwrap_or(to);
    std::fs::create_dir_all(folder).map_err(|e| on_file("create", folder, &e))?;
    std::fs::write(to, bytes).map_err(|e| on_file("write", to, &e))
}

/// All files of a folder, relative to it.
fn files(folder: &Path) -> Result<Vec<PathBuf>> {
    let (mut found, mut open) = (Vec::new(), vec![folder.to_owned()]);
    while let Some(next) = open.pop() {
        for entry in std::fs::read_dir(&next).map_err(|e| on_file("read", &next, &e))? {
            let path = entry.map_err(|e| on_file("read", &next, &e))?.path();
            match path.is_dir() {
                true => open.push(path),
                false => found.extend(path.strip_prefix(folder).map(Path::to_owned)),
            }
        }
    }
    Ok(found)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    #[ignore = "long: compiles a copy of the tree and runs its goldens and laws"]
    fn what_is_added_works_and_its_goldens_are_blessed() {
        let copy = added().expect("added");
        let to = shell::target_dir().join("adding/heights.added");
        let export = "run --quiet --package orogen-cli -- export added-preset --size 32 --force -o";
        sh(in_copy(&copy, export).arg(&to)).expect("the preset is exported to the format");
        assert_eq!(std::fs::metadata(&to).expect("a file").len(), 4 * 32 * 32);
        let suite = "test --quiet --no-fail-fast --package orogen --package orogen-noise --test suite --";
        let golden = || in_copy(&copy, &format!("{suite} golden"));
        let unblessed = golden().output().expect("started");
        let unblessed = String::from_utf8_lossy(&unblessed.stdout).into_owned();
        for expect in ["added-filter is not in golden/ops.txt", "cargo xtask bless"] {
            assert!(unblessed.contains(expect), "{unblessed}");
        }
        sh(golden().args(["--test-threads", "1"]).env("OROGEN_BLESS", "1")).expect("blessed");
        sh(&mut golden()).expect("the goldens are what was blessed");
        sh(&mut in_copy(&copy, &format!("{suite} laws"))).expect("the laws hold");
        let missing = codegen::lists(&copy.join("tree"), true).expect_err("pictures are missing").message().to_owned();
        assert!(missing.contains("gallery added-preset") && !missing.contains("bless"), "{missing}");
    }
}
