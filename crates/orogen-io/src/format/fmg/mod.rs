//! Maps of [Azgaar's Fantasy Map Generator](https://github.com/Azgaar/Fantasy-Map-Generator), as it exports them to
//! JSON (`full`, or `pack cells`).
//!
//! A map has cells with heights from 0 to 100 (land from 20 on), and corners of cells in pixels. Coasts and lakes are
//! made from the cells themselves, not from the features of the file, so that they fit together whatever was edited.

mod cells;
mod document;
mod map;
mod parts;
mod rivers;
#[doc(hidden)]
pub mod samples;
mod surroundings;
mod table;
mod units;

pub use map::FmgMap;
pub use parts::{Lake, River, Settlement, Site, Water};

#[cfg(test)]
mod tests;
