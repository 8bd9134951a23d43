//! Blender as a Python module. It is large (1 GiB installed) and needs a specific version of Python and its own NumPy,
//! so it runs only if it is named.

use std::path::PathBuf;

use crate::failure::{Failure, Result};
use crate::shell;

const MODULE: &str = "bpy==5.0.0";

/// The Python that the module is built for.
const PYTHONS: [&str; 2] = ["python3.11", "python3"];

/// Installs it if it is missing, and runs the check.
pub fn check() -> Result {
    let python = python();
    let there = || shell::succeeds(shell::program(&python).args(["-c", "import bpy"]));
    if !there() {
        let right = ["-c", "import sys, venv, ensurepip; sys.exit(sys.version_info[:2] != (3, 11))"];
        let base = PYTHONS.into_iter().find(|base| shell::succeeds(shell::program(base).args(right)));
        let base = base.ok_or_else(|| Failure::new("Blender's module needs Python 3.11 with venv"))?;
        shell::run(shell::program(base).args(["-m", "venv", "--clear"]).arg(venv()))?;
        let install = ["-m", "pip", "install", "--quiet", "--disable-pip-version-check", MODULE];
        shell::run(shell::program(&python).args(install))?;
    }
    super::script_by(&python, "blender", "blender")
}

fn venv() -> PathBuf {
    super::folder().join("blender")
}

fn python() -> PathBuf {
    venv().join(if cfg!(windows) { "Scripts/python.exe" } else { "bin/python" })
}
