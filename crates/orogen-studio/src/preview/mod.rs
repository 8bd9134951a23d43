//! Pictures of a recipe while it is edited: coarse first, then finer, off the thread of the user interface.

pub mod colors;
pub mod frame;
pub mod picture;
pub mod region;
pub mod request;
pub mod stages;
pub mod statistics;
pub mod strip;
pub mod thumbnails;
pub mod worker;
