//! Checks that every crate compiles from its own published archive, and that the libraries are documented.

use std::path::{Path, PathBuf};

use crate::compiled::{LIBRARIES, WINDOW};
use crate::failure::{Failure, Result, on_file};
use crate::front_door;
use crate::shell::{self, cargo, program, run as sh};

/// Packs every crate as it would be published, unpacks the archives and compiles only their content. Paths that lead
/// out of a crate's folder, and missing files, therefore fail. Documents the libraries from the archives, too.
///
/// `cargo package` itself would generate code for each crate and its dependencies. Here no code is generated, and
/// profile, features and target folder are the same as for clippy, so that dependencies are not compiled again. The
/// crates for windows and graphics cards are not compiled here, see [`check_window`].
pub fn check() -> Result {
    let folder = shell::target_dir().join("packages");
    // Removes archives of other versions.
    shell::empty_dir(&folder.join("package"))?;
    // The Python package is published as a wheel.
    let left_out = "--exclude xtask --exclude orogen-bench --exclude orogen-features --exclude orogen-fuzz-targets \
        --exclude orogen-py";
    let pack = format!("package --quiet --workspace {left_out} --allow-dirty --no-verify");
    sh(cargo(&pack).arg("--target-dir").arg(&folder))?;
    let unpacked = unpacked();
    shell::empty_dir(&unpacked)?;
    let crates = unpack(&folder.join("package"), &unpacked)?;
    write_features(&unpacked, &crates)?;
    write_workspace(&unpacked, &crates)?;
    in_archives(&format!("check --quiet {LIBRARIES} --lib --bins"), "")?;
    // Without the binary `orogen`, whose pages would overwrite the pages of the library of the same name, and without
    // the studio.
    let undocumented = "--exclude orogen-cli --exclude orogen-studio --exclude orogen-features";
    // Pages of items that no longer exist would remain.
    let pages = shell::target_dir().join("doc");
    shell::empty_dir(&pages)?;
    in_archives(&format!("doc --quiet {LIBRARIES} --no-deps {undocumented}"), "-D warnings")?;
    front_door::check(&pages)
}

/// Compiles the archives of the crates for windows and graphics cards. [`check`] must have unpacked them.
pub fn check_window() -> Result {
    if !unpacked().join("Cargo.toml").is_file() {
        check()?;
    }
    in_archives(&format!("check --quiet {WINDOW} --lib --bins"), "")
}

/// The folder with the unpacked archives.
fn unpacked() -> PathBuf {
    shell::target_dir().join("packages/unpacked")
}

/// Runs cargo on the unpacked archives.
fn in_archives(args: &str, rustdoc_flags: &str) -> Result {
    let mut command = cargo(args);
    command.arg("--manifest-path").arg(unpacked().join("Cargo.toml")).arg("--target-dir").arg(shell::target_dir());
    sh(command.env("RUSTDOCFLAGS", rustdoc_flags))
}

/// Unpacks the archives of a folder; returns the folders of the crates, sorted.
fn unpack(archives: &Path, into: &Path) -> Result<Vec<String>> {
    let entries = std::fs::read_dir(archives).map_err(|cause| on_file("read", archives, &cause))?;
    let paths = entries.flatten().map(|entry| entry.path());
    let mut archives: Vec<PathBuf> = paths.filter(|path| path.extension().is_some_and(|end| end == "crate")).collect();
    archives.sort();
    if archives.is_empty() {
        return Err(Failure::new("`cargo package` has made no archive"));
    }
    for archive in &archives {
        // With -m files get the current time. The times in archives never change, so cargo would not notice changed
        // files.
        sh(program("tar").arg("-xzmf").arg(archive).arg("-C").arg(into))?;
    }
    Ok(archives.iter().filter_map(|path| Some(path.file_stem()?.to_string_lossy().into_owned())).collect())
}

/// Copies the package that selects features.
fn write_features(folder: &Path, crates: &[String]) -> Result {
    let (from, to) = (shell::root().join("xtask/features"), folder.join("features"));
    shell::empty_dir(&to.join("src"))?;
    let library = crates.iter().find(|folder| name(folder) == "orogen").map_or("orogen", String::as_str);
    let manifest = shell::read(&from.join("Cargo.toml"))?.replace("../../crates/orogen", &format!("../{library}"));
    shell::write(&to.join("Cargo.toml"), &manifest)?;
    for file in ["build.rs", "src/lib.rs"] {
        shell::write(&to.join(file), &shell::read(&from.join(file))?)?;
    }
    Ok(())
}

/// Makes a workspace of the unpacked crates, in place of the registry, with our profiles and versions of dependencies.
fn write_workspace(folder: &Path, crates: &[String]) -> Result {
    let root = shell::read(&shell::root().join("Cargo.toml"))?;
    let manifest = manifest(&root, crates)?;
    shell::write(&folder.join("Cargo.toml"), &manifest)?;
    shell::write(&folder.join("Cargo.lock"), &shell::read(&shell::root().join("Cargo.lock"))?)
}

/// The manifest of that workspace.
fn manifest(root: &str, crates: &[String]) -> Result<String> {
    let (_, profiles) =
        root.split_once("[profile.dev]").ok_or_else(|| Failure::new("Cargo.toml has no section [profile.dev]"))?;
    let members = [crates, &["features".to_owned()]].concat();
    let mut text = format!("[workspace]\nresolver = \"3\"\nmembers = {members:?}\n\n[patch.crates-io]\n");
    for folder in crates {
        text += &format!("{} = {{ path = \"{folder}\" }}\n", name(folder));
    }
    Ok(text + "\n[profile.dev]" + profiles)
}

/// The name of a crate, from `NAME-VERSION`.
fn name(folder: &str) -> &str {
    folder.rsplit_once('-').map_or(folder, |(name, _)| name)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_workspace_has_the_crates_and_our_profiles() {
        let crates = ["a-1.0.0", "a-b-1.0.0"].map(str::to_owned);
        let text = manifest("[workspace]\n\n[profile.dev]\nopt-level = 1\n", &crates).expect("a profile");
        assert!(text.contains("members = [\"a-1.0.0\", \"a-b-1.0.0\", \"features\"]"), "{text}");
        assert!(text.contains("\na = { path = \"a-1.0.0\" }\na-b = { path = \"a-b-1.0.0\" }\n"), "{text}");
        assert!(text.ends_with("\n[profile.dev]\nopt-level = 1\n"), "{text}");
        assert!(manifest("[workspace]\n", &crates).is_err());
    }
}
