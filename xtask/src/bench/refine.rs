//! `cargo xtask bench refine`: real places, averaged to a larger cell, refined again and compared with themselves.

use std::path::{Path, PathBuf};

use super::realism;
use crate::failure::{Failure, Result, on_file};
use crate::{host, shell};

/// Runs the script on all places of a folder; it prints tables.
pub fn run(dems: Option<&Path>, factor: &str, program: &Path) -> Result {
    let dems = dems.ok_or_else(|| {
        Failure::usage(
            "refine needs --dems DIR: a folder with GeoTIFFs of real places, which are not part of the project",
        )
    })?;
    let mut command = shell::program(realism::python()?);
    command.arg(realism::scripts().join("refined.py")).arg(program).args(rasters(dems)?);
    command.args(["--factor", factor]);
    println!("{}, {}\n", host::date(), host::processor());
    shell::run(&mut command)
}

/// The real places, sorted by name.
fn rasters(dems: &Path) -> Result<Vec<PathBuf>> {
    let entries = std::fs::read_dir(dems).map_err(|e| on_file("read", dems, &e))?;
    let mut files = Vec::new();
    for entry in entries {
        let path = entry.map_err(|e| on_file("read", dems, &e))?.path();
        if path.extension().is_some_and(|extension| extension == "tif") {
            files.push(std::path::absolute(&path).map_err(|e| on_file("find", &path, &e))?);
        }
    }
    files.sort();
    match files.is_empty() {
        true => Err(Failure::new(format!("there is no .tif in {}", dems.display()))),
        false => Ok(files),
    }
}
