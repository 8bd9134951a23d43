//! Land of presets, as files.

use std::path::Path;

use crate::failure::{Result, on_file};
use crate::shell;

/// The compared samples of a preset.
#[derive(Clone, Copy)]
pub enum Made {
    /// Samples at [`CELL`] metres from this sample, and their number along a side.
    From([i64; 2], u32),
    /// [`HIGHEST_SIDE`] samples per side around the highest place within 490 km of this sample: land elsewhere may be
    /// sea or plain.
    Highest([i64; 2]),
    /// The whole world at a cell in metres.
    World(u32),
}

impl Made {
    /// The cell in metres.
    pub const fn cell(self) -> u32 {
        match self {
            Self::From(..) | Self::Highest(_) => CELL,
            Self::World(cell) => cell,
        }
    }
}

/// The cell of windows of mountains in metres.
const CELL: u32 = 60;
/// Samples per side around the highest place.
const HIGHEST_SIDE: u32 = 1024;

/// The cell at which the highest place is searched, in samples.
const FAR_CELL: i64 = 128;
/// Side of the window in which the highest place is searched, in samples at that cell.
const FAR_SIDE: i64 = 128;

/// Exports the samples of a preset.
pub fn preset(program: &Path, preset: &str, made: Made, seed: u64, file: &Path) -> Result {
    let mut command = shell::program(program);
    let layer = layer(preset)?;
    command.args(["export", preset, "--quiet", "--layer", layer, "--seed", &seed.to_string()]);
    command.args(["--cell", &made.cell().to_string()]);
    let window = match made {
        Made::World(_) => None,
        Made::From(corner, side) => Some((corner, side)),
        Made::Highest(at) => {
            let half = i64::from(HIGHEST_SIDE) / 2;
            Some((highest(program, preset, seed, at)?.map(|index| index - half), HIGHEST_SIDE))
        }
    };
    if let Some(([x, y], side)) = window {
        command.args(["--window", &format!("{x},{y},{side},{side}")]);
    }
    shell::run(command.arg("--force").arg("-o").arg(file))
}

/// The layer of a preset that is compared. Models of real heights have the surface of lakes and of the sea, not their
/// beds.
fn layer(preset: &str) -> Result<&'static str> {
    let recipe = shell::root().join(format!("crates/orogen-engine/recipes/{preset}.toml"));
    let text = std::fs::read_to_string(&recipe).map_err(|e| on_file("read", &recipe, &e))?;
    Ok(if text.lines().any(|line| line.starts_with("surface = ")) { "surface" } else { "height" })
}

/// The sample at the highest place around a sample, found at a larger cell.
fn highest(program: &Path, preset: &str, seed: u64, at: [i64; 2]) -> Result<[i64; 2]> {
    let first = at.map(|index| index / FAR_CELL - FAR_SIDE / 2);
    let window = format!("{},{},{FAR_SIDE},{FAR_SIDE}", first[0], first[1]);
    let cell = (i64::from(CELL) * FAR_CELL).to_string();
    let mut command = shell::program(program);
    command.args(["export", preset, "--quiet", "--seed", &seed.to_string(), "--cell", &cell, "--window", &window]);
    let text = shell::capture(command.args(["--format", "asc", "-o", "-"]))?;
    // A header of lines that begin with a letter, then rows from north to south.
    let rows = text.lines().filter(|line| !line.trim_start().starts_with(|first: char| first.is_ascii_alphabetic()));
    let mut best = (f64::NEG_INFINITY, first);
    for (row, y) in rows.zip(first[1]..) {
        for (height, x) in row.split_whitespace().filter_map(|word| word.parse::<f64>().ok()).zip(first[0]..) {
            if height > best.0 {
                best = (height, [x, y].map(|index| index * FAR_CELL));
            }
        }
    }
    Ok(best.1)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn presets_without_lakes_are_compared_by_their_heights() {
        assert_eq!(layer("hills").ok(), Some("surface"));
        assert_eq!(layer("mesa").ok(), Some("height"));
    }
}
