//! Worlds from maps that an author drew: an [`AuthorMapJob`] makes a recipe and its files from an export of Azgaar's
//! Fantasy Map Generator.

mod calibration;
mod courses;
mod files;
mod job;
mod layers;
mod rasters;
mod recipe;

pub use files::check_new;
pub use job::{AuthorMapJob, AuthorWorld};

#[cfg(test)]
mod tests;
