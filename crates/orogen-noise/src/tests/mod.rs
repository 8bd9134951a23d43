//! Tests that look inside.

mod bits;
mod common;
mod statistics;
mod twins;
