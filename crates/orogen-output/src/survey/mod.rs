//! Terrain statistics: measured, compared with real terrain, and drawn on a page.

pub(crate) mod chart;
pub mod job;
pub mod land;
pub(crate) mod mean;
pub mod measures;
pub mod page;
pub mod real;
pub(crate) mod sorted;
#[doc(hidden)]
pub mod stretch;
pub(crate) mod water;
