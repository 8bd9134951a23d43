//! Terrain statistics: measured, compared with real terrain, and drawn on a page.

pub mod chart;
pub mod land;
pub mod mean;
pub mod measures;
pub mod page;
pub mod real;
pub mod sorted;
pub mod water;
