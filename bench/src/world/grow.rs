//! Animations of growing terrain, compared with the terrain itself, by the `orogen` program. CPU time.

use super::figure::{Figure, Target};
use super::process::{program, watch};
use crate::options::Options;

/// Presets with one and with two stages of `stream-power`.
const PRESETS: [&str; 4] = ["volcano", "dla-peaks", "canyon", "alpine"];

/// Maximum ratio of the animation's CPU time to the terrain's.
const DEARER: f64 = 3.0;

/// Runs the measurements.
pub fn measure(options: &Options) -> Result<Vec<Figure>, String> {
    let program = program()?;
    let folder = std::env::temp_dir().join(format!("orogen-bench-grow-{}", std::process::id()));
    std::fs::create_dir_all(&folder).map_err(|e| format!("{}: {e}", folder.display()))?;
    let (film, terrain) = (folder.join("grow.png"), folder.join("terrain"));
    let (film, terrain) = (film.to_string_lossy().into_owned(), terrain.to_string_lossy().into_owned());
    // The minimum of several runs, because other load only adds.
    let runs = if options.repetitions < 9 { 1 } else { 3 };
    let least = |arguments: &[&str]| -> Result<f64, String> {
        let common = ["--size", "512", "--no-cache", "--quiet", "--force"];
        let arguments: Vec<&str> = arguments.iter().copied().chain(common).collect();
        let costs = (0..runs).map(|_| watch(&program, &arguments, f64::INFINITY).map(|(cost, _)| cost.cpu));
        costs.collect::<Result<Vec<f64>, String>>().map(|costs| costs.into_iter().fold(f64::INFINITY, f64::min))
    };
    let figures = PRESETS.map(|preset| {
        let terrain = least(&["generate", preset, "--out", &terrain])?;
        let film = least(&["grow", preset, "--frames", "40", "--out", &film])?;
        Ok(Figure {
            case: format!("film of `{preset}` growing, 40 frames of 512 x 512"),
            ours: film,
            unit: "s",
            other: Some(("generate", terrain)),
            target: Target::RatioAtMost(DEARER),
        })
    });
    // The folder has only files that were made here.
    let _ = std::fs::remove_dir_all(&folder);
    figures.into_iter().collect()
}
