//! The Python package in a new environment, where its tests run.

use std::path::{Path, PathBuf};
use std::process::Command;

use super::install;
use crate::failure::{Failure, Result};
use crate::output;
use crate::shell::{self, program, root, run as sh, target_dir};

/// Tests the package with the native part of the release build, laid out as in the wheel.
pub fn check() -> Result {
    let (venv, site) = environment("python")?;
    lay_out(&install::python(), &site)?;
    test(&venv, &site)
}

/// Lays the package out in a folder of packages, with the native part of the release build.
pub fn lay_out(python: &Path, site: &Path) -> Result {
    let [before, after] = [std::env::consts::DLL_PREFIX, std::env::consts::DLL_SUFFIX];
    let native = target_dir().join("release").join(format!("{before}_orogen{after}"));
    sh(program(python).arg(root().join("xtask/clients/install_python.py")).arg(native).arg(site))
}

/// Maximum length of the wheel in bytes.
const LONGEST: u64 = 12_000_000;

/// Tests the wheel that maturin makes.
pub fn check_wheel() -> Result {
    let wheel = wheel(None)?;
    let (venv, site) = environment("wheel")?;
    let mut unpack = program(install::python());
    unpack.args(["-m", "pip", "install", "--quiet", "--disable-pip-version-check", "--no-deps", "--no-index"]);
    sh(unpack.arg("--target").arg(&site).arg(&wheel))?;
    test(&venv, &site)
}

/// The Python without a global lock, which is in no package of Debian.
const FREE_THREADED: &str = "python3.14t";

/// What its tests need.
const FREE_THREADED_TESTS: [&str; 4] =
    [super::NUMPY, "pytest==9.2.0", "hypothesis==6.170.17", "pytest-run-parallel==0.10.0"];

/// Tests the wheel of the free-threaded Python: every test in four threads at a time.
pub fn check_free_threaded() -> Result {
    let lock = shell::capture(program(FREE_THREADED).args(["-c", "import sys; print(sys._is_gil_enabled())"]));
    if !lock.is_ok_and(|lock| lock.trim() == "False") {
        let message = format!("{FREE_THREADED} is missing: build CPython 3.14 with `configure --disable-gil`");
        return Err(Failure::new(message));
    }
    let wheel = wheel(Some(FREE_THREADED))?;
    let venv = super::folder().join("work/nogil");
    shell::empty_dir(&venv)?;
    sh(program(FREE_THREADED).args(["-m", "venv"]).arg(&venv))?;
    let python = venv.join("bin/python");
    install::patiently(|| {
        let mut command = program(&python);
        command.args(["-m", "pip", "install", "--quiet", "--disable-pip-version-check", "--only-binary=:all:"]);
        command.args(FREE_THREADED_TESTS).arg(&wheel);
        command
    })?;
    let tests = root().join("python/tests");
    let mut test = program(&python);
    test.current_dir(&venv).args(["-m", "pytest", "-p", "no:cacheprovider", "--parallel-threads", "4", "-c"]);
    test.arg(root().join("python/pyproject.toml")).arg("--rootdir").arg(&venv);
    sh(test.args(["test_arrays.py", "test_world.py"].map(|name| tests.join(name))))
}

/// The tests of the package, its generated files and its types, by two type checkers.
fn test(venv: &Path, site: &Path) -> Result {
    let inside = |args: &[&str]| -> Command {
        let mut command = program(venv.join("bin/python"));
        // Away from the sources, so that only what was installed is imported.
        command.current_dir(venv).args(args);
        command
    };
    let python = root().join("python");
    let settings = python.join("pyproject.toml");
    sh(inside(&[]).arg(python.join("generate.py")).arg("--check").arg(site.join("orogen")))?;
    sh(inside(&["-m", "pytest", "-p", "no:cacheprovider", "-c"])
        .arg(&settings)
        .arg("--rootdir")
        .arg(venv)
        .arg(python.join("tests")))?;
    sh(inside(&["-m", "mypy", "--strict", "--no-incremental", "--config-file"])
        .arg(&settings)
        .arg(python.join("tests/typed.py")))?;
    sh(&mut inside(&["-m", "mypy", "--strict", "--no-incremental", "-p", "orogen"]))?;
    let mut pyright = program(install::node_bin().join("pyright"));
    sh(pyright.arg("--project").arg(&settings).arg("--pythonpath").arg(venv.join("bin/python")))?;
    sh(&mut inside(&["-m", "mypy.stubtest", "orogen._orogen"]))
}

/// A new environment, and the folder of its packages. What the package needs is that of the other clients.
fn environment(name: &str) -> Result<(PathBuf, PathBuf)> {
    let venv = super::folder().join("work").join(name);
    shell::empty_dir(&venv)?;
    sh(program(install::python()).args(["-m", "venv", "--without-pip"]).arg(&venv))?;
    let site = site_packages(&venv.join("bin/python"))?;
    let others = site_packages(&install::python())?;
    shell::write(&site.join("clients.pth"), &format!("{}\n", others.display()))?;
    Ok((venv, site))
}

/// Makes the wheel, for all Pythons with a stable interface or for one interpreter; returns its path.
fn wheel(interpreter: Option<&str>) -> Result<PathBuf> {
    let folder = target_dir().join("wheels");
    shell::empty_dir(&folder)?;
    let mut build = program(install::python());
    build.args(["-m", "maturin", "build", "--quiet", "--profile", "wheel", "--locked", "--out"]).arg(&folder);
    build.args(interpreter.iter().flat_map(|python| ["--interpreter", python]));
    sh(build.current_dir(root().join("python")))?;
    let entries = std::fs::read_dir(&folder).into_iter().flatten().flatten();
    let found = entries.map(|entry| entry.path()).find(|path| path.extension().is_some_and(|end| end == "whl"));
    let wheel = found.ok_or_else(|| Failure::new("maturin has made no wheel"))?;
    match std::fs::metadata(&wheel).map_or(0, |metadata| metadata.len()) {
        length @ ..=LONGEST => {
            output::line(format_args!("    {}: {length} bytes", wheel.file_name().unwrap_or_default().display()));
            Ok(wheel)
        }
        length => Err(Failure::new(format!("the wheel has {length} bytes; it should have at most {LONGEST}"))),
    }
}

/// The folder of a Python's packages.
pub fn site_packages(python: &Path) -> Result<PathBuf> {
    let code = "import sysconfig; print(sysconfig.get_path('purelib'))";
    let path = shell::capture(program(python).args(["-c", code]))?;
    Ok(PathBuf::from(path.trim()))
}
