//! The libraries built for WebAssembly, without an operating system; every preset is made under node and must have the
//! golden hash.

use super::install;
use crate::failure::{Failure, Result};
use crate::{output, shell};

const TARGET: &str = "wasm32-unknown-unknown";

/// Installs the target's standard library.
pub fn install() -> Result {
    let ask = ["--print", "target-libdir", "--target", TARGET];
    if shell::capture(shell::program("rustc").args(ask))
        .is_ok_and(|folder| std::path::Path::new(folder.trim()).is_dir())
    {
        return Ok(());
    }
    output::line(format_args!("    rustup target add {TARGET}"));
    install::patiently(|| {
        let mut command = shell::program("rustup");
        command.args(["target", "add", TARGET]);
        command
    })
}

/// Builds without threads and without the feature `fs`, with 128-bit vectors, and makes every preset.
pub fn check() -> Result {
    let folder = super::folder().join("wasm");
    let mut build =
        shell::cargo("build --quiet --package orogen --example golden_presets --no-default-features --release");
    build
        .env("CARGO_BUILD_TARGET", TARGET)
        .env("CARGO_TARGET_DIR", &folder)
        .env("CARGO_TARGET_WASM32_UNKNOWN_UNKNOWN_RUSTFLAGS", "-C target-feature=+simd128")
        .env("CARGO_PROFILE_RELEASE_LTO", "off")
        .env("CARGO_PROFILE_RELEASE_OPT_LEVEL", "2")
        .env("CARGO_PROFILE_RELEASE_CODEGEN_UNITS", "16");
    shell::run(&mut build)?;
    let module = folder.join(TARGET).join("release/examples/golden_presets.wasm");
    let mut run = shell::program("node");
    run.arg(shell::root().join("xtask/clients/run_wasm.mjs")).arg(module);
    match shell::status(&mut run)?.code() {
        Some(0) => {
            output::line("    every preset at the level simd128: all as in golden/presets.txt");
            Ok(())
        }
        Some(number @ 1..=200) => Err(Failure::new(format!("preset number {number} differs from golden/presets.txt"))),
        code => Err(Failure::new(format!("the module did not get to its end: exit code {code:?}"))),
    }
}
