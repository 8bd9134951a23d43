//! `cargo xtask bench`: measures all published figures.

mod critic;
mod peers;
mod realism;
mod refine;
mod report;

use std::path::PathBuf;

use crate::failure::{Failure, Result, on_file};
use crate::{shell, table};

pub const ABOUT: &str = "compare with other libraries and the machine's limits; print a table, write JSON";

pub const HELP: &str = "
Usage: cargo xtask bench [AREA] [--json FILE] [--case TEXT] [--quick]
       cargo xtask bench realism [--peers] [--half HALF] [--first SEED] [--case TEXT]
       cargo xtask bench critic --dems DIR --control DIR [--first SEED]
       cargo xtask bench refine --dems DIR [--factor N]
       cargo xtask bench coasts SOURCE... [--seed N] [--cell M] [--window X,Y,W,H]
       cargo xtask bench valleys SOURCE... [--seed N] [--cell M] [--window X,Y,W,H]
       cargo xtask bench fans SOURCE... [--seed N] [--cell M] [--window X,Y,W,H]
       cargo xtask bench water RECIPE [--seed N] [--cell M] [--origin X,Y] [--side N] [--pairs N] [--pair-side N] [--near N] [--fresh]

Builds the benches at full optimization, measures one area (or all in turn) and prints a table.

  AREA         noise     noise kernels compared with other crates, one thread, CPU time; AVX2, memory and two threads
               erosion   depressions, drainage, a stream power step and hillshade compared with richdem, fastscapelib and matplotlib
                         (installed with pip; one that fails to install is omitted), erosion filters, CPU time of one thread; two
                         threads; worlds of 512 x 512 to 4096 x 4096 cells; OROGEN_RICHDEM, OROGEN_FASTSCAPELIB and OROGEN_MATPLOTLIB name a Python that has them
               generate  `orogen generate` for every preset, all cores, wall time
               outputs   contours compared with contourpy, meshes with pydelatin and OpenEXR files with its library (installed with pip; OROGEN_CONTOURPY,
                         OROGEN_PYDELATIN and OROGEN_OPENEXR name a Python that has them) and a Cloud-Optimized GeoTIFF with
                         gdal_translate, CPU time; maps of 4096 x 4096 and a rendered view, wall time
               world     chunks, tiles with halos, threads and whole builds of hills of noise, animations of growing presets; the builds (--case build) take
                         minutes and a dozen GiB of disk
               tiles     terrain classes, clean-up and tiles of a map of 4096 x 4096 cells, climate and biomes of 2048 x 2048 samples; chunks of
                         blocks; all cores, wall time
               studio    from a change of a parameter to the pictures of the studio, without the drawing of the window; all cores, wall time
               python    windows, hydrology, analysis and noise from the Python package compared with the same calls in Rust and with richdem, fastscapelib,
                         pysheds, xarray-spatial, WhiteboxTools, noise and opensimplex (installed with pip, as above), CPU time
               serve     `orogen serve` under load over loopback: warm and cold tiles, memory of mixed requests, requests that are aborted; --case soak
                         takes ten minutes
               gpu       only if it is named: terrain and pictures on the first graphics card, beside a copy within its memory and beside the
                         processor, wall time; a software adapter has no targets
  --json FILE  also write the rows as JSON; needs an AREA
  --case TEXT  only cases whose name contains TEXT
  --quick      few repetitions: only to check that it runs

Area realism, only if it is named: compares every preset with windows of real land of its type, 16 seeds each, by the scripts of the folder `realism`
(OROGEN_REALISM names a Python that has the packages of its requirements.txt); fails if a target is missed.

  --peers         other generators beside presets, 6 seeds each, as a table in Markdown, without targets (fastscapelib and landlab are installed with pip, as
                  above; OROGEN_FASTSCAPELIB and OROGEN_LANDLAB name a Python that has them): docs/realism.md
  --half HALF     first or second: compares with every second region of each type only; what is tuned on one half is reported on the other
  --first SEED    the first of the seeds [default: from the clock]

Area refine, only if it is named: averages real places to several times their cell, refines them by `orogen refine` and by cubic interpolation, and compares
them with the original: errors of heights, rivers, depressions, realism.

  --dems DIR      the real places, GeoTIFFs of 30 to 90 m
  --factor N      averages to 2, 4 or 8 times the cell [default: 4]

Area critic, only if it is named: trains a small network to tell presets from real places, and prints how often it can (AUC; PyTorch is installed with pip;
OROGEN_TRAINING names a Python that has it): docs/realism.md.

  --dems DIR      the real places, GeoTIFFs of 30 to 90 m
  --control DIR   other real places, which nobody could tell from the first
  --first SEED    the first of six seeds [default: 1]

Area coasts, only if it is named: measures continents: the share of land, the dimension of the coast by counted boxes of 2 and 16 cells, islands below 1000
cells, the share of the sea at distances from the coast that is shallower than 200 m, and the heights of the land.

  SOURCE            presets, recipe files and files of heights in metres, such as windows of a relief of the Earth in an equal-area projection
  --seed N          seed of presets [default: the recipe's]
  --cell M          cell in metres [default: 30720]
  --window X,Y,W,H  first column and row, columns and rows [default: the whole world; 256 x 256 cells around the origin of `endless`]

Area valleys, only if it is named: measures the form of valleys: the exponent of their cross sections (1 is a V, 2 a parabola) along rivers of 5 to 300 km2,
and the steps at the mouths of tributaries, the fall of their last 1.2 km beyond what the 1.2 km above them let expect.

  SOURCE            presets, recipe files and files of heights, real ones too
  --seed N          seed of presets [default: the recipe's]
  --cell M          cell in metres [default: that of the recipe or file]
  --window X,Y,W,H  first column and row, columns and rows [default: the whole world]

Area fans, only if it is named: measures alluvial fans of recipes with an output `sediment`: their slopes by distance from the apex, their areas, and
depressions; with the options of area valleys.

Area water, only if it is named: measures the water of a recipe on 3 x 3 tiles that are made apart: depressions, beds of rivers, agreement of D8 on
the heights with `flow`, rivers at the borders of tiles; fails if a target is missed.

  RECIPE         a preset or a recipe file with the outputs `height` and `flow`, and optionally `lakes` and `receiver`
  --seed N       seed of the world [default: the recipe's]
  --cell M       cell in metres [default: the recipe's]
  --origin X,Y   column and row of the first cell [default: 0,0]
  --side N       cells along the side of a tile [default: a third of the world; 512 if it is unbounded]
  --pairs N      pairs of adjacent windows at random positions [default: 200]
  --pair-side N  cells along the side of each of these windows [default: 64]
  --near N       pairs in the same region of 1024 x 1024 cells: more are faster, because they are made from the same coarse tiles [default: 1]
  --fresh        makes every window of the pairs in a session of its own, not the first windows of all pairs in one and the second in another; each tile
                 of the mosaic is always made so

How to read the table: docs/benchmarks.md.
";

/// The areas of the bench program.
const AREAS: &[&str] = &["noise", "erosion", "generate", "world", "outputs", "tiles", "studio", PYTHON, "serve"];

/// An area that needs the Python package.
const PYTHON: &str = "python";

/// An area that builds the libraries of graphics drivers, so it is measured only if it is named.
const GPU: &str = "gpu";

/// An area that takes long, so it is measured only if it is named.
const REALISM: &str = "realism";

/// An area that needs files that are not part of the project, so it is measured only if it is named.
const REFINE: &str = "refine";

/// Another such area.
const CRITIC: &str = "critic";

/// Areas that measure recipes, so they run only if they are named.
const WATER: &str = "water";
const VALLEYS: &str = "valleys";
const COASTS: &str = "coasts";
const FANS: &str = "fans";

#[derive(Debug, Default, PartialEq, Eq)]
struct Options {
    area: Option<String>,
    json: Option<PathBuf>,
    /// Arguments for the bench program.
    passed: Vec<String>,
    /// Options of area `realism`.
    realism: realism::Options,
    /// The real places of areas `refine` and `critic`.
    dems: Option<PathBuf>,
    /// The other real places of area `critic`.
    control: Option<PathBuf>,
    /// Its coarse cell over the fine one.
    factor: Option<String>,
}

/// Runs the measurements.
pub fn run(args: &[String]) -> Result {
    if let [area, rest @ ..] = args
        && [COASTS, FANS, VALLEYS, WATER].contains(&area.as_str())
    {
        let mut command = shell::cargo("run --quiet --release --package orogen-bench --");
        return shell::run(command.arg(area).args(rest));
    }
    let options = parse(args)?;
    let areas: Vec<&str> = options.area.as_deref().map_or_else(|| AREAS.to_vec(), |area| vec![area]);
    if areas.len() > 1 && options.json.is_some() {
        return Err(Failure::usage("--json holds one area: name it"));
    }
    // Whole runs are measured with the program that users run.
    shell::run(&mut shell::cargo("build --quiet --release --package orogen-cli --features orogen-cli/serve"))?;
    let program = shell::target_dir().join("release").join(format!("orogen{}", std::env::consts::EXE_SUFFIX));
    for area in areas {
        if area == REALISM {
            realism::run(&options.realism, &program)?;
            continue;
        }
        if area == REFINE {
            refine::run(options.dems.as_deref(), options.factor.as_deref().unwrap_or("4"), &program)?;
            continue;
        }
        if area == CRITIC {
            let folders = critic::Options { dems: options.dems.clone(), control: options.control.clone() };
            critic::run(&folders, options.realism.first.unwrap_or(1), &program)?;
            continue;
        }
        let features = if area == GPU { "peers,gpu" } else { "peers" };
        let mut command =
            shell::cargo(&format!("run --quiet --profile bench --package orogen-bench --features {features} --"));
        command.envs(peers::installed(area));
        if area == PYTHON {
            // CPU time is that of the process.
            command.envs([peers::package()?]).env("RAYON_NUM_THREADS", "1");
        }
        let measured = shell::capture(command.arg(area).args(&options.passed).env("OROGEN_BIN", &program))?;
        let report = report::Report::read(&measured)?;
        println!("{}", report.heading());
        println!("{}", table::render(&report::HEAD, &report.cells()));
        if let Some(path) = &options.json {
            std::fs::write(path, report.json()).map_err(|e| on_file("write", path, &e))?;
            println!("\nwritten to {}", path.display());
        }
    }
    Ok(())
}

fn parse(args: &[String]) -> Result<Options> {
    let mut options = Options::default();
    let mut args = args.iter();
    while let Some(arg) = args.next() {
        let mut value = || args.next().cloned().ok_or_else(|| Failure::usage(format!("{arg} needs a value after it")));
        match arg.as_str() {
            "--json" => options.json = Some(value()?.into()),
            "--case" => {
                let text = value()?;
                options.realism.case = Some(text.clone());
                options.passed.extend([arg.clone(), text]);
            }
            "--half" => options.realism.half = Some(realism::Half::parse(&value()?)?),
            "--dems" => options.dems = Some(value()?.into()),
            "--control" => options.control = Some(value()?.into()),
            "--factor" => options.factor = Some(value()?),
            "--peers" => options.realism.peers = true,
            "--first" => {
                let seed = value()?;
                let seed = seed.parse().map_err(|_| Failure::usage(format!("'{seed}' is no seed: a whole number")))?;
                options.realism.first = Some(seed);
            }
            "--quick" => options.passed.push(arg.clone()),
            area if (AREAS.contains(&area) || [REALISM, REFINE, CRITIC, GPU].contains(&area))
                && options.area.is_none() =>
            {
                options.area = Some(area.to_owned())
            }
            flag if flag.starts_with('-') => return Err(Failure::usage(format!("there is no option '{flag}'"))),
            other => {
                return Err(Failure::usage(format!(
                    "there is no area '{other}'; there are: {}, {COASTS}, {CRITIC}, {FANS}, {REALISM}, {REFINE}, {VALLEYS}, {WATER}",
                    AREAS.join(", ")
                )));
            }
        }
    }
    Ok(options)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parsed(line: &str) -> Result<Options> {
        parse(&line.split_whitespace().map(str::to_owned).collect::<Vec<_>>())
    }

    #[test]
    fn options() {
        let options = parsed("noise --json a.json --case perlin --quick").expect("well formed");
        assert_eq!(options.area.as_deref(), Some("noise"));
        assert_eq!(options.json, Some("a.json".into()));
        assert_eq!(options.passed, ["--case", "perlin", "--quick"]);
        let options = parsed("realism --peers --first 7 --case far").expect("well formed");
        assert_eq!((options.area.as_deref(), options.realism.first), (Some("realism"), Some(7)));
        assert_eq!((options.realism.peers, options.realism.case), (true, Some("far".into())));
        for (line, expect) in [
            ("nois", "there is no area 'nois'; there are: noise, erosion, generate"),
            ("--json", "--json needs a value"),
            ("realism --first x", "'x' is no seed"),
            ("realism --half third", "not 'third'"),
            ("noise --fast", "no option '--fast'"),
        ] {
            let failure = parsed(line).expect_err(expect);
            assert!(failure.message().contains(expect), "{}", failure.message());
        }
    }
}
