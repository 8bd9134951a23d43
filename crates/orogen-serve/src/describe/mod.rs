//! Descriptions of a world, for people and for map programs.

pub mod escape;
pub mod index;
pub mod openapi;
pub mod recipe;
pub mod tilejson;
pub mod wmts;
pub mod world;
