//! `cargo xtask web`: the studio as a page, a folder of static files.

use std::path::PathBuf;

use crate::failure::{Failure, Result};
use crate::web_build::{Profile, build};
use crate::{clients, output, shell};

pub const ABOUT: &str = "build the studio as a page: static files for any host";

pub const HELP: &str = "
Usage: cargo xtask web [--quick] [FOLDER]

Builds the studio for WebAssembly and writes FOLDER/studio/ [default: target/web]: index.html, its scripts, and the
module, compressed. Any host of static files can serve the folder.

  --quick  a larger module with the same results, built in a fraction of the time, for tests

It needs rustup's wasm32-unknown-unknown, which is installed if it is missing.
";

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
