//! The target `author_map` for libFuzzer.
#![no_main]

libfuzzer_sys::fuzz_target!(|input: &[u8]| orogen_fuzz_targets::author_map::run(input));
