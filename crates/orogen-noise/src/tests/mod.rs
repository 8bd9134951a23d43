//! Tests that look inside.

mod bits;
mod common;
mod phacelle;
mod seams;
mod statistics;
mod twins;
mod worley;
