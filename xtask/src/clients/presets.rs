//! Checks that the release binary makes every preset with the golden hash.

use serde_json::Value;

use crate::failure::{Failure, Result};
use crate::{output, shell};

const GOLDEN: &str = "golden/presets.txt";

/// Numbers of threads.
const THREADS: [&str; 2] = ["1", "2"];

/// Makes each preset once at each SIMD level, at neighboring levels with different numbers of threads.
pub fn check() -> Result {
    check_with(|at| &THREADS[at % 2..][..1])
}

/// Makes each preset at each SIMD level with each number of threads.
pub fn check_all() -> Result {
    check_with(|_| &THREADS)
}

/// Makes each preset at each SIMD level. `threads` returns the numbers of threads for the index of a level.
fn check_with(threads: fn(usize) -> &'static [&'static str]) -> Result {
    let golden = shell::read(&shell::root().join(GOLDEN))?;
    let golden =
        parse(&golden).map_err(|line| Failure::new(format!("{GOLDEN}: expected `NAME SHA256`, got '{line}'")))?;
    let listed = shell::capture(shell::program(super::orogen()).arg("presets"))?;
    let listed: Vec<&str> = listed.lines().filter_map(|l| l.split_whitespace().next()).collect();
    if let Some(name) = listed.iter().find(|name| golden.iter().all(|(n, _)| n != *name)) {
        return Err(Failure::new(format!("{GOLDEN} has no line for the preset '{name}': run `cargo xtask bless`")));
    }
    let levels = levels();
    let mut wrong = Vec::new();
    for (name, expect) in &golden {
        for (at, level) in levels.iter().enumerate() {
            for threads in threads(at) {
                let got = hash(name, level, threads)?;
                if got != *expect {
                    wrong.push(format!("  {name}, {level}, {threads} threads: {got}, expected {expect}"));
                }
            }
        }
    }
    if !wrong.is_empty() {
        return Err(Failure::new(format!("hashes that differ from {GOLDEN}:\n{}", wrong.join("\n"))));
    }
    output::line(format_args!(
        "    {} presets, levels {}: all as in {GOLDEN}",
        golden.len(),
        levels
            .iter()
            .enumerate()
            .map(|(at, level)| format!("{level} ({} threads)", threads(at).join(" and ")))
            .collect::<Vec<_>>()
            .join(", ")
    ));
    Ok(())
}

fn parse(text: &str) -> std::result::Result<Vec<(&str, &str)>, &str> {
    let lines = text.lines().filter(|l| !l.trim().is_empty() && !l.starts_with('#'));
    lines.map(|line| line.split_once(' ').map(|(name, hash)| (name, hash.trim())).ok_or(line)).collect()
}

/// The levels that this machine supports.
fn levels() -> Vec<&'static str> {
    let mut levels = vec!["scalar"];
    if cfg!(target_arch = "aarch64") {
        levels.push("neon");
    }
    #[cfg(target_arch = "x86_64")]
    {
        use std::arch::is_x86_feature_detected as has;
        if has!("avx2") && has!("fma") {
            levels.push("avx2");
        }
        if has!("avx512f") && has!("avx512bw") && has!("avx512dq") && has!("avx512vl") {
            levels.push("avx512");
        }
    }
    levels
}

fn hash(preset: &str, level: &str, threads: &str) -> Result<String> {
    let out = super::folder().join("work/presets");
    let mut command = shell::program(super::orogen());
    command.args(["generate", preset, "--size", "256", "--threads", threads, "--quiet", "-o"]).arg(&out);
    shell::run(command.env("OROGEN_SIMD", level))?;
    let summary = shell::read(&out.join("summary.json"))?;
    let summary: Value = serde_json::from_str(&summary).map_err(|e| Failure::new(format!("summary.json: {e}")))?;
    Ok(summary["sha256"].as_str().unwrap_or("no sha256").to_owned())
}

#[cfg(test)]
mod tests {
    use super::parse;

    #[test]
    fn golden_lines() {
        let pairs = parse("# name, then hash\nalpine 0a1b\n\nhills  ff\n");
        assert_eq!(pairs, Ok(vec![("alpine", "0a1b"), ("hills", "ff")]));
        assert_eq!(parse("alpine"), Err("alpine"));
    }
}
