//! The build of the studio as a page, for `cargo xtask web` and for the check of the page.

use std::path::{Path, PathBuf};

use crate::failure::{Result, on_file};
use crate::shell;

const TARGET: &str = "wasm32-unknown-unknown";

/// The page's own files.
const PAGE: [&str; 3] = ["index.html", "page.js", "worker.js"];

/// The module, and its name before it is compressed.
const MODULE: &str = "studio_bg.wasm";

/// How the module is built.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Profile {
    /// Small and fast.
    Release,
    /// Built in little time.
    Quick,
}

/// Builds the page in a folder. Returns the folder of its files.
pub fn build(folder: &Path, profile: Profile) -> Result<PathBuf> {
    let page = folder.join("studio");
    shell::empty_dir(&page)?;
    let built = shell::target_dir().join("web-build");
    let name = if profile == Profile::Quick { "quick" } else { "release" };
    let cargo = |arguments: &str| {
        let mut cargo = shell::cargo(&format!("build --quiet --locked --manifest-path web/Cargo.toml {arguments}"));
        cargo.env("CARGO_TARGET_DIR", &built);
        cargo.env("CARGO_TARGET_WASM32_UNKNOWN_UNKNOWN_RUSTFLAGS", "-C target-feature=+simd128");
        cargo
    };
    shell::run(&mut cargo(&format!("--profile {name} --target {TARGET} --package orogen-web-studio")))?;
    // The program that binds it need not be small.
    shell::run(&mut cargo("--profile quick --package orogen-web-bindgen"))?;
    let tool = built.join("quick").join(format!("orogen-web-bindgen{}", std::env::consts::EXE_SUFFIX));
    let module = built.join(TARGET).join(name).join("studio.wasm");
    shell::run(shell::program(&tool).arg("bind").arg(module).arg(&page))?;
    let module = page.join(MODULE);
    let pack = if profile == Profile::Quick { "pack" } else { "squeeze" };
    shell::run(shell::program(&tool).arg(pack).arg(module))?;
    for file in PAGE {
        let to = page.join(file);
        let from = shell::root().join("web/studio/page").join(file);
        std::fs::copy(from, &to).map_err(|e| on_file("write", &to, &e))?;
    }
    Ok(page)
}
