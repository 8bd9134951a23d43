//! Peers that are Python packages, each in its own virtual environment.

use std::path::PathBuf;

use crate::shell;

/// A peer: its area, the environment variable in which the bench program looks for its Python, the packages, and the
/// supported Pythons.
struct Peer {
    area: &'static str,
    variable: &'static str,
    name: &'static str,
    packages: &'static [&'static str],
    pythons: &'static [&'static str],
}

const PEERS: &[Peer] = &[
    // Its last release on PyPI is source code that does not compile with newer Pythons.
    Peer {
        area: "erosion",
        variable: "OROGEN_RICHDEM",
        name: "richdem",
        packages: &["numpy<2", "richdem==0.3.4"],
        pythons: &["python3.10", "python3.9", "python3.8"],
    },
    Peer {
        area: "erosion",
        variable: "OROGEN_FASTSCAPELIB",
        name: "fastscapelib",
        packages: &["numpy", "fastscapelib==0.3.0"],
        pythons: &["python3", "python3.12", "python3.11", "python3.10"],
    },
    Peer {
        area: "erosion",
        variable: "OROGEN_MATPLOTLIB",
        name: "matplotlib",
        packages: &["numpy", "matplotlib==3.10.7"],
        pythons: &["python3", "python3.13", "python3.12", "python3.11", "python3.10"],
    },
    Peer {
        area: "outputs",
        variable: "OROGEN_CONTOURPY",
        name: "contourpy",
        packages: &["numpy", "contourpy==1.3.3"],
        pythons: &["python3", "python3.13", "python3.12", "python3.11"],
    },
    Peer {
        area: "outputs",
        variable: "OROGEN_PYDELATIN",
        name: "pydelatin",
        packages: &["numpy", "pydelatin==0.4.0"],
        pythons: &["python3", "python3.13", "python3.12", "python3.11"],
    },
    Peer {
        area: "outputs",
        variable: "OROGEN_OPENEXR",
        name: "OpenEXR",
        packages: &["numpy", "OpenEXR==3.5.3"],
        pythons: &["python3", "python3.13", "python3.12", "python3.11"],
    },
];

/// The Pythons of an area's peers that can be installed, each with its variable; a variable that is set is used
/// unchanged. Peers that cannot be installed are listed on standard error.
pub fn installed(area: &str) -> Vec<(&'static str, PathBuf)> {
    let peers = PEERS.iter().filter(|peer| peer.area == area);
    peers.filter_map(|peer| Some((peer.variable, install(peer)?))).collect()
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
