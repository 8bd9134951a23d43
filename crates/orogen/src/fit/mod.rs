//! Recipes whose land is like a real place, without holding the place.

pub mod likeness;
pub mod search;
pub mod template;
