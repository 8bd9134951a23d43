//! Pictures of a recipe while it is edited: first coarse, then finer, made outside of the thread of the user interface.

pub mod coloring;
pub mod colors;
pub mod contours;
pub mod cover;
pub mod detail;
pub mod failure;
pub mod frame;
pub mod legend;
pub mod op_pictures;
pub mod picture;
pub mod ramp;
pub mod region;
pub mod request;
pub mod ring;
pub mod rivers;
pub mod stages;
pub mod statistics;
pub mod strip;
pub mod sunlight;
pub mod survey;
pub mod thumbnails;
pub mod worker;
