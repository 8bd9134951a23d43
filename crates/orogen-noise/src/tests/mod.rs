//! Tests that look inside.

mod bits;
mod common;
mod seams;
mod statistics;
mod twins;
mod worley;
