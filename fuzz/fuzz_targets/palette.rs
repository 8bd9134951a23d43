//! The target `palette` for libFuzzer.
#![no_main]

libfuzzer_sys::fuzz_target!(|input: &[u8]| orogen_fuzz_targets::palette::run(input));
