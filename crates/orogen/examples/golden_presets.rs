//! Makes every preset with 256 samples along its longer side, at the fastest SIMD level of the machine, and compares
//! the bits with `golden/presets.txt`. For hosts that can neither read files nor run tests, such as WebAssembly without
//! a system (`cargo xtask clients wasm`).
//!
//! The exit code is 0 if all bits are equal, else the number of the first preset that differs, counted from 1; 255 for
//! any other error. The environment variable `OROGEN_PRESETS` at compile time names the presets to make, separated by
//! blanks; without it, all presets are made.

use std::process::ExitCode;

use orogen::grid::analysis::summary;
use orogen::{Level, Options, Session, Window, presets};

const GOLDEN: &str = include_str!("../../../golden/presets.txt");

/// The presets to make; `None` for all presets.
const CHOSEN: Option<&str> = option_env!("OROGEN_PRESETS");

fn main() -> ExitCode {
    match first_difference() {
        Ok(None) => ExitCode::SUCCESS,
        Ok(Some(number)) => ExitCode::from(number),
        Err(error) => {
            eprintln!("{error}");
            ExitCode::from(255)
        }
    }
}

fn first_difference() -> Result<Option<u8>, Box<dyn std::error::Error>> {
    let level = Level::current();
    let chosen: Vec<&str> = CHOSEN.unwrap_or_default().split_whitespace().collect();
    if let Some(unknown) = chosen.iter().find(|name| presets::all().iter().all(|preset| preset.name != **name)) {
        return Err(format!("there is no preset `{unknown}`").into());
    }
    for (number, preset) in (1..).zip(presets::all()) {
        if !chosen.is_empty() && !chosen.contains(&preset.name) {
            continue;
        }
        let world = Session::new(Options::default())?.open(preset.recipe()?)?;
        // An unbounded world: this number of samples at its own cell.
        let window = world.window_fitting(256).unwrap_or(Window::new(256, 256, world.recipe().world.cell));
        let hash = summary(world.window("height", &window)?.data(), 0.0).sha256;
        let expected = GOLDEN.lines().find_map(|line| line.strip_prefix(preset.name)?.strip_prefix(' '));
        println!("{level} {} {hash}", preset.name);
        if expected != Some(hash.as_str()) {
            return Ok(Some(number));
        }
    }
    Ok(None)
}
