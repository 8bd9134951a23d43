//! `cargo xtask web`: the studio as a page, a folder of static files.

use std::path::PathBuf;

use crate::failure::{Failure, Result};
use crate::web_build::{Profile, build};
use crate::{clients, output, shell};

pub const ABOUT: &str = "build the studio as a page: static files for any host";

pub const HELP: &str = "
Usage: cargo xtask web [--quick] [--no-threads] [FOLDER]

Builds the studio for WebAssembly and writes FOLDER/studio/ [default: target/web]: index.html, its scripts, and two
modules, compressed. A page loads one of them: that with threads where the host's headers allow it, otherwise the other.
Any host of static files can serve the folder.

  --quick       larger modules with the same results, built in a fraction of the time, for tests
  --no-threads  without the module with threads, in half the time

It needs rustup's wasm32-unknown-unknown, and rust-src for threads, which are installed if they are missing.
";

/// Builds the page.
pub fn run(args: &[String]) -> Result {
    let has = |option: &str| args.iter().any(|arg| arg == option);
    let others: Vec<&String> = args.iter().filter(|arg| *arg != "--quick" && *arg != "--no-threads").collect();
    let folder = match others[..] {
        [] => shell::target_dir().join("web"),
        [folder] if !folder.starts_with('-') => PathBuf::from(folder),
        _ => return Err(Failure::usage("expected --quick, --no-threads, a folder, or nothing")),
    };
    clients::install_wasm()?;
    let with_threads = !has("--no-threads") && clients::install_source();
    if !with_threads && !has("--no-threads") {
        output::line(format_args!(
            "The page is built without threads: the source of the standard library is missing. Install it with \
             `rustup component add rust-src`, or silence this with `--no-threads`."
        ));
    }
    let page = build(&folder, if has("--quick") { Profile::Quick } else { Profile::Release }, with_threads)?;
    output::line(format_args!("{}", page.display()));
    Ok(())
}
