//! Installation of the clients: Debian packages, a venv, a folder of Node packages.

use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::Duration;

use super::Client;
use crate::failure::{Failure, Result};
use crate::{output, shell};

/// Waits before the second and the third try, because registries may be unavailable for a moment.
const BACK_OFF: [Duration; 2] = [Duration::from_secs(5), Duration::from_secs(20)];

/// Installs the missing programs of these clients.
pub fn programs<'a>(clients: impl Iterator<Item = &'a Client>) -> Result {
    let mut debian: Vec<&str> = Vec::new();
    if !shell::succeeds(shell::program("python3").args(["-c", "import venv, ensurepip"])) {
        debian.extend(["python3", "python3-venv"]);
    }
    let wanted = clients.flat_map(|c| c.apt);
    debian.extend(wanted.filter(|(program, _)| !on_path(program)).map(|(_, package)| *package));
    apt(&sorted(debian))
}

/// Installs the missing Python and Node packages of these clients.
pub fn packages<'a>(clients: impl Iterator<Item = &'a Client> + Clone) -> Result {
    pip(&sorted(clients.clone().flat_map(|c| c.pip).copied().collect()))?;
    npm(&sorted(clients.flat_map(|c| c.npm).copied().collect()))
}

/// The Python with the pinned packages.
pub fn python() -> PathBuf {
    venv().join(if cfg!(windows) { "Scripts/python.exe" } else { "bin/python" })
}

/// The folder of the Node packages' programs.
pub fn node_bin() -> PathBuf {
    node().join("node_modules/.bin")
}

/// The folder of the environment with the pinned packages.
pub fn venv() -> PathBuf {
    super::folder().join("venv")
}

fn node() -> PathBuf {
    super::folder().join("node")
}

fn sorted(mut names: Vec<&str>) -> Vec<&str> {
    names.sort_unstable();
    names.dedup();
    names
}

/// Whether a program is in the path; for an absolute path, whether it is a file.
fn on_path(name: &str) -> bool {
    let path = std::env::var_os("PATH").unwrap_or_default();
    std::env::split_paths(&path).any(|dir| dir.join(name).is_file())
}

/// Installs Debian packages of another architecture.
pub fn foreign_apt(architecture: &str, packages: &[&str]) -> Result {
    if may_install() {
        shell::run(shell::program("dpkg").args(["--add-architecture", architecture]))?;
    }
    apt(packages)
}

/// Whether the system is Debian and the user is root.
fn may_install() -> bool {
    let root = shell::capture(shell::program("id").arg("-u")).is_ok_and(|id| id.trim() == "0");
    root && on_path("apt-get")
}

fn apt(packages: &[&str]) -> Result {
    if packages.is_empty() {
        return Ok(());
    }
    if !may_install() {
        return Err(Failure::new(format!(
            "these Debian packages, or what your system calls them, are missing; install them and run this again: {}",
            packages.join(" ")
        )));
    }
    let apt_get = |args: &[&str]| {
        let mut command = shell::program("apt-get");
        command.args(["-qq", "-y"]).args(args).env("DEBIAN_FRONTEND", "noninteractive");
        command
    };
    output::line(format_args!("    apt-get install {}", packages.join(" ")));
    patiently(|| apt_get(&["update"]))?;
    patiently(|| {
        let mut command = apt_get(&["install", "--no-install-recommends"]);
        command.args(packages);
        command
    })
}

fn pip(packages: &[&str]) -> Result {
    if installed(&venv(), packages) && python().is_file() {
        return Ok(());
    }
    output::line(format_args!("    pip install {}", packages.join(" ")));
    shell::empty_dir(&venv())?;
    shell::run(shell::program("python3").args(["-m", "venv"]).arg(venv()))?;
    patiently(|| {
        let mut command = shell::program(python());
        command.args(["-m", "pip", "install", "--quiet", "--disable-pip-version-check", "--only-binary=:all:"]);
        command.args(packages);
        command
    })?;
    remember(&venv(), packages)
}

fn npm(packages: &[&str]) -> Result {
    if installed(&node(), packages) {
        return Ok(());
    }
    output::line(format_args!("    npm install {}", packages.join(" ")));
    shell::empty_dir(&node())?;
    shell::write(&node().join("package.json"), "{ \"private\": true }\n")?;
    patiently(|| {
        let mut command = shell::program("npm");
        command.current_dir(node());
        command.args(["install", "--silent", "--no-audit", "--no-fund", "--ignore-scripts"]).args(packages);
        command
    })?;
    remember(&node(), packages)
}

/// Runs a command up to three times, with waits between.
pub fn patiently(command: impl Fn() -> Command) -> Result {
    for wait in BACK_OFF {
        match shell::run(&mut command()) {
            Ok(()) => return Ok(()),
            Err(failure) => {
                output::line(format_args!("    {}; trying again in {} s", failure.message(), wait.as_secs()))
            }
        }
        std::thread::sleep(wait);
    }
    shell::run(&mut command())
}

/// Whether a folder contains these packages, according to the note written after the installation.
fn installed(folder: &Path, packages: &[&str]) -> bool {
    std::fs::read_to_string(note(folder)).is_ok_and(|text| {
        let there: Vec<&str> = text.lines().collect();
        packages.iter().all(|package| there.contains(package))
    })
}

fn remember(folder: &Path, packages: &[&str]) -> Result {
    shell::write(&note(folder), &(packages.join("\n") + "\n"))
}

fn note(folder: &Path) -> PathBuf {
    folder.join("installed.txt")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_note_tells_a_changed_pin() {
        let folder = std::env::temp_dir().join(format!("orogen-install-{}", std::process::id()));
        std::fs::create_dir_all(&folder).expect("a temporary folder");
        assert!(!installed(&folder, &["a==1"]));
        remember(&folder, &["a==1", "b==2"]).expect("written");
        assert!(installed(&folder, &["a==1", "b==2"]));
        assert!(installed(&folder, &["b==2"]));
        assert!(!installed(&folder, &["a==1", "b==3"]) && !installed(&folder, &["c==1"]));
        std::fs::remove_dir_all(&folder).expect("removed");
    }
}
