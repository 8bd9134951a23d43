//! Recipes whose land is like a real place, without holding the place.

pub mod features;
pub mod search;
pub mod template;
