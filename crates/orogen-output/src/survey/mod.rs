//! Terrain statistics: measured, compared with real terrain, and drawn on a page.

pub(crate) mod chart;
#[doc(hidden)]
pub mod job;
#[doc(hidden)]
pub mod land;
pub(crate) mod mean;
#[doc(hidden)]
pub mod measures;
#[doc(hidden)]
pub mod page;
#[doc(hidden)]
pub mod real;
pub(crate) mod sorted;
#[doc(hidden)]
pub mod stretch;
pub(crate) mod water;

pub use job::SurveyJob;
pub use land::Land;
pub use measures::Measures;
