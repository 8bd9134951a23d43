//! Tests of recipes and worlds as a program uses them.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "a test that fails panics")]

mod cells;
mod drawings;
mod exemplar_in_recipes;
mod levelled;
mod lowering;
mod margins;
mod objects;
mod paint;
mod points_in_recipes;
mod previews;
mod rain;
mod shares;
mod strata_in_recipes;
mod strokes_in_recipes;
