//! Recipes with the statistics of a real place, without its data: a [`FitJob`] finds one.

#[doc(hidden)]
pub mod features;
#[doc(hidden)]
pub mod job;
#[doc(hidden)]
pub mod report;
#[doc(hidden)]
pub mod search;
#[doc(hidden)]
pub mod template;

#[doc(hidden)]
pub use features::FeatureVector;
pub use job::FitJob;
pub use search::{Effort, FitTarget, Found, search};
pub use template::FittedWorld;
