//! The tests of every SIMD level, run on an emulated ARM processor: there the levels are NEON and scalar.
//!
//! Only the two crates that depend on levels are cross-built; they need no C headers.

use std::path::{Path, PathBuf};
use std::process::Command;

use super::install;
use crate::failure::{Failure, Result};
use crate::{output, shell};

const TARGET: &str = "aarch64-unknown-linux-gnu";

/// The packages of the linker and the emulator, each with a file or program that it installs.
pub const APT: &[(&str, &str)] = &[
    ("aarch64-linux-gnu-gcc", "gcc-aarch64-linux-gnu"),
    ("/usr/aarch64-linux-gnu/lib/libc.a", "libc6-dev-arm64-cross"),
    ("qemu-aarch64", "qemu-user"),
];

/// Debian's compiler, for systems where rustup cannot fetch the standard library of another target.
const DEBIAN_RUSTC: &str = "/usr/bin/rustc";
const DEBIAN_PACKAGES: [&str; 2] = ["rustc-web", "libstd-rust-web-dev:arm64"];

/// The tests: bits compared with golden files, all entry points with each other, and every operation with the scalar
/// level.
pub const TESTS: [&str; 2] = [
    "test --quiet --package orogen-simd --lib",
    "test --quiet --package orogen-noise --test suite -- goldens:: ways::",
];

/// Installs a standard library for the target if no compiler has one: from rustup, otherwise from Debian.
pub fn install() -> Result {
    if native() || rustc().is_some() {
        return Ok(());
    }
    output::line(format_args!("    rustup target add {TARGET}"));
    match install::patiently(|| {
        let mut command = shell::program("rustup");
        command.args(["target", "add", TARGET]);
        command
    }) {
        Ok(()) => Ok(()),
        Err(failure) => {
            output::line(format_args!("    {}; trying Debian's", failure.message()));
            install::foreign_apt("arm64", &DEBIAN_PACKAGES)
        }
    }
}

/// Builds the tests for the target and runs them.
pub fn check() -> Result {
    for test in TESTS {
        let mut command = shell::cargo(test);
        if !native() {
            cross(&mut command)?;
        }
        shell::run(&mut command)?;
    }
    Ok(())
}

/// Whether this is an ARM machine, on which nothing is emulated.
const fn native() -> bool {
    cfg!(target_arch = "aarch64")
}

/// Sets up cargo to build for the target and run the result in the emulator.
fn cross(command: &mut Command) -> Result {
    let Some(rustc) = rustc() else {
        return Err(Failure::new(format!("no compiler here has the standard library of {TARGET}")));
    };
    command
        .env("RUSTC", rustc)
        .env("CARGO_BUILD_TARGET", TARGET)
        .env("CARGO_TARGET_DIR", super::folder().join("neon"))
        .env("CARGO_TARGET_AARCH64_UNKNOWN_LINUX_GNU_LINKER", "aarch64-linux-gnu-gcc")
        .env("CARGO_TARGET_AARCH64_UNKNOWN_LINUX_GNU_RUNNER", "qemu-aarch64")
        // Statically linked: otherwise the emulator would mix the C libraries of several packages.
        .env("CARGO_TARGET_AARCH64_UNKNOWN_LINUX_GNU_RUSTFLAGS", "-C target-feature=+crt-static")
        // Under emulation, code of the default optimization level takes longer to run than code of this level takes to
        // build.
        .env("CARGO_PROFILE_DEV_OPT_LEVEL", "2")
        .env("CARGO_PROFILE_DEV_DEBUG", "false")
        .env("CARGO_INCREMENTAL", "0");
    Ok(())
}

/// A compiler with the target's standard library.
fn rustc() -> Option<PathBuf> {
    let usual = std::env::var_os("RUSTC").map_or_else(|| PathBuf::from("rustc"), PathBuf::from);
    [usual, PathBuf::from(DEBIAN_RUSTC)].into_iter().find(|rustc| has_target(rustc))
}

fn has_target(rustc: &Path) -> bool {
    let ask = ["--print", "target-libdir", "--target", TARGET];
    shell::capture(shell::program(rustc).args(ask)).is_ok_and(|folder| Path::new(folder.trim()).is_dir())
}
