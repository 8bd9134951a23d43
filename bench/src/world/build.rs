//! Whole builds by the `orogen` program: 32768 x 32768 samples under 1 GiB, compared with small ones; two threads;
//! resuming.
//!
//! It needs a dozen GiB of disk space for temporary files, and takes minutes. CPU time is compared, which other load
//! changes little; threads are compared by wall time.

use std::path::{Path, PathBuf};

use super::figure::{Figure, Target};
use super::hills;
use super::process::{Cost, program, watch};
use crate::options::Options;

/// Samples per side: of the large build, of the build with which it is compared, and of the build whose wall time is
/// measured.
const LARGE: usize = 32_768;
const SMALL: usize = 4_096;
const MIDDLE: usize = 8_192;

/// The memory limit of a build, and the maximum resident memory including code.
const MEMORY: &str = "1GiB";
const MAX_GIB: f64 = 1.2;

/// Maximum ratio of the cost per sample in the large build.
const DEARER: f64 = 1.15;

/// Required speedup of two threads.
const FASTER: f64 = 1.9;

/// Maximum share of a whole build for resuming after a kill at half time.
const RESUMED: f64 = 0.55;

const FORMS: [(&str, &str); 2] = [("Zarr", "zarr"), ("COG", "tif")];

/// The folder of builds, removed at the end.
struct Bench {
    program: PathBuf,
    folder: PathBuf,
    cell: f64,
}

impl Drop for Bench {
    fn drop(&mut self) {
        // The folder has only files that were made here.
        let _ = std::fs::remove_dir_all(&self.folder);
    }
}

/// Runs the measurements.
pub fn measure(options: &Options) -> Result<Vec<Figure>, String> {
    let program = program()?;
    let folder = std::env::temp_dir().join(format!("orogen-bench-build-{}", std::process::id()));
    std::fs::create_dir_all(&folder).map_err(|e| format!("{}: {e}", folder.display()))?;
    let recipe = hills::stretched()?;
    let length = recipe.world.size.ok_or("`hills` has bounds")?[0];
    let bench = Bench { program, folder, cell: length / LARGE as f64 };
    let path = bench.folder.join("hills.toml");
    std::fs::write(&path, recipe.to_toml()).map_err(|e| format!("{}: {e}", path.display()))?;
    // A quick run only shows that it works, at a size that takes seconds.
    let large = if options.repetitions < 9 { MIDDLE } else { LARGE };
    let mut figures = Vec::new();
    for (name, extension) in FORMS {
        bench.form(name, extension, large, &mut figures)?;
    }
    Ok(figures)
}

impl Bench {
    fn form(&self, name: &str, extension: &str, large: usize, figures: &mut Vec<Figure>) -> Result<(), String> {
        let per_sample = |cost: Cost, side: usize| cost.cpu * 1e9 / (side * side) as f64;
        let mut add =
            |case: String, ours, unit, other, target| figures.push(Figure { case, ours, unit, other, target });
        let small = self.best(extension, SMALL, 3, &[])?;
        let whole = self.best(extension, large, 1, &[])?;
        let what = format!("build {large} x {large} to {name} under {MEMORY}");
        let gib = whole.memory as f64 / f64::from(1 << 30);
        add(format!("{what}, memory at most"), gib, "GiB", None, Target::AtMost(MAX_GIB));
        let compared = Some(("4096 x 4096", per_sample(small, SMALL)));
        add(
            format!("{what}, ratio at most"),
            per_sample(whole, large),
            "ns/sample",
            compared,
            Target::RatioAtMost(DEARER),
        );
        let resumed = self.resumed(extension, large, whole.cpu / 2.0)?;
        let compared = Some(("whole build", whole.cpu));
        add(
            format!("{what}, resumed after a kill at half time, ratio at most"),
            resumed.cpu,
            "s of processors",
            compared,
            Target::RatioAtMost(RESUMED),
        );
        let one = self.best(extension, MIDDLE, 3, &["--threads", "1"])?;
        let two = self.best(extension, MIDDLE, 3, &["--threads", "2"])?;
        add(
            format!("build {MIDDLE} x {MIDDLE} to {name}, two threads, faster by"),
            two.wall,
            "s on the wall",
            Some(("one thread", one.wall)),
            Target::FasterBy(FASTER),
        );
        Ok(())
    }

    /// The arguments of a build around the middle of the world, so that samples are similar at any size.
    fn arguments(&self, out: &Path, side: usize, more: &[&str]) -> Vec<String> {
        let corner = (LARGE - side) / 2;
        let fixed = ["build", "hills.toml", "--layers", hills::STRETCHED, "--memory", MEMORY, "--no-cache", "-q"];
        let mut arguments: Vec<String> = fixed.iter().chain(more).map(ToString::to_string).collect();
        arguments[1] = self.folder.join("hills.toml").display().to_string();
        arguments.extend(["--cell".to_string(), self.cell.to_string()]);
        arguments.extend(["--window".to_string(), format!("{corner},{corner},{side},{side}")]);
        arguments.extend(["-o".to_string(), out.display().to_string()]);
        arguments
    }

    fn run(&self, out: &Path, side: usize, more: &[&str], most: f64) -> Result<(Cost, bool), String> {
        let arguments = self.arguments(out, side, more);
        let arguments: Vec<&str> = arguments.iter().map(String::as_str).collect();
        watch(&self.program, &arguments, most)
    }

    /// The best of a few builds, because other load only makes them slower.
    fn best(&self, extension: &str, side: usize, times: usize, more: &[&str]) -> Result<Cost, String> {
        let out = self.folder.join(format!("out.{extension}"));
        let mut best = Cost { cpu: f64::INFINITY, wall: f64::INFINITY, memory: 0 };
        for _ in 0..times {
            let (cost, _) = self.run(&out, side, &[more, &["--force"]].concat(), f64::INFINITY)?;
            best = Cost {
                cpu: best.cpu.min(cost.cpu),
                wall: best.wall.min(cost.wall),
                memory: best.memory.max(cost.memory),
            };
        }
        self.remove(&out);
        Ok(best)
    }

    /// The remaining cost after a kill.
    fn resumed(&self, extension: &str, side: usize, half: f64) -> Result<Cost, String> {
        let out = self.folder.join(format!("killed.{extension}"));
        let (_, ended) = self.run(&out, side, &[], half)?;
        if ended {
            return Err("the build was done before it could be killed".to_string());
        }
        let (cost, _) = self.run(&out, side, &["--resume"], f64::INFINITY)?;
        self.remove(&out);
        Ok(cost)
    }

    fn remove(&self, out: &Path) {
        let _ = std::fs::remove_dir_all(out).or_else(|_| std::fs::remove_file(out));
        let mut beside = out.as_os_str().to_os_string();
        beside.push(".build");
        let _ = std::fs::remove_dir_all(beside);
    }
}
