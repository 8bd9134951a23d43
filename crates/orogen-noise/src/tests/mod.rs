//! Tests that need private items.

mod bits;
mod common;
mod phacelle;
mod seams;
mod statistics;
mod twins;
mod worley;
