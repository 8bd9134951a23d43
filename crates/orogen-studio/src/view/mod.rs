//! What is looked at, and from where.

pub mod camera;
pub mod graph_layout;
pub mod map_view;
pub mod sun;
