//! `cargo xtask bench critic`: how well a small network tells presets from real places.

use std::path::{Path, PathBuf};

use crate::failure::{Failure, Result};
use crate::{host, shell};

/// What is judged: a preset, or a recipe of the folder of generators, and its layer.
const MADE: &[(&str, &str)] = &[("alpine", "surface"), ("endless", "surface"), ("hillslopes", "surface")];

/// Each has as many seeds, of half of which the critic learns.
const SEEDS: u64 = 6;
/// Samples along a side, and the cell in metres.
const SIDE: u32 = 512;
const CELL: u32 = 60;

/// The folders of real places; neither is part of the project.
#[derive(Debug, Default, PartialEq, Eq)]
pub struct Options {
    /// Those from which the critic learns what real land is.
    pub dems: Option<PathBuf>,
    /// Other ones, as the control.
    pub control: Option<PathBuf>,
}

/// Makes land, and prints the figures of the critic.
pub fn run(options: &Options, first: u64, program: &Path) -> Result {
    let (Some(dems), Some(control)) = (&options.dems, &options.control) else {
        return Err(Failure::usage(
            "critic needs --dems DIR and --control DIR: two folders with GeoTIFFs of real places, which are not part of the \
             project",
        ));
    };
    let folder = shell::target_dir().join("bench").join("critic-made");
    shell::empty_dir(&folder)?;
    let mut command = shell::program(python()?);
    command.arg(shell::root().join("training").join("critic.py")).arg(dems).arg(control);
    for (name, layer) in MADE {
        let recipe = shell::root().join(format!("realism/generators/{name}.toml"));
        let made = folder.join(name);
        shell::empty_dir(&made)?;
        for seed in first..first + SEEDS {
            let mut export = shell::program(program);
            export.arg("export");
            match recipe.is_file() {
                true => export.arg(&recipe),
                false => export.arg(name),
            };
            export.args(["--quiet", "--layer", layer, "--seed", &seed.to_string(), "--cell", &CELL.to_string()]);
            export.args(["--window", &format!("0,0,{SIDE},{SIDE}")]);
            shell::run(export.arg("-o").arg(made.join(format!("{seed}.tif"))))?;
        }
        command.arg(made);
    }
    println!("{}, {}", host::date(), host::processor());
    println!("seeds {first} to {}\n", first + SEEDS - 1);
    shell::run(&mut command)
}

/// A Python with the packages of the training: `OROGEN_TRAINING`, or one in the target folder.
fn python() -> Result<PathBuf> {
    if let Some(python) = std::env::var_os("OROGEN_TRAINING") {
        return Ok(python.into());
    }
    let venv = shell::target_dir().join("bench").join("training");
    let python = venv.join(if cfg!(windows) { "Scripts/python.exe" } else { "bin/python" });
    if python.is_file() && shell::succeeds(shell::program(&python).args(["-c", "import torch, rasterio"])) {
        return Ok(python);
    }
    eprintln!("installing PyTorch ...");
    shell::run(shell::program("python3").args(["-m", "venv", "--clear"]).arg(&venv))?;
    let install = ["-m", "pip", "install", "--quiet", "--disable-pip-version-check", "-r"];
    shell::run(shell::program(&python).args(install).arg(shell::root().join("training/requirements.txt")))?;
    Ok(python)
}
