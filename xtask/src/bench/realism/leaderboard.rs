//! `cargo xtask bench realism --peers`: generators of many kinds beside real land, as a table in Markdown.

use std::path::{Path, PathBuf};

use super::CASES;
use super::judge::{Judge, Score, folder as scripts};
use super::make::{self, Made};
use crate::bench::peers;
use crate::failure::Result;
use crate::{host, shell};

/// A generator of land of a type.
struct Generator {
    name: &'static str,
    source: Source,
    /// The type of land.
    kind: &'static str,
}

/// How land is made. A generator is given the mean slope of its type by a parameter.
#[derive(Clone, Copy)]
enum Source {
    /// A recipe of `realism/generators`, and what is set in it.
    Recipe(&'static str, &'static str),
    /// A script there, and the variable of its peer.
    Script(&'static str, &'static str),
    /// A preset, and the side of the square that is judged in samples, or its usual samples.
    Preset(&'static str, Option<u32>),
}

/// Samples per side and cell in metres of recipes and scripts.
const SIDE: u32 = 512;
const CELL: u32 = 60;

const SEEDS: u64 = 6;

const fn recipe(name: &'static str, kind: &'static str, file: &'static str, set: &'static str) -> Generator {
    Generator { name, source: Source::Recipe(file, set), kind }
}

const fn preset(name: &'static str, kind: &'static str) -> Generator {
    Generator { name, source: Source::Preset(name, None), kind }
}

const fn script(name: &'static str, kind: &'static str, file: &'static str, variable: &'static str) -> Generator {
    Generator { name, source: Source::Script(file, variable), kind }
}

const fn fastscapelib(kind: &'static str) -> Generator {
    script("stream power, fastscapelib", kind, "stream_power_fastscapelib.py", "OROGEN_FASTSCAPELIB")
}

const fn landlab(kind: &'static str) -> Generator {
    script("stream power, landlab", kind, "stream_power_landlab.py", "OROGEN_LANDLAB")
}

const MOUNTAINS: &str = "mountains";
const HILLS: &str = "rolling_hills";

const GENERATORS: &[Generator] = &[
    recipe("white noise", MOUNTAINS, "white", "height=150"),
    recipe("Perlin noise", MOUNTAINS, "perlin", "height=560"),
    recipe("fBm", MOUNTAINS, "fbm", "height=3400"),
    recipe("fBm damped by slope", MOUNTAINS, "weighted-fbm", "height=4800"),
    recipe("ridged noise", MOUNTAINS, "ridged", "height=2100"),
    recipe("diffusion-limited aggregate", MOUNTAINS, "dla", "height=1550"),
    recipe("fBm and droplets", MOUNTAINS, "droplets", "height=3600"),
    recipe("fBm and shallow water (pipes)", MOUNTAINS, "pipes", "height=3400"),
    fastscapelib(MOUNTAINS),
    landlab(MOUNTAINS),
    recipe("stream power, ours", MOUNTAINS, "stream-power", "uplift=0.18"),
    Generator { name: "alpine", source: Source::Preset("alpine", Some(SIDE)), kind: MOUNTAINS },
    Generator { name: "endless", source: Source::Preset("endless", Some(SIDE)), kind: MOUNTAINS },
    preset("himalaya", MOUNTAINS),
    recipe("white noise", HILLS, "white", "height=150"),
    recipe("Perlin noise", HILLS, "perlin", "height=145"),
    recipe("fBm", HILLS, "fbm", "height=900"),
    recipe("fBm damped by slope", HILLS, "weighted-fbm", "height=1250"),
    recipe("ridged noise", HILLS, "ridged", "height=515"),
    recipe("fBm and droplets", HILLS, "droplets", "height=950"),
    recipe("fBm and shallow water (pipes)", HILLS, "pipes", "height=900"),
    fastscapelib(HILLS),
    landlab(HILLS),
    recipe("stream power, ours", HILLS, "stream-power", "uplift=0.05"),
    preset("rolling", HILLS),
    preset("hills", HILLS),
    recipe("fBm", "canyons", "fbm", "height=2500"),
    preset("canyon", "canyons"),
    preset("mesa", "canyons"),
    recipe("fBm", "deserts", "fbm", "height=900"),
    preset("badlands", "deserts"),
    preset("basin", "deserts"),
    recipe("fBm", "glacial", "fbm", "height=2950"),
    preset("fjords", "glacial"),
    preset("glaciers", "glacial"),
    recipe("fBm", "islands_coasts", "fbm", "height=1300"),
    preset("archipelago", "islands_coasts"),
    preset("island", "islands_coasts"),
    recipe("fBm", "volcanoes", "fbm", "height=2150"),
    preset("volcano", "volcanoes"),
];

/// Makes land of all generators whose name has been chosen, and prints the table.
pub fn run(judge: &Judge, program: &Path, folder: &Path, first: u64, is_named: impl Fn(&str) -> bool) -> Result {
    println!("{}, {}, seeds {first} to {}\n\n{HEAD}", host::date(), host::processor(), first + SEEDS - 1);
    let mut kind = "";
    let chosen = GENERATORS.iter().filter(|generator| is_named(generator.name) && judge.knows(generator.kind));
    for generator in chosen {
        if let Some(found) = judged(generator, judge, program, folder, first)? {
            if generator.kind != kind {
                kind = generator.kind;
                println!("{}", real_row(kind, &found));
            }
            println!("{}", row(generator, &found));
        }
    }
    Ok(())
}

/// The figures of a generator, or `None` if it cannot be installed or makes only level ground.
fn judged(generator: &Generator, judge: &Judge, program: &Path, folder: &Path, first: u64) -> Result<Option<Score>> {
    let mut files = Vec::new();
    let mut cell = CELL;
    for seed in first..first + SEEDS {
        let name = match generator.source {
            Source::Recipe(name, _) | Source::Script(name, _) | Source::Preset(name, _) => name,
        };
        let file = folder.join(format!("{name}-{seed}.tif"));
        let file = match generator.source {
            Source::Recipe(recipe, set) => recipe_file(program, recipe, set, seed, file)?,
            Source::Script(script, variable) => {
                let Some(python) = peers::python(variable) else { return Ok(None) };
                let file = file.with_extension("npy");
                // The same land is compared with several types.
                if !file.is_file() {
                    let mut command = shell::program(python);
                    command.arg(scripts().join("generators").join(script)).arg(seed.to_string()).arg(&file);
                    shell::run(&mut command)?;
                }
                file
            }
            Source::Preset(preset, side) => {
                let made = samples(preset, side);
                cell = made.cell();
                make::preset(program, preset, made, seed, &file)?;
                file
            }
        };
        files.push(file);
    }
    judge.compare(&files, generator.kind, cell)
}

/// Exports a recipe: the middle of worlds that are larger.
fn recipe_file(program: &Path, recipe: &str, set: &str, seed: u64, file: PathBuf) -> Result<PathBuf> {
    let mut command = shell::program(program);
    command.arg("export").arg(scripts().join("generators").join(recipe).with_extension("toml"));
    command.args(["--quiet", "--no-cache", "--set", set, "--seed", &seed.to_string()]);
    if recipe == "dla" {
        command.args(["--window", &format!("{0},{0},{SIDE},{SIDE}", SIDE / 2)]);
    }
    shell::run(command.arg("--force").arg("-o").arg(&file))?;
    Ok(file)
}

/// The samples of a preset that are judged.
fn samples(preset: &str, side: Option<u32>) -> Made {
    let usual = CASES.iter().find(|case| case.preset == preset).map_or(Made::World(CELL), |case| case.made);
    match (usual, side) {
        (Made::From(corner, usual), Some(side)) => {
            Made::From(corner.map(|at| at + i64::from(usual / 2) - i64::from(side / 2)), side)
        }
        (made, _) => made,
    }
}

const HEAD: &str = "\
| beside | generator | windows | score | p90 | energy | stand out | grid bias | pits | filled |
|---|---|--:|--:|--:|--:|--:|--:|--:|--:|";

/// The row of the real windows of a type.
fn real_row(kind: &str, found: &Score) -> String {
    let real = &found.real;
    let energy = if found.energy.is_nan() { "-" } else { "1.00" };
    format!(
        "| {} | *real land* | {} | 1.00 | {:.2} | {energy} | | {:.3} | | {:.1} % |",
        kind.replace('_', " "),
        real.windows,
        real.p90,
        real.bias,
        real.filled * 100.0
    )
}

fn row(generator: &Generator, found: &Score) -> String {
    let name = match generator.source {
        Source::Recipe(file, set) => {
            format!("[{}](../realism/generators/{file}.toml), `{set}`", generator.name)
        }
        Source::Script(script, _) => format!("[{}](../realism/generators/{script})", generator.name),
        Source::Preset(preset, _) => format!("preset `{preset}`"),
    };
    let all = found.judged + found.dropped;
    let windows = if found.dropped == 0.0 { format!("{all}") } else { format!("{} of {all}", found.judged) };
    let energy = if found.energy.is_nan() { "-".to_owned() } else { format!("{:.2}", found.energy) };
    format!(
        "| | {name} | {windows} | {:.2} | {:.2} | {energy} | {} | {:.3} | {:.2} % | {:.1} % |",
        found.median,
        found.p90,
        found.stand_out,
        found.bias,
        found.pits * 100.0,
        found.filled * 100.0
    )
}

#[cfg(test)]
mod tests {
    use super::super::judge::SAMPLE;
    use super::*;

    #[test]
    fn every_recipe_and_script_is_there() {
        for generator in GENERATORS {
            let file = match generator.source {
                Source::Recipe(recipe, _) => format!("{recipe}.toml"),
                Source::Script(script, ..) => script.to_owned(),
                Source::Preset(preset, _) => {
                    assert!(CASES.iter().any(|case| case.preset == preset), "{preset} is no case");
                    continue;
                }
            };
            assert!(scripts().join("generators").join(&file).is_file(), "{file} is missing");
        }
    }

    #[test]
    fn a_row_links_its_recipe() {
        let generator = recipe("fBm", HILLS, "fbm", "height=900");
        let expect = "| | [fBm](../realism/generators/fbm.toml), `height=900` | 250 of 256 | 0.70 | 0.85 | 0.41 | 1 | \
            0.006 | 0.10 % | 2.0 % |";
        assert_eq!(row(&generator, &SAMPLE), expect);
    }

    #[test]
    fn the_middle_of_a_preset_is_judged() {
        assert!(matches!(samples("endless", Some(512)), Made::From([-256, -256], 512)));
        assert!(matches!(samples("rolling", None), Made::World(45)));
    }
}
