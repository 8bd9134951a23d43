//! The crate with unsafe code and the kernels on it, under LLVM's AddressSanitizer: a read or write beside a slice ends the test.

use crate::failure::Result;
use crate::shell;

/// Every level, every way of asking, odd positions and parameters, empty and single samples.
const TESTS: [&str; 2] = [
    "test --quiet --package orogen-simd --lib",
    "test --quiet --package orogen-noise --test goldens --test odd --test ways",
];

/// Builds the tests with the sanitizer, in a target folder of their own, and runs them.
pub fn check() -> Result {
    let host = shell::host()?;
    for test in TESTS {
        let mut command = shell::cargo(test);
        command
            // The sanitizer is not stable yet; the compiler is the very one that all else is built with.
            .env("RUSTC_BOOTSTRAP", "1")
            .env("RUSTFLAGS", "-Zsanitizer=address")
            // A named target keeps the flags from what runs while building.
            .env("CARGO_BUILD_TARGET", &host)
            .env("CARGO_TARGET_DIR", super::folder().join("asan"))
            // The report names functions without it, and the build is shorter.
            .env("CARGO_PROFILE_DEV_DEBUG", "false")
            .env("CARGO_INCREMENTAL", "0");
        shell::run(&mut command)?;
    }
    Ok(())
}
