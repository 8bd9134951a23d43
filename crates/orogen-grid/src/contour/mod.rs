//! Contours of a grid, as lines.

#[doc(hidden)]
pub mod band;
#[doc(hidden)]
pub mod chaikin;
#[doc(hidden)]
pub mod levels;
#[doc(hidden)]
pub mod line;
#[doc(hidden)]
pub mod trace;

pub use band::Band;
pub use chaikin::chaikin;
pub use levels::{levels_every, round_interval};
pub use line::Line;
pub use trace::contours;
