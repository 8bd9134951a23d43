//! The target `network` for libFuzzer.
#![no_main]

libfuzzer_sys::fuzz_target!(|input: &[u8]| orogen_fuzz_targets::network::run(input));
