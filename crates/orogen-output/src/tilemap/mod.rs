//! Tiles: a [`tileset`], those that the program draws ([`art`]), and their [`picture`].

pub mod art;
pub mod picture;
#[doc(hidden)]
pub mod rows;
pub mod tileset;
