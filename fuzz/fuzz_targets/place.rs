//! The target `place` for libFuzzer.
#![no_main]

libfuzzer_sys::fuzz_target!(|input: &[u8]| orogen_fuzz_targets::place::run(input));
