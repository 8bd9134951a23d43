//! Tests of the public API of noises, and of their kernels, which are compared with reference implementations.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "a test that fails panics")]

mod bits;
mod goldens;
mod noises;
mod odd;
mod paths;
mod phacelle;
mod prepared;
mod programs;
mod rng;
mod seams;
mod statistics;
mod twins;
mod ways;
mod worley;
