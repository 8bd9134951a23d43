//! The plugin for Godot and the example in Bevy. Both are in a workspace of their own and take long to compile, so they
//! run only if they are named.

use std::path::{Path, PathBuf};

use crate::failure::Result;
use crate::licences;
use crate::shell::{cargo, root, run as sh, target_dir};

/// The workspace.
const MANIFEST: &str = "engines/Cargo.toml";

/// Licences of game engines that others do not need: none is stricter than those of the list.
const LICENCES: &[&str] = &[];

/// Builds and tests packages of the workspace; returns the folder of what is built.
fn build(packages: &str) -> Result<PathBuf> {
    licences::check_of(Some(&root().join(MANIFEST)), LICENCES)?;
    let target = target_dir().join("engines");
    let run = |command: &str, more: &str| {
        sh(cargo(&format!("{command} --quiet --locked --manifest-path {MANIFEST} {packages} {more}"))
            .env("CARGO_TARGET_DIR", &target))
    };
    run("clippy", "--all-targets -- -D warnings")?;
    run("build", "")?;
    run("test", "-p orogen-engine-ground")?;
    Ok(target.join("debug"))
}

/// The example in Bevy, without a window.
pub fn check_bevy() -> Result {
    let built = build("-p orogen-bevy")?;
    let binary = built.join(format!("orogen-bevy{}", std::env::consts::EXE_SUFFIX));
    check("bevy", "OROGEN_BEVY", &binary)
}

/// The library for Godot, loaded by a stand-in for the engine.
pub fn check_godot() -> Result {
    let built = build("-p orogen-godot")?;
    let name = format!("{}orogen_godot{}", std::env::consts::DLL_PREFIX, std::env::consts::DLL_SUFFIX);
    check("godot", "OROGEN_GODOT", &built.join(name))
}

/// Runs the script of a client with what was built.
fn check(name: &str, variable: &str, built: &Path) -> Result {
    let work = super::empty_work(name)?;
    sh(super::python_script(&super::install::python(), name, name, &work).env(variable, built))
}
