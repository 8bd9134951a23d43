//! Tests of the crate with unsafe code and of its kernels under LLVM's AddressSanitizer: a read or write outside a
//! slice ends the test.

use crate::failure::Result;
use crate::shell;

/// Tests of every level and entry point, with unusual positions and parameters, and with empty and single samples.
const TESTS: [&str; 2] = [
    "test --quiet --package orogen-simd --lib",
    "test --quiet --package orogen-noise --test suite -- goldens:: odd:: ways::",
];

/// Builds the tests with the sanitizer, in their own target folder, and runs them.
pub fn check() -> Result {
    let host = shell::host()?;
    for test in TESTS {
        let mut command = shell::cargo(test);
        command
            // Sanitizers are unstable; this allows them in the stable compiler that builds everything else.
            .env("RUSTC_BOOTSTRAP", "1")
            .env("RUSTFLAGS", "-Zsanitizer=address")
            // A named target keeps the flags from build scripts.
            .env("CARGO_BUILD_TARGET", &host)
            .env("CARGO_TARGET_DIR", super::folder().join("asan"))
            // The report has function names without debug information, and the build is shorter.
            .env("CARGO_PROFILE_DEV_DEBUG", "false")
            .env("CARGO_INCREMENTAL", "0");
        shell::run(&mut command)?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::clients::neon;

    /// Checks the filters, because a filter that matches no test does not fail.
    #[test]
    fn filters_of_tests_are_modules_of_the_suite() {
        let suite = shell::root().join("crates/orogen-noise/tests/suite");
        let words = TESTS.iter().chain(&neon::TESTS).flat_map(|test| test.split(' '));
        let modules: Vec<&str> = words.filter_map(|word| word.strip_suffix("::")).collect();
        assert_eq!(modules.len(), 5);
        assert!(modules.iter().all(|module| suite.join(module).with_extension("rs").is_file()), "{modules:?}");
    }
}
