//! What terrain is like, in numbers: measured, set beside what real terrain is like, and drawn on a page.

pub mod chart;
pub mod land;
pub mod mean;
pub mod measures;
pub mod page;
pub mod real;
pub mod sorted;
pub mod water;
