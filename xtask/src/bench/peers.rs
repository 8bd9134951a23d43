//! Peers that are Python packages, each in its own virtual environment.

use std::path::PathBuf;

use crate::failure::{Failure, Result};
use crate::{clients, shell};

/// A peer: its areas, the environment variable in which the bench program looks for its Python, the packages, and the
/// supported Pythons.
struct Peer {
    areas: &'static [&'static str],
    variable: &'static str,
    name: &'static str,
    packages: &'static [&'static str],
    pythons: &'static [&'static str],
}

const PEERS: &[Peer] = &[
    // Its last release on PyPI is source code that does not compile with newer Pythons.
    Peer {
        areas: &["erosion", "python"],
        variable: "OROGEN_RICHDEM",
        name: "richdem",
        packages: &["numpy<2", "richdem==0.3.4"],
        pythons: &["python3.10", "python3.9", "python3.8"],
    },
    Peer {
        areas: &["erosion", "python"],
        variable: "OROGEN_FASTSCAPELIB",
        name: "fastscapelib",
        packages: &["numpy", "fastscapelib==0.3.0"],
        pythons: &["python3", "python3.12", "python3.11", "python3.10"],
    },
    Peer {
        areas: &[],
        variable: "OROGEN_LANDLAB",
        name: "landlab",
        packages: &["numpy", "landlab==2.10.1"],
        pythons: PYTHONS,
    },
    Peer {
        areas: &["erosion"],
        variable: "OROGEN_MATPLOTLIB",
        name: "matplotlib",
        packages: &["numpy", "matplotlib==3.10.7"],
        pythons: &["python3", "python3.13", "python3.12", "python3.11", "python3.10"],
    },
    Peer {
        areas: &["outputs"],
        variable: "OROGEN_CONTOURPY",
        name: "contourpy",
        packages: &["numpy", "contourpy==1.3.3"],
        pythons: &["python3", "python3.13", "python3.12", "python3.11"],
    },
    Peer {
        areas: &["outputs"],
        variable: "OROGEN_PYDELATIN",
        name: "pydelatin",
        packages: &["numpy", "pydelatin==0.4.0"],
        pythons: &["python3", "python3.13", "python3.12", "python3.11"],
    },
    Peer {
        areas: &["outputs"],
        variable: "OROGEN_OPENEXR",
        name: "OpenEXR",
        packages: &["numpy", "OpenEXR==3.5.3"],
        pythons: &["python3", "python3.13", "python3.12", "python3.11"],
    },
    Peer {
        areas: &["python"],
        variable: "OROGEN_PYSHEDS",
        name: "pysheds",
        packages: &["numpy", "pysheds==0.5"],
        pythons: PYTHONS,
    },
    Peer {
        areas: &["python"],
        variable: "OROGEN_XRSPATIAL",
        name: "xrspatial",
        packages: &["numpy", "xarray-spatial==0.5.3"],
        pythons: PYTHONS,
    },
    Peer {
        areas: &["python"],
        variable: "OROGEN_WHITEBOX",
        name: "whitebox_workflows",
        packages: &["numpy", "whitebox-workflows==2.0.6"],
        pythons: PYTHONS,
    },
    Peer {
        areas: &["python"],
        variable: "OROGEN_NOISE",
        name: "noise",
        packages: &["numpy", "noise==1.2.2"],
        pythons: PYTHONS,
    },
    Peer {
        areas: &["python"],
        variable: "OROGEN_OPENSIMPLEX",
        name: "opensimplex",
        packages: &["numpy", "opensimplex==0.4.5.1"],
        pythons: PYTHONS,
    },
];

/// The newest Pythons.
const PYTHONS: &[&str] = &["python3", "python3.13", "python3.12", "python3.11"];

/// The Python in which our own package is measured.
const OURS: Peer = Peer {
    areas: &["python"],
    variable: "OROGEN_PYTHON",
    name: "distributed",
    packages: &["numpy", "distributed==2026.8.0"],
    pythons: PYTHONS,
};

/// The Pythons of an area's peers that can be installed, each with its variable; a variable that is set is used
/// unchanged. Peers that cannot be installed are listed on standard error.
pub fn installed(area: &str) -> Vec<(&'static str, PathBuf)> {
    let peers = PEERS.iter().filter(|peer| peer.areas.contains(&area));
    peers.filter_map(|peer| Some((peer.variable, install(peer)?))).collect()
}

/// The Python of a peer that can be installed, by its variable.
pub fn python(variable: &str) -> Option<PathBuf> {
    install(PEERS.iter().find(|peer| peer.variable == variable)?)
}

/// Installs our own package from the release build; returns its Python with its variable.
pub fn package() -> Result<(&'static str, PathBuf)> {
    if let Some(python) = std::env::var_os(OURS.variable) {
        return Ok((OURS.variable, python.into()));
    }
    let python =
        install(&OURS).ok_or_else(|| Failure::new("the Python package cannot be measured without NumPy and Dask"))?;
    shell::run(&mut shell::cargo("build --quiet --release --package orogen-py"))?;
    clients::python::lay_out(&python, &clients::python::site_packages(&python)?)?;
    Ok((OURS.variable, python))
}

fn install(peer: &Peer) -> Option<PathBuf> {
    if let Some(python) = std::env::var_os(peer.variable) {
        return Some(python.into());
    }
    let venv = shell::target_dir().join("bench").join(peer.name);
    let python = venv.join(if cfg!(windows) { "Scripts/python.exe" } else { "bin/python" });
    let imports = || shell::succeeds(shell::program(&python).args(["-c", &format!("import {}", peer.name)]));
    if python.is_file() && imports() {
        return Some(python);
    }
    for base in peer.pythons {
        if !shell::succeeds(shell::program(base).args(["-c", "import venv, ensurepip"])) {
            continue;
        }
        eprintln!("installing {} for {base} ...", peer.name);
        let made = shell::succeeds(shell::program(base).args(["-m", "venv", "--clear"]).arg(&venv));
        let install = ["-m", "pip", "install", "--quiet", "--disable-pip-version-check"];
        if made && shell::succeeds(shell::program(&python).args(install).args(peer.packages)) && imports() {
            return Some(python);
        }
    }
    eprintln!("{} cannot be installed with any of {}: measured without it", peer.name, peer.pythons.join(", "));
    None
}
