//! Descriptions of a world, for people and for map programs.

mod escape;
pub mod index;
pub mod openapi;
pub mod tilejson;
pub mod wmts;
