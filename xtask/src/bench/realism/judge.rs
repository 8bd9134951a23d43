//! The scripts of the folder `realism`, and their answers.

use std::collections::BTreeSet;
use std::path::PathBuf;

use serde_json::Value;

use super::Half;
use crate::failure::{Failure, Result};
use crate::shell;

/// Compares rasters with windows of real land.
pub struct Judge {
    python: PathBuf,
    half: Option<Half>,
    real: Value,
}

/// How far land is from real land of a type.
#[derive(Debug, Clone, PartialEq)]
pub struct Score {
    pub judged: f64,
    pub dropped: f64,
    pub median: f64,
    pub p90: f64,
    /// NaN if the type has no unit of it.
    pub energy: f64,
    pub stand_out: f64,
    pub bias: f64,
    pub worst_bias: f64,
    /// Shares of samples below all neighbors, and of those that filling of depressions raises.
    pub pits: f64,
    pub filled: f64,
    pub real: Real,
}

/// The real windows of a type: how many, and the same figures of them.
#[derive(Debug, Clone, PartialEq)]
pub struct Real {
    pub windows: f64,
    pub p90: f64,
    pub bias: f64,
    pub filled: f64,
}

impl Judge {
    pub fn new(half: Option<Half>) -> Result<Self> {
        let real = shell::read(&folder().join("real.json"))?;
        let real = serde_json::from_str(&real).map_err(|e| Failure::new(format!("realism/real.json: {e}")))?;
        Ok(Self { python: python()?, half, real })
    }

    /// The figures of rasters beside a type of land, or `None` if no window is hilly enough. Arrays of NumPy have cells
    /// of this many metres.
    pub fn compare(&self, files: &[PathBuf], kind: &str, cell: u32) -> Result<Option<Score>> {
        let mut command = shell::program(&self.python);
        command.arg(folder().join("score.py")).args(files);
        command.args(["--json", "--type", kind, "--cell", &cell.to_string()]);
        command.args(self.half.iter().flat_map(|half| ["--half", half.name()]));
        let answer = shell::capture(&mut command)?;
        let found: Value = serde_json::from_str(&answer).unwrap_or_default();
        if found["windows"] == 0 {
            return Ok(None);
        }
        let score = read(&found).ok_or_else(|| Failure::new(format!("the answer has no score:\n{answer}")))?;
        Ok(Some(score))
    }

    /// Whether land is compared with a type. The unit of distance needs two regions, which half of a type may not have.
    pub fn knows(&self, kind: &str) -> bool {
        let knows = self.half.is_none() || self.regions(kind) >= 4;
        if !knows {
            eprintln!("{kind} has fewer than four real regions: its halves are not compared");
        }
        knows
    }

    /// The number of real regions of a type.
    fn regions(&self, kind: &str) -> usize {
        let windows = self.real["windows"].as_array().map_or(&[] as &[Value], Vec::as_slice);
        // The first two columns are the type and the region.
        windows.iter().filter(|row| row[0] == kind).filter_map(|row| row[1].as_str()).collect::<BTreeSet<_>>().len()
    }
}

/// The folder of the scripts.
pub fn folder() -> PathBuf {
    shell::root().join("realism")
}

/// A Python with the packages of the scripts: `OROGEN_REALISM`, or one in the target folder.
pub fn python() -> Result<PathBuf> {
    if let Some(python) = std::env::var_os("OROGEN_REALISM") {
        return Ok(python.into());
    }
    let venv = shell::target_dir().join("bench").join("realism");
    let python = venv.join(if cfg!(windows) { "Scripts/python.exe" } else { "bin/python" });
    let imports = || shell::succeeds(shell::program(&python).args(["-c", "import scipy, rasterio, numba"]));
    if python.is_file() && imports() {
        return Ok(python);
    }
    eprintln!("installing scipy, rasterio and numba ...");
    shell::run(shell::program("python3").args(["-m", "venv", "--clear"]).arg(&venv))?;
    let install = ["-m", "pip", "install", "--quiet", "--disable-pip-version-check", "-r"];
    shell::run(shell::program(&python).args(install).arg(folder().join("requirements.txt")))?;
    Ok(python)
}

/// Parses the answer of `score.py --json`. Figures that have targets are rounded to the published digits.
fn read(found: &Value) -> Option<Score> {
    let number = |name: &str| found[name].as_f64();
    let rounded = |name: &str, parts: f64| Some((number(name)? * parts).round() / parts);
    let real = |name: &str| found["real"][name].as_f64();
    Some(Score {
        judged: number("windows")?,
        dropped: number("flat")?,
        median: rounded("score", 100.0)?,
        p90: rounded("p90", 100.0)?,
        energy: rounded("energy", 100.0).unwrap_or(f64::NAN),
        stand_out: found["stand_out"].as_object()?.len() as f64,
        bias: rounded("bias", 1000.0)?,
        worst_bias: rounded("worst_bias", 1000.0)?,
        pits: number("pits")?,
        filled: number("filled")?,
        real: Real { windows: real("windows")?, p90: real("p90")?, bias: real("bias")?, filled: real("filled")? },
    })
}

/// A score, for tests.
#[cfg(test)]
pub const SAMPLE: Score = Score {
    judged: 250.0,
    dropped: 6.0,
    median: 0.70,
    p90: 0.85,
    energy: 0.41,
    stand_out: 1.0,
    bias: 0.006,
    worst_bias: 0.035,
    pits: 0.001,
    filled: 0.02,
    real: Real { windows: 37.0, p90: 1.41, bias: 0.006, filled: 0.026 },
};

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_answer_is_read() {
        let answer = r#"{"flat": 6, "windows": 250, "score": 0.70, "p90": 0.85, "energy": 0.41, "bias": 0.006,
            "stand_out": {"fill_asym": -2.3}, "worst_bias": 0.035, "pits": 0.001, "filled": 0.02,
            "real": {"windows": 37, "p90": 1.41, "bias": 0.006, "filled": 0.026}}"#;
        let mut answer: Value = serde_json::from_str(answer).expect("well formed");
        assert_eq!(read(&answer), Some(SAMPLE));
        answer["energy"] = Value::Null;
        assert!(read(&answer).expect("well formed").energy.is_nan());
        answer["score"] = Value::Null;
        assert_eq!(read(&answer), None);
    }
}
