//! Peers that are Python packages: a script in `peers/` measures them with their own Python.

use std::path::{Path, PathBuf};
use std::process::Command;

use orogen::Grid;
use serde_json::Value;

use crate::measure::median;

/// The times of a peer's parts, in seconds of CPU.
pub struct Parts {
    peer: String,
    times: Value,
}

impl Parts {
    /// Runs a script of `peers/` with these arguments; its last line is a JSON object with a list of seconds for each
    /// part. `peer` is the name in messages.
    pub fn measure(python: &Path, script: &str, peer: &str, arguments: &[String]) -> Result<Self, String> {
        let script = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("peers").join(script);
        let mut command = Command::new(python);
        let output = command.arg(script).arg(peer).args(arguments).output();
        let output = output.map_err(|e| format!("{}: {e}", python.display()))?;
        let text = String::from_utf8_lossy(&output.stdout);
        let times: Value = serde_json::from_str(text.lines().last().unwrap_or_default())
            .map_err(|_| format!("{peer} measured nothing: {}", String::from_utf8_lossy(&output.stderr)))?;
        Ok(Self { peer: peer.to_owned(), times })
    }

    /// The sum of the median seconds of these parts.
    pub fn seconds(&self, parts: &[&str]) -> Result<f64, String> {
        parts.iter().map(|part| self.part(part)).sum()
    }

    fn part(&self, part: &str) -> Result<f64, String> {
        let times = self.times[part].as_array();
        let mut times: Vec<f64> = times.into_iter().flatten().filter_map(Value::as_f64).collect();
        match times.is_empty() {
            true => Err(format!("{} did not measure {part}", self.peer)),
            false => Ok(median(&mut times)),
        }
    }
}

/// Writes heights as `ground.npy`; returns the path.
pub fn ground_file(folder: &Path, ground: &Grid) -> Result<PathBuf, String> {
    let file = folder.join("ground.npy");
    let written = std::fs::File::create(&file).and_then(|mut out| orogen::io::format::npy::write(&mut out, ground));
    written.map(|()| file.clone()).map_err(|e| format!("{}: {e}", file.display()))
}
