//! Recipes with the statistics of a real place, without its data.

#[doc(hidden)]
pub mod features;
#[doc(hidden)]
pub mod search;
#[doc(hidden)]
pub mod template;

pub use features::FeatureVector;
pub use search::{Effort, FitTarget, Found, search};
pub use template::FittedWorld;
