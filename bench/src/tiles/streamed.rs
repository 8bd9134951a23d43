//! Maps of a billion cells by the `orogen` program, in bounded memory, with all files of such a map.
//!
//! It needs 20 GiB of disk space for temporary files, and takes minutes.

use std::path::PathBuf;

use super::RECIPE;
use crate::options::Options;
use crate::world::figure::{Figure, Target};
use crate::world::process::{Cost, program, watch};

/// Cells along a side: of the large map, of the large map in a quick run, and of the map with which it is compared.
const LARGE: usize = 31_623;
const MIDDLE: usize = 8_192;
const SMALL: usize = 4_096;

/// The memory limit, and the maximum resident memory including code, in MiB.
const MEMORY: &str = "256MiB";
const MAX_MIB: f64 = 1.1 * 256.0;

/// Maximum ratio of the CPU time per cell to the small map's.
const DEARER: f64 = 1.15;

/// The classes of the map.
const CLASSES: &str = r#"
    [[class]]
    name = "grass"
    [[class]]
    name = "forest"
    height = { min = 0.1 }
    [[class]]
    name = "rock"
    height = { min = 0.25 }
    [[class]]
    name = "snow"
    height = { min = 0.35 }
    [[class]]
    name = "sand"
    height = { max = -0.05 }
    [[class]]
    name = "water"
    height = { max = -0.1 }
"#;

/// The folder of maps, removed at the end.
struct Bench {
    program: PathBuf,
    folder: PathBuf,
}

impl Drop for Bench {
    fn drop(&mut self) {
        // The folder has only files that were made here.
        let _ = std::fs::remove_dir_all(&self.folder);
    }
}

/// Runs the measurements.
pub fn measure(options: &Options) -> Result<Vec<Figure>, String> {
    let name = "streamed";
    if !name.contains(&options.case) {
        return Ok(Vec::new());
    }
    let folder = std::env::temp_dir().join(format!("orogen-bench-tiles-{}", std::process::id()));
    std::fs::create_dir_all(&folder).map_err(|e| format!("{}: {e}", folder.display()))?;
    let bench = Bench { program: program()?, folder };
    let path = bench.folder.join("land.toml");
    std::fs::write(&path, format!("{RECIPE}{CLASSES}")).map_err(|e| format!("{}: {e}", path.display()))?;
    // A quick run only shows that it works, at a size that takes seconds.
    let large = if options.repetitions < 9 { MIDDLE } else { LARGE };
    let (large_map, small_map) = (bench.map(large)?, bench.map(SMALL)?);
    let per_cell = |cost: Cost, side: usize| cost.cpu * 1e9 / (side * side) as f64;
    let case = format!("{large} x {large} cells {name} to all files under {MEMORY}");
    let memory = large_map.memory as f64 / f64::from(1 << 20);
    Ok(vec![
        Figure { case: case.clone(), ours: large_map.wall, unit: "s", other: None, target: Target::None },
        Figure {
            case: format!("{case}: memory"),
            ours: memory,
            unit: "MiB",
            other: None,
            target: Target::AtMost(MAX_MIB),
        },
        Figure {
            case: format!("{case}: CPU time of a cell"),
            ours: per_cell(large_map, large),
            unit: "ns",
            other: Some(("4096 x 4096 cells", per_cell(small_map, SMALL))),
            target: Target::RatioAtMost(DEARER),
        },
    ])
}

impl Bench {
    /// The cost of a map.
    fn map(&self, side: usize) -> Result<Cost, String> {
        let path = |name: &str| self.folder.join(name).display().to_string();
        let (recipe, out, window) = (path("land.toml"), path("map"), format!("0,0,{side},{side}"));
        let arguments = ["tilemap", &recipe, "--window", &window, "--memory", MEMORY, "-o", &out, "-q", "--force"];
        let (cost, _) = watch(&self.program, &arguments, f64::INFINITY)?;
        std::fs::remove_dir_all(&out).map_err(|e| format!("{out}: {e}"))?;
        Ok(cost)
    }
}
