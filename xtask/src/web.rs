//! `cargo xtask web`: the studio as a page, a folder of static files.

use std::path::{Path, PathBuf};

use crate::failure::{Failure, Result, on_file};
use crate::{clients, output, shell};

pub const ABOUT: &str = "build the studio as a page: static files for any host";

pub const HELP: &str = "
Usage: cargo xtask web [--quick] [FOLDER]

Builds the studio for WebAssembly and writes FOLDER/studio/ [default: target/web]: index.html, its scripts, and the
module, compressed. Any host of static files can serve the folder.

  --quick  a larger module with the same results, built in a fraction of the time, for tests

It needs rustup's wasm32-unknown-unknown, which is installed if it is missing.
";

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

/// Builds the page.
pub fn run(args: &[String]) -> Result {
    let is_quick = args.iter().any(|arg| arg == "--quick");
    let others: Vec<&String> = args.iter().filter(|arg| *arg != "--quick").collect();
    let folder = match others[..] {
        [] => shell::target_dir().join("web"),
        [folder] if !folder.starts_with('-') => PathBuf::from(folder),
        _ => return Err(Failure::usage("expected --quick, a folder, or nothing")),
    };
    clients::install_wasm()?;
    let page = build(&folder, if is_quick { Profile::Quick } else { Profile::Release })?;
    output::line(format_args!("{}", page.display()));
    Ok(())
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
