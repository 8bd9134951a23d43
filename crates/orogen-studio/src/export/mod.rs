//! Exports: the settings of the dialog, the command line that makes the same file, and the work.
//!
//! An [`Export`](request::Export) holds the settings of each [kind](kind::Kind). Files are made by the same jobs of the
//! library as in the command-line program, so they have the same bytes.

pub mod command_line;
pub mod engine;
pub mod given;
pub mod kept;
pub mod kind;
pub mod layer;
pub mod map;
pub mod render;
pub mod request;
pub mod running;
pub mod samples;
pub mod tilemap;
pub mod work;

#[cfg(test)]
mod tests;
