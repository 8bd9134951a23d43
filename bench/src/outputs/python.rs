//! Peers that are Python packages: scripts in `bench/peers` that read heights from a .npy file and print a line of
//! JSON.

use std::ffi::OsStr;
use std::path::PathBuf;
use std::process::Command;

use orogen::Grid;
use orogen::io::format::npy;
use serde_json::Value;

use crate::measure::median;

/// The result of a peer.
pub struct Told {
    /// The median of its `seconds`.
    pub seconds: f64,
    /// The whole JSON object.
    pub values: Value,
}

/// Runs a script on these heights with the Python that an environment variable names; `None` if it is not set.
pub fn run(variable: &str, script: &str, heights: &Grid, arguments: &[String]) -> Result<Option<Told>, String> {
    let Some(python) = std::env::var_os(variable) else { return Ok(None) };
    let file = std::env::temp_dir().join(format!("orogen-bench-{script}-{}.npy", std::process::id()));
    let written = std::fs::File::create(&file).and_then(|mut out| npy::write(&mut out, heights));
    written.map_err(|e| format!("{}: {e}", file.display()))?;
    let path = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("peers").join(script);
    let output = Command::new(&python)
        .args([path.as_os_str(), file.as_os_str()])
        .args(arguments.iter().map(OsStr::new))
        .output();
    // Only files made here are removed.
    let _ = std::fs::remove_file(&file);
    let output = output.map_err(|e| format!("{}: {e}", python.display()))?;
    let values: Value = serde_json::from_slice(&output.stdout)
        .map_err(|_| format!("{script} measured nothing: {}", String::from_utf8_lossy(&output.stderr)))?;
    let mut seconds: Vec<f64> = values["seconds"].as_array().into_iter().flatten().filter_map(Value::as_f64).collect();
    if seconds.is_empty() {
        return Err(format!("{script} did not tell what it measured"));
    }
    Ok(Some(Told { seconds: median(&mut seconds), values }))
}
