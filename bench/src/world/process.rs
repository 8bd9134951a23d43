//! CPU time and memory of another process, on Linux.

use std::path::{Path, PathBuf};
use std::process::{Child, Command, ExitStatus, Stdio};
use std::time::{Duration, Instant};

/// Interval at which the process is checked.
const INTERVAL: Duration = Duration::from_millis(5);

/// The kernel reports CPU time in hundredths of a second.
const TICKS: f64 = 100.0;

/// The environment variable with the program to run: `cargo xtask bench` builds it and sets this.
const PROGRAM: &str = "OROGEN_BIN";

/// The program to run.
pub fn program() -> Result<PathBuf, String> {
    let program = std::env::var_os(PROGRAM).map(PathBuf::from);
    program.ok_or_else(|| format!("{PROGRAM} is not set: run `cargo xtask bench world`"))
}

/// The cost of a run.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Cost {
    /// CPU seconds of all threads.
    pub cpu: f64,
    /// Wall time in seconds.
    pub wall: f64,
    /// Peak memory, in bytes.
    pub memory: u64,
}

/// Runs a program to its end, or kills it after `most` CPU seconds. Returns the cost, and whether it ended by itself.
pub fn watch(program: &Path, arguments: &[&str], most: f64) -> Result<(Cost, bool), String> {
    let failed = |why: &dyn std::fmt::Display| format!("{} {}: {why}", program.display(), arguments.join(" "));
    let start = Instant::now();
    let mut command = Command::new(program);
    command.args(arguments).stdin(Stdio::null()).stdout(Stdio::null());
    let mut child = command.spawn().map_err(|e| failed(&e))?;
    let mut cost = Cost::default();
    let mut killed = false;
    loop {
        let look = Look::at(&child).ok_or_else(|| failed(&"this system does not tell what a process takes"))?;
        // After its end the process is listed until its exit status is read.
        cost = Cost { cpu: look.cpu, wall: start.elapsed().as_secs_f64(), memory: cost.memory.max(look.memory) };
        if look.ended {
            break;
        }
        if look.cpu >= most && !killed {
            child.kill().map_err(|e| failed(&e))?;
            killed = true;
        }
        std::thread::sleep(INTERVAL);
    }
    let status: ExitStatus = child.wait().map_err(|e| failed(&e))?;
    match status.success() || killed {
        true => Ok((cost, status.success())),
        false => Err(failed(&status)),
    }
}

struct Look {
    cpu: f64,
    memory: u64,
    ended: bool,
}

impl Look {
    fn at(child: &Child) -> Option<Look> {
        let read = |name: &str| std::fs::read_to_string(format!("/proc/{}/{name}", child.id())).ok();
        let stat = read("stat")?;
        // After the name, which is in brackets: the state, and as 12th and 13th field the user and system times.
        let fields: Vec<&str> = stat.rsplit_once(')')?.1.split_whitespace().collect();
        let ticks = |at: usize| fields.get(at).and_then(|text| text.parse::<f64>().ok());
        Some(Look {
            cpu: (ticks(11)? + ticks(12)?) / TICKS,
            memory: read("status").and_then(|status| high_water(&status)).unwrap_or(0),
            ended: matches!(*fields.first()?, "Z" | "X"),
        })
    }
}

/// The peak memory so far, in bytes.
fn high_water(status: &str) -> Option<u64> {
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"))?;
    Some(line.trim().strip_suffix("kB")?.trim().parse::<u64>().ok()? * 1024)
}

#[cfg(all(test, target_os = "linux"))]
mod tests {
    use super::*;

    #[test]
    fn what_a_run_takes() {
        let spin = "i=0; while [ $i -lt 300000 ]; do i=$((i+1)); done";
        let (cost, ended) = watch(Path::new("sh"), &["-c", spin], f64::INFINITY).expect("it runs");
        assert!(ended && cost.cpu > 0.0 && cost.wall >= 0.9 * cost.cpu && cost.memory > 100_000, "{cost:?}");
        let (cost, ended) = watch(Path::new("sh"), &["-c", "while :; do :; done"], 0.05).expect("it is killed");
        assert!(!ended && cost.cpu >= 0.05 && cost.cpu < 5.0, "{cost:?}");
        assert!(watch(Path::new("sh"), &["-c", "exit 3"], 1.0).is_err());
    }
}
