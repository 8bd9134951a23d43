//! The Python package: a wheel, installed into a new environment, where its tests run.

use std::path::{Path, PathBuf};

use super::install;
use crate::failure::{Failure, Result};
use crate::shell::{self, program, root, run as sh, target_dir};

/// Builds the wheel from what the release build has compiled, installs it, and tests it from there.
pub fn check() -> Result {
    let wheel = wheel()?;
    let venv = super::folder().join("work/python");
    shell::empty_dir(&venv)?;
    sh(program(install::python()).args(["-m", "venv", "--without-pip"]).arg(&venv))?;
    // What it needs is that of the other clients; the package itself is only in the new environment.
    let site = site_packages(&venv)?;
    shell::write(&site.join("clients.pth"), &format!("{}\n", site_packages(&install::venv())?.display()))?;
    let mut unpack = program(install::python());
    unpack.args(["-m", "pip", "install", "--quiet", "--disable-pip-version-check", "--no-deps", "--no-index"]);
    sh(unpack.arg("--target").arg(&site).arg(&wheel))?;
    let inside = |args: &[&str]| {
        let mut command = program(venv.join("bin/python"));
        // Away from the sources, so that only what was installed is imported.
        command.current_dir(&venv).args(args);
        command
    };
    let python = root().join("python");
    sh(inside(&[]).arg(python.join("generate.py")).arg("--check").arg(site.join("orogen")))?;
    sh(inside(&["-m", "pytest", "-p", "no:cacheprovider", "-c"])
        .arg(python.join("pyproject.toml"))
        .arg("--rootdir")
        .arg(&venv)
        .arg(python.join("tests")))?;
    let settings = python.join("pyproject.toml");
    sh(inside(&["-m", "mypy", "--strict", "--no-incremental", "--config-file"])
        .arg(settings)
        .arg(python.join("tests/typed.py")))?;
    sh(&mut inside(&["-m", "mypy", "--strict", "--no-incremental", "-p", "orogen"]))?;
    sh(&mut inside(&["-m", "mypy.stubtest", "orogen._orogen"]))
}

/// The wheel.
fn wheel() -> Result<PathBuf> {
    let folder = target_dir().join("wheels");
    shell::empty_dir(&folder)?;
    let mut build = program(install::python());
    build.args(["-m", "maturin", "build", "--quiet", "--release", "--locked", "--out"]).arg(&folder);
    build.arg("--manifest-path").arg(root().join("crates/orogen-py/Cargo.toml"));
    sh(build.current_dir(root().join("python")))?;
    let entries = std::fs::read_dir(&folder).into_iter().flatten().flatten();
    let found = entries.map(|entry| entry.path()).find(|path| path.extension().is_some_and(|end| end == "whl"));
    found.ok_or_else(|| Failure::new("maturin has made no wheel"))
}

/// The folder of an environment's packages.
fn site_packages(venv: &Path) -> Result<PathBuf> {
    let code = "import sysconfig; print(sysconfig.get_path('purelib'))";
    let path = shell::capture(program(venv.join("bin/python")).args(["-c", code]))?;
    Ok(PathBuf::from(path.trim()))
}
