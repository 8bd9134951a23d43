//! What is shown, and from where.

pub mod arrangement;
pub mod camera;
pub mod land;
pub mod map_view;
pub mod pace;
pub mod rings;
pub mod scene;
pub mod sun;
