//! Tiles: a [`tileset`], the built-in tilesets ([`art`]), and their [`picture`].

#[doc(hidden)]
pub mod art;
#[doc(hidden)]
pub mod picture;
#[doc(hidden)]
pub mod rows;
#[doc(hidden)]
pub mod tileset;

pub use tileset::{Tile, Tileset};
