//! `orogen-web-bindgen bind MODULE FOLDER` writes the module and its bindings to JavaScript into a folder;
//! `orogen-web-bindgen pack FILE` replaces a file by `FILE.gz`.
#![forbid(unsafe_code)]

use std::error::Error;
use std::io::Write as _;
use std::process::ExitCode;

use flate2::{Compression, GzBuilder};
use wasm_bindgen_cli_support::Bindgen;

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let words: Vec<&str> = arguments.iter().map(String::as_str).collect();
    let done = match words[..] {
        ["bind", module, folder] => bind(module, folder),
        ["pack", file] => pack(file),
        _ => Err("usage: orogen-web-bindgen bind MODULE FOLDER | pack FILE".into()),
    };
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::FAILURE
        }
    }
}

fn bind(module: &str, folder: &str) -> Result<(), Box<dyn Error>> {
    let mut bindgen = Bindgen::new();
    bindgen.input_path(module).web(true)?.typescript(false).remove_name_section(true).remove_producers_section(true);
    Ok(bindgen.generate(folder).map_err(|error| format!("{error:#}"))?)
}

fn pack(file: &str) -> Result<(), Box<dyn Error>> {
    let bytes = std::fs::read(file)?;
    // Without a time, so that equal modules give equal files.
    let mut packer = GzBuilder::new().mtime(0).write(Vec::new(), Compression::best());
    packer.write_all(&bytes)?;
    std::fs::write(format!("{file}.gz"), packer.finish()?)?;
    std::fs::remove_file(file)?;
    Ok(())
}
