//! `orogen-web-bindgen bind MODULE FOLDER` writes the module and its bindings to JavaScript into a folder;
//! `orogen-web-bindgen pack FILE` replaces a file by `FILE.gz`, and
//! `orogen-web-bindgen squeeze FILE` by a smaller one, which takes minutes.
#![forbid(unsafe_code)]

use std::error::Error;
use std::io::Write as _;
use std::num::NonZeroU64;
use std::process::ExitCode;

use flate2::{Compression, GzBuilder};
use wasm_bindgen_cli_support::Bindgen;

/// Rounds of the search for shorter codes: with three of them, 19 MB take half a minute.
const ROUNDS: NonZeroU64 = NonZeroU64::new(3).unwrap();

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let words: Vec<&str> = arguments.iter().map(String::as_str).collect();
    let done = match words[..] {
        ["bind", module, folder] => bind(module, folder),
        ["pack", file] => replace(file, pack),
        ["squeeze", file] => replace(file, squeeze),
        _ => Err("usage: orogen-web-bindgen bind MODULE FOLDER | pack FILE | squeeze FILE".into()),
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

fn replace(file: &str, packed: fn(&[u8]) -> std::io::Result<Vec<u8>>) -> Result<(), Box<dyn Error>> {
    let bytes = std::fs::read(file)?;
    std::fs::write(format!("{file}.gz"), packed(&bytes)?)?;
    std::fs::remove_file(file)?;
    Ok(())
}

fn pack(bytes: &[u8]) -> std::io::Result<Vec<u8>> {
    // Without a time, so that equal modules give equal files.
    let mut packer = GzBuilder::new().mtime(0).write(Vec::new(), Compression::best());
    packer.write_all(bytes)?;
    packer.finish()
}

fn squeeze(bytes: &[u8]) -> std::io::Result<Vec<u8>> {
    let options = zopfli::Options { iteration_count: ROUNDS, ..zopfli::Options::default() };
    let mut packed = Vec::new();
    zopfli::compress(options, zopfli::Format::Gzip, bytes, &mut packed)?;
    Ok(packed)
}
