//! Tests of the libraries built for WebAssembly, without an operating system. Presets are made under Node.js and must
//! have the golden hash.

use std::path::Path;

use super::install;
use crate::failure::{Failure, Result};
use crate::{output, shell};

const TARGET: &str = "wasm32-unknown-unknown";

/// Installs the target's standard library.
pub fn install() -> Result {
    let ask = ["--print", "target-libdir", "--target", TARGET];
    if shell::capture(shell::program("rustc").args(ask)).is_ok_and(|folder| Path::new(folder.trim()).is_dir()) {
        return Ok(());
    }
    output::line(format_args!("    rustup target add {TARGET}"));
    install::patiently(|| {
        let mut command = shell::program("rustup");
        command.args(["target", "add", TARGET]);
        command
    })
}

/// Installs the source of the standard library, which a module with threads is built with. Returns whether it is there.
pub fn install_source() -> bool {
    let is_there = || {
        let root = shell::capture(shell::program("rustc").args(["--print", "sysroot"]));
        root.is_ok_and(|root| Path::new(root.trim()).join("lib/rustlib/src/rust/library/std/Cargo.toml").is_file())
    };
    if is_there() {
        return true;
    }
    output::line(format_args!("    rustup component add rust-src"));
    let install = || {
        let mut command = shell::program("rustup");
        command.args(["component", "add", "rust-src"]);
        command
    };
    install::patiently(install).is_ok() && is_there()
}

/// One preset of each kind: noise, levels, a volume, stream power.
const FOUR: &str = "classic endless caves volcano";

/// Makes four presets, and a world without files.
pub fn check_four() -> Result {
    check(FOUR)
}

/// Makes every preset, and a world without files.
pub fn check_all() -> Result {
    check("")
}

/// Builds without threads and without the feature `fs`, with 128-bit vectors, and makes these presets; all if the text
/// is empty.
fn check(presets: &str) -> Result {
    let folder = super::folder().join("wasm");
    let build = |example: &str| {
        let mut build = shell::cargo(&format!("build --quiet --release --no-default-features {example}"));
        build
            .env("CARGO_BUILD_TARGET", TARGET)
            .env("CARGO_TARGET_DIR", &folder)
            .env("CARGO_TARGET_WASM32_UNKNOWN_UNKNOWN_RUSTFLAGS", "-C target-feature=+simd128")
            .env("CARGO_PROFILE_RELEASE_LTO", "off")
            .env("CARGO_PROFILE_RELEASE_OPT_LEVEL", "2")
            .env("CARGO_PROFILE_RELEASE_CODEGEN_UNITS", "16")
            .env("OROGEN_PRESETS", presets);
        shell::run(&mut build)
    };
    build("--package orogen-engine --example without_files")?;
    build("--package orogen --example golden_presets")?;
    if run(&folder, "without_files")? != Some(0) {
        return Err(Failure::new("the example without_files of orogen-engine failed"));
    }
    match run(&folder, "golden_presets")? {
        Some(0) => {
            let which = if presets.is_empty() { "every preset" } else { presets };
            output::line(format_args!("    {which} at the level simd128: as in golden/presets.txt"));
            Ok(())
        }
        Some(number @ 1..=200) => Err(Failure::new(format!("preset number {number} differs from golden/presets.txt"))),
        code => Err(Failure::new(format!("the module did not get to its end: exit code {code:?}"))),
    }
}

/// Runs an example under Node.js; returns its exit code.
fn run(folder: &Path, example: &str) -> Result<Option<i32>> {
    let module = folder.join(TARGET).join(format!("release/examples/{example}.wasm"));
    let mut run = shell::program("node");
    run.arg(shell::root().join("xtask/clients/run_wasm.mjs")).arg(module);
    Ok(shell::status(&mut run)?.code())
}
