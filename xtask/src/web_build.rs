//! The build of the studio as a page, for `cargo xtask web` and for the check of the page.

use std::path::{Path, PathBuf};
use std::process::Command;

use crate::failure::{Result, on_file};
use crate::shell;

const TARGET: &str = "wasm32-unknown-unknown";

/// The page's own files.
const PAGE: [&str; 3] = ["index.html", "page.js", "worker.js"];

/// The module, and its name before it is compressed.
const MODULE: &str = "studio_bg.wasm";

/// Flags of the compiler, for all modules.
const FLAGS: &str = "-C target-feature=+simd128";

/// More flags, for instances of a module that share their memory: at most 4 GiB, which is all that it can address.
const SHARED: &str = ",+atomics,+bulk-memory,+mutable-globals -C link-arg=--shared-memory -C link-arg=--import-memory \
    -C link-arg=--max-memory=4294967296 -C link-arg=--export=__wasm_init_tls -C link-arg=--export=__tls_size \
    -C link-arg=--export=__tls_align -C link-arg=--export=__tls_base -C link-arg=--export=__heap_base";

/// How the module is built.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Profile {
    /// Small and fast.
    Release,
    /// Built in little time.
    Quick,
}

/// Which module is built.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Module {
    /// For all pages: each of its instances has a memory of its own, and one thread.
    Single,
    /// For isolated pages: its instances share memory. It contains a standard library that is compiled for that.
    Threads,
}

/// Builds the page in a folder. Returns the folder of its files.
pub fn build(folder: &Path, profile: Profile, with_threads: bool) -> Result<PathBuf> {
    let page = folder.join("studio");
    shell::empty_dir(&page)?;
    let name = if profile == Profile::Quick { "quick" } else { "release" };
    // The program that binds a module need not be small.
    shell::run(&mut cargo(Module::Single, "--profile quick --package orogen-web-bindgen"))?;
    let tool = built(Module::Single).join("quick").join(format!("orogen-web-bindgen{}", std::env::consts::EXE_SUFFIX));
    let modules: &[Module] = if with_threads { &[Module::Single, Module::Threads] } else { &[Module::Single] };
    for module in modules {
        let to = match module {
            Module::Single => page.clone(),
            Module::Threads => page.join("threads"),
        };
        let mut compile = cargo(*module, &format!("--profile {name} --target {TARGET} --package orogen-web-studio"));
        match module {
            Module::Single => shell::run(&mut compile)?,
            // The compiler warns at every crate that the flags for shared memory may change.
            Module::Threads => shell::run_silently(&mut compile)?,
        }
        let compiled = built(*module).join(TARGET).join(name).join("studio.wasm");
        shell::run(shell::program(&tool).arg("bind").arg(compiled).arg(&to))?;
        let pack = if profile == Profile::Quick { "pack" } else { "squeeze" };
        shell::run(shell::program(&tool).arg(pack).arg(to.join(MODULE)))?;
    }
    for file in PAGE {
        let to = page.join(file);
        let from = shell::root().join("web/studio/page").join(file);
        std::fs::copy(from, &to).map_err(|e| on_file("write", &to, &e))?;
    }
    let says = format!("// Whether the folder `threads` is there.\nexport const HAS_THREADS = {with_threads};\n");
    shell::write(&page.join("modules.js"), &says)?;
    Ok(page)
}

/// The folder of what is compiled. Modules with threads have their own: the compiler's settings for them would have
/// much of the other one compiled again.
fn built(module: Module) -> PathBuf {
    shell::target_dir().join(match module {
        Module::Single => "web-build",
        Module::Threads => "web-threads-build",
    })
}

fn cargo(module: Module, arguments: &str) -> Command {
    let mut cargo = shell::cargo(&format!("build --quiet --locked --manifest-path web/Cargo.toml {arguments}"));
    cargo.env("CARGO_TARGET_DIR", built(module));
    let mut flags = FLAGS.to_owned();
    if module == Module::Threads {
        flags.push_str(SHARED);
        // A standard library for threads is not distributed, and building one is not stable yet.
        cargo.args(["-Z", "build-std=std,panic_abort"]).env("RUSTC_BOOTSTRAP", "1");
    }
    cargo.env("CARGO_TARGET_WASM32_UNKNOWN_UNKNOWN_RUSTFLAGS", flags);
    cargo
}
