//! Places of a world that satisfy conditions, also in worlds without bounds: a [`LocateJob`] finds the nearest.
//!
//! `condition` reads conditions, `search` has the order of the parts of the world, `ground` finds places in samples and
//! `objects` among vector features, and `report` tells them.

mod condition;
mod ground;
#[doc(hidden)]
pub mod job;
mod objects;
#[doc(hidden)]
pub mod report;
mod search;

pub use job::LocateJob;
pub use report::{Located, Match};
