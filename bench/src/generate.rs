//! Area `generate`: wall time of whole runs of `orogen generate`, on all cores.

use std::path::PathBuf;
use std::process::{Command, Stdio};
use std::time::Instant;

use serde_json::{Value, json};

use crate::options::Options;

/// The environment variable with the program to run: `cargo xtask bench` builds it and sets this.
const PROGRAM: &str = "OROGEN_BIN";

/// Maximum wall time for a preset at 1024 samples per side, in seconds.
const MOST: f64 = 2.0;

/// Runs every preset, or those selected.
pub fn run(options: &Options) -> Result<Value, String> {
    let program = std::env::var_os(PROGRAM)
        .map(PathBuf::from)
        .ok_or_else(|| format!("{PROGRAM} is not set: run `cargo xtask bench generate`"))?;
    let out = std::env::temp_dir().join(format!("orogen-bench-{}", std::process::id()));
    let listed = Command::new(&program).arg("presets").output().map_err(|e| format!("{}: {e}", program.display()))?;
    let listed = String::from_utf8_lossy(&listed.stdout).into_owned();
    let names = listed.lines().filter_map(|line| line.split_whitespace().next());
    let mut rows = Vec::new();
    for name in names.filter(|name| name.contains(&options.case)) {
        eprintln!("{name} ...");
        let mut times = Vec::new();
        for _ in 0..options.repetitions {
            let mut command = Command::new(&program);
            command
                .args(["generate", name, "--size", "1024", "--quiet", "--no-cache", "-o"])
                .arg(&out)
                .stdin(Stdio::null());
            let start = Instant::now();
            let status = command.status().map_err(|e| format!("{}: {e}", program.display()))?;
            times.push(start.elapsed().as_secs_f64());
            if !status.success() {
                return Err(format!("`orogen generate {name}` ended with {status}"));
            }
        }
        let seconds = (crate::measure::median(&mut times) * 1000.0).round() / 1000.0;
        rows.push(json!({
            "case": format!("generate {name} 1024 x 1024, at most"),
            "ours": seconds, "unit": "s on the wall", "peer": null, "peer_value": null, "ratio": null,
            "target": MOST, "met": seconds <= MOST,
        }));
    }
    // The folder has only files that were made here.
    let _ = std::fs::remove_dir_all(&out);
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    Ok(json!({ "area": "generate", "simd": orogen_simd::Level::current().name(), "threads": threads, "rows": rows }))
}
