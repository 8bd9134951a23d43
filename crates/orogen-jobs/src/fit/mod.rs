//! Recipes with the statistics of a real place, without its data.

pub mod features;
pub mod search;
pub mod template;
