//! Tests of the public API of noises.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "a test that fails panics")]

mod goldens;
mod noises;
mod odd;
mod paths;
mod prepared;
mod statistics;
mod ways;
