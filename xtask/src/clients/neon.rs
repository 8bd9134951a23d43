//! The tests of every SIMD level, run on an emulated ARM processor: there the levels are NEON and scalar.
//!
//! What is cross-built is the two crates that know of levels; both depend on nothing that would need a C library's headers.

use std::path::{Path, PathBuf};
use std::process::Command;

use super::install;
use crate::failure::{Failure, Result};
use crate::shell;

const TARGET: &str = "aarch64-unknown-linux-gnu";

/// What links and what runs the tests: each file or program with the package that brings it.
pub const APT: &[(&str, &str)] = &[
    ("aarch64-linux-gnu-gcc", "gcc-aarch64-linux-gnu"),
    ("/usr/aarch64-linux-gnu/lib/libc.a", "libc6-dev-arm64-cross"),
    ("qemu-aarch64", "qemu-user"),
];

/// Debian's own compiler, for where rustup cannot fetch the standard library of another target.
const DEBIAN_RUSTC: &str = "/usr/bin/rustc";
const DEBIAN_PACKAGES: [&str; 2] = ["rustc-web", "libstd-rust-web-dev:arm64"];

/// The tests that are run: bits against the goldens, all ways of asking against each other, every operation against the scalar.
const TESTS: [&str; 2] =
    ["test --quiet --package orogen-simd --lib", "test --quiet --package orogen-noise --test goldens --test ways"];

/// Gets a standard library for the target, if no compiler here has one: by rustup, else Debian's.
pub fn install() -> Result {
    if native() || rustc().is_some() {
        return Ok(());
    }
    println!("    rustup target add {TARGET}");
    match install::patiently(|| {
        let mut command = shell::program("rustup");
        command.args(["target", "add", TARGET]);
        command
    }) {
        Ok(()) => Ok(()),
        Err(failure) => {
            println!("    {}; trying Debian's", failure.message());
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

/// On an ARM machine nothing is emulated.
const fn native() -> bool {
    cfg!(target_arch = "aarch64")
}

/// Makes cargo build for the target and run what it built in the emulator.
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
        // Whole in itself: the emulator would else mix the C libraries that several packages bring.
        .env("CARGO_TARGET_AARCH64_UNKNOWN_LINUX_GNU_RUSTFLAGS", "-C target-feature=+crt-static")
        // Emulated, the usual light optimisation takes longer to run than this takes to build.
        .env("CARGO_PROFILE_DEV_OPT_LEVEL", "2")
        .env("CARGO_PROFILE_DEV_DEBUG", "false")
        .env("CARGO_INCREMENTAL", "0");
    Ok(())
}

/// A compiler that has the target's standard library.
fn rustc() -> Option<PathBuf> {
    let usual = std::env::var_os("RUSTC").map_or_else(|| PathBuf::from("rustc"), PathBuf::from);
    [usual, PathBuf::from(DEBIAN_RUSTC)].into_iter().find(|rustc| has_target(rustc))
}

fn has_target(rustc: &Path) -> bool {
    let ask = ["--print", "target-libdir", "--target", TARGET];
    shell::capture(shell::program(rustc).args(ask)).is_ok_and(|folder| Path::new(folder.trim()).is_dir())
}
