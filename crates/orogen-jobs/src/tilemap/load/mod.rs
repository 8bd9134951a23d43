//! Tilesets from files.

pub mod any;
pub mod description;
pub mod loaded;
mod picture;
pub mod tsx;

#[cfg(test)]
mod tests;
