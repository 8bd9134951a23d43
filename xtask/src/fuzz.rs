//! `cargo xtask fuzz`: libFuzzer on every reader of files and texts, with the stable compiler.

use crate::failure::{Failure, Result, on_file};
use crate::{pool, shell};

pub const ABOUT: &str = "run libFuzzer on the readers of files and texts";

pub const HELP: &str = "
Usage: cargo xtask fuzz [TARGET...] [--seconds N] [--runs N]

Builds fuzz/ with coverage counters and AddressSanitizer into target/fuzz and runs all targets, or those named, as many at once as there are cores, for N seconds
each (default 60) or N executions, whichever comes first, starting with the files in fuzz/corpus/TARGET. New inputs are written to target/fuzz/found, not to the committed corpus. Inputs that break a reader
are written to fuzz/artifacts. Needs a C++ compiler for libFuzzer; cargo-fuzz is optional.
";

/// Flags for coverage instrumentation, the same as in cargo-fuzz.
const FLAGS: &str = "--cfg fuzzing -Zsanitizer=address -Cpasses=sancov-module -Cllvm-args=-sanitizer-coverage-level=4 \
    -Cllvm-args=-sanitizer-coverage-inline-8bit-counters -Cllvm-args=-sanitizer-coverage-pc-table \
    -Cllvm-args=-sanitizer-coverage-trace-compares -Ccodegen-units=1 -Cdebug-assertions";

/// Builds and runs.
pub fn run(args: &[String]) -> Result {
    let targets = targets()?;
    let (mut seconds, mut runs, mut named, mut args) = (60, None, Vec::new(), args.iter());
    while let Some(arg) = args.next() {
        match arg.as_str() {
            "--seconds" | "--runs" => {
                let number = args.next().and_then(|number| number.parse::<u32>().ok());
                let number = number.ok_or_else(|| Failure::usage(format!("{arg} takes a whole number")))?;
                if arg == "--runs" { runs = Some(number) } else { seconds = number }
            }
            target if targets.iter().any(|name| name == target) => named.push(target.to_owned()),
            other => {
                return Err(Failure::usage(format!("there is no target '{other}'; there are {}", targets.join(", "))));
            }
        }
    }
    if named.is_empty() {
        named = targets;
    }
    let folder = shell::target_dir().join("fuzz");
    let artifacts = shell::root().join("fuzz/artifacts");
    let host = shell::host()?;
    let mut build = shell::cargo("build --quiet --release --manifest-path fuzz/Cargo.toml");
    build
        .args(named.iter().flat_map(|target| ["--bin", target.as_str()]))
        // Sanitizers are unstable; this allows them in the stable compiler that builds everything else.
        .env("RUSTC_BOOTSTRAP", "1")
        .env("RUSTFLAGS", FLAGS)
        // A named target keeps the flags from build scripts.
        .env("CARGO_BUILD_TARGET", &host)
        .env("CARGO_TARGET_DIR", &folder)
        .env("CARGO_INCREMENTAL", "0");
    shell::run(&mut build)?;
    let mut commands = Vec::with_capacity(named.len());
    for target in named {
        let found = folder.join("found").join(&target);
        for folder in [&found, &artifacts.join(&target)] {
            std::fs::create_dir_all(folder).map_err(|cause| on_file("make", folder, &cause))?;
        }
        let mut command = shell::program(folder.join(&host).join("release").join(&target));
        command
            .args([&found, &shell::root().join("fuzz/corpus").join(&target)])
            .arg(format!("-max_total_time={seconds}"))
            .args(runs.map(|runs| format!("-runs={runs}")))
            .arg(format!("-artifact_prefix={}/", artifacts.join(&target).display()))
            .args([
                "-rss_limit_mb=1024",
                "-malloc_limit_mb=256",
                "-timeout=10",
                "-print_final_stats=1",
                "-verbosity=0",
            ]);
        commands.push(command);
    }
    pool::run(commands, |mut command| shell::run(&mut command))
}

/// The names of all targets, sorted. Each target is a program in fuzz/fuzz_targets.
fn targets() -> Result<Vec<String>> {
    let folder = shell::root().join("fuzz/fuzz_targets");
    let entries = std::fs::read_dir(&folder).map_err(|cause| on_file("read", &folder, &cause))?;
    let mut names: Vec<String> = entries
        .flatten()
        .filter_map(|entry| Some(entry.file_name().to_str()?.strip_suffix(".rs")?.to_owned()))
        .collect();
    names.sort();
    Ok(names)
}
