//! Tilemaps: terrain classes of cells, the tiles that fit their neighbors, and changes of classes where no tile fits.
//!
//! Classes are ordered: a tilemap draws one layer for each, over the layers of the classes before it. The layer of a class covers the cells
//! of this class and of all later ones, so each layer needs only tiles for "covered or not" ([`mask`]), and classes of any number meet
//! anywhere without tiles for every pair.

pub mod choose;
pub mod classes;
pub mod clean;
pub mod drawable;
pub mod mask;

#[cfg(test)]
mod tests;
