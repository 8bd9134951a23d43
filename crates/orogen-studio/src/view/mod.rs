//! What is looked at, and from where.

pub mod arrangement;
pub mod camera;
pub mod map_view;
pub mod scene;
pub mod sun;
